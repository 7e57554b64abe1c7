// SPDX-License-Identifier: BSD-3-Clause
#include "boundary.hpp"

#include "constant_field.hpp"
#include "gauss.hpp"
#include "rpc/contact/law/friction.hpp"
#include "rpc/core/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace rpc::bound
{
namespace
{

/// The host's copy of the facets of a mesh's sides.
struct OnHost {
  const mesh::Mesh &mesh;
  HostView<LO **> of_cell;
  HostView<LO *[2]> cell, node;
  HostView<LO *> middle;
  HostView<double **> coords;
  static constexpr int points_of_fields = 8; // of loads and gaps on a facet

  OnHost(const mesh::Mesh &m, const Facets &f)
      : mesh(m), of_cell("", f.of_cell.extent(0), f.of_cell.extent(1)), cell("", f.size()), node("", f.size()),
        middle("", f.size()), coords("", m.coords.extent(0), 2)
  {
    const auto all = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), f.of_cell);
    for (std::size_t c = 0; c < all.extent(0); ++c)
      for (std::size_t s = 0; s < all.extent(1); ++s) of_cell(c, s) = all(c, s);
    const auto cells = to_host(f.cell), nodes = to_host(f.node);
    const auto middles = to_host(f.middle);
    const auto x = to_host(m.coords);
    for (LO e = 0; e < f.size(); ++e) {
      middle(e) = middles(e);
      for (int k = 0; k < 2; ++k) {
        cell(e, k) = cells(e, k);
        node(e, k) = nodes(e, k);
      }
    }
    for (std::size_t i = 0; i < x.extent(0); ++i)
      for (int d = 0; d < 2; ++d) coords(i, d) = x(i, d);
  }
  /// Numbers of the facets of a side.
  std::vector<LO> facets_of(const mesh::Side &side) const
  {
    const auto cells = to_host(side.cell);
    const auto ordinals = to_host(side.ordinal);
    std::vector<LO> all;
    for (std::size_t k = 0; k < cells.extent(0); ++k) {
      all.push_back(of_cell(cells(k), ordinals(k)));
      RPC_REQUIRE(cell(all.back(), 1) < 0,
                  "deck: \"Adapt->Error Bound\" = guaranteed covers sides on the boundary of the body; side \""
                      << side.name << "\" lies within it. Write \"estimated\"");
    }
    return all;
  }
  std::array<double, 2> edge(const LO f) const
  {
    return {coords(node(f, 1), 0) - coords(node(f, 0), 0), coords(node(f, 1), 1) - coords(node(f, 0), 1)};
  }
  double length_of(const LO f) const { return std::hypot(edge(f)[0], edge(f)[1]); }
  /// Points of a quadrature rule on facets, (facets * points, 2).
  HostView<double **> points(const std::vector<LO> &facets, const Gauss &rule) const
  {
    const std::size_t n = rule.point.size();
    HostView<double **> x("rpc::bound::points", facets.size() * n, 2);
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (std::size_t q = 0; q < n; ++q)
        for (int d = 0; d < 2; ++d)
          x(e * n + q, d) = coords(node(facets[e], 0), d) + rule.point[q] * edge(facets[e])[d];
    return x;
  }
};

/// What the elements make of values at the ends and in the middle of a facet, at a point of it.
double at_point(const int order, const OfFacet &g, const double s)
{
  if (order == 1) return g[0] + s * (g[1] - g[0]);
  return g[0] * (1 - s) * (1 - 2 * s) + g[1] * s * (2 * s - 1) + g[2] * 4 * s * (1 - s);
}

