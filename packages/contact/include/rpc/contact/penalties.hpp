// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"

namespace rpc::contact
{

/// (points) The penalties r of the modified Lagrangian [Pa/m]: those that are given, and where they are left open a multiple of
/// `own`; none exceeds what double precision bears. doc/theory.md (5.12)
/// @param own  (points) see own_stiffness() [Pa/m]
DeviceView<double *> chosen_penalties(const ContactNodes &points, const DeviceView<double *> &own);

/// Raises penalties in place, as far as double precision bears it. Collective.
/// @return whether any rose, on any rank                                                                        (5.12)
bool raise_penalties(const Comm &comm, const DeviceView<double *> &own, const DeviceView<double *> &penalty);

/// Raises penalties that are given to those that are chosen where they are left open: for friction, whose states a weak penalty leads astray.
/// Collective. @return at how many points, on all ranks                                                        (12.12b)
GO raise_weak_penalties(const ContactNodes &points, const DeviceView<double *> &own,
                        const DeviceView<double *> &penalty, const Comm &comm);

/// Lowers penalties in place to those of the body as a whole, E / diameter: for friction whose states do not converge.  (12.12a)
void lower_penalties(const ContactNodes &points, const DeviceView<double *> &penalty);

} // namespace rpc::contact
