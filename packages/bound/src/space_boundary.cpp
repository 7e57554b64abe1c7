// SPDX-License-Identifier: BSD-3-Clause
#include "space_boundary.hpp"

#include "boundary.hpp"
#include "constant_field.hpp"
#include "facet_polynomials.hpp"
#include "rpc/core/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace rpc::bound
{
namespace
{

constexpr const char *covers = "deck: \"Adapt->Error Bound\" = guaranteed covers ";

/// The host's copy of the facets of a mesh's sides.
struct FacetsOnHost {
  const mesh::Mesh &mesh;
  HostView<LO **> nodes_of_cell, of_cell, cell, node;
  HostView<double **> coords;

  FacetsOnHost(const mesh::Mesh &m, const SpaceFacets &f)
      : mesh(m), nodes_of_cell(copied(f.nodes_of_cell)), of_cell(copied(f.of_cell)), cell(copied(f.cell)),
        node(copied(f.node)), coords("", m.coords.extent(0), 3)
  {
    const auto x = to_host(m.coords);
    for (std::size_t i = 0; i < x.extent(0); ++i)
      for (int d = 0; d < 3; ++d) coords(i, d) = x(i, d);
  }
  template <class View>
  static HostView<LO **> copied(const View &view)
  {
    const auto from = to_host(view);
    HostView<LO **> to("", from.extent(0), from.extent(1));
    for (std::size_t i = 0; i < from.extent(0); ++i)
      for (std::size_t j = 0; j < from.extent(1); ++j) to(i, j) = from(i, j);
    return to;
  }
  /// Numbers of the facets of a side.
  std::vector<LO> facets_of(const mesh::Side &side) const
  {
    const auto cells = to_host(side.cell);
    const auto ordinals = to_host(side.ordinal);
    const auto given = to_host(mesh.cells);
    std::vector<LO> all;
    for (std::size_t k = 0; k < cells.extent(0); ++k) {
      const auto &local = mesh.element.facets()[ordinals(k)];
      int opposite = 0;
      for (int v = 0; v < 4; ++v) {
        bool on_it = false;
        for (int a = 0; a < 3; ++a) on_it = on_it || given(cells(k), local[a]) == nodes_of_cell(cells(k), v);
        if (!on_it) opposite = v;
      }
      all.push_back(of_cell(cells(k), opposite));
      RPC_REQUIRE(cell(all.back(), 1) < 0, covers << "sides on the boundary of the body; side \"" << side.name
                                                  << "\" lies within it. Write \"estimated\"");
    }
    return all;
  }
  Point corner(const LO f, const int v) const
  {
    return {coords(node(f, v), 0), coords(node(f, v), 1), coords(node(f, v), 2)};
  }
  /// Normal as long as the area.
  Point normal(const LO f) const
  {
    const Point a = corner(f, 0), b = corner(f, 1), c = corner(f, 2);
    Point n;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = ((b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j])) / 2;
    }
    return n;
  }
  double area(const LO f) const
  {
    const Point n = normal(f);
    return std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
  /// Points of a rule on facets, (facets * points, 3).
  HostView<double **> points(const std::vector<LO> &facets, const FacetRule &rule) const
  {
    const std::size_t n = rule.size();
    HostView<double **> x("rpc::bound::points", facets.size() * n, 3);
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (std::size_t q = 0; q < n; ++q)
        for (int v = 0; v < 3; ++v)
          for (int d = 0; d < 3; ++d) x(e * n + q, d) += rule.point[q][v] * coords(node(facets[e], v), d);
    return x;
  }
};

std::string place_of(const HostView<double **> &x, const std::size_t at)
{
  return "(" + shown(x(at, 0)) + ", " + shown(x(at, 1)) + ", " + shown(x(at, 2)) + ")";
}

/// Values of polynomials at the points of a rule, (polynomials, points).
std::vector<std::vector<double>> values_of(const FacetPolynomials &polynomials, const FacetRule &rule)
{
  std::vector<std::vector<double>> values(polynomials.size());
  for (int j = 0; j < polynomials.size(); ++j)
    for (const Barycentric &at : rule.point) values[j].push_back(polynomials(j, at));
  return values;
}

/// load(f, j, i) += the coefficients of the tractions on a side. What they lack of the tractions, such as half of a jump within a facet, no
/// stress would balance, and J of the exact solution could lie below its bound: that is refused.
void add_space_load(const analysis::Problem &problem, const FacetsOnHost &host, const fem::TractionLoad &load,
                    const HostView<double ***> &sum)
{
  constexpr int along = 5;         // points for the coefficients: exact for products of degree 8
  constexpr int parts = 3;         // of a facet along each side, where what is lacking is looked for
  constexpr double allowed = 1e-3; // of the largest traction of the entry: smooth loads stay below it on coarse cells
  const mesh::Side &side = host.mesh.side(load.side, "Traction->" + load.name);
  const fem::VectorField traction = fem::force_per_area(problem.discretization(), side, load);
  const std::vector<LO> facets = host.facets_of(side);
  const FacetPolynomials polynomials(3, ReferenceStress::degree_of_loads_in_space);
  const FacetRule rule = facet_rule(3, along), fine = refined(3, facet_rule(3, along - 1), parts);
  const auto values = values_of(polynomials, rule), there = values_of(polynomials, fine);
  const HostView<double **> x = host.points(facets, rule), between = host.points(facets, fine);
  double largest = 0, worst = 0;
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i) {
    const auto t = evaluate(traction[i], x, "Traction->" + load.name, host.mesh.comm());
    const auto exact = evaluate(traction[i], between, "Traction->" + load.name, host.mesh.comm());
    for (std::size_t e = 0; e < facets.size(); ++e) {
      std::vector<double> own(polynomials.size(), 0.);
      for (int j = 0; j < polynomials.size(); ++j) {
        for (int q = 0; q < rule.size(); ++q) own[j] += rule.weight[q] * values[j][q] * t(e * rule.size() + q);
        sum(facets[e], j, i) += host.area(facets[e]) * own[j];
      }
      for (int q = 0; q < fine.size(); ++q) {
        double off = exact(e * fine.size() + q);
        largest = std::max(largest, std::abs(off));
        for (int j = 0; j < polynomials.size(); ++j) off -= own[j] * there[j][q];
        if (std::abs(off) > worst) {
          worst = std::abs(off);
          at = e * fine.size() + q;
        }
      }
    }
  }
  RPC_REQUIRE(worst <= allowed * largest, covers << "loads that are smooth within each cell; \"Traction->" << load.name
                                                 << "\" is not, at " << place_of(between, at)
                                                 << ". Let cells end where it jumps or bends, take smaller ones, or "
                                                    "write \"estimated\"");
}

