#include "report.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numeric>

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

/// An error bar, or that there is none.
std::string bar_text(const double value, const char *unit)
{
  if (std::isnan(value)) return "unknown";
  char text[60];
  std::snprintf(text, sizeof text, "%.1e%s", value, unit);
  return text;
}

int sum(const std::vector<int> &values)
{
  return std::accumulate(values.begin(), values.end(), 0);
}

void print_adaptation(std::ostream &out, const adapt::Adaptation &adaptation, const bool per_metre)
{
  const std::string outcome = !adaptation.reached         ? "NOT TO THE TARGET: " + adaptation.reason
                              : adaptation.reason.empty() ? "the error is what was asked for"
                                                          : adaptation.reason;
  out << "  adapted             " << outcome << "\n";
  print(out, "    cycle     dofs    error            J    max. p  Newton  krylov  time [s]\n");
  for (std::size_t k = 0; k < adaptation.cycles.size(); ++k) {
    const adapt::Cycle &c = adaptation.cycles[k];
    print(out, "    %5zu %8zu %8.2e %12.6g %9.4g %7d %7d %9.3f\n", k + 1, c.dofs, c.estimate, c.energy, c.max_pressure,
          c.newton_iterations, sum(c.linear_iterations), c.seconds);
  }
  const auto &e = adaptation.errors;
  if (std::isnan(e.energy)) {
    print(out, "    errors by the sequence: unknown, for these are the results of the first mesh\n");
    return;
  }
  print(out, "    errors by the sequence: J %s, contact force %s, max. pressure %s, pressure in L2 %s, in contact %s\n",
        bar_text(e.energy, per_metre ? " J/m" : " J").c_str(),
        bar_text(e.contact_force, per_metre ? " N/m" : " N").c_str(), bar_text(e.max_pressure, " Pa").c_str(),
        bar_text(e.contact_pressure, "").c_str(), bar_text(e.contact_length, per_metre ? " m" : " m^2").c_str());
  for (const auto &[name, reason] : e.unknown) print(out, "    no error of %s: %s\n", name.c_str(), reason.c_str());
}

} // namespace

ConsoleTable::ConsoleTable(std::ostream &out) : out_(out), start_(Teuchos::Time::wallTime()) {}

void ConsoleTable::scene(const Scene &scene, const fem::Discretization &d, const contact::ContactNodes &contact)
{
  const mesh::Mesh &mesh = *d.mesh;
  std::string sides;
  for (const auto &side : scene.model.contact) sides += (sides.empty() ? " on \"" : ", \"") + side.side + "\"";
  const std::string kinematics = mesh.dim() == 2 ? ", " + fem::name_of(d.kinematics) : "";
  print(out_, "%s: %lld %s cells%s, %lld dofs, %lld contact nodes%s, %d rank%s, %s\n", scene.name.c_str(),
        static_cast<long long>(sum_all(mesh.comm(), GO(mesh.num_owned_cells))), mesh.element.name().c_str(),
        kinematics.c_str(), static_cast<long long>(d.owned_dofs->getGlobalNumElements()),
        static_cast<long long>(contact.num_total), sides.c_str(), mesh.comm().getSize(),
        mesh.comm().getSize() == 1 ? "" : "s", ExecutionSpace::name());
  if (contact.num_fixed > 0)
    print(out_,
          "note: the normal displacement of %lld contact nodes is prescribed by \"Dirichlet\", which wins over contact "
          "there\n",
          static_cast<long long>(contact.num_fixed));
  if (contact.num_missing > 0)
    print(out_, "note: from %lld nodes of the contact sides the normal misses the obstacle: they never touch\n",
          static_cast<long long>(contact.num_missing));
  const std::string locking = fem::locking_note(d, scene.model.materials);
  if (!locking.empty()) print(out_, "note: %s\n", locking.c_str());
  if (scene.steps.times.empty())
    print(out_, "uzawa newton   |F|/|b|     step    open  closed  yields krylov   time [s]\n");
  else if (load_steps_ == 0)
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
  const auto &c = result.residuals;
  print(out_, "%5d     -- kkt %.1e, equilibrium %.1e, energy balance %.1e, duality gap %.1e\n", result.iterations,
        c.kkt_residual, c.equilibrium_residual, c.energy_balance, c.duality_gap);
  out_ << std::flush;
}

