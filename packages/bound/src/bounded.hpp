// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells.hpp"
#include "contact_pressure.hpp"
#include "rpc/bound/bound.hpp"
#include "space_contact.hpp"

#include <functional>
#include <string>
#include <vector>

/// What the bounds in the plane, of tetrahedra and of hexahedra leave for intervals of functionals of the solution.
namespace rpc::bound
{

/// Of displacements (owned dofs) of a problem, which has to be there while they are called. Collective.
struct Works {
  std::function<double(const Vector &)> of_loads; ///< their work [J], in 2D per m
  std::function<double(const Vector &)> of_all;   ///< that of loads and contact's tractions
  std::function<Squared(const Vector &)> squared; ///< bounds of |w|^2
};

template <class Side>
struct Bounded {
  EnergyBound bound;       ///< without functionals
  std::vector<Side> sides; ///< of contact
  Works works;             ///< of_loads also where there is no bound
  RCP<const Vector> u;     ///< (owned dofs) u^
  double squared = 0;      ///< |u^|^2 [J]
  double rho = 0;          ///< of (13.13) [J^(1/2)], in 2D per m
};

/// @param steps  of conjugate gradients, see energy_bound()   @param facets  space_facets_of() the tetrahedra
/// @param flat  sides on which displacements of hexahedra are linear on halves of faces
Bounded<ContactFacets> bounded_in_plane(const analysis::Problem &problem, const analysis::StepSolution &solution,
                                        const solver::LinearSolverOptions &options, int steps);
Bounded<SpaceContact> bounded_in_space(const analysis::Problem &problem, const analysis::StepSolution &solution,
                                       const solver::LinearSolverOptions &options, int steps, const SpaceFacets &facets,
                                       const std::vector<std::string> &flat);

} // namespace rpc::bound
