#include "rpc/analysis/load_history.hpp"

#include "rpc/contact/moving_dents.hpp"
#include "rpc/contact/node_columns.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/interpolation.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace rpc::analysis
{
namespace
{

// Solves of a step for the dents that points meet where it leads them, each from the one before: the dents' slopes are small, so that
// two to four do.
constexpr int most_searches = 8;
constexpr double dents_settled = 1e-7; // of the deepest dent: changes of the dents met that call for no further solve

/// Forces on the body from all but the foundation, f_int + sum of w p nu (owned dofs, [N]): loads, and at prescribed unknowns
/// the reactions too.
Vector other_forces(const Problem &problem, const StepSolution &s)
{
  Vector force(*s.uzawa.residuals.internal.forces, Teuchos::Copy);
  force.update(-1., contact::contact_forces(problem.discretization(), s.step.contact, s.contact), 1.);
  return force;
}

/// The same of a state that is remembered, on the mesh as it is.
Vector other_forces(const Problem &problem, const contact::ContactNodes &points, const Memory &memory)
{
  const fem::Discretization &d = problem.discretization();
  Vector force(*fem::internal_work(d, problem.model().materials, *memory.displacement).forces, Teuchos::Copy);
  contact::ContactResult before;
  before.pressure = contact::at_points(points, *memory.pressure);
  force.update(-1., contact::contact_forces(d, points, before), 1.);
  return force;
}

/// (points) The gap that changes by motion alone: g, and where points move along dents that too [m].
/// @param dent  (points) that they stand on
DeviceView<double *> moving_gap(const Problem &problem, const contact::ContactNodes &points,
                                const DeviceView<double *> &dent)
{
  const contact::ContactNodes c = points;
  const DeviceView<double *> gap("rpc::analysis::moving_gap", c.size());
  Kokkos::deep_copy(gap, c.gap);
  for (int side = 0; side < c.num_sides(); ++side)
    if (problem.model().contact[side].dents_move_with == contact::DentsMoveWith::foundation)
      Kokkos::parallel_for(
          "rpc::analysis::moving_gap", Kokkos::RangePolicy<ExecutionSpace, LO>(c.first(side), c.first(side + 1)),
          KOKKOS_LAMBDA(const LO i) { gap(i) += dent(i); });
  Kokkos::fence();
  return gap;
}

/// Work that the foundation's own motion does on body and foundation, -sum of w p dg by the trapezoidal rule [J]; collective.
/// @param gap, before_pressure, before_gap  (points)
double work_of_motion(const Comm &comm, const contact::ContactNodes &contact, const contact::ContactResult &result,
                      const DeviceView<double *> &gap, const DeviceView<double *> &before_pressure,
                      const DeviceView<double *> &before_gap)
{
  const contact::ContactNodes c = contact;
  const auto p = result.pressure;
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::analysis::work_of_motion", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        part -= 0.5 * c.weight(i) * (p(i) + before_pressure(i)) * (gap(i) - before_gap(i));
      },
      sum);
  return sum_all(comm, sum);
}

/// Whether an obstacle is elsewhere at another time.
bool moves_between(const Model &model, const double t, const double other)
{
  const auto a = model.seen_at(t).contact, b = model.seen_at(other).contact;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k].obstacle.kind != contact::Obstacle::Kind::none && a[k].obstacle.point != b[k].obstacle.point) return true;
  return false;
}

/// The contact points of another time, without dents; collective.
contact::ContactNodes points_at(const Problem &problem, const double t)
{
  const Model model = problem.model().seen_at(t);
  const fem::Discretization &d = problem.discretization();
  return contact::contact_nodes(d, model.contact, fem::dirichlet_dofs(d, model.dirichlet), model.materials);
}

/// (points, dim) The normals that the points had before; their own where they were no points. Collective.
DeviceView<double **> normals_before(const contact::ContactNodes &contact, const contact::ContactNodes &before,
                                     const RCP<const Map> &owned_nodes)
{
  const contact::ContactNodes c = contact, b = before;
  const DeviceView<double **> normal("rpc::analysis::normals_before", c.size(), c.dim);
  Kokkos::deep_copy(normal, c.normal);
  const DeviceView<double *> ones("rpc::analysis::ones", b.size());
  Kokkos::deep_copy(ones, 1.);
  const auto was_point = contact::at_points(c, *contact::node_columns(b, ones, owned_nodes));
  const DeviceView<double *> component("rpc::analysis::normal_component", b.size());
  for (int k = 0; k < c.dim; ++k) {
    Kokkos::parallel_for(
        "rpc::analysis::normal_component", device_range(b.size()),
        KOKKOS_LAMBDA(const LO i) { component(i) = b.normal(i, k); });
    Kokkos::fence();
    const auto at = contact::at_points(c, *contact::node_columns(b, component, owned_nodes));
    Kokkos::parallel_for(
        "rpc::analysis::normals_before", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
          if (was_point(i) > 0) normal(i, k) = at(i);
        });
    Kokkos::fence();
  }
  return normal;
}

