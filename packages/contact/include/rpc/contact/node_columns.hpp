// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"

namespace rpc::contact
{

/// Values of contact points by node and side (owned nodes; sides), 0 elsewhere: a form that does not depend on which nodes are
/// points, and that interpolates to other meshes.
RCP<MultiVector> node_columns(const ContactNodes &c, const DeviceView<double *> &values,
                              const RCP<const Map> &owned_nodes);

/// The same of vectors at the points: (owned nodes; sides x dim), the components of a side after each other.
/// @param vectors  (points, dim); empty on a rank without points
RCP<MultiVector> node_columns(const ContactNodes &c, const DeviceView<double **> &vectors,
                              const RCP<const Map> &owned_nodes);

/// (points) The values of such columns.
DeviceView<double *> at_points(const ContactNodes &c, const MultiVector &columns);
/// (points, dim) The same of vectors.
DeviceView<double **> vectors_at_points(const ContactNodes &c, const MultiVector &columns);

} // namespace rpc::contact
