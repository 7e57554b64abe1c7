#pragma once

#include "rpc/contact/result.hpp"
#include "rpc/contact/support.hpp"
#include "scene.hpp"

#include <array>
#include <memory>
#include <optional>
#include <ostream>

namespace rpc
{

/// Wall-clock time of a run's phases [s].
struct PhaseSeconds {
  double mesh = 0, assembly = 0, prediction = 0, setup = 0, solve = 0, output = 0, total = 0;
};

/// What was done on a coarser mesh.
struct LevelWork {
  std::size_t dofs = 0;
  int newton_iterations = 0;
  std::vector<int> linear_iterations; ///< per solve
  int preconditioner_setups = 0;
  double seconds = 0; ///< with all coarser ones
};

/// All that a run has found.
struct Solution {
  fem::Discretization discretization;
  contact::Support support;
  RCP<Vector> u; ///< (owned dofs) [m]
  std::shared_ptr<contact::SmoothedFunctional> functional;
  contact::UzawaResult uzawa;
  contact::ContactResult contact;
  double energy = 0;                            ///< J(u) [J]
  double strain_energy = 0;                     ///< a(u, u) [J]
  std::vector<std::array<double, 3>> reactions; ///< of each Dirichlet condition on the body [N], in 2D per m
  solver::LinearSolverCounts linear;            ///< on the finest mesh
  std::vector<LevelWork> levels;                ///< coarser meshes that predicted the solution, from the coarsest
  std::vector<std::string> skipped;             ///< what the scene allowed to leave out, and why
  int matrix_assemblies = 0;
  PhaseSeconds seconds;
};

/// Mesh, assembly, Uzawa and Newton: from a scene to its solution. Collective on comm.
/// @param console  where the table of the iteration goes; a stream without a buffer prints nothing
/// @throws rpc::Error on every rank if the scene does not fit its mesh; failing to converge is in the result
Solution solve(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console);

} // namespace rpc