/// Work that the foundation does where its motion turns the normals, sum of w p u . d nu by the trapezoidal rule [J]; collective.
/// @param u, before_u      (owned dofs) [m]
/// @param before_pressure  (points)
/// @param before_normal    (points, dim)
double work_of_turning(const Comm &comm, const contact::ContactNodes &contact, const contact::ContactResult &result,
                       const Vector &u, const Vector &before_u, const DeviceView<double *> &before_pressure,
                       const DeviceView<double **> &before_normal)
{
  const contact::ContactNodes c = contact;
  const auto p = result.pressure;
  const auto x = device_read(u), y = device_read(before_u);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::analysis::work_of_turning", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        double along = 0;
        for (int k = 0; k < c.dim; ++k)
          along += (x(c.dof(i, k)) + y(c.dof(i, k))) * (c.normal(i, k) - before_normal(i, k));
        part += 0.25 * c.weight(i) * (p(i) + before_pressure(i)) * along;
      },
      sum);
  return sum_all(comm, sum);
}

/// Before the first step the body is at rest, and a foundation that overlaps it has moved in. Larger gaps did no work.
DeviceView<double *> gaps_at_rest(const contact::ContactNodes &contact)
{
  const contact::ContactNodes c = contact;
  const DeviceView<double *> gap("rpc::analysis::gaps_at_rest", c.size());
  Kokkos::parallel_for(
      "rpc::analysis::gaps_at_rest", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { gap(i) = c.gap(i) > 0 ? c.gap(i) : 0; });
  Kokkos::fence();
  return gap;
}

/// The energies after a step that began at `before`, null for the first one. (11.3)
/// @param t             of the step
/// @param force_before  see other_forces(), at `before`; null: not known
/// @param force         the same after the step
Energies energies_after(const Problem &problem, const double t, const StepSolution &s, const Memory *const before,
                        const Vector *const force_before, const Vector &force)
{
  const contact::ContactNodes &points = s.step.contact;
  const Comm &comm = problem.discretization().mesh->comm();
  Energies energies = before ? before->energies : Energies{};
  energies.strain = 0.5 * s.energy_norm_squared;
  energies.foundation = s.contact.total.foundation_energy;
  const auto &sides = problem.model().contact;
  for (std::size_t k = 0; k < sides.size(); ++k) // what denting takes comes back where dents do not stay
    (sides[k].remembers ? energies.dissipated : energies.foundation) += s.contact.sides[k].dissipated;
  Vector mean(force, Teuchos::Copy), moved(*s.u, Teuchos::Copy);
  mean.scale(0.5);
  DeviceView<double *> pressure("rpc::analysis::no_pressure", points.size()), before_gap;
  if (before) {
    const bool moves = moves_between(problem.model(), t, before->time);
    const contact::ContactNodes points_before = moves ? points_at(problem, before->time) : points;
    mean.update(0.5, force_before ? *force_before : other_forces(problem, points_before, *before), 1.);
    moved.update(-1., *before->displacement, 1.);
    pressure = contact::at_points(points, *before->pressure);
    before_gap = contact::at_points(points, *before->gap);
    if (moves)
      energies.work +=
          work_of_turning(comm, points, s.contact, *s.u, *before->displacement, pressure,
                          normals_before(points, points_before, problem.discretization().mesh->owned_nodes));
  } else {
    before_gap = gaps_at_rest(points);
  }
  energies.work += mean.dot(moved) + work_of_motion(comm, points, s.contact, moving_gap(problem, points, points.dent),
                                                    pressure, before_gap);
  return energies;
}

