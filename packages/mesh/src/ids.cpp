// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/ids.hpp"

#include <algorithm>
#include <limits>

namespace rpc::mesh
{

GO Ids::smallest() const
{
  if (size_ == 0) return std::numeric_limits<GO>::max();
  return parts_ == 0 ? *std::min_element(list_.data(), list_.data() + size_) : (*this)(0); // the lowest corner
}

HostView<GO *> Ids::list() const
{
  if (parts_ == 0) return list_;
  HostView<GO *> ids(Kokkos::view_alloc("rpc::mesh::ids", Kokkos::WithoutInitializing), size_);
  GO *next = ids.data();
  const int fast = owned_.axes[0], mid = owned_.axes[1], slow = owned_.axes[2];
  Index at{};
  for (at[slow] = owned_.begin[slow]; at[slow] < owned_.end[slow]; ++at[slow])
    for (at[mid] = owned_.begin[mid]; at[mid] < owned_.end[mid]; ++at[mid])
      for (at[fast] = owned_.begin[fast]; at[fast] < owned_.end[fast]; ++at[fast])
        for (int part = 0; part < parts_; ++part) *next++ = parts_ * in_lattice(at) + part;
  return ids;
}

} // namespace rpc::mesh
