// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/run.hpp"

#include "body/obstacle_force.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/analysis/run_steps.hpp"
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

/// What follows a solve: the time that it took, what `solved` adds, and what was skipped.
void finish(const Task &task, const Problem &problem, const Listener &listener, Solution &s)
{
  s.seconds.prediction += s.prediction_seconds;
  s.seconds.setup += s.linear.setup_seconds;
  s.seconds.solve += s.solve_seconds;
  if (!s.has_results()) take_back_results(s);
  if (listener.solved) listener.solved(problem, s);
  note_skipped(task, s);
}

/// Load steps on one mesh, for run_steps().
class StepsOnMesh
{
public:
  /// @param from  none: at rest
  StepsOnMesh(const Task &task, LoadHistory &history, std::optional<HistoryState> from, const Listener &listener)
      : task_(task), history_(history), listener_(listener)
  {
    history_.balance_energies(task_.steps);
    if (!from) return;
    records_ = std::move(from->records);
    assemblies_before_ = from->matrix_assemblies;
    history_.go_on_from(std::move(from->last), std::move(from->before));
  }

  Solution solve(const double t, const Solution *)
  {
    Solution s;
    static_cast<StepSolution &>(s) = history_.advance(t, listener_.step);
    s.discretization = history_.problem().discretization();
    s.mesh_options = task_.mesh;
    s.time = history_.last().time;
    s.body = history_.last().body;
    s.matrix_assemblies = assemblies();
    s.history = records_;
    s.history.push_back(history_.last());
    if (s.uzawa.converged) records_.push_back(history_.last());
    finish(task_, history_.problem(), listener_, s);
    return s;
  }

  StepRecord broken_off(double, const std::string &reason) const { return history_.broken_off(reason); }
  static bool succeeded(const Solution &s) { return s.has_results(); }

  bool keep() const
  {
    if (!history_.memory()) return false;
    HistoryState state{history_.problem().discretization(), task_.mesh, *history_.memory(), {}, records_, assemblies()};
    if (history_.before()) state.before = *history_.before();
    return keep_checkpoint(state, listener_);
  }

  void start_anew() { history_.start_anew(); }

private:
  int assemblies() const { return assemblies_before_ + history_.problem().stiffness()->assemblies(); }

  const Task &task_;
  LoadHistory &history_;
  const Listener &listener_;
  std::vector<StepRecord> records_; // of steps that have converged
  int assemblies_before_ = 0;
};

} // namespace

Solution solve_steps(const Task &task, const RCP<const Comm> &comm, const Listener &listener)
{
  PhaseSeconds seconds;
  auto from = resumed(listener, seconds);
  const auto mesh = from ? from->discretization.mesh : make_mesh(task.mesh, comm, seconds);
  const double after = from ? from->last.time : no_step_before();
  Task first = task;
  first.time = from ? after : task.steps.times.front();
  const auto problem = make_problem(first, mesh, seconds);
  LoadHistory history(problem, task.step, task.steps.max_halvings, task.linear_solver,
                      coarser_meshes(first, task.mesh, comm));
  StepsOnMesh steps(task, history, std::move(from), listener);
  try {
    if (listener.mesh) listener.mesh(problem->discretization(), problem->step(first.time).contact);
  } catch (const Error &error) { // on all ranks
    throw error_at(first.time, error, true);
  }
  return run_steps<Solution>(task, after, *comm, listener, seconds, steps).value_or(Solution{});
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
  if (previous) // at the points that the obstacle has where it is now
    s.start_pressure = contact::at_points(
        s.step.contact, *contact::node_columns(step.contact, starts.front().multiplier.normal, d.mesh->owned_nodes));
  finish(task, *problem, listener, s);
  return s;
}

} // namespace rpc::analysis
