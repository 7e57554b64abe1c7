// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/lattice.hpp"

#include <cstddef>

namespace rpc::mesh
{

/// Numbers of a rank's nodes or cells that do not depend on the ranks, 0-based: a list, or a closed formula, as those of a box, which
/// takes no memory.
class Ids
{
public:
  Ids() = default;
  Ids(const HostView<GO *> &list)
      : size_(static_cast<GO>(list.extent(0))), list_(list) {} // a list is taken for its numbers
  /// Position by position of a block, in its order, x fastest in the whole lattice.
  /// @param extent  of the whole lattice   @param parts  numbers of each position, which follow each other
  Ids(const Block &owned, const Index &extent, const int parts)
      : size_(parts * owned.size()), owned_(owned), extent_(extent), parts_(parts)
  {
  }

  GO operator()(const GO n) const
  {
    return parts_ == 0 ? list_(n) : parts_ * in_lattice(owned_.at(n / parts_)) + n % parts_;
  }
  /// How many there are, as views say it.
  std::size_t extent(int) const { return static_cast<std::size_t>(size_); }
  std::size_t size() const { return static_cast<std::size_t>(size_); }
  /// Any number larger than all if there are none.
  GO smallest() const;
  /// All of them; of a formula a new list.
  HostView<GO *> list() const;

private:
  GO in_lattice(const Index &at) const { return at[0] + extent_[0] * (at[1] + extent_[1] * at[2]); }

  GO size_ = 0;
  HostView<GO *> list_;
  Block owned_;
  Index extent_{};
  int parts_ = 0; // 0: listed
};

} // namespace rpc::mesh
