// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

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

/// A vector in its components.
std::string vector_text(const std::array<double, 3> &v, const int dim)
{
  std::string text;
  for (int c = 0; c < dim; ++c) text += (c > 0 ? ", " : "(") + number_text("%.6g", v[c]);
  return text + ")";
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

/// An error bar, or that there is none.
std::string bar_text(const double value, const std::string &unit)
{
  if (std::isnan(value)) return "unknown";
  return number_text("%.1e", value) + (unit.empty() ? "" : " " + unit);
}

int sum(const std::vector<int> &values)
{
  return std::accumulate(values.begin(), values.end(), 0);
}

void print_adaptation(std::ostream &out, const adapt::Adaptation &adaptation, const ResultScope &scope)
{
  const std::string outcome = !adaptation.reached         ? "NOT TO THE TARGET: " + adaptation.reason
                              : adaptation.reason.empty() ? "the error is what was asked for"
                                                          : adaptation.reason;
  out << "  adapted             " << outcome << "\n";
  print(out, "    cycle     dofs    error            J    max. p  Newton  krylov  time [s]\n");
  for (std::size_t k = 0; k < adaptation.cycles.size(); ++k) {
    const adapt::Cycle &c = adaptation.cycles[k];
    print(out, "    %5zu %8zu %8.2e %12.6g %9.4g %7d %7d %9.3f\n", k + 1, c.dofs, c.estimate, c.energy,
          c.contact.max_pressure, c.newton_iterations, sum(c.linear_iterations), c.seconds);
  }
  const auto &e = adaptation.errors;
  if (std::isnan(e.energy)) {
    print(out, "    errors by the sequence: unknown, for these are the results of the first mesh\n");
    return;
  }
  const char *separator = "    errors by the sequence: ";
  for (const auto &q : defined_numbers(adapt::error_bars, scope)) {
    out << separator << q.shown.label << bar_text(e.*q.value, q.unit_name(scope));
    separator = ", ";
  }
  out << '\n';
  for (const auto &[key, reason] : e.unknown)
    out << "    no error of " << adapt::error_bar_name(key, scope) << ": " << reason << '\n';
}

/// In lines of its own, below each other.
void print_note(std::ostream &out, const std::string &note)
{
  constexpr std::size_t width = 110;
  std::string rest = note, heading = "    note              ";
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

ConsoleTable::ConsoleTable(std::ostream &out) : out_(out), start_(Teuchos::Time::wallTime()) {}

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
  print(out_, "%5d     -- ", result.iterations);
  out_ << lines(analysis::residual_quantities, result.residuals, {}, "%.1e").front().numbers << std::endl;
}

void ConsoleTable::load_step(const Scene &scene, const analysis::Solution &s)
{
  const analysis::StepRecord &step = s.history.back();
  const auto &force = step.contact.force;
  const auto &times = scene.steps.times;
  const auto left = static_cast<std::size_t>(times.end() - std::upper_bound(times.begin(), times.end(), step.time));
  ++load_steps_;
  const double now = Teuchos::Time::wallTime() - start_;
  print(out_, "%4zu/%-4zu %9.4g %12.6g %10.4g %12.4g %13.6g %5d %6d %6d %10.3f %9.1f%s\n", s.history.size(),
        s.history.size() + left, step.time, std::hypot(force[0], force[1], force[2]), step.contact.max_pressure,
        step.contact.max_dent, step.energies.dissipated, step.parts, step.newton_iterations, step.linear_iterations,
        now, now / load_steps_ * static_cast<double>(left), step.converged ? "" : " NOT CONVERGED");
  out_ << std::flush;
}

void print_estimate(std::ostream &out, const Scene &scene, const Solution &s)
{
  print(out, "estimated error %.3e of the energy norm", relative_estimate(s));
  if (scene.adapt.adapts()) print(out, ", asked for: %.3e", scene.adapt.target);
  const double exact = exact_error(scene, s);
  if (!std::isnan(exact)) print(out, "; by the exact energy %.3e", exact);
  if (only_rounding(s)) print(out, ". The strain energy is at rounding level; the estimate is meaningless.");
  out << std::endl;
}

namespace
{

/// Numbers of a solution.
void print_results(std::ostream &out, const Scene &scene, const Solution &s, const ResultScope &scope)
{
  const int dim = s.discretization.dim();
  const auto unit_of = [&](const Unit &unit) { return scope.units.of(unit, scope.per_length); };
  print(out, "  energy J            %.9g %s\n", s.energy, unit_of(unit::energy).c_str());
  print_lines(out, lines(analysis::body_quantities, s.body, scope, "%.6g"));
  if (!scene.model.contact.empty()) {
    print(out, "  contact force       %s %s\n", vector_text(s.contact.total.force, dim).c_str(),
          unit_of(unit::force).c_str());
    print_lines(out, lines(contact::contact_quantities, s.contact.total, scope, "%.6g"));
    const auto last =
        std::find_if(s.history.rbegin(), s.history.rend(), [](const auto &step) { return step.converged; });
    if (last != s.history.rend()) print_lines(out, lines(analysis::energy_quantities, last->energies, scope, "%.6g"));
  }
  if (s.estimate) {
    print(out, "  ");
    print_estimate(out, scene, s);
  }
  for (std::size_t k = 0; k < scene.model.contact.size() && scene.model.contact.size() > 1; ++k) {
    const contact::ContactSums &side = s.contact.sides[k];
    out << "    on \"" << scene.model.contact[k].name_in_results() << "\": force " << vector_text(side.force, dim);
    for (const Line &line : lines(contact::contact_quantities, side, scope, "%.6g"))
      out << ", " << line.heading << ' ' << line.numbers;
    out << '\n';
  }
}

} // namespace

void print_summary(std::ostream &out, const Scene &scene, const Solution &s, const std::vector<std::string> &notes,
                   const std::vector<std::string> &files)
{
  const ResultScope scope = analysis::result_scope(scene.model, s.discretization);
  const bool stopped = s.failure || !s.uzawa.converged;
  out << '\n' << (stopped ? "NOT CONVERGED: " : "");
  if (stopped && !s.history.empty()) print(out, "at t = %g: ", s.failure ? s.failure->time : s.time);
  out << (s.failure ? s.failure->reason : s.uzawa.reason) << '\n';
  if (s.failure) print(out, "  results             of the last step that converged, t = %g\n", s.time);
  print_lines(out, lines(analysis::residual_quantities, s.uzawa.residuals, scope, "%.1e"));
  if (s.has_results())
    print_results(out, scene, s, scope);
  else
    out << "  results             none: the last iterate is no solution\n";
  print(out,
        "  work                %d Uzawa, %d Newton, %zu linear solves, %d iterations in them, %d preconditioner "
        "set-ups\n",
        s.uzawa.iterations, sum(s.uzawa.newton_iterations), s.linear.iterations.size(), sum(s.linear.iterations),
        s.linear.preconditioner_setups);
  out << "    linear solver     " << solver::chosen_solver(s.linear) << '\n';
  if (s.coarse_choices > 0)
    print(out, "    %d of the Newton steps to states that the coarser mesh chose\n", s.coarse_choices);
  if (s.line_search_steps > 0)
    print(out, "    %d of the Newton steps with sweep and line search: the active-set iteration did not settle\n",
          s.line_search_steps);
  for (const auto &level : s.levels)
    print(out, "    predicted by      %zu dofs: %d Newton, %d linear iterations, %.3f s\n", level.dofs,
          level.newton_iterations, sum(level.linear_iterations), level.seconds);
  if (s.adaptation && s.has_results()) print_adaptation(out, *s.adaptation, scope);
  print_balance(out, scene, s);
  for (const auto &note : notes) print_note(out, note);
  for (const auto &skipped : s.skipped) print(out, "    skipped           %s\n", skipped.c_str());
  print_lines(out, lines(analysis::phase_seconds, s.seconds, scope, "%.3f"));
  for (const auto &file : files) print(out, "  wrote %s\n", file.c_str());
}

} // namespace rpc
