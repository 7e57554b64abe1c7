// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/moving_dents.hpp"

#include "rpc/contact/rules.hpp"
#include "rpc/contact/surface/facets.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rpc::contact
{
namespace
{

bool moves_with_foundation(const ContactOptions &side)
{
  return side.dents_move_with == DentsMoveWith::foundation;
}

const mesh::Side &side_of(const fem::Discretization &d, const ContactOptions &options)
{
  return d.mesh->side(options.side, options.path + "->Side");
}

/// A side's owned nodes with their weights.
struct SideNodes {
  HostView<LO *> node;
  HostView<double *> weight;
};

SideNodes nodes_of(const fem::SurfaceNodes &surface)
{
  return {to_host(surface.node), to_host(surface.weight)};
}

/// The largest of a side's nodal values, among nodes with a weight; collective.
/// @param values  (owned nodes; sides) >= 0
double largest_of(const Comm &comm, const SideNodes &nodes, const MultiVector &values, const std::size_t side)
{
  const auto from = values.getLocalViewHost(Tpetra::Access::ReadOnly);
  double largest = 0;
  for (std::size_t i = 0; i < nodes.node.extent(0); ++i)
    if (nodes.weight(i) > 0) largest = std::max(largest, from(nodes.node(i), side));
  return max_all(comm, largest);
}

/// Their weighted sum; collective.
double integral_of(const Comm &comm, const SideNodes &nodes, const MultiVector &values, const std::size_t side)
{
  const auto from = values.getLocalViewHost(Tpetra::Access::ReadOnly);
  double sum = 0;
  for (std::size_t i = 0; i < nodes.node.extent(0); ++i) sum += nodes.weight(i) * from(nodes.node(i), side);
  return sum_all(comm, sum);
}

/// A side's owned nodes as they stand, seen from the foundation.
struct Standing : SideNodes {
  std::vector<Point> place, direction; // y, and where they are pressed in
  double spread = 0;                   // see spread_of()
};

/// By how much nodes have moved along the foundation beside each other: the largest distance from their mean [m]. Collective.
double spread_of(const Comm &comm, const std::vector<Point> &u, const std::vector<Point> &direction)
{
  std::vector<double> sums(4, 0.);
  for (const Point &moved : u) {
    for (int c = 0; c < 3; ++c) sums[c] += moved[c];
    ++sums[3];
  }
  sums = summed(comm, sums);
  double largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    Point from_mean{};
    for (int c = 0; c < 3; ++c) from_mean[c] = u[i][c] - sums[c] / sums[3];
    const double normal = inner(from_mean, direction[i]);
    for (int c = 0; c < 3; ++c) from_mean[c] -= normal * direction[i][c];
    largest = std::max(largest, length(from_mean));
  }
  return max_all(comm, largest);
}

/// Collective.
Standing standing(const fem::Discretization &d, const ContactOptions &options, const Vector &u)
{
  const int dim = d.dim();
  const auto surface = fem::surface_nodes(d, side_of(d, options));
  const auto place = fem::node_positions(*d.mesh, surface.node);
  const auto outward = to_host(surface.normal);
  const auto values = u.getLocalViewHost(Tpetra::Access::ReadOnly);
  const Point motion = difference(options.obstacle.point, options.obstacle.origin);
  Standing nodes;
  static_cast<SideNodes &>(nodes) = nodes_of(surface);
  std::vector<Point> moved;
  for (std::size_t i = 0; i < nodes.node.extent(0); ++i) {
    Point x{}, direction{}, displacement{}, y{};
    for (int c = 0; c < dim; ++c) {
      x[c] = place(i, c);
      direction[c] = options.normal == Normal::fixed ? options.direction[c] : outward(i, c);
      displacement[c] = values(dof(dim, nodes.node(i), c), 0);
      y[c] = x[c] + displacement[c] - motion[c]; // (11.4)
    }
    if (options.normal == Normal::foundation)
      if (const auto into = direction_into(options.obstacle, x)) direction = *into;
    nodes.place.push_back(y);
    nodes.direction.push_back(direction);
    moved.push_back(displacement);
  }
  nodes.spread = spread_of(d.mesh->comm(), moved, nodes.direction);
  return nodes;
}

/// The dented facets of a side that this rank owns, as their nodes stand. Collective.
/// @param dents   (owned nodes; columns) [m]
DentSheet sheet_of(const fem::Discretization &d, const ContactOptions &options, const Standing &nodes,
                   const MultiVector &dents, const int column)
{
  const auto at_owned = rcp(new MultiVector(d.mesh->owned_nodes, 7)); // place, direction, dent
  {
    const auto to = at_owned->getLocalViewHost(Tpetra::Access::ReadWrite);
    const auto from = dents.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < nodes.place.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        to(nodes.node(i), c) = nodes.place[i][c];
        to(nodes.node(i), 3 + c) = nodes.direction[i][c];
      }
      to(nodes.node(i), 6) = from(nodes.node(i), column);
    }
  }
  const auto overlap = fem::nodes_on_overlap(d, at_owned);
  const auto at = overlap->getLocalViewHost(Tpetra::Access::ReadOnly);
  const mesh::Side &side = side_of(d, options);
  const auto facets = to_host(side.facets);
  const auto cell = to_host(side.cell);
  const int per_facet = static_cast<int>(facets.extent(1));
  DentSheet sheet;
  sheet.facet = d.mesh->element.facet();
  sheet.spread = nodes.spread;
  std::map<LO, LO> number;
  for (std::size_t f = 0; f < facets.extent(0); ++f) {
    bool dented = false;
    for (int a = 0; a < per_facet; ++a) dented = dented || at(facets(f, a), 6) > 0;
    for (int a = 0; a < per_facet && dented && cell(f) < d.mesh->num_owned_cells; ++a) {
      const LO node = facets(f, a);
      const auto [found, is_new] = number.emplace(node, static_cast<LO>(sheet.dent.size()));
      if (is_new) {
        sheet.place.push_back({at(node, 0), at(node, 1), at(node, 2)});
        sheet.direction.push_back({at(node, 3), at(node, 4), at(node, 5)});
        sheet.dent.push_back(at(node, 6));
      }
      sheet.facet_node.push_back(found->second);
    }
  }
  return sheet;
}

