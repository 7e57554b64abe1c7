// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/bounds.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/rigid_motion.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

/// Pieces of a body: sets of cells that are joined over facets. Private to require_stiff_joints().
namespace rpc::fem
{

/// Sets that join.
class Sets
{
public:
  explicit Sets(const int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int find(int n)
  {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(const int a, const int b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }
  /// (items) the number of each one's set, from 0.
  std::vector<int> numbers()
  {
    std::vector<int> number(parent_.size());
    int count = 0;
    for (int n = 0; n < static_cast<int>(parent_.size()); ++n) number[n] = find(n) == n ? count++ : number[find(n)];
    return number;
  }

private:
  std::vector<int> parent_; // of a root itself; others come after theirs
};

/// How many sets there are.
inline int count_of(const std::vector<int> &numbers)
{
  return numbers.empty() ? 0 : 1 + *std::max_element(numbers.begin(), numbers.end());
}

/// Centre and radius of a box about pieces.
Part frame_of(const Bounds &bounds);

/// A force of size 1 at a place, along one piece's modes.
RigidMotion row_at(const double *x, int direction, const Part &frame, int dim);

/// The same force and moment along the modes of another frame.
RigidMotion moved(const RigidMotion &row, const Part &from, const Part &to, int dim);

/// What ranks know of their pieces; lists of all ranks, on rank 0 alone, name pieces over all ranks.
struct Pieces {
  std::vector<GO> num_cells;    // (pieces) owned
  std::vector<double> box;      // (pieces, 6) lower, upper ends of its local cells [m]
  std::vector<GO> same;         // (pairs, 2) names of one piece on two ranks
  std::vector<GO> joined;       // (joints, 2) pieces
  std::vector<double> joint;    // (joints, dim) [m]
  std::vector<GO> held;         // (rows) piece
  std::vector<double> held_row; // (rows, 6) along the modes of the piece's box on that rank

  Bounds box_of(const std::size_t piece) const
  {
    const double *const end = &box[6 * piece];
    return {{end[0], end[1], end[2]}, {end[3], end[4], end[5]}};
  }
};

/// Collective.
Pieces pieces_of(const Discretization &d, const DirichletDofs &dirichlet);

} // namespace rpc::fem
