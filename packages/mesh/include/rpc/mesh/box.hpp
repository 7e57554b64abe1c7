#pragma once

#include "rpc/mesh/mesh.hpp"

#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <vector>

namespace rpc::mesh
{

/// An axis-parallel box, divided evenly but for the last cells. 2D or 3D by the length of its arrays.
struct BoxOptions {
  std::vector<double> lower; ///< [m]
  std::vector<double> upper; ///< [m]   upper > lower
  std::vector<int> cells;    ///<       > 0 in each direction
  Element element;
  /// Length of the last cell in each direction over that of all others, > 0. Empty: 1, as decks have it.
  std::vector<double> last = {};

  double last_in(const int direction) const { return last.empty() ? 1 : last[direction]; }
  /// Of all cells but the last one [m].
  double cell_length(const int direction) const
  {
    return (upper[direction] - lower[direction]) / (cells[direction] - 1 + last_in(direction));
  }
};

/// Adds the box's parameters to a valid list.
void add_box_parameters(Teuchos::ParameterList &valid);

/// @throws rpc::Error (bad_input) on anything out of range
BoxOptions box_options(const Teuchos::ParameterList &list);

/// The next coarser box for multigrid, of order 1: in the directions in which cells are shortest, each two cells are one, and of an odd
/// number the last three, so that its functions are among those of the finer box; directions in which cells are more than 1.7 times as
/// long keep theirs, so that stretched cells become square ones first. None where no direction has more than one cell.
std::optional<BoxOptions> halved(const BoxOptions &options);

/// Makes this rank's part of a box; no communication of mesh data, and no rank holds the whole.
///
/// P1 and P2 cut each cell of the grid into two triangles, or six tetrahedra. Ranks form a grid of blocks chosen for the least number of shared cell faces. Sides are named left, right (x),
/// bottom, top (y), and in 3D back, front (z), corners after their sides, "left bottom" or "left bottom back". Node ids run over the lattice, x fastest. Collective on comm.
/// @throws rpc::Error (bad_mesh) if there are fewer cells than ranks in every direction, (bad_input) if the mesh cannot fit in memory
Mesh make_box(const BoxOptions &options, const RCP<const Comm> &comm);

} // namespace rpc::mesh
