#pragma once

#include "rpc/adapt/estimator.hpp"
#include "rpc/adapt/options.hpp"

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
  /// @param[out] reason  why there is none
  std::optional<mesh::MeshOptions> next(const fem::Discretization &d, const ErrorEstimate &estimate,
                                        double energy_norm_squared, std::string &reason);

private:
  const Task &task_;
  double planned_ = std::numeric_limits<double>::infinity(); // estimate that the present mesh was to have
};

} // namespace rpc::adapt
