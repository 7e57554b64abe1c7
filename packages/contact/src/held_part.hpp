// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/nearest_point.hpp"
#include "rpc/fem/rigid_motion.hpp"

#include <vector>

namespace rpc::contact
{

/// What the foundation can do along the rigid motions of the parts, at the contact nodes.         doc/theory.md (9.4)
struct Reactions {
  DeviceView<double *[6]> along; ///< (n) m_i . r_k(x_i), of the node's own part; 0 where it takes no part in contact
  DeviceView<double *> limit;    ///< (n) w_i xi_i [N], inf where rigid or hardening
  /// (n) (I - nu nu^T) r_k(x_i), row by component, where friction acts; empty where there is none.                  (12.10)
  DeviceView<double *[3][6]> slide;
  FrictionPoints friction;      ///< (n)
  DeviceView<double *> weight;  ///< (n)
  DeviceView<int *> part;       ///< (n) -1 where the node takes no part in contact
  std::vector<double> strength; ///< (parts) sum of the finite limits [N]
};
/// Collective.
Reactions reactions_of(const fem::Discretization &d, const fem::Parts &parts, const ContactNodes &contact);

/// One part of the body with the rigid motions that only contact can stop, and the set Z of what the foundation can do
/// against them, in coordinates of their orthonormal basis. (9.4)
class HeldPart
{
public:
  HeldPart(const Comm &comm, const Reactions &reactions, int part, std::vector<fem::RigidMotion> motions);

  /// sum_j q_j motions_j
  fem::RigidMotion motion(const std::vector<double> &q) const;
  /// force . motions_j
  std::vector<double> coordinates(const fem::RigidMotion &force) const;
  /// How far Z goes along q. (9.5); collective
  Furthest furthest(const std::vector<double> &q) const;
  /// sum of w (p m + q) along the modes over the nodes from `begin` to `end`, with the p and q that do most against the motion; nodes
  /// with a finite yield stress that it presses into the foundation, and friction [N]; collective
  fem::RigidMotion carried(const fem::RigidMotion &motion, LO begin, LO end) const;
  /// The same over all nodes.
  fem::RigidMotion carried(const fem::RigidMotion &motion) const;
  int part() const { return part_; }

private:
  const Comm &comm_;
  const Reactions &reactions_;
  int part_;
  std::vector<fem::RigidMotion> motions_;
};

} // namespace rpc::contact