/// Whether the polynomials that stand for a traction on the facets of a side are that traction, between their points too. What they lack, such
/// as half of a jump within a facet, no stress would balance, and J of the exact solution could lie below its bound.
/// @param coefficients  (facets of the mesh, degree, component) times lengths [N]
void require_represented_load(const OnHost &host, const fem::VectorField &traction, const std::string &name,
                              const std::vector<LO> &facets, const HostView<double ***> &coefficients)
{
  constexpr int parts = 4;         // of a facet, of points_of_fields each
  constexpr double allowed = 1e-3; // of the largest traction of the entry: smooth loads stay below it on coarse cells
  const Gauss points = gauss(OnHost::points_of_fields);
  Gauss rule;
  for (int part = 0; part < parts; ++part)
    for (const double s : points.point) rule.point.push_back((part + s) / parts);
  const std::size_t n = rule.point.size();
  const HostPoints x = host.points(facets, rule);
  double largest = 0, worst = 0;
  std::size_t at = 0;
  for (int i = 0; i < 2; ++i) {
    const auto t = evaluate(traction[i], x, "Traction->" + name, host.mesh.comm());
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (std::size_t q = 0; q < n; ++q) {
        double polynomial = 0;
        for (int j = 0; j <= ReferenceStress::degree_of_loads; ++j)
          polynomial += coefficients(facets[e], j, i) / host.length_of(facets[e]) * legendre(j, rule.point[q]);
        const double off = std::abs(t(e * n + q) - polynomial);
        largest = std::max(largest, std::abs(t(e * n + q)));
        if (off > worst) {
          worst = off;
          at = e * n + q;
        }
      }
  }
  RPC_REQUIRE(worst <= allowed * largest,
              "deck: \"Adapt->Error Bound\" = guaranteed covers loads that are smooth within each cell; \"Traction->"
                  << name << "\" is not, at (" << x(at, 0) << ", " << x(at, 1)
                  << "). Let cells end where it jumps or bends, take smaller ones, or write \"estimated\"");
}

/// Whether a prescribed displacement between the nodes is what the elements make of it there.
void require_represented_displacement(const ScalarField &field, const OnHost &host, const std::vector<LO> &facets,
                                      const std::string &name)
{
  if (field.is_constant()) return;
  Gauss rule = gauss(OnHost::points_of_fields);
  rule.point.insert(rule.point.begin(), {0, 1, 0.5}); // the nodes
  const std::size_t n = rule.point.size();
  const HostPoints x = host.points(facets, rule);
  const auto u = evaluate(field, x, "Dirichlet->" + name, host.mesh.comm());
  double largest = 0;
  for (std::size_t q = 0; q < u.extent(0); ++q) largest = std::max(largest, std::abs(u(q)));
  for (std::size_t e = 0; e < facets.size(); ++e)
    for (std::size_t q = 0; q < n; ++q) {
      const double here = at_point(host.mesh.element.order, {u(e * n), u(e * n + 1), u(e * n + 2)}, rule.point[q]);
      RPC_REQUIRE(std::abs(u(e * n + q) - here) <= 1e-10 * largest,
                  "deck: \"Adapt->Error Bound\" = guaranteed covers displacements that the elements represent; "
                  "\"Dirichlet->"
                      << name << "\" is not, at (" << x(e * n + q, 0) << ", " << x(e * n + q, 1)
                      << "). Write \"estimated\"");
    }
}

/// load(f, j, i) += the coefficients of the tractions on a side.
void add_load(const analysis::Problem &problem, const OnHost &host, const fem::TractionLoad &load,
              const HostView<double ***> &sum)
{
  const fem::Discretization &d = problem.discretization();
  const mesh::Side &side = host.mesh.side(load.side, "Traction->" + load.name);
  const fem::VectorField traction = fem::force_per_area(d, side, load);
  const std::vector<LO> facets = host.facets_of(side);
  constexpr int num_points = OnHost::points_of_fields;
  const Gauss rule = gauss(num_points);
  const HostPoints x = host.points(facets, rule);
  const HostView<double ***> own("rpc::bound::load_of_entry", sum.extent(0), sum.extent(1), 2);
  for (int i = 0; i < 2; ++i) {
    const auto t = evaluate(traction[i], x, "Traction->" + load.name, host.mesh.comm());
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (int j = 0; j <= ReferenceStress::degree_of_loads; ++j) {
        for (int q = 0; q < num_points; ++q)
          own(facets[e], j, i) += (2 * j + 1) * rule.weight[q] * legendre(j, rule.point[q]) * t(e * num_points + q) *
                                  host.length_of(facets[e]);
        sum(facets[e], j, i) += own(facets[e], j, i);
      }
  }
  require_represented_load(host, traction, load.name, facets, own);
}

