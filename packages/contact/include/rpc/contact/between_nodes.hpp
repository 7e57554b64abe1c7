// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/contact_options.hpp"
#include "rpc/contact/result.hpp"
#include "rpc/fem/elasticity.hpp"

#include <vector>

/// The contact law holds at the contact points alone. What happens between them is read here, from samples on the facets. doc/theory.md, 3.5
namespace rpc::contact
{

/// Looks for penetration between the contact points of a solution, on samples of all facets: there u is interpolated and the gap is that of
/// the foundation at the sample itself.
///
///     e(x) = u_nu(x) - g(x) - max(w + v+, 0)(x)                                                          doc/theory.md (3.15)
///
/// is how much deeper a sample lies in the foundation than the interpolation of what the contact points of its facet have been pressed in.
/// Contact is *unseen* on a facet where e > 0 at a sample although no contact point of it bears a pressure, or where something of the gap is
/// narrower than the facet, (3.15a): contact is there and the mesh does not see it.
///
/// Fills `result.between` and the numbers of `result.sides` and `result.total` that belong to it. Collective.
/// @param sides      that the contact nodes were made from
/// @param options    of the sides, seen at the time of the solution
/// @param materials  for the stiffness against which a facet would be pushed out of the foundation
/// @param u          displacement from 0 (owned dofs) [m]
void look_between_nodes(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                        const std::vector<ContactOptions> &options, const ContactNodes &points,
                        const fem::Materials &materials, const Vector &u, ContactResult &result);

/// Whether contact that the mesh does not see matters.                                              doc/theory.md (3.16)
/// @param energy_norm_squared  a(u, u) of the solution [J], in 2D per m
bool misses_contact(const ContactSums &sums, double energy_norm_squared);

/// Note for the user on contact that the mesh does not see: place, depth, and the size of cells that would see it; empty if there is none
/// that matters.
/// @param energy_norm_squared  a(u, u) of the solution [J], in 2D per m
/// @param adapts  whether the deck asks for meshes that are adapted
std::string unseen_contact_note(const ContactResult &result, const std::vector<ContactOptions> &options, int dim,
                                double energy_norm_squared, const UnitNames &units = {}, bool adapts = false);

} // namespace rpc::contact
