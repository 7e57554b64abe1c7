#pragma once

#include "rpc/adapt/estimator.hpp"
#include "rpc/adapt/options.hpp"
#include "rpc/adapt/solve.hpp"

#include <limits>
#include <optional>
#include <string>

namespace rpc::adapt
{

/// Plans mesh after mesh, each by the estimate on the one before.
class MeshPlanner
{
public:
  explicit MeshPlanner(const Task &task) : task_(task) {}

  /// The mesh after that of a solution; none if there is none to be had. Collective.
  /// @param energy_norm_squared  of the solution [J], in 2D per m
  /// @param[out] forecast  of the meshes that the target takes, where there is a next one; `seconds` is left alone
  /// @param[out] reason  why there is none
  std::optional<mesh::MeshOptions> next(const fem::Discretization &d, const ErrorEstimate &estimate,
                                        double energy_norm_squared, Forecast &forecast, std::string &reason);

private:
  const Task &task_;
  double planned_ = std::numeric_limits<double>::infinity();    // estimate that the present mesh was to have
  double eta_before_ = std::numeric_limits<double>::infinity(); // estimate of the mesh before the present one
  double predicted_cells_ = 0;                                  // of the present mesh; 0: it was not planned
};

} // namespace rpc::adapt
