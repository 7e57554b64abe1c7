#include "rpc/adapt/cycle.hpp"

#include "rpc/adapt/observed_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::adapt
{
namespace
{

/// Changes of a quantity from mesh to mesh.
template <class Change>
std::vector<double> changes(const std::vector<Cycle> &cycles, const Change &change)
{
  std::vector<double> all;
  for (std::size_t k = 1; k < cycles.size(); ++k) all.push_back(change(cycles[k - 1], cycles[k]));
  return all;
}

/// Why the largest pressure of the last mesh has no error bar; empty if it has one.
std::string unknown_max_pressure(const std::vector<Cycle> &cycles, const std::vector<double> &eta)
{
  const Cycle &last = cycles.back();
  const std::string reason = last.peak.unknown();
  if (last.peak.at_bound || !reason.empty()) return reason;
  const auto growth =
      changes(cycles, [](const Cycle &a, const Cycle &b) { return b.contact.max_pressure - a.contact.max_pressure; });
  const bool grows = growth.size() > 1 && growth.back() > 0 && growth[growth.size() - 2] > 0;
  if (grows && unsettled(growth, eta, last.recovered_max_pressure))
    return "the largest pressure grows from mesh to mesh and does not settle";
  return "";
}

} // namespace

std::string error_bar_name(const std::string &key, const ResultScope &scope)
{
  const auto found = std::find_if(error_bars.begin(), error_bars.end(), [&](const auto &q) { return key == q.key; });
  return found == error_bars.end() ? key : found->name(scope);
}

ObservedErrors observed_errors(const std::vector<Cycle> &cycles)
{
  std::vector<double> eta;
  for (const auto &cycle : cycles) eta.push_back(cycle.estimate);
  const auto error = [&](const auto &change) { return adapt::observed_error(changes(cycles, change), eta); };
  const Cycle &last = cycles.back();
  ObservedErrors errors;
  errors.energy = error([](const Cycle &a, const Cycle &b) { return std::abs(b.energy - a.energy); });
  errors.contact_force = error([](const Cycle &a, const Cycle &b) {
    const auto &f = a.contact.force, &g = b.contact.force;
    return std::hypot(g[0] - f[0], g[1] - f[1], g[2] - f[2]);
  });
  errors.max_pressure =
      error([](const Cycle &a, const Cycle &b) { return std::abs(b.contact.max_pressure - a.contact.max_pressure); });
  errors.contact_pressure = error([](const Cycle &, const Cycle &b) { return b.pressure_change; });
  const auto length = [](const Cycle &a, const Cycle &b) {
    return std::abs(b.contact.contact_length - a.contact.contact_length);
  };
  errors.contact_length = error(length);
  errors.max_penetration = error(
      [](const Cycle &a, const Cycle &b) { return std::abs(b.contact.max_penetration - a.contact.max_penetration); });
  if (cycles.size() < 2) {
    for (const auto &q : error_bars) errors.unknown[q.key] = "one mesh shows no change";
    return errors;
  }
  // Two meshes may agree by chance, and do where all of a side yields. Errors of forces are like eta^2; the largest penetration may be that of
  // a corner.
  const auto &force = last.contact.force;
  errors.contact_force =
      std::max(errors.contact_force, last.estimate * last.estimate * std::hypot(force[0], force[1], force[2]));
  errors.max_penetration = std::max(errors.max_penetration, last.estimate * last.contact.max_penetration);
  errors.max_pressure = last.peak.at_bound ? 0 : std::max(errors.max_pressure, last.recovered_max_pressure);
  errors.contact_pressure = std::max(errors.contact_pressure, last.recovered_pressure);
  // Sums of weights are rounded.
  errors.contact_length = std::max({errors.contact_length, last.contact_ends, 1e-12 * last.contact.contact_length});
  const std::string reason = unknown_max_pressure(cycles, eta);
  if (!reason.empty()) {
    errors.max_pressure = std::numeric_limits<double>::quiet_NaN();
    errors.unknown["max_pressure"] = reason;
  }
  if (unsettled(changes(cycles, length), eta, errors.contact_length)) {
    errors.contact_length = std::numeric_limits<double>::quiet_NaN();
    errors.unknown["contact_length"] = "the length in contact does not settle from mesh to mesh";
  }
  return errors;
}

} // namespace rpc::adapt
