// SPDX-License-Identifier: BSD-3-Clause
#include "exodus_part.hpp"

#include "rpc/core/parallel.hpp"
#include "rpc/mesh/canonical_order.hpp"

#include <algorithm>
#include <utility>

namespace rpc::io
{

ExodusPart::Found ExodusPart::find(const mesh::Mesh &mesh)
{
  const auto ids = mesh::overlap_node_ids(mesh);
  const auto cells = to_host(mesh.cells);
  const auto block = to_host(mesh.block);
  Found found;
  found.place.assign(mesh.num_local_nodes(), -1);
  for (LO c = 0; c < mesh.num_owned_cells; ++c) {
    found.cell.push_back(c);
    for (int a = 0; a < mesh.element.num_nodes(); ++a) found.place[cells(c, a)] = 0; // is there
  }
  std::sort(found.cell.begin(), found.cell.end(), [&](const LO a, const LO b) {
    return std::pair(block(a), mesh.cell_id(a)) < std::pair(block(b), mesh.cell_id(b));
  });
  for (LO n = 0; n < mesh.num_local_nodes(); ++n)
    if (found.place[n] == 0) found.node.push_back(n);
  for (const LO n : found.node)
    if (n >= mesh.num_owned_nodes()) found.ghosts.push_back(n - mesh.num_owned_nodes());
  std::sort(found.node.begin(), found.node.end(), [&](const LO a, const LO b) { return ids(a) < ids(b); });
  for (std::size_t k = 0; k < found.node.size(); ++k) {
    found.place[found.node[k]] = static_cast<int>(k);
    found.id.push_back(ids(found.node[k]));
  }
  return found;
}

ExodusPart::ExodusPart(const mesh::Mesh &mesh) : ExodusPart(mesh, find(mesh)) {}

ExodusPart::ExodusPart(const mesh::Mesh &mesh, Found found)
    : mesh_(mesh), node_(std::move(found.node)), id_(std::move(found.id)), cell_(std::move(found.cell)),
      place_(std::move(found.place)), ghosts_(std::move(found.ghosts)), ghost_values_(mesh, ghosts_)
{
}

std::vector<GO> ExodusPart::block_sizes() const
{
  const auto block = to_host(mesh_.block);
  std::vector<GO> sizes(mesh_.blocks.size(), 0);
  for (const LO c : cell_) ++sizes[block(c)];
  return sizes;
}

ExodusShare ExodusPart::share() const
{
  std::vector<int> blocks, facets;
  for (const GO size : block_sizes()) blocks.push_back(static_cast<int>(size));
  for (const SideSet &side : sides()) facets.push_back(static_cast<int>(side.cell.size()));
  ExodusShare share;
  share.num_parts = mesh_.comm().getSize();
  share.num_nodes = static_cast<GO>(mesh_.owned_nodes->getGlobalNumElements());
  share.num_cells = sum_all(mesh_.comm(), static_cast<GO>(cell_.size()));
  share.block_sizes = summed(mesh_.comm(), blocks);
  share.side_sizes = summed(mesh_.comm(), facets);
  for (const GO id : id_) share.node_number.push_back(static_cast<int>(id) + 1);
  for (const LO c : cell_) share.cell_number.push_back(static_cast<int>(mesh_.cell_id(c)) + 1);
  return share;
}

std::vector<double> ExodusPart::coordinate(const int direction) const
{
  const auto coords = to_host(mesh_.coords);
  std::vector<double> values;
  values.reserve(node_.size());
  for (const LO n : node_) values.push_back(coords(n, direction));
  return values;
}

std::vector<int> ExodusPart::connectivity() const
{
  const auto cells = to_host(mesh_.cells);
  std::vector<int> nodes;
  for (const LO c : cell_)
    for (int a = 0; a < mesh_.element.num_nodes(); ++a) nodes.push_back(place_[cells(c, a)] + 1);
  return nodes;
}

std::vector<SideSet> ExodusPart::sides() const
{
  std::vector<int> number(mesh_.num_owned_cells); // of a cell in the file
  for (std::size_t k = 0; k < cell_.size(); ++k) number[cell_[k]] = static_cast<int>(k) + 1;
  std::vector<SideSet> sets;
  for (const mesh::Side &side : mesh_.sides) {
    const auto cell = to_host(side.cell);
    const auto ordinal = to_host(side.ordinal);
    std::vector<std::pair<int, int>> facets;
    for (std::size_t f = 0; f < cell.extent(0); ++f)
      if (cell(f) < mesh_.num_owned_cells) facets.emplace_back(number[cell(f)], ordinal(f) + 1);
    std::sort(facets.begin(), facets.end());
    SideSet set{side.name, {}, {}};
    for (const auto &[of_cell, which] : facets) {
      set.cell.push_back(of_cell);
      set.ordinal.push_back(which);
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

std::vector<double> ExodusPart::at_nodes(const HostView<double *> &owned) const
{
  const std::vector<double> of_ghosts = ghost_values_.of(owned.data());
  const LO num_owned = mesh_.num_owned_nodes();
  std::vector<double> values(node_.size());
  for (LO n = 0; n < num_owned; ++n)
    if (place_[n] >= 0) values[place_[n]] = owned(n);
  for (std::size_t k = 0; k < ghosts_.size(); ++k) values[place_[num_owned + ghosts_[k]]] = of_ghosts[k];
  return values;
}

std::vector<double> ExodusPart::at_cells(const HostView<double *> &owned) const
{
  std::vector<double> values;
  values.reserve(cell_.size());
  for (const LO c : cell_) values.push_back(owned(c));
  return values;
}

} // namespace rpc::io
