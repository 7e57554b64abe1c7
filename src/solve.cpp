#include "solve_on.hpp"

#include "report.hpp"
#include "rpc/contact/prediction.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/solver/active_set.hpp"

#include <Teuchos_Time.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <cmath>

namespace rpc
{
namespace
{

// Below, a solution costs about as much as its prediction.
constexpr std::size_t least_nodes_predicted = 500;
// Newton steps on a coarser mesh, where the search for states ends without: with rough solves there they cost no more than a few
// elastic solves of the finer one, and what they lead to is a start in any case.
constexpr int most_steps_predicting = 30;

/// Adds the time of its scope to a phase, and to the timer tree.
class Phase
{
public:
  Phase(const std::string &name, double &seconds)
      : monitor_(*Teuchos::TimeMonitor::getNewTimer("rpc::" + name)), seconds_(seconds),
        start_(Teuchos::Time::wallTime())
  {
  }
  ~Phase() { seconds_ += Teuchos::Time::wallTime() - start_; }

private:
  Teuchos::TimeMonitor monitor_;
  double &seconds_;
  double start_;
};

/// Collective. @throws rpc::Error (bad_input) where numbers overflow, naming what they belong to
fem::ElasticProblem assemble(const Scene &scene, const fem::Discretization &d)
{
  const auto coordinates = [&d] { return fem::node_coordinates(d); };
  auto dirichlet = fem::dirichlet_dofs(d, scene.dirichlet);
  require_finite(*dirichlet.value, "the displacements that \"Dirichlet\" prescribes", coordinates);
  const auto load = rcp(new Vector(d.owned_dofs));
  fem::add_body_force(d, scene.body_force, "Body Force", *load);
  require_finite(*load, "the forces of \"Body Force\"", coordinates);
  for (const auto &traction : scene.tractions) {
    const std::string path = "Traction->" + traction.name;
    fem::add_traction(d, d.mesh->side(traction.side, path + "->Side"), traction.traction, path, *load);
    require_finite(*load, "the forces of \"" + path + "\"", coordinates);
  }
  const auto stiffness = fem::assemble_stiffness(d, scene.materials);
  require_finite(*stiffness, "the stiffness matrix, from \"Material\" and \"Mesh\"", coordinates);
  auto problem = fem::eliminate_dirichlet(d, stiffness, load, std::move(dirichlet));
  require_finite(*problem.load, "the forces of prescribed displacements", coordinates);
  return problem;
}

/// Forces with which the Dirichlet conditions hold the body.
std::vector<std::array<double, 3>> reactions(const Scene &scene, const Solution &s)
{
  const fem::ElasticProblem &problem = s.functional->problem();
  Vector out_of_balance(*s.uzawa.certificate.internal.forces, Teuchos::Copy);
  out_of_balance.update(-1., *problem.applied_load, -1.,
                        contact::contact_forces(s.discretization, s.functional->contact(), s.contact), 1.);
  return fem::reaction_forces(s.discretization, problem.dirichlet, static_cast<int>(scene.dirichlet.size()),
                              out_of_balance);
}

/// Prolongators of quadratic elements want more smoothing: 32 to 35 instead of 34 to 37 iterations on the beam (P2).
solver::LinearSolverOptions tuned(solver::LinearSolverOptions options, const mesh::Element &element)
{
  if (element.order == 2 && !options.muelu.isParameter("sa: damping factor"))
    options.muelu.set("sa: damping factor", 1.6);
  return options;
}

/// A mesh with all that is solved on it.
struct Level {
  fem::Discretization discretization;
  contact::Support support;
  RCP<Vector> u; ///< (owned dofs) [m]
  std::shared_ptr<contact::SmoothedFunctional> functional;
  std::shared_ptr<solver::LinearSolver> linear;
};

Level make_level(const Scene &scene, const mesh::MeshOptions &options, const RCP<const Comm> &comm,
                 PhaseSeconds &seconds)
{
  Level level;
  fem::Discretization &d = level.discretization;
  {
    const Phase phase("mesh", seconds.mesh);
    throw_if_interrupted(*comm, "before the mesh was made; no results are written");
    d.mesh = std::make_shared<mesh::Mesh>(mesh::make_mesh(options, comm));
  }
  const Phase phase("assembly", seconds.assembly);
  throw_if_interrupted(*comm, "before the assembly; no results are written");
  d = fem::discretize(d.mesh);
  fem::ElasticProblem problem = assemble(scene, d);
  auto contact = contact::contact_nodes(d, scene.contact, problem.dirichlet, scene.materials);
  level.support = contact::check_support(d, problem.dirichlet, *problem.applied_load, contact, scene.contact);
  level.u = rcp(new Vector(*problem.dirichlet.value, Teuchos::Copy));
  level.functional = std::make_shared<contact::SmoothedFunctional>(comm, std::move(problem), std::move(contact));
  if (level.support.by_contact_only) level.functional->hold_by_contact();
  level.linear =
      std::make_shared<solver::LinearSolver>(tuned(scene.linear_solver, d.mesh->element), level.functional->hessian(),
                                             fem::node_coordinates(d), fem::rigid_body_modes(d));
  return level;
}

/// Why no coarser mesh is to predict the solution on this one; empty if one is.
std::string no_prediction(const Scene &scene, const Level &level)
{
  const auto &contact = level.functional->contact();
  if (contact.num_total == contact.num_fixed) return "no node can touch";
  if (!scene.nested.enabled) return "switched off";
  if (level.discretization.mesh->owned_nodes->getGlobalNumElements() < least_nodes_predicted)
    return "the mesh is small";
  return "";
}

/// Starts a level from the solution on a coarser mesh, which a still coarser one predicts. Nothing is lost where that
/// fails. @return why it did not; empty if it did
std::string predict(const Scene &scene, const mesh::MeshOptions &options, const RCP<const Comm> &comm, Level &level,
                    std::vector<LevelWork> &work)
{
  std::string reason = no_prediction(scene, level);
  if (!reason.empty()) return reason;
  const auto coarse_options = mesh::coarser(options, scene.nested.coarsening);
  if (!coarse_options) return "a mesh from a file cannot be made coarser";
  try {
    const double start = Teuchos::Time::wallTime();
    PhaseSeconds seconds;
    Level coarse = make_level(scene, *coarse_options, comm, seconds);
    predict(scene, *coarse_options, comm, coarse, work);
    solver::NewtonOptions options_there = scene.newton;
    options_there.start_tolerance = scene.nested.tolerance;
    options_there.residual_tolerance = scene.nested.tolerance;
    options_there.max_iterations = std::min(options_there.max_iterations, most_steps_predicting);
    const auto silent = [](const solver::NewtonStep &) {};
    auto found = solver::find_states(*coarse.functional, *coarse.linear, *coarse.u, options_there, silent);
    if (!found.confirmed) {
      found.steps += solver::minimize(*coarse.functional, *coarse.linear, coarse.u, options_there, false, silent)
                         .newton_iterations;
      coarse.functional->update_multipliers(*coarse.u);
    }
    const auto interpolation = fem::interpolation(coarse.discretization, level.discretization);
    contact::start_from(*interpolation, *coarse.functional, coarse.functional->displacement(*coarse.u),
                        *level.functional, *level.u);
    const auto &counts = coarse.linear->counts();
    work.push_back({coarse.discretization.owned_dofs->getGlobalNumElements(), found.steps, counts.iterations,
                    counts.preconditioner_setups, Teuchos::Time::wallTime() - start});
  } catch (const Error &failure) { // an interrupt too: the finest mesh is where a run stops with what it has found
    return one_line(failure.what());
  }
  return "";
}

/// The sides that the contact nodes were made from.
std::vector<const mesh::Side *> contact_sides(const Scene &scene, const mesh::Mesh &mesh)
{
  std::vector<const mesh::Side *> sides;
  for (const auto &contact : scene.contact) sides.push_back(&mesh.side(contact.side, contact.path + "->Side"));
  return sides;
}

/// |p - q|_2 over the contact sides, by the weights of their nodes; collective. An empty q is 0.
double pressure_distance(const Comm &comm, const contact::ContactNodes &c, const DeviceView<double *> &p,
                         const DeviceView<double *> &q)
{
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::pressure_distance", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        const double difference = p(i) - (q.extent(0) > 0 ? q(i) : 0);
        if (!c.fixed(i)) part += c.weight(i) * difference * difference;
      },
      sum);
  return std::sqrt(sum_all(comm, sum));
}

