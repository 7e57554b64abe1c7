// SPDX-License-Identifier: BSD-3-Clause
#include "boundary.hpp"

#include "contact_side.hpp"
#include "gauss.hpp"
#include "rpc/core/evaluate.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc::bound
{
namespace
{

/// Where something is off most, on all ranks.
struct WorstPlace {
  double off, x, y;
};
WorstPlace place_of_worst(const Comm &comm, const double off, const double x, const double y)
{
  const std::vector<double> all = gathered_by_all(comm, std::vector<double>{off, x, y});
  WorstPlace worst{all[0], all[1], all[2]};
  for (std::size_t k = 3; k + 2 < all.size(); k += 3)
    if (all[k] > worst.off) worst = {all[k], all[k + 1], all[k + 2]};
  return worst;
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
  const WorstPlace place = place_of_worst(host.mesh.comm(), worst, worst > 0 ? x(at, 0) : 0, worst > 0 ? x(at, 1) : 0);
  RPC_REQUIRE(place.off <= allowed * max_all(host.mesh.comm(), largest),
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
  double largest = 0, worst = 0;
  std::size_t at = 0;
  for (std::size_t e = 0; e < facets.size(); ++e)
    for (std::size_t q = 0; q < n; ++q) {
      const double here = at_point(host.mesh.element.order, {u(e * n), u(e * n + 1), u(e * n + 2)}, rule.point[q]);
      const double off = std::abs(u(e * n + q) - here);
      largest = std::max(largest, std::abs(u(e * n + q)));
      if (off > worst) {
        worst = off;
        at = e * n + q;
      }
    }
  const WorstPlace place = place_of_worst(host.mesh.comm(), worst, worst > 0 ? x(at, 0) : 0, worst > 0 ? x(at, 1) : 0);
  RPC_REQUIRE(place.off <= 1e-10 * max_all(host.mesh.comm(), largest),
              "deck: \"Adapt->Error Bound\" = guaranteed covers displacements that the elements represent; "
              "\"Dirichlet->"
                  << name << "\" is not, at (" << place.x << ", " << place.y << "). Write \"estimated\"");
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
      if (sides[s].facet[e] < 0) continue;
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