/// Not covered: `what`, on a contact side.
std::string not_covered(const contact::ContactOptions &options, const std::string &what)
{
  return "deck: \"Adapt->Error Bound\" = guaranteed covers straight contact sides with gaps that the elements "
         "represent; \"" +
         options.path + "\", side \"" + options.side + "\": " + what + ". Write \"estimated\"";
}

/// Whether the gap between the nodes is what the elements make of it there.
void require_represented_gap(const contact::ContactOptions &options, const OnHost &host, const ContactFacets &c,
                             const std::vector<OfFacet> &gap)
{
  constexpr int num_points = OnHost::points_of_fields;
  const Gauss rule = gauss(num_points);
  const HostView<double **> x = host.points(c.facet, rule);
  HostView<double *> field;
  if (!options.obstacle.exists()) field = evaluate(options.gap, x, options.path + "->Gap", host.mesh.comm(), true);
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

/// A number of the law of a side, the same everywhere.
double law(const contact::ContactOptions &options, const int parameter)
{
  return value_everywhere(options.*contact::law_parameters[parameter].field)
      .value_or(std::numeric_limits<double>::quiet_NaN());
}

OfFacet not_negative(OfFacet b)
{
  for (double &coefficient : b) coefficient = std::max(0., coefficient);
  return b;
}

/// (points) Of points with friction.
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

/// What friction is at contact points, along the side's tangent; 0 where there is none.
struct FrictionAtPoints {
  std::vector<double> from, traction;
  std::vector<char> acts;

  FrictionAtPoints(const contact::ContactNodes &points, const HostView<double **> &q)
      : from(points.size(), 0.), traction(from), acts(points.size(), 0)
  {
    if (!points.friction.exists()) return;
    const auto any = to_host(where_friction_acts(points));
    const auto normal = to_host(points.normal), start = to_host(points.friction.from);
    for (LO i = 0; i < points.size(); ++i) {
      const auto along = tangent_of({normal(i, 0), normal(i, 1)});
      for (int d = 0; d < 2; ++d) from[i] += along[d] * start(i, d);
      for (int d = 0; d < 2 && q.extent(0) > 0; ++d) traction[i] += along[d] * q(i, d);
      acts[i] = any(i);
    }
  }
};

/// Friction at a facet whose last point has been added to the side.
void add_friction(const contact::ContactOptions &options, const FrictionAtPoints &points, const int first,
                  const std::array<int, 3> &of_facet, const OfFacet &pressure, ContactFacets &c)
{
  const double mu = law(options, 3), s_0 = law(options, 4), s_max = law(options, 5);
  OfFacet q{}, from{}, s{};
  for (int a = 0; a <= c.order; ++a) {
    const int i = first + of_facet[a];
    q[a] = points.traction[i];
    from[a] = points.from[i];
    s[a] = contact::friction_bound(pressure[a], {mu, s_0, s_max});
  }
  s = mu > 0 ? not_negative(bernstein(c.order, s)) : OfFacet{s[0], s[0], s[0]};
  for (double &coefficient : s) coefficient = std::min(coefficient, s_max);
  c.friction.traction.push_back(q);
  c.friction.slip_from.push_back(from);
  c.friction.limit_of.push_back(s);
}

/// What the contact law, the pressures and the normals are at the facets of a side.
ContactFacets contact_side(const analysis::Problem &problem, const analysis::Model &model, const analysis::Step &step,
                           const OnHost &host, const int k, const PointTractions &solution,
                           const HostView<char *[2]> &prescribed)
{
  const contact::ContactOptions &options = model.contact[k];
  const contact::ContactNodes &points = step.contact;
  const auto node = to_host(points.node);
  const auto weight = to_host(points.weight), gap = to_host(points.gap), dent = to_host(points.dent);
  const auto normal = to_host(points.normal), direction = to_host(points.direction);
  const auto fixed = to_host(points.fixed);
  const auto block = to_host(host.mesh.block);
  const auto lame = to_host(fem::lame_table(problem.discretization(), problem.model().materials));
  ContactFacets c;
  c.order = host.mesh.element.order;
  c.rise = law(options, 1);
  c.spring = 1 / law(options, 2);
  c.facet = host.facets_of(host.mesh.side(options.side, options.path));
  std::map<LO, int> point_at;
  const int first = points.first(k), last = points.first(k + 1);
  for (int i = first; i < last; ++i) point_at[node(i)] = i - first;
  c.free.resize(last - first);
  for (int i = first; i < last; ++i) {
    c.free[i - first] = !fixed(i) && weight(i) > 0;
    c.force.push_back(weight(i) * solution.pressure(i));
  }
  c.place.resize(last - first);
  const FrictionAtPoints friction(points, solution.along);
  c.friction.acts = options.has_friction() && points.friction.anywhere;
  for (int i = first; i < last; ++i) {
    c.friction.force.push_back(weight(i) * friction.traction[i]);
    c.friction.free.push_back(friction.acts[i] && weight(i) > 0);
  }
  std::vector<OfFacet> gaps;
  std::map<int, std::set<int>> blocks_at; // of the points
  std::array<double, 2> along{};
  for (const LO f : c.facet) {
    RPC_REQUIRE(!prescribed(f, 0) && !prescribed(f, 1), not_covered(options, "displacements are prescribed on it too"));
    const LO at[3] = {host.node(f, 0), host.node(f, 1), host.middle(f)};
    const std::array<double, 2> e = host.edge(f);
    if (c.length.empty()) along = {e[0] / host.length_of(f), e[1] / host.length_of(f)};
    c.length.push_back(host.length_of(f));
    c.ends.push_back({Point{host.coords(at[0], 0), host.coords(at[0], 1), 0},
                      Point{host.coords(at[1], 0), host.coords(at[1], 1), 0}});
    RPC_REQUIRE(std::abs(e[0] * along[1] - e[1] * along[0]) <= 1e-10 * c.length.back(),
                not_covered(options, "it has a bend, or is curved"));
    std::array<int, 3> of_facet{-1, -1, -1};
    OfFacet g{};
    for (int a = 0; a <= c.order; ++a) {
      const auto found = point_at.find(at[a]);
      RPC_REQUIRE(found != point_at.end(), not_covered(options, "the normal misses the foundation in a node"));
      of_facet[a] = found->second;
      const int i = first + found->second;
      g[a] = gap(i);
      c.place[of_facet[a]] = along[0] * host.coords(at[a], 0) + along[1] * host.coords(at[a], 1);
      if (c.normal.size() < c.length.size()) c.normal.push_back({normal(i, 0), normal(i, 1)});
      const std::array<double, 2> &nu = c.normal.back();
      RPC_REQUIRE(std::abs(normal(i, 0) - nu[0]) + std::abs(normal(i, 1) - nu[1]) <= 1e-10,
                  not_covered(options, "its normals differ within a facet"));
      RPC_REQUIRE(fixed(i) || std::abs(direction(i, 0)) + std::abs(direction(i, 1)) > 0,
                  not_covered(options, "a node has no direction"));
    }
    c.point.push_back(of_facet);
    const double xi = law(options, 0);
    OfFacet p{}, w{}, limit{};
    for (int a = 0; a <= c.order; ++a) {
      p[a] = solution.pressure(first + of_facet[a]);
      w[a] = dent(first + of_facet[a]);
      limit[a] = xi + c.rise * w[a];
      blocks_at[of_facet[a]].insert(block(host.cell(f, 0)));
    }
    c.pressure.push_back(p);
    c.dent.push_back(w);
    c.limit_of.push_back({xi, xi, xi});
    if (c.rise > 0 && !contact::is_rigid(xi)) c.limit_of.back() = not_negative(bernstein(c.order, limit));
    add_friction(options, friction, first, of_facet, p, c);
    gaps.push_back(g);
    const double lambda = lame(block(host.cell(f, 0)), 0), mu = lame(block(host.cell(f, 0)), 1);
    c.modulus = mu * (3 * lambda + 2 * mu) / (lambda + mu);
  }
  for (std::size_t e = 0; e < c.facet.size(); ++e) // where materials meet pressures jump, and a node has a mean
    for (int a = 0; a < 2; ++a)
      if (blocks_at[c.point[e][a]].size() > 1)
        c.pressure[e][a] = c.order == 1 ? c.pressure[e][1 - a] : 2 * c.pressure[e][2] - c.pressure[e][1 - a];
  require_represented_gap(options, host, c, gaps);
  return c;
}

} // namespace

