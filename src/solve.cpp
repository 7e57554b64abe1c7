#include "solve.hpp"

#include "report.hpp"

#include <Teuchos_Time.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <sstream>

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

fem::ElasticProblem assemble(const Scene &scene, const fem::Discretization &d)
{
  auto dirichlet = fem::dirichlet_dofs(d, scene.dirichlet);
  const auto load = rcp(new Vector(d.owned_dofs));
  fem::add_body_force(d, scene.body_force, "Body Force", *load);
  for (const auto &traction : scene.tractions) {
    const std::string path = "Traction->" + traction.name;
    fem::add_traction(d, d.mesh->side(traction.side, path + "->Side"), traction.traction, path, *load);
  }
  return fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, scene.material), load, std::move(dirichlet));
}

} // namespace

Solution solve(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console)
{
  Solution s;
  {
    const Phase phase("mesh", s.seconds.mesh);
    s.discretization.mesh = std::make_shared<mesh::Mesh>(mesh::make_box(scene.mesh, comm));
  }
  {
    const Phase phase("assembly", s.seconds.assembly);
    s.discretization = fem::discretize(s.discretization.mesh);
    fem::ElasticProblem problem = assemble(scene, s.discretization);
    auto contact = contact::contact_nodes(s.discretization, scene.contact, problem.dirichlet);
    s.matrix_assemblies = 1;
    s.u = rcp(new Vector(*problem.dirichlet.value, Teuchos::Copy));
    s.functional = std::make_shared<contact::SmoothedFunctional>(comm, std::move(problem), std::move(contact));
  }
  const fem::Discretization &d = s.discretization;
  ConsoleTable table(console);
  table.scene(scene, s);
  {
    const Phase phase("solve", s.seconds.solve);
    solver::LinearSolver linear(scene.linear_solver, s.functional->hessian(), fem::node_coordinates(d),
                                fem::rigid_body_modes(d));
    const auto minimize = [&](const int iteration) {
      table.next_uzawa();
      return solver::minimize(*s.functional, linear, s.u, scene.newton, iteration > 1,
                              [&](const solver::NewtonStep &step) { table.newton(step); });
    };
    const double stiffness_scale = scene.material.youngs_modulus / mesh::diameter(*d.mesh);
    s.uzawa = contact::uzawa(*s.functional, *s.u, minimize, stiffness_scale, scene.uzawa,
                             [&](const contact::UzawaResult &result) { table.uzawa(result); });
    if (!s.uzawa.converged && s.uzawa.iterations == scene.uzawa.max_iterations) {
      std::ostringstream hint; // the penalty has a unit, and no default fits all
      hint << "; \"Contact->Penalty\" = " << scene.contact.penalty << " [Pa/m] is "
           << scene.contact.penalty / stiffness_scale
           << " times E/diameter of the body, where 1e3 to 1e9 usually works";
      s.uzawa.reason += hint.str();
    }
    s.linear = linear.counts();
    const mesh::Side *side = scene.contact.side.empty() ? nullptr : &d.mesh->side(scene.contact.side, "Contact->Side");
    s.contact = contact::contact_result(d, side, *s.functional, *s.u);
    s.energy = s.functional->energy(*s.u);
    s.strain_energy = fem::strain_energy(d, scene.material, *s.u);
  }
  s.seconds.setup = s.linear.setup_seconds;
  s.seconds.solve -= s.seconds.setup;
  return s;
}

} // namespace rpc
