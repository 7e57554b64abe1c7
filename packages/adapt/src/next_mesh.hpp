#pragma once

#include "rpc/adapt/estimator.hpp"
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

private:
  double excess(double cells, int dim) const;

  const Task &task_;
  double planned_ = std::numeric_limits<double>::infinity();    // estimate that the present mesh was to have
  double eta_before_ = std::numeric_limits<double>::infinity(); // estimate of the mesh before the present one
  double predicted_cells_ = 0;                                  // of the present mesh; 0: it was not planned
  std::shared_ptr<const mesh::MeshData> base_;                  // of nested meshes, on rank 0; null: not made yet
};

} // namespace rpc::adapt
