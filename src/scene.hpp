#pragma once

#include "rpc/adapt/refinement.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/mesh/make_mesh.hpp"

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

namespace rpc
{

struct OutputOptions {
  bool exodus = true, csv = true, json = true;
  bool timers = false;
};

/// A deck, read and checked: all that a run needs to know.
struct Scene {
  std::string name; ///< of the deck's file, without folder and extension
  mesh::MeshOptions mesh;
  double time = 1; ///< at which the scene is solved
  analysis::Model model;
  analysis::StepOptions step;
  adapt::AdaptOptions adapt;
  solver::LinearSolverOptions linear_solver;
  OutputOptions output;
};

/// Every parameter of a deck: the packages' lists put together.
Teuchos::ParameterList valid_deck();

/// @param assignments  "Sublist->Parameter=value", applied on top of the deck
/// @throws rpc::Error (bad_input) on the first thing that is wrong
Scene read_scene(const std::string &deck_path, const std::vector<std::string> &assignments);

} // namespace rpc
