// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/result.hpp"

#include <array>
#include <vector>

/// How contact is spread over a side: what studies of rough surfaces report.
namespace rpc::contact
{

/// Of one contact side.
struct ContactPatches {
  static constexpr int bins = 20;

  double mean_gap = 0; ///< mean distance of the body from the dented foundation, 0 where they touch [m]
  double whole = 0;    ///< size of the side [m^2], in the plane [m]
  /// Sizes of the parts of the contact that hang together, the largest first: weights of points with p > 0. Two such points hang together where they
  /// belong to one facet; over the joined sides of a periodic box, too. [m^2], in the plane [m]
  std::vector<double> size;
  /// Weights of points with p > 0, by p: bins of one width between 0 and the largest pressure. [m^2], in the plane [m]
  std::array<double, bins> size_by_pressure{};
  double max_pressure = 0; ///< upper end of the last bin [Pa]
};

/// Of all contact sides together: what a history has of its steps.
struct PatchCount {
  double count = 0;    ///< parts of the contact that hang together [-]
  double largest = 0;  ///< size of the largest one [m^2], in the plane [m]
  double mean_gap = 0; ///< mean distance of the body from the dented foundation [m]
};

/// Its numbers.
inline constexpr std::array<Quantity<PatchCount>, 3> patch_quantities{{
    {&PatchCount::count, "patches", unit::none, Combine::sum, {true, 1}},
    {&PatchCount::largest, "largest_patch", unit::extent, Combine::maximum, {true, 2}},
    {&PatchCount::mean_gap, "mean_gap", unit::length, Combine::maximum, {true, 3}},
}};

/// On rank 0.
PatchCount counted(const std::vector<ContactPatches> &sides);

/// Of each contact side, on rank 0; elsewhere empty. Collective. Its work is that of sorting the side's nodes, on one core.
/// @param sides  that the contact nodes were made from
std::vector<ContactPatches> contact_patches(const mesh::Mesh &mesh, const std::vector<const mesh::Side *> &sides,
                                            const ContactNodes &points, const ContactResult &result);

} // namespace rpc::contact
