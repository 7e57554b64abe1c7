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

/// Whether a penetration or a slip is what rounding may leave of the numbers that it is the difference of.
bool is_rounding(const double x, const double size)
{
  return std::abs(x) <= 1e-14 * size;
}

/// The sum of x_d y_d less another number, or 0 where rounding is all that is left. @param size  in: of that number; out: of all that is summed
double less(const double *const x, const Point &y, const double subtracted, double &size)
{
  double sum = -subtracted;
  for (int d = 0; d < 3; ++d) {
    sum += x[d] * y[d];
    size += std::abs(x[d] * y[d]);
  }
  return is_rounding(sum, size) ? 0 : sum;
}

/// (facets) The coefficients of numbers of points. @param size  (points) of what these numbers are the difference of
std::vector<OfTriangle> on_facets(const SpaceContact &c, const std::vector<double> &of_point,
                                  const std::vector<double> &size)
{
  std::vector<OfTriangle> all;
  for (const auto &p : c.point) {
    OfTriangle at_nodes{};
    double largest = 0;
    for (int a = 0; a < nodes_of_triangle(c.order); ++a) {
      at_nodes[a] = of_point[p[a]];
      largest = std::max(largest, size[p[a]]);
    }
    all.push_back(bernstein_of(c.order, at_nodes));
    for (int m = 3; m < nodes_of_triangle(c.order); ++m)
      if (is_rounding(all.back()[m], largest)) all.back()[m] = 0;
  }
  return all;
}

/// Penetration at a point. @param[out] size  of what it is the difference of
double depth_of(const SpacePoint &p, const Point &u, double &size)
{
  size = std::abs(p.gap) + p.dent;
  return less(p.normal, u, p.gap + p.dent, size);
}

std::vector<OfTriangle> depths_in_space(const SpaceContact &c, const std::vector<Point> &u)
{
  std::vector<double> depth(u.size()), size(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) depth[i] = depth_of(c.points[i], u[i], size[i]);
  return on_facets(c, depth, size);
}

AlongSide slips_in_space(const SpaceContact &c, const std::vector<Point> &u)
{
  AlongSide slip;
  for (int k = 0; k < 2; ++k) {
    std::vector<double> of_point(u.size()), size(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double from = c.friction.slip_from[i][k];
      size[i] = std::abs(from);
      of_point[i] = less(c.axis[k].data(), u[i], from, size[i]);
    }
    slip[k] = on_facets(c, of_point, size);
  }
  return slip;
}

} // namespace

void move_out(const SpaceContact &c, const mesh::Mesh &mesh, const HostView<double *> &u)
{
  if (!never_gives_way(c)) return;
  std::vector<Point> at = displacements_of(c, mesh, u);
  std::vector<double> deep; // what rounding has left of it too: else it would stay where a point is moved by more
  for (std::size_t i = 0; i < at.size(); ++i) {
    const SpacePoint &p = c.points[i];
    deep.push_back(p.normal[0] * at[i][0] + p.normal[1] * at[i][1] + p.normal[2] * at[i][2] - (p.gap + p.dent));
  }
  const auto lower = [&](const int i, const double to) {
    const Point direction = {c.points[i].direction[0], c.points[i].direction[1], c.points[i].direction[2]};
    const double squared = inner(direction, direction);
    if (!(deep[i] > to && squared > 0)) return;
    for (int d = 0; d < 3; ++d) at[i][d] -= (deep[i] - to) / squared * direction[d];
    deep[i] = to;
  };
  for (std::size_t i = 0; i < at.size(); ++i) lower(static_cast<int>(i), 0);
  for (const auto &p : c.point)
    for (int m = 0; m < 3 && c.order == 2; ++m) // (13.3)
      lower(p[3 + m], (deep[p[m == 1 ? 1 : 0]] + deep[p[m == 0 ? 1 : 2]]) / 4);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const LO node = owned_node(c.points[i], mesh);
    for (int d = 0; d < 3 && node >= 0; ++d) u(dof(3, node, d)) = at[i][d];
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
      ContactIntegrals sum = contact_integrals(c.order, v[f], t.pressure[f], {c.limit_of[f], c.rise, c.spring});
      if (c.friction.acts) {
        const ContactIntegrals rub = friction_integrals(c.order, {e[0][f], e[1][f]},
                                                        {t.friction[0][f], t.friction[1][f]}, c.friction.limit_of[f]);
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
