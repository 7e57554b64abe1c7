// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace rpc::adapt
{

/// Error of a quantity on the last of several meshes, from how much it changed from mesh to mesh while the energy error eta
/// fell: as if it was C eta on each, |Q_k - Q| <= change_k / (eta_{k-1} / eta_k - 1), and no less than what the change
/// before that leaves. Cautious for forces, whose error falls like eta^2.                          doc/theory.md (10.7)
/// @param change  |Q_k - Q_{k-1}| for k = 1, 2, ...   @param eta  of all meshes, one more, > 0
/// @return NaN for fewer than two meshes
double observed_error(const std::vector<double> &change, const std::vector<double> &eta);

/// The same from all meshes whose estimate is at most `span` times that of the last one: what small steps show together, while
/// each by itself shows little more than chance.                                                      (10.7)
/// @param distance  |Q_n - Q_k| for all meshes k but the last, n   @param eta  of all meshes, one more, > 0
/// @return 0 where there is no such mesh
double error_over_span(const std::vector<double> &distance, const std::vector<double> &eta);

/// Error of a quantity at the end of a history, as another one on other meshes shows it: as if it was C eta in both, eta the largest of all
/// steps. Meshes of earlier steps may be the coarser ones.                                                    (10.7c)
/// @param distance  of the quantity in the two   @param eta_other, eta  of the other history and of this one, > 0
double error_of_history(double distance, double eta_other, double eta);

/// Whether the estimate has fallen by so little over all meshes that their changes tell nothing of what is left.  (10.7)
bool hardly_finer(const std::vector<double> &eta);

/// Whether the last value is the largest and the values grow at a power of the estimate below 1/2: by more than `resolved` over the
/// second half of its fall, on a logarithmic scale, and by no less than such a power leaves of the first half. So do values without a
/// limit, as log(1/eta). Not told by fewer than three meshes.                                                (10.8)
bool grows_without_limit(const std::vector<double> &value, const std::vector<double> &eta, double resolved);

/// Whether the last change is larger than the one before it, or half of it where the estimate has fallen by more than half:
/// then the sequence does not converge visibly, and nothing bounds its error. Changes up to `resolved` do not count.        (10.8)
bool unsettled(const std::vector<double> &change, const std::vector<double> &eta, double resolved);

/// The larger of the contact force and the resultant of the loads, which balances it and the reactions [N], in 2D per m. (10.7a)
double force_at_work(const std::array<double, 3> &contact, const std::vector<std::array<double, 3>> &reactions);

} // namespace rpc::adapt
