// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/estimator.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/bound/bound.hpp"
#include "rpc/core/quantity.hpp"

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rpc::adapt
{

/// What forces move on one mesh.
struct Motions {
  std::vector<std::array<double, 3>> displacements; ///< of each Dirichlet condition [m]; empty where none is moved
  std::vector<std::array<double, 3>> rotations;     ///< of each rigid side [rad]
  std::vector<std::array<double, 3>> moments;       ///< of each rigid side [N m], in 2D per m
  std::vector<double> arms; ///< of each rigid side: root mean square of how far a rotation of 1 moves its nodes [m]
  Point obstacle{};         ///< how far a force has moved its obstacle [m]
  analysis::Softness softness;
};

/// One mesh of an adaptive run.
struct Cycle {
  std::size_t dofs = 0;
  double estimate = 0;                          ///< of the error in the energy norm, over that of the solution
  double energy = 0;                            ///< J [J], in 2D per m
  double energy_norm_squared = 0;               ///< a(u, u) [J], in 2D per m
  contact::ContactSums contact;                 ///< of all sides
  std::vector<std::array<double, 3>> reactions; ///< of each Dirichlet condition on the body [N], in 2D per m
  Motions motions;
  double pressure_change = 0;        ///< of the contact pressure since the mesh before, over its norm, both in L2
  double recovered_pressure = 0;     ///< |contact pressure - that of the recovered stress| / |contact pressure|, in L2
  double recovered_max_pressure = 0; ///< largest difference of the two where the pressure is near its maximum [Pa]
  PressurePeak peak;
  double contact_ends = 0;                    ///< of facets that are partly open, half of them [m]
  double ends_force = 0;                      ///< see ErrorEstimate [N], in 2D per m
  double jumped_force = 0, jumped_energy = 0; ///< see ErrorEstimate [N], [J], in 2D per m
  double misread_force = 0, misread_energy = 0, misread_penetration = 0; ///< the same, and [m]
  double interpolated = 0;                                               ///< the same [J], in 2D per m
  /// That is left [m]; < 0 where a side lies in the foundation between its nodes.
  double smallest_gap = std::numeric_limits<double>::infinity();
  double max_displacement = 0; ///< [m]
  bool misses_contact = false; ///< contact that no contact point sees is most of the estimate, (10.4b)
  int newton_iterations = 0;
  std::vector<int> linear_iterations;      ///< per solve
  std::optional<bound::EnergyBound> bound; ///< where it is asked for
  double seconds = 0;
};

/// Errors of what forces move, and of moments, each like the number that it belongs to; where that of the contact force is known.
struct MotionErrors {
  std::vector<double> displacements; ///< of each Dirichlet condition, 2-norm [m]; empty where no force moves a side
  std::vector<double> rotations, moments; ///< of each rigid side, 2-norm [rad], [N m], in 2D per m
  double obstacle = 0;                    ///< of the displacement of the one that a force moves, 2-norm [m]
};

/// Errors of results as the sequence of meshes shows them, and for pressures the recovered stress if that shows more; each
/// like the number that it belongs to. NaN where the meshes do not tell, as from one alone. doc/theory.md (10.7), (10.8)
struct ObservedErrors {
  double energy = 0;        ///< of J
  double contact_force = 0; ///< 2-norm
  double max_pressure = 0;
  double contact_pressure = 0; ///< L2 norm over the contact sides, over that of the pressure
  double contact_length = 0;
  double max_penetration = 0;
  std::vector<double>
      reactions; ///< of the force of each Dirichlet condition, 2-norm; where that of the contact force is known
  MotionErrors motions;
  std::map<std::string, std::string> unknown; ///< why, by the key in the table below, for those that are NaN
};

inline constexpr std::array<Quantity<ObservedErrors>, 6> error_bars{{
    {&ObservedErrors::energy, "energy_J", unit::energy, Combine::maximum, {true}},
    {&ObservedErrors::contact_force, "contact_force", unit::force, Combine::maximum, {true}},
    {&ObservedErrors::max_pressure, "max_pressure", unit::pressure, Combine::maximum, {true}},
    {&ObservedErrors::contact_pressure, "contact_pressure_l2_relative", unit::none, Combine::maximum, {true}},
    {&ObservedErrors::contact_length, "contact_length", unit::extent, Combine::maximum, {true}, "contact_area"},
    {&ObservedErrors::max_penetration, "max_penetration", unit::length, Combine::maximum, {true}},
}};
static_assert(sizeof(ObservedErrors) == error_bars.size() * sizeof(double) + sizeof(std::vector<double>) +
                                            sizeof(MotionErrors) + sizeof(std::map<std::string, std::string>),
              "an error bar has no line in the table");

/// The name in the files of the number that an error bar belongs to.
/// @param key  of error_bars
std::string error_bar_name(const std::string &key, const ResultScope &scope);

/// What a mesh leaves open.
struct LeftOpen {
  double force = 0, energy = 0; ///< [N], [J], in 2D per m
  double penetration = 0;       ///< of the largest [m]
};

/// By reading a gap at nodes that jumps or has a kink between them.                                  doc/theory.md (3.16a)
LeftOpen left_by_misreading(const Cycle &cycle);

/// By that, by the gap's interpolant, and by other data of the contact law that jump between nodes.
/// doc/theory.md (3.16b), (10.7b)
LeftOpen left_by_jumps(const Cycle &cycle);

/// What one mesh by itself leaves open of J: no bar is smaller [J], in 2D per m.                     doc/theory.md (10.7a), (10.7b)
double energy_left(const Cycle &cycle);

inline constexpr const char *unseen_by_mesh =
    "the mesh misses contact between its nodes, which is most of the estimated error"; ///< a reason in `unknown`
inline constexpr const char *one_mesh = "one mesh shows no change";                    ///< a reason in `unknown`

inline constexpr const char *may_touch =
    "nothing touches on this mesh, and the smallest gap that is left is within its error"; ///< a reason in `unknown`
inline constexpr const char *may_be_open =
    "all pressures together are within the error of the contact force, so that the body may not touch"; ///< the same

/// Which forces the load alone fixes.
struct FixedByLoad {
  std::array<bool, 3>
      contact{}; ///< components without a prescribed displacement, or along which a force moves the obstacle
  std::vector<bool> reactions = {}; ///< of each Dirichlet condition: all components; empty: none
  std::vector<bool> moments = {};   ///< of each rigid side
  Point springs{};                  ///< stiffness of those that the obstacle lies on, along each coordinate [N/m]
};
FixedByLoad fixed_by_load(const analysis::Model &model);

/// Error bars of the components of the contact force, of several meshes: of those that the load fixes what the meshes show, along a spring its
/// stiffness times that of the obstacle's way, and no more than that of the vector. Empty where this is not known.      doc/theory.md (10.7f)
/// @param errors  of the last mesh   @param tolerance  as below
std::vector<double> contact_force_bars(const std::vector<Cycle> &cycles, const ObservedErrors &errors,
                                       const FixedByLoad &fixed, double tolerance);

/// Error bars of the last of several meshes.
/// @param fixed      a contact force that has no other components has but the error that the meshes show
/// @param tolerance  of its equilibrium, relative: less is rounding, and the bar 0
ObservedErrors observed_errors(const std::vector<Cycle> &cycles, const FixedByLoad &fixed = {}, double tolerance = 0);

/// All load steps up to the last one on a mesh with larger cells: what the meshes of earlier steps have left shows by how much the results of the
/// two differ.                                                                                            doc/theory.md (10.7c)
struct CoarserHistory {
  Cycle last;                  ///< of the last step
  double largest_estimate = 0; ///< of its steps, of the error in the energy norm [J^(1/2)]
  std::string missing;         ///< why there is none; else empty
};

/// What counts of the load steps up to one.
struct EarlierSteps {
  bool matter = false;         ///< they have left dents or slip
  double largest_estimate = 0; ///< of all steps, of the error in the energy norm [J^(1/2)]
  double moved_by = 0;         ///< by how much the load moved in the mean, where it moved most [m]
  LeftOpen misread{};          ///< left_by_misreading(): the most of one of them, the last one left out
};

/// The same for the last of several load steps.
ObservedErrors observed_errors(std::vector<Cycle> cycles, const CoarserHistory &coarser, const EarlierSteps &earlier,
                               const FixedByLoad &fixed = {}, double tolerance = 0);

/// Of an error in the energy norm, over that of the solution.
double relative_bound(const bound::EnergyBound &bound, double energy_norm_squared);

/// The mesh with the least error, by its guaranteed bound where it has one, else by its estimate; with the target met that is the last one.
std::size_t best_of(const std::vector<Cycle> &cycles);

/// What became of "Adapt".
struct Adaptation {
  bool reached = false;      ///< the target
  std::string reason;        ///< why not, or why the first mesh is the answer: energy at rounding level; else empty
  std::vector<Cycle> cycles; ///< from the first mesh
  ObservedErrors errors;     ///< of the one whose results these are
};

} // namespace rpc::adapt
