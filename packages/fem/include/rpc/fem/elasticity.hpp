// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"
#include "rpc/fem/discretization.hpp"

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <map>
#include <string>

namespace rpc::fem
{

/// What counts as div u in a cell: itself, or its L2 projection on constants (Q1, P2) or linear functions (Q2), which does
/// not lock as nu nears 0.5, (2.6). Automatic is projected where nu > 0.4, for P2 0.48. P1 has constants anyway. Nothing locks in
/// plane stress: there automatic is full.
enum class Dilatation { automatic, full, projected };

/// Linear isotropic elasticity.
struct Material {
  double youngs_modulus = 1; ///< E [Pa] > 0
  double poissons_ratio = 0; ///< nu     in (-1, 0.5)
  Dilatation dilatation = Dilatation::automatic;

  double lambda() const { return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio)); }
  double mu() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }
};

/// What a body is made of: one material, or several, by the names of the mesh's blocks.
struct Materials {
  Material common;                       ///< of all blocks that are not named
  std::map<std::string, Material> block; ///< by block name
  bool only_blocks = false;              ///< nothing is said of other blocks: the mesh must not have any

  Materials() = default;
  Materials(const Material &material) : common(material) {}
  const Material &of(const std::string &name) const; ///< that of a block
};

/// Parameters of the deck's `Material` sublist.
Teuchos::ParameterList valid_material_parameters();
/// Young's modulus and Poisson's ratio have no defaults: those of the body must be given, or with `Blocks` those of each.
/// @throws rpc::Error (bad_input) on anything out of range or missing
Materials material_options(const Teuchos::ParameterList &list);

/// Lame's constants of each block of a mesh, (2.3): (blocks; lambda, mu) [Pa]. In plane stress lambda is that of the strains in the
/// plane, (2.3a).
/// @throws rpc::Error (bad_input) if a material is given for a block that the mesh does not have, or none for one that it has
DeviceView<double **> lame_table(const Discretization &d, const Materials &materials);

/// The largest Young's modulus among the cells around each of some owned nodes (nodes, [Pa]).
/// @throws rpc::Error (bad_input) as lame_table()
DeviceView<double *> youngs_modulus_at_nodes(const Discretization &d, const Materials &materials,
                                             const DeviceView<LO *> &nodes);

/// Blocks in which the dilatation is replaced by its projection: (blocks) 0 or 1.
/// @throws rpc::Error (bad_input) if it is asked for in plane stress
DeviceView<int *> projected_dilatation_table(const Discretization &d, const Materials &materials);

/// What a user should know: that elements which lock meet a nearly incompressible material; empty if there is nothing.
std::string locking_note(const Discretization &d, const Materials &materials);

/// What a user should know: that linear solves take many iterations for a nearly incompressible box of Q1, and fewer for one of Q2; empty if
/// there is nothing.
std::string incompressibility_note(const Discretization &d, const Materials &materials);

/// What a user should know: that cells of order 1 are so long that a thin box is too stiff where it bends (theory, 2.6a); empty if there
/// is nothing.
std::string bending_note(const Discretization &d, const Materials &materials);

/// What a user should know who asks for small errors: that P2 loses an order where its dilatation is projected; empty if
/// there is nothing.
std::string order_note(const Discretization &d, const Materials &materials);

using VectorField = std::array<ScalarField, 3>;

/// What acts on one side: a force per area, or a force in all that is spread evenly over the side's area.
struct TractionLoad {
  std::string name; ///< of the entry in the deck, for messages
  std::string side;
  VectorField traction; ///< [Pa]
  VectorField force =
      {}; ///< [N], in the plane per m, of the whole body of revolution in axisymmetry; fields of time alone
};

/// Parameters of the deck's `Traction` and `Body Force` sublists.
Teuchos::ParameterList valid_traction_parameters();
Teuchos::ParameterList valid_body_force_parameters();
std::vector<TractionLoad> traction_options(const Teuchos::ParameterList &list, int dim, const FieldParser &parse);
VectorField body_force_options(const Teuchos::ParameterList &list, int dim, const FieldParser &parse); ///< [N/m^3]

/// The stiffness matrix, without boundary conditions: a(., .) of paper (1) for the shape functions.
///
///     K(ai,bj) = sum over cells, int lambda dN_ai dN_bj + mu (dN_aj dN_bi + delta_ij dN_a . dN_b) doc/theory.md (2.4)
///
/// with the projection of div u in the blocks of projected_dilatation_table, (2.6), here and in the functions below.
/// Each rank fills its own rows from its local cells; no communication but the check. [N/m], in 2D per m of thickness
/// [Pa].
/// @throws rpc::Error (bad_mesh) on every rank if a cell has a Jacobian <= 0 at a quadrature point, naming the first
RCP<CrsMatrix> assemble_stiffness(const Discretization &d, const Materials &materials);

/// What a displacement does inside the body, from one pass over the cells: the left side of paper (1), cell by cell.
struct InternalWork {
  RCP<const Vector>
      forces; ///< f(ai) = int sigma(u) : grad(N_a e_i), the forces that hold the body in the state u (owned
              ///< dofs, [N]); no row is eliminated.                                             (2.10)
  double force_norm =
      0; ///< 2-norm over all forces between cells and their nodes, each cell's by itself [N]: the size of
         ///< the forces inside the body, of which `forces` are the sums at nodes. (2.12)
  double energy_norm_squared =
      0; ///< a(u, u), twice the elastic energy [J], in 2D per m: rigid motion cancels cell by cell. (1.2)
};

/// @param u  (owned dofs) [m], prescribed ones included; collective
InternalWork internal_work(const Discretization &d, const Materials &materials, const Vector &u);

/// load(ai) += int N_a f_i, over the body, for a force per volume f [N/m^3] (owned dofs, [N], in 2D per m).
/// paper (1), (2.5)
/// @param parameter  deck path for messages; collective
void add_body_force(const Discretization &d, const VectorField &force, const std::string &parameter, Vector &load);

/// A load per area, its force over the area of the mesh's side included [Pa]; collective.
/// @throws rpc::Error (bad_input) where there is a force and the side has no area, or the force is not finite
VectorField force_per_area(const Discretization &d, const mesh::Side &side, const TractionLoad &load);

/// The sum of those of some tractions that act on a side, at the points of ReferenceElement::facet: (facets, points, dim)
/// [Pa]; collective.
DeviceView<double ***> tractions_on(const Discretization &d, const mesh::Side &side,
                                    const std::vector<TractionLoad> &loads);

/// load(ai) += int N_a t_i, over a side, for a traction t [Pa].                                       paper (3), (2.5)
/// @param parameter  deck path for messages; collective
void add_traction(const Discretization &d, const mesh::Side &side, const VectorField &traction,
                  const std::string &parameter, Vector &load);

/// areas(ai) += int N_a, over a side, for each component i: the area that node a stands for [m^2]. On the axis of a body of revolution it is 0.
/// Collective.
void add_node_areas(const Discretization &d, const mesh::Side &side, Vector &areas);

} // namespace rpc::fem