void ConsoleTable::load_step(const Scene &scene, const Solution &s)
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
  if (only_rounding(s)) print(out, "; nothing is strained, what is estimated is rounding");
  out << std::endl;
}

void print_summary(std::ostream &out, const Scene &scene, const Solution &s, const std::vector<std::string> &files)
{
  const bool flat = s.discretization.dim() == 2, per_metre = s.discretization.per_metre();
  const auto &c = s.contact.total;
  print(out, "\n%s: %s\n", s.uzawa.converged ? "converged" : "NOT CONVERGED", s.uzawa.reason.c_str());
  const auto &held = s.uzawa.residuals;
  print(out, "  optimality          kkt %.1e, equilibrium %.1e, energy balance %.1e, duality gap %.1e\n",
        held.kkt_residual, held.equilibrium_residual, held.energy_balance, held.duality_gap);
  print(out, "  energy J            %.9g %s\n", s.energy, per_metre ? "J/m" : "J");
  if (!scene.model.contact.empty()) {
    print(out, "  contact force       (%.6g, %.6g%s) %s\n", c.force[0], c.force[1],
          flat ? "" : (", " + std::to_string(c.force[2])).c_str(), per_metre ? "N/m" : "N");
    print(out, "  max. pressure       %.6g Pa\n", c.max_pressure);
    print(out, "  max. penetration    %.6g m\n", c.max_penetration);
    if (c.max_initial_penetration > 0) print(out, "  initial penetration %.6g m\n", c.max_initial_penetration);
    if (!s.history.empty()) {
      const analysis::Energies &e = s.history.back().energies;
      print(out, "  dents               at most %.6g m, volume %.6g\n", c.max_dent, c.dent_volume);
      print(out, "  since the start     work %.6g, strain %.6g, foundation %.6g, dissipated %.6g %s\n", e.work,
            e.strain, e.foundation, e.dissipated, per_metre ? "J/m" : "J");
    }
    print(out, "  in contact          %.6g, yielded %.6g %s\n", c.contact_length, c.yielded_length,
          per_metre ? "m" : "m^2");
  }
  if (s.estimate) {
    print(out, "  ");
    print_estimate(out, scene, s);
  }
  for (std::size_t k = 0; k < scene.model.contact.size() && scene.model.contact.size() > 1; ++k) {
    const auto &side = s.contact.sides[k];
    print(out, "    on \"%s\": force (%.6g, %.6g%s), max. pressure %.6g, in contact %.6g, yielded %.6g\n",
          scene.model.contact[k].side.c_str(), side.force[0], side.force[1],
          flat ? "" : (", " + std::to_string(side.force[2])).c_str(), side.max_pressure, side.contact_length,
          side.yielded_length);
  }
  print(out,
        "  work                %d Uzawa, %d Newton, %zu linear solves, %d CG iterations, %d preconditioner set-ups\n",
        s.uzawa.iterations, sum(s.uzawa.newton_iterations), s.linear.iterations.size(), sum(s.linear.iterations),
        s.linear.preconditioner_setups);
  if (s.line_search_steps > 0)
    print(out, "    %d of the Newton steps with sweep and line search: the active-set iteration did not settle\n",
          s.line_search_steps);
  for (const auto &level : s.levels)
    print(out, "    predicted by      %zu dofs: %d Newton, %d CG iterations, %.3f s\n", level.dofs,
          level.newton_iterations, sum(level.linear_iterations), level.seconds);
  if (s.adaptation) print_adaptation(out, *s.adaptation, per_metre);
  for (const auto &skipped : s.skipped) print(out, "    skipped           %s\n", skipped.c_str());
  const auto &t = s.seconds;
  print(out,
        "  time [s]            mesh %.3f, assembly %.3f, prediction %.3f, set-up %.3f, solve %.3f, estimate %.3f, "
        "output %.3f, total %.3f\n",
        t.mesh, t.assembly, t.prediction, t.setup, t.solve, t.estimate, t.output, t.total);
  for (const auto &file : files) print(out, "  wrote %s\n", file.c_str());
}

} // namespace rpc