/// Dents of nodes that are no contact points now, since their normals miss the obstacle, stay as they are.
void keep_dents_elsewhere(const contact::ContactNodes &contact, const MultiVector &before, MultiVector &now)
{
  const contact::ContactNodes c = contact;
  MultiVector kept(before, Teuchos::Copy);
  {
    const auto to = kept.getLocalViewDevice(Tpetra::Access::ReadWrite);
    for (int side = 0; side < c.num_sides(); ++side) {
      const LO begin = c.first(side);
      Kokkos::parallel_for(
          "rpc::analysis::forget_points", device_range(c.first(side + 1) - begin),
          KOKKOS_LAMBDA(const LO i) { to(c.node(begin + i), side) = 0; });
    }
    Kokkos::fence();
  }
  now.update(1., kept, 1.);
}

/// (points) What a step has added to the dents.
DeviceView<double *> added_dents(const contact::ContactNodes &contact, const contact::ContactResult &result)
{
  const contact::ContactNodes c = contact;
  const auto dent = result.dent;
  const DeviceView<double *> added("rpc::analysis::added_dents", c.size());
  Kokkos::parallel_for(
      "rpc::analysis::added_dents", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { added(i) = dent(i) - c.dent(i); });
  Kokkos::fence();
  return added;
}

/// The dents that are to be remembered, (owned nodes; sides), from those before the step, null for none. Collective.
/// @param sides  seen at the time of the step
RCP<const MultiVector> dents_after(const Problem &problem, const std::vector<contact::ContactOptions> &sides,
                                   const contact::ContactNodes &points, const StepSolution &s,
                                   const MultiVector *const before)
{
  const fem::Discretization &d = problem.discretization();
  const auto owned_nodes = d.mesh->owned_nodes;
  const auto dents = contact::node_columns(points, s.contact.dent, owned_nodes);
  for (std::size_t k = 0; k < sides.size(); ++k)
    if (!sides[k].remembers) dents->getVectorNonConst(k)->putScalar(0);
  if (before) keep_dents_elsewhere(points, *before, *dents);
  if (!contact::any_moves_with_foundation(sides)) return dents;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (sides[k].dents_move_with != contact::DentsMoveWith::foundation) continue;
    const auto column = dents->getVectorNonConst(k);
    column->putScalar(0);
    if (before) column->update(1., *before->getVector(k), 0.);
  }
  const auto added = contact::node_columns(points, added_dents(points, s.contact), owned_nodes);
  contact::add_where_they_lie(d, sides, *added, *s.u, *dents);
  return dents;
}

/// Where a step is expected to lead from a displacement: along with the mean change of what is prescribed. Collective.
/// @param u  (owned dofs) [m]
Vector moved_along(const Problem &problem, const double t, const Vector &u)
{
  const fem::Discretization &d = problem.discretization();
  const int dim = d.dim();
  const auto dirichlet = fem::dirichlet_dofs(d, problem.model().seen_at(t).dirichlet);
  Vector moved(u, Teuchos::Copy);
  std::vector<double> sums(6, 0.); // of the changes and their numbers, by component
  {
    const auto condition = to_host(dirichlet.condition);
    const auto from = u.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto to = dirichlet.value->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < condition.extent(0); ++i) {
      if (condition(i) < 0) continue;
      const int c = component_of(dim, static_cast<LO>(i));
      sums[c] += to(i, 0) - from(i, 0);
      ++sums[3 + c];
    }
  }
  sums = summed(d.mesh->comm(), sums);
  const auto to = moved.getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t i = 0; i < to.extent(0); ++i) {
    const int c = component_of(dim, static_cast<LO>(i));
    if (sums[3 + c] > 0) to(i, 0) += sums[c] / sums[3 + c];
  }
  return moved;
}

/// Whether dents that points meet have changed by no more than what calls for no further solve. Collective.
bool settled(const MultiVector &used, const MultiVector &met, const MultiVector &dents)
{
  MultiVector change(met, Teuchos::Copy);
  change.update(-1., used, 1.);
  for (std::size_t k = 0; k < dents.getNumVectors(); ++k)
    if (change.getVector(k)->normInf() > dents_settled * dents.getVector(k)->normInf()) return false;
  return true;
}

