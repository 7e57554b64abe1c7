// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/node_points.hpp"
#include "rpc/contact/contact_options.hpp"
#include "rpc/contact/friction_points.hpp"
#include "rpc/contact/law/foundations.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/surface.hpp"

#include <vector>

namespace rpc::contact
{

/// The nodes of the contact sides that this rank owns, each a point with a weight; side by side, so that a node of two
/// sides is two points. doc/theory.md (2.7), (3.4)
///
/// A node from which the side's normal misses the obstacle never touches: it is no point. A node without weight (a vertex of
/// quadratic triangles; with order 2 a node on the axis of an axisymmetric body) takes no part in the solution: its direction is
/// 0, and its pressure follows from its neighbours'.
///
/// v_i = direction_i . u_i - free_gap_i is the penetration of node i, where `direction` is the normal without its
/// prescribed components and `free_gap` has taken these over. A node whose normal displacement is prescribed altogether
/// has direction 0: it takes no part in the solution, and its pressure is what the law says at its v: 0 if it stays clear, xi if
/// it is pressed in, and undetermined where a rigid foundation has v = 0.
struct ContactNodes : NodePoints {    // a group is a side; `direction` is the normal, prescribed components 0
  DeviceView<double **> normal;       ///< (n, dim) unit normal nu, from the body into the foundation
  DeviceView<double *> gap;           ///< (n) g [m], to the surface without dents
  DeviceView<double *> dent;          ///< (n) w >= 0 [m], what earlier steps have left of dents
  DeviceView<double *> free_gap;      ///< (n) g + w - normal . u_prescribed [m]
  Foundations law;                    ///< (n) the foundation at the dents of earlier steps
  FrictionPoints friction;            ///< (n) friction along the side; empty where no side has any
  DeviceView<double *> scaling;       ///< (n) rho = E / diameter, with the largest E around the node [Pa/m]
  DeviceView<double *> given_penalty; ///< (n) r of the deck [Pa/m], 0 where it is to be chosen
  DeviceView<char *> fixed;           ///< (n) 1 where direction = 0
  GO num_total = 0;                   ///< that have a weight, over all ranks
  GO num_fixed = 0;                   ///< of these, those whose normal displacement is prescribed, over all ranks
  GO num_weightless = 0;              ///< over all ranks
  GO num_missing = 0;                 ///< nodes of the sides, over all ranks, from which the normal misses the obstacle

  int num_sides() const { return num_groups(); }
};

/// What slip counts from: the step before.
struct SlipStart {
  const Vector &displacement; ///< (owned dofs) from 0 [m]
  std::vector<Point> motion;  ///< of each side's foundation since then [m]
};

/// Collective.
/// @param materials  what the body is made of, for `scaling`
/// @param dents      w >= 0 [m] that earlier steps have left, (owned nodes; sides); null: none
/// @param slip_start  null: slip counts from 0, and from foundations that have not moved
/// @throws rpc::Error bad_input if a side does not exist, a number of the law is out of range, the gap is not finite somewhere,
/// the normal leads from no node of a side to its obstacle, which does not move, or a node lies in the foundation and its normal does not cross
/// the foundation's surface (the place is named); no_solution if a prescribed displacement presses a node into a rigid
/// foundation
ContactNodes contact_nodes(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                           const fem::DirichletDofs &dirichlet, const fem::Materials &materials = {},
                           const MultiVector *dents = nullptr, const SlipStart *slip_start = nullptr);

/// The sides of a mesh that the options name.
/// @throws rpc::Error (bad_input) if one does not exist
std::vector<const mesh::Side *> contact_sides(const mesh::Mesh &mesh, const std::vector<ContactOptions> &options);

/// v_i = direction_i . u_i - free_gap_i at one node, for kernels [m].
template <class U>
KOKKOS_INLINE_FUNCTION double penetration(const ContactNodes &c, const LO i, const U &u)
{
  return along_direction(c, i, u) - c.free_gap(i);
}

/// (points) v_i at all nodes; fences [m]. @param u  (owned dofs)
DeviceView<double *> penetrations(const ContactNodes &points, const Vector &u);

/// (owned nodes) How many points each node has; empty without friction, and where no node can have two.
DeviceView<int *> points_of_nodes(const ContactNodes &points, LO num_nodes);

/// Whether a point with friction moves as it likes: its node has no other one, and none of its unknowns is prescribed; for kernels.
/// @param count  points_of_nodes()
KOKKOS_INLINE_FUNCTION bool is_free(const ContactNodes &c, const LO i, const DeviceView<int *> &count)
{
  bool free = !c.fixed(i) && (count.extent(0) == 0 || count(c.node(i)) < 2);
  for (int k = 0; k < c.dim; ++k) free = free && c.friction.free(i, k) != 0;
  return free;
}

/// (I - nu_i nu_i^T) x, the part of a vector along the side at one node, for kernels.
KOKKOS_INLINE_FUNCTION Along along_side(const ContactNodes &c, const LO i, const Along &x)
{
  Along along = x;
  double normal = 0;
  for (int k = 0; k < c.dim; ++k) normal += c.normal(i, k) * x(k);
  for (int k = 0; k < c.dim; ++k) along.x[k] -= normal * c.normal(i, k);
  return along;
}

/// e_i = (I - nu_i nu_i^T) u_i - from_i at one node with friction, for kernels [m]. The difference is projected once more: what rounding of u_i
/// leaves along the normal would come back from the penalty as a traction.                                        (12.2)
template <class U>
KOKKOS_INLINE_FUNCTION Along slip(const ContactNodes &c, const LO i, const U &u)
{
  Along moved;
  for (int k = 0; k < c.dim; ++k) moved.x[k] = u(c.dof(i, k));
  Along e = along_side(c, i, moved);
  for (int k = 0; k < c.dim; ++k) e.x[k] -= c.friction.from(i, k);
  return along_side(c, i, e);
}

} // namespace rpc::contact
