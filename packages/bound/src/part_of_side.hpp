// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_pressure.hpp"
#include "rpc/core/interval.hpp"
#include "space_contact.hpp"

#include <vector>

/// The part of a contact side that lies in a box: on all ranks alike.
namespace rpc::bound
{

/// What of a facet is in the box.
struct PartOfFacet {
  double size = 0;     ///< [m], in space and of revolution [m^2]
  double force = 0;    ///< integral of the solution's pressure, of the nodes' values between them [N], in 2D per m
  bool whole = false;  ///< nothing is outside
  bool partly = false; ///< something is inside
};

/// (facets) @param near  by how much a facet may reach over an end of the box that counts as one of its own [m]
std::vector<PartOfFacet> parts_of_facets(const ContactFacets &c, const Box &box, double near);
std::vector<PartOfFacet> parts_of_facets(const SpaceContact &c, const Box &box, double near);

} // namespace rpc::bound
