#include "rpc/contact/moving_dents.hpp"

#include "rpc/contact/surface/facets.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace rpc::contact
{
namespace
{

bool moves_with_foundation(const ContactOptions &side)
{
  return side.dents_move_with == DentsMoveWith::foundation;
}

/// A side's owned nodes with the directions in which they are pressed in.
struct Pressed {
  HostView<LO *> node;
  std::vector<Point> place, direction;
};

/// @param obstacle  that of the options where it is, or was
Pressed pressed_nodes(const fem::Discretization &d, const ContactOptions &options, const Obstacle &obstacle)
{
  const auto surface = fem::surface_nodes(d, d.mesh->side(options.side, options.path + "->Side"));
  const auto place = fem::node_positions(*d.mesh, surface.node);
  const auto outward = to_host(surface.normal);
  Pressed nodes;
  nodes.node = to_host(surface.node);
  for (std::size_t i = 0; i < nodes.node.extent(0); ++i) {
    Point x{}, direction{};
    for (int c = 0; c < d.dim(); ++c) {
      x[c] = place(i, c);
      direction[c] = options.normal == Normal::fixed ? options.direction[c] : outward(i, c);
    }
    if (options.normal == Normal::foundation)
      if (const auto into = direction_into(obstacle, x)) direction = *into;
    nodes.place.push_back(x);
    nodes.direction.push_back(direction);
  }
  return nodes;
}

/// By how much nodes move along the foundation beside each other: the largest distance, along it, from their mean [m]. Collective.
double spread(const fem::Discretization &d, const Pressed &nodes, const Vector &u)
{
  const int dim = d.dim();
  const auto values = u.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<double> sums(4, 0.);
  for (std::size_t i = 0; i < nodes.place.size(); ++i, ++sums[3])
    for (int c = 0; c < dim; ++c) sums[c] += values(dof(dim, nodes.node(i), c), 0);
  sums = summed(d.mesh->comm(), sums);
  double largest = 0;
  for (std::size_t i = 0; i < nodes.place.size(); ++i) {
    Point from_mean{};
    double normal = 0, square = 0;
    for (int c = 0; c < dim; ++c) {
      from_mean[c] = values(dof(dim, nodes.node(i), c), 0) - sums[c] / sums[3];
      normal += from_mean[c] * nodes.direction[i][c];
    }
    for (int c = 0; c < dim; ++c) square += std::pow(from_mean[c] - normal * nodes.direction[i][c], 2);
    largest = std::max(largest, std::sqrt(square));
  }
  return max_all(d.mesh->comm(), largest);
}

Point motion(const Obstacle &obstacle)
{
  Point motion{};
  for (int c = 0; c < 3; ++c) motion[c] = obstacle.point[c] - obstacle.origin[c];
  return motion;
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
                                 const RCP<const MultiVector> &dents, const Vector &u)
{
  const int dim = d.dim();
  RCP<MultiVector> met;
  for (std::size_t k = 0; k < options.size(); ++k) {
    if (!moves_with_foundation(options[k]) || all_zero(*dents, k)) continue;
    if (met.is_null()) met = rcp(new MultiVector(*dents, Teuchos::Copy));
    const Pressed nodes = pressed_nodes(d, options[k], options[k].obstacle);
    const FacetSurface foundation(straight_facets(d, d.mesh->side(options[k].side, options[k].path + "->Side"), nullptr,
                                                  {}, *dents, static_cast<int>(k)),
                                  spread(d, nodes, u));
    const Point moved = motion(options[k].obstacle);
    const auto values = u.getLocalViewHost(Tpetra::Access::ReadOnly);
    std::vector<Point> standing = nodes.place;
    for (std::size_t i = 0; i < standing.size(); ++i)
      for (int c = 0; c < dim; ++c) standing[i][c] += values(dof(dim, nodes.node(i), c), 0) - moved[c];
    const auto found = values_along(d.mesh->comm(), foundation, standing, nodes.direction);
    const auto to = met->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < found.size(); ++i) to(nodes.node(i), k) = found[i].value_or(0);
  }
  if (met.is_null()) return dents;
  return met;
}

void add_where_they_lie(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                        const MultiVector &added, const Vector &u, MultiVector &dents)
{
  for (std::size_t k = 0; k < options.size(); ++k) {
    if (!moves_with_foundation(options[k]) || all_zero(added, k)) continue;
    Obstacle at_first = options[k].obstacle;
    at_first.point = at_first.origin;
    const Pressed places = pressed_nodes(d, options[k], at_first);
    Point back = motion(options[k].obstacle);
    for (double &component : back) component = -component;
    const FacetSurface body(straight_facets(d, d.mesh->side(options[k].side, options[k].path + "->Side"), &u, back,
                                            added, static_cast<int>(k)));
    const auto found = values_along(d.mesh->comm(), body, places.place, places.direction);
    const auto to = dents.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < found.size(); ++i) to(places.node(i), k) += found[i].value_or(0);
  }
}

void take_dents_of_foundation(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                              const MultiVector &dents, ContactResult &result)
{
  if (!any_moves_with_foundation(options)) return;
  const Comm &comm = d.mesh->comm();
  result.total.max_dent = result.total.dent_volume = 0;
  for (std::size_t k = 0; k < options.size(); ++k) {
    ContactSums &sums = result.sides[k];
    if (moves_with_foundation(options[k])) {
      const auto surface = fem::surface_nodes(d, d.mesh->side(options[k].side, options[k].path + "->Side"));
      const auto node = to_host(surface.node);
      const auto weight = to_host(surface.weight);
      const auto from = dents.getLocalViewHost(Tpetra::Access::ReadOnly);
      double deepest = 0, volume = 0;
      for (std::size_t i = 0; i < node.extent(0); ++i) {
        if (weight(i) > 0) deepest = std::max(deepest, from(node(i), k));
        volume += weight(i) * from(node(i), k);
      }
      sums.max_dent = max_all(comm, deepest);
      sums.dent_volume = sum_all(comm, volume);
    }
    result.total.max_dent = std::max(result.total.max_dent, sums.max_dent);
    result.total.dent_volume += sums.dent_volume;
  }
}

} // namespace rpc::contact
