// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::test
{

/// The larger of two numbers, NaN if one of them is: std::max forgets NaN, and a bound on the largest of many would hold.
inline double larger(const double a, const double b)
{
  return a > b || a != a ? a : b;
}

} // namespace rpc::test