FacetSurface surface_of(const DentSheet &sheet, const double beyond)
{
  std::vector<Point> places;
  std::vector<double> dents;
  for (const LO n : sheet.facet_node) {
    places.push_back(sheet.place[n]);
    dents.push_back(sheet.dent[n]);
  }
  return FacetSurface(straight_facets(sheet.facet, places, dents), beyond);
}

/// Whether a sheet lies under all dents of another one. Collective.
bool lies_under(const Comm &comm, const DentSheet &sheet, const DentSheet &other)
{
  std::vector<Point> place, direction;
  for (std::size_t n = 0; n < other.dent.size(); ++n)
    if (other.dent[n] > 0) {
      place.push_back(other.place[n]);
      direction.push_back(other.direction[n]);
    }
  const double spread = sheet.spread + other.spread;
  const auto met = meetings_along(comm, surface_of(sheet, spread), place, direction);
  const bool mine = std::all_of(met.begin(), met.end(), [&](const auto &m) { return m && m->off <= spread; });
  return min_all(comm, static_cast<int>(mine)) == 1;
}

/// A sheet with the dents of another one added. Collective.
std::shared_ptr<const DentSheet> sum_of(const Comm &comm, DentSheet sheet, const DentSheet &other)
{
  const auto found = meetings_along(comm, surface_of(other, sheet.spread + other.spread), sheet.place, sheet.direction);
  for (std::size_t n = 0; n < found.size(); ++n)
    if (found[n]) sheet.dent[n] += found[n]->value;
  return std::make_shared<DentSheet>(std::move(sheet));
}

/// Adds the dents of the oldest sheet under which its neighbour in time lies to that neighbour, if there is one. Collective.
void join_two(const Comm &comm, std::vector<std::shared_ptr<const DentSheet>> &sheets)
{
  for (std::size_t k = 0; k + 1 < sheets.size(); ++k)
    for (const auto &[under, other] : {std::pair(k + 1, k), std::pair(k, k + 1)}) {
      if (!lies_under(comm, *sheets[under], *sheets[other])) continue;
      sheets[under] = sum_of(comm, *sheets[under], *sheets[other]);
      sheets.erase(sheets.begin() + static_cast<std::ptrdiff_t>(other));
      return;
    }
}

bool all_zero(const MultiVector &columns, const std::size_t column)
{
  return columns.getVector(column)->normInf() == 0;
}

} // namespace

bool any_moves_with_foundation(const std::vector<ContactOptions> &options)
{
  return std::any_of(options.begin(), options.end(), moves_with_foundation);
}

RCP<const MultiVector> dents_met(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                                 const RCP<const MultiVector> &with_body,
                                 const std::vector<FoundationDents> &foundations, const Vector &u)
{
  const Comm &comm = d.mesh->comm();
  RCP<MultiVector> met;
  for (std::size_t k = 0; k < foundations.size(); ++k) {
    if (foundations[k].sheets.empty()) continue;
    if (met.is_null()) met = rcp(new MultiVector(*with_body, Teuchos::Copy));
    const Standing nodes = standing(d, options[k], u);
    for (const auto &sheet : foundations[k].sheets) {
      const auto found =
          meetings_along(comm, surface_of(*sheet, nodes.spread + sheet->spread), nodes.place, nodes.direction);
      const auto to = met->getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i]) to(nodes.node(i), k) += found[i]->value;
    }
  }
  if (met.is_null()) return with_body;
  return met;
}

void press_in(const fem::Discretization &d, const std::vector<ContactOptions> &options, const MultiVector &added,
              const MultiVector &after, const Vector &u, std::vector<FoundationDents> &foundations)
{
  const Comm &comm = d.mesh->comm();
  foundations.resize(options.size());
  for (std::size_t k = 0; k < options.size(); ++k) {
    if (!options[k].remembers || all_zero(added, k)) continue;
    FoundationDents &foundation = foundations[k];
    if (moves_with_foundation(options[k])) {
      foundation.sheets.push_back(
          std::make_shared<DentSheet>(sheet_of(d, options[k], standing(d, options[k], u), added, static_cast<int>(k))));
      if (static_cast<int>(foundation.sheets.size()) > lag_rules.most_sheets) join_two(comm, foundation.sheets);
    }
    const SideNodes nodes = nodes_of(fem::surface_nodes(d, side_of(d, options[k])));
    foundation.deepest = std::max(foundation.deepest, largest_of(comm, nodes, after, k));
    foundation.volume += integral_of(comm, nodes, added, k);
  }
}

void take_all_dents(const std::vector<ContactOptions> &options, const std::vector<FoundationDents> &foundations,
                    ContactResult &result)
{
  result.total.max_dent = result.total.dent_volume = 0;
  for (std::size_t k = 0; k < options.size(); ++k) {
    ContactSums &sums = result.sides[k];
    if (options[k].remembers) {
      sums.max_dent = k < foundations.size() ? foundations[k].deepest : 0;
      sums.dent_volume = k < foundations.size() ? foundations[k].volume : 0;
    }
    result.total.max_dent = std::max(result.total.max_dent, sums.max_dent);
    result.total.dent_volume += sums.dent_volume;
  }
}

} // namespace rpc::contact
