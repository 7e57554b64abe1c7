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

/// Where values are off most.
class Worst
{
public:
  void add(const double value, const double wanted, const double x, const double y)
  {
    largest_ = std::max(largest_, std::abs(value));
    if (std::abs(value - wanted) > at_[0]) at_ = {std::abs(value - wanted), x, y};
  }
  /// "(x, y)" of the place, on all ranks alike; empty if no value is off by more than this part of the largest one. Collective.
  std::string beyond(const Comm &comm, const double allowed) const
  {
    const std::vector<double> all = gathered_by_all(comm, at_);
    std::size_t worst = 0;
    for (std::size_t k = 3; k < all.size(); k += 3)
      if (all[k] > all[worst]) worst = k;
    if (all[worst] <= allowed * max_all(comm, largest_)) return "";
    std::ostringstream text;
    text << "(" << all[worst + 1] << ", " << all[worst + 2] << ")";
    return text.str();
  }

private:
  double largest_ = 0;
  std::vector<double> at_{0, 0, 0}; // by how much, x, y
};

/// Whether the polynomials that stand for a traction on the facets of a side are that traction, between their points too. What they lack, such
/// as half of a jump within a facet, no stress would balance, and J of the exact solution could lie below its bound.
/// @param coefficients  (facets of the mesh, degree, component) times lengths [N]
void require_represented_load(const OnHost &host, const bool revolution, const fem::VectorField &traction,
                              const std::string &name, const std::vector<LO> &facets,
                              const HostView<double ***> &coefficients)
{
  constexpr int parts = 4;         // of a facet, of points_of_fields each
  constexpr double allowed = 1e-3; // of the largest traction of the entry: smooth loads stay below it on coarse cells
  const Gauss points = gauss(OnHost::points_of_fields);
  Gauss rule;
  for (int part = 0; part < parts; ++part)
    for (const double s : points.point) rule.point.push_back((part + s) / parts);
  const std::size_t n = rule.point.size();
  const HostPoints x = host.points(facets, rule);
  Worst worst;
  for (int i = 0; i < 2; ++i) {
    const auto t = evaluate(traction[i], x, "Traction->" + name, host.mesh.comm());
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (std::size_t q = 0; q < n; ++q) {
        double polynomial = 0;
        for (int j = 0; j <= ReferenceStress::degree_of_loads; ++j)
          polynomial += coefficients(facets[e], j, i) / host.length_of(facets[e]) * legendre(j, rule.point[q]);
        worst.add(around(revolution, x(e * n + q, 0)) * t(e * n + q), polynomial, x(e * n + q, 0), x(e * n + q, 1));
      }
  }
  const std::string place = worst.beyond(host.mesh.comm(), allowed);
  RPC_REQUIRE(place.empty(),
              "deck: \"Adapt->Error Bound\" = guaranteed covers loads that are smooth within each cell; \"Traction->"
                  << name << "\" is not, at " << place
                  << ". Let cells end where it jumps or bends, take smaller ones, or write \"estimated\"");
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
  Worst worst;
  for (std::size_t e = 0; e < facets.size(); ++e)
    for (std::size_t q = 0; q < n; ++q) {
      const double here = at_point(host.mesh.element.order, {u(e * n), u(e * n + 1), u(e * n + 2)}, rule.point[q]);
      worst.add(u(e * n + q), here, x(e * n + q, 0), x(e * n + q, 1));
    }
  const std::string place = worst.beyond(host.mesh.comm(), 1e-10);
  RPC_REQUIRE(place.empty(),
              "deck: \"Adapt->Error Bound\" = guaranteed covers displacements that the elements represent; "
              "\"Dirichlet->"
                  << name << "\" is not, at " << place << ". Write \"estimated\"");
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
  const bool revolution = d.axisymmetric();
  for (int i = 0; i < 2; ++i) {
    const auto t = evaluate(traction[i], x, "Traction->" + load.name, host.mesh.comm());
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (int j = 0; j <= ReferenceStress::degree_of_loads; ++j) {
        for (int q = 0; q < num_points; ++q)
          own(facets[e], j, i) += (2 * j + 1) * rule.weight[q] * legendre(j, rule.point[q]) *
                                  around(revolution, x(e * num_points + q, 0)) * t(e * num_points + q) *
                                  host.length_of(facets[e]);
        sum(facets[e], j, i) += own(facets[e], j, i);
      }
  }
  require_represented_load(host, revolution, traction, load.name, facets, own);
}

} // namespace

Boundary boundary_of(const analysis::Problem &problem, const analysis::Step &step, const Facets &facets,
                     const PointTractions &solution)
{
  const analysis::Model model = problem.model().seen_at(step.time);
  const OnHost host(*problem.discretization().mesh, facets);
  const fem::Discretization &d = problem.discretization();
  HostView<char *[2]> prescribed("rpc::bound::prescribed", facets.size());
  const auto on_axis = [&](const LO f) {
    return d.axisymmetric() && std::max(host.coords(host.node(f, 0), 0), host.coords(host.node(f, 1), 0)) <= d.on_axis;
  };
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
      int lines = 0;
      for (const LO f : facets) {
        if (on_axis(f)) lines = 1; // u_r = 0 there as it is
        prescribed(f, i) = !on_axis(f);
      }
      RPC_REQUIRE(i == 0 || max_all(host.mesh.comm(), lines) == 0,
                  "deck: \"Adapt->Error Bound\" = guaranteed covers displacements that are prescribed on surfaces; "
                  "\"Dirichlet->"
                      << condition.name
                      << "\" prescribes one along the axis, where the exact solution has no force. Write "
                      << "\"estimated\"");
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
