// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"
#include "rpc/core/kokkos.hpp"

#include <Teuchos_Comm.hpp>
#include <string>

namespace rpc
{

/// Points on the host, (n, 2 or 3) [m]. Any layout converts to it: a HostView<double **> as well as a host copy of a
/// device view.
using HostPoints = Kokkos::View<const double **, Kokkos::LayoutStride, Kokkos::HostSpace>;

/// Values of a user's field at this rank's points, checked; collective on comm.
///
/// @param parameter       deck path for the message, "Contact->Yield Stress"
/// @param allow_infinite  whether +inf and -inf are values like any other; NaN never is
/// @return (n) values, in the order of the points
/// @throws rpc::Error (bad_input) on every rank if a value is not allowed on any, naming parameter, text, point and
/// value
HostView<double *> evaluate(const ScalarField &field, const HostPoints &points, const std::string &parameter,
                            const Teuchos::Comm<int> &comm, bool allow_infinite = false);

} // namespace rpc
