#include "rpc/fem/parts.hpp"

#include "numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace rpc::fem
{
namespace
{

/// Sets of nodes that cells have joined.
class DisjointSets
{
public:
  explicit DisjointSets(const LO size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  LO find(LO n)
  {
    for (; parent_[n] != n; n = parent_[n]) parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(const LO a, const LO b)
  {
    const LO first = find(a), second = find(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

private:
  std::vector<LO> parent_;
};

/// The set of each local node, 0-based.
std::vector<int> local_sets(const mesh::Mesh &mesh)
{
  const auto cells = to_host(mesh.cells);
  DisjointSets sets(mesh.num_local_nodes());
  for (LO cell = 0; cell < mesh.num_cells(); ++cell)
    for (std::size_t a = 1; a < cells.extent(1); ++a) sets.join(cells(cell, 0), cells(cell, a));
  std::vector<int> set(mesh.num_local_nodes());
  int count = 0;
  for (LO n = 0; n < mesh.num_local_nodes(); ++n) { // the smallest node of a set is its root
    const LO root = sets.find(n);
    set[n] = root == n ? count++ : set[root];
  }
  return set;
}

/// The smallest node id of the part that each local set of nodes belongs to; collective.
std::vector<GO> smallest_ids(const Discretization &d, const std::vector<int> &set)
{
  const mesh::Mesh &mesh = *d.mesh;
  const int dim = d.dim(), num_sets = set.empty() ? 0 : 1 + *std::max_element(set.begin(), set.end());
  std::vector<GO> smallest(num_sets, std::numeric_limits<GO>::max());
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) smallest[set[n]] = std::min(smallest[set[n]], mesh.node_id(n));
  if (mesh.comm().getSize() == 1) return smallest;
  Vector owned(d.owned_dofs), overlap(d.overlap_dofs); // doubles hold node ids exactly
  for (int changed = 1; changed; changed = max_all(mesh.comm(), changed)) {
    changed = 0;
    {
      const auto to = owned.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
        for (int c = 0; c < dim; ++c) to(dim * n + c, 0) = static_cast<double>(smallest[set[n]]);
    }
    overlap.doImport(owned, *d.dof_import, Tpetra::INSERT);
    const auto from = overlap.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = mesh.num_owned_nodes(); n < mesh.num_local_nodes(); ++n) {
      const GO heard = static_cast<GO>(from(dim * n, 0));
      if (heard >= smallest[set[n]]) continue;
      smallest[set[n]] = heard;
      changed = 1;
    }
  }
  return smallest;
}

/// All different values over all ranks, ascending; collective.
std::vector<GO> all_different(const Comm &comm, std::vector<GO> values)
{
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (comm.getSize() > 1) {
    const int longest = max_all(comm, static_cast<int>(values.size()));
    if (longest == 0) return {};
    values.resize(longest, std::numeric_limits<GO>::max());
    std::vector<GO> all(static_cast<std::size_t>(longest) * comm.getSize());
    Teuchos::gatherAll(comm, longest, values.data(), static_cast<int>(all.size()), all.data());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (all.back() == std::numeric_limits<GO>::max()) all.pop_back();
    return all;
  }
  return values;
}

template <class T>
void reduce(const Comm &comm, const Teuchos::EReductionType type, std::vector<T> &values)
{
  const std::vector<T> mine = values;
  Teuchos::reduceAll(comm, type, static_cast<int>(mine.size()), mine.data(), values.data());
}

/// Centre, radius, cells and blocks of each part; collective.
void describe_parts(const mesh::Mesh &mesh, const std::vector<int> &part_of_node, std::vector<Part> &parts)
{
  const std::size_t num_parts = parts.size(), num_blocks = mesh.blocks.size();
  const int dim = mesh.dim();
  const auto coords = to_host(mesh.coords);
  std::vector<double> sums(num_parts * 4, 0.), radius(num_parts, 0.);
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    double *const sum = &sums[4 * part_of_node[n]];
    for (int c = 0; c < dim; ++c) sum[c] += coords(n, c);
    sum[3] += 1;
  }
  reduce(mesh.comm(), Teuchos::REDUCE_SUM, sums);
  for (std::size_t p = 0; p < num_parts; ++p)
    for (int c = 0; c < dim; ++c) parts[p].centre[c] = sums[4 * p + c] / sums[4 * p + 3];
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    const Point &centre = parts[part_of_node[n]].centre;
    double squares = 0;
    for (int c = 0; c < dim; ++c) squares += (coords(n, c) - centre[c]) * (coords(n, c) - centre[c]);
    radius[part_of_node[n]] = std::max(radius[part_of_node[n]], squares);
  }
  reduce(mesh.comm(), Teuchos::REDUCE_MAX, radius);
  const auto cells = to_host(mesh.cells);
  const auto block = to_host(mesh.block);
  std::vector<GO> num_cells(num_parts * num_blocks, 0);
  for (LO cell = 0; cell < mesh.num_owned_cells; ++cell)
    ++num_cells[part_of_node[cells(cell, 0)] * num_blocks + block(cell)];
  reduce(mesh.comm(), Teuchos::REDUCE_SUM, num_cells);
  for (std::size_t p = 0; p < num_parts; ++p) {
    parts[p].radius = std::sqrt(radius[p]);
    for (std::size_t b = 0; b < num_blocks; ++b) {
      const GO count = num_cells[p * num_blocks + b];
      parts[p].num_cells += count;
      if (count > 0) parts[p].blocks.push_back(static_cast<int>(b));
    }
  }
}

} // namespace

Parts connected_parts(const Discretization &d)
{
  const mesh::Mesh &mesh = *d.mesh;
  std::vector<int> part_of_node = local_sets(mesh);
  const std::vector<GO> smallest = smallest_ids(d, part_of_node);
  const std::vector<GO> ids = all_different(mesh.comm(), smallest);
  for (int &part : part_of_node)
    part = static_cast<int>(std::lower_bound(ids.begin(), ids.end(), smallest[part]) - ids.begin());
  Parts parts;
  parts.part.resize(ids.size());
  describe_parts(mesh, part_of_node, parts.part);

  HostView<int *> of_node("rpc::fem::part_of_node", part_of_node.size());
  std::copy(part_of_node.begin(), part_of_node.end(), of_node.data());
  parts.of_node = to_device(of_node);
  parts.centre = DeviceView<double **>("rpc::fem::part_centre", ids.size(), mesh.dim());
  parts.radius = DeviceView<double *>("rpc::fem::part_radius", ids.size());
  const auto centre = Kokkos::create_mirror_view(parts.centre);
  const auto radius = Kokkos::create_mirror_view(parts.radius);
  for (int p = 0; p < parts.size(); ++p) {
    for (int c = 0; c < mesh.dim(); ++c) centre(p, c) = parts.part[p].centre[c];
    radius(p) = parts.part[p].radius;
  }
  Kokkos::deep_copy(parts.centre, centre);
  Kokkos::deep_copy(parts.radius, radius);
  return parts;
}

std::string name_of(const mesh::Mesh &mesh, const Parts &parts, const int part)
{
  if (parts.size() == 1) return "the body";
  const Part &p = parts.part[part];
  std::ostringstream text;
  text << "the part in block" << (p.blocks.size() > 1 ? "s" : "");
  for (std::size_t b = 0; b < p.blocks.size(); ++b)
    text << (b > 0 ? ", \"" : " \"") << mesh.blocks[p.blocks[b]] << "\"";
  text << " (" << p.num_cells << (p.num_cells == 1 ? " cell" : " cells") << " around "
       << point_text(p.centre, mesh.dim(), p.radius) << ")";
  return text.str();
}

} // namespace rpc::fem
