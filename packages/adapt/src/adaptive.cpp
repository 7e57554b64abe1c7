#include "rpc/adapt/observed_error.hpp"
#include "rpc/adapt/solution.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace rpc::adapt
{
namespace
{

// A new mesh is to come that much below the target: what is predicted is met to some ten percent.
constexpr double aim = 0.95;
// The estimate falls by no more from one mesh to the next: a coarse mesh knows little of where a fine one is to be fine.
constexpr double greatest_reduction = 4;
// Near the target, what came out above what was planned is allowed for in the next plan, up to a factor, and cells hardly
// grow, lest the next mesh loses what this one has.
constexpr double near = 2, greatest_correction = 3, growth_near = 1.25, growth = 2.5;
// A mesh has no more than so many times the cells that the order of the elements asks for: where a coarse one is to be
// refined in many more, it has not seen what it estimates.
constexpr double greatest_excess = 1.5;
// Meshes are planned that much smaller than allowed: gmsh makes more cells or fewer than it is asked for.
constexpr double share_of_max_dofs = 0.75;

Cycle cycle_of(const Solution &s, const double seconds)
{
  Cycle cycle;
  cycle.dofs = s.discretization.owned_dofs->getGlobalNumElements();
  cycle.estimate = relative_estimate(s);
  cycle.energy = s.energy;
  cycle.contact_force = s.contact.total.force;
  cycle.max_pressure = s.contact.total.max_pressure;
  cycle.contact_length = s.contact.total.contact_length;
  cycle.pressure_change = s.pressure_norm > 0 ? s.pressure_change / s.pressure_norm : 0;
  for (const int steps : s.uzawa.newton_iterations) cycle.newton_iterations += steps;
  cycle.linear_iterations = s.linear.iterations;
  cycle.recovered_pressure = s.pressure_norm > 0 ? s.estimate->pressure / s.pressure_norm : 0;
  cycle.recovered_max_pressure = s.estimate->max_pressure;
  cycle.peak = s.estimate->peak;
  cycle.contact_ends = s.estimate->contact_ends;
  cycle.seconds = seconds;
  return cycle;
}

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
  const auto growth = changes(cycles, [](const Cycle &a, const Cycle &b) { return b.max_pressure - a.max_pressure; });
  const bool grows = growth.size() > 1 && growth.back() > 0 && growth[growth.size() - 2] > 0;
  if (grows && unsettled(growth, eta, last.recovered_max_pressure))
    return "the largest pressure grows from mesh to mesh and does not settle";
  return "";
}

/// Error bars of the last mesh.
ObservedErrors observed_errors(const std::vector<Cycle> &cycles)
{
  std::vector<double> eta;
  for (const auto &cycle : cycles) eta.push_back(cycle.estimate);
  const auto error = [&](const auto &change) { return adapt::observed_error(changes(cycles, change), eta); };
  const Cycle &last = cycles.back();
  ObservedErrors errors;
  errors.energy = error([](const Cycle &a, const Cycle &b) { return std::abs(b.energy - a.energy); });
  errors.contact_force = error([](const Cycle &a, const Cycle &b) {
    return std::hypot(b.contact_force[0] - a.contact_force[0], b.contact_force[1] - a.contact_force[1],
                      b.contact_force[2] - a.contact_force[2]);
  });
  errors.max_pressure = error([](const Cycle &a, const Cycle &b) { return std::abs(b.max_pressure - a.max_pressure); });
  errors.contact_pressure = error([](const Cycle &, const Cycle &b) { return b.pressure_change; });
  const auto length = [](const Cycle &a, const Cycle &b) { return std::abs(b.contact_length - a.contact_length); };
  errors.contact_length = error(length);
  if (cycles.size() < 2) {
    for (const char *name :
         {"energy_J", "contact_force", "max_pressure", "contact_pressure_l2_relative", "contact_length"})
      errors.unknown[name] = "one mesh shows no change";
    return errors;
  }
  errors.max_pressure = last.peak.at_bound ? 0 : std::max(errors.max_pressure, last.recovered_max_pressure);
  errors.contact_pressure = std::max(errors.contact_pressure, last.recovered_pressure);
  // Sums of weights are rounded.
  errors.contact_length = std::max({errors.contact_length, last.contact_ends, 1e-12 * last.contact_length});
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

/// Plans mesh after mesh.
class Planner
{
public:
  explicit Planner(const Task &task) : task_(task) {}

  /// The mesh after that of a solution; none, and the reason, if there is none to be had. Collective.
  std::optional<mesh::MeshOptions> next(const Solution &s, std::string &reason)
  {
    const double eta = std::sqrt(s.estimate->total());
    const double wanted = aim * task_.adapt.target * std::sqrt(s.energy_norm_squared);
    const double meshes = std::ceil(std::log(eta / wanted) / std::log(greatest_reduction)); // in equal steps
    const bool is_near = eta < near * wanted;
    const double missed = is_near ? std::clamp(eta / planned_, 1., greatest_correction) : 1;
    planned_ = eta * std::pow(wanted / eta, 1 / std::max(1., meshes));
    const double bound = planned_ / missed;

    const double dofs = static_cast<double>(s.discretization.owned_dofs->getGlobalNumElements());
    const mesh::Mesh &mesh = *s.discretization.mesh;
    const double cells = static_cast<double>(sum_all(mesh.comm(), GO(mesh.num_owned_cells)));
    const double most_dofs = share_of_max_dofs * static_cast<double>(task_.adapt.max_dofs);
    const double allowed = most_dofs * cells / dofs;
    const double sensible = greatest_excess * cells * std::pow(eta / bound, 2. / mesh.element.order);
    const auto sizes = new_sizes(s.discretization, *s.estimate,
                                 {bound * bound, std::min(allowed, sensible), is_near ? growth_near : growth});
    if (dofs > 0.9 * most_dofs && sizes.predicted_cells > 0.9 * allowed) {
      reason = "a mesh for the target would exceed \"Adapt->Max Dofs\" = " + std::to_string(task_.adapt.max_dofs);
      return std::nullopt;
    }
    return mesh::with_sizes(task_.mesh, sizes.field);
  }

private:
  const Task &task_;
  double planned_ = std::numeric_limits<double>::infinity(); // estimate that the present mesh was to have
};

/// Why there is nothing to adapt a mesh to.
std::string nothing_strained(const Solution &s)
{
  std::ostringstream reason;
  reason << "nothing is strained";
  if (s.energy_norm_squared > 0)
    reason << ": the strain energy " << s.energy_norm_squared << (s.discretization.per_metre() ? " J/m" : " J")
           << " is rounding, which may reach " << s.estimate->rounding;
  return reason.str();
}

/// The mesh with the least estimate; with the target met that is the last one.
std::size_t best_of(const std::vector<Cycle> &cycles)
{
  const auto less = [](const Cycle &a, const Cycle &b) { return a.estimate < b.estimate; };
  return std::min_element(cycles.begin(), cycles.end(), less) - cycles.begin();
}

/// @param earlier  the load step before, if there are several; its mesh is the first one
Solution solve_adaptively(const Task &task, const Solution *const earlier, const RCP<const Comm> &comm,
                          const Listener &listener)
{
  Adaptation adaptation;
  std::vector<Cycle> &cycles = adaptation.cycles;
  Planner planner(task);
  std::optional<mesh::MeshOptions> options = earlier ? earlier->mesh_options : task.mesh;
  std::optional<Solution> last, best;
  std::string hint;
  PhaseSeconds seconds;
  while (options) {
    const double start = Teuchos::Time::wallTime();
    std::optional<Solution> next;
    try {
      next = solve_on(task, *options, last ? &*last : nullptr, earlier, comm, listener);
    } catch (const Error &failure) { // on all ranks
      if (!last) throw;
      adaptation.reason = interrupted(*comm) ? interruption() + " before the next mesh" : failure.what();
      break;
    }
    seconds += next->seconds;
    if (last && !next->uzawa.converged) {
      adaptation.reason = "no solution on the next mesh: " + next->uzawa.reason;
      break;
    }
    last = std::move(next);
    hint = fem::order_note(last->discretization, task.model.materials);
    if (cycles.empty() && !hint.empty() && listener.note) listener.note(hint);
    cycles.push_back(cycle_of(*last, Teuchos::Time::wallTime() - start));
    if (!best || best_of(cycles) + 1 == cycles.size()) best = last;
    if (listener.cycle) listener.cycle(*last);
    if (!last->uzawa.converged || !std::isfinite(cycles.back().estimate)) {
      adaptation.reason = "there is no solution to estimate an error of";
      break;
    }
    if (listener.estimate) listener.estimate(*last);
    adaptation.reached = cycles.back().estimate <= task.adapt.target;
    if (only_rounding(*last)) adaptation.reason = nothing_strained(*last);
    if (adaptation.reached) break;
    if (last->estimate->total() <= last->estimate->rounding) {
      adaptation.reason = "the estimated error is rounding of the displacements, which finer meshes do not reduce";
      break;
    }
    if (static_cast<int>(cycles.size()) == task.adapt.max_cycles) {
      adaptation.reason = "there were \"Adapt->Max Cycles\" = " + std::to_string(task.adapt.max_cycles) + " meshes";
      break;
    }
    options = planner.next(*last, adaptation.reason);
  }
  if (!adaptation.reached && !hint.empty() && !interrupted(*comm)) adaptation.reason += ". " + hint;
  adaptation.errors = observed_errors({cycles.begin(), cycles.begin() + best_of(cycles) + 1});
  best->adaptation = std::move(adaptation);
  best->seconds = seconds;
  return std::move(*best);
}

/// Load steps, each on meshes of its own.
Solution solve_steps_adaptively(const Task &task, const RCP<const Comm> &comm, const Listener &listener)
{
  std::optional<Solution> earlier;
  PhaseSeconds seconds;
  for (const double t : task.steps.times) {
    Task step = task;
    step.time = t;
    Solution s = solve_adaptively(step, earlier ? &*earlier : nullptr, comm, listener);
    seconds += s.seconds;
    s.seconds = seconds;
    if (listener.load_step) listener.load_step(s);
    earlier = std::move(s);
    if (!succeeded(*earlier)) break;
  }
  return std::move(*earlier);
}

} // namespace

Solution solve(const Task &task, const RCP<const Comm> &comm, const Listener &listener)
{
  const bool several_steps = !task.steps.times.empty();
  if (!task.adapt.adapts())
    return several_steps ? solve_steps(task, comm, listener)
                         : solve_on(task, task.mesh, nullptr, nullptr, comm, listener);
  if (comm->getRank() == 0) mesh::start_gmsh_early();
  return several_steps ? solve_steps_adaptively(task, comm, listener) : solve_adaptively(task, nullptr, comm, listener);
}

PhaseSeconds &PhaseSeconds::operator+=(const PhaseSeconds &other)
{
  for (double PhaseSeconds::*const phase :
       {&PhaseSeconds::mesh, &PhaseSeconds::assembly, &PhaseSeconds::prediction, &PhaseSeconds::setup,
        &PhaseSeconds::solve, &PhaseSeconds::estimate, &PhaseSeconds::output, &PhaseSeconds::total})
    this->*phase += other.*phase;
  return *this;
}

bool only_rounding(const Solution &s)
{
  return s.estimate && s.energy_norm_squared <= s.estimate->rounding;
}

double relative_estimate(const Solution &s)
{
  const double squared = s.estimate->total();
  return squared == 0 || only_rounding(s) ? 0 : std::sqrt(squared / s.energy_norm_squared);
}

double exact_error(const Task &task, const Solution &s)
{
  return std::sqrt(2 * std::abs(s.energy - task.adapt.exact_energy) / s.energy_norm_squared);
}

bool succeeded(const Solution &s)
{
  return s.uzawa.converged && (!s.adaptation || s.adaptation->reached);
}

} // namespace rpc::adapt
