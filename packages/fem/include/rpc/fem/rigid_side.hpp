// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"
#include "rpc/core/point.hpp"
#include "rpc/core/tpetra.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace rpc::fem
{

/// A number for each motion of a rigid side: displacements of its reference point along X, Y, Z [m], then rotations about these axes
/// [rad]; or forces [N], then moments about that point [N m].
using SixNumbers = std::array<double, 6>;

/// How far motion k of a rigid side moves a node along component c: u = q + theta x (x - reference point).      doc/theory.md (2.9b)
/// @param arm  (3) of the node from the reference point
KOKKOS_INLINE_FUNCTION double along_motion(const int k, const double *const arm, const int c)
{
  if (k < 3) return k == c ? 1 : 0;
  const int axis = k - 3;
  if (c == (axis + 1) % 3) return -arm[(axis + 2) % 3];
  return c == (axis + 2) % 3 ? arm[(axis + 1) % 3] : 0;
}

/// What a deck's entry of `Rigid` gives. A motion without a displacement is unknown; without a force and a stiffness it is free of force.
struct RigidMotions {
  std::vector<int>
      motions; ///< that the body has: of a plane one X, Y and Rotation Z, of one of revolution Y, in space all six
  std::optional<Point> point;                               ///< of reference; the side's centroid if absent
  std::array<std::optional<ScalarField>, 6> displacement{}; ///< [m], [rad]; of time alone
  std::array<std::optional<ScalarField>, 6> force{};        ///< [N], [N m]; of time alone
  SixNumbers stiffness{};                                   ///< of springs to the ground [N/m], [N m/rad]

  std::vector<int> unknown() const;
  /// Whether an unknown motion moves nodes along a component.
  bool moves(int component) const;
  RigidMotions seen_at(double t) const;
};

/// "X", "Rotation Z".
std::string name_of_motion(int motion);
/// "Force X", "Moment Z".
std::string name_of_force(int motion);
/// "Stiffness X", "Rotation Stiffness Z".
std::string name_of_stiffness(int motion);

/// A rigid side on a mesh. Its nodes move by its motions q alone; those that are not prescribed are q = T z - o with tied unknowns z.
struct RigidSide {
  int condition = 0;
  std::vector<int> motions, unknown; ///< of RigidMotions
  Point point{};                     ///< of reference
  LO num_components = 0;             ///< of a node
  DeviceView<LO *> node;             ///< (nodes) this rank's owned ones
  DeviceView<double *> arm;          ///< (3 nodes) from the reference point
  std::vector<double> products;      ///< (motions, motions) of the displacements of the nodes of all ranks
  int first_group = 0;               ///< of TiedUnknowns, which has one for each unknown motion
  std::vector<double> to_motions;    ///< (unknown, unknown) T, upper triangular, row after row
  std::vector<double> start;         ///< (unknown) z at which the unknown motions are 0: o = T start
  std::vector<double> stiffness;     ///< (unknown)
};

/// (owned dofs) f += forces on the nodes of a side with given resultants: their work is sum_k given_k q_k where the side moves by q.  (2.9c)
void add_resultants(const RigidSide &side, const SixNumbers &given, Vector &f);
/// The motions that are nearest to a displacement of a side, in the mean square over its nodes; collective.
SixNumbers motions_of(const RigidSide &side, const Vector &u);
/// Resultant and moment about the reference point of the forces on a side's nodes that its condition holds; collective.
/// @param condition  see DirichletDofs
SixNumbers resultants_on(const RigidSide &side, const DeviceView<int *> &condition, const Vector &f);

/// f -= the forces with which springs draw sides that are displaced by u; collective.
void subtract_spring_forces(const std::vector<RigidSide> &sides, const Vector &u, Vector &f);
/// Energy of these springs [J]; collective.
double spring_energy(const std::vector<RigidSide> &sides, const Vector &u);

} // namespace rpc::fem
