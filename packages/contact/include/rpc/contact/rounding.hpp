// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::contact
{

/// What counts as rounding; no number here steers a decision. Relative, but where the subject says otherwise.
struct Rounding {
  static constexpr double depth = 1e-12; ///< of what lies in the foundation between nodes, over the body's diameter
  static constexpr double gap =
      1e-30; ///< over the diameter: the tail of an exponential is no gap, and no overlap to solve for
  static constexpr double full_use = 1 - 1e-9; ///< of the friction bound: from here on a point slips
  static constexpr double place = 1e-9; ///< of places within a facet, and of positions and directions of obstacles
  static constexpr double rank = 1e-10; ///< of singular values of the acceleration of friction bounds
  static constexpr double sum = 1e-12; ///< of sums, and of prescribed displacements and gaps that are meant to be equal
  static constexpr double direction = 1e-16; ///< squared length of what is left of a unit vector: it is no direction
  static constexpr double speed = 1e-14;     ///< of a point in a motion, over the motion
  static constexpr double pressed = 1e-10; ///< the same, of the point that a motion presses in most: it presses none in
  static constexpr double face = 1e-14;    ///< of singular values of a face of a convex set
  static constexpr double furthest = 1e-13; ///< of a point that lies further out than a face of a convex set
  /// Of forces and energies against those of prescribed displacements on a body that stays behind: below it the body moves as a whole.
  static constexpr double lifted_part = 1e-7;
};

} // namespace rpc::contact
