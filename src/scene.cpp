#include "scene.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/io/deck.hpp"
#include "rpc/io/expression.hpp"

#include <algorithm>
#include <filesystem>

namespace rpc
{
namespace
{

Teuchos::ParameterList valid_output_parameters()
{
  Teuchos::ParameterList valid("Output");
  valid.set("Exodus", true, "Write <deck>.e: displacement, stresses, contact fields.");
  valid.set("CSV", true, "Write <deck>.contact.csv: the contact nodes along the surface.");
  valid.set("JSON", true, "Write <deck>.json: the summary.");
  valid.set("Timers", false, "Print the timer tree at the end.");
  return valid;
}

Teuchos::ParameterList valid_nested_parameters()
{
  Teuchos::ParameterList valid("Nested Iteration");
  valid.set("Enabled", true,
            "Whether a solution on a coarser mesh, itself predicted by one on a still coarser mesh, is the start: for "
            "boxes and "
            ".geo files of 500 nodes and more.");
  valid.set("Coarsening", 4., "Ratio of cell lengths from one mesh to the next, in [1.5, 100].");
  valid.set("Tolerance", 1e-4, "Bound on |F|_2/|load|_2 on the coarser meshes, in (0, 1).");
  return valid;
}

NestedOptions nested_options(const Teuchos::ParameterList &list)
{
  const NestedOptions options{list.get<bool>("Enabled"), list.get<double>("Coarsening"), list.get<double>("Tolerance")};
  RPC_REQUIRE(options.coarsening >= 1.5 && options.coarsening <= 100,
              "deck: \"Nested Iteration->Coarsening\" must be in [1.5, 100], got " << options.coarsening);
  RPC_REQUIRE(options.tolerance > 0 && options.tolerance < 1,
              "deck: \"Nested Iteration->Tolerance\" must be in (0, 1), got " << options.tolerance);
  return options;
}

} // namespace

Teuchos::ParameterList valid_deck()
{
  Teuchos::ParameterList valid("rpc");
  valid.sublist("Mesh") = mesh::valid_parameters();
  valid.sublist("Material") = fem::valid_material_parameters();
  valid.sublist("Dirichlet") = fem::valid_dirichlet_parameters();
  valid.sublist("Traction") = fem::valid_traction_parameters();
  valid.sublist("Body Force") = fem::valid_body_force_parameters();
  valid.sublist("Contact") = contact::valid_contact_parameters();
  valid.sublist("Nested Iteration") = valid_nested_parameters();
  valid.sublist("Adapt") = adapt::valid_adapt_parameters();
  valid.sublist("Uzawa") = contact::valid_uzawa_parameters();
  valid.sublist("NOX") = solver::valid_newton_parameters();
  valid.sublist("Linear Solver") = solver::valid_linear_solver_parameters();
  valid.sublist("Output") = valid_output_parameters();
  return valid;
}

Scene read_scene(const std::string &deck_path, const std::vector<std::string> &assignments, const Comm &comm)
{
  const Teuchos::ParameterList valid = valid_deck();
  Teuchos::ParameterList deck = io::read_deck(deck_path, comm);
  for (const auto &assignment : assignments) assign(deck, valid, assignment);
  validate(deck, valid);

  Scene scene;
  scene.name = std::filesystem::path(deck_path).stem().string();
  scene.mesh = mesh::mesh_options(deck.sublist("Mesh"), std::filesystem::path(deck_path).parent_path().string(), comm);
  const int dim = mesh::dimension(scene.mesh);
  scene.materials = fem::material_options(deck.sublist("Material"));
  scene.dirichlet = fem::dirichlet_options(deck.sublist("Dirichlet"), dim, io::parse_field);
  scene.tractions = fem::traction_options(deck.sublist("Traction"), dim, io::parse_field);
  scene.body_force = fem::body_force_options(deck.sublist("Body Force"), dim, io::parse_field);
  scene.contact = contact::contact_options(deck.sublist("Contact"), dim, io::parse_field);
  scene.nested = nested_options(deck.sublist("Nested Iteration"));
  scene.adapt = adapt::adapt_options(deck.sublist("Adapt"));
  scene.uzawa = contact::uzawa_options(deck.sublist("Uzawa"));
  scene.newton = solver::newton_options(deck.sublist("NOX"));
  scene.newton.pressure_tolerance = std::min(scene.newton.pressure_tolerance, 10 * scene.uzawa.tolerance); // (5.15)
  scene.linear_solver = solver::linear_solver_options(deck.sublist("Linear Solver"));
  const Teuchos::ParameterList &output = deck.sublist("Output");
  scene.output = {output.get<bool>("Exodus"), output.get<bool>("CSV"), output.get<bool>("JSON"),
                  output.get<bool>("Timers")};
  RPC_REQUIRE(
      !scene.adapt.adapts() || mesh::with_sizes(scene.mesh, nullptr),
      "deck: \"Adapt->Target Relative Error\" goes with a 2D box or a .geo, which can be meshed anew; the mesh is a "
          << (dim == 3 ? "box in 3D" : ".msh"));
  return scene;
}

} // namespace rpc
