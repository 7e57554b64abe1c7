// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/stiff_dilatation.hpp"
#include "rpc/algebra/stiffness_operator.hpp"
#include "rpc/solver/mesh_levels.hpp"

#include <functional>

namespace rpc::solver
{

/// The stiffness of a nearly incompressible body in two parts, (4.13), for Mixed.
struct MixedForm {
  RCP<const StiffnessOperator> soft; ///< K_0
  MakeMeshLevels levels;             ///< of the body whose stiffness is K_0
  StiffDilatation dilatation;        ///< what K has beyond it
};

/// Of the polynomial in the matrix of alternating pressures.                                                   doc/theory.md (4.15c)
/// @param condition  that matrix's condition number, < 1e9
int degree_for_pressures(double condition);

/// Makes it when it is needed; collective.
using MakeMixedForm = std::function<MixedForm()>;

} // namespace rpc::solver