/// Adds what the way through the scene did not tell by itself; collective.
void note_skipped(const Scene &scene, Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto &contact = s.functional->contact();
  const LO shapes = static_cast<LO>(s.discretization.congruent.example.extent(0));
  const auto skip = [&s](const bool skipped, const std::string &what) {
    if (skipped) s.skipped.push_back(what);
  };
  skip(scene.contact.empty(), "contact: no side may touch");
  skip(contact.num_total > contact.num_fixed && s.uzawa.iterations == 1,
       "multiplier updates: pressures of the chosen states obey the contact law");
  skip(s.linear.local_corrections > 0, "multigrid set-ups: " + std::to_string(s.linear.local_corrections) +
                                           " changes of states did with solves around the changed nodes");
  skip(min_all(mesh.comm(), shapes) > 0, "cell matrices: cells are alike, one for each shape is enough");
  skip(!scene.output.exodus, "stress recovery and nodal fields: no Exodus file");
  skip(!scene.output.csv && !scene.contact.empty(), "contact tables: no CSV file");
  skip(!scene.adapt.estimate, "error estimate: not asked for");
}

} // namespace

Solution solve_on(const Scene &scene, const mesh::MeshOptions &options, const Solution *const previous,
                  const RCP<const Comm> &comm, std::ostream &console)
{
  Solution s;
  Level level = make_level(scene, options, comm, s.seconds);
  s.matrix_assemblies = 1;
  s.discretization = level.discretization;
  s.support = level.support;
  s.u = level.u;
  s.functional = level.functional;
  throw_if_interrupted(*comm, "before the first solve; no results are written");
  const fem::Discretization &d = s.discretization;
  solver::check_nox_parameters(*level.functional, *level.linear, level.u, scene.newton);
  DeviceView<double *> start_pressure;
  ConsoleTable table(console);
  table.scene(scene, s);
  {
    const Phase phase("prediction", s.seconds.prediction);
    if (previous) {
      contact::start_from(*fem::interpolation(previous->discretization, d), *previous->functional, *previous->u,
                          *s.functional, *s.u);
      start_pressure = DeviceView<double *>("rpc::start_pressure", s.functional->contact().size());
      Kokkos::deep_copy(start_pressure, s.functional->multipliers());
    } else {
      const std::string reason = predict(scene, options, comm, level, s.levels);
      if (!reason.empty()) s.skipped.push_back("coarser meshes: " + reason);
    }
  }
  {
    const Phase phase("solve", s.seconds.solve);
    solver::LinearSolver &linear = *level.linear;
    const auto minimize = [&](const int iteration) {
      const auto report = [&](const solver::NewtonStep &step) { table.newton(step); };
      table.next_uzawa();
      solver::ActiveSetResult start;
      if (iteration == 1 && scene.newton.active_set_start)
        start = solver::find_states(*s.functional, linear, *s.u, scene.newton, report);
      if (start.confirmed) {
        s.skipped.push_back("generalized Newton with line search: the choice of states was confirmed");
        return contact::MinimizeResult{true, start.steps, "", true};
      }
      auto result = solver::minimize(*s.functional, linear, s.u, scene.newton, iteration > 1, report);
      s.line_search_steps += result.newton_iterations;
      result.newton_iterations += start.steps;
      return result;
    };
    const auto certify = [&](const Vector &u) {
      return contact::certify(d, scene.materials, *s.functional, u,
                              [&](const Vector &residual) { return linear.inverse_energy(residual); });
    };
    s.uzawa = contact::uzawa(*s.functional, *s.u, minimize, certify, scene.uzawa,
                             [&](const contact::UzawaResult &result) { table.uzawa(result); });
    s.linear = linear.counts();
    s.contact = contact::contact_result(d, contact_sides(scene, *d.mesh), *s.functional, *s.u);
    if (scene.adapt.adapts())
      s.pressure_norm = pressure_distance(*comm, s.functional->contact(), s.contact.pressure, {});
    if (previous)
      s.pressure_change = pressure_distance(*comm, s.functional->contact(), s.contact.pressure, start_pressure);
    s.energy = s.functional->energy(*s.u);
    s.strain_energy = s.uzawa.certificate.internal.strain_energy;
    s.reactions = reactions(scene, s);
  }
  if (scene.adapt.estimate) {
    const Phase phase("estimate", s.seconds.estimate);
    s.estimate = adapt::estimate_error(d, scene.materials, contact_sides(scene, *d.mesh), scene.tractions,
                                       s.functional->contact(), s.contact, *s.u);
  }
  note_skipped(scene, s);
  s.seconds.setup = s.linear.setup_seconds;
  s.seconds.solve -= s.seconds.setup;
  return s;
}

} // namespace rpc
