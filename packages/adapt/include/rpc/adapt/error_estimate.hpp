#pragma once

#include "rpc/contact/result.hpp"
#include "rpc/fem/elasticity.hpp"

#include <string>

namespace rpc::adapt
{

/// Whether the largest contact pressure can have an error bar: what the mesh shows of it.              doc/theory.md (10.8)
struct PressurePeak {
  bool at_bound = false; ///< it is the highest yield stress there is, and so exact
  double drop =
      0; ///< by how much the pressure falls within a facet whose highest is 0.98 of it, over the largest pressure
  bool yield_jump = false; ///< a part that yields borders on a higher yield stress: the pressure is singular in between
  bool gap_jump = false;   ///< contact ends where the gap jumps: the pressure is singular there

  /// Why there is no bar; empty if there is one.
  std::string unknown() const;
};

/// Estimated error of a solution in the energy norm, squared: an estimate of 2 (J(u_h) - J(u)), which bounds a(e, e) for the
/// error e.                                                                                     doc/theory.md (10.1)
///
///     eta_T^2 = int_T (s* - s_h) : C^-1 (s* - s_h)                                             recovery         (10.2)
///             + sum over contact facets of T, h / (3 (lambda + 2 mu)) int |s* n + p nu - t|^2  equilibrium      (10.3)
///             + 2 int (xi - p) v+ + p v-                                                       complementarity  (10.4)
///
/// with s* the recovered stress, s_h that of u_h, p the contact pressure and v the penetration between the nodes, t the
/// applied traction and h the facet's length. Yielded parts carry p = xi, open ones p = 0.
struct ErrorEstimate {
  DeviceView<double *> squared; ///< (owned cells) eta_T^2 [J], in 2D per m
  // Sums over all ranks, [J], in 2D per m.
  double recovery = 0;
  double equilibrium = 0;
  double complementarity = 0;
  double rounding =
      0; ///< an estimate, or a strain energy, that is no larger than this is rounding; see rounding_energy()
  // What the contact pressure and that of the recovered stress, held to [0, xi], disagree by.
  double pressure = 0; ///< in L2 over facets that are neither all open nor all yielded [Pa m^(1/2)], in 3D [Pa m]
  double max_pressure =
      0; ///< the most at points with 0.9 of the largest pressure, on facets that have not all yielded [Pa]
  PressurePeak peak;
  double contact_ends =
      0; ///< half of the facets that are partly open: the mesh does not tell where contact ends [m^(dim-1)]

  double total() const { return recovery + equilibrium + complementarity; } ///< eta^2
};

/// @param sides    the contact sides, in the order of the contact nodes
/// @param loads    of the scene; those on contact sides count
/// @param contact, result  contact nodes and what they came to
/// @param u        displacement from 0 (owned dofs) [m]; collective
ErrorEstimate estimate_error(const fem::Discretization &d, const fem::Materials &materials,
                             const std::vector<const mesh::Side *> &sides, const std::vector<fem::TractionLoad> &loads,
                             const contact::ContactNodes &contact, const contact::ContactResult &result,
                             const Vector &u);

} // namespace rpc::adapt