std::string contact_not_covered(const contact::ContactOptions &options, const std::string &what)
{
  return std::string(covers) + "flat contact sides with gaps that the elements represent; \"" + options.path +
         "\", side \"" + options.side + "\": " + what + ". Write \"estimated\"";
}

/// Whether the gap between the nodes is what the elements make of it there.
void require_linear_gap(const contact::ContactOptions &options, const FacetsOnHost &host, const SpaceContact &c,
                        const std::vector<OfTriangle> &gap)
{
  const FacetRule rule = facet_rule(3, 4);
  const HostView<double **> x = host.points(c.facet, rule);
  HostView<double *> field;
  if (!options.obstacle.exists()) field = evaluate(options.gap, x, options.path + "->Gap", host.mesh.comm(), true);
  for (std::size_t e = 0; e < c.facet.size(); ++e)
    for (int q = 0; q < rule.size(); ++q) {
      const Barycentric &lambda = rule.point[q];
      const double here = gap[e][0] * lambda[0] + gap[e][1] * lambda[1] + gap[e][2] * lambda[2];
      const std::size_t at = e * rule.size() + q;
      const auto distance = options.obstacle.exists()
                                ? contact::distance_along(options.obstacle, {x(at, 0), x(at, 1), x(at, 2)}, c.normal)
                                : std::optional<double>(field(at));
      const double scale = std::sqrt(c.area[e]) + std::abs(here);
      RPC_REQUIRE(distance && std::abs(*distance - here) <= 1e-10 * scale,
                  contact_not_covered(options, "at " + place_of(x, at) + " the gap is another than between its nodes"));
    }
}

