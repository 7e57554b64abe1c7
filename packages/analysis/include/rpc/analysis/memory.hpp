// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_state.hpp"
#include "rpc/contact/moving_dents.hpp"
#include "rpc/fem/discretization.hpp"

#include <vector>

namespace rpc::analysis
{

/// Energies since the first step began [J], in 2D per m. doc/theory.md (11.3)
struct Energies {
  double strain = 0; ///< a(u, u)/2
  double foundation =
      0; ///< in the foundation's springs, sum of w c p^2/2; where dents do not stay all that denting took
  double dissipated = 0; ///< sum of w int (xi + H w) dw
  double work = 0;      ///< of loads, prescribed displacements and the foundation's own motion, by the trapezoidal rule
  double imbalance = 0; ///< work - strain - foundation - dissipated - friction: error of the trapezoidal rule alone
  double friction = 0;  ///< dissipated by slip, by the trapezoidal rule                                       (12.9)

  double largest() const; ///< of all but the imbalance, in size
};

/// What a step leaves for the next one: plain data on its mesh. doc/theory.md, section 11
struct Memory {
  double time = 0;
  RCP<const Vector> displacement;  ///< (owned dofs) from 0 [m]
  RCP<const MultiVector> pressure; ///< (owned nodes; sides) [Pa]
  RCP<const MultiVector> dent; ///< (owned nodes; sides) w, 0 where a side does not remember or its dents move with the
                               ///< foundation [m]
  RCP<const MultiVector> gap;  ///< (owned nodes; sides) g, to the surface without dents; where points move along dents,
                               ///< to the surface with those that they stand on [m]
  Energies energies;
  double energy_scale = 0; ///< S of (5.5b): later energies are judged as shares of it [J], in 2D per m
  RCP<const MultiVector>
      tangential; ///< (owned nodes; sides x dim) multipliers along the side [Pa]; null: the law has none
  std::vector<contact::FoundationDents> foundations; ///< by side; empty: none has a dent
  Point obstacle{};                                  ///< how far a force has moved its obstacle [m]
};

/// What is remembered, on another mesh of the same body: by interpolation; dents stay >= 0. Collective.
Memory interpolated(const Memory &memory, const fem::Discretization &from, const fem::Discretization &to);
/// @param interpolation  (owned nodes of the other mesh x owned nodes), see fem::interpolation()
Memory interpolated(const Memory &memory, const Operator &interpolation, const fem::Discretization &to);

/// What is remembered as a state to start from.
contact::ContactState state_of(const contact::ContactNodes &points, const Memory &memory);
/// Linear extrapolation of two steps to a later time.
contact::ContactState extrapolated(const contact::ContactNodes &points, const Memory &before, const Memory &last,
                                   double time);

} // namespace rpc::analysis
