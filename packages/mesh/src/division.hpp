#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <cstddef>
#include <vector>

/// Division of a whole mesh among ranks; private to distribute().
namespace rpc::mesh
{

/// Lists of numbers one behind the other: list i is value[begin[i]] .. value[begin[i + 1] - 1].
struct Lists {
  std::vector<std::size_t> begin{0};
  std::vector<int> value;

  int size() const { return static_cast<int>(begin.size()) - 1; }
  int size_of(const int list) const { return static_cast<int>(begin[list + 1] - begin[list]); }
  int *first(const int list) { return value.data() + begin[list]; }
  int *last(const int list) { return value.data() + begin[list + 1]; }
  const int *first(const int list) const { return value.data() + begin[list]; }
  const int *last(const int list) const { return value.data() + begin[list + 1]; }
};

/// Who holds what of a whole mesh.
struct Division {
  std::vector<int> node_owner; // (nodes) rank
  std::vector<int> gid;        // (nodes)
  Lists nodes;                 // of each rank, by gid
  Lists cells;                 // of each rank
  Lists halo;                  // of each rank: cells of others that touch its nodes
};

/// METIS' cut, and the order of each rank's nodes; on one rank by itself.
/// @throws rpc::Error (bad_mesh) if there are fewer cells than ranks
Division divide(const MeshData &whole, int num_ranks);

} // namespace rpc::mesh
