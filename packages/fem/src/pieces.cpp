// SPDX-License-Identifier: BSD-3-Clause
#include "pieces.hpp"

#include "pinched_nodes.hpp"
#include "rpc/core/exchange.hpp"
#include "rpc/core/parallel.hpp"

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace rpc::fem
{

Part frame_of(const Bounds &bounds)
{
  Part part;
  double squares = 0;
  for (int c = 0; c < 3; ++c) {
    part.centre[c] = (bounds.lower[c] + bounds.upper[c]) / 2;
    squares += std::pow((bounds.upper[c] - bounds.lower[c]) / 2, 2);
  }
  part.radius = std::sqrt(squares);
  return part;
}

RigidMotion row_at(const double *const x, const int direction, const Part &frame, const int dim)
{
  double arm[3] = {0, 0, 0}, unit[3] = {0, 0, 0};
  for (int c = 0; c < dim; ++c) arm[c] = (x[c] - frame.centre[c]) / frame.radius;
  unit[direction] = 1;
  RigidMotion row{};
  along_modes(dim, arm, unit, row.data());
  return row;
}

RigidMotion moved(const RigidMotion &row, const Part &from, const Part &to, const int dim)
{
  double arm[3] = {0, 0, 0}, force[3] = {0, 0, 0};
  for (int c = 0; c < dim; ++c) {
    arm[c] = (from.centre[c] - to.centre[c]) / to.radius;
    force[c] = row[c];
  }
  RigidMotion result{};
  along_modes(dim, arm, force, result.data());
  for (int k = dim; k < 6; ++k) result[k] += row[k] * from.radius / to.radius;
  return result;
}

namespace
{

/// (local cells) the piece of each, by facets that they share on this rank.
template <class Cells>
std::vector<int> local_pieces(const mesh::Mesh &mesh, const Cells &cells)
{
  const mesh::Element &element = mesh.element;
  const int width = num_facet_vertices(element);
  Sets sets(mesh.num_cells());
  std::map<std::vector<LO>, LO> first;
  for (LO cell = 0; cell < mesh.num_cells(); ++cell)
    for (const auto &facet : element.facets()) {
      std::vector<LO> key;
      for (int a = 0; a < width; ++a) key.push_back(cells(cell, facet[a]));
      std::sort(key.begin(), key.end());
      const auto [other, fresh] = first.emplace(key, cell);
      if (!fresh) sets.join(other->second, cell);
    }
  return sets.numbers();
}

/// Cells that several ranks have: gids of the vertices, ascending, and the piece on this rank.
using SharedCells = std::map<std::vector<GO>, GO>;

/// (pairs, 2) Names of one piece on two ranks: the rank that owns a shared cell's least node is asked for its name; collective.
std::vector<GO> same_pieces(const mesh::Mesh &mesh, const SharedCells &cells)
{
  const Comm &comm = mesh.comm();
  const int vertices = mesh.element.num_vertices();
  std::vector<GO> least;
  for (const auto &[key, piece] : cells) least.push_back(key.front());
  std::vector<int> owner(least.size());
  mesh.owned_nodes->getRemoteIndexList(Teuchos::ArrayView<const GO>(least), Teuchos::ArrayView<int>(owner));
  std::vector<int> counts(comm.getSize());
  std::multimap<int, const SharedCells::value_type *> asked; // by rank
  std::size_t next = 0;
  for (const auto &cell : cells) {
    const int rank = owner[next++];
    asked.emplace(rank, &cell);
    ++counts[rank];
  }
  std::vector<double> keys; // doubles hold gids exactly
  for (const auto &[rank, cell] : asked) keys.insert(keys.end(), cell->first.begin(), cell->first.end());
  const Exchange exchange(comm, counts);
  const std::vector<double> got = exchange.forward(keys, vertices);
  std::vector<double> names;
  for (std::size_t k = 0; k < got.size(); k += vertices) {
    std::vector<GO> key;
    for (int a = 0; a < vertices; ++a) key.push_back(static_cast<GO>(got[k + a]));
    names.push_back(static_cast<double>(cells.at(key)));
  }
  const std::vector<double> theirs = exchange.back(names, 1);
  std::set<std::array<GO, 2>> pairs;
  next = 0;
  for (const auto &[rank, cell] : asked) pairs.insert({cell->second, static_cast<GO>(theirs[next++])});
  std::vector<GO> result;
  for (const auto &pair : pairs) result.insert(result.end(), pair.begin(), pair.end());
  return result;
}

} // namespace

Pieces pieces_of(const Discretization &d, const DirichletDofs &dirichlet)
{
  const mesh::Mesh &mesh = *d.mesh;
  const Comm &comm = mesh.comm();
  const int dim = d.dim(), width = mesh.element.num_nodes(), vertices = mesh.element.num_vertices();
  const auto cells = to_host(mesh.cells);
  const auto coords = to_host(mesh.coords);
  const auto fixed = to_host(dirichlet.fixed);
  const auto group = to_host(dirichlet.tied ? dirichlet.tied->group : DeviceView<int *>());
  const auto row = to_host(d.node_to_cells.row);
  const auto around = to_host(d.node_to_cells.cell);
  const std::vector<int> piece = local_pieces(mesh, cells);
  const int count = count_of(piece);
  const GO offset = sum_before(comm, GO(count));

  Pieces mine;
  mine.num_cells.assign(count, 0);
  std::vector<Bounds> boxes(count, Bounds::empty());
  SharedCells shared_cells;
  for (LO cell = 0; cell < mesh.num_cells(); ++cell) {
    mine.num_cells[piece[cell]] += cell < mesh.num_owned_cells;
    bool shared = cell >= mesh.num_owned_cells; // with a rank that owns it or one of its nodes
    std::vector<GO> key;
    for (int a = 0; a < width; ++a) {
      Point x{};
      for (int c = 0; c < dim; ++c) x[c] = coords(cells(cell, a), c);
      boxes[piece[cell]].add(x);
      shared = shared || cells(cell, a) >= mesh.num_owned_nodes();
      if (a >= vertices) continue;
      key.push_back(mesh.node_gid(cells(cell, a)));
    }
    if (!shared) continue;
    std::sort(key.begin(), key.end());
    shared_cells.emplace(key, offset + piece[cell]);
  }
  mine.same = same_pieces(mesh, shared_cells);
  std::vector<Part> frames;
  for (const Bounds &box : boxes) {
    frames.push_back(frame_of(box));
    mine.box.insert(mine.box.end(), box.lower.begin(), box.lower.end());
    mine.box.insert(mine.box.end(), box.upper.begin(), box.upper.end());
  }
  std::vector<std::vector<RigidMotion>> rows(count);
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    std::set<int> here;
    for (std::size_t k = row(n); k < row(n + 1); ++k) here.insert(piece[around(k)]);
    double x[3] = {0, 0, 0};
    for (int c = 0; c < dim; ++c) x[c] = coords(n, c);
    for (auto other = std::next(here.begin()); other != here.end(); ++other) {
      mine.joined.insert(mine.joined.end(), {offset + *here.begin(), offset + *other});
      mine.joint.insert(mine.joint.end(), x, x + dim);
    }
    for (int c = 0; c < dim; ++c)
      for (const int p : here)
        if (fixed(dim * n + c) && !(group.extent(0) > 0 && group(dim * n + c) >= 0))
          rows[p].push_back(row_at(x, c, frames[p], dim));
  }
  for (int p = 0; p < count; ++p)
    for (const RigidMotion &held : independent_rows(rows[p], rigid_tolerance)) {
      mine.held.push_back(offset + p);
      mine.held_row.insert(mine.held_row.end(), held.begin(), held.end());
    }
  return {gathered_by_root(comm, mine.num_cells), gathered_by_root(comm, mine.box),   gathered_by_root(comm, mine.same),
          gathered_by_root(comm, mine.joined),    gathered_by_root(comm, mine.joint), gathered_by_root(comm, mine.held),
          gathered_by_root(comm, mine.held_row)};
}

} // namespace rpc::fem
