// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"

#include <string>
#include <vector>

namespace rpc::bound
{

/// Moves u so that the contact points of a rigid foundation lie nowhere in it; elsewhere it stays. Collective.
///                                                                                                      doc/bounds.md (13.3)
/// @param u  (owned dofs)
void move_out(const ContactFacets &c, const mesh::Mesh &mesh, const HostView<double *> &u);

/// What contact sides have in the energy of a displacement and in its bound.
struct ContactTerms {
  std::vector<SideTractions> tractions;
  std::vector<std::vector<double>> gap_of; ///< (sides; facets) in `gap` [J], in 2D per m
  double energy = 0;                       ///< int psi(v) + s |e| [J]
  double gap = 0;      ///< int psi(v) + psi*(p) - p v + s |e| - q e [J]                    (13.11), (13.12)
  std::string missing; ///< why there is no bound; else empty
};
/// Collective. @param u  (owned dofs) out of rigid foundations
ContactTerms contact_terms(const std::vector<ContactFacets> &sides, const mesh::Mesh &mesh,
                           const HostView<double *> &u);

} // namespace rpc::bound
