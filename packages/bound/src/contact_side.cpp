// SPDX-License-Identifier: BSD-3-Clause
#include "contact_side.hpp"

#include "constant_field.hpp"
#include "rpc/contact/law/foundation.hpp"
#include "rpc/contact/law/friction.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace rpc::bound
{
namespace
{

/// Not covered: `what`, on a contact side.
std::string not_covered(const contact::ContactOptions &options, const std::string &what)
{
  return "deck: \"Adapt->Error Bound\" = guaranteed covers straight contact sides with gaps that the elements "
         "represent; \"" +
         options.path + "\", side \"" + options.side + "\": " + what + ". Write \"estimated\"";
}

/// Whether the gap between the nodes is what the elements make of it there.
void require_represented_gap(const contact::ContactOptions &options, const Comm &comm, const ContactFacets &c,
                             const std::vector<OfFacet> &gap)
{
  constexpr int num_points = OnHost::points_of_fields;
  const Gauss rule = gauss(num_points);
  const HostView<double **> x("rpc::bound::points", c.ends.size() * num_points, 2);
  for (std::size_t e = 0; e < c.ends.size(); ++e)
    for (int q = 0; q < num_points; ++q)
      for (int d = 0; d < 2; ++d)
        x(e * num_points + q, d) = c.ends[e][0][d] + rule.point[q] * (c.ends[e][1][d] - c.ends[e][0][d]);
  HostView<double *> field;
  if (!options.obstacle.exists()) field = evaluate(options.gap, x, options.path + "->Gap", comm, true);
  for (std::size_t e = 0; e < c.facet.size(); ++e)
    for (int q = 0; q < num_points; ++q) {
      const double here = at_point(c.order, gap[e], rule.point[q]);
      const std::size_t at = e * num_points + q;
      const auto distance =
          options.obstacle.exists()
              ? contact::distance_along(options.obstacle, {x(at, 0), x(at, 1), 0}, {c.normal[e][0], c.normal[e][1], 0})
              : std::optional<double>(field(at));
      const double scale = c.length[e] + std::abs(here);
      RPC_REQUIRE(distance && std::abs(*distance - here) <= 1e-10 * scale,
                  not_covered(options, "at (" + shown(x(at, 0)) + ", " + shown(x(at, 1)) +
                                           ") the gap is another than between its nodes"));
    }
}

OfFacet not_negative(OfFacet b)
{
  for (double &coefficient : b) coefficient = std::max(0., coefficient);
  return b;
}

/// Friction at a facet whose last point has been added to the side.
void add_friction(const contact::ContactOptions &options, const std::vector<SidePoint> &points,
                  const std::array<int, 3> &of_facet, const OfFacet &pressure, ContactFacets &c)
{
  const double mu = law(options, 3), s_0 = law(options, 4), s_max = law(options, 5);
  OfFacet q{}, from{}, s{};
  for (int a = 0; a <= c.order; ++a) {
    q[a] = points[of_facet[a]].friction;
    from[a] = points[of_facet[a]].slip_from;
    s[a] = contact::friction_bound(pressure[a], {mu, s_0, s_max});
  }
  s = mu > 0 ? not_negative(bernstein(c.order, s)) : OfFacet{s[0], s[0], s[0]};
  for (double &coefficient : s) coefficient = std::min(coefficient, s_max);
  c.friction.traction.push_back(q);
  c.friction.slip_from.push_back(from);
  c.friction.limit_of.push_back(s);
}

/// The numbers of this rank's points of a side, along the side's tangent where they are vectors.
/// @param on_axis  of a body of revolution, nodes with r up to this lie on the axis; else -1
std::vector<SidePoint> own_points(const contact::ContactNodes &points, const int k, const OnHost &host,
                                  const PointTractions &solution, const double on_axis)
{
  const auto node = to_host(points.node);
  const auto weight = to_host(points.weight), gap = to_host(points.gap), dent = to_host(points.dent);
  const auto free_gap = to_host(points.free_gap);
  const auto normal = to_host(points.normal), direction = to_host(points.direction);
  const auto fixed = to_host(points.fixed);
  const bool rubs = points.friction.exists();
  const auto from = to_host(points.friction.from);
  const auto acts = to_host(rubs ? where_friction_acts(points) : DeviceView<char *>());
  std::vector<SidePoint> all;
  for (int i = points.first(k); i < points.first(k + 1); ++i) {
    SidePoint p{};
    p.gid = static_cast<double>(host.mesh.node_gid(node(i)));
    p.weight = weight(i);
    p.pressure = solution.pressure(i);
    p.gap = gap(i);
    p.dent = dent(i);
    p.free_gap = free_gap(i);
    p.fixed = fixed(i);
    p.acts = rubs && acts(i);
    for (int d = 0; d < 2; ++d) {
      p.place[d] = host.coords(node(i), d);
      p.normal[d] = normal(i, d);
      p.direction[d] = direction(i, d);
    }
    if (on_axis >= 0 &&
        host.coords(node(i), 0) <= on_axis) { // of order 2 contact does not see this node, which may lie too deep
      p.direction[0] = p.fixed = 0;
      p.direction[1] = p.normal[1];
      p.free_gap = p.gap + p.dent;
    }
    const auto along = tangent_of({p.normal[0], p.normal[1]});
    for (int d = 0; d < 2 && rubs; ++d) p.slip_from += along[d] * from(i, d);
    for (int d = 0; d < 2 && solution.along.extent(0) > 0; ++d) p.friction += along[d] * solution.along(i, d);
    all.push_back(p);
  }
  return all;
}

/// A facet of a side, for all ranks.
struct SideFacet {
  double gid[3];     // of its ends and its middle, -1: none
  double ends[2][2]; // [m]
  double block, modulus, prescribed;
};

std::vector<SideFacet> own_facets(const analysis::Problem &problem, const OnHost &host, const std::vector<LO> &facets,
                                  const HostView<char *[2]> &prescribed)
{
  const auto block = to_host(host.mesh.block);
  const auto lame = to_host(fem::lame_table(problem.discretization(), problem.model().materials));
  std::vector<SideFacet> all;
  for (const LO f : facets) {
    if (host.cell(f, 0) >= host.mesh.num_owned_cells) continue;
    SideFacet s{};
    const LO at[3] = {host.node(f, 0), host.node(f, 1), host.middle(f)};
    for (int a = 0; a < 3; ++a) s.gid[a] = at[a] < 0 ? -1 : static_cast<double>(host.mesh.node_gid(at[a]));
    for (int a = 0; a < 2; ++a)
      for (int d = 0; d < 2; ++d) s.ends[a][d] = host.coords(at[a], d);
    s.block = block(host.cell(f, 0));
    const double lambda = lame(block(host.cell(f, 0)), 0), mu = lame(block(host.cell(f, 0)), 1);
    s.modulus = mu * (3 * lambda + 2 * mu) / (lambda + mu);
    s.prescribed = prescribed(f, 0) || prescribed(f, 1);
    all.push_back(s);
  }
  return all;
}

/// Tractions of a body of revolution are those of S = 2 pi r s, with the limits of friction.
void multiply_by_circles(const double on_axis, const contact::ContactOptions &options, ContactFacets &c)
{
  double mean = 0;
  for (std::size_t e = 0; e < c.facet.size(); ++e) {
    double r[2];
    for (int end = 0; end < 2; ++end) r[end] = c.ends[e][end][0] <= on_axis ? 0 : around(true, c.ends[e][end][0]);
    const double middle = (r[0] + r[1]) / 2;
    mean += middle / static_cast<double>(c.facet.size());
    const OfFacet at_nodes{r[0], r[1], middle};
    c.circle.push_back(c.order == 1 ? OfFacet{r[0], r[1], 0} : OfFacet{r[0], middle, r[1]});
    for (int a = 0; a <= c.order; ++a) {
      c.pressure[e][a] *= at_nodes[a];
      RPC_REQUIRE(c.limit_of[e][a] == c.limit_of[0][0] || contact::is_rigid(c.limit_of[0][0]),
                  not_covered(options, "dents of earlier steps under a body of revolution have hardened it"));
      if (!c.friction.acts) continue;
      c.friction.traction[e][a] *= at_nodes[a];
      c.friction.limit_of[e][a] *= c.circle[e][a];
    }
  }
  c.modulus *= mean;
}

} // namespace

double law(const contact::ContactOptions &options, const int parameter)
{
  return value_everywhere(options.*contact::law_parameters[parameter].field)
      .value_or(std::numeric_limits<double>::quiet_NaN());
}

DeviceView<char *> where_friction_acts(const contact::ContactNodes &points)
{
  const DeviceView<char *> acting("rpc::bound::acting", points.size());
  const contact::FrictionPoints friction = points.friction;
  Kokkos::parallel_for(
      "rpc::bound::acting", device_range(points.size()),
      KOKKOS_LAMBDA(const LO i) { acting(i) = contact::acts(friction(i)); });
  Kokkos::fence();
  return acting;
}

ContactFacets contact_side(const analysis::Problem &problem, const analysis::Model &model, const analysis::Step &step,
                           const OnHost &host, const int k, const PointTractions &solution,
                           const HostView<char *[2]> &prescribed)
{
  const contact::ContactOptions &options = model.contact[k];
  const Comm &comm = host.mesh.comm();
  const fem::Discretization &d = problem.discretization();
  ContactFacets c;
  c.order = host.mesh.element.order;
  c.rise = law(options, 1);
  c.spring = 1 / law(options, 2);
  const std::vector<LO> local = host.facets_of(host.mesh.side(options.side, options.path));
  std::vector<SideFacet> facets = rows_of_all(comm, own_facets(problem, host, local, prescribed));
  c.points = rows_of_all(comm, own_points(step.contact, k, host, solution, d.axisymmetric() ? d.on_axis : -1));
  if (facets.empty()) return c;
  std::array<double, 2> along{facets[0].ends[1][0] - facets[0].ends[0][0], facets[0].ends[1][1] - facets[0].ends[0][1]};
  const double size = std::hypot(along[0], along[1]);
  for (double &x : along) x /= size;
  const auto place = [&](const double *const x) { return along[0] * x[0] + along[1] * x[1]; };
  std::sort(facets.begin(), facets.end(),
            [&](const SideFacet &a, const SideFacet &b) { return place(a.ends[0]) < place(b.ends[0]); });
  std::sort(c.points.begin(), c.points.end(),
            [&](const SidePoint &a, const SidePoint &b) { return place(a.place) < place(b.place); });
  std::map<std::pair<GO, GO>, LO> local_at;
  for (const LO f : local) local_at[{host.mesh.node_gid(host.node(f, 0)), host.mesh.node_gid(host.node(f, 1))}] = f;
  std::map<double, int> point_at;
  c.friction.acts = options.has_friction() && step.contact.friction.anywhere;
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const SidePoint &p = c.points[i];
    point_at[p.gid] = static_cast<int>(i);
    c.free.push_back(p.fixed == 0 && p.weight > 0);
    c.force.push_back(p.weight * p.pressure);
    c.place.push_back(place(p.place));
    c.friction.force.push_back(p.weight * p.friction);
    c.friction.free.push_back(p.acts != 0 && p.weight > 0);
  }
  std::vector<OfFacet> gaps;
  std::map<int, std::set<double>> blocks_at; // of the points
  for (const SideFacet &s : facets) {
    RPC_REQUIRE(s.prescribed == 0, not_covered(options, "displacements are prescribed on it too"));
    const std::array<double, 2> e{s.ends[1][0] - s.ends[0][0], s.ends[1][1] - s.ends[0][1]};
    const auto here = local_at.find({static_cast<GO>(s.gid[0]), static_cast<GO>(s.gid[1])});
    c.facet.push_back(here == local_at.end() ? -1 : here->second);
    c.length.push_back(std::hypot(e[0], e[1]));
    c.ends.push_back({Point{s.ends[0][0], s.ends[0][1], 0}, Point{s.ends[1][0], s.ends[1][1], 0}});
    RPC_REQUIRE(std::abs(e[0] * along[1] - e[1] * along[0]) <= 1e-10 * c.length.back(),
                not_covered(options, "it has a bend, or is curved"));
    std::array<int, 3> of_facet{-1, -1, -1};
    OfFacet g{}, p{}, w{}, limit{};
    const double xi = law(options, 0);
    for (int a = 0; a <= c.order; ++a) {
      const auto found = point_at.find(s.gid[a]);
      RPC_REQUIRE(found != point_at.end(), not_covered(options, "the normal misses the foundation in a node"));
      of_facet[a] = found->second;
      const SidePoint &point = c.points[of_facet[a]];
      g[a] = point.gap;
      p[a] = point.pressure;
      w[a] = point.dent;
      limit[a] = xi + c.rise * w[a];
      blocks_at[of_facet[a]].insert(s.block);
      if (a == 0) c.normal.push_back({point.normal[0], point.normal[1]});
      const std::array<double, 2> &nu = c.normal.back();
      RPC_REQUIRE(std::abs(point.normal[0] - nu[0]) + std::abs(point.normal[1] - nu[1]) <= 1e-10,
                  not_covered(options, "its normals differ within a facet"));
      RPC_REQUIRE(point.fixed != 0 || std::abs(point.direction[0]) + std::abs(point.direction[1]) > 0,
                  not_covered(options, "a node has no direction"));
    }
    c.point.push_back(of_facet);
    c.pressure.push_back(p);
    c.limit_of.push_back({xi, xi, xi});
    if (c.rise > 0 && !contact::is_rigid(xi)) c.limit_of.back() = not_negative(bernstein(c.order, limit));
    add_friction(options, c.points, of_facet, p, c);
    gaps.push_back(g);
    c.modulus = s.modulus;
  }
  for (std::size_t e = 0; e < c.facet.size(); ++e) // where materials meet pressures jump, and a node has a mean
    for (int a = 0; a < 2; ++a)
      if (blocks_at[c.point[e][a]].size() > 1)
        c.pressure[e][a] = c.order == 1 ? c.pressure[e][1 - a] : 2 * c.pressure[e][2] - c.pressure[e][1 - a];
  require_represented_gap(options, comm, c, gaps);
  if (d.axisymmetric()) multiply_by_circles(d.on_axis, options, c);
  return c;
}

} // namespace rpc::bound
