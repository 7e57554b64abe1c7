// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/run.hpp"

#include "body/obstacle_force.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/contact/node_columns.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/timed.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/fem/rounding.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>
#include <variant>

namespace rpc::analysis
{
namespace
{

std::shared_ptr<const mesh::Mesh> make_mesh(const mesh::MeshOptions &options, const RCP<const Comm> &comm,
                                            PhaseSeconds &seconds)
{
  const Timed phase("mesh", seconds.mesh);
  throw_if_interrupted(*comm, "before the mesh was made; no results are written");
  return std::make_shared<mesh::Mesh>(mesh::make_mesh(options, comm));
}

std::shared_ptr<const Problem> make_problem(const Task &task, std::shared_ptr<const mesh::Mesh> mesh,
                                            PhaseSeconds &seconds)
{
  const Timed phase("assembly", seconds.assembly);
  throw_if_interrupted(mesh->comm(), "before the assembly; no results are written");
  return std::make_shared<Problem>(std::move(mesh), task.model, task.time);
}

/// The scene on coarser and coarser meshes: those that multigrid needs too where they are boxes or parents, else made by the
/// options. None that is not smaller.
CoarserProblem coarser_meshes(Task task, const mesh::MeshOptions &options, const RCP<const Comm> &comm)
{
  return [task = std::move(task), options, comm](const Problem &finer,
                                                 const int level) -> std::shared_ptr<const Problem> {
    if (const auto nested = finer.coarser(task.step.prediction.coarsening, task.time)) return nested;
    std::optional<mesh::MeshOptions> coarse = options;
    for (int k = 0; k < level && coarse; ++k) coarse = mesh::coarser(*coarse, task.step.prediction.coarsening);
    PhaseSeconds seconds;
    if (!coarse) return nullptr;
    if (auto *const box = std::get_if<mesh::BoxOptions>(&*coarse)) // there may be fewer cells than ranks
      *box = mesh::divided(*box, comm->getSize(), linear_rules.least_nodes_of_rank);
    auto mesh = make_mesh(*coarse, comm, seconds);
    // A .geo with Transfinite curves has as many cells whatever the size factor is.
    if (mesh->owned_nodes->getGlobalNumElements() >= finer.discretization().mesh->owned_nodes->getGlobalNumElements())
      return nullptr;
    return make_problem(task, std::move(mesh), seconds);
  };
}

/// Lists the parts of the algorithm that this run skipped, with reasons; collective.
void note_skipped(const Task &task, Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto &contact = s.step.contact;
  const LO shapes = s.discretization.congruent.size();
  const auto skip = [&s](const bool skipped, const std::string &what) {
    if (skipped) s.skipped.push_back(what);
  };
  skip(!s.not_predicted.empty(), "coarser meshes: " + s.not_predicted);
  skip(s.line_search_steps == 0 && s.uzawa.converged,
       "generalized Newton with line search: the active set was confirmed");
  skip(task.model.contact.empty(), "contact: no side may touch");
  for (std::size_t k = 0; k < task.model.contact.size(); ++k)
    skip(sum_all(mesh.comm(), GO(contact.first(k + 1) - contact.first(k))) == 0,
         "contact of \"" + task.model.contact[k].path + "\": its obstacle faces no node of side \"" +
             task.model.contact[k].side + "\"");
  skip(contact.num_total > contact.num_fixed && s.uzawa.iterations == 1,
       "multiplier updates: pressures of the chosen states obey the contact law");
  const int local = s.linear.local_corrections;
  skip(local > 0, "multigrid set-ups: " + std::to_string(local) + (local == 1 ? " change" : " changes") +
                      " of the active set reused the hierarchy with local updates");
  skip(!s.linear.fallback.empty(), "multigrid on coarser meshes: " + s.linear.fallback);
  skip(min_all(mesh.comm(), shapes) > 0, "cell matrices: cells are alike, one for each shape is enough");
}

} // namespace

void set_obstacle_origins(Task &task)
{
  for (auto &side : task.model.contact) {
    contact::Obstacle &obstacle = side.obstacle;
    if (!obstacle.exists()) continue;
    obstacle.origin = obstacle.seen_at(0).point;
    if (!side.has_friction() && side.dents_move_with != contact::DentsMoveWith::foundation) continue;
    for (const double coordinate : obstacle.origin)
      RPC_REQUIRE(std::isfinite(coordinate),
                  "deck: \"" << side.path
                             << "->Obstacle\": the motion along the side counts from t = 0, and a coordinate of its \""
                             << contact::point_name(obstacle) << "\" is " << coordinate
                             << " [m] there. Give an expression that is finite at t = 0.");
  }
}

PhaseSeconds &PhaseSeconds::operator+=(const PhaseSeconds &other)
{
  add_numbers(phase_seconds, *this, other);
  return *this;
}

ResultScope result_scope(const Model &model, const fem::Discretization &d)
{
  return {d.per_length(), contact::has_friction(model.contact), model.units};
}

MadeMesh made_mesh(const mesh::MeshOptions &options, const RCP<const Comm> &comm)
{
  PhaseSeconds seconds;
  auto mesh = make_mesh(options, comm, seconds);
  return {options, std::move(mesh), seconds.mesh};
}

double energy_rounding(const Task &task, const Solution &s)
{
  if (!std::isfinite(task.steps.energy_tolerance) || !s.uzawa.converged) return 0;
  double largest = 0;
  for (const StepRecord &step : s.history)
    if (step.converged) largest = std::max(largest, step.energies.largest());
  return task.step.uzawa.tolerance * largest + fem::rounding_energy(s.discretization, task.model.materials, *s.u);
}

void judge_balance(const Task &task, Solution &s)
{
  if (std::isfinite(task.steps.energy_tolerance))
    s.out_of_balance = out_of_balance(s.history, task.steps.energy_tolerance, s.energy_rounding);
}

Solution solve(const Task &task, const RCP<const Comm> &comm, const Listener &listener)
{
  return task.has_steps() ? solve_steps(task, comm, listener)
                          : solve_on(task, made_mesh(task.mesh, comm), nullptr, nullptr, listener);
}

std::optional<HistoryState> resumed(const Listener &listener, PhaseSeconds &seconds)
{
  if (!listener.resume) return std::nullopt;
  const Timed phase("mesh", seconds.mesh);
  return listener.resume();
}

bool keep_checkpoint(const HistoryState &state, const Listener &listener)
{
  if (!listener.checkpoint) return false;
  try {
    listener.checkpoint(state);
    return true;
  } catch (const Error &error) { // on all ranks
    if (listener.note)
      listener.note("no checkpoint " + at_time(state.last.time) + error.what() + "; the next step tries again");
    return false;
  }
}

std::string at_time(const double t)
{
  std::ostringstream text;
  text << "at t = " << t << ": ";
  return text.str();
}

Error error_at(const double t, const Error &error, const bool first)
{
  return first && error.code() != ExitCode::no_solution ? error : Error(error.code(), at_time(t) + error.what());
}

namespace
{

/// One of several load steps; its record is added if it converges, and is the last of the solution's history in any case.
Solution solve_one_of_steps(const Task &task, const double t, LoadHistory &history, const int assemblies_before,
                            std::vector<StepRecord> &records, const PhaseSeconds &seconds, const Listener &listener)
{
  Solution s;
  static_cast<StepSolution &>(s) = history.advance(t, listener.step);
  s.discretization = history.problem().discretization();
  s.mesh_options = task.mesh;
  s.time = history.last().time;
  s.body = history.last().body;
  s.matrix_assemblies = assemblies_before + history.problem().stiffness()->assemblies();
  s.history = records;
  s.history.push_back(history.last());
  if (s.uzawa.converged) records.push_back(history.last());
  s.seconds = seconds;
  s.seconds.prediction += s.prediction_seconds;
  s.seconds.setup += s.linear.setup_seconds;
  s.seconds.solve += s.solve_seconds;
  if (!s.has_results()) take_back_results(s);
  if (listener.solved) listener.solved(history.problem(), s);
  note_skipped(task, s);
  return s;
}

/// Has the last step that converged kept, if there is one. Collective.
/// @return whether it was
bool keep_last(const Task &task, const LoadHistory &history, const std::vector<StepRecord> &records,
               const int assemblies, const Listener &listener)
{
  if (!history.memory()) return false;
  HistoryState state{
      history.problem().discretization(), task.mesh, *history.memory(), std::nullopt, records, assemblies};
  if (history.before()) state.before = *history.before();
  return keep_checkpoint(state, listener);
}

} // namespace

Solution solve_steps(const Task &task, const RCP<const Comm> &comm, const Listener &listener)
{
  Solution s;
  PhaseSeconds seconds;
  const auto from = resumed(listener, seconds);
  const auto mesh = from ? from->discretization.mesh : make_mesh(task.mesh, comm, seconds);
  Task first = task;
  first.time = from ? from->last.time : task.steps.times.front();
  const auto problem = make_problem(first, mesh, seconds);
  LoadHistory history(problem, task.step, task.steps.max_halvings, task.linear_solver,
                      coarser_meshes(first, task.mesh, comm));
  history.balance_energies(task.steps);
  std::vector<StepRecord> records;
  double rounding = 0;
  int assemblies_before = 0;
  if (from) {
    records = from->records;
    assemblies_before = from->matrix_assemblies;
    history.go_on_from(from->last, from->before);
  }
  try {
    if (listener.mesh) listener.mesh(problem->discretization(), problem->step(first.time).contact);
  } catch (const Error &error) { // on all ranks
    throw error_at(first.time, error, true);
  }
  bool checkpoint_due = false;
  for (const double t : task.steps.times) {
    if (from && t <= from->last.time) continue;
    if (!s.history.empty() && interrupted(*comm)) { // a step that converges without iterations does not ask
      keep_last(task, history, records, s.matrix_assemblies, listener);
      s.failure = Failure{t, interruption() + " before the step", ExitCode::not_converged};
      break;
    }
    bool solved = false;
    try {
      Solution next = solve_one_of_steps(task, t, history, assemblies_before, records, seconds, listener);
      seconds = next.seconds;
      next.energy_rounding = rounding = std::max(rounding, energy_rounding(task, next));
      if (!next.has_results() && !s.history.empty()) {
        s.failure = Failure{next.time, next.uzawa.reason, ExitCode::not_converged};
        s.history = std::move(next.history);
        s.matrix_assemblies = next.matrix_assemblies;
        s.seconds = seconds;
      } else {
        s = std::move(next);
      }
      solved = true;
      if (listener.load_step && s.has_results() && !s.failure) listener.load_step(s);
    } catch (const Error &error) { // on all ranks; what the steps before have found is not lost
      const StepRecord broken = history.broken_off(one_line(error.what()));
      if (s.history.empty()) throw error_at(broken.time, error, records.empty());
      if (!solved) s.history.push_back(broken);
      s.failure = Failure{solved ? s.time : broken.time, broken.reason, error.code()};
      break;
    }
    const int every = task.steps.checkpoint_every;
    checkpoint_due |= every > 0 && records.size() % every == 0;
    if (!s.has_results() || s.failure) {
      if (interrupted(*comm)) keep_last(task, history, records, s.matrix_assemblies, listener);
      break;
    }
    if (!checkpoint_due) continue;
    checkpoint_due = !keep_last(task, history, records, s.matrix_assemblies, listener);
    if (t < task.steps.times.back()) history.start_anew();
  }
  judge_balance(task, s);
  return s;
}

Solution solve_on(const Task &task, const MadeMesh &made, const Solution *const previous, const Solution *const earlier,
                  const Listener &listener)
{
  Solution s;
  s.time = task.time;
  s.mesh_options = made.options;
  s.seconds.mesh = made.seconds;
  const RCP<const Comm> comm = made.mesh->owned_nodes->getComm();
  const auto problem = make_problem(task, made.mesh, s.seconds);
  const fem::Discretization &d = s.discretization = problem->discretization();
  Step step;
  {
    const Timed phase("assembly", s.seconds.assembly);
    step = problem->step(task.time, nullptr, nullptr, previous ? &previous->step.obstacle : nullptr);
  }
  throw_if_interrupted(*comm, "before the first solve; no results are written");
  if (listener.mesh) listener.mesh(d, step.contact);
  std::vector<contact::ContactState> starts;
  if (previous) {
    const Timed phase("prediction", s.seconds.prediction);
    const contact::ContactNodes &points = previous->step.contact;
    const auto state =
        contact::with_weightless(previous->state, points, previous->discretization,
                                 contact::contact_sides(*previous->discretization.mesh, task.model.contact));
    starts.push_back(contact::interpolated(*fem::interpolation(previous->discretization, d), points, state,
                                           step.contact, d.owned_dofs));
  }
  const auto coarser = coarser_meshes(task, made.options, comm);
  StepOptions last_resort = task.step;
  last_resort.low_penalties = true;
  if (!task.has_steps() && pressed_by_force(task.model)) {
    LoadHistory history(problem, task.step, 0, task.linear_solver, coarser);
    if (previous) history.offer(starts.front(), previous->step.obstacle);
    static_cast<StepSolution &>(s) = history.solve(task.time, last_resort, listener.step, {});
    s.body = fem::body_peaks(d, task.model.materials, *s.u);
  } else if (!task.has_steps()) {
    SolverState state(*problem, task.linear_solver);
    Starts from{starts, {}};
    if (starts.empty())
      from.predict = [&] { // the coarser scenes go before the finest one is solved
        return Predictor(coarser, task.step, task.linear_solver).predict(*problem, step, nullptr);
      };
    static_cast<StepSolution &>(s) = solve_step(*problem, step, state, last_resort, from, listener.step);
    s.body = fem::body_peaks(d, task.model.materials, *s.u);
  } else {
    LoadHistory history(problem, task.step, task.steps.max_halvings, task.linear_solver, coarser);
    history.balance_energies(task.steps);
    if (earlier)
      history.go_on_from(made.mesh == earlier->discretization.mesh
                             ? *earlier->memory
                             : interpolated(*earlier->memory, earlier->discretization, d));
    if (previous) history.offer(starts.front(), previous->step.obstacle);
    static_cast<StepSolution &>(s) = history.advance(task.time, listener.step);
    if (s.uzawa.converged) s.memory = *history.memory();
    if (earlier) s.history = earlier->history;
    s.history.push_back(history.last());
    s.body = history.last().body;
  }
  s.matrix_assemblies = problem->stiffness()->assemblies();
  if (!s.has_results()) take_back_results(s);
  if (previous) // at the points that the obstacle has where it is now
    s.start_pressure = contact::at_points(
        s.step.contact, *contact::node_columns(step.contact, starts.front().multiplier.normal, d.mesh->owned_nodes));
  if (listener.solved) listener.solved(*problem, s);
  note_skipped(task, s);
  s.seconds.prediction += s.prediction_seconds;
  s.seconds.setup = s.linear.setup_seconds;
  s.seconds.solve = s.solve_seconds;
  return s;
}

} // namespace rpc::analysis
