// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/run.hpp"
#include "rpc/bound/goals.hpp"

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace rpc::adapt
{

/// Who makes the meshes after the first one.
enum class NextMeshes {
  automatic, ///< nested for a .msh and without gmsh, else gmsh
  gmsh,      ///< anew, by a field of sizes
  nested     ///< cells of the first one are halved where a field of sizes asks for it
};

/// What is said of the error of the energy and of the displacement.
enum class ErrorBound {
  none,
  estimated, ///< by the recovered stress: an estimate, which may be too small
  guaranteed ///< by stresses in equilibrium, where that is built; doc/bounds.md
};

struct AdaptOptions {
  double target = 0;       ///< of the relative error in the energy norm, in (0, 1); 0: one mesh, as it is given
  long long max_dofs = 0;  ///< of any mesh but the first, > 0
  int max_cycles = 0;      ///< meshes, > 0
  double exact_energy = 0; ///< J of the exact solution [J], in 2D per m; NaN: unknown
  bool estimate = false;   ///< whether the error is estimated; adapting implies it
  ErrorBound bound = ErrorBound::none;
  bool write_all = false; ///< results of every mesh, not of the last only
  NextMeshes meshes = NextMeshes::automatic;

  bool adapts() const { return target > 0; }
};

/// Parameters of the deck's `Adapt` sublist.
Teuchos::ParameterList valid_adapt_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
AdaptOptions adapt_options(const Teuchos::ParameterList &list);

/// Whether cells of the first mesh are halved, rather than gmsh asked for another mesh.
bool nests(const mesh::MeshOptions &first, const AdaptOptions &adapt);

/// The options of the first mesh with a field of sizes; none if gmsh is to mesh a .msh anew.
/// @param sizes        see mesh::with_sizes()
/// @param refinements  of gmsh's meshes; nested ones keep those of the first mesh
std::optional<mesh::MeshOptions> sized(const mesh::MeshOptions &first, const AdaptOptions &adapt,
                                       std::shared_ptr<const mesh::SizeField> sizes, int refinements);

/// What is to be solved, on meshes that are adapted where that is asked for.
struct Task : analysis::Task {
  AdaptOptions adapt;
  std::vector<bound::Goal> goals; ///< to be told with the guaranteed bound
};

/// @throws rpc::Error (bad_input) unless the task's mesh can be adapted, and its error be bounded, where that is asked for
void require_adaptable(const Task &task);

} // namespace rpc::adapt
