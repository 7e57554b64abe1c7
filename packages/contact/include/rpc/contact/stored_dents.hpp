// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/moving_dents.hpp"

#include <vector>

/// Dents of foundations as numbers, for a checkpoint.
namespace rpc::contact
{

/// The parts of all ranks, on rank 0; empty elsewhere. Collective.
std::vector<double> stored_dents(const Comm &comm, const std::vector<FoundationDents> &foundations);

/// The dents of which stored_dents() made numbers: on as many ranks each has its part again, on another number of ranks the parts are
/// dealt out in turn. Collective.
/// @param numbers  rank 0's are read
/// @throws rpc::Error (bad_input) on every rank if they are not what stored_dents() has made
std::vector<FoundationDents> dents_from(const Comm &comm, const std::vector<double> &numbers);

} // namespace rpc::contact