/// What the contact law, the pressures and the normals are at the facets of a side.
SpaceContact space_side(const analysis::Problem &problem, const analysis::Model &model, const analysis::Step &step,
                        const FacetsOnHost &host, const int k, const HostView<double *> &pressure,
                        const HostView<char *[3]> &prescribed)
{
  const contact::ContactOptions &options = model.contact[k];
  const contact::ContactNodes &points = step.contact;
  const auto node = to_host(points.node);
  const auto weight = to_host(points.weight), gap = to_host(points.gap);
  const auto normal = to_host(points.normal), direction = to_host(points.direction);
  const auto fixed = to_host(points.fixed);
  const auto block = to_host(host.mesh.block);
  const auto lame = to_host(fem::lame_table(problem.discretization(), problem.model().materials));
  SpaceContact c;
  c.limit = value_everywhere(options.*contact::law_parameters[0].field).value();
  c.facet = host.facets_of(host.mesh.side(options.side, options.path));
  const int first = points.first(k), last = points.first(k + 1);
  std::map<LO, int> point_at;
  for (int i = first; i < last; ++i) point_at[node(i)] = i - first;
  for (int i = first; i < last; ++i) {
    c.free.push_back(!fixed(i) && weight(i) > 0);
    c.force.push_back(weight(i) * pressure(i));
  }
  c.place.resize(last - first);
  std::vector<OfTriangle> gaps;
  std::map<int, std::set<int>> blocks_at; // of the points
  Point axis[2]{};                        // in the side
  for (const LO f : c.facet) {
    RPC_REQUIRE(!prescribed(f, 0) && !prescribed(f, 1) && !prescribed(f, 2),
                contact_not_covered(options, "displacements are prescribed on it too"));
    c.area.push_back(host.area(f));
    const Point n = host.normal(f);
    if (c.area.size() == 1) {
      for (int d = 0; d < 3; ++d) c.normal[d] = n[d] / c.area[0];
      int least = 0; // the axis that lies most along the side
      for (int d = 1; d < 3; ++d)
        if (std::abs(c.normal[d]) < std::abs(c.normal[least]) - 1e-10) least = d;
      const double length = std::sqrt(1 - c.normal[least] * c.normal[least]);
      for (int d = 0; d < 3; ++d) axis[0][d] = ((d == least) - c.normal[least] * c.normal[d]) / length;
      for (int d = 0; d < 3; ++d) {
        const int i = (d + 1) % 3, j = (d + 2) % 3;
        axis[1][d] = c.normal[i] * axis[0][j] - c.normal[j] * axis[0][i];
      }
    }
    double across = 0;
    for (int d = 0; d < 3; ++d) across += c.normal[d] * n[d];
    double bend = 0;
    for (int d = 0; d < 3; ++d) bend += std::abs(n[d] - across * c.normal[d]);
    RPC_REQUIRE(bend <= 1e-10 * c.area.back(), contact_not_covered(options, "it has a bend, or is curved"));
    std::array<int, 3> of_facet{};
    OfTriangle g{}, p{};
    for (int a = 0; a < 3; ++a) {
      const auto found = point_at.find(host.node(f, a));
      RPC_REQUIRE(found != point_at.end(), contact_not_covered(options, "the normal misses the foundation in a node"));
      of_facet[a] = found->second;
      const int i = first + found->second;
      g[a] = gap(i);
      p[a] = pressure(i);
      blocks_at[found->second].insert(block(host.cell(f, 0)));
      const Point x = host.corner(f, a);
      for (int k2 = 0; k2 < 2; ++k2)
        c.place[found->second][k2] = axis[k2][0] * x[0] + axis[k2][1] * x[1] + axis[k2][2] * x[2];
      RPC_REQUIRE(fixed(i) || std::abs(direction(i, 0)) + std::abs(direction(i, 1)) + std::abs(direction(i, 2)) > 0,
                  contact_not_covered(options, "a node has no direction"));
    }
    c.point.push_back(of_facet);
    c.pressure.push_back(p);
    gaps.push_back(g);
    const double lambda = lame(block(host.cell(f, 0)), 0), mu = lame(block(host.cell(f, 0)), 1);
    c.modulus = mu * (3 * lambda + 2 * mu) / (lambda + mu);
  }
  for (int d = 0; d < 3; ++d) c.normal[d] = normal(first, d);
  for (int i = first; i < last; ++i)
    for (int d = 0; d < 3; ++d)
      RPC_REQUIRE(std::abs(normal(i, d) - c.normal[d]) <= 1e-10, contact_not_covered(options, "its normals differ"));
  // Where materials meet pressures jump, and a node has a mean; where the node is held it has none.
  for (std::size_t e = 0; e < c.facet.size(); ++e) {
    const auto is_own = [&](const int a) {
      const int i = c.point[e][a];
      return c.free[i] && blocks_at[i].size() == 1;
    };
    double sum = 0;
    int known = 0;
    for (int a = 0; a < 3; ++a)
      if (is_own(a)) {
        sum += c.pressure[e][a];
        ++known;
      }
    for (int a = 0; a < 3 && known > 0; ++a)
      if (!is_own(a)) c.pressure[e][a] = sum / known;
  }
  require_linear_gap(options, host, c, gaps);
  return c;
}

} // namespace

