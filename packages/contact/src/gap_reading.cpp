// SPDX-License-Identifier: BSD-3-Clause
#include "gap_reading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::contact
{
namespace
{

/// The foundation with a layer of the body in series.
Foundation in_series(const ContactOptions &options, const Point &x, const double dent, const double layer)
{
  const double hardening = options.hardening(x);
  return {options.yield_stress(x) + (hardening > 0 ? hardening * std::max(dent, 0.) : 0), hardening,
          layer + 1 / options.stiffness(x)};
}

} // namespace

void GapReading::sample(const LO f, const Lattice &lattice, SampledFacet &found) const
{
  const FacetNodes nodes = facet_nodes(rows, f);
  found.lattice = &lattice;
  found.points.clear();
  found.penetration.clear();
  found.points.reserve(lattice.points.size());
  found.penetration.reserve(lattice.points.size());
  for (const FacetShape &shape : lattice.points) {
    found.points.push_back(sample_at(nodes, shape, options));
    found.penetration.push_back(penetration_at(found.points.back(), options));
  }
}

bool GapReading::has_deep_node(const LO f, const double modulus) const
{
  for (int a = 0; a < rows.nodes; ++a) {
    if (!(rows.column(f, a, FacetRows::bearing) < 0)) continue;
    if (rows.column(f, a, FacetRows::penetration) > rows.size(f) / modulus * rows.column(f, a, FacetRows::pressure))
      return true;
  }
  return false;
}

bool OffInterpolants::hides(const double smooth) const
{
  return halves * std::sqrt(8.) > std::max(whole, smooth);
}

OffInterpolants off_interpolants(const SampledFacet &at)
{
  const Lattice &lattice = *at.lattice;
  const std::vector<double> &v = at.penetration;
  OffInterpolants off;
  for (std::size_t n = 0; n < v.size(); ++n) {
    if (!std::isfinite(v[n])) return {}; // the obstacle is missed
    const Lattice::Nodes &in_half = lattice.of_half[lattice.half[n]];
    double whole = v[n], half = v[n];
    for (std::size_t a = 0; a < in_half.size(); ++a) {
      whole -= lattice.points[n].value[a] * v[lattice.node[a]];
      half -= lattice.points[lattice.alike[n]].value[a] * v[in_half[a]];
    }
    off.whole = std::max(off.whole, std::abs(whole));
    off.halves = std::max(off.halves, std::abs(half));
  }
  return off;
}

bool GapReading::is_off(const LO f, const SampledFacet &at) const
{
  double least = std::numeric_limits<double>::infinity(), most = -least, furthest = 0;
  for (int a = 0; a < rows.nodes; ++a) {
    least = std::min(least, rows.column(f, a, FacetRows::penetration));
    most = std::max(most, rows.column(f, a, FacetRows::penetration));
  }
  for (std::size_t n = 0; n < at.lattice->points.size(); ++n) {
    const double v = at.beyond_dents(n);
    if (!std::isfinite(v)) return false;
    furthest = std::max(furthest, std::abs(v - rows.interpolated(f, at.lattice->points[n], FacetRows::penetration)));
  }
  return furthest > off * (most - least);
}

double GapReading::work_of_interpolation(const LO f, const SampledFacet &at) const
{
  double work = 0, weights = 0;
  for (std::size_t n = 0; n < at.lattice->points.size(); ++n) {
    const FacetShape &shape = at.lattice->points[n];
    const double weight = shape.share * (axisymmetric ? at.points[n].place[0] : 1), v = at.beyond_dents(n);
    const double off = rows.interpolated(f, shape, FacetRows::penetration) - v;
    if (!std::isfinite(off)) return 0; // the obstacle is missed
    work += weight * rows.interpolated(f, shape, FacetRows::pressure) * off;
    weights += weight;
  }
  return weights > 0 ? work * rows.area(f) / weights : 0;
}

double pressed_in(const ContactOptions &options, const Point &x, const double dent, const double depth,
                  const double layer)
{
  return dent + depth - layer * pressure_at(depth, in_series(options, x, dent, layer));
}

Misread GapReading::read(const LO f, const double modulus, const double of_surface, const SampledFacet &at) const
{
  const double h = rows.size(f), layer = h / modulus;
  double energy[FacetShape::most_nodes], pressure[FacetShape::most_nodes];
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (int a = 0; a < rows.nodes; ++a) {
    const double p = rows.column(f, a, FacetRows::pressure);
    const Foundation law = in_series(options, rows.point(f, a), rows.column(f, a, FacetRows::dent), layer);
    const double v = rows.column(f, a, FacetRows::penetration) + layer * p;
    energy[a] = foundation_energy(v, law);
    pressure[a] = pressure_at(v, law);
    low = std::min(low, p);
    high = std::max(high, p);
  }
  constexpr double pi = 3.14159265358979;
  // By pressures that jump half a facet further, in a half-plane that is at rest a diameter away.
  const double moved = (high - low) * h / (pi * of_surface) * (1 + std::log(2 * diameter / h));
  Misread found;
  double weights = 0;
  for (std::size_t n = 0; n < at.lattice->points.size(); ++n) {
    const FacetShape &shape = at.lattice->points[n];
    const Point &place = at.points[n].place;
    const double weight = shape.share * (axisymmetric ? place[0] : 1);
    const double dent = at.points[n].dent;
    const double v = at.beyond_dents(n) + layer * rows.interpolated(f, shape, FacetRows::pressure);
    if (!std::isfinite(v)) return {};
    const Foundation law = in_series(options, place, dent, layer);
    const double p = pressure_at(v, law);
    double off_energy = foundation_energy(v, law), off_force = p;
    for (int a = 0; a < rows.nodes; ++a) {
      off_energy -= shape.value[a] * energy[a];
      off_force -= shape.value[a] * pressure[a];
    }
    found.energy += weight * std::abs(off_energy);
    found.force += weight * std::abs(off_force);
    found.penetration = std::max(found.penetration, dent + v - layer * p + moved);
    if (low > 0 && !(p > 0)) found.ends = rows.area(f) / 2;
    weights += weight;
  }
  const double share = weights > 0 ? rows.area(f) / weights : 0;
  found.energy *= share;
  found.force *= share;
  return found;
}

} // namespace rpc::contact
