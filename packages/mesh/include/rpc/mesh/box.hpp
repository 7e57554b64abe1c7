// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// An axis-parallel box. In each direction its cells are equal but for the last one, or graded. 2D or 3D by the length of its arrays.
struct BoxOptions {
  std::vector<double> lower; ///< [m]
  std::vector<double> upper; ///< [m]   upper > lower
  std::vector<int> cells;    ///<       > 0 in each direction
  Element element;
  /// Length of the last cell in each direction over that of all others, > 0. Empty: 1, as decks have it.
  std::vector<double> last = {};
  /// Blocks that it is divided into, on as many of the ranks; the other ranks have none of it. 0: a block on each rank.
  int blocks = 0;
  /// Directions in which it repeats itself: nodes of the upper side are those of the lower one. Ranks do not divide them.
  std::array<bool, 3> periodic = {};
  /// Whether nodes of such upper sides are nodes of their own all the same, as files want it.
  bool unrolled = false;
  /// Length of the last cell in each direction over that of the first one; those between are in geometric progression. Empty: 1.
  std::vector<double> expansion = {};
  /// Where the cells of graded directions end, cells + 1 ascending numbers [m]. Empty: equal cells, but for the last one.
  std::array<std::vector<double>, 3> ends = {};

  bool graded(const int direction) const { return !ends[direction].empty(); }
  double expansion_in(const int direction) const { return expansion.empty() ? 1 : expansion[direction]; }
  /// Whether the upper side has the nodes of the lower one.
  bool wraps(const int direction) const { return periodic[direction] && !unrolled; }
  /// 0 where there is none [m].
  double period(const int direction) const { return wraps(direction) ? upper[direction] - lower[direction] : 0; }
  double last_in(const int direction) const { return last.empty() ? 1 : last[direction]; }
  /// Of all cells but the last one, in graded directions of the longest one [m].
  double cell_length(int direction) const;
  /// Between neighbouring nodes, but for those of the last cell [m]. In graded directions of the two neighbouring cells of which the longer one is
  /// shortest, in that one: those that a coarser box joins first.
  double node_distance(int direction) const;
  /// Number of intervals between nodes.
  int intervals(const int direction) const { return cells[direction] * element.order_along(direction); }
};

/// Where cells end in a direction, cells + 1 numbers [m].
std::vector<double> cell_ends(const BoxOptions &options, int direction);

/// Fills `ends` of the directions in which `expansion` is not 1, by the number of cells n there, and empties it in the others:
///
///     x_k = lower + (upper - lower) (q^k - 1) / (q^n - 1),  q = expansion^(1/(n - 1))
void grade(BoxOptions &options);

/// Adds the box's parameters to a valid list.
void add_box_parameters(Teuchos::ParameterList &valid);

/// @throws rpc::Error (bad_input) on anything out of range
BoxOptions box_options(const Teuchos::ParameterList &list);

/// The next coarser box for multigrid. In the directions in which nodes are closest, up to 1.7 times the shortest distance, order 2 becomes
/// order 1 on the same cells; where it is 1 already, each two cells become one, and of an odd number the last three. Other directions
/// keep what they have, so that anisotropic cells become square ones first. In graded directions the same holds of pairs of cells: those longer than 1.7 times
/// the shortest distance stay. Where that makes a box thin (thin_direction()), but so it is too with only the
/// directions coarsened that come down to one interval between nodes, only they are. Functions of Q1 and Q2 boxes are among those of the finer one.
/// P2 becomes P1 where node distances are alike, else Q2 with the same nodes takes its place. None where no direction has more
/// than one interval. A direction in which the box is periodic keeps two cells at least.
std::optional<BoxOptions> coarsened(const BoxOptions &options);

/// Whether it repeats itself in some direction.
inline bool periodic(const BoxOptions &options)
{
  return options.periodic[0] || options.periodic[1] || options.periodic[2];
}

/// The longest node distance over the shortest one.
double stretch(const BoxOptions &options);

/// The same box in as many blocks as there are ranks, or in fewer, so that each has at least `least_nodes` nodes on average; in one block if the
/// box has fewer.
BoxOptions divided(BoxOptions options, int num_ranks, GO least_nodes);

/// The direction in which a box is one cell of order 1 and thinner than 1.7 times the shortest distance of nodes in the others; the
/// thinnest of several. A coarser box would be too stiff when it bends, so multigrid ends here.
std::optional<int> thin_direction(const BoxOptions &options);

/// Why a rank cannot have so many nodes; none if it can.
/// @param bytes  that a run takes for each node at least [B]   @param limit  [B]   @param what  "memory", "the GPU's memory"
std::optional<std::string> memory_refusal(GO nodes, double bytes, double limit, const std::string &what);

/// Makes this rank's part of a box; no communication of mesh data, and no rank holds the whole.
///
/// P1 and P2 cut each cell of the grid into two triangles, or six tetrahedra. Ranks form a grid of blocks chosen for the least number of shared cell faces. Sides are named left, right (x),
/// bottom, top (y), and in 3D back, front (z), corners after their sides, "left bottom" or "left bottom back". Node ids run over the lattice, x fastest.
/// Sides and corners in directions in which the box is periodic are none. Collective on comm.
/// @throws rpc::Error (bad_mesh) if there are fewer cells than ranks in every direction, (bad_input) if the mesh cannot fit in memory
Mesh make_box(const BoxOptions &options, const RCP<const Comm> &comm);

} // namespace rpc::mesh
