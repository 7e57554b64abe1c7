// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rpc::io
{

/// A number of the results as a reader is to see it: its digits end where its error bar has its second one.
///
///     "64.9323 ± 0.0077 N/m (0.012 %)", "(6.40 ± 0.25)e+08 Pa (3.9 %)", "0.8 ± 4.7 m (larger than the value)"
///
/// A bar of 0 reads "(exact)", one of rounding "(to rounding)"; without a bar there are six digits: "64.9349 N/m". A number that is not finite is "unknown".
/// @param bar   >= 0; NaN: there is none
/// @param unit  may be empty
std::string with_error_bar(double value, double bar, const std::string &unit);

/// The same of a vector's length, and its components with as many decimals: "64.9323 ± 0.0077 N/m (0.012 %), components (0.0000, 64.9323)".
/// @param bar  of the length of the vector's error, which none of its components exceeds
std::string with_error_bar(const std::vector<double> &vector, double bar, const std::string &unit);

} // namespace rpc::io
