// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/load_history.hpp"
#include "rpc/core/quantity.hpp"

#include <array>

/// The numbers of a run beside those of its contact sides, contact::contact_quantities. The order is that of the summary.
namespace rpc::analysis
{

/// Wall-clock time of a run's phases [s], of an adaptive one on all meshes.
struct PhaseSeconds {
  double mesh = 0, assembly = 0, prediction = 0, setup = 0, solve = 0, estimate = 0, output = 0, total = 0;

  PhaseSeconds &operator+=(const PhaseSeconds &other);
};

inline constexpr std::array<Quantity<PhaseSeconds>, 8> phase_seconds{{
    {&PhaseSeconds::mesh, "mesh", unit::second, Combine::sum, {true, 0, "time", "mesh "}},
    {&PhaseSeconds::assembly, "assembly", unit::second, Combine::sum, {true, 0, "time", "assembly "}},
    {&PhaseSeconds::prediction, "prediction", unit::second, Combine::sum, {true, 0, "time", "prediction "}},
    {&PhaseSeconds::setup, "setup", unit::second, Combine::sum, {true, 0, "time", "set-up "}},
    {&PhaseSeconds::solve, "solve", unit::second, Combine::sum, {true, 0, "time", "solve "}},
    {&PhaseSeconds::estimate, "estimate", unit::second, Combine::sum, {true, 0, "time", "estimate "}},
    {&PhaseSeconds::output, "output", unit::second, Combine::sum, {true, 0, "time", "output "}},
    {&PhaseSeconds::total, "total", unit::second, Combine::sum, {true, 0, "time", "total "}},
}};
static_assert(sizeof(PhaseSeconds) == phase_seconds.size() * sizeof(double), "a phase has no line in the table");

inline constexpr std::array<Quantity<Energies>, 6> energy_quantities{{
    {&Energies::strain, "strain_energy", unit::energy, Combine::sum, {true, 1, "since the start", "strain "}},
    {&Energies::foundation,
     "foundation_energy",
     unit::energy,
     Combine::sum,
     {true, 2, "since the start", "foundation "}},
    {&Energies::dissipated,
     "dissipated_energy",
     unit::energy,
     Combine::sum,
     {true, 3, "since the start", "dissipated "}},
    {&Energies::work, "work", unit::energy, Combine::sum, {true, 4, "since the start", "work "}},
    {&Energies::imbalance, "energy_imbalance", unit::energy, Combine::sum, {true, 5, "since the start", "imbalance "}},
    {&Energies::friction,
     "dissipated_by_friction",
     unit::energy,
     Combine::sum,
     {true, 6, "since the start", "friction "},
     nullptr,
     Needs::friction},
}};
static_assert(sizeof(Energies) == energy_quantities.size() * sizeof(double), "an energy has no line in the table");

/// The body's largest numbers.
inline constexpr std::array<Quantity<fem::BodyPeaks>, 3> body_quantities{{
    {&fem::BodyPeaks::displacement,
     "max_displacement",
     unit::length,
     Combine::maximum,
     {true, 1, "body", "displacement at most "}},
    {&fem::BodyPeaks::strain, "max_strain", unit::none, Combine::maximum, {true, 2, "body", "strain "}},
    {&fem::BodyPeaks::von_mises, "max_von_mises", unit::pressure, Combine::maximum, {true, 3, "body", "von Mises "}},
}};
static_assert(sizeof(fem::BodyPeaks) == body_quantities.size() * sizeof(double), "a number has no line in the table");

/// In how many parts a step was solved, and by how many solves.
inline constexpr std::array<Quantity<StepRecord, int>, 2> step_parts{{
    {&StepRecord::parts, "parts", unit::none, Combine::sum, {true, 3}},
    {&StepRecord::solves, "solves", unit::none, Combine::sum, {true}},
}};

/// What a step took.
inline constexpr std::array<Quantity<StepRecord, int>, 4> step_work{{
    {&StepRecord::newton_iterations, "newton_iterations", unit::none, Combine::sum, {true, 1}},
    {&StepRecord::linear_solves, "linear_solves", unit::none, Combine::sum, {true}},
    {&StepRecord::linear_iterations, "linear_iterations", unit::none, Combine::sum, {true, 2}},
    {&StepRecord::preconditioner_setups, "preconditioner_setups", unit::none, Combine::sum, {true}},
}};

/// Residuals of a solution, those by which it is judged.
inline constexpr std::array<Quantity<contact::OptimalityResiduals>, 4> residual_quantities{{
    {&contact::OptimalityResiduals::kkt_residual,
     "kkt_residual",
     unit::none,
     Combine::maximum,
     {true, 0, "optimality", "kkt "}},
    {&contact::OptimalityResiduals::equilibrium_residual,
     "equilibrium_residual",
     unit::none,
     Combine::maximum,
     {true, 0, "optimality", "equilibrium "}},
    {&contact::OptimalityResiduals::energy_balance,
     "energy_balance",
     unit::none,
     Combine::maximum,
     {true, 0, "optimality", "energy balance "}},
    {&contact::OptimalityResiduals::duality_gap,
     "duality_gap",
     unit::none,
     Combine::maximum,
     {true, 0, "optimality", "duality gap "}},
}};

/// Which numbers a scene has on a mesh.
ResultScope result_scope(const Model &model, const fem::Discretization &d);

} // namespace rpc::analysis
