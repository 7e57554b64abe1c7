// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/box.hpp"

namespace rpc::mesh
{

/// @throws rpc::Error (bad_input) where `expansion` is out of range, or not 1 in a direction that cannot be graded
void require_expansion(const BoxOptions &options);

} // namespace rpc::mesh