/// Means of the prescribed displacements over the nodes of each Dirichlet condition; 0 for components that are free.
std::vector<std::array<double, 3>> prescribed_means(const Problem &problem, const StepSolution &s)
{
  const fem::Discretization &d = problem.discretization();
  const fem::DirichletDofs &dirichlet = s.step.elastic.dirichlet;
  const int conditions = static_cast<int>(problem.model().dirichlet.size());
  Vector ones(d.owned_dofs);
  ones.putScalar(1);
  auto means = fem::reaction_forces(d, dirichlet, conditions, *s.u);
  const auto numbers = fem::reaction_forces(d, dirichlet, conditions, ones);
  for (int k = 0; k < conditions; ++k)
    for (int c = 0; c < 3; ++c) means[k][c] = numbers[k][c] > 0 ? means[k][c] / numbers[k][c] : 0;
  return means;
}

contact::ContactState state_of(const contact::ContactNodes &points, const Vector &u, const MultiVector &pressure)
{
  return {rcp(new Vector(u, Teuchos::Copy)), contact::at_points(points, pressure), {}};
}

/// The start for what is little beside the step before: from there, its rounding would be in the way.
contact::ContactState at_rest(const contact::ContactNodes &points, const fem::Discretization &d)
{
  return {rcp(new Vector(d.owned_dofs)), DeviceView<double *>("rpc::analysis::no_pressure", points.size()), {}};
}

/// Where the last two steps lead by the time of the next one.
contact::ContactState extrapolated(const Step &step, const Memory &before, const Memory &last)
{
  const double ratio = (step.time - last.time) / (last.time - before.time);
  Vector u(*last.displacement, Teuchos::Copy);
  MultiVector pressure(*last.pressure, Teuchos::Copy);
  u.update(-ratio, *before.displacement, 1 + ratio);
  pressure.update(-ratio, *before.pressure, 1 + ratio);
  return state_of(step.contact, u, pressure);
}

int newton_steps(const StepSolution &s)
{
  return std::accumulate(s.uzawa.newton_iterations.begin(), s.uzawa.newton_iterations.end(), 0);
}

/// Adds what solving a part of a step took.
void add_work(const StepSolution &s, StepRecord &record)
{
  record.newton_iterations += newton_steps(s);
  record.linear_solves += static_cast<int>(s.linear.iterations.size());
  record.linear_iterations =
      std::accumulate(s.linear.iterations.begin(), s.linear.iterations.end(), record.linear_iterations);
  record.preconditioner_setups += s.linear.preconditioner_setups;
}

} // namespace

Teuchos::ParameterList valid_steps_parameters()
{
  Teuchos::ParameterList valid("Steps");
  valid.set(
      "Times", Teuchos::Array<double>(),
      "Times t of the load steps, rising: the foundation keeps the dents of each for the next. Empty: one step, at "
      "`Time`.");
  valid.set("Write Every", 1, "Every N-th of the times goes into the Exodus file, and the last one; N > 0.");
  valid.set("Max Halvings", 6, "A step that does not converge is halved, and its halves, so many times at most, >= 0.");
  valid.set("Checkpoint Every", 0,
            "After every N-th step a checkpoint is written, <deck>.checkpoint-NUMBER.e, from which --restart goes on; "
            "0: none.");
  return valid;
}

StepsOptions steps_options(const Teuchos::ParameterList &list)
{
  const auto &times = list.get<Teuchos::Array<double>>("Times");
  StepsOptions options{{times.begin(), times.end()},
                       list.get<int>("Write Every"),
                       list.get<int>("Max Halvings"),
                       list.get<int>("Checkpoint Every")};
  for (std::size_t k = 0; k < options.times.size(); ++k) {
    RPC_REQUIRE(std::isfinite(options.times[k]), "deck: \"Steps->Times\" must be finite, got " << options.times[k]);
    RPC_REQUIRE(k == 0 || options.times[k] > options.times[k - 1],
                "deck: \"Steps->Times\" must rise, got " << options.times[k] << " after " << options.times[k - 1]);
  }
  RPC_REQUIRE(options.write_every > 0, "deck: \"Steps->Write Every\" must be > 0, got " << options.write_every);
  RPC_REQUIRE(options.max_halvings >= 0 && options.max_halvings <= 30,
              "deck: \"Steps->Max Halvings\" must be in [0, 30], got " << options.max_halvings);
  RPC_REQUIRE(options.checkpoint_every >= 0,
              "deck: \"Steps->Checkpoint Every\" must be >= 0, got " << options.checkpoint_every);
  return options;
}

LoadHistory::LoadHistory(std::shared_ptr<const Problem> problem, StepOptions options, const int max_halvings,
                         CoarserProblem coarser)
    : problem_(std::move(problem)), options_(std::move(options)), max_halvings_(max_halvings),
      coarser_(std::move(coarser))
{
}

