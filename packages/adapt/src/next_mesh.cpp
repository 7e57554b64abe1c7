// SPDX-License-Identifier: BSD-3-Clause
#include "next_mesh.hpp"

#include "rpc/adapt/new_sizes.hpp"
#include "rpc/adapt/rules.hpp"
#include "rpc/core/rules.hpp"
#include "size_plan.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc::adapt
{
namespace
{

/// Cells, as those of a field of sizes count.
double cells_of(const mesh::Mesh &mesh)
{
  return cells_per_cell(mesh.element) * static_cast<double>(sum_all(mesh.comm(), GO(mesh.num_owned_cells)));
}

double dofs_of(const mesh::Mesh &mesh)
{
  return static_cast<double>(mesh.dim()) * static_cast<double>(mesh.owned_nodes->getGlobalNumElements());
}

/// Unknowns as a multiple of present ones, for another estimate by the order of the elements.
double growth_for(const double reduction, const mesh::Element &element)
{
  return std::pow(reduction, double(element.dim) / element.order);
}

/// A number of which two digits are known.
long long two_digits(const double value)
{
  const double unit = std::pow(10., std::max(0., std::floor(std::log10(value)) - 1));
  return std::llround(std::round(value / unit) * unit);
}

} // namespace

/// Cells that are made for one that is planned, as the present mesh shows; after the first one, which was not planned, a guess.
/// @param cells  of the present mesh
double MeshPlanner::made_per_planned(const double cells, const int dim) const
{
  if (predicted_cells_ > 0) return cells / predicted_cells_;
  return dim == 2 && !nests(task_.mesh, task_.adapt) ? 1. : plan_rules.excess;
}

/// @param eta, target  estimates, of the present mesh and of the last one [J^(1/2)]
/// @param no_better    whether the present mesh is no better than one before
MeshPlanner::Goal MeshPlanner::goal(const double eta, const double target, const bool no_better, const int dim)
{
  const bool nested = nests(task_.mesh, task_.adapt);
  const double far = (dim == 2 ? plan_rules.aim : plan_rules.aim_in_space) * target;
  const bool is_near = eta < (dim == 2 || nested ? plan_rules.near : plan_rules.near_in_space) * far;
  const double wanted = is_near && nested ? plan_rules.aim_near_nested * target : far;
  const double meshes =
      std::ceil(std::log(eta / wanted) / std::log(double(plan_rules.greatest_reduction))); // in equal steps
  // Sizes that ask for too little leave nested cells as they are, or halve others: then they ask for more.
  if (nested)
    missed_ = no_better ? missed_ / plan_rules.aim_near_nested : missed_;
  else
    missed_ = is_near ? std::clamp(missed_ * eta / planned_, 1., double(plan_rules.greatest_correction)) : 1;
  planned_ = eta * std::pow(wanted / eta, 1 / std::max(1., meshes));
  return {planned_ / missed_, is_near ? plan_rules.growth_near : plan_rules.growth,
          std::max(1, static_cast<int>(meshes)), wanted};
}

mesh::MeshOptions MeshPlanner::options_for(const Sizes &sizes, const mesh::Mesh &mesh)
{
  const bool nested = nests(task_.mesh, task_.adapt);
  predicted_cells_ = sizes.predicted_cells;
  halved_ = halves_ && !nested && mesh.dim() == 3 && sizes.predicted_cells >= plan_rules.least_halved;
  auto options = *sized(task_.mesh, task_.adapt, sizes.field, halved_ ? 1 : 0);
  auto &gmsh = std::get<mesh::GmshOptions>(options);
  gmsh.simplices = mesh.element.shape == mesh::Shape::simplex; // all meshes of a run have cells of one shape
  if (nested) {
    if (sum_all(mesh.comm(), GO(base_ ? 1 : 0)) == 0) base_ = mesh::base_mesh(task_.mesh, mesh.comm());
    gmsh.base = base_;
  }
  return options;
}

/// Whether meshes at the limit of unknowns have come to their end: the present one is hardly better than the one before; or it is better by
/// its size alone, and the whole limit would not do.
bool MeshPlanner::nothing_gained(const double eta, const double target, const double dofs,
                                 const mesh::Element &element) const
{
  const double most = static_cast<double>(task_.adapt.max_dofs);
  if (!(planned_at_limit_ && dofs > plan_rules.share_again * plan_rules.share_of_max_dofs * most)) return false;
  const double needed = dofs * growth_for(eta / target, element);
  const double needed_before = before_.dofs * growth_for(before_.eta / target, element);
  return eta > headway_rules.falls * before_.eta ||
         (needed > most && needed > growth_for(headway_rules.falls, element) * needed_before);
}

/// The end of a message on the limit.
std::string MeshPlanner::least_estimate() const
{
  std::ostringstream text;
  text << "the least estimated error is " << least_ << ", with " << std::llround(least_dofs_) << " dofs";
  if (needed_ > static_cast<double>(task_.adapt.max_dofs))
    text << "; by the order of the elements the target takes about " << two_digits(needed_);
  text << ". Raise \"Adapt->Max Dofs\" or \"Adapt->Target Relative Error\"";
  return text.str();
}

std::string MeshPlanner::why_no_other(const mesh::Mesh &mesh) const
{
  if (!nests(task_.mesh, task_.adapt) || mesh.element.shape == mesh::Shape::simplex ||
      std::holds_alternative<mesh::BoxOptions>(task_.mesh))
    return "";
  return "only triangles and tetrahedra are halved, and the mesh has " + mesh.element.name() +
         " cells; a geometry can be meshed anew, \"Adapt->Meshes\" = gmsh. Of a file of such cells compare the "
         "results of \"Mesh->Refinements\" = 0 and 1";
}

std::optional<mesh::MeshOptions> MeshPlanner::next(const fem::Discretization &d, const ErrorEstimate &estimate,
                                                   const double energy_norm_squared, Forecast &forecast,
                                                   std::string &reason)
{
  const mesh::Mesh &mesh = *d.mesh;
  reason = why_no_other(mesh);
  if (!reason.empty()) return std::nullopt;
  const double eta = std::sqrt(estimate.total()), target = task_.adapt.target * std::sqrt(energy_norm_squared);
  const double relative = eta / std::sqrt(energy_norm_squared);
  goal_ = goal(eta, target, relative > headway_rules.falls * least_, mesh.dim());
  // Where unseen contact is most of the error, errors elsewhere are those of another solution: no cell grows for them.
  if (estimate.falls_at_once()) goal_.growth = 1;
  const double dofs = dofs_of(mesh), cells = cells_of(mesh), ratio = made_per_planned(cells, mesh.dim());
  if (!halved_) ratio_unless_halved_ = ratio;
  if (relative < least_) {
    least_ = relative;
    least_dofs_ = dofs;
    needed_ = dofs * growth_for(eta / target, mesh.element);
  }
  const double most = static_cast<double>(task_.adapt.max_dofs);
  const double share = planned_at_limit_ ? plan_rules.share_again : plan_rules.share_of_max_dofs;
  const double allowed = share * most * cells / dofs / ratio;
  const double sensible = plan_rules.greatest_excess * cells * growth_for(eta / goal_.bound, mesh.element);
  const double squared_error = goal_.bound * goal_.bound;
  Sizes sizes = new_sizes(d, estimate, {squared_error, sensible, goal_.growth});
  const bool at_limit = sizes.predicted_cells > allowed;
  if (at_limit && nothing_gained(eta, target, dofs, mesh.element)) {
    reason = "the target is not reached within \"Adapt->Max Dofs\" = " + std::to_string(task_.adapt.max_dofs) + ": " +
             least_estimate();
    return std::nullopt;
  }
  // Cells that see contact are small in few places only: the first try has one of them for each that is planned.
  if (at_limit) sizes = new_sizes(d, estimate, {squared_error, allowed, plan_rules.growth, ratio * allowed});
  before_ = planned_at_limit_ ? Before{eta, dofs} : Before{};
  planned_at_limit_ = at_limit;
  tries_ = 1;
  smallest_try_ = std::numeric_limits<double>::infinity();
  forecast.meshes = goal_.meshes;
  forecast.dofs = dofs * sizes.predicted_cells / cells * ratio;
  forecast.last_dofs = std::max(forecast.dofs, dofs * growth_for(eta / goal_.wanted, mesh.element));
  return options_for(sizes, mesh);
}

bool MeshPlanner::fits(const mesh::Mesh &mesh) const
{
  return dofs_of(mesh) <= static_cast<double>(task_.adapt.max_dofs);
}

std::optional<mesh::MeshOptions> MeshPlanner::smaller(const fem::Discretization &d, const ErrorEstimate &estimate,
                                                      const mesh::Mesh &too_large, std::string &reason)
{
  const double made = dofs_of(too_large),
               most = plan_rules.share_of_max_dofs * static_cast<double>(task_.adapt.max_dofs);
  planned_at_limit_ = true;
  if (made < headway_rules.falls * smallest_try_) {
    smallest_try_ = made;
    ++tries_;
    double allowed = predicted_cells_ * most / made;
    if (halved_ && allowed < plan_rules.least_halved) { // other meshes, which have other numbers of cells
      halves_ = false;
      allowed = most * cells_of(*d.mesh) / dofs_of(*d.mesh) / ratio_unless_halved_;
    }
    return options_for(new_sizes(d, estimate, {goal_.bound * goal_.bound, allowed, plan_rules.growth, allowed}),
                       *d.mesh);
  }
  std::ostringstream text;
  text << "no next mesh within \"Adapt->Max Dofs\" = " << task_.adapt.max_dofs << " was found in " << tries_
       << " tries, the smallest of them has " << std::llround(std::min(made, smallest_try_)) << " dofs; "
       << least_estimate();
  reason = text.str();
  return std::nullopt;
}

} // namespace rpc::adapt
