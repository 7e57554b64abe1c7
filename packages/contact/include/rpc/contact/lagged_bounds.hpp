// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::contact
{

/// Friction's bounds from one Tresca problem to the next: a fixed point s = G(s), G the bounds by (12.1) at the pressures that the
/// problem with the bounds s has, by Anderson's acceleration.                                     doc/theory.md (12.12)
class LaggedBounds
{
public:
  /// The bounds of the next Tresca problem [Pa]; collective.
  /// @param used    (points) s of the last problem    @param found   (points) G(s)
  /// @param weight  (points) of the norm              @return (points) >= 0
  DeviceView<double *> next(const Comm &comm, const DeviceView<double *> &used, const DeviceView<double *> &found,
                            const DeviceView<double *> &weight);

private:
  struct Change {
    DeviceView<double *> residual, found; // (points) of G(s) - s, and of G(s), from one problem to the next
  };
  std::vector<Change> changes_;           // the last ones, at most four
  DeviceView<double *> residual_, found_; // of the last problem
  bool started_ = false;
};

} // namespace rpc::contact
