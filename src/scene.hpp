#pragma once

#include "rpc/adapt/refinement.hpp"
#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/uzawa.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "rpc/solver/linear_solver.hpp"
#include "rpc/solver/newton.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

namespace rpc
{

struct OutputOptions {
  bool exodus = true, csv = true, json = true;
  bool timers = false;
};

/// Solutions on coarser meshes to start from.
struct NestedOptions {
  bool enabled = true;
  double coarsening = 4;   ///< ratio of cell lengths from one mesh to the next, > 1
  double tolerance = 1e-4; ///< |F|_2 / |load|_2 there
};

/// A deck, read and checked: all that a run needs to know.
struct Scene {
  std::string name; ///< of the deck's file, without folder and extension
  mesh::MeshOptions mesh;
  fem::Materials materials;
  std::vector<fem::DirichletCondition> dirichlet;
  std::vector<fem::TractionLoad> tractions;
  fem::VectorField body_force;
  std::vector<contact::ContactOptions> contact; ///< one per contact side
  contact::UzawaOptions uzawa;
  NestedOptions nested;
  adapt::AdaptOptions adapt;
  solver::NewtonOptions newton;
  solver::LinearSolverOptions linear_solver;
  OutputOptions output;
};

/// Every parameter of a deck: the packages' lists put together.
Teuchos::ParameterList valid_deck();

/// Rank 0 reads the files, of which other ranks may have none; collective on comm, by default each rank for itself.
/// @param assignments  "Sublist->Parameter=value", applied on top of the deck
/// @throws rpc::Error (bad_input) on every rank on the first thing that is wrong
Scene read_scene(const std::string &deck_path, const std::vector<std::string> &assignments,
                 const Comm &comm = Teuchos::SerialComm<int>());

} // namespace rpc
