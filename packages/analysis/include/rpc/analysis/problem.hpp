// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/stiffness_operator.hpp"
#include "rpc/analysis/memory.hpp"
#include "rpc/analysis/nested_mesh.hpp"
#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/support.hpp"
#include "rpc/core/units.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/solver/mesh_levels.hpp"
#include "rpc/solver/mixed_form.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rpc::analysis
{

/// What a scene is made of, but for its mesh. Fields are functions of place and time.
struct Model {
  fem::Kinematics kinematics = fem::Kinematics::plane_strain;
  fem::Materials materials;
  std::vector<fem::DirichletCondition> dirichlet;
  std::vector<fem::TractionLoad> tractions;
  fem::VectorField body_force;
  std::vector<contact::ContactOptions> contact; ///< one per contact side
  UnitNames units;                              ///< of all its numbers

  /// The same, with all fields seen at one time.
  /// @param obstacle  how far a force has moved its obstacle then [m]
  Model seen_at(double t, const Point &obstacle = {}) const;
};

/// When body and foundation are at rest as they are given, before a first step: at t = 0, for the step begins there; or when it ends, if
/// that is not later.
/// @param first  time of the first step
double time_at_rest(double first);
/// How far each side's foundation moves from one time to another [m].
/// @param before, now  how far a force has moved its obstacle at these times [m]
std::vector<Point> foundations_moved(const Model &model, double from, double to, const Point &before = {},
                                     const Point &now = {});
/// How far the obstacle that a force moves is from where it was at t = 0 [m]; 0 where there is none.
/// @param obstacle  what the force has moved it by [m]
Point obstacle_displacement(const Model &model, double t, const Point &obstacle);
/// With what its springs draw an obstacle back that has moved so far [N], in 2D per m; nothing where none has a spring.     doc/theory.md (3.17e)
/// @param obstacle  what forces and springs have moved it by [m]
std::optional<Point> spring_force_on_obstacle(const Model &model, const Point &obstacle);

/// What acts on a body at one time: cheap to make again. Plain data.
struct Step {
  double time = 1;
  fem::ElasticProblem elastic;   ///< loads and prescribed displacements
  contact::ContactNodes contact; ///< with the gap and the yield stress of the time
  contact::Support support;      ///< what holds the body
  double energies_before = 0;    ///< S of (5.5b), of the steps before [J], in 2D per m
  Point obstacle{};              ///< how far a force has moved its obstacle [m]: where the contact points are seen
  RCP<const Vector> on_floating =
      {}; ///< (owned dofs) forces that stand for that on the obstacle [N]; null: there is none
};

/// A body on its mesh: what stays from step to step, made once. Nothing of it changes while steps are solved: that is SolverState's.
/// K belongs to the body, not to its contact: it stays the same where gaps and normals change. doc/theory.md, section 2
class Problem
{
public:
  /// Assembles the stiffness matrix, or lists its rows where they repeat. Collective.
  /// @param t  time of the first step; which displacements are prescribed does not depend on it
  /// @throws rpc::Error bad_input where the model does not fit the mesh or numbers overflow, naming what they belong to;
  ///         bad_mesh for a cell with a Jacobian <= 0; no_solution as contact::contact_nodes() and contact::free_parts()
  Problem(std::shared_ptr<const mesh::Mesh> mesh, const Model &model, double t = 1);
  Problem(std::shared_ptr<const NestedMesh> mesh, const Model &model, double t = 1);

  /// Loads, prescribed displacements and contact nodes at one time. Collective.
  /// @param dents   that earlier steps have left, (owned nodes; sides) [m]; null: none
  /// @param before  what the step before has left, from which slip counts; null: body and foundation were at rest
  /// @param obstacle  how far a force has moved its obstacle [m]; null: as far as in the step before, or until it meets the side
  /// @throws rpc::Error bad_input as above; no_solution where nothing holds the body, see contact::check_support()
  Step step(double t, const MultiVector *dents = nullptr, const Memory *before = nullptr,
            const Point *obstacle = nullptr) const;
  fem::DirichletDofs dirichlet(double t) const; ///< of step(t), alone
  /// The same scene on one of the boxes that this one leads to: the first that has at most a `factor`-th of its cells along the direction
  /// with most; of a mesh with parents the first one with cells `factor` times as long, in space half of that, or the coarsest. Null where there is none, and for boxes
  /// of order 2: linear elements, too stiff in bending, predict worse. Collective.
  std::shared_ptr<const Problem> coarser(double factor, double t) const;

  const fem::Discretization &discretization() const { return mesh_->discretization(); }
  const NestedMesh &mesh() const { return *mesh_; }
  const Model &model() const { return model_; } ///< seen at the time of the first step
  /// The contact sides, in the order of the model's.
  std::vector<const mesh::Side *> contact_sides() const;
  /// K, prescribed unknowns eliminated. Assembled only where somebody asks for its matrix, if its rows repeat.
  const RCP<const StiffnessOperator> &stiffness() const { return stiffness_; }
  /// The same with the sides that forces move as one; null where there are none.
  const RCP<const TiedStiffness> &stiffness_of_tied() const { return stiffness_of_tied_; }
  /// Owned nodes at which contact may act at some time, ascending: those of the contact sides.
  const DeviceView<LO *> &contact_candidates() const { return candidates_; }
  /// Makes the meshes that multigrid needs; null where there is no coarser one.
  solver::MakeMeshLevels mesh_levels() const;
  /// Splits the stiffness where a mixed form suits it, see analysis::mixed_form(); else null.
  solver::MakeMixedForm mixed_form() const;

private:
  Model model_;
  std::shared_ptr<const NestedMesh> mesh_;
  DeviceView<char *> prescribed_; // (overlap dofs)
  contact::FreeParts free_parts_;
  fem::PrescribedCouplings couplings_;
  RCP<const StiffnessOperator> stiffness_;
  RCP<const TiedStiffness> stiffness_of_tied_;
  DeviceView<LO *> candidates_;
};

} // namespace rpc::analysis