Boundary boundary_of(const analysis::Problem &problem, const analysis::Step &step, const Facets &facets,
                     const PointTractions &solution)
{
  const analysis::Model model = problem.model().seen_at(step.time);
  const OnHost host(*problem.discretization().mesh, facets);
  HostView<char *[2]> prescribed("rpc::bound::prescribed", facets.size());
  for (const auto &condition : model.dirichlet) {
    const auto &sides = host.mesh.sides;
    const auto side =
        std::find_if(sides.begin(), sides.end(), [&](const mesh::Side &s) { return s.name == condition.side; });
    RPC_REQUIRE(
        side != sides.end(),
        "deck: \"Adapt->Error Bound\" = guaranteed covers displacements that are prescribed on sides; \"Dirichlet->"
            << condition.name << "\" prescribes one at points, where the exact solution has no force. Write "
            << "\"estimated\"");
    const std::vector<LO> facets = host.facets_of(*side);
    for (int i = 0; i < 2; ++i) {
      if (!condition.displacement[i]) continue;
      require_represented_displacement(*condition.displacement[i], host, facets, condition.name);
      for (const LO f : facets) prescribed(f, i) = 1;
    }
  }
  Boundary b;
  b.tractions.known = DeviceView<char **>("rpc::bound::known", facets.size(), 2);
  b.tractions.load = DeviceView<double ***>("rpc::bound::load", facets.size(), ReferenceStress::degree_of_loads + 1, 2);
  const auto known = Kokkos::create_mirror_view(b.tractions.known);
  for (LO f = 0; f < facets.size(); ++f)
    for (int i = 0; i < 2; ++i) known(f, i) = host.cell(f, 1) < 0 && !prescribed(f, i);
  Kokkos::deep_copy(b.tractions.known, known);
  HostView<double ***> load("rpc::bound::load", facets.size(), ReferenceStress::degree_of_loads + 1, 2);
  for (const auto &traction : model.tractions) add_load(problem, host, traction, load);
  const auto to = Kokkos::create_mirror_view(b.tractions.load);
  for (std::size_t f = 0; f < load.extent(0); ++f)
    for (std::size_t j = 0; j < load.extent(1); ++j)
      for (int i = 0; i < 2; ++i) to(f, j, i) = load(f, j, i);
  Kokkos::deep_copy(b.tractions.load, to);
  for (int k = 0; k < step.contact.num_sides(); ++k)
    b.sides.push_back(contact_side(problem, model, step, host, k, solution, prescribed));
  return b;
}

