// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/parts.hpp"

#include "point_text.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace rpc::fem
{
namespace
{

/// Joins the nodes of each cell, any number of cells at once: the root of a set is its smallest node, in whatever order sets
/// meet, for a root gives way to smaller ones only.
struct JoinNodes {
  DeviceView<LO **> cells; // (cells, nodes)     in
  DeviceView<LO *> parent; // (overlap nodes)    inout, of a root itself

  /// The root, as far as others have come; halves the way for those who follow.
  KOKKOS_FUNCTION LO find(LO n) const
  {
    for (LO next = parent(n); next != n;) {
      const LO after = parent(next);
      parent(n) = after;
      n = next;
      next = after;
    }
    return n;
  }
  KOKKOS_FUNCTION void join(LO a, LO b) const
  {
    a = find(a);
    b = find(b);
    while (a != b) {
      const LO large = a > b ? a : b, small = a > b ? b : a;
      const LO seen = Kokkos::atomic_compare_exchange(&parent(large), large, small);
      if (seen == large) return;
      a = find(seen); // somebody else has joined it, to a smaller node
      b = small;
    }
  }
  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    for (std::size_t a = 1; a < cells.extent(1); ++a) join(cells(cell, 0), cells(cell, a));
  }
};

/// Sets of nodes that cells of this rank join.
struct LocalSets {
  DeviceView<int *> of_node; ///< (overlap nodes) from 0, in the order of their smallest nodes
  int count = 0;
};

LocalSets local_sets(const mesh::Mesh &mesh)
{
  const LO n = mesh.num_local_nodes();
  const DeviceView<LO *> parent(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::parent"), n);
  Kokkos::parallel_for(
      "rpc::fem::nodes_alone", device_range(n), KOKKOS_LAMBDA(const LO i) { parent(i) = i; });
  Kokkos::parallel_for("rpc::fem::join_nodes", device_range(mesh.num_cells()), JoinNodes{mesh.cells, parent});
  for (LO moved = 1; moved > 0;) // every node to its root
    Kokkos::parallel_reduce(
        "rpc::fem::find_roots", device_range(n),
        KOKKOS_LAMBDA(const LO i, LO &count) {
          const LO next = parent(i), after = parent(next);
          if (next == after) return;
          parent(i) = after;
          ++count;
        },
        moved);
  LocalSets sets{DeviceView<int *>(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::part_of_node"), n)};
  const auto set = sets.of_node;
  Kokkos::parallel_scan(
      "rpc::fem::number_sets", device_range(n),
      KOKKOS_LAMBDA(const LO i, int &sum, const bool last) {
        if (parent(i) != i) return;
        if (last) set(i) = sum;
        ++sum;
      },
      sets.count);
  Kokkos::parallel_for(
      "rpc::fem::sets_of_nodes", device_range(n), KOKKOS_LAMBDA(const LO i) {
        if (parent(i) != i) set(i) = set(parent(i));
      });
  return sets;
}

/// Takes what other ranks know of the sets that reach this rank's ghost nodes.
/// @return whether there was something new
bool hear(const LO first, const LO end, const DeviceView<int *> &set, const Vector &heard,
          const DeviceView<double *> &smallest)
{
  const auto from = device_read(heard);
  LO changes = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::hear_of_sets", Kokkos::RangePolicy<ExecutionSpace, LO>(first, end),
      KOKKOS_LAMBDA(const LO n, LO &count) {
        if (from(n) < Kokkos::atomic_fetch_min(&smallest(set(n)), from(n))) ++count;
      },
      changes);
  return changes > 0;
}

/// nodes <- the numbers of their sets.
void tell(const DeviceView<int *> &set, const DeviceView<double *> &of_set, Vector &nodes)
{
  const auto to = device_write(nodes);
  Kokkos::parallel_for(
      "rpc::fem::tell_of_sets", device_range(static_cast<LO>(to.extent(0))),
      KOKKOS_LAMBDA(const LO n) { to(n) = of_set(set(n)); });
}

/// The smallest node id of the part that each local set of nodes belongs to; collective.
std::vector<GO> smallest_ids(const Discretization &d, const LocalSets &sets)
{
  const mesh::Mesh &mesh = *d.mesh;
  std::vector<GO> smallest(sets.count, std::numeric_limits<GO>::max());
  if (sets.count == 1) {
    smallest[0] = mesh.node_id.smallest();
  } else {
    const auto set = to_host(sets.of_node);
    for (LO n = 0; n < mesh.num_owned_nodes(); ++n) smallest[set(n)] = std::min(smallest[set(n)], mesh.node_id(n));
  }
  if (mesh.comm().getSize() == 1) return smallest;
  const std::vector<double> mine(smallest.begin(), smallest.end()); // doubles hold node ids exactly
  const auto known = device_values(mine, "rpc::fem::smallest_ids");
  Vector owned(mesh.owned_nodes);
  for (int changed = 1; changed;) {
    tell(sets.of_node, known, owned);
    const auto first = mesh.num_owned_nodes(), end = mesh.num_local_nodes();
    const bool heard = hear(first, end, sets.of_node, d.node_halo->at_columns(owned), known);
    changed = max_all(mesh.comm(), heard ? 1 : 0);
  }
  const auto now = to_host(known);
  for (int s = 0; s < sets.count; ++s) smallest[s] = static_cast<GO>(now(s));
  return smallest;
}

/// All different values over all ranks, ascending; collective. Each rank sends the parts that it has nodes of: a few numbers.
std::vector<GO> all_different(const Comm &comm, std::vector<GO> values)
{
  const auto sort = [&values] {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  };
  sort();
  values = gathered_by_all(comm, values);
  sort();
  return values;
}

/// Centre, radius, cells and blocks of the only part; collective.
Part whole_body(const mesh::Mesh &mesh)
{
  const auto coords = mesh.coords;
  const int dim = mesh.dim();
  Part body;
  body.num_cells = sum_all(mesh.comm(), GO(mesh.num_owned_cells));
  const double num_nodes = static_cast<double>(mesh.owned_nodes->getGlobalNumElements());
  for (int c = 0; c < dim; ++c) {
    double sum = 0;
    Kokkos::parallel_reduce(
        "rpc::fem::centre_of_body", device_range(mesh.num_owned_nodes()),
        KOKKOS_LAMBDA(const LO n, double &part) { part += coords(n, c); }, sum);
    body.centre[c] = sum_all(mesh.comm(), sum) / num_nodes;
  }
  const Kokkos::Array<double, 3> centre{{body.centre[0], body.centre[1], body.centre[2]}};
  double farthest = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::radius_of_body", device_range(mesh.num_owned_nodes()),
      KOKKOS_LAMBDA(const LO n, double &most) {
        double squares = 0;
        for (int c = 0; c < dim; ++c) squares += (coords(n, c) - centre[c]) * (coords(n, c) - centre[c]);
        if (squares > most) most = squares;
      },
      Kokkos::Max<double>(farthest));
  body.radius = std::sqrt(max_all(mesh.comm(), std::max(0., farthest)));

  const auto block = mesh.block;
  const DeviceView<int *> occurs("rpc::fem::block_occurs", mesh.blocks.size());
  Kokkos::parallel_for(
      "rpc::fem::blocks_of_body", device_range(mesh.num_owned_cells),
      KOKKOS_LAMBDA(const LO cell) { occurs(block(cell)) = 1; }); // the same from all threads
  const auto mine = to_host(occurs);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    if (max_all(mesh.comm(), mine(b)) > 0) body.blocks.push_back(static_cast<int>(b));
  return body;
}

/// The same of each of several parts, one after the other on the host; collective.
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
  sums = summed(mesh.comm(), sums);
  for (std::size_t p = 0; p < num_parts; ++p)
    for (int c = 0; c < dim; ++c) parts[p].centre[c] = sums[4 * p + c] / sums[4 * p + 3];
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    const Point &centre = parts[part_of_node[n]].centre;
    double squares = 0;
    for (int c = 0; c < dim; ++c) squares += (coords(n, c) - centre[c]) * (coords(n, c) - centre[c]);
    radius[part_of_node[n]] = std::max(radius[part_of_node[n]], squares);
  }
  radius = largest(mesh.comm(), radius);
  const auto cells = to_host(mesh.cells);
  const auto block = to_host(mesh.block);
  std::vector<GO> num_cells(num_parts * num_blocks, 0);
  for (LO cell = 0; cell < mesh.num_owned_cells; ++cell)
    ++num_cells[part_of_node[cells(cell, 0)] * num_blocks + block(cell)];
  num_cells = summed(mesh.comm(), num_cells);
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
  const LocalSets sets = local_sets(mesh);
  Parts parts;
  parts.of_node = sets.of_node;
  if (sets.count == 1 && mesh.comm().getSize() == 1) {
    parts.part.push_back(whole_body(mesh));
  } else {
    const std::vector<GO> smallest = smallest_ids(d, sets);
    const std::vector<GO> ids = all_different(mesh.comm(), smallest);
    parts.part.resize(ids.size());
    if (ids.size() == 1) {
      Kokkos::deep_copy(parts.of_node, 0);
      parts.part[0] = whole_body(mesh);
    } else {
      const auto set = to_host(sets.of_node);
      std::vector<int> part_of_node(set.extent(0));
      for (std::size_t n = 0; n < part_of_node.size(); ++n)
        part_of_node[n] = static_cast<int>(std::lower_bound(ids.begin(), ids.end(), smallest[set(n)]) - ids.begin());
      describe_parts(mesh, part_of_node, parts.part);
      parts.of_node = device_values(part_of_node, "rpc::fem::part_of_node");
    }
  }
  const int num_parts = parts.size();
  parts.centre = DeviceView<double **>("rpc::fem::part_centre", num_parts, mesh.dim());
  parts.radius = DeviceView<double *>("rpc::fem::part_radius", num_parts);
  const auto centre = Kokkos::create_mirror_view(parts.centre);
  const auto radius = Kokkos::create_mirror_view(parts.radius);
  for (int p = 0; p < num_parts; ++p) {
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