void LoadHistory::go_on_from(Memory memory, std::optional<Memory> before)
{
  memory_ = std::move(memory);
  before_ = std::move(before);
  last_forces_ = Teuchos::null;
}

void LoadHistory::start_anew()
{
  last_forces_ = Teuchos::null;
  on_coarser_mesh_.reset();
  assembled_before_ += problem_->stiffness().has_matrix();
  problem_ = problem_->remade(memory_ ? memory_->time : last_.time);
}

StepSolution LoadHistory::advance(const double t, const Progress &progress,
                                  const std::function<void(const Problem &, const Step &)> &now)
{
  const double start = Teuchos::Time::wallTime();
  last_ = {};
  last_.time = t;
  last_.parts = 0; // counted as they are solved
  StepSolution s = advance_in_parts(t, max_halvings_, progress, now);
  last_.converged = s.uzawa.converged;
  last_.contact = s.contact.total;
  last_.displacements = prescribed_means(*problem_, s);
  last_.reactions = s.reactions;
  if (memory_) last_.energies = memory_->energies;
  last_.seconds = Teuchos::Time::wallTime() - start;
  return s;
}

StepSolution LoadHistory::advance_in_parts(const double t, const int halvings, const Progress &progress,
                                           const std::function<void(const Problem &, const Step &)> &now)
{
  StepSolution s = solve(t, progress, now);
  if (s.uzawa.converged || halvings == 0 || interrupted(problem_->discretization().mesh->comm())) return s;
  const double from = memory_ ? memory_->time : 0; // the body is at rest at t = 0
  const double half = 0.5 * (from + t);
  if (!(half > from && half < t)) return s;
  s = advance_in_parts(half, halvings - 1, progress, now);
  return s.uzawa.converged ? advance_in_parts(t, halvings - 1, progress, now) : s;
}

StepSolution LoadHistory::solve(const double t, const Progress &progress,
                                const std::function<void(const Problem &, const Step &)> &now)
{
  const auto sides = problem_->model().seen_at(t).contact;
  const bool on_foundation = memory_ && contact::any_moves_with_foundation(sides);
  const auto met_at = [&](const Vector &u) {
    return contact::dents_met(problem_->discretization(), sides, memory_->dent, u);
  };
  RCP<const MultiVector> met = memory_ ? memory_->dent : Teuchos::null;
  if (on_foundation) met = met_at(moved_along(*problem_, t, *memory_->displacement));
  Step step = problem_->step(t, met.get());
  if (now) now(*problem_, step);
  Starts starts{std::exchange(offered_, {}), {}};
  if (memory_) {
    starts.states.push_back(state_of(step.contact, *memory_->displacement, *memory_->pressure));
    if (before_ && before_->time < memory_->time) starts.states.push_back(extrapolated(step, *before_, *memory_));
    starts.states.push_back(at_rest(step.contact, problem_->discretization()));
    starts.predicted = [&](std::vector<LevelWork> &work) { return predicted(step, work); };
  }
  ++last_.parts;
  StepSolution s;
  for (int search = 1;; ++search) {
    s = solve_step(*problem_, step, options_, starts, coarser_, progress);
    ++last_.solves;
    add_work(s, last_);
    if (!s.uzawa.converged) return s;
    if (!on_foundation || search == most_searches) break;
    const auto next = met_at(*s.u);
    if (settled(*met, *next, *memory_->dent)) break;
    met = next;
    step = problem_->step(t, met.get());
    starts = {{s.state}, {}};
  }
  const auto dents = dents_after(*problem_, sides, step.contact, s, memory_ ? memory_->dent.get() : nullptr);
  contact::take_dents_of_foundation(problem_->discretization(), sides, *dents, s.contact);
  const auto owned_nodes = problem_->discretization().mesh->owned_nodes;
  const auto forces = rcp(new Vector(other_forces(*problem_, s)));
  before_ = std::exchange(memory_, std::nullopt);
  memory_ =
      Memory{t,
             rcp(new Vector(*s.u, Teuchos::Copy)),
             contact::node_columns(step.contact, s.contact.pressure, owned_nodes),
             dents,
             contact::node_columns(step.contact, moving_gap(*problem_, step.contact, s.contact.dent), owned_nodes),
             energies_after(*problem_, t, s, before_ ? &*before_ : nullptr, last_forces_.get(), *forces)};
  last_forces_ = forces;
  return s;
}

