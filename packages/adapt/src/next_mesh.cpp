#include "next_mesh.hpp"

#include "rpc/adapt/new_sizes.hpp"
#include "size_plan.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::adapt
{
namespace
{

// A new mesh is planned for so much less than the target: predictions are right to some ten per cent.
constexpr double aim = 0.95, aim_in_space = 0.88; // another mesh costs more there
// Sizes of nested cells are a factor of 1.26 or 1.41 apart: near the target plans that ask for little change nothing in many places.
constexpr double aim_near_nested = 0.7;
// The estimate falls by no more from one mesh to the next: a coarse mesh knows little of where a fine one is to be fine.
constexpr double greatest_reduction = 4;
// Near the target the next plan makes up for the excess of the last estimate over its plan, up to a factor. Cells hardly
// grow there, so that no accuracy is lost.
constexpr double near = 2, near_in_space = 1.3, greatest_correction = 3, growth_near = 1.25, growth = 2.5;
// A mesh has no more than so many times the cells that the order of the elements asks for: where a coarse mesh asks for
// many more, its estimate is not reliable.
constexpr double greatest_excess = 1.5;
// Meshes are planned that much smaller than allowed: gmsh makes more cells or fewer than it is asked for.
constexpr double share_of_max_dofs = 0.75;
// At the limit an estimate that falls by less ends the run.
constexpr double hardly_less = 0.97;
// A mesh in space has up to so many times the cells that are expected: coarse ones cannot be as coarse as they may, for the body's edges.
constexpr double excess_in_space = 2;
// The same of nested meshes, which are no coarser than the first one and have neighbours of small cells halved.
constexpr double excess_nested = 3.2, excess_nested_in_plane = 2;
// In space gmsh makes cells of twice the size, which are halved: that takes an eighth of gmsh's time, and multigrid has a mesh more. Meshes of
// fewer cells are gmsh's: halved ones could not be as coarse. In the plane gmsh is fast enough, and finer gradings pay. doc/design.md
constexpr double least_halved = 6000;

} // namespace

/// How many times as many cells the next mesh may have as planned.
/// @param cells  of the present mesh
double MeshPlanner::excess(const double cells, const int dim) const
{
  const bool nested = nests(task_.mesh, task_.adapt);
  if (dim == 2 && !nested) return 1;
  if (predicted_cells_ > 0) return std::max(1., cells / predicted_cells_);
  if (!nested) return excess_in_space;
  return dim == 2 ? excess_nested_in_plane : excess_nested;
}

std::optional<mesh::MeshOptions> MeshPlanner::next(const fem::Discretization &d, const ErrorEstimate &estimate,
                                                   const double energy_norm_squared, Forecast &forecast,
                                                   std::string &reason)
{
  const bool nested = nests(task_.mesh, task_.adapt);
  if (nested && d.mesh->element.shape != mesh::Shape::simplex &&
      !std::holds_alternative<mesh::BoxOptions>(task_.mesh)) {
    reason = "only triangles and tetrahedra are halved, and the mesh has " + d.mesh->element.name() +
             " cells; a .geo can be meshed anew, \"Adapt->Meshes\" = gmsh";
    return std::nullopt;
  }
  const double eta = std::sqrt(estimate.total());
  const double target = task_.adapt.target * std::sqrt(energy_norm_squared);
  const double far = (d.dim() == 2 ? aim : aim_in_space) * target;
  const bool is_near = eta < (d.dim() == 2 || nested ? near : near_in_space) * far;
  const double wanted = is_near && nested ? aim_near_nested * target : far;
  const double meshes = std::ceil(std::log(eta / wanted) / std::log(greatest_reduction)); // in equal steps
  const double missed = is_near && !nested ? std::clamp(eta / planned_, 1., greatest_correction) : 1;
  planned_ = eta * std::pow(wanted / eta, 1 / std::max(1., meshes));
  const double bound = planned_ / missed;

  const double dofs = static_cast<double>(d.owned_dofs->getGlobalNumElements());
  const mesh::Mesh &mesh = *d.mesh;
  const double cells =
      cells_per_cell(mesh.element) * static_cast<double>(sum_all(mesh.comm(), GO(mesh.num_owned_cells)));
  const double most_dofs = share_of_max_dofs * static_cast<double>(task_.adapt.max_dofs);
  const double excess = this->excess(cells, mesh.dim());
  const double allowed = most_dofs * cells / dofs / excess;
  const double sensible = greatest_excess * cells * std::pow(eta / bound, double(mesh.dim()) / mesh.element.order);
  const auto sizes =
      new_sizes(d, estimate, {bound * bound, std::min(allowed, sensible), is_near ? growth_near : growth});
  const bool no_better = eta > hardly_less * eta_before_;
  eta_before_ = eta;
  const bool at_limit = dofs > 0.9 * most_dofs && sizes.predicted_cells > 0.9 * allowed;
  if (at_limit || (no_better && sizes.predicted_cells > 0.7 * allowed)) {
    reason = "a mesh for the target would exceed \"Adapt->Max Dofs\" = " + std::to_string(task_.adapt.max_dofs);
    return std::nullopt;
  }
  forecast.meshes = std::max(1, static_cast<int>(meshes));
  forecast.dofs = dofs * sizes.predicted_cells / cells * excess;
  forecast.last_dofs = std::max(forecast.dofs, dofs * std::pow(eta / wanted, double(mesh.dim()) / mesh.element.order));
  predicted_cells_ = sizes.predicted_cells;
  const bool halved = !nested && mesh.dim() == 3 && sizes.predicted_cells >= least_halved;
  auto options = sized(task_.mesh, task_.adapt, sizes.field, halved ? 1 : 0);
  if (nested) {
    if (sum_all(mesh.comm(), GO(base_ ? 1 : 0)) == 0) base_ = mesh::base_mesh(task_.mesh, mesh.comm());
    std::get<mesh::GmshOptions>(*options).base = base_;
  }
  return options;
}

} // namespace rpc::adapt
