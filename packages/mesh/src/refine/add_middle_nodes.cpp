// SPDX-License-Identifier: BSD-3-Clause
#include "add_middle_nodes.hpp"

#include "boundary_places.hpp"
#include "middles.hpp"
#include "routed.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <array>
#include <optional>

namespace rpc::mesh
{
namespace
{

/// The nodes of the mesh of order 2 before they are numbered: those of the coarse mesh, then the middles, kind by kind.
struct NewMesh {
  std::vector<int> first; ///< (kinds of middles) number of the first of each
  std::vector<char> owned, moved;
  std::vector<GO> id;
  std::vector<double> coords;
  std::vector<int> cells;
  std::vector<GO> gid;

  int size() const { return static_cast<int>(owned.size()); }
};

using HostRange = Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, int>;
using CellIds = std::array<GO, 8>; // of a cell's vertices, ascending; unused ones are 0

std::vector<CellIds> ids_of_cells(const LocalMesh &mesh)
{
  const int width = mesh.element.num_vertices();
  std::vector<CellIds> ids(mesh.num_cells());
  Kokkos::parallel_for("rpc::mesh::ids_of_cells", HostRange(0, mesh.num_cells()), [&](const int c) {
    for (int a = 0; a < width; ++a) ids[c][a] = mesh.id[mesh.nodes_of(c)[a]];
    std::sort(ids[c].begin(), ids[c].begin() + width);
  });
  return ids;
}

/// The place of a node that several cells share is that of the one with the lowest ids, whatever the number of ranks: cells differ in the last
/// digits.
void add_places(const LocalMesh &mesh, const Middles &middles, const NewPlaces &place, const std::vector<CellIds> &ids,
                std::vector<double> &coords)
{
  const int dim = mesh.dim();
  std::vector<int> cell(middles.size(), -1);
  for (int c = 0; c < mesh.num_cells(); ++c)
    for (int e = 0; e < middles.per_cell; ++e) {
      const int m = middles.of(c)[e];
      if (m >= 0 && (cell[m] < 0 || ids[c] < ids[cell[m]])) cell[m] = c;
    }
  coords.assign(std::size_t(dim) * middles.size(), 0);
  Kokkos::parallel_for("rpc::mesh::new_places", HostRange(0, middles.size()), [&](const int m) {
    if (cell[m] < 0 || middles.owner_vertex(m) >= mesh.num_owned_nodes()) return;
    double *const x = &coords[std::size_t(dim) * m];
    if (place) {
      const int *const of_cell = middles.of(cell[m]);
      place(cell[m], middles.slot[std::find(of_cell, of_cell + middles.per_cell, m) - of_cell], x);
      return;
    }
    for (int v = 0; v < middles.width; ++v)
      for (int d = 0; d < dim; ++d)
        x[d] += mesh.coords[std::size_t(dim) * middles.vertices_of(m)[v] + d] / middles.width;
  });
}

/// Collective.
NewMesh new_mesh(const LocalMesh &mesh, const std::vector<Middles> &kinds, const NewPlaces &place,
                 const std::string &file)
{
  std::vector<std::vector<double>> coords(kinds.size());
  std::vector<std::vector<char>> moved(kinds.size());
  const std::vector<CellIds> ids = ids_of_cells(mesh);
  for (std::size_t k = 0; k < kinds.size(); ++k) add_places(mesh, kinds[k], place, ids, coords[k]);
  move_to_boundary(mesh, kinds, file, coords, moved);

  NewMesh made;
  made.id = mesh.id;
  made.coords = mesh.coords;
  made.moved = mesh.moved;
  for (int n = 0; n < mesh.num_nodes(); ++n) made.owned.push_back(n < mesh.num_owned_nodes() ? 1 : 0);
  GO next_id = static_cast<GO>(mesh.owned_nodes->getGlobalNumElements());
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    made.first.push_back(made.size());
    const std::vector<GO> new_ids = ids_of(mesh, kinds[k], next_id);
    made.id.insert(made.id.end(), new_ids.begin(), new_ids.end());
    made.coords.insert(made.coords.end(), coords[k].begin(), coords[k].end());
    made.moved.insert(made.moved.end(), moved[k].begin(), moved[k].end());
    for (const GO id : new_ids) made.owned.push_back(id >= 0 ? 1 : 0);
  }
  const int width = Element{mesh.dim(), 2, mesh.element.shape}.num_nodes(), vertices = mesh.element.num_nodes();
  made.cells.resize(std::size_t(width) * mesh.num_cells());
  for (int c = 0; c < mesh.num_cells(); ++c) {
    int *const nodes = &made.cells[std::size_t(width) * c];
    std::copy_n(mesh.nodes_of(c), vertices, nodes);
    for (std::size_t k = 0; k < kinds.size(); ++k)
      for (int e = 0; e < kinds[k].per_cell; ++e) {
        const int m = kinds[k].of(c)[e];
        nodes[kinds[k].slot[e]] = m < 0 ? -1 : made.first[k] + m;
      }
  }
  return made;
}

/// Questions for the nodes of other ranks: rows of the kind (-1: a node of the coarse mesh), the gid of the node or first vertex, and
/// the ids of the other vertices.
struct Questions {
  int width = 2;
  std::vector<int> node, rank;
  std::vector<double> rows;
};

Questions questions(const LocalMesh &mesh, const std::vector<Middles> &kinds, const NewMesh &made)
{
  Questions asked;
  for (const Middles &middles : kinds) asked.width = std::max(asked.width, middles.width + 1);
  std::vector<GO> gids;
  const auto ask = [&](const int node, const int kind, const int first) {
    asked.node.push_back(node);
    gids.push_back(mesh.gid[first]);
    asked.rows.insert(asked.rows.end(), {static_cast<double>(kind), static_cast<double>(mesh.gid[first])});
    asked.rows.resize(std::size_t(asked.width) * asked.node.size(), -1);
  };
  for (int n = mesh.num_owned_nodes(); n < mesh.num_nodes(); ++n) ask(n, -1, n);
  for (std::size_t k = 0; k < kinds.size(); ++k)
    for (int m = 0; m < kinds[k].size(); ++m) {
      if (made.owned[made.first[k] + m]) continue;
      ask(made.first[k] + m, static_cast<int>(k), kinds[k].owner_vertex(m));
      double *const row = &asked.rows[std::size_t(asked.width) * (asked.node.size() - 1)];
      for (int v = 1; v < kinds[k].width; ++v) row[v + 1] = static_cast<double>(mesh.id[kinds[k].vertices_of(m)[v]]);
    }
  asked.rank = owners_of(mesh, gids);
  return asked;
}

/// The node that another rank asks for; -1: there is none.
int asked_node(const LocalMesh &mesh, const std::vector<Middles> &kinds, const NewMesh &made, const double *const row)
{
  const int kind = static_cast<int>(row[0]), first = mesh.owned_nodes->getLocalElement(static_cast<GO>(row[1]));
  if (kind < 0) return first;
  const Middles &middles = kinds[kind];
  for (int k = 0; k < middles.at_vertex.size_of(first); ++k) {
    const int m = middles.at_vertex.first(first)[k];
    bool same = true;
    for (int v = 1; v < middles.width; ++v)
      same = same && static_cast<double>(mesh.id[middles.vertices_of(m)[v]]) == row[v + 1];
    if (same) return made.first[kind] + m;
  }
  return -1;
}

/// Gets gids, ids and places of other ranks' nodes; collective.
void ask_others(const LocalMesh &mesh, const std::vector<Middles> &kinds, NewMesh &made)
{
  const Comm &comm = *mesh.owned_nodes->getComm();
  const Questions asked = questions(mesh, kinds, made);
  const Routed routed(comm, asked.rank);
  const std::vector<double> received = routed.forward(asked.rows, asked.width);
  const int dim = mesh.dim(), width = 3 + dim;
  std::vector<double> answers;
  std::optional<std::string> missing;
  for (int k = 0; k < routed.num_received(); ++k) {
    int node = asked_node(mesh, kinds, made, &received[std::size_t(asked.width) * k]);
    if (node < 0) {
      missing = "mesh: refinement: a rank lacks an edge, face or cell that another one has at its node";
      node = 0;
    }
    answers.insert(answers.end(), {static_cast<double>(made.gid[node]), static_cast<double>(made.id[node]),
                                   static_cast<double>(made.moved[node])});
    for (int d = 0; d < dim; ++d) answers.push_back(made.coords[std::size_t(dim) * node + d]);
  }
  throw_if_any(comm, ExitCode::internal_error, missing);
  const std::vector<double> got = routed.back(answers, width);
  for (std::size_t k = 0; k < asked.node.size(); ++k) {
    const double *const row = &got[width * k];
    const int node = asked.node[k];
    made.gid[node] = static_cast<GO>(row[0]);
    made.id[node] = static_cast<GO>(row[1]);
    made.moved[node] = static_cast<char>(row[2]);
    for (int d = 0; d < dim; ++d) made.coords[std::size_t(dim) * node + d] = row[3 + d];
  }
}

/// Numbers the owned nodes as cells meet them, and has the others' numbers from their owners. Collective.
/// @return (nodes) lids: owned ones first, others by their gids
std::vector<int> number_nodes(const LocalMesh &mesh, const std::vector<Middles> &kinds, NewMesh &made,
                              RCP<const Map> &owned_nodes)
{
  std::vector<int> lid(made.size(), -1);
  int num_owned = 0;
  for (const int node : made.cells)
    if (node >= 0 && made.owned[node] && lid[node] < 0) lid[node] = num_owned++;
  const auto &comm = mesh.owned_nodes->getComm();
  owned_nodes = rcp(new Map(Teuchos::OrdinalTraits<GO>::invalid(), static_cast<std::size_t>(num_owned), 0, comm));
  const GO first = sum_before(*comm, static_cast<GO>(num_owned));
  made.gid.assign(made.size(), -1);
  for (int n = 0; n < made.size(); ++n)
    if (lid[n] >= 0) made.gid[n] = first + lid[n];
  if (comm->getSize() == 1) return lid;
  ask_others(mesh, kinds, made);
  std::vector<std::pair<GO, int>> others;
  for (int n = 0; n < made.size(); ++n)
    if (!made.owned[n]) others.emplace_back(made.gid[n], n);
  std::sort(others.begin(), others.end());
  for (std::size_t k = 0; k < others.size(); ++k) lid[others[k].second] = num_owned + static_cast<int>(k);
  return lid;
}

} // namespace

