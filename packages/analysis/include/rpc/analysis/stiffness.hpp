// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/stiffness_operator.hpp"
#include "rpc/analysis/nested_mesh.hpp"
#include "rpc/analysis/problem.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/solver/mixed_form.hpp"

#include <memory>

namespace rpc::analysis
{

/// K of a body, prescribed unknowns eliminated, and what was eliminated.
struct Stiffness {
  RCP<const StiffnessOperator> rows; ///< assembled only where somebody asks for the matrix, if rows repeat
  fem::PrescribedCouplings couplings;
};

/// Where rows repeat, the finest mesh's node graph is forgotten. Collective.
/// @param prescribed  (overlap dofs) 1 where the displacement is
/// @throws rpc::Error (bad_input) where numbers overflow, (bad_mesh) for a cell with a Jacobian <= 0
Stiffness stiffness_of(const NestedMesh &mesh, const fem::Materials &materials, const DeviceView<char *> &prescribed);

/// Splits K of a nearly incompressible body of order 2 for a solver that has pressures as unknowns of their own; null for other bodies
/// and where there is no coarser mesh. doc/theory.md (4.13)
solver::MakeMixedForm mixed_form(const std::shared_ptr<const NestedMesh> &finest, const Model &model,
                                 const DeviceView<char *> &prescribed);

} // namespace rpc::analysis
