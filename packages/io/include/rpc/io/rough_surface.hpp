// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace rpc::io
{

/// A synthetic self-affine surface: a sum of waves, those of a period, of random phases.
///
///     h(x) = sum_q c_q exp(2 pi i q . x / L),   E|c_q|^2 ~ q^(-2 - 2H), of a profile q^(-1 - 2H),   for whole q from the lowest to the highest;
///
/// below the roll-off the power is that at the roll-off. Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001.
struct RoughSurfaceOptions {
  bool is_profile = false;
  int points = 64;                               ///< along each direction; neighbours are period / points apart
  double period = 1;                             ///< L [m]
  double hurst = 0.8;                            ///< H
  double lowest = 1, roll_off = 1, highest = 16; ///< waves a period: bounds on |q|
  double rms_slope = 0, rms_height = 0;          ///< of this surface as a sum of waves; one of them is > 0 [-], [m]
  bool gaussian = false;  ///< amplitudes are normally distributed; else each is the root of its mean square
  bool symmetric = false; ///< about x = 0 and L/2, and the same along y
  int seed = 1;
};

Teuchos::ParameterList valid_rough_surface_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
RoughSurfaceOptions rough_surface_options(const Teuchos::ParameterList &list);

/// Its heights (rows along y, columns along x) [m], from a Mersenne twister of 64 bits, whose numbers the C++ standard fixes: the same on all
/// machines but for rounding. A wave has its phase whatever the number of points, the highest wave number and the period are. The sum
/// takes some points^2 * highest + points * highest^2 times 4 products.
std::vector<double> rough_surface(const RoughSurfaceOptions &options);

/// What a file of heights holds: .npy, .csv or, with the spacing, .asc.
/// @throws rpc::Error (bad_input) on another ending
std::string heights_as(const std::string &ending, const std::vector<double> &heights, int columns, double spacing);

} // namespace rpc::io
