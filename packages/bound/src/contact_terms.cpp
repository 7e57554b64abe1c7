// SPDX-License-Identifier: BSD-3-Clause
#include "contact_terms.hpp"

#include "rpc/contact/law/foundation.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

/// Whether the foundation gives way to nothing.
bool is_rigid(const ContactFacets &c)
{
  return c.spring == 0 && !c.limit_of.empty() && contact::is_rigid(c.limit_of[0][0]);
}

/// Penetrations of a side at the nodes of its facets. What rounding leaves of a point that is held at the surface is 0.
std::vector<OfFacet> depths(const ContactFacets &c, const int first, const contact::ContactNodes &points,
                            const HostView<double *> &u)
{
  const auto node = to_host(points.node);
  const auto normal = to_host(points.normal);
  const auto gap = to_host(points.gap), dent = to_host(points.dent);
  std::vector<OfFacet> all;
  for (const auto &of_facet : c.point) {
    OfFacet v{};
    for (int a = 0; a < 3; ++a) {
      if (of_facet[a] < 0) continue;
      const int i = first + of_facet[a];
      const double x = normal(i, 0) * u(dof(2, node(i), 0)), y = normal(i, 1) * u(dof(2, node(i), 1));
      v[a] = x + y - gap(i) - dent(i);
      if (std::abs(v[a]) <= 1e-14 * (std::abs(x) + std::abs(y) + std::abs(gap(i)) + dent(i))) v[a] = 0;
    }
    all.push_back(v);
  }
  return all;
}

/// Slips of a side at the nodes of its facets.
std::vector<OfFacet> slips(const ContactFacets &c, const int first, const contact::ContactNodes &points,
                           const HostView<double *> &u)
{
  const auto node = to_host(points.node);
  std::vector<OfFacet> all;
  for (std::size_t f = 0; f < c.point.size(); ++f) {
    const std::array<double, 2> along = tangent_of(c.normal[f]);
    OfFacet e{};
    for (int a = 0; a <= c.order; ++a) {
      const int i = first + c.point[f][a];
      const double x = along[0] * u(dof(2, node(i), 0)), y = along[1] * u(dof(2, node(i), 1)),
                   from = c.friction.slip_from[f][a];
      e[a] = x + y - from;
      if (std::abs(e[a]) <= 1e-14 * (std::abs(x) + std::abs(y) + std::abs(from))) e[a] = 0;
    }
    all.push_back(e);
  }
  return all;
}

} // namespace

void move_out(const ContactFacets &c, const int first, const contact::ContactNodes &points, const HostView<double *> &u)
{
  if (!is_rigid(c)) return;
  const auto node = to_host(points.node);
  const auto direction = to_host(points.direction);
  const auto gap = to_host(points.free_gap);
  const auto depth = [&](const int i) {
    return direction(i, 0) * u(dof(2, node(i), 0)) + direction(i, 1) * u(dof(2, node(i), 1)) - gap(i);
  };
  const auto move = [&](const int i, const double by) {
    const double squared = direction(i, 0) * direction(i, 0) + direction(i, 1) * direction(i, 1);
    for (int d = 0; d < 2 && squared > 0; ++d) u(dof(2, node(i), d)) -= by / squared * direction(i, d);
  };
  for (const auto &of_facet : c.point)
    for (const int a : of_facet)
      if (a >= 0) move(first + a, std::max(0., depth(first + a)));
  if (c.order == 1) return;
  for (const auto &of_facet : c.point) {
    const OfFacet v{depth(first + of_facet[0]), depth(first + of_facet[1]), depth(first + of_facet[2])};
    move(first + of_facet[2], std::max(0., v[2] - lowered_middle(v)));
  }
}

ContactTerms contact_terms(const std::vector<ContactFacets> &sides, const contact::ContactNodes &points,
                           const HostView<double *> &u)
{
  ContactTerms terms;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const ContactFacets &c = sides[k];
    const auto v = depths(c, points.first(k), points, u);
    const auto e = slips(c, points.first(k), points, u);
    SideTractions t{fitted_pressure(c, v), {}};
    if (c.friction.acts) t.friction = fitted_friction(c, e);
    std::vector<double> gap_of(c.facet.size(), 0.);
    for (std::size_t f = 0; f < c.facet.size(); ++f) {
      if (is_rigid(c) && *std::max_element(v[f].begin(), v[f].end()) > 0)
        terms.missing = "the body lies in a rigid foundation";
      ContactIntegrals sum = contact_integrals(c.order, v[f], t.pressure[f], {c.limit_of[f], c.rise, c.spring});
      if (c.friction.acts) {
        const ContactIntegrals rub = friction_integrals(c.order, e[f], t.friction[f], c.friction.limit_of[f]);
        sum.energy += rub.energy;
        sum.gap += rub.gap;
      }
      gap_of[f] = c.length[f] * sum.gap;
      terms.energy += c.length[f] * sum.energy;
      terms.gap += gap_of[f];
    }
    terms.tractions.push_back(t);
    terms.gap_of.push_back(gap_of);
  }
  return terms;
}

} // namespace rpc::bound