BoundaryTractions with_contact(const BoundaryTractions &loads, const std::vector<ContactFacets> &sides,
                               const std::vector<SideTractions> &contact)
{
  BoundaryTractions all = loads;
  all.load = DeviceView<double ***>("rpc::bound::load", loads.load.extent(0), loads.load.extent(1), 2);
  const auto load = Kokkos::create_mirror_view(all.load);
  Kokkos::deep_copy(load, loads.load);
  for (std::size_t s = 0; s < sides.size(); ++s)
    for (std::size_t e = 0; e < sides[s].facet.size(); ++e) {
      const OfFacet p = legendre_of(sides[s].order, contact[s].pressure[e]);
      const bool rubs = sides[s].friction.acts;
      const OfFacet q = rubs ? legendre_of(sides[s].order, contact[s].friction[e]) : OfFacet{};
      const std::array<double, 2> &normal = sides[s].normal[e], along = tangent_of(normal);
      for (int j = 0; j <= sides[s].order; ++j)
        for (int i = 0; i < 2; ++i)
          load(sides[s].facet[e], j, i) -= sides[s].length[e] * (normal[i] * p[j] + along[i] * q[j]);
    }
  Kokkos::deep_copy(all.load, load);
  return all;
}

std::string shown(const double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

} // namespace rpc::bound
