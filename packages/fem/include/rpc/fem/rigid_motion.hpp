// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/parts.hpp"

#include <array>
#include <string>
#include <vector>

namespace rpc::fem
{

/// A rigid motion of one part, r(x) = sum_k q_k r_k(x), or, as its dual, a force in N with its moment over the part's
/// radius: 3 numbers in 2D, 6 in 3D, the rest 0.                                                doc/theory.md (9.1)
///
/// First the translations, then the rotations in the planes of (x_i, x_j), i < j, about the part's centre, over its
/// radius: all modes are of size 1.
using RigidMotion = std::array<double, 6>;

inline int num_rigid_modes(const int dim)
{
  return dim == 2 ? 3 : 6;
}

inline double dot(const RigidMotion &a, const RigidMotion &b)
{
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

/// out_k = f . r_k(x): the component of a force f at x along each mode.                                doc/theory.md (9.1)
/// @param arm  (dim) (x - centre)/radius of the part
/// @param out  (6)
KOKKOS_INLINE_FUNCTION void along_modes(const int dim, const double *arm, const double *f, double *out)
{
  int mode = dim;
  for (int i = 0; i < dim; ++i) out[i] = f[i];
  for (int i = 0; i < dim; ++i)
    for (int j = i + 1; j < dim; ++j) out[mode++] = f[j] * arm[i] - f[i] * arm[j];
  for (; mode < 6; ++mode) out[mode] = 0;
}

/// Rows that span all the others: the remainder of each, orthogonal to the ones before it, is above `tolerance`. At most 6.
/// Picks the largest remainder first, as QR with pivoting does.
std::vector<RigidMotion> independent_rows(const std::vector<RigidMotion> &rows, double tolerance);
/// The same over the rows of all ranks, in several lists at once; the result is the same on all ranks. Collective.
std::vector<std::vector<RigidMotion>>
independent_rows_of_all(const Comm &comm, const std::vector<std::vector<RigidMotion>> &rows, double tolerance);
/// Orthonormal basis of the motions within the span of `space` (orthonormal) on which all independent rows vanish.
std::vector<RigidMotion> null_space(const std::vector<RigidMotion> &rows, const std::vector<RigidMotion> &space,
                                    double tolerance);

/// Orthonormal basis of all motions: of an axisymmetric body the one along its axis, all others strain it.
std::vector<RigidMotion> all_motions(int dim, Kinematics kinematics = Kinematics::plane_strain);
/// The same of a body. A periodic box cannot turn in a plane with a direction in which it repeats itself.
std::vector<RigidMotion> all_motions(const Discretization &d);

/// Below this a row of size 1 is rounding: a part that is held on 1e-8 of its length counts as hinged.
constexpr double rigid_tolerance = 1e-8;

/// For each part the rigid motions that no prescribed unknown stops, an orthonormal basis; none if it is held.   (9.2)
/// Collective.
std::vector<std::vector<RigidMotion>> free_motions(const Discretization &d, const Parts &parts,
                                                   const DirichletDofs &dirichlet);

/// The forces on each part along its modes.
struct Resultant {
  RigidMotion force{};  ///< [N], moments over the radius; in the plane per m
  double magnitude = 0; ///< sum of the sizes of all its terms [N]: 1e-16 of it is rounding
};
/// @param force  (owned dofs) [N]; collective
std::vector<Resultant> resultants(const Discretization &d, const Parts &parts, const Vector &force);

/// u less the rigid motion that is nearest, in the mean square, to its prescribed values; an axisymmetric body moves along its
/// axis only. Strain energy does not see that motion, but rounding does.                        doc/theory.md (5.4)
/// @param u  (owned dofs) [m]; collective
Vector without_rigid_motion(const Discretization &d, const DirichletDofs &dirichlet, const Vector &u);

/// u + rest less the rigid motion that is nearest to u, with the error that one rounding of the result makes: a body that hardly strains
/// and moves far has forces and strains of that alone.                                          doc/theory.md (5.2a)
/// @param rest  (owned dofs) what the rounding of u has left out [m]; collective
Vector strained_part(const Discretization &d, const Vector &u, const Vector &rest);

/// The same motions by a basis that reads well: translations, along the axes if possible, then rotations.
std::vector<RigidMotion> readable_basis(std::vector<RigidMotion> motions, int dim);

/// A rigid motion in words.
struct MotionInWords {
  bool rotates = false;
  /// "along (1, 0)"; "about (2, 0), counterclockwise"; in 3D "about the axis through (..) along (..)".
  std::string where;
  double size = 0; ///< |t|, or the angle |omega| [1/m]: b.q/size is a force [N] or a moment [N m]

  std::string text() const { return (rotates ? "rotation " : "translation ") + where; }
};
MotionInWords in_words(const RigidMotion &q, const Part &part, int dim);
/// "(2, 0)": a place beside a part, to as many digits as searches for motions know.
std::string place_in_words(const Point &x, const Part &part, int dim);

} // namespace rpc::fem
