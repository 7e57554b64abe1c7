// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/tpetra.hpp"

#include <cstddef>
#include <unordered_map>
#include <vector>

/// What is alike and is found once: cells, stars of vertices, rings of edges. On the host.
namespace rpc::bound
{

struct Kinds {
  DeviceView<int *> kind;
  DeviceView<LO *> example; ///< (kinds) one of each
};

/// Kinds of cells of one material whose vertices lie alike. They steer the descent alone, not the bound. Collective.
/// @param comm  of the mesh   @param coords  (nodes, dim)   @param cells  (cells, nodes), vertices first
Kinds kinds_of_cells(const Comm &comm, const DeviceView<double **> &coords, const DeviceView<LO **> &cells,
                     const DeviceView<int *> &block, int vertices);
/// Each is a kind of its own.
Kinds all_different(LO count);

/// Whether cells are so different that nothing made of them is looked for twice.
template <class Input>
bool all_differ(const Input &in)
{
  return 2 * in.example.extent(0) > static_cast<std::size_t>(in.num_cells());
}

/// Numbers of kinds by what tells them apart.
template <class Number>
class Found
{
public:
  /// @return the kind of item `number`, whose key is given
  int operator()(const std::vector<Number> &key, const LO number)
  {
    const auto [at, is_new] = found_.try_emplace(key, static_cast<int>(found_.size()));
    if (is_new) example.push_back(number);
    return at->second;
  }
  std::vector<LO> example; // (kinds)

private:
  struct Hash {
    std::size_t operator()(const std::vector<Number> &key) const
    {
      std::size_t hash = 14695981039346656037u; // of Fowler, Noll and Vo
      for (const Number k : key) hash = (hash ^ static_cast<std::size_t>(k)) * 1099511628211u;
      return hash ^ hash >> 32;
    }
  };
  std::unordered_map<std::vector<Number>, int, Hash> found_;
};

} // namespace rpc::bound
