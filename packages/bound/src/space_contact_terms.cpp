// SPDX-License-Identifier: BSD-3-Clause
#include "space_contact_terms.hpp"

#include "rpc/contact/law/foundation.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/point.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

/// (points) A displacement at the points of a side, on all ranks.
std::vector<Point> displacements_of(const SpaceContact &c, const mesh::Mesh &mesh, const HostView<double *> &u)
{
  std::vector<double> mine(3 * c.points.size(), 0.);
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const LO node = owned_node(c.points[i], mesh);
    for (int d = 0; d < 3 && node >= 0; ++d) mine[3 * i + d] = u(dof(3, node, d));
  }
  const std::vector<double> all = summed(mesh.comm(), mine);
  std::vector<Point> of(c.points.size());
  for (std::size_t i = 0; i < of.size(); ++i) of[i] = {all[3 * i], all[3 * i + 1], all[3 * i + 2]};
  return of;
}

/// The sum of x_d y_d less y_0, or 0 where rounding is all that is left.
double less(const double *const x, const Point &y, const double subtracted, const double size_of_subtracted)
{
  double sum = -subtracted, size = size_of_subtracted;
  for (int d = 0; d < 3; ++d) {
    sum += x[d] * y[d];
    size += std::abs(x[d] * y[d]);
  }
  return std::abs(sum) <= 1e-14 * size ? 0 : sum;
}

/// (facets) Numbers of points at the corners.
std::vector<OfTriangle> at_corners(const SpaceContact &c, const std::vector<double> &of_point)
{
  std::vector<OfTriangle> all;
  for (const auto &p : c.point) all.push_back({of_point[p[0]], of_point[p[1]], of_point[p[2]]});
  return all;
}

std::vector<OfTriangle> depths_in_space(const SpaceContact &c, const std::vector<Point> &u)
{
  std::vector<double> depth;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const SpacePoint &p = c.points[i];
    depth.push_back(less(p.normal, u[i], p.gap + p.dent, std::abs(p.gap) + p.dent));
  }
  return at_corners(c, depth);
}

AlongSide slips_in_space(const SpaceContact &c, const std::vector<Point> &u)
{
  AlongSide slip;
  for (int k = 0; k < 2; ++k) {
    std::vector<double> of_point;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double from = c.friction.slip_from[i][k];
      of_point.push_back(less(c.axis[k].data(), u[i], from, std::abs(from)));
    }
    slip[k] = at_corners(c, of_point);
  }
  return slip;
}

} // namespace

void move_out(const SpaceContact &c, const mesh::Mesh &mesh, const HostView<double *> &u)
{
  if (!never_gives_way(c)) return;
  for (const SpacePoint &p : c.points) {
    const LO node = owned_node(p, mesh);
    if (node < 0) continue;
    double deep = -p.free_gap, squared = 0;
    for (int d = 0; d < 3; ++d) {
      deep += p.direction[d] * u(dof(3, node, d));
      squared += p.direction[d] * p.direction[d];
    }
    for (int d = 0; d < 3 && deep > 0 && squared > 0; ++d) u(dof(3, node, d)) -= deep / squared * p.direction[d];
  }
}

SpaceContactTerms contact_terms(const std::vector<SpaceContact> &sides, const mesh::Mesh &mesh,
                                const HostView<double *> &u)
{
  SpaceContactTerms terms;
  for (const SpaceContact &c : sides) {
    const std::vector<Point> at = displacements_of(c, mesh, u);
    const std::vector<OfTriangle> v = depths_in_space(c, at);
    SpaceTractions t{fitted_pressure(c, v), {}};
    AlongSide e;
    if (c.friction.acts) {
      e = slips_in_space(c, at);
      t.friction = fitted_friction(c, e);
    }
    std::vector<double> gap_of(c.facet.size(), 0.);
    for (std::size_t f = 0; f < c.facet.size(); ++f) {
      if (never_gives_way(c) && *std::max_element(v[f].begin(), v[f].end()) > 0)
        terms.missing = "the body lies in a rigid foundation";
      ContactIntegrals sum = contact_integrals(v[f], t.pressure[f], {c.limit_of[f], c.rise, c.spring});
      if (c.friction.acts) {
        const ContactIntegrals rub =
            friction_integrals({e[0][f], e[1][f]}, {t.friction[0][f], t.friction[1][f]}, c.friction.limit_of[f]);
        sum.energy += rub.energy;
        sum.gap += rub.gap;
      }
      gap_of[f] = c.area[f] * sum.gap;
      terms.energy += c.area[f] * sum.energy;
      terms.gap += gap_of[f];
    }
    terms.tractions.push_back(t);
    terms.gap_of.push_back(gap_of);
  }
  return terms;
}

} // namespace rpc::bound
