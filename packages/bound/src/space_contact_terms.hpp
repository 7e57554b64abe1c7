// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"
#include "space_contact.hpp"

#include <string>
#include <vector>

/// What contact_terms.hpp has in the plane, for flat sides in space.
namespace rpc::bound
{

/// Tractions of contact on the facets of a side [Pa].
struct SpaceTractions {
  std::vector<OfTriangle> pressure;
  AlongSide friction; ///< empty where there is none
};

/// Collective. @param u  (owned dofs)                                                                  doc/bounds.md (13.3)
void move_out(const SpaceContact &c, const mesh::Mesh &mesh, const HostView<double *> &u);

struct SpaceContactTerms {
  std::vector<SpaceTractions> tractions;
  std::vector<std::vector<double>> gap_of; ///< (sides; facets) in `gap` [J]
  double energy = 0;                       ///< int psi(v) + s |e| [J]
  double gap = 0;      ///< int psi(v) + psi*(p) - p v + s |e| - q e [J]                    (13.11), (13.12)
  std::string missing; ///< why there is no bound; else empty
};
/// Collective. @param u  (owned dofs) out of rigid foundations
SpaceContactTerms contact_terms(const std::vector<SpaceContact> &sides, const mesh::Mesh &mesh,
                                const HostView<double *> &u);

} // namespace rpc::bound
