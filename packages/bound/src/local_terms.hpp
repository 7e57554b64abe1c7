// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <utility>
#include <vector>

namespace rpc::bound
{

/// (owned cells) Parts of energy_norm^2: the energy of each cell's difference of stresses times a factor, and what contact misses on its
/// facets, all scaled so that their sum over all ranks is the whole. Collective.
/// @param of_cell  (owned cells) that energy [J], in 2D per m
/// @param gaps  (contact facets) owned cell and what contact misses there [J], in 2D per m
DeviceView<double *> local_terms(const Comm &comm, const DeviceView<double *> &of_cell, double factor,
                                 const std::vector<std::pair<LO, double>> &gaps, double whole);

} // namespace rpc::bound
