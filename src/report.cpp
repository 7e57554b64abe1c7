// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include "output/result_list.hpp"
#include "rpc/contact/contact_patches.hpp"
#include "rpc/core/point.hpp"
#include "rpc/core/quantity.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numeric>
#include <utility>

namespace rpc
{
namespace
{

/// printf into a stream.
[[gnu::format(printf, 2, 3)]] void print(std::ostream &out, const char *format, ...)
{
  char line[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out << line;
}

std::string number_text(const char *format, const double value)
{
  char text[60];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A line of numbers with one heading.
struct Line {
  std::string heading, numbers;
};

/// The lines that a record's numbers have on the console. The unit stands behind the last number where all have the same one.
/// @param format  of a number
template <class Table, class Record>
std::vector<Line> lines(const Table &table, const Record &record, const ResultScope &scope, const char *const format)
{
  std::vector<Line> all;
  const auto numbers = defined_numbers(table, scope);
  for (auto first = numbers.begin(); first != numbers.end();) {
    const auto end = std::find_if(first, numbers.end(), [&](const auto &q) {
      return std::string(q.shown.heading ? q.shown.heading : "") != (first->shown.heading ? first->shown.heading : "");
    });
    const std::string unit = std::prev(end)->unit_name(scope);
    const bool one_unit = std::all_of(first, end, [&](const auto &q) { return q.unit_name(scope) == unit; });
    const bool shown = first->shown.heading && std::any_of(first, end, [&](const auto &q) {
                         return !q.shown.only_positive || record.*q.value > 0;
                       });
    std::string text;
    for (auto q = first; q != end; ++q) {
      const bool with_unit = !q->unit_name(scope).empty() && (!one_unit || std::next(q) == end);
      text += (q == first ? "" : ", ") + std::string(q->shown.label) + number_text(format, record.*q->value) +
              (with_unit ? " " + q->unit_name(scope) : "");
    }
    if (shown) all.push_back({first->shown.heading, text});
    first = end;
  }
  return all;
}

void print_lines(std::ostream &out, const std::vector<Line> &lines)
{
  for (const Line &line : lines) {
    print(out, "  %-19s ", line.heading.c_str());
    out << line.numbers << '\n';
  }
}

int sum(const std::vector<int> &values)
{
  return std::accumulate(values.begin(), values.end(), 0);
}

/// Sizes of the contact forces of all sides together [N]: those of two plates that squeeze a body do not cancel.
double pressing(const analysis::StepRecord &step)
{
  if (step.side_forces.size() < 2) return length(step.contact.force);
  double sum = 0;
  for (const auto &force : step.side_forces) sum += length(force);
  return sum;
}

/// The meshes of an adaptive run.
void print_meshes(std::ostream &out, const adapt::Adaptation &adaptation)
{
  print(out, "    mesh      dofs    error            J    max. p  Newton  krylov  time [s]\n");
  for (std::size_t k = 0; k < adaptation.cycles.size(); ++k) {
    const adapt::Cycle &c = adaptation.cycles[k];
    print(out, "    %5zu %8zu %8.2e %12.6g %9.4g %7d %7d %9.3f\n", k + 1, c.dofs, c.estimate, c.energy,
          c.contact.max_pressure, c.newton_iterations, sum(c.linear_iterations), c.seconds);
  }
}

/// @param format  of a number
std::string estimate_text(const Scene &scene, const Solution &s, const char *const format)
{
  std::string text = number_text(format, relative_estimate(s)) + " of the energy norm";
  if (s.estimate->misses_contact()) text = "at least " + text;
  if (scene.adapt.adapts()) text += ", asked for: " + number_text(format, scene.adapt.target);
  const double exact = exact_error(scene, s);
  if (!std::isnan(exact)) text += "; by the exact energy " + number_text(format, exact);
  if (only_rounding(s)) text += ". The strain energy is at rounding level; the estimate is meaningless.";
  return text;
}

/// A heading with its text, in lines below each other.
void print_text(std::ostream &out, const std::string &what, const std::string &text)
{
  constexpr std::size_t width = 110;
  std::string rest = text,
              heading = "  " + what + std::string(std::max<std::size_t>(20, what.size() + 1) - what.size(), ' ');
  while (!rest.empty()) {
    const std::size_t blank = rest.size() > width ? rest.rfind(' ', width) : std::string::npos;
    out << heading << rest.substr(0, blank) << '\n';
    rest = blank == std::string::npos ? "" : rest.substr(blank + 1);
    heading.assign(heading.size(), ' ');
  }
}

/// Steps whose work does not fit their energies as well as the deck asks for.
void print_balance(std::ostream &out, const Scene &scene, const Solution &s)
{
  if (!s.out_of_balance) return;
  const std::string reason = analysis::not_kept(*s.out_of_balance, scene.steps.energy_tolerance, s.history.size());
  if (!reason.empty()) out << "  energy balance      NOT TO THE TOLERANCE: " << reason << '\n';
}

} // namespace

ConsoleTable::ConsoleTable(std::ostream &out, const bool verbose)
    : out_(out), verbose_(verbose), start_(Teuchos::Time::wallTime())
{
}

void ConsoleTable::scene(const Scene &scene, const fem::Discretization &d, const contact::ContactNodes &contact)
{
  const mesh::Mesh &mesh = *d.mesh;
  std::string sides;
  for (const auto &side : scene.model.contact)
    sides += (sides.empty() ? " on \"" : ", \"") + side.name_in_results() + "\"";
  const std::string kinematics = mesh.dim() == 2 ? ", " + fem::name_of(d.kinematics) : "";
  print(out_, "%s: %lld %s cells%s, %lld dofs, %lld contact nodes%s, %d rank%s, %s\n", scene.name.c_str(),
        static_cast<long long>(sum_all(mesh.comm(), GO(mesh.num_owned_cells))), mesh.element.name().c_str(),
        kinematics.c_str(), static_cast<long long>(d.owned_dofs->getGlobalNumElements()),
        static_cast<long long>(contact.num_total), sides.c_str(), mesh.comm().getSize(),
        mesh.comm().getSize() == 1 ? "" : "s", ExecutionSpace::name());
  out_ << std::flush;
  heads_due_ = !scene.has_steps() || load_steps_ == 0;
}

void ConsoleTable::heads(const Scene &scene)
{
  if (!std::exchange(heads_due_, false)) return;
  if (!scene.has_steps())
    print(out_, "uzawa newton   |F|/|b|     step    open  closed  yields krylov   time [s]\n");
  else
    print(out_, "    step         t      |force|     max. p    max. dent    dissipated parts Newton krylov   time [s]  "
                "left [s]\n");
  out_ << std::flush;
}

void ConsoleTable::newton(const int uzawa, const solver::NewtonStep &step, const contact::StateCounts &n)
{
  out_ << std::exchange(residuals_, "");
  print(out_, "%5d %6d  %8.2e", uzawa, step.iteration, step.residual);
  if (step.iteration == 0)
    print(out_, "         ");
  else
    print(out_, " %8.2e", step.step_length);
  print(out_, " %7lld %7lld %7lld %6d %10.3f\n", static_cast<long long>(n.open), static_cast<long long>(n.closed),
        static_cast<long long>(n.yielding), step.linear_iterations, Teuchos::Time::wallTime() - start_);
  out_ << std::flush;
}

void ConsoleTable::uzawa(const analysis::UzawaResult &result)
{
  residuals_ = number_text("%5.0f     -- ", result.iterations) +
               lines(analysis::residual_quantities, result.residuals, {}, "%.1e").front().numbers + '\n';
  if (verbose_) out_ << std::exchange(residuals_, "") << std::flush;
}

void ConsoleTable::load_step(const Scene &scene, const analysis::Solution &s)
{
  const analysis::StepRecord &step = s.history.back();
  const auto &times = scene.steps.times;
  const auto left = static_cast<std::size_t>(times.end() - std::upper_bound(times.begin(), times.end(), step.time));
  ++load_steps_;
  const double now = Teuchos::Time::wallTime() - start_;
  print(out_, "%4zu/%-4zu %9.4g %12.6g %10.4g %12.4g %13.6g %5d %6d %6d %10.3f %9.1f%s\n", s.history.size(),
        s.history.size() + left, step.time, pressing(step), step.contact.max_pressure, step.contact.max_dent,
        step.energies.dissipated, step.parts, step.newton_iterations, step.linear_iterations, now,
        now / load_steps_ * static_cast<double>(left), step.converged ? "" : " NOT CONVERGED");
  out_ << std::flush;
}

void print_estimate(std::ostream &out, const Scene &scene, const Solution &s)
{
  out << "estimated error " << estimate_text(scene, s, "%.3e") << std::endl;
}

namespace
{

std::string place_text(const Scene &scene, const contact::PlaceBetweenNodes &at, const int dim)
{
  std::string text = "at ";
  for (int c = 0; c < dim; ++c) text += (c > 0 ? ", " : "(") + number_text("%.4g", at.place[c]);
  return text + ") on \"" + scene.model.contact[at.side].name_in_results() + "\"";
}

/// What lies between the nodes of the contact sides.
std::string missed(const Scene &scene, const Solution &s, const ResultScope &scope)
{
  const auto in = [&](const Unit &unit) { return " " + scope.units.of(unit, scope.per_length); };
  const contact::ContactSums &sums = s.contact.total;
  const contact::BetweenNodes &between = s.contact.between;
  const int dim = s.discretization.dim();
  if (sums.num_nodes == 0) return "no node of the contact sides faces the foundation: there is no contact";
  if (!(between.deepest.depth > 0)) return "no penetration between the nodes";
  std::string text = "between nodes the body lies " + number_text("%.3g", sums.max_penetration_between_nodes) +
                     in(unit::length) + " deeper in the foundation, " + place_text(scene, between.deepest, dim);
  if (between.unseen.depth > 0)
    text += "; contact that no node has, " + number_text("%.3g", sums.unseen_penetration) + in(unit::length) +
            " deep " + place_text(scene, between.unseen, dim) + ", of an energy of " +
            number_text("%.2g", sums.unseen_energy) + in(unit::energy);
  return text;
}

/// Results, those of one heading on one line. Reasons for missing error bars stand behind the numbers that have one of their own.
std::vector<Line> result_lines(const std::vector<Result> &results)
{
  std::vector<Line> all;
  for (const Result &result : results) {
    if (result.line.empty()) continue;
    if (all.empty() || all.back().heading != result.line)
      all.push_back({result.line, ""});
    else
      all.back().numbers += ", ";
    all.back().numbers += result.label + text_of(result);
    if (result.tells_why) all.back().numbers += " (no error bar: " + result.no_bar + ")";
  }
  return all;
}

/// What is certain of the error.
void print_bound(std::ostream &out, const Scene &scene, const Solution &s)
{
  if (!s.bound) return;
  const bound::EnergyBound &b = *s.bound;
  const std::string unit = scene.model.units.of(unit::energy, s.discretization.per_length());
  print_text(
      out, "guaranteed",
      b.missing.empty()
          ? std::string(bound::name_of(b.of)) + " of the exact solution is in [" + number_text("%.9g", b.lower) + ", " +
                number_text("%.9g", b.upper) + "] " + unit + "; error at most " +
                (s.energy_norm_squared > 0
                     ? number_text("%.1e", b.energy_norm / std::sqrt(s.energy_norm_squared)) + " of the energy norm"
                     : number_text("%.1e", b.energy_norm) + " in the energy norm")
          : "nothing: " + b.missing);
  const std::string of_force = scene.model.units.of(unit::force, s.discretization.per_length());
  for (std::size_t k = 0; k < b.contact_force.size(); ++k) {
    const bound::ForceBound &force = b.contact_force[k];
    const std::string side = "\"" + scene.model.contact[k].name_in_results() + "\" along its normal";
    print_text(out, "guaranteed force",
               force.missing.empty() ? "that of " + side + " is in [" + number_text("%.6g", force.lower) + ", " +
                                           number_text("%.6g", force.upper) + "] " + of_force
                                     : "unknown of " + side + ": " + force.missing);
  }
  for (const bound::GoalBound &goal : b.goals) {
    const std::string name = "\"" + goal.goal.name + "\"";
    print_text(out, "guaranteed goal",
               goal.missing.empty()
                   ? name + " = " + number_text("%.6g", goal.value) + ", the exact one in [" +
                         number_text("%.6g", goal.lower) + ", " + number_text("%.6g", goal.upper) + "] " +
                         scene.model.units.of(bound::unit_of(goal.goal.type), s.discretization.per_length()) +
                         (std::isnan(goal.estimated_error) ? ""
                                                           : "; estimated (not guaranteed): " +
                                                                 number_text("%.6g", goal.value + goal.estimated_error))
                   : name + " has no interval: " + goal.missing);
  }
}

/// Where error bars come from, or how to have them.
void print_accuracy(std::ostream &out, const Scene &scene, const Solution &s)
{
  print_bound(out, scene, s);
  const auto &box = s.discretization.mesh->box;
  if (box && mesh::periodic(*box)) {
    print_text(out, "errors", "not estimated in a periodic box");
    return;
  }
  if (!s.estimate) {
    print_text(
        out, "errors",
        s.bound && s.bound->missing.empty()
            ? "bounded of J alone: add \"Adapt->Target Relative Error\", such as 0.01, for further error bars"
            : "not estimated: add \"Adapt->Target Relative Error\", such as 0.01, for error bars on meshes that are "
              "adapted, or \"Adapt->Estimate Error\" = true for that of J on this mesh");
    return;
  }
  const adapt::ObservedErrors errors = adapt::errors_of(scene, s);
  std::string text = estimate_text(scene, s, "%.1e");
  if (std::isfinite(errors.contact_pressure) && !scene.model.contact.empty())
    text += "; of the contact pressure " + number_text("%.1e", errors.contact_pressure) + " of its norm in L2";
  print_text(out, "estimated error", text);
  if (!s.adaptation && std::isfinite(errors.energy))
    print_text(out, "errors", "of J alone: add \"Adapt->Target Relative Error\", such as 0.01, for further error bars");
  else if (const auto reason = errors.unknown.find("contact_force"); reason != errors.unknown.end())
    print_text(out, "errors", (std::isfinite(errors.energy) ? "of J alone: " : "not known: ") + reason->second);
  else
    print_text(out, "errors", "of numbers without an error bar are not estimated");
}

/// How contact is spread over sides whose foundations have details of their own, as rough surfaces do. Collective.
void print_patches(std::ostream &out, const Scene &scene, const Solution &s, const ResultScope &scope)
{
  const auto &sides = scene.model.contact;
  const auto is_detailed = [](const auto &side) { return side.obstacle.surface && side.obstacle.surface->detail; };
  if (std::none_of(sides.begin(), sides.end(), is_detailed)) return;
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto patches = contact::contact_patches(mesh, contact::contact_sides(mesh, sides), s.step.contact, s.contact);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    if (!is_detailed(sides[k])) continue;
    const auto in = [&](const Unit &unit) { return " " + scope.units.of(unit, scope.per_length); };
    const std::size_t count = patches[k].size.size();
    std::string text = std::to_string(count);
    if (count > 0) text += ", the largest " + number_text("%.6g", patches[k].size.front()) + in(unit::extent);
    text += "; mean gap " + number_text("%.6g", patches[k].mean_gap) + in(unit::length);
    print_text(out, sides.size() > 1 ? "patches on \"" + sides[k].name_in_results() + "\"" : "patches", text);
  }
}

/// Numbers of a solution.
void print_results(std::ostream &out, const Scene &scene, const Solution &s, const std::vector<std::string> &notes)
{
  const ResultScope scope = analysis::result_scope(scene.model, s.discretization);
  print_lines(out, result_lines(result_list(scene, s)));
  const auto &sides = scene.model.contact;
  for (std::size_t k = 0; k < sides.size() && sides.size() > 1; ++k) {
    std::string text;
    for (const Line &line : result_lines(side_results(scene, s, k)))
      text += (text.empty() ? "" : "; ") + line.heading + ' ' + line.numbers;
    print_text(out, "on \"" + sides[k].name_in_results() + "\"", text);
  }
  print_patches(out, scene, s, scope);
  print_accuracy(out, scene, s);
  if (!sides.empty()) print_text(out, "mesh misses", missed(scene, s, scope));
  for (const auto &note : notes) print_text(out, "note", note);
  if (const std::size_t told = s.notes.size() - notes.size(); told > 0)
    print(out, "  notes               %zu above, in %s \"note:\"\n", told,
          told == 1 ? "the line that begins with" : "lines that begin with");
}

void print_work(std::ostream &out, const Solution &s)
{
  print(out,
        "  work                %s%d Uzawa, %d Newton, %zu linear solves, %d iterations in them, %d preconditioner "
        "set-ups\n",
        s.history.size() > 1 ? "of the last step: " : "", s.uzawa.iterations, sum(s.uzawa.newton_iterations),
        s.linear.iterations.size(), sum(s.linear.iterations), s.linear.preconditioner_setups);
  out << "    linear solver     " << solver::chosen_solver(s.linear) << '\n';
  if (s.coarse_choices > 0)
    print(out, "    %d of the Newton steps to states that the coarser mesh chose\n", s.coarse_choices);
  if (s.line_search_steps > 0)
    print(out, "    %d of the Newton steps with sweep and line search: the active-set iteration did not settle\n",
          s.line_search_steps);
  for (const auto &level : s.levels)
    print(out, "    predicted by      %zu dofs: %d Newton, %d linear iterations, %.3f s\n", level.dofs,
          level.newton_iterations, sum(level.linear_iterations), level.seconds);
}

void print_candidates(std::ostream &out, const solver::LinearSolverCounts &counts)
{
  print(out, "    candidates        %-20s %8s %8s %11s\n", "", "set-ups", "solves", "iterations");
  for (const solver::CandidateCounts &c : counts.candidates)
    print(out, "                      %-20s %8d %8d %11d%s%s\n", c.name.c_str(), c.setups, c.solves, c.iterations,
          c.left.empty() ? (c.tried ? "" : "  not tried")
          : c.tried      ? "  left: "
                         : "  not tried: ",
          c.left.c_str());
}

} // namespace

void print_summary(std::ostream &out, const Scene &scene, const Solution &s, const std::vector<std::string> &notes,
                   const std::vector<std::string> &files)
{
  const bool stopped = s.failure || !s.uzawa.converged;
  out << '\n' << (stopped ? "NOT CONVERGED: " : "");
  if (stopped && !s.history.empty()) print(out, "at t = %g: ", s.failure ? s.failure->time : s.time);
  out << (s.failure ? s.failure->reason : s.uzawa.reason) << '\n';
  if (s.adaptation && s.has_results()) {
    const adapt::Adaptation &a = *s.adaptation;
    print_text(out, "adapted",
               !a.reached         ? "NOT TO THE TARGET: " + a.reason
               : a.reason.empty() ? "the error is what was asked for"
                                  : a.reason);
  }
  print_balance(out, scene, s);
  if (s.failure)
    print(out, "  results             of the last step that converged, t = %g\n", s.time);
  else if (s.has_results() && !s.history.empty())
    print(out, "  results             at t = %g, the last of %zu step%s\n", s.time, s.history.size(),
          s.history.size() == 1 ? "" : "s");
  if (s.failure || !s.uzawa.reason_has_residuals) {
    for (const Line &line : lines(analysis::residual_quantities, s.uzawa.residuals, {}, "%.1e"))
      print(out, "  residuals           %s, tolerance %g\n", line.numbers.c_str(), scene.step.uzawa.tolerance);
  }
  if (s.has_results())
    print_results(out, scene, s, notes);
  else
    out << "  results             none: the last iterate is no solution\n";
  print_work(out, s);
  if (s.adaptation && s.has_results()) print_meshes(out, *s.adaptation);
  if (scene.output.verbose && !s.linear.candidates.empty()) print_candidates(out, s.linear);
  if (scene.output.verbose)
    for (const auto &skipped : s.skipped) print(out, "    skipped           %s\n", skipped.c_str());
  print_lines(out, lines(analysis::phase_seconds, s.seconds, {}, "%.3f"));
  for (const auto &file : files) print(out, "  wrote %s\n", file.c_str());
}

} // namespace rpc
