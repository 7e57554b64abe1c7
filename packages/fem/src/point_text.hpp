// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"

#include <cmath>
#include <sstream>
#include <string>

namespace rpc::fem
{

/// "(1, 0.5)" for messages.
/// @param rounding  numbers are multiples of it
inline std::string rounded_point_text(const Point &x, const int dim, const double rounding)
{
  std::ostringstream text;
  for (int c = 0; c < dim; ++c) text << (c > 0 ? ", " : "(") << std::round(x[c] / rounding) * rounding + 0.; // no -0
  text << ")";
  return text.str();
}

/// The same; numbers at the rounding of `scale` are 0.
inline std::string point_text(const Point &x, const int dim, const double scale)
{
  std::ostringstream text;
  for (int c = 0; c < dim; ++c) text << (c > 0 ? ", " : "(") << (std::abs(x[c]) > 1e-7 * scale ? x[c] : 0.);
  text << ")";
  return text.str();
}

} // namespace rpc::fem
