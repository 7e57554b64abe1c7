// SPDX-License-Identifier: BSD-3-Clause
#include "space_boundary.hpp"

#include "rpc/core/evaluate.hpp"
#include "rpc/core/parallel.hpp"
#include "space_contact_side.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

constexpr const char *covers = "deck: \"Adapt->Error Bound\" = guaranteed covers ";

/// Where something is off most, on all ranks, and by how much over the largest value.
struct WorstInSpace {
  double off = 0;
  Point place{};
};
WorstInSpace worst_in_space(const Comm &comm, const double off, const double largest, const Point &x)
{
  const std::vector<double> all = gathered_by_all(comm, std::vector<double>{off, x[0], x[1], x[2]});
  const double size = max_all(comm, largest);
  WorstInSpace worst;
  for (std::size_t k = 0; k + 3 < all.size(); k += 4)
    if (all[k] > worst.off * size) worst = {all[k] / size, {all[k + 1], all[k + 2], all[k + 3]}};
  return worst;
}

/// Values of polynomials at the points of a rule, (polynomials, points).
std::vector<std::vector<double>> values_of(const FacetPolynomials &polynomials, const FacetRule &rule)
{
  std::vector<std::vector<double>> values(polynomials.size());
  for (int j = 0; j < polynomials.size(); ++j)
    for (const Barycentric &at : rule.point) values[j].push_back(polynomials(j, at));
  return values;
}

/// Whether a prescribed displacement between the nodes is what the elements make of it there.
void require_represented_displacement(const ScalarField &field, const SpaceFacetsOnHost &host,
                                      const std::vector<LO> &facets, const bool hexahedra, const std::string &name)
{
  if (field.is_constant()) return;
  const int order = hexahedra ? 1 : host.mesh.element.order, nodes = nodes_of_triangle(order);
  const std::array<Barycentric, 6> at_nodes{
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}}};
  FacetRule rule = facet_rule(3, 4);
  rule.point.insert(rule.point.begin(), at_nodes.begin(), at_nodes.begin() + nodes);
  rule.weight.insert(rule.weight.begin(), nodes, 0.);
  const HostView<double **> x = host.points(facets, rule);
  const auto u = evaluate(field, x, "Dirichlet->" + name, host.mesh.comm());
  double largest = 0, off_most = 0;
  Point where{};
  for (std::size_t e = 0; e < facets.size(); ++e) {
    const std::size_t first = e * rule.size();
    OfTriangle of_nodes{};
    for (int a = 0; a < nodes; ++a) of_nodes[a] = u(first + a);
    const OfTriangle there = bernstein_of(order, of_nodes);
    for (int q = 0; q < rule.size(); ++q) {
      largest = std::max(largest, std::abs(u(first + q)));
      const double off = u(first + q) - value_of(order, there, rule.point[q]);
      if (std::abs(off) > off_most) {
        off_most = std::abs(off);
        for (int d = 0; d < 3; ++d) where[d] = x(first + q, d);
      }
    }
  }
  const WorstInSpace worst = worst_in_space(host.mesh.comm(), off_most, largest, where);
  RPC_REQUIRE(worst.off <= 1e-10,
              covers << (hexahedra ? "displacements of sides of hexahedra that are linear on each triangle that their "
                                     "faces are split into; \"Dirichlet->"
                                   : "displacements that the elements represent; \"Dirichlet->")
                     << name << "\" is not, at " << place_in_space(worst.place) << ". Write \"estimated\"");
}

/// load(f, j, i) += the coefficients of the tractions on a side. What they lack of the tractions, such as half of a jump within a facet, no
/// stress would balance, and J of the exact solution could lie below its bound: that is refused.
void add_space_load(const fem::Discretization &discretization, const SpaceFacetsOnHost &host,
                    const fem::TractionLoad &load, const HostView<double ***> &sum)
{
  constexpr int along = 5;         // points for the coefficients: exact for products of degree 8
  constexpr int parts = 3;         // of a facet along each side, where what is lacking is looked for
  constexpr double allowed = 1e-3; // of the largest traction of the entry: smooth loads stay below it on coarse cells
  const mesh::Side &side = host.mesh.side(load.side, "Traction->" + load.name);
  const fem::VectorField traction = fem::force_per_area(discretization, side, load);
  const std::vector<LO> facets = host.facets_of(side);
  const FacetPolynomials polynomials(3, ReferenceStress::degree_of_loads_in_space);
  const bool is_constant =
      std::all_of(traction.begin(), traction.end(), [](const ScalarField &t) { return t.is_constant(); });
  const FacetRule rule = facet_rule(3, along),
                  fine = is_constant ? FacetRule{} : refined(3, facet_rule(3, along - 1), parts);
  const auto values = values_of(polynomials, rule), there = values_of(polynomials, fine);
  const HostView<double **> x = host.points(facets, rule), between = host.points(facets, fine);
  double largest = 0, off_most = 0;
  Point where{};
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
        if (std::abs(off) > off_most) {
          off_most = std::abs(off);
          for (int d = 0; d < 3; ++d) where[d] = between(e * fine.size() + q, d);
        }
      }
    }
  }
  const WorstInSpace worst = worst_in_space(host.mesh.comm(), off_most, largest, where);
  RPC_REQUIRE(worst.off <= allowed, covers << "loads that are smooth within each cell; \"Traction->" << load.name
                                           << "\" is not, at " << place_in_space(worst.place)
                                           << ". Let cells end where it jumps or bends, take smaller ones, or "
                                              "write \"estimated\"");
}

} // namespace

