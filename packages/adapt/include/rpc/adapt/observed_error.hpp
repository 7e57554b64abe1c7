#pragma once

#include <vector>

namespace rpc::adapt
{

/// Error of a quantity on the last of several meshes, from how much it changed from mesh to mesh while the energy error eta
/// fell: as if it was C eta on each, |Q_k - Q| <= change_k / (eta_{k-1} / eta_k - 1), and no less than what the change
/// before that leaves. Cautious for forces, whose error falls like eta^2.                          doc/theory.md (10.7)
/// @param change  |Q_k - Q_{k-1}| for k = 1, 2, ...   @param eta  of all meshes, one more, > 0
/// @return NaN for fewer than two meshes
double observed_error(const std::vector<double> &change, const std::vector<double> &eta);

/// Whether the last change is larger than the one before it, or half of it where the estimate has fallen by more than half:
/// then the sequence does not settle, and nothing bounds its error. A change up to `resolved` is no matter.        (10.8)
bool unsettled(const std::vector<double> &change, const std::vector<double> &eta, double resolved);

} // namespace rpc::adapt
