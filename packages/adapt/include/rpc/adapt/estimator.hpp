// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/result.hpp"
#include "rpc/fem/elasticity.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace rpc::adapt
{

/// Whether the largest contact pressure can have an error bar: what the mesh shows of it.              doc/theory.md (10.8)
struct PressurePeak {
  bool at_bound = false; ///< it is the highest yield stress there is, and so exact
  /// The pressure from which a contact point gives way: its yield stress, on springs 0 [Pa].
  double lowest_bound = std::numeric_limits<double>::infinity();
  double drop =
      0; ///< by how much the pressure falls within a facet whose highest is 0.98 of it, over the largest pressure
  bool yield_jump = false; ///< a part that yields borders on a higher yield stress: the pressure is singular in between
  bool gap_jump =
      false; ///< contact ends on a rigid foundation where the gap jumps, or has a kink: the pressure is singular there
  bool dented_jump = false; ///< the foundation has been dented next to a jump of the gap, and no node knows up to where
  bool friction_jump = false; ///< the traction of a body that slips jumps: the pressure is singular there
  bool friction_edge = false; ///< contact with friction reaches an end of the side, where the pressure may be singular
  double kink =
      0; ///< of the gap in contact: how much the pressure grows while the distance to it falls to 1/e, over the largest pressure
  /// What facets leave open of the pressure, and of the penetration, at a kink of the gap where the foundation gives way [Pa], [m]. (10.8b)
  double rounded = 0, rounded_depth = 0;

  /// Why there is no bar; empty if there is one.
  std::string unknown() const;
};

/// A part of an estimate, squared, over all ranks.
struct ErrorPart {
  std::string key; ///< in the summary
  double squared;  ///< [J], in 2D per m; >= 0
};

/// Estimated error of a solution in the energy norm, squared: an estimate of 2 (J(u_h) - J(u)), which bounds a(e, e) for the
/// error e.                                                                                     doc/theory.md (10.1)
struct ErrorEstimate {
  DeviceView<double *> squared; ///< (owned cells) the indicators eta_T^2 [J], in 2D per m
  std::vector<ErrorPart> parts; ///< of eta^2, in the order of the summary
  double rounding =
      0; ///< an estimate, or a strain energy, that is no larger than this is rounding, or left by earlier steps [J]; see rounding_energy(), (5.5b)
  // By how much the contact pressure differs from that of the recovered stress, made admissible.
  double pressure = 0; ///< in L2 over facets that are neither all open nor all yielded [Pa m^(1/2)], in 3D [Pa m]
  double max_pressure =
      0; ///< at points with 0.9 of the largest pressure, on facets that have not all yielded: the most, in space the root mean square [Pa]
  PressurePeak peak;
  // (owned cells) Of unseen contact: its part in eta_T^2 [J], and the size of a cell that would see it, 0 where there is none [m]. (10.4b)
  DeviceView<double *> unseen_squared, seen_from;
  double contact_ends =
      0; ///< half of the facets that are partly open: the mesh does not tell where contact ends [m^(dim-1)]

  double ends_force =
      0; ///< what that leaves open of forces [N], in 2D per m                                      (10.7g)

  // What the mesh leaves open where data of the contact law jump between nodes:                                  (10.7b)
  double jumped_force = 0;  ///< tractions that jump, over half of the facets on which they do [N], in 2D per m
  double jumped_energy = 0; ///< what contact that ends half a facet further in would release [J], in 2D per m
  double misread_force = 0, misread_energy = 0, misread_penetration = 0; ///< see contact::BetweenNodes, (3.5b)
  double interpolated =
      0; ///< |contact::BetweenNodes::interpolation_work| [J], in 2D per m                       (3.16b)

  double part(const std::string &key) const; ///< [J], in 2D per m
  double total() const;                      ///< eta^2
  /// Of contact that no contact point sees, twice the energy that it takes [J], in 2D per m.                      (10.4b)
  double unseen() const { return part(unseen_contact); }
  double hidden = 0; ///< of that, contact beside which no node bears: see contact::BetweenNodes [J], in 2D per m
  /// Whether unseen contact is most of the estimate, which the next mesh sees: it falls at once, and not as the order of the elements.
  bool falls_at_once() const { return unseen() > 0.5 * total(); }
  /// Whether hidden contact is: errors elsewhere are those of another solution.
  bool misses_contact() const { return hidden > 0.5 * total(); }
  static constexpr const char *unseen_contact = "unseen_contact";
};

/// A solution whose error is to be estimated.
struct EstimateInput {
  const fem::Discretization &discretization;
  const fem::Materials &materials;
  std::vector<const mesh::Side *> sides;       ///< the contact sides, in the order of the contact nodes
  const std::vector<fem::TractionLoad> &loads; ///< of the scene; those on contact sides count
  const contact::ContactNodes &contact;
  const contact::ContactResult &result; ///< results at the contact nodes
  const Vector &u;                      ///< displacement from 0 (owned dofs) [m]
};

/// A way to estimate errors; collective.
using Estimator = std::function<ErrorEstimate(const EstimateInput &)>;

/// The one that runs use: that by recovered stresses, see recovered_estimate().
Estimator estimator();

} // namespace rpc::adapt
