// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/cycle.hpp"

#include "rpc/adapt/observed_error.hpp"
#include "rpc/core/point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::adapt
{
namespace
{

double difference_of(const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

/// Changes of a quantity from mesh to mesh.
template <class Change>
std::vector<double> changes(const std::vector<Cycle> &cycles, const Change &change)
{
  std::vector<double> all;
  for (std::size_t k = 1; k < cycles.size(); ++k) all.push_back(change(cycles[k - 1], cycles[k]));
  return all;
}

/// Error of a quantity on the last mesh, as all meshes show it.                                       doc/theory.md (10.7)
/// @param distance  of the quantity on two meshes
template <class Distance>
double shown_error(const std::vector<Cycle> &cycles, const std::vector<double> &eta, const Distance &distance)
{
  std::vector<double> to_last;
  for (std::size_t k = 0; k + 1 < cycles.size(); ++k) to_last.push_back(distance(cycles[k], cycles.back()));
  const auto change = changes(cycles, distance);
  const double error = std::max(observed_error(change, eta), error_over_span(to_last, eta));
  return unsettled(change, eta, 0) ? std::max(error, change.back()) : error; // no limit is in sight yet
}

/// Why the largest pressure of the last mesh has no error bar; empty if it has one.
std::string unknown_max_pressure(const std::vector<Cycle> &cycles, const std::vector<double> &eta)
{
  const Cycle &last = cycles.back();
  const std::string reason = last.peak.unknown();
  if (last.peak.at_bound || !reason.empty()) return reason;
  const auto growth =
      changes(cycles, [](const Cycle &a, const Cycle &b) { return b.contact.max_pressure - a.contact.max_pressure; });
  std::vector<double> pressure;
  for (const Cycle &cycle : cycles) pressure.push_back(cycle.contact.max_pressure);
  const bool grows = growth.size() > 1 && growth.back() > 0 && growth[growth.size() - 2] > 0;
  if ((grows && unsettled(growth, eta, last.recovered_max_pressure)) ||
      grows_without_limit(pressure, eta, last.estimate * last.contact.max_pressure))
    return "the largest pressure grows from mesh to mesh and does not settle";
  return "";
}

constexpr double caution = 2; // the estimate may be 0.7 of the error

/// By how much a force of a mesh moves in the mean, if the strain energy is its work [m].                         (10.7b)
double moved_by(const Cycle &cycle, const double force)
{
  return force > 0 ? cycle.energy_norm_squared / force : 0;
}

/// What a mesh leaves open of what forces move: what it would leave of forces if that was given, times how soft it is.      (10.7d)
/// @param of_force  left of forces [N], in 2D per m   @param share  of a force
MotionErrors left_of_motions(const Cycle &cycle, const double of_force, const double share)
{
  const Motions &m = cycle.motions;
  const double force = force_at_work(cycle.contact.force, cycle.reactions),
               mean = force > 0 ? moved_by(cycle, force) / force : 0;
  MotionErrors left;
  double of_all =
      of_force; // and of forces that have the moments at the arms: of loads that turn a side, and do not press it
  for (std::size_t j = 0; j < m.moments.size(); ++j) {
    left.moments.push_back(std::max(of_force * m.arms[j], share * length(m.moments[j])));
    if (m.arms[j] > 0) of_all = std::max(of_all, left.moments[j] / m.arms[j]);
  }
  for (const double softness : m.softness.displacement) left.displacements.push_back(of_all * std::max(softness, mean));
  for (const double softness : m.softness.rotation) left.rotations.push_back(of_all * softness);
  left.obstacle = of_all * std::max(m.softness.obstacle, mean);
  return left;
}

/// Makes each error no less than what is left open, or grow by it.
/// @param change  of two numbers: the new error
template <class Change>
void change_each(std::vector<double> &errors, const std::vector<double> &left, const Change &change)
{
  for (std::size_t k = 0; k < errors.size() && k < left.size(); ++k) errors[k] = change(errors[k], left[k]);
}

template <class Change>
void change_all(MotionErrors &errors, const MotionErrors &left, const Change &change)
{
  change_each(errors.displacements, left.displacements, change);
  change_each(errors.rotations, left.rotations, change);
  change_each(errors.moments, left.moments, change);
  errors.obstacle = change(errors.obstacle, left.obstacle);
}

/// Errors of motions, as a distance of two meshes tells.
/// @param error  of a distance of vectors on two meshes
template <class Error>
MotionErrors motion_errors(const Motions &last, const Error &error)
{
  MotionErrors errors;
  const auto of_each = [&](const std::vector<std::array<double, 3>> Motions::*all) {
    std::vector<double> each;
    for (std::size_t k = 0; k < (last.*all).size(); ++k)
      each.push_back(error([all, k](const Cycle &a, const Cycle &b) {
        return difference_of((a.motions.*all)[k], (b.motions.*all)[k]);
      }));
    return each;
  };
  errors.displacements = of_each(&Motions::displacements);
  errors.rotations = of_each(&Motions::rotations);
  errors.moments = of_each(&Motions::moments);
  errors.obstacle =
      error([](const Cycle &a, const Cycle &b) { return difference_of(a.motions.obstacle, b.motions.obstacle); });
  return errors;
}

/// No less than what the last mesh leaves open: its estimated error, and data that jump between its nodes.      (10.7a), (10.7b)
void add_what_a_mesh_leaves(const Cycle &last, const std::vector<double> &eta, ObservedErrors &errors)
{
  const double force = force_at_work(last.contact.force, last.reactions),
               squared = caution * last.estimate * last.estimate;
  errors.energy = std::max(errors.energy, energy_left(last));
  const double jumped = left_by_jumps(last).force;
  // No force moves further than the body: where others cancel in their sum, this one does little of the work.
  const double far = last.max_displacement, at_work = far > 0 ? std::max(force, last.energy_norm_squared / far) : force;
  const auto of_mesh = [&](const double f) { return std::max(squared * f, last.ends_force) + jumped; };
  errors.contact_force = std::max(errors.contact_force, of_mesh(at_work));
  double largest = force;
  for (const auto &reaction : last.reactions) largest = std::max(largest, length(reaction));
  for (double &bar : errors.reactions) bar = std::max(bar, of_mesh(std::max(largest, at_work)));
  change_all(errors.motions, left_of_motions(last, of_mesh(largest), squared),
             [](const double error, const double left) { return std::max(error, left); });
  // The largest penetration may be that of a corner; what remains of it where the body has drawn back is as uncertain as the dents.
  const double deepest = std::max(last.contact.max_penetration, last.contact.max_dent);
  const double misread = last.contact.gives_way() ? left_by_misreading(last).penetration : deepest;
  errors.max_penetration =
      std::max({errors.max_penetration, last.estimate * deepest, last.peak.rounded_depth, misread});
  if (hardly_finer(eta)) errors.max_pressure = std::max(errors.max_pressure, last.estimate * last.contact.max_pressure);
  errors.max_pressure =
      last.peak.at_bound ? 0 : std::max({errors.max_pressure, last.recovered_max_pressure, last.peak.rounded});
  errors.contact_pressure = std::max(errors.contact_pressure, last.recovered_pressure);
  // Sums of weights are rounded.
  errors.contact_length = std::max({errors.contact_length, last.contact_ends, 1e-12 * last.contact.contact_length});
}

void make_unknown(ObservedErrors &errors, const std::string &reason)
{
  for (const auto &q : error_bars) {
    errors.*q.value = std::numeric_limits<double>::quiet_NaN();
    errors.unknown[q.key] = reason;
  }
}

/// Whether springs are all that gives way of the foundation: penetrations are pressures over their stiffness.
bool springs_alone(const Cycle &cycle)
{
  const contact::ContactSums &all = cycle.contact;
  return all.foundation_energy > 0 && all.max_pressure > 0 && all.max_penetration > 0 && all.max_dent == 0;
}

/// Of springs that alone give way the largest pressure and the largest penetration are known to the same share. Nor has a penetration a bar
/// without one of the pressure where it is smaller than that, and dents are: the foundation has just begun to give way.            (10.7a)
void share_what_springs_tell(const Cycle &last, ObservedErrors &errors)
{
  const double deepest = std::max(last.contact.max_penetration, last.contact.max_dent);
  const bool springs = springs_alone(last), just_begun = last.contact.max_dent > 0 && errors.max_penetration > deepest;
  const auto unknown = errors.unknown.find("max_pressure");
  if (unknown != errors.unknown.end() && (springs || just_begun)) {
    const std::string where = springs ? "on springs it goes with" : "the foundation has just begun to give way under";
    errors.unknown.emplace("max_penetration", where + " the largest pressure, which has no bar: " + unknown->second);
    errors.max_penetration = std::numeric_limits<double>::quiet_NaN();
  }
  if (!springs || unknown != errors.unknown.end()) return;
  const double compliance = last.contact.max_penetration / last.contact.max_pressure;
  errors.max_penetration = std::max(errors.max_penetration, errors.max_pressure * compliance);
  errors.max_pressure = std::max(errors.max_pressure, errors.max_penetration / compliance);
}

/// A penetration of 0 has no bar where the pressure may reach the yield stress, or the body may touch a spring: how deep the foundation gives way
/// there, no mesh has shown.
void judge_rigid_foundation(const Cycle &last, ObservedErrors &errors)
{
  const contact::ContactSums &all = last.contact;
  const double gives_way_from = last.peak.lowest_bound;
  if (all.gives_way() || !std::isfinite(gives_way_from)) return;
  const double most = all.max_pressure + errors.max_pressure;
  if (most == 0 || most < gives_way_from) return; // NaN is not
  errors.max_penetration = std::numeric_limits<double>::quiet_NaN();
  errors.unknown["max_penetration"] =
      gives_way_from > 0 ? "nothing yields on this mesh, and the largest pressure may reach the yield stress"
                         : "no spring is pressed in on this mesh, and the body may touch one";
}

/// By how far two gaps differ; infinite ones, of sides without contact points, do not.
double difference_of_gaps(const Cycle &a, const Cycle &b)
{
  return a.smallest_gap == b.smallest_gap ? 0 : std::abs(b.smallest_gap - a.smallest_gap);
}

/// By how much the smallest gap may be off, as the meshes of a step show.                                         (10.7e)
double error_of_gap(const std::vector<Cycle> &cycles, const std::vector<double> &eta)
{
  const Cycle &last = cycles.back();
  return std::max(shown_error(cycles, eta, difference_of_gaps), last.estimate * last.max_displacement);
}

/// Where nothing touches, contact force, pressures and the area in contact are 0 where the gap that is left is larger than its error; else no
/// mesh has shown what pressures there may be. Tresca friction acts at open points too: a force that it leaves keeps the bar that meshes
/// show.                                                                                                         (10.7e)
void judge_open_body(const Cycle &last, const double error_of_gap, ObservedErrors &errors)
{
  const bool touches = last.contact.contact_length > 0, open = !touches && last.smallest_gap > error_of_gap;
  // All pressures together may be no more than the error of the force.                                           (10.7h)
  if (touches && !(last.contact.max_pressure * last.contact.contact_length <= errors.contact_force)) return;
  if (open && length(last.contact.force) == 0) errors.contact_force = 0;
  const auto set = [&](double &bar, const char *const key) {
    bar = open ? 0 : std::numeric_limits<double>::quiet_NaN();
    open ? void(errors.unknown.erase(key)) : void(errors.unknown[key] = touches ? may_be_open : may_touch);
  };
  set(errors.max_pressure, "max_pressure");
  set(errors.contact_pressure, "contact_pressure_l2_relative");
  set(errors.contact_length, "contact_length");
  if (open && last.contact.max_dent == 0) set(errors.max_penetration, "max_penetration");
}

/// What follows from each other.
void judge_together(const Cycle &last, const double error_of_gap, ObservedErrors &errors)
{
  share_what_springs_tell(last, errors);
  judge_open_body(last, error_of_gap, errors);
  judge_rigid_foundation(last, errors);
}

/// What the meshes of earlier steps leave comes to what those of the last one do.                              (10.7c)
void add_what_earlier_steps_leave(const CoarserHistory &coarser, const Cycle &last, const EarlierSteps &earlier,
                                  ObservedErrors &errors)
{
  const Cycle &other = coarser.last;
  const double eta = earlier.largest_estimate, squared = eta * eta;
  const auto shown = [&](const double distance) {
    return error_of_history(std::abs(distance), coarser.largest_estimate, eta);
  };
  const double of_force = earlier.moved_by > 0 ? caution * squared / earlier.moved_by : 0;
  const double least = std::max(of_force, earlier.misread.force);
  errors.energy += std::max({shown(last.energy - other.energy), caution * squared / 2, earlier.misread.energy});
  errors.contact_force += std::max(shown(difference_of(last.contact.force, other.contact.force)), least);
  for (std::size_t k = 0; k < errors.reactions.size(); ++k)
    errors.reactions[k] += std::max(shown(difference_of(last.reactions[k], other.reactions[k])), least);
  MotionErrors motions =
      motion_errors(last.motions, [&](const auto &distance) { return shown(distance(last, other)); });
  change_all(motions, left_of_motions(last, least, caution * squared / last.energy_norm_squared),
             [](const double error, const double left) { return std::max(error, left); });
  change_all(errors.motions, motions, [](const double error, const double more) { return error + more; });
  errors.max_pressure += shown(last.contact.max_pressure - other.contact.max_pressure);
  errors.contact_length += shown(last.contact.contact_length - other.contact.contact_length);
  errors.max_penetration += shown(last.contact.max_penetration - other.contact.max_penetration);
  if (last.contact.max_dent > 0) errors.max_penetration = std::max(errors.max_penetration, earlier.misread.penetration);
}

/// Of forces and moments that the load alone fixes the errors are those that meshes show.
void take_what_the_load_fixes(const ObservedErrors &shown, const FixedByLoad &fixed, ObservedErrors &errors)
{
  for (std::size_t k = 0; k < errors.reactions.size() && k < fixed.reactions.size(); ++k)
    if (fixed.reactions[k]) errors.reactions[k] = shown.reactions[k];
  for (std::size_t k = 0; k < errors.motions.moments.size() && k < fixed.moments.size(); ++k)
    if (fixed.moments[k]) errors.motions.moments[k] = shown.motions.moments[k];
}

/// Whether the load alone fixes the contact force: it has no component along prescribed displacements on any mesh.
bool is_fixed(const std::vector<Cycle> &cycles, const FixedByLoad &fixed)
{
  constexpr double rounding = 1e-12;
  for (const Cycle &cycle : cycles) {
    const double length = rpc::length(cycle.contact.force);
    for (int c = 0; c < 3; ++c)
      if (!fixed.contact[c] && !(length > 0 && std::abs(cycle.contact.force[c]) <= rounding * length)) return false;
  }
  return true;
}

/// The force that does a work, by how much a mesh's forces move in the mean.
double force_of(const double energy, const double moved)
{
  return moved > 0 ? 2 * energy / moved : 0;
}

} // namespace

LeftOpen left_by_misreading(const Cycle &cycle)
{
  const double moved = moved_by(cycle, force_at_work(cycle.contact.force, cycle.reactions));
  return {moved > 0 ? std::min(cycle.misread_force, force_of(cycle.misread_energy, moved)) : cycle.misread_force,
          cycle.misread_energy,
          cycle.contact.gives_way() ? std::max(0., cycle.misread_penetration - cycle.contact.max_penetration) : 0};
}

LeftOpen left_by_jumps(const Cycle &cycle)
{
  const double moved = moved_by(cycle, force_at_work(cycle.contact.force, cycle.reactions));
  const LeftOpen misread = left_by_misreading(cycle);
  const double energy = cycle.jumped_energy + cycle.interpolated;
  return {cycle.jumped_force + force_of(energy, moved) + misread.force,
          energy + cycle.jumped_force * moved_by(cycle, length(cycle.contact.force)) + misread.energy};
}

double energy_left(const Cycle &cycle)
{
  return caution * cycle.estimate * cycle.estimate * cycle.energy_norm_squared / 2 + left_by_jumps(cycle).energy;
}

std::string error_bar_name(const std::string &key, const ResultScope &scope)
{
  const auto found = std::find_if(error_bars.begin(), error_bars.end(), [&](const auto &q) { return key == q.key; });
  return found == error_bars.end() ? key : found->name(scope);
}

namespace
{

std::vector<double> estimates_of(const std::vector<Cycle> &cycles)
{
  std::vector<double> eta;
  for (const auto &cycle : cycles) eta.push_back(cycle.estimate);
  return eta;
}

/// Whether the meshes show nothing of the errors.
bool show_nothing(const std::vector<Cycle> &cycles)
{
  return cycles.size() < 2 || cycles.back().misses_contact;
}

/// The same as observed_errors(), each quantity by itself.
ObservedErrors errors_on_meshes(const std::vector<Cycle> &cycles, const FixedByLoad &fixed, const double tolerance)
{
  const std::vector<double> eta = estimates_of(cycles);
  const auto error = [&](const auto &distance) { return shown_error(cycles, eta, distance); };
  ObservedErrors errors;
  errors.energy = error([](const Cycle &a, const Cycle &b) { return std::abs(b.energy - a.energy); });
  errors.contact_force =
      error([](const Cycle &a, const Cycle &b) { return difference_of(a.contact.force, b.contact.force); });
  for (std::size_t k = 0; k < cycles.back().reactions.size(); ++k)
    errors.reactions.push_back(
        error([k](const Cycle &a, const Cycle &b) { return difference_of(a.reactions[k], b.reactions[k]); }));
  errors.max_pressure =
      error([](const Cycle &a, const Cycle &b) { return std::abs(b.contact.max_pressure - a.contact.max_pressure); });
  errors.contact_pressure = observed_error( // of which only that from one mesh to the next is known
      changes(cycles, [](const Cycle &, const Cycle &b) { return b.pressure_change; }), eta);
  const auto length = [](const Cycle &a, const Cycle &b) {
    return std::abs(b.contact.contact_length - a.contact.contact_length);
  };
  errors.motions = motion_errors(cycles.back().motions, error);
  errors.contact_length = error(length);
  errors.max_penetration = error(
      [](const Cycle &a, const Cycle &b) { return std::abs(b.contact.max_penetration - a.contact.max_penetration); });
  if (cycles.size() < 2) {
    make_unknown(errors, one_mesh);
    return errors;
  }
  if (cycles.back().misses_contact) { // what it shows is another solution
    make_unknown(errors, unseen_by_mesh);
    return errors;
  }
  const ObservedErrors shown = errors;
  add_what_a_mesh_leaves(cycles.back(), eta, errors);
  take_what_the_load_fixes(shown, fixed, errors);
  if (is_fixed(cycles, fixed)) {
    const double rounding = tolerance * rpc::length(cycles.back().contact.force);
    errors.contact_force = shown.contact_force > rounding ? shown.contact_force : 0;
  }
  const std::string reason = unknown_max_pressure(cycles, eta);
  if (!reason.empty()) {
    errors.max_pressure = std::numeric_limits<double>::quiet_NaN();
    errors.unknown["max_pressure"] = reason;
  }
  if (cycles.back().peak.gap_jump && !cycles.back().peak.at_bound) {
    errors.contact_pressure = std::numeric_limits<double>::quiet_NaN();
    errors.unknown["contact_pressure_l2_relative"] =
        "contact ends where the gap jumps, where the square of the pressure has no integral";
  }
  if (unsettled(changes(cycles, length), eta, errors.contact_length)) {
    errors.contact_length = std::numeric_limits<double>::quiet_NaN();
    errors.unknown["contact_length"] = "the length in contact does not settle from mesh to mesh";
  }
  return errors;
}

} // namespace

ObservedErrors observed_errors(const std::vector<Cycle> &cycles, const FixedByLoad &fixed, const double tolerance)
{
  ObservedErrors errors = errors_on_meshes(cycles, fixed, tolerance);
  if (!show_nothing(cycles)) judge_together(cycles.back(), error_of_gap(cycles, estimates_of(cycles)), errors);
  return errors;
}

ObservedErrors observed_errors(std::vector<Cycle> cycles, const CoarserHistory &coarser, const EarlierSteps &earlier,
                               const FixedByLoad &fixed, const double tolerance)
{
  const bool alone = cycles.size() < 2;
  if (!earlier.matter && (!alone || !coarser.missing.empty())) return observed_errors(cycles, fixed, tolerance);
  ObservedErrors errors;
  if (!coarser.missing.empty()) {
    make_unknown(errors, "what the meshes of earlier steps have left is not known: " + coarser.missing);
    return errors;
  }
  if (alone) cycles.insert(cycles.begin(), coarser.last);
  errors = errors_on_meshes(cycles, fixed, tolerance);
  errors.contact_pressure = std::numeric_limits<double>::quiet_NaN();
  errors.unknown["contact_pressure_l2_relative"] =
      alone ? one_mesh : "what the meshes of earlier steps have left of it is not known";
  const ObservedErrors on_meshes = errors;
  if (earlier.matter) add_what_earlier_steps_leave(coarser, cycles.back(), earlier, errors);
  take_what_the_load_fixes(on_meshes, fixed, errors);
  if (is_fixed(cycles, fixed)) errors.contact_force = on_meshes.contact_force;
  if (show_nothing(cycles)) return errors;
  double of_gap = error_of_gap(cycles, estimates_of(cycles));
  if (earlier.matter)
    of_gap += error_of_history(difference_of_gaps(cycles.back(), coarser.last), coarser.largest_estimate,
                               earlier.largest_estimate);
  judge_together(cycles.back(), of_gap, errors);
  return errors;
}

double relative_bound(const bound::EnergyBound &bound, const double energy_norm_squared)
{
  return bound.energy_norm == 0 ? 0 : bound.energy_norm / std::sqrt(energy_norm_squared);
}

std::size_t best_of(const std::vector<Cycle> &cycles)
{
  const auto error = [](const Cycle &c) {
    if (!c.bound) return c.estimate;
    return c.bound->missing.empty() ? relative_bound(*c.bound, c.energy_norm_squared)
                                    : std::numeric_limits<double>::infinity();
  };
  const auto less = [&](const Cycle &a, const Cycle &b) { return error(a) < error(b); };
  return std::min_element(cycles.begin(), cycles.end(), less) - cycles.begin();
}

} // namespace rpc::adapt
