// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/contact_options.hpp"
#include "rpc/contact/result.hpp"

#include <string>
#include <vector>

/// Contact where the sides of a periodic box are joined: contact points there see the foundation at the lower side alone.
namespace rpc::contact
{

/// A contact point of joined sides at which the foundation has not the period of the box.
struct UnevenGap {
  double difference =
      0; ///< between the gaps at the point and at its image [m], infinite where one misses the obstacle; 0: there is none
  Point place{}; ///< of the point [m]
  int side = 0;  ///< which contact side
};

/// The largest difference at points that bear a pressure or whose images lie in the foundation. Collective.
/// @param sides    that the contact nodes were made from
/// @param options  of the sides, seen at the time of the solution
UnevenGap uneven_gap(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                     const std::vector<ContactOptions> &options, const ContactNodes &points,
                     const ContactResult &result);

/// Note for the user on it; empty if there is none.
std::string uneven_gap_note(const UnevenGap &uneven, const std::vector<ContactOptions> &options, int dim,
                            const UnitNames &units = {});

} // namespace rpc::contact
