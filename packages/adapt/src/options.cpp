// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/options.hpp"

#include "rpc/bound/bound.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"
#include "rpc/mesh/box.hpp"
#include "rpc/mesh/has_gmsh.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace rpc::adapt
{
namespace
{

std::string percent_remedy(const double target)
{
  if (!(target >= 1 && target < 100)) return "";
  return ". Write " + number_text(target / 100) + " for " + number_text(target) + " %";
}

} // namespace

Teuchos::ParameterList valid_adapt_parameters()
{
  Teuchos::ParameterList valid("Adapt");
  valid.set(
      "Target Relative Error", 0.,
      "Bound on the estimated error in the energy norm over that of the solution, in (0, 1): meshes are refined where "
      "the error is until it holds. 0: one mesh, as \"Mesh\" gives it.");
  valid.set("Max Dofs", 2000000, "Unknowns that no mesh but the first is to exceed, > 0.");
  set_words(valid, "Meshes", {"automatic", "gmsh", "nested"},
            "Who makes the meshes after the first one: `gmsh`, anew; `nested`: cells of the first one are halved, each "
            "rank its own, to triangles or tetrahedra whose coarser meshes are multigrid's. `automatic`: nested for "
            "a .msh, which gmsh cannot mesh anew, and of an rpc that was built without gmsh; else gmsh.");
  valid.set("Max Cycles", 12, "Meshes, > 0.");
  valid.set("Estimate Error", false, "Estimate the error without refining; with a target that is done anyway.");
  set_words(
      valid, "Error Bound", {"none", "estimated", "guaranteed"},
      "An interval for the energy, and a bound of the error in the energy norm: `estimated` by the recovered stress, "
      "which may be too small, or `guaranteed`. Guaranteed are bodies that displacements hold, in the plane and of "
      "revolution of triangles or parallelograms on straight contact sides, in space of tetrahedra, or hexahedra of "
      "order 1, on flat ones; for other decks it is refused. It takes about as long as three runs without contact, in "
      "space as ten.");
  valid.set("Exact Energy", std::numeric_limits<double>::quiet_NaN(),
            "J of the exact solution [J], in 2D per m, to compare the estimate with; nan, which is to leave it out: "
            "unknown.");
  valid.set("Write All", false, "Write the results of each mesh, as <deck>.cycle<k>, besides those of the last.");
  return valid;
}

AdaptOptions adapt_options(const Teuchos::ParameterList &list)
{
  AdaptOptions options;
  options.target = list.get<double>("Target Relative Error");
  options.max_dofs = list.get<int>("Max Dofs");
  options.max_cycles = list.get<int>("Max Cycles");
  options.exact_energy = list.get<double>("Exact Energy");
  options.estimate = list.get<bool>("Estimate Error") || options.adapts();
  const auto &bound = list.get<std::string>("Error Bound");
  RPC_REQUIRE(bound == "none" || bound == "estimated" || bound == "guaranteed",
              "deck: \"Adapt->Error Bound\" must be one of none, estimated, guaranteed, got \"" << bound << "\"");
  options.bound = bound == "estimated"    ? ErrorBound::estimated
                  : bound == "guaranteed" ? ErrorBound::guaranteed
                                          : ErrorBound::none;
  options.estimate = options.estimate || options.bound == ErrorBound::estimated;
  options.write_all = list.get<bool>("Write All");
  const auto &meshes = list.get<std::string>("Meshes");
  RPC_REQUIRE(meshes == "automatic" || meshes == "gmsh" || meshes == "nested",
              "deck: \"Adapt->Meshes\" must be one of automatic, gmsh, nested, got \"" << meshes << "\"");
  options.meshes = meshes == "gmsh"     ? NextMeshes::gmsh
                   : meshes == "nested" ? NextMeshes::nested
                                        : NextMeshes::automatic;
  RPC_REQUIRE(options.target >= 0 && options.target < 1,
              "deck: \"Adapt->Target Relative Error\" must be in (0, 1), or 0 for none, got "
                  << options.target << percent_remedy(options.target));
  RPC_REQUIRE(options.max_dofs > 0, "deck: \"Adapt->Max Dofs\" must be > 0, got " << options.max_dofs);
  RPC_REQUIRE(options.max_cycles > 0, "deck: \"Adapt->Max Cycles\" must be > 0, got " << options.max_cycles);
  RPC_REQUIRE(!std::isinf(options.exact_energy),
              "deck: \"Adapt->Exact Energy\" must be finite, or nan where it is unknown, got " << options.exact_energy);
  return options;
}

bool nests(const mesh::MeshOptions &first, const AdaptOptions &adapt)
{
  if (adapt.meshes != NextMeshes::automatic) return adapt.meshes == NextMeshes::nested;
  return !mesh::has_gmsh() || !mesh::with_sizes(first, nullptr);
}

std::optional<mesh::MeshOptions> sized(const mesh::MeshOptions &first, const AdaptOptions &adapt,
                                       std::shared_ptr<const mesh::SizeField> sizes, const int refinements)
{
  if (nests(first, adapt)) return mesh::refined_to_sizes(first, std::move(sizes));
  return mesh::with_sizes(first, std::move(sizes), refinements);
}

void require_adaptable(const Task &task)
{
  RPC_REQUIRE(
      !task.adapt.adapts() || nests(task.mesh, task.adapt) || mesh::has_gmsh(),
      "deck: \"Adapt->Meshes\" = gmsh needs gmsh, and this rpc was built without it. Write nested, or automatic.");
  RPC_REQUIRE(
      !task.adapt.adapts() || sized(task.mesh, task.adapt, nullptr, 0),
      "deck: \"Adapt->Meshes\" = gmsh goes with a box or a geometry, which can be meshed anew; the mesh is a file "
      "of cells. Its cells can be halved: nested, if they are triangles or tetrahedra.");
  const bool bounded = task.adapt.bound == ErrorBound::guaranteed, errors = task.adapt.estimate || bounded;
  const auto *const box = std::get_if<mesh::BoxOptions>(&task.mesh);
  RPC_REQUIRE(!errors || !box || !mesh::periodic(*box), "deck: \"Adapt\" does not go with \"Mesh->Periodic\": errors "
                                                        "are not estimated across joined sides, and adapted meshes "
                                                        "have none. Leave \"Adapt\" out.");
  const auto &contact = task.model.contact;
  for (std::size_t a = 0; a < contact.size() && errors; ++a)
    for (std::size_t b = 0; b < a; ++b)
      RPC_REQUIRE(contact[a].side != contact[b].side,
                  "deck: \"Adapt\" does not go with several foundations of one side, \""
                      << contact[b].path << "\" and \"" << contact[a].path
                      << "\": their errors are not estimated yet. Leave \"Adapt\" out.");
  RPC_REQUIRE(bounded || task.goals.empty(), "deck: \"" << task.goals.front().path()
                                                        << "\" asks for a guaranteed interval. Write "
                                                           "\"Adapt->Error Bound\" = guaranteed");
  if (!bounded) return;
  bound::require_covered(task, task.goals);
  RPC_REQUIRE(!task.adapt.adapts() || nests(task.mesh, task.adapt) || !box ||
                  box->element.shape == mesh::Shape::simplex,
              "deck: \"Adapt->Error Bound\" = guaranteed covers parallelograms, and the quadrilaterals that gmsh makes "
              "for the next mesh are none. Write \"Mesh->Element\" = P"
                  << box->element.order << ", or \"Adapt->Meshes\" = nested");
}

} // namespace rpc::adapt
