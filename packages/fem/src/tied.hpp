// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/dirichlet.hpp"

#include <memory>
#include <vector>

namespace rpc::fem
{

/// @throws rpc::Error (bad_input) where a force is to move a point, or a side along the radius of a body of revolution
void require_movable(const Discretization &d, const std::vector<DirichletCondition> &conditions);

/// The rigid sides of the deck on a mesh. Collective.
/// @throws rpc::Error (bad_input) where one is a point, or too thin for its rotations
std::vector<RigidSide> rigid_sides(const Discretization &d, const std::vector<DirichletCondition> &conditions);

/// How far an unknown mode of a rigid side, a column of the motions times T, moves a node along a component.            (2.9b)
double along_mode(const RigidSide &side, int mode, const double *arm, int component);

/// (groups, groups) += the stiffness of the rigid sides' springs against tied unknowns.
void add_springs(const std::vector<RigidSide> &sides, int groups, std::vector<double> &stiffness);

/// A force, moment or motion of the whole side. @throws rpc::Error (bad_input) if it is not finite
double finite_value(const ScalarField &given, const std::string &parameter);

/// The unknowns that forces move as one; null where there are none. The rigid sides get their groups. Collective.
/// @param condition  see DirichletDofs
std::shared_ptr<const TiedUnknowns> tied_unknowns(const Discretization &d,
                                                  const std::vector<DirichletCondition> &conditions,
                                                  const DeviceView<int *> &condition, std::vector<RigidSide> &rigid);

/// Prescribed values of members lose what tied unknowns can do: u . f of a force that is one of groups has none of them. The rigid sides get their
/// starts. Collective.                                                                                              (2.9b)
void part_from_modes(const TiedUnknowns &tied, std::vector<RigidSide> &rigid, Vector &value);

/// What prescribed motions do at the springs of the sides: load += forces on tied unknowns. @return the energy [J]; collective
double add_spring_starts(const DirichletDofs &dirichlet, Vector &load);

} // namespace rpc::fem
