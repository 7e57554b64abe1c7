// SPDX-License-Identifier: BSD-3-Clause
#include "space_contact_side.hpp"

#include "contact_side.hpp"
#include "rpc/core/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace rpc::bound
{
namespace
{

std::string not_covered_of_side(const contact::ContactOptions &options, const std::string &what)
{
  return "deck: \"Adapt->Error Bound\" = guaranteed covers flat contact sides with gaps that the elements represent; "
         "\"" +
         options.path + "\", side \"" + options.side + "\": " + what + ". Write \"estimated\"";
}

/// Whether the gap between the nodes is what the elements make of it there.
/// @param gap  (facets) Bernstein coefficients
void require_represented_gap_in_space(const contact::ContactOptions &options, const Comm &comm, const SpaceContact &c,
                                      const std::vector<OfTriangle> &gap)
{
  const FacetRule rule = facet_rule(3, 4);
  const HostView<double **> x("rpc::bound::points", c.corner.size() * rule.size(), 3);
  for (std::size_t e = 0; e < c.corner.size(); ++e)
    for (int q = 0; q < rule.size(); ++q)
      for (int v = 0; v < 3; ++v)
        for (int d = 0; d < 3; ++d) x(e * rule.size() + q, d) += rule.point[q][v] * c.corner[e][v][d];
  HostView<double *> field;
  if (!options.obstacle.exists()) field = evaluate(options.gap, x, options.path + "->Gap", comm, true);
  for (std::size_t e = 0; e < c.corner.size(); ++e)
    for (int q = 0; q < rule.size(); ++q) {
      const Barycentric &lambda = rule.point[q];
      const double here = value_of(c.order, gap[e], lambda);
      const std::size_t at = e * rule.size() + q;
      const Point place{x(at, 0), x(at, 1), x(at, 2)};
      const auto distance = options.obstacle.exists() ? contact::distance_along(options.obstacle, place, c.normal)
                                                      : std::optional<double>(field(at));
      const double scale = std::sqrt(c.area[e]) + std::abs(here);
      RPC_REQUIRE(
          distance && std::abs(*distance - here) <= 1e-10 * scale,
          not_covered_of_side(options, "at " + place_in_space(place) + " the gap is another than between its nodes"));
    }
}

/// Two unit vectors across a normal, the first one along the axis that lies most across it.
std::array<Point, 2> axes_across(const Point &normal)
{
  int least = 0;
  for (int d = 1; d < 3; ++d)
    if (std::abs(normal[d]) < std::abs(normal[least]) - 1e-10) least = d;
  const double size = std::sqrt(1 - normal[least] * normal[least]);
  std::array<Point, 2> axis{};
  for (int d = 0; d < 3; ++d) axis[0][d] = ((d == least) - normal[least] * normal[d]) / size;
  axis[1] = cross(normal, axis[0]);
  return axis;
}

/// A facet of a side, for all ranks.
struct SpaceSideFacet {
  double gid[6];       // of its nodes in their order
  double corner[3][3]; // [m]
  double block, modulus, prescribed;
};

std::vector<SpaceSideFacet> own_side_facets(const fem::Discretization &discretization, const analysis::Model &model,
                                            const SpaceFacetsOnHost &host, const std::vector<LO> &facets,
                                            const HostView<char *[3]> &prescribed)
{
  const auto block = to_host(host.mesh.block);
  const auto lame = to_host(fem::lame_table(discretization, model.materials));
  std::vector<SpaceSideFacet> all;
  for (const LO f : facets) {
    const LO cell = host.cell(f, 0);
    if (cell < 0 || cell >= host.mesh.num_owned_cells) continue;
    SpaceSideFacet s{};
    for (std::size_t a = 0; a < host.node.extent(1); ++a)
      s.gid[a] = static_cast<double>(host.mesh.node_gid(host.node(f, a)));
    for (int v = 0; v < 3; ++v)
      for (int d = 0; d < 3; ++d) s.corner[v][d] = host.coords(host.node(f, v), d);
    s.block = block(cell);
    const double lambda = lame(block(cell), 0), mu = lame(block(cell), 1);
    s.modulus = mu * (3 * lambda + 2 * mu) / (lambda + mu);
    s.prescribed = prescribed(f, 0) || prescribed(f, 1) || prescribed(f, 2);
    all.push_back(s);
  }
  return all;
}

/// The numbers of this rank's points of a side.
/// A vertex of quadratic triangles has no weight, and so no direction in the solution; here it has one, and may be held.
std::vector<SpacePoint> own_side_points(const analysis::Step &step, const int k, const SpaceFacetsOnHost &host,
                                        const PointTractions &solution)
{
  const contact::ContactNodes &points = step.contact;
  const auto held = to_host(step.elastic.dirichlet.fixed);
  const auto node = to_host(points.node);
  const auto weight = to_host(points.weight), gap = to_host(points.gap), dent = to_host(points.dent);
  const auto free_gap = to_host(points.free_gap);
  const auto normal = to_host(points.normal), direction = to_host(points.direction);
  const auto fixed = to_host(points.fixed);
  const bool rubs = points.friction.exists();
  const auto from = to_host(points.friction.from);
  const auto acts = to_host(rubs ? where_friction_acts(points) : DeviceView<char *>());
  std::vector<SpacePoint> all;
  for (int i = points.first(k); i < points.first(k + 1); ++i) {
    SpacePoint p{};
    p.gid = static_cast<double>(host.mesh.node_gid(node(i)));
    p.id = static_cast<double>(host.mesh.node_id(node(i)));
    p.weight = weight(i);
    const bool is_vertex = host.mesh.element.order == 2 && p.weight == 0;
    p.pressure = solution.pressure(i);
    p.gap = gap(i);
    p.dent = dent(i);
    p.free_gap = free_gap(i);
    p.fixed = fixed(i);
    p.acts = rubs && acts(i);
    for (int d = 0; d < 3; ++d) {
      p.place[d] = host.coords(node(i), d);
      p.normal[d] = normal(i, d);
      p.direction[d] = direction(i, d);
      if (is_vertex) p.direction[d] = held(dof(3, node(i), d)) ? 0 : p.normal[d];
      if (rubs) p.slip_from[d] = from(i, d);
      if (solution.along.extent(0) > 0) p.friction[d] = solution.along(i, d);
    }
    if (is_vertex) {
      p.fixed = p.direction[0] == 0 && p.direction[1] == 0 && p.direction[2] == 0;
      p.acts = rubs && p.fixed == 0;
    }
    all.push_back(p);
  }
  return all;
}

std::array<double, 2> along_axes(const SpaceContact &c, const double *const x)
{
  std::array<double, 2> along{};
  for (int k = 0; k < 2; ++k) along[k] = c.axis[k][0] * x[0] + c.axis[k][1] * x[1] + c.axis[k][2] * x[2];
  return along;
}

/// What the side has of its points.
void add_points(const contact::ContactOptions &options, SpaceContact &c)
{
  for (int d = 0; d < 3; ++d) c.normal[d] = c.points[0].normal[d];
  c.axis = axes_across(c.normal);
  for (const SpacePoint &p : c.points) {
    for (int d = 0; d < 3; ++d)
      RPC_REQUIRE(std::abs(p.normal[d] - c.normal[d]) <= 1e-10, not_covered_of_side(options, "its normals differ"));
    RPC_REQUIRE(p.fixed != 0 || std::abs(p.direction[0]) + std::abs(p.direction[1]) + std::abs(p.direction[2]) > 0,
                not_covered_of_side(options, "a node has no direction"));
    c.free.push_back(p.fixed == 0 && (p.weight > 0 || c.order == 2));
    c.force.push_back(p.weight * p.pressure);
    c.place.push_back(along_axes(c, p.place));
    c.friction.traction.push_back(along_axes(c, p.friction));
    c.friction.slip_from.push_back(along_axes(c, p.slip_from));
    c.friction.free.push_back(p.acts != 0 && (p.weight > 0 || c.order == 2));
    for (int k = 0; k < 2; ++k) c.friction.force[k].push_back(p.weight * c.friction.traction.back()[k]);
  }
}

/// The limits of friction on a facet at pressures, negative ones cut off.
OfTriangle friction_limit(const contact::ContactOptions &options, const OfTriangle &pressure)
{
  const contact::Friction friction{law(options, 3), law(options, 4), law(options, 5)};
  OfTriangle s{};
  for (std::size_t a = 0; a < s.size(); ++a)
    s[a] = std::clamp(contact::friction_bound(pressure[a], friction), 0., std::max(0., friction.limit));
  return s;
}

} // namespace

std::string place_in_space(const Point &x)
{
  return "(" + shown(x[0]) + ", " + shown(x[1]) + ", " + shown(x[2]) + ")";
}

SpaceContact space_side(const fem::Discretization &discretization, const analysis::Model &model,
                        const analysis::Step &step, const SpaceFacetsOnHost &host, const int k,
                        const PointTractions &solution, const HostView<char *[3]> &prescribed)
{
  const contact::ContactOptions &options = model.contact[k];
  const Comm &comm = host.mesh.comm();
  SpaceContact c;
  c.order = host.mesh.element.order;
  c.rise = law(options, 1);
  c.spring = 1 / law(options, 2);
  c.friction.acts = options.has_friction() && step.contact.friction.anywhere;
  const std::vector<LO> local = host.facets_of(host.mesh.side(options.side, options.path));
  std::vector<SpaceSideFacet> facets =
      rows_of_all(comm, own_side_facets(discretization, model, host, local, prescribed));
  c.points = rows_of_all(comm, own_side_points(step, k, host, solution));
  if (facets.empty()) return c;
  RPC_REQUIRE(!c.points.empty(), not_covered_of_side(options, "the normal misses the foundation in a node"));
  std::sort(c.points.begin(), c.points.end(), [](const SpacePoint &a, const SpacePoint &b) { return a.id < b.id; });
  std::map<double, int> point_at; // by gid
  for (std::size_t i = 0; i < c.points.size(); ++i) point_at[c.points[i].gid] = static_cast<int>(i);
  add_points(options, c);
  std::map<std::array<double, 3>, LO> local_at;
  for (const LO f : local) {
    std::array<double, 3> gid{};
    for (int v = 0; v < 3; ++v) gid[v] = static_cast<double>(host.mesh.node_gid(host.node(f, v)));
    local_at[gid] = f;
  }
  const int nodes = nodes_of_triangle(c.order);
  std::map<std::array<int, 6>, SpaceSideFacet> in_order; // by their points
  for (const SpaceSideFacet &s : facets) {
    std::array<int, 6> of_facet{};
    for (int a = 0; a < nodes; ++a) {
      const auto found = point_at.find(s.gid[a]);
      RPC_REQUIRE(found != point_at.end(), not_covered_of_side(options, "the normal misses the foundation in a node"));
      of_facet[a] = found->second;
    }
    in_order[of_facet] = s;
  }
  std::vector<OfTriangle> gaps;
  std::map<int, std::set<double>> blocks_at; // of the points
  Point across{};                            // the normal of the first facet
  const double xi = law(options, 0);
  for (const auto &[of_facet, s] : in_order) {
    RPC_REQUIRE(s.prescribed == 0, not_covered_of_side(options, "displacements are prescribed on it too"));
    std::array<Point, 3> corner{};
    OfTriangle g{}, p{}, limit{};
    for (int v = 0; v < 3; ++v)
      for (int d = 0; d < 3; ++d) corner[v][d] = s.corner[v][d];
    for (int a = 0; a < nodes; ++a) {
      const SpacePoint &point = c.points[of_facet[a]];
      g[a] = point.gap;
      p[a] = point.pressure;
      limit[a] = c.rise > 0 && !contact::is_rigid(xi) ? xi + c.rise * point.dent : xi;
      blocks_at[of_facet[a]].insert(s.block);
    }
    if (c.order == 2) p = through_middles(p);
    if (!contact::is_rigid(xi)) limit = bernstein_of(c.order, limit);
    for (double &of_limit : limit) of_limit = std::max(0., of_limit);
    const Point n = cross(difference(corner[1], corner[0]), difference(corner[2], corner[0]));
    c.area.push_back(length(n) / 2);
    if (c.area.size() == 1) across = scaled(1 / length(n), n);
    const Point bend = difference(n, scaled(inner(n, across), across));
    RPC_REQUIRE(length(bend) <= 1e-10 * length(n), not_covered_of_side(options, "it has a bend, or is curved"));
    const auto here = local_at.find({s.gid[0], s.gid[1], s.gid[2]});
    c.facet.push_back(here == local_at.end() ? -1 : here->second);
    c.corner.push_back(corner);
    c.point.push_back(of_facet);
    c.pressure.push_back(p);
    c.limit_of.push_back(limit);
    c.friction.limit_of.push_back(friction_limit(options, p));
    c.modulus = s.modulus;
    gaps.push_back(bernstein_of(c.order, g));
  }
  // Where materials meet pressures jump, and a node has a mean; where the node is held it has none.
  for (std::size_t e = 0; e < c.facet.size(); ++e) {
    const auto is_own = [&](const int a) {
      const int i = c.point[e][a];
      return c.free[i] && blocks_at[i].size() == 1;
    };
    const int from = c.order == 1 ? 0 : 3; // where the nodes with weight are
    double sum = 0;
    int known = 0;
    for (int a = from; a < nodes; ++a)
      if (is_own(a)) {
        sum += c.pressure[e][a];
        ++known;
      }
    for (int a = from; a < nodes && known > 0; ++a)
      if (!is_own(a)) c.pressure[e][a] = sum / known;
    if (c.order == 2) c.pressure[e] = through_middles(c.pressure[e]);
  }
  require_represented_gap_in_space(options, comm, c, gaps);
  return c;
}

} // namespace rpc::bound
