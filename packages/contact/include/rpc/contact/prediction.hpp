#pragma once

#include "rpc/contact/smoothed_functional.hpp"

namespace rpc::contact
{

/// Starts a problem from the solution of the same one on a coarser mesh: displacement and multipliers by interpolation,
/// side by side; what is prescribed stays as it is. Collective.
/// @param interpolation  (fine owned nodes x coarse owned nodes), see fem::interpolation()
/// @param coarse_u       (coarse owned dofs) [m], displacement from 0
/// @param[in,out] u      (fine owned dofs) [m], holds the prescribed displacements
void start_from(const CrsMatrix &interpolation, const SmoothedFunctional &coarse, const Vector &coarse_u,
                SmoothedFunctional &fine, Vector &u);

} // namespace rpc::contact