LocalMesh with_middle_nodes(const LocalMesh &mesh, const std::vector<Middles> &kinds, const NewPlaces &place,
                            const std::string &file)
{
  NewMesh made = new_mesh(mesh, kinds, place, file);
  LocalMesh whole;
  whole.element = {mesh.dim(), 2, mesh.element.shape};
  const std::vector<int> lid = number_nodes(mesh, kinds, made, whole.owned_nodes);
  const int dim = mesh.dim();
  whole.gid.resize(made.size());
  whole.id.resize(made.size());
  whole.moved.resize(made.size());
  whole.coords.resize(made.coords.size());
  for (int n = 0; n < made.size(); ++n) {
    whole.gid[lid[n]] = made.gid[n];
    whole.id[lid[n]] = made.id[n];
    whole.moved[lid[n]] = made.moved[n];
    std::copy_n(&made.coords[std::size_t(dim) * n], dim, &whole.coords[std::size_t(dim) * lid[n]]);
  }
  for (const int node : made.cells) whole.cells.push_back(node < 0 ? -1 : lid[node]);
  whole.block = mesh.block;
  whole.cell_id = mesh.cell_id;
  whole.sides = mesh.sides;
  whole.geometry = mesh.geometry;
  for (const PointData &set : mesh.points) {
    PointData mine{set.name, {}};
    for (const int node : set.node) mine.node.push_back(lid[node]);
    std::sort(mine.node.begin(), mine.node.end());
    whole.points.push_back(mine);
  }
  whole.parent = mesh.parent;
  whole.kind = mesh.kind;
  whole.child_vertices = mesh.child_vertices;
  return whole;
}

} // namespace rpc::mesh
