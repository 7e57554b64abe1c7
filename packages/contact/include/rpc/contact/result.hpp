// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_state.hpp"
#include "rpc/core/point.hpp"
#include "rpc/core/quantity.hpp"

#include <array>
#include <limits>
#include <vector>

namespace rpc::contact
{

/// Sums and maxima over a contact side, or all of them, on all ranks.
struct ContactSums {
  GO num_nodes = 0; ///< that have a weight
  std::array<double, 3>
      force{}; ///< of the foundation on the body, sum of -w (p normal + q) [N], in the plane per m; of an axisymmetric body along its axis
  // Numbers: units and how they combine stand in contact_quantities.
  double max_pressure = 0;
  double max_penetration = 0;         ///< largest u_nu - g where > 0
  double max_initial_penetration = 0; ///< largest -g where > 0
  double contact_length = 0;          ///< sum of weights with p > 0
  double yielded_length = 0;          ///< sum of weights with p at the yield limit
  double max_dent = 0;
  double dent_volume = 0; ///< sum of w dent
  double dissipated = 0;  ///< sum of w int (xi + H w) dw over what this step adds to the dents               (3.14)
  double foundation_energy = 0; ///< sum of w c p^2/2, stored in the foundation's springs
  double max_shear = 0;         ///< largest |q|
  double max_slip = 0;          ///< largest |e| of this step where p > 0
  double stick_length = 0;      ///< sum of weights where friction acts, |q| < s
  double slip_length = 0;       ///< the same with |q| = s
  double friction_work = 0;     ///< sum of w s |e| of this step
  // Between the contact points, see look_between_nodes():
  double max_penetration_between_nodes = 0; ///< largest e                                                        (3.15)
  double unseen_penetration = 0;            ///< the same on facets where contact is unseen
  double unseen_energy = 0;                 ///< what it would take to push these out of the foundation           (3.16)

  /// Whether the foundation gives way; where it does not, penetrations are 0 but for rounding.
  bool gives_way() const { return max_dent > 0 || foundation_energy > 0; }
  ContactSums &operator+=(const ContactSums &other);
};

/// The numbers of ContactSums, in the order of the summary. Energies are shown as sums over the steps, by analysis.
inline constexpr std::array<Quantity<ContactSums>, 17> contact_quantities{{
    {&ContactSums::max_pressure,
     "max_pressure",
     unit::pressure,
     Combine::maximum,
     {true, 1, "largest pressure", "", false, true}},
    {&ContactSums::max_penetration,
     "max_penetration",
     unit::length,
     Combine::maximum,
     {true, 2, "largest penetration"}},
    {&ContactSums::max_initial_penetration,
     "max_initial_penetration",
     unit::length,
     Combine::maximum,
     {true, 0, "initial penetration", "", true}},
    {&ContactSums::contact_length,
     "contact_length",
     unit::extent,
     Combine::sum,
     {true, 5, "in contact", "", false, true},
     "contact_area"},
    {&ContactSums::yielded_length, "yielded_length", unit::extent, Combine::sum, {true, 6, "yielded"}, "yielded_area"},
    {&ContactSums::max_dent, "max_dent", unit::length, Combine::maximum, {true, 3, "dents", "at most ", true}},
    {&ContactSums::dent_volume, "dent_volume", unit::volume, Combine::sum, {true, 4, "dents", "volume ", true}},
    {&ContactSums::dissipated, "dissipated_energy", unit::energy},
    {&ContactSums::foundation_energy, "foundation_energy", unit::energy},
    {&ContactSums::max_shear,
     "max_shear",
     unit::pressure,
     Combine::maximum,
     {true, 7, "friction", "at most "},
     nullptr,
     Needs::friction},
    {&ContactSums::max_slip,
     "max_slip",
     unit::length,
     Combine::maximum,
     {true, 8, "friction", "slip of the step at most "},
     nullptr,
     Needs::friction},
    {&ContactSums::stick_length,
     "stick_length",
     unit::extent,
     Combine::sum,
     {true, 9, "friction", "sticks on "},
     "stick_area",
     Needs::friction},
    {&ContactSums::slip_length,
     "slip_length",
     unit::extent,
     Combine::sum,
     {true, 10, "friction", "slips on "},
     "slip_area",
     Needs::friction},
    {&ContactSums::friction_work, "friction_work", unit::energy, Combine::sum, {true}, nullptr, Needs::friction},
    {&ContactSums::max_penetration_between_nodes,
     "max_penetration_between_nodes",
     unit::length,
     Combine::maximum,
     {true}},
    {&ContactSums::unseen_penetration, "unseen_penetration", unit::length, Combine::maximum, {true}},
    {&ContactSums::unseen_energy, "unseen_energy", unit::energy, Combine::sum, {true}},
}};
static_assert(sizeof(ContactSums) == sizeof(GO) + (3 + contact_quantities.size()) * sizeof(double),
              "a number of ContactSums has no line in the table");

/// A place on a contact side where the body lies in the foundation between the contact points.
struct PlaceBetweenNodes {
  double depth = 0; ///< e [m]; 0: there is none                                                                (3.15)
  Point place{};    ///< of the undeformed body [m]
  int side = 0;     ///< which contact side
  double width = 0; ///< how far the part of its facet that lies in the foundation reaches [m]
  double facet = 0; ///< the same of the facet [m]
};

/// What samples between the contact points show.
struct BetweenNodes {
  PlaceBetweenNodes deepest, unseen;                ///< of all facets, and of those where it is unseen (3.15)
  std::vector<DeviceView<double *>> unseen_squared; ///< (sides; facets) the part of each in twice `unseen_energy` [J]
  std::vector<DeviceView<double *>>
      unseen_width; ///< (sides; facets) see PlaceBetweenNodes, 0 where nothing is unseen [m]
  /// Of `unseen_energy`, over all ranks: where facets touch, of samples in front of which the gap is smaller than at all of their nodes that
  /// bear, and no more than by how much. What lies beside such a node is where contact ends, and (3.16a) tells it [J], in 2D per m.    (10.4b)
  double hidden_energy = 0;
  // Of facets that touch and within which the gap jumps or has a kink, over all ranks: by how much reading the gap at the nodes alone may be
  // off, and how deep they may have been pressed in, with dents that were there.                               (3.16a)
  double misread_force = 0, misread_energy = 0; ///< [N], [J], in 2D per m
  double misread_penetration = 0;               ///< [m]
  double misread_ends = 0; ///< half of the facets whose nodes all bear, and between which contact may end [m^(dim-1)]
  /// Of other facets that touch: the work of the pressures over what the gap's interpolant differs by
  /// from it, over all sides and ranks, with its sign [J], in 2D per m.                                           (3.16b)
  double interpolation_work = 0;
  /// The least of -e, of (3.15), over the samples of all ranks [m]; infinite where nothing was sampled.
  double smallest_gap = std::numeric_limits<double>::infinity();
};

/// What a user reads off the contact sides: values at this rank's contact nodes, and sums over all ranks.
struct ContactResult {
  /// A fourth state, of a point without weight that bears no pressure and lies in the foundation: nothing holds it. look_between_nodes() finds
  /// such points.
  static constexpr int unseen = 3;

