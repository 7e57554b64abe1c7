// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>
#include <utility>
#include <vector>

namespace rpc::mesh
{

/// Disjoint sets of numbers 0, 1, ..., each of which is like the representative of its set or its opposite. (Union by size with path halving;
/// R. E. Tarjan, 1975.)
class ParitySets
{
public:
  struct Found {
    int root; ///< representative
    bool odd; ///< whether the number is its opposite
  };

  explicit ParitySets(const int size) : parent_(size), size_(size, 1), odd_(size, 0)
  {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  Found find(int n)
  {
    bool odd = false;
    while (parent_[n] != n) {
      const int above = parent_[n];
      odd_[n] ^= odd_[above]; // the representative's own is 0
      parent_[n] = parent_[above];
      odd = odd != (odd_[n] != 0);
      n = parent_[n];
    }
    return {n, odd};
  }
  /// @param opposite  whether the two are each other's opposite   @return whether that fits what was known
  bool join(const int a, const int b, const bool opposite)
  {
    Found x = find(a), y = find(b);
    if (x.root == y.root) return (x.odd != y.odd) == opposite;
    if (size_[x.root] < size_[y.root]) std::swap(x, y);
    parent_[y.root] = x.root;
    size_[x.root] += size_[y.root];
    odd_[y.root] = (x.odd != y.odd) != opposite ? 1 : 0;
    return true;
  }

private:
  std::vector<int> parent_, size_;
  std::vector<char> odd_; // against the parent
};

} // namespace rpc::mesh