/// A history on a coarser mesh, with the interpolations between the meshes.
struct LoadHistory::Coarser {
  LoadHistory history;
  RCP<const CrsMatrix> to_coarse, to_fine;
};

std::optional<contact::ContactState> LoadHistory::predicted(const Step &step, std::vector<LevelWork> &work)
{
  const fem::Discretization &fine = problem_->discretization();
  if (!coarser_ || !no_prediction(fine, step.contact, options_.prediction).empty()) return std::nullopt;
  const double start = Teuchos::Time::wallTime();
  try {
    if (!on_coarser_mesh_) {
      const auto problem = coarser_(*problem_, 1);
      if (!problem) return std::nullopt;
      StepOptions rough = options_;
      rough.newton.residual_tolerance = rough.uzawa.tolerance = options_.prediction.tolerance;
      const auto coarser = [next = coarser_](const Problem &finer, const int level) { return next(finer, level + 1); };
      on_coarser_mesh_.reset(new Coarser{LoadHistory(problem, rough, 0, coarser),
                                         fem::interpolation(fine, problem->discretization()),
                                         fem::interpolation(problem->discretization(), fine)});
    }
    auto &[history, to_coarse, to_fine] = *on_coarser_mesh_;
    if (!history.memory() || history.memory()->time != memory_->time) { // brings it to where this one is
      const fem::Discretization &coarse = history.problem().discretization();
      history.go_on_from(interpolated(*memory_, *to_coarse, coarse));
      if (!history.solve(memory_->time, {}, {}).uzawa.converged) return std::nullopt;
    }
    const Memory before = *history.memory();
    StepSolution coarse = history.solve(step.time, {}, {});
    if (!coarse.uzawa.converged) return std::nullopt;
    work = std::move(coarse.levels);
    work.push_back({coarse.u->getGlobalLength(), newton_steps(coarse), coarse.linear.iterations,
                    coarse.linear.preconditioner_setups, Teuchos::Time::wallTime() - start});
    Memory change = *history.memory();
    const auto difference = [](const auto &now, const auto &then) {
      const auto result = rcp(new std::decay_t<decltype(now)>(now, Teuchos::Copy));
      result->update(-1., then, 1.);
      return result;
    };
    const auto u = fem::interpolated(*to_fine, *difference(*change.displacement, *before.displacement), fine.dim(),
                                     fine.owned_dofs);
    u->update(1., *memory_->displacement, 1.);
    MultiVector pressure(*memory_->pressure, Teuchos::Copy);
    to_fine->apply(*difference(*change.pressure, *before.pressure), pressure, Teuchos::NO_TRANS, 1., 1.);
    return state_of(step.contact, *u, pressure);
  } catch (const Error &) { // an interrupt too: this mesh is where a run stops
    on_coarser_mesh_.reset();
    return std::nullopt;
  }
}

Memory interpolated(const Memory &memory, const fem::Discretization &from, const fem::Discretization &to)
{
  return interpolated(memory, *fem::interpolation(from, to), to);
}

Memory interpolated(const Memory &memory, const CrsMatrix &interpolation, const fem::Discretization &to)
{
  const auto columns = [&](const MultiVector &values) {
    const auto result = rcp(new MultiVector(interpolation.getRangeMap(), values.getNumVectors()));
    if (values.getNumVectors() > 0) interpolation.apply(values, *result);
    return result;
  };
  const auto not_below_zero = [](const RCP<MultiVector> &values) { // quadratic interpolants dip
    const auto view = values->getLocalViewDevice(Tpetra::Access::ReadWrite);
    const LO n = static_cast<LO>(view.extent(0)), sides = static_cast<LO>(view.extent(1));
    Kokkos::parallel_for(
        "rpc::analysis::not_below_zero", device_range(n), KOKKOS_LAMBDA(const LO node) {
          for (LO k = 0; k < sides; ++k)
            if (view(node, k) < 0) view(node, k) = 0;
        });
    Kokkos::fence();
    return values;
  };
  Memory result = memory;
  result.displacement = fem::interpolated(interpolation, *memory.displacement, to.dim(), to.owned_dofs);
  result.pressure = not_below_zero(columns(*memory.pressure));
  result.dent = not_below_zero(columns(*memory.dent));
  result.gap = columns(*memory.gap);
  return result;
}

} // namespace rpc::analysis
