// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "equilibration.hpp"
#include "rpc/analysis/run.hpp"
#include "space_cells.hpp"

#include <string>

/// The solution that the stresses in balance come from, in the plane (Input = CellInput) and in space (SpaceInput).
namespace rpc::bound
{

RCP<Vector> vector_of(const HostView<double *> &u, const RCP<const Map> &map);
HostView<double *> host_copy(const Vector &u);

/// The Galerkin solution of given tractions.                                                             doc/bounds.md (13.5)
struct Solved {
  RCP<const Vector> u;
  DeviceView<double ***> Q; ///< its nodal_forces()
  int iterations = 0;
  std::string failure;
};
template <class Input>
Solved galerkin_solution(const analysis::Problem &problem, const analysis::StepSolution &s,
                         const solver::LinearSolverOptions &options, const Input &in,
                         const BoundaryTractions &tractions);

/// Work of the known moments and of the body force with a displacement [J], in 2D per m.
template <class Input>
double work_of(const fem::Discretization &d, const DeviceView<double ***> &moments, const Input &in, const Vector &u);

} // namespace rpc::bound
