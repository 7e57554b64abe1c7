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
  /// Between neighbouring nodes, but for those of the last cell [m].
  double node_distance(const int direction) const { return cell_length(direction) / element.order_along(direction); }
  /// Number of intervals between nodes.
  int intervals(const int direction) const { return cells[direction] * element.order_along(direction); }
};

/// Adds the box's parameters to a valid list.
void add_box_parameters(Teuchos::ParameterList &valid);

/// @throws rpc::Error (bad_input) on anything out of range
BoxOptions box_options(const Teuchos::ParameterList &list);

/// The next coarser box for multigrid, whose functions are among those of the finer one. In the directions in which nodes are closest, up to
/// 1.7 times the shortest distance, order 2 becomes order 1 on the same cells; where it is 1 already, each two cells become one, and
/// of an odd number the last three. Other directions keep what they have, so that stretched cells become square ones first. P2 becomes P1 in
/// all directions at once. None where no direction has more than one interval between nodes.
std::optional<BoxOptions> coarsened(const BoxOptions &options);

/// The direction in which a box is one cell of order 1 and thinner than 1.7 times the shortest distance of nodes in the others; the
/// thinnest of several. Coarser boxes would bend like bodies that are as thick as their cells are long, so that multigrid has to end here.
std::optional<int> thin_direction(const BoxOptions &options);

/// Makes this rank's part of a box; no communication of mesh data, and no rank holds the whole.
///
/// P1 and P2 cut each cell of the grid into two triangles, or six tetrahedra. Ranks form a grid of blocks chosen for the least number of shared cell faces. Sides are named left, right (x),
/// bottom, top (y), and in 3D back, front (z), corners after their sides, "left bottom" or "left bottom back". Node ids run over the lattice, x fastest. Collective on comm.
/// @throws rpc::Error (bad_mesh) if there are fewer cells than ranks in every direction, (bad_input) if the mesh cannot fit in memory
Mesh make_box(const BoxOptions &options, const RCP<const Comm> &comm);

} // namespace rpc::mesh
