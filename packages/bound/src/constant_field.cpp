// SPDX-License-Identifier: BSD-3-Clause
#include "constant_field.hpp"

#include <cmath>

namespace rpc::bound
{

std::optional<double> value_everywhere(const ScalarField &field)
{
  constexpr double far = 1e30; // beyond all bodies
  constexpr double rounding = 1e-13;
  if (field.is_constant()) return field.constant;
  if (!field.bounds) return std::nullopt;
  const Interval values = field.bounds({{-far, -far, -far}, {far, far, far}}, field.time);
  const double value = field({});
  const bool one = values.high - values.low <= rounding * std::abs(value) || values.high == values.low;
  return one ? std::optional<double>(value) : std::nullopt;
}

} // namespace rpc::bound
