// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/core/units.hpp"
#include "rpc/fem/parts.hpp"
#include "rpc/fem/rigid_motion.hpp"

#include <vector>

namespace rpc::contact
{

/// What holds the body.
struct Support {
  int num_parts = 1;            ///< of the body that share no node
  bool by_contact_only = false; ///< some part has rigid motions that nothing but contact stops
  /// Without the friction that follows the pressure, mu p, the load would move some part: whether there is a solution depends on the
  /// pressures. (12.10)
  bool by_coulomb_only = false;
};

/// The parts of a body with the rigid motions that prescribed displacements leave to each.
struct FreeParts {
  fem::Parts parts;
  std::vector<std::vector<fem::RigidMotion>> motions; ///< by part, see fem::free_motions()
};
/// Costs O(nodes) small and depends on the mesh and on which unknowns are prescribed only. Collective.
/// @throws rpc::Error (no_solution) on every rank, where pieces of a part can move in their joint
FreeParts free_parts(const fem::Discretization &d, const fem::DirichletDofs &dirichlet);

/// Looks for rigid motions that neither prescribed displacements nor the foundation stop, before anything is solved.
///
/// The discrete problem has a solution if and only if, part by part, the resultant of the load along the free rigid motions
/// lies in the set Z of resultants that the foundation can bear; it is determined only if the resultant lies inside Z.
///                                                                                         doc/theory.md (9.2) - (9.6)
/// Costs nothing if prescribed displacements hold every part, else some hundred sums over the contact nodes.
/// @param applied_load  (owned dofs) [N], before elimination; collective
/// @param units         for messages
/// @throws rpc::Error (no_solution) on every rank, naming part, motion and forces: a motion that nothing stops; a load
///         beyond what the foundation carries, or away from it; a load that leaves the position open
Support check_support(const fem::Discretization &d, const FreeParts &body, const Vector &applied_load,
                      const ContactNodes &contact, const std::vector<ContactOptions> &options,
                      const UnitNames &units = {});

} // namespace rpc::contact