SpaceBoundary boundary_of(const fem::Discretization &d, const analysis::Model &model, const analysis::Step &step,
                          const SpaceInput &in, const PointTractions &solution)
{
  const SpaceFacets &facets = in.facets;
  const SpaceFacetsOnHost host(*d.mesh, facets);
  HostView<char *[3]> prescribed("rpc::bound::prescribed", facets.num_outer);
  for (const auto &condition : model.dirichlet) {
    const auto &sides = host.mesh.sides;
    const auto side =
        std::find_if(sides.begin(), sides.end(), [&](const mesh::Side &s) { return s.name == condition.side; });
    RPC_REQUIRE(side != sides.end(), covers << "displacements that are prescribed on sides; \"Dirichlet->"
                                            << condition.name
                                            << "\" prescribes one at points, where the exact solution has no force. "
                                               "Write \"estimated\"");
    const std::vector<LO> of_side = host.facets_of(*side);
    for (int i = 0; i < 3; ++i) {
      if (!condition.displacement[i]) continue;
      require_represented_displacement(*condition.displacement[i], host, of_side, in.of_hexahedra, condition.name);
      for (const LO f : of_side) prescribed(f, i) = 1;
    }
  }
  const int polynomials = FacetPolynomials::count(3, ReferenceStress::degree_of_loads_in_space),
            own = FacetPolynomials::count(3, in.reference.degree);
  SpaceBoundary b;
  b.tractions.known = DeviceView<char **>("rpc::bound::known", facets.num_outer, 3);
  b.tractions.load = DeviceView<double ***>("rpc::bound::load", facets.num_outer, polynomials, 3);
  const auto known = Kokkos::create_mirror_view(b.tractions.known);
  for (LO f = 0; f < facets.num_outer; ++f)
    for (int i = 0; i < 3; ++i) known(f, i) = host.cell(f, 1) == SpaceFacets::none && !prescribed(f, i);
  Kokkos::deep_copy(b.tractions.known, known);
  HostView<double ***> load("rpc::bound::load", facets.num_outer, polynomials, 3);
  for (const auto &traction : model.tractions) add_space_load(d, host, traction, load);
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
  b.beyond = max_all(host.mesh.comm(), b.beyond ? 1 : 0) > 0;
  Kokkos::deep_copy(b.tractions.load, to);
  for (int k = 0; k < step.contact.num_sides(); ++k)
    b.sides.push_back(space_side(d, model, step, host, k, solution, prescribed));
  return b;
}

BoundaryTractions with_contact(const SpaceInput &in, const SpaceBoundary &boundary,
                               const std::vector<SpaceTractions> &contact)
{
  const BoundaryTractions &loads = boundary.tractions;
  BoundaryTractions all = loads;
  all.load = DeviceView<double ***>("rpc::bound::load", loads.load.extent(0), loads.load.extent(1), 3);
  const auto load = Kokkos::create_mirror_view(all.load);
  Kokkos::deep_copy(load, loads.load);
  const auto bernstein = to_host(in.tables.bernstein);
  const int n = nodes_of_triangle(in.reference.degree);
  for (std::size_t s = 0; s < boundary.sides.size(); ++s) {
    const SpaceContact &c = boundary.sides[s];
    for (std::size_t e = 0; e < c.facet.size(); ++e) {
      if (c.facet[e] < 0) continue;
      for (int i = 0; i < 3; ++i) {
        OfTriangle t{}; // on the foundation
        for (int v = 0; v < n; ++v) {
          t[v] = c.normal[i] * contact[s].pressure[e][v];
          for (int k = 0; k < 2 && c.friction.acts; ++k) t[v] += c.axis[k][i] * contact[s].friction[k][e][v];
        }
        for (int j = 0; j < n; ++j)
          for (int v = 0; v < n; ++v) load(c.facet[e], j, i) -= c.area[e] * bernstein(j, v) * t[v];
      }
    }
  }
  Kokkos::deep_copy(all.load, load);
  return all;
}

} // namespace rpc::bound
