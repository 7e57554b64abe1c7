// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/estimator.hpp"
#include "rpc/adapt/new_sizes.hpp"
#include "rpc/adapt/options.hpp"
#include "rpc/adapt/solve.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace rpc::adapt
{

/// Plans mesh after mesh, each by the estimate on the one before.
class MeshPlanner
{
public:
  /// @param first  the mesh before the next one
  MeshPlanner(const Task &task, const mesh::MeshOptions &first) : task_(task)
  {
    if (const auto *const gmsh = std::get_if<mesh::GmshOptions>(&first)) base_ = gmsh->base;
  }

  /// The mesh after that of a solution; none if there is none to be had. Collective.
  /// @param energy_norm_squared  of the solution [J], in 2D per m
  /// @param[out] forecast  of the meshes that the target takes, where there is a next one; `seconds` is left alone
  /// @param[out] reason  why there is none
  std::optional<mesh::MeshOptions> next(const fem::Discretization &d, const ErrorEstimate &estimate,
                                        double energy_norm_squared, Forecast &forecast, std::string &reason);

  /// Why no mesh can follow one, whatever its solution; empty if one may.
  std::string why_no_other(const mesh::Mesh &mesh) const;
  /// Whether a mesh has no more unknowns than any but the first may have. Collective.
  bool fits(const mesh::Mesh &mesh) const;
  /// The same mesh with larger cells, where the one that was planned last does not fit; none if it cannot be had. Collective.
  /// @param d, estimate  as next() had them
  /// @param[out] reason  why there is none
  std::optional<mesh::MeshOptions> smaller(const fem::Discretization &d, const ErrorEstimate &estimate,
                                           const mesh::Mesh &too_large, std::string &reason);

private:
  /// What the next mesh is for, as an estimate tells.
  struct Goal {
    double bound = 0;  ///< on the estimate that it is to have
    double growth = 0; ///< of cells at most, see SizeRequest
    int meshes = 0;    ///< to the target, > 0
    double wanted = 0; ///< estimate of the last of them
  };
  Goal goal(double eta, double target, bool no_better, int dim);
  double made_per_planned(double cells, int dim) const;
  mesh::MeshOptions options_for(const Sizes &sizes, const mesh::Mesh &mesh);
  bool nothing_gained(double eta, double target, double dofs, const mesh::Element &element) const;
  std::string least_estimate() const;

  const Task &task_;
  Goal goal_;         // of the mesh that was planned last
  double missed_ = 1; // the next mesh is planned for the goal over this, >= 1: what earlier ones missed of theirs
  double planned_ = std::numeric_limits<double>::infinity(); // estimate that the present mesh was to have
  double predicted_cells_ = 0;                               // of the present mesh; 0: it was not planned
  bool planned_at_limit_ = false; // the present mesh, for fewer cells than the target asked for
  /// The mesh before the present one, where that was planned at the limit too.
  struct Before {
    double eta = std::numeric_limits<double>::infinity(), dofs = 1;
  } before_;
  double least_ = std::numeric_limits<double>::infinity(), least_dofs_ = 0; // relative estimate, and on which mesh
  double needed_ = 0;                          // unknowns for the target, as that mesh tells
  int tries_ = 0;                              // meshes that were planned after the present one
  double smallest_try_ = 0;                    // unknowns of these that do not fit
  bool halved_ = false;                        // the mesh that was planned last: gmsh makes cells of twice the size
  bool halves_ = true;                         // whether that may be
  double ratio_unless_halved_ = 1;             // made_per_planned() of the last mesh that was not
  std::shared_ptr<const mesh::MeshData> base_; // of nested meshes, on rank 0; null: not made yet
};

} // namespace rpc::adapt