  DeviceView<double *> normal_displacement; ///< (n) u_nu [m]
  DeviceView<double *> penetration;         ///< (n) u_nu - g [m], below the surface without dents
  DeviceView<double *> dent;                ///< (n) w >= 0 [m], that of this step included                       (3.13)
  DeviceView<double *> pressure;            ///< (n) [Pa] >= 0
  DeviceView<int *> state; ///< (n) State: open where p = 0, yielded where p >= xi, else closed; or `unseen`
  // Friction; empty where there is none:
  DeviceView<double **> traction; ///< (n, dim) q, of the body on the foundation [Pa]
  DeviceView<double **> slip;     ///< (n, dim) e of this step [m], 0 where no friction acts
  DeviceView<double *> used;      ///< (n) |q|/s, 0 where s = 0
  DeviceView<int *> slip_state;   ///< (n) 0 no friction acts, 1 sticks, 2 slips

  std::vector<ContactSums> sides; ///< in the order of the contact sides
  ContactSums total;
  BetweenNodes between;
  double deepest_on_axis =
      0; ///< displacement into a foundation that gives way, at points without weight on the axis [m]
};

/// Reads a state's displacement and multipliers, see completed_pressure(); collective.
/// @param sides  that the contact nodes were made from
/// @param with_friction  has the fields of friction also where none acts at this time
ContactResult contact_result(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                             const ContactNodes &points, const ContactState &state, bool with_friction = false);

/// Pressures at all points from those of the points that take part in the solution: the others get theirs as told at
/// ContactNodes, and where the law leaves it open from their neighbours. doc/theory.md (3.5); collective
/// @param sides       that the contact nodes were made from
/// @param multiplier  (n) [Pa]
DeviceView<double *> completed_pressure(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                                        const ContactNodes &c, const DeviceView<double *> &multiplier);

/// |p - q|_2 over the contact sides, by the weights of their nodes, but for those whose normal displacement is prescribed
/// [Pa m^(1/2)], in 3D [Pa m]; collective.
/// @param q  as near as the law admits it; an empty one is 0
double pressure_distance(const Comm &comm, const ContactNodes &c, const DeviceView<double *> &p,
                         const DeviceView<double *> &q);

/// (n, dim) Force of the foundation on the body at each point, -w (p normal + q) [N], in the plane per m.
DeviceView<double **> point_forces(const ContactNodes &points, const ContactResult &result);

/// (n, dim) (I - nu nu^T) u, the displacement along the side at each point [m]. @param u  from 0 (owned dofs)
DeviceView<double **> tangential_displacements(const ContactNodes &points, const Vector &u);

/// Nodal forces of the foundation on the body, the sum of point_forces() at each node (owned dofs, [N]), prescribed components included.
Vector contact_forces(const fem::Discretization &d, const ContactNodes &contact, const ContactResult &result);

} // namespace rpc::contact
