// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/units.hpp"

#include <optional>

namespace rpc
{

/// A deck's unit of stress in Pa: 1e6 of mm and N; none of units that are not metres and newtons with a prefix.
std::optional<double> pascals(const UnitNames &units);

} // namespace rpc
