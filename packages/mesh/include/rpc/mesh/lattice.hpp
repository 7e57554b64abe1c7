// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/tpetra.hpp"

namespace rpc::mesh
{

/// A position on the lattice of cells or nodes; absent dimensions are 0. (Kokkos 3.4 takes a view of Kokkos::Array for
/// a view of one more dimension, hence no Kokkos::Array here.)
struct Index {
  GO along[3];
  KOKKOS_INLINE_FUNCTION GO &operator[](const int d) { return along[d]; }
  KOKKOS_INLINE_FUNCTION GO operator[](const int d) const { return along[d]; }
};

/// A block of lattice positions, [begin, end) in each direction, in the storage order of this mesh.
struct Block {
  Index begin{}, end{};
  Kokkos::Array<int, 3> axes{}; // from the fastest running one to the slowest

  KOKKOS_INLINE_FUNCTION GO size() const { return (end[0] - begin[0]) * (end[1] - begin[1]) * (end[2] - begin[2]); }
  KOKKOS_INLINE_FUNCTION bool contains(const Index &at) const
  {
    for (int d = 0; d < 3; ++d)
      if (at[d] < begin[d] || at[d] >= end[d]) return false;
    return true;
  }
  KOKKOS_INLINE_FUNCTION GO index_of(const Index &at) const
  {
    GO index = 0;
    for (int s = 2; s >= 0; --s) {
      const int d = axes[s];
      index = index * (end[d] - begin[d]) + (at[d] - begin[d]);
    }
    return index;
  }
  KOKKOS_INLINE_FUNCTION Index at(GO index) const
  {
    Index position{};
    for (int s = 0; s < 3; ++s) {
      const int d = axes[s];
      position[d] = begin[d] + index % (end[d] - begin[d]);
      index /= end[d] - begin[d];
    }
    return position;
  }
};

} // namespace rpc::mesh
