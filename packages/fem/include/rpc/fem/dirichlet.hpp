// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/algebra/tied_stiffness.hpp"
#include "rpc/core/field.hpp"
#include "rpc/fem/discretization.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/rigid_side.hpp"

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rpc::fem
{

/// Prescribed displacement on one side or at points, paper (2) with values other than 0 too; a component of neither a displacement nor a
/// force is free.
struct DirichletCondition {
  std::string name;                                       ///< of the entry in the deck, for messages
  std::string side;                                       ///< or a name of mesh::Mesh::points
  std::array<std::optional<ScalarField>, 3> displacement; ///< [m]
  /// On the whole side, which moves along that component as one [N]; of time alone.
  std::array<std::optional<ScalarField>, 3> force{};
  std::optional<RigidMotions> rigid{}; ///< instead of both, for an entry of `Rigid`
  /// Components along which all sides that are held at 0 move as one, by one force: seen from an obstacle that a force moves.   (3.17)
  std::array<bool, 3> floats{};
  std::array<double, 3>
      float_stiffness{}; ///< of the spring to the ground on which all that floats hangs [N/m]  (3.17e)

  /// Whether the side's nodes are not free along a component.
  bool holds(const int component) const { return rigid || displacement[component] || force[component]; }
  /// Whether the side's nodes move as one along a component, as far as forces move them.
  bool moves(const int component) const { return rigid ? rigid->moves(component) : force[component].has_value(); }
  /// Whether a force moves the side.
  bool is_moved() const { return rigid ? !rigid->unknown().empty() : force[0] || force[1] || force[2]; }
  /// Of the entry in the deck.
  std::string path() const { return (rigid ? "Rigid->" : "Dirichlet->") + name; }
};

/// A component of a side that a force moves: a group of tied unknowns.
struct MovedByForce {
  int condition, component;
};
/// In the order of the groups, which those of rigid sides follow.
std::vector<MovedByForce> moved_by_force(const std::vector<DirichletCondition> &conditions);

/// Parameters of the deck's `Dirichlet` sublist.
Teuchos::ParameterList valid_dirichlet_parameters();
/// @throws rpc::Error (bad_input) if an entry prescribes nothing
std::vector<DirichletCondition> dirichlet_options(const Teuchos::ParameterList &list, int dim,
                                                  const FieldParser &parse);

/// Parameters of the deck's `Rigid` sublist.
Teuchos::ParameterList valid_rigid_parameters();
/// @throws rpc::Error (bad_input) on motions that the body does not have, or that are given twice
std::vector<DirichletCondition> rigid_options(const Teuchos::ParameterList &list, int dim, Kinematics kinematics,
                                              const FieldParser &parse);

/// Which unknowns are prescribed, and their values. Those that a force moves as one are among them, with the value 0; of
/// a rigid side what its prescribed motions do, less what its unknown ones can do.
struct DirichletDofs {
  DeviceView<char *> fixed; ///< (overlap dofs) 1 where prescribed
  DeviceView<int *>
      condition;     ///< (owned dofs) index of the condition that prescribes it, the last of several; -1 if free, or
                     ///< held by the axis of an axisymmetric body
  RCP<Vector> value; ///< (owned dofs) [m], 0 where free
  GO num_fixed = 0;  ///< over all ranks
  std::shared_ptr<const TiedUnknowns>
      tied; ///< those that forces move, a group for each component of a side, for each component along which sides float, and for each motion of a rigid side; null: none
  std::vector<RigidSide> rigid;        ///< of the deck's `Rigid`
  std::vector<double> float_stiffness; ///< (components along which sides float) of springs to the ground [N/m]
  int first_floating = 0;              ///< group of the first of these components

  bool has_springs() const;
};

/// u_r = 0 on the axis of an axisymmetric body is prescribed without a condition. Collective.
/// @throws rpc::Error (bad_input) if a side does not exist, a value is NaN or infinite, two conditions prescribe different
///         values at one node, one another radial displacement on the axis, or a force moves what is no side, what another
///         condition holds, or along the radius
DirichletDofs dirichlet_dofs(const Discretization &d, const std::vector<DirichletCondition> &conditions);

/// A force f, (owned dofs), becomes what moves the body: 0 where displacements are prescribed, at tied unknowns the mean over their
/// group. Collective; fences.                                                                        (2.9a)
void clear_prescribed(const DirichletDofs &dirichlet, Vector &f);

/// The entries of a stiffness matrix in the columns of prescribed unknowns, (K_FD; K_DD), row after row: what a step with other
/// prescribed values needs of them. Which unknowns are prescribed is fixed.
struct PrescribedCouplings {
  DeviceView<LO *> row;            ///< (rows) owned dofs with such entries, ascending
  DeviceView<std::size_t *> begin; ///< (rows + 1) where a row's entries begin
  DeviceView<LO *> column;         ///< (entries) overlap dofs
  DeviceView<double *> value;      ///< (entries)
};

/// A stiffness matrix without the couplings of prescribed unknowns, and these couplings.
struct EliminatedStiffness {
  RCP<CrsMatrix> matrix; ///< K_FF, and the diagonal of K_DD; symmetric positive definite if rigid motions are held
  PrescribedCouplings couplings;
};

/// Eliminates the prescribed unknowns from both rows and columns: the diagonal stays.    paper (2), doc/theory.md (2.9)
/// @param K  becomes the matrix; collective   @param prescribed  (overlap dofs) 1 where the displacement is
EliminatedStiffness eliminate_dirichlet(const Discretization &d, RCP<CrsMatrix> K,
                                        const DeviceView<char *> &prescribed);

/// The same of a matrix that is not assembled, for most of its rows repeat those of a few nodes.
struct RepeatedStiffness {
  RepeatedRows rows; ///< without the couplings of prescribed unknowns
  PrescribedCouplings couplings;
};

/// @return nothing for mixed elements, where less than three quarters of the rows repeat on any rank, or where the assembly would complain; collective
std::optional<RepeatedStiffness> repeated_stiffness(const Discretization &d, const Materials &materials,
                                                    const DeviceView<char *> &prescribed);

/// The discrete elastic problem with its boundary conditions built in: find u with K u = load, where nothing touches and K is without
/// the couplings of prescribed unknowns.
struct ElasticProblem {
  RCP<Vector> load;         ///< with the forces of prescribed displacements [N]
  RCP<Vector> applied_load; ///< [N]
  DirichletDofs dirichlet;
  RCP<const TiedStiffness> stiffness_of_tied; ///< null: there are no tied unknowns
  double energy_offset =
      0; ///< Pi(u) = u.(K u)/2 - load.u + energy_offset, Pi being that of the problem before elimination [J]
};

/// The problem of one load and one set of prescribed values; costs no more than a few vectors. Collective. (2.9)
/// @param applied_load  (owned dofs) [N]
/// @param dirichlet     of the unknowns that were eliminated
ElasticProblem elastic_problem(const Discretization &d, const PrescribedCouplings &couplings, RCP<Vector> applied_load,
                               DirichletDofs dirichlet);

/// f -= the forces with which springs draw what they hold to the ground, where the body is displaced by u; collective.
void subtract_spring_forces(const DirichletDofs &dirichlet, const Vector &u, Vector &f);

/// load += the forces that move sides as one, in equal parts on their nodes. Collective.
/// @throws rpc::Error (bad_input) if one is not finite
void add_moving_forces(const DirichletDofs &dirichlet, const std::vector<DirichletCondition> &conditions, Vector &load);

/// Forces and moments that the deck gives a rigid side at its time. @throws rpc::Error (bad_input) if one is not finite
SixNumbers given_forces(const DirichletCondition &condition);

/// Components along which held sides float, ascending.
std::vector<int> floating_components(const std::vector<DirichletCondition> &conditions);

/// (owned dofs) Forces on sides that float, in equal parts on their nodes. Collective.
/// @param force  along each component [N]
RCP<Vector> forces_on_floating(const Discretization &d, const DirichletDofs &dirichlet,
                               const std::vector<DirichletCondition> &conditions, const std::array<double, 3> &force);

/// The stiffness with tied unknowns, springs included; null where there are none. Collective.                                       (2.9a)
/// @param K  the same, all prescribed unknowns eliminated
RCP<const TiedStiffness> tied_stiffness(const Discretization &d, const PrescribedCouplings &couplings,
                                        const DirichletDofs &dirichlet, RCP<const StiffnessOperator> K);

/// Force with which each condition holds the body: the sum of internal - external forces over the unknowns that it
/// prescribes [N], in the plane per m; the radial component of an axisymmetric body cancels to 0. Collective. (2.11)
/// @param out_of_balance  (owned dofs) internal minus all external forces, contact included [N]
std::vector<std::array<double, 3>> reaction_forces(const Discretization &d, const DirichletDofs &dirichlet,
                                                   int num_conditions, const Vector &out_of_balance);

/// How many of some nodes of this rank nothing holds along a component; what a force moves is not held.
GO num_not_held(const DirichletDofs &dirichlet, const DeviceView<LO *> &nodes, int dim, int component);

} // namespace rpc::fem
