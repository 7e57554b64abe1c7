#include "solve.hpp"

#include "report.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/solver/active_set.hpp"

#include <Teuchos_Time.hpp>
#include <Teuchos_TimeMonitor.hpp>

namespace rpc
{
namespace
{

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
  Vector out_of_balance = fem::internal_forces(s.discretization, scene.materials, *s.u);
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

} // namespace

Solution solve(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console)
{
  Solution s;
  {
    const Phase phase("mesh", s.seconds.mesh);
    throw_if_interrupted(*comm, "before the mesh was made; no results are written");
    s.discretization.mesh = std::make_shared<mesh::Mesh>(mesh::make_mesh(scene.mesh, comm));
  }
  {
    const Phase phase("assembly", s.seconds.assembly);
    throw_if_interrupted(*comm, "before the assembly; no results are written");
    s.discretization = fem::discretize(s.discretization.mesh);
    fem::ElasticProblem problem = assemble(scene, s.discretization);
    auto contact = contact::contact_nodes(s.discretization, scene.contact, problem.dirichlet, scene.materials);
    s.support =
        contact::check_support(s.discretization, problem.dirichlet, *problem.applied_load, contact, scene.contact);
    s.matrix_assemblies = 1;
    s.u = rcp(new Vector(*problem.dirichlet.value, Teuchos::Copy));
    s.functional = std::make_shared<contact::SmoothedFunctional>(comm, std::move(problem), std::move(contact));
    if (s.support.by_contact_only) s.functional->hold_by_contact();
  }
  throw_if_interrupted(*comm, "before the first solve; no results are written");
  const fem::Discretization &d = s.discretization;
  ConsoleTable table(console);
  table.scene(scene, s);
  {
    const Phase phase("solve", s.seconds.solve);
    solver::LinearSolver linear(tuned(scene.linear_solver, d.mesh->element), s.functional->hessian(),
                                fem::node_coordinates(d), fem::rigid_body_modes(d));
    const auto minimize = [&](const int iteration) {
      const auto report = [&](const solver::NewtonStep &step) { table.newton(step); };
      table.next_uzawa();
      int steps = 0;
      if (iteration == 1 && scene.newton.active_set_start)
        steps = solver::find_states(*s.functional, linear, *s.u, scene.newton, report);
      auto result = solver::minimize(*s.functional, linear, s.u, scene.newton, iteration > 1, report);
      result.newton_iterations += steps;
      return result;
    };
    const auto certify = [&](const Vector &u) {
      return contact::certify(d, scene.materials, *s.functional, u,
                              [&](const Vector &residual) { return linear.inverse_energy(residual); });
    };
    s.uzawa = contact::uzawa(*s.functional, *s.u, minimize, certify, scene.uzawa,
                             [&](const contact::UzawaResult &result) { table.uzawa(result); });
    s.linear = linear.counts();
    std::vector<const mesh::Side *> sides;
    for (const auto &contact : scene.contact) sides.push_back(&d.mesh->side(contact.side, contact.path + "->Side"));
    s.contact = contact::contact_result(d, sides, *s.functional, *s.u);
    s.energy = s.functional->energy(*s.u);
    s.strain_energy = fem::strain_energy(d, scene.materials, *s.u);
    s.reactions = reactions(scene, s);
  }
  s.seconds.setup = s.linear.setup_seconds;
  s.seconds.solve -= s.seconds.setup;
  return s;
}

} // namespace rpc