SpaceBoundary boundary_of(const analysis::Problem &problem, const analysis::Step &step, const SpaceInput &in,
                          const HostView<double *> &pressure)
{
  const analysis::Model model = problem.model().seen_at(step.time);
  const SpaceFacets &facets = in.facets;
  const FacetsOnHost host(*problem.discretization().mesh, facets);
  HostView<char *[3]> prescribed("rpc::bound::prescribed", facets.size());
  for (const auto &condition : model.dirichlet) {
    const auto &sides = host.mesh.sides;
    const auto side =
        std::find_if(sides.begin(), sides.end(), [&](const mesh::Side &s) { return s.name == condition.side; });
    RPC_REQUIRE(side != sides.end(), covers << "displacements that are prescribed on sides; \"Dirichlet->"
                                            << condition.name
                                            << "\" prescribes one at points, where the exact solution has no force. "
                                               "Write \"estimated\"");
    for (const LO f : host.facets_of(*side))
      for (int i = 0; i < 3; ++i)
        if (condition.displacement[i]) prescribed(f, i) = 1;
  }
  const int polynomials = FacetPolynomials::count(3, ReferenceStress::degree_of_loads_in_space),
            own = FacetPolynomials::count(3, in.reference.degree);
  SpaceBoundary b;
  b.tractions.known = DeviceView<char **>("rpc::bound::known", facets.size(), 3);
  b.tractions.load = DeviceView<double ***>("rpc::bound::load", facets.size(), polynomials, 3);
  const auto known = Kokkos::create_mirror_view(b.tractions.known);
  for (LO f = 0; f < facets.size(); ++f)
    for (int i = 0; i < 3; ++i) known(f, i) = host.cell(f, 1) < 0 && !prescribed(f, i);
  Kokkos::deep_copy(b.tractions.known, known);
  HostView<double ***> load("rpc::bound::load", facets.size(), polynomials, 3);
  for (const auto &traction : model.tractions) add_space_load(problem, host, traction, load);
  const auto to = Kokkos::create_mirror_view(b.tractions.load);
  for (std::size_t f = 0; f < load.extent(0); ++f) {
    double largest = 0;
    for (std::size_t j = 0; j < load.extent(1); ++j)
      for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(load(f, j, i)));
    for (std::size_t j = 0; j < load.extent(1); ++j)
      for (int i = 0; i < 3; ++i) {
        const bool rounding = static_cast<int>(j) >= own && std::abs(load(f, j, i)) <= 1e-13 * largest;
        to(f, j, i) = rounding ? 0 : load(f, j, i);
        b.beyond = b.beyond || (static_cast<int>(j) >= own && to(f, j, i) != 0);
      }
  }
  Kokkos::deep_copy(b.tractions.load, to);
  for (int k = 0; k < step.contact.num_sides(); ++k)
    b.sides.push_back(space_side(problem, model, step, host, k, pressure, prescribed));
  return b;
}

BoundaryTractions with_pressure(const SpaceInput &in, const SpaceBoundary &boundary,
                                const std::vector<std::vector<OfTriangle>> &pressure)
{
  const BoundaryTractions &loads = boundary.tractions;
  BoundaryTractions all = loads;
  all.load = DeviceView<double ***>("rpc::bound::load", loads.load.extent(0), loads.load.extent(1), 3);
  const auto load = Kokkos::create_mirror_view(all.load);
  Kokkos::deep_copy(load, loads.load);
  const auto linear = to_host(in.tables.linear);
  for (std::size_t s = 0; s < boundary.sides.size(); ++s) {
    const SpaceContact &c = boundary.sides[s];
    for (std::size_t e = 0; e < c.facet.size(); ++e)
      for (int j = 0; j < 3; ++j)
        for (int v = 0; v < 3; ++v)
          for (int i = 0; i < 3; ++i)
            load(c.facet[e], j, i) -= c.normal[i] * c.area[e] * linear(j, v) * pressure[s][e][v];
  }
  Kokkos::deep_copy(all.load, load);
  return all;
}

} // namespace rpc::bound
