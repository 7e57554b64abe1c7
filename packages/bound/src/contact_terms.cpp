// SPDX-License-Identifier: BSD-3-Clause
#include "contact_terms.hpp"

#include "rpc/contact/law/foundation.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

using OfPoints = std::vector<std::array<double, 2>>;

/// (points) A displacement at the points of a side, on all ranks.
OfPoints at_points(const ContactFacets &c, const mesh::Mesh &mesh, const HostView<double *> &u)
{
  std::vector<double> mine(2 * c.points.size(), 0.);
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const LO node = owned_node(c.points[i], mesh);
    for (int d = 0; d < 2 && node >= 0; ++d) mine[2 * i + d] = u(dof(2, node, d));
  }
  const std::vector<double> all = summed(mesh.comm(), mine);
  OfPoints of(c.points.size());
  for (std::size_t i = 0; i < of.size(); ++i) of[i] = {all[2 * i], all[2 * i + 1]};
  return of;
}

/// Penetrations of a side at the nodes of its facets. What rounding leaves of a point that is held at the surface is 0.
std::vector<OfFacet> depths(const ContactFacets &c, const OfPoints &u)
{
  std::vector<OfFacet> all;
  for (const auto &of_facet : c.point) {
    OfFacet v{};
    for (int a = 0; a <= c.order; ++a) {
      const SidePoint &p = c.points[of_facet[a]];
      const double x = p.normal[0] * u[of_facet[a]][0], y = p.normal[1] * u[of_facet[a]][1];
      v[a] = x + y - p.gap - p.dent;
      if (std::abs(v[a]) <= 1e-14 * (std::abs(x) + std::abs(y) + std::abs(p.gap) + p.dent)) v[a] = 0;
    }
    all.push_back(v);
  }
  return all;
}

/// Slips of a side at the nodes of its facets.
std::vector<OfFacet> slips(const ContactFacets &c, const OfPoints &u)
{
  std::vector<OfFacet> all;
  for (std::size_t f = 0; f < c.point.size(); ++f) {
    const std::array<double, 2> along = tangent_of(c.normal[f]);
    OfFacet e{};
    for (int a = 0; a <= c.order; ++a) {
      const std::array<double, 2> &here = u[c.point[f][a]];
      const double x = along[0] * here[0], y = along[1] * here[1], from = c.friction.slip_from[f][a];
      e[a] = x + y - from;
      if (std::abs(e[a]) <= 1e-14 * (std::abs(x) + std::abs(y) + std::abs(from))) e[a] = 0;
    }
    all.push_back(e);
  }
  return all;
}

} // namespace

void move_out(const ContactFacets &c, const mesh::Mesh &mesh, const HostView<double *> &u)
{
  if (!never_gives_way(c)) return;
  OfPoints at = at_points(c, mesh, u);
  const auto depth = [&](const int i) {
    const SidePoint &p = c.points[i];
    return p.direction[0] * at[i][0] + p.direction[1] * at[i][1] - p.free_gap;
  };
  const auto move = [&](const int i, const double by) {
    const double *const direction = c.points[i].direction;
    const double squared = direction[0] * direction[0] + direction[1] * direction[1];
    for (int d = 0; d < 2 && squared > 0; ++d) at[i][d] -= by / squared * direction[d];
  };
  for (std::size_t i = 0; i < c.points.size(); ++i) move(i, std::max(0., depth(i)));
  for (const auto &of_facet : c.point) {
    if (c.order == 1) break;
    const OfFacet v{depth(of_facet[0]), depth(of_facet[1]), depth(of_facet[2])};
    move(of_facet[2], std::max(0., v[2] - lowered_middle(v)));
  }
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const LO node = owned_node(c.points[i], mesh);
    for (int d = 0; d < 2 && node >= 0; ++d) u(dof(2, node, d)) = at[i][d];
  }
}

ContactTerms contact_terms(const std::vector<ContactFacets> &sides, const mesh::Mesh &mesh, const HostView<double *> &u)
{
  ContactTerms terms;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const ContactFacets &c = sides[k];
    const OfPoints at = at_points(c, mesh, u);
    const auto v = depths(c, at);
    const auto e = slips(c, at);
    SideTractions t{fitted_pressure(c, v), {}};
    if (c.friction.acts) t.friction = fitted_friction(c, e);
    std::vector<double> gap_of(c.facet.size(), 0.);
    for (std::size_t f = 0; f < c.facet.size(); ++f) {
      if (never_gives_way(c) && *std::max_element(v[f].begin(), v[f].end()) > 0)
        terms.missing = "the body lies in a rigid foundation";
      NormalLaw law{c.limit_of[f], c.rise, c.spring, {}};
      if (!c.circle.empty()) law.circle = c.circle[f];
      for (int a = 0; a <= c.order && law.circle; ++a)
        if (c.circle[f][a] == 0 && (t.pressure[f][a] != 0 || (c.friction.acts && t.friction[f][a] != 0)))
          terms.missing = "a traction of contact acts on the axis";
      ContactIntegrals sum = contact_integrals(c.order, v[f], t.pressure[f], law);
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
