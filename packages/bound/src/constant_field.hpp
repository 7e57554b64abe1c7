// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"

#include <optional>

namespace rpc::bound
{

/// The value of a field that is the same at all places, at the time at which it is seen; none if it is not known to be.
std::optional<double> value_everywhere(const ScalarField &field);

} // namespace rpc::bound
