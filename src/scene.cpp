// SPDX-License-Identifier: BSD-3-Clause
#include "scene.hpp"

#include "deck_notes.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/fem/rigid_side.hpp"
#include "rpc/io/deck.hpp"
#include "rpc/io/expression.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace rpc
{
namespace
{

Teuchos::ParameterList valid_output_parameters()
{
  Teuchos::ParameterList valid("Output");
  set_choice(valid, "Exodus", {"joined", "split", "none"},
             "Displacement, stresses, contact fields: `joined` writes <deck>.e (`true` means the same), `split` a file "
             "a rank of its own "
             "cells, <deck>.e.N.k for rank k of N, as `epu` and ParaView take them, `none` nothing (`false` too).");
  valid.set("Cell Stresses", false,
            "Write to the Exodus file, too, the mean of each cell's own stress, `cell_stress_xx`, ...: where blocks "
            "meet, nodes have a mean of both sides.");
  valid.set("CSV", true, "Write <deck>.contact.csv: the contact nodes along the surface.");
  valid.set("JSON", true, "Write <deck>.json: the summary.");
  valid.set("Timers", false, "Print the timer tree at the end.");
  add_points_parameters(valid);
  return valid;
}

/// Every parameter of a list with its value, defaults included.
std::string text_of(const Teuchos::ParameterList &list)
{
  std::ostringstream text;
  text.precision(17);
  for (auto it = list.begin(); it != list.end(); ++it) {
    const std::string &name = list.name(it);
    if (list.isSublist(name))
      text << name << '{' << text_of(list.sublist(name)) << '}';
    else
      text << name << '=' << Teuchos::toString(list.entry(it).getAny(false)) << ';';
  }
  return text.str();
}

/// Rigid sides are conditions as those of `Dirichlet` are, and have results by the same names.
void add_rigid_sides(analysis::Model &model, const Teuchos::ParameterList &list, const int dim,
                     const FieldParser &parse)
{
  for (const auto &rigid : fem::rigid_options(list, dim, model.kinematics, parse)) {
    for (const auto &other : model.dirichlet)
      RPC_REQUIRE(other.name != rigid.name, "deck: \"" << other.path() << "\" and \"" << rigid.path()
                                                       << "\" must have different names, for results go by them. "
                                                          "Rename one, and give it a \"Side\".");
    model.dirichlet.push_back(rigid);
  }
}

} // namespace

Teuchos::ParameterList valid_deck()
{
  Teuchos::ParameterList valid("rpc");
  valid.set("Time", 1., "t at which the scene is solved: fields may be expressions of x, y, z and t.");
  set_words(valid, "Kinematics", {"plane strain", "plane stress", "axisymmetric"},
            "What body a plane mesh is a section of: `plane strain`, a long one; `plane stress`, a thin sheet; "
            "`axisymmetric`, "
            "a body of revolution, where x is the radius and y runs along the axis. Bodies in space have no choice.");
  valid.sublist("Units") = valid_units_parameters();
  valid.sublist("Mesh") = mesh::valid_parameters();
  valid.sublist("Material") = fem::valid_material_parameters();
  valid.sublist("Dirichlet") = fem::valid_dirichlet_parameters();
  valid.sublist("Rigid") = fem::valid_rigid_parameters();
  valid.sublist("Traction") = fem::valid_traction_parameters();
  valid.sublist("Body Force") = fem::valid_body_force_parameters();
  valid.sublist("Contact") = contact::valid_contact_parameters();
  valid.sublist("Steps") = analysis::valid_steps_parameters();
  valid.sublist("Nested Iteration") = analysis::valid_prediction_parameters();
  valid.sublist("Adapt") = adapt::valid_adapt_parameters();
  valid.sublist("Goals") = bound::valid_goal_parameters();
  valid.sublist("Uzawa") = analysis::valid_uzawa_parameters();
  valid.sublist("NOX") = solver::valid_newton_parameters();
  valid.sublist("Linear Solver") = solver::valid_linear_solver_parameters();
  valid.sublist("Output") = valid_output_parameters();
  return valid;
}

Teuchos::ParameterList read_parameters(const std::string &deck_path, const std::vector<std::string> &assignments,
                                       const Comm &comm)
{
  const Teuchos::ParameterList valid = valid_deck();
  Teuchos::ParameterList deck = io::read_deck(deck_path, comm, valid);
  for (const auto &assignment : assignments) assign(deck, valid, assignment);
  validate(deck, valid);
  return deck;
}

/// What a periodic box does not go with.
void require_fit_for_periodic(const Scene &scene)
{
  const auto *const box = std::get_if<mesh::BoxOptions>(&scene.mesh);
  if (!box || !mesh::periodic(*box)) return;
  RPC_REQUIRE(
      scene.model.kinematics != fem::Kinematics::axisymmetric,
      "deck: \"Mesh->Periodic\" does not go with \"Kinematics\" = axisymmetric. Write plane strain or plane stress");
  for (const auto &side : scene.model.contact)
    RPC_REQUIRE(side.dents_move_with != contact::DentsMoveWith::foundation,
                "deck: \"" << side.path
                           << "->Dents Move With\" = foundation does not go with \"Mesh->Periodic\": dents are not "
                           << "followed across joined sides. Write body");
  for (const auto &condition : scene.model.dirichlet)
    for (int axis = 0; axis < 3 && condition.rigid; ++axis) {
      const int first = (axis + 1) % 3, second = (axis + 2) % 3, rotation = 3 + axis;
      const auto &motions = condition.rigid->motions;
      if (std::find(motions.begin(), motions.end(), rotation) == motions.end()) continue;
      const auto &turn = condition.rigid->displacement[rotation];
      RPC_REQUIRE((!box->periodic[first] && !box->periodic[second]) || (turn && turn->is_zero()),
                  "deck: \"" << condition.path() << "->" << fem::name_of_motion(rotation)
                             << "\" must be 0 with \"Mesh->Periodic\": a side that is joined to itself does not turn, "
                                "got "
                             << (turn ? turn->text : "none, which lets it turn") << ". Write 0");
    }
}

Scene read_scene(const std::string &deck_path, const std::vector<std::string> &assignments, const Comm &comm)
{
  Teuchos::ParameterList deck = read_parameters(deck_path, assignments, comm);
  RPC_REQUIRE(
      !deck.getEntry("Mesh").isDefault(),
      "deck: \"Mesh\" is missing, which gives the body its shape. Write the list \"Mesh\": of a box with Lower, "
      "Upper and Cells, of a mesh or geometry file with Type = gmsh and File");
  const FieldParser parse = io::field_parser(valid_deck());
  Scene scene;
  scene.name = std::filesystem::path(deck_path).stem().string();
  scene.mesh = mesh::mesh_options(deck.sublist("Mesh"), std::filesystem::path(deck_path).parent_path().string(), comm);
  scene.model.units = units_options(deck.sublist("Units"));
  auto *const file = std::get_if<mesh::GmshOptions>(&scene.mesh);
  if (file && !deck.sublist("Units").getEntry("Length").isDefault()) file->length_unit = scene.model.units.length;
  const int dim = mesh::dimension(scene.mesh, comm);
  scene.time = deck.get<double>("Time");
  RPC_REQUIRE(std::isfinite(scene.time), "deck: \"Time\" must be finite, got " << scene.time);
  scene.model.kinematics = fem::kinematics_option(deck.get<std::string>("Kinematics"), dim);
  scene.model.materials = fem::material_options(deck.sublist("Material"));
  scene.model.dirichlet = fem::dirichlet_options(deck.sublist("Dirichlet"), dim, parse);
  add_rigid_sides(scene.model, deck.sublist("Rigid"), dim, parse);
  scene.model.tractions = fem::traction_options(deck.sublist("Traction"), dim, parse);
  scene.model.body_force = fem::body_force_options(deck.sublist("Body Force"), dim, parse);
  const FileReader of_root = file_reader_of_root(std::filesystem::path(deck_path).parent_path().string(), comm);
  std::string files; // a run does not go on with other contents
  const FileReader read_file = [&](const std::string &name, const std::string &parameter) {
    const std::string bytes = of_root(name, parameter);
    std::uint64_t print = bytes.size();
    for (const char c : bytes) print = scrambled(print, static_cast<unsigned char>(c));
    files += parameter + "=" + std::to_string(print) + ";";
    return bytes;
  };
  scene.model.contact = contact::contact_options(deck.sublist("Contact"), dim, parse, read_file);
  scene.step.prediction = analysis::prediction_options(deck.sublist("Nested Iteration"));
  scene.identity.emplace_back("Kinematics", deck.get<std::string>("Kinematics"));
  for (const char *const part : {"Mesh", "Material", "Dirichlet", "Traction", "Body Force", "Contact"})
    scene.identity.emplace_back(part, text_of(deck.sublist(part)));
  if (deck.sublist("Rigid").numParams() > 0) scene.identity.emplace_back("Rigid", text_of(deck.sublist("Rigid")));
  if (!files.empty()) scene.identity.emplace_back("Contents of files", files);
  scene.steps = analysis::steps_options(deck.sublist("Steps"));
  RPC_REQUIRE(!scene.has_steps() || deck.getEntry("Time").isDefault(),
              "deck: \"Time\" = " << scene.time << " does not go with \"Steps\", which have times of their own");
  analysis::set_obstacle_origins(scene);
  scene.adapt = adapt::adapt_options(deck.sublist("Adapt"));
  scene.goals = bound::goal_options(deck.sublist("Goals"), dim);
  scene.step.uzawa = analysis::uzawa_options(deck.sublist("Uzawa"));
  scene.step.newton = solver::newton_options(deck.sublist("NOX"));
  scene.linear_solver = solver::linear_solver_options(deck.sublist("Linear Solver"));
  const Teuchos::ParameterList &output = deck.sublist("Output");
  const auto exodus = output.get<std::string>("Exodus");
  scene.output = {exodus != "none", output.get<bool>("CSV"), output.get<bool>("JSON"),
                  exodus == "split" ? io::ExodusFiles::split : io::ExodusFiles::joined, output.get<bool>("Timers")};
  scene.output.cell_stresses = output.get<bool>("Cell Stresses");
  RPC_REQUIRE(!scene.output.cell_stresses || scene.output.exodus,
              "deck: \"Output->Cell Stresses\" goes into the Exodus file, and \"Output->Exodus\" = none writes none. "
              "Leave one of them out.");
  scene.output.points = points_options(output.sublist("Points"), dim);
  require_fit_for_periodic(scene);
  adapt::require_adaptable(scene);
  scene.notes = notes_on_deck(deck, scene);
  return scene;
}

} // namespace rpc
