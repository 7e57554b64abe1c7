// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_pressure.hpp"
#include "rpc/analysis/run.hpp"
#include "rpc/core/interval.hpp"
#include "space_contact.hpp"

#include <string>
#include <vector>

namespace rpc::bound
{

/// Displacements w with which the stress tells between which numbers the integral of a contact side's pressure over a part of it is.
///                                                                                                      doc/bounds.md (13.14), (13.15)
struct SidePress {
  double size = 0;  ///< of the part [m], in space and of revolution [m^2]
  double force = 0; ///< the integral of the solution's pressure, within the law's limits [N], in 2D per m
  double most = 0;  ///< what the exact one is not above, whatever the displacements; may be infinite
  RCP<const Vector> below,
      above;         ///< (owned dofs) w_nu <= 1 in the part and <= 0 outside, or >= both, but for: (null: below is 0)
  double missed = 0; ///< of the pressure where `above` is less than 1 in the part, at most [N]
  double counted_twice = 0; ///< of the pressure where `below` is more than 1, at most [N]
  std::string missing;      ///< why there is none; empty if there is one
};

/// The w of least energy for functions w_nu that are 1 at the nodes of a whole side, of a part linear on facets, and 0 along the normals of other contact sides. Collective.
/// @param sides  all contact sides   @param k  which of them   @param part  of it: what is in this box
SidePress side_press(const analysis::Problem &problem, double time, const std::vector<ContactFacets> &sides, int k,
                     const Box &part, const solver::LinearSolverOptions &options);
SidePress side_press(const analysis::Problem &problem, double time, const std::vector<SpaceContact> &sides, int k,
                     const Box &part, const solver::LinearSolverOptions &options);

} // namespace rpc::bound
