// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/core/kokkos.hpp"

namespace rpc::contact
{

/// The foundation at each contact point of this rank. Only the functions of law/ read a law's parameters.
struct Foundations {
  DeviceView<double *> yield;      ///< (points) xi + H w, at the dents w that earlier steps have left [Pa]
  DeviceView<double *> hardening;  ///< (points) H [Pa/m]
  DeviceView<double *> compliance; ///< (points) c = 1/k [m/Pa]

  KOKKOS_INLINE_FUNCTION Foundation operator()(const LO i) const
  {
    return Foundation{yield(i), hardening(i), compliance(i)};
  }
};

} // namespace rpc::contact
