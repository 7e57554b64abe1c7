#include "rpc/fem/kinematics.hpp"

#include "bodies.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/stress.hpp"

namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::Kinematics;

constexpr fem::Material steel{2000, 0.3};

std::vector<mesh::Element> plane_elements()
{
  std::vector<mesh::Element> plane;
  for (const auto &element : elements())
    if (element.dim == 2) plane.push_back(element);
  return plane;
}

fem::Discretization bulged(const mesh::Element &element, const Kinematics kinematics)
{
  const auto box = small_box(element);
  return body(box, world(), bulge(box), kinematics);
}

/// Stresses of all nodes by node id, a row per node.
std::vector<double> stresses(const fem::Discretization &d, const fem::Material &material, const Vector &u)
{
  const auto stress = fem::RecoveredStress(d, material, u).at_nodes();
  const auto values = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
  return by_node_id(*d.mesh, static_cast<int>(values.extent(1)), [&](const LO n, const int k) { return values(n, k); });
}

std::vector<double> repeated(const std::vector<double> &row, const std::size_t size)
{
  std::vector<double> all;
  while (all.size() < size) all.insert(all.end(), row.begin(), row.end());
  return all;
}

/// Sum over the nodes where `there` of a force.
template <class Where>
Point resultant_where(const fem::Discretization &d, const Vector &force, const Where &there)
{
  Vector part(force, Teuchos::Copy);
  {
    const auto values = part.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
      for (int c = 0; c < d.dim(); ++c)
        if (!there(point_of(d, n))) values(d.dim() * n + c, 0) = 0;
  }
  return resultant(d, part);
}

TEST(KinematicsOption, ReadsWhatItWritesAndRefusesTheRest)
{
  for (const auto kinematics : {Kinematics::plane_strain, Kinematics::plane_stress})
    EXPECT_EQ(fem::kinematics_option(fem::name_of(kinematics), 2), kinematics);
  EXPECT_EQ(fem::kinematics_option("plane strain", 3), Kinematics::plane_strain);
  expect_error(ExitCode::bad_input, {"\"Kinematics\"", "plane stress", "got \"plane\""},
               [] { fem::kinematics_option("plane", 2); });
  expect_error(ExitCode::bad_input, {"\"Kinematics\" = plane stress", "in space", "Remove it"},
               [] { fem::kinematics_option("plane stress", 3); });
}

/// E/(1 - nu^2) ((1 - nu) eps_ij + nu tr eps delta_ij) of the linear displacement, nothing across the plane.
std::array<double, 3> plane_stress(const fem::Material &material)
{
  const double nu = material.poissons_ratio, factor = material.youngs_modulus / (1 - nu * nu);
  const double xx = slope[0][0], yy = slope[1][1], xy = (slope[0][1] + slope[1][0]) / 2;
  return {factor * (xx + nu * yy), factor * (yy + nu * xx), factor * (1 - nu) * xy};
}

TEST(PlaneStress, OfALinearDisplacementIsHookesLawWithoutStressAcross)
{
  for (const double nu : {0.3, 0.4999}) { // nothing locks, and nothing is projected
    for (const auto &element : plane_elements()) {
      SCOPED_TRACE(text_of(element));
      const fem::Material material{2000, nu};
      const auto d = bulged(element, Kinematics::plane_stress);
      const auto u = interpolate(d, [](const Point &x) { return linear(x, 2); });
      const auto s = plane_stress(material);
      const double von_mises = std::sqrt(s[0] * s[0] + s[1] * s[1] - s[0] * s[1] + 3 * s[2] * s[2]);
      const auto found = stresses(d, material, *u);
      EXPECT_LT(difference(found, repeated({s[0], s[1], s[2], von_mises}, found.size())), 1e-11);
    }
  }
}

TEST(PlaneStress, ForcesOfALinearDisplacementAreTheStressOnTheBoundary)
{
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = bulged(element, Kinematics::plane_stress);
    const auto u = interpolate(d, [](const Point &x) { return linear(x, 2); });
    const auto s = plane_stress(steel);
    const auto work = fem::internal_work(d, steel, *u);
    const double height = box.upper[1] - box.lower[1], width = box.upper[0] - box.lower[0];
    const auto inside = [&](const double x, const int i) { return x > box.lower[i] + 1e-9 && x < box.upper[i] - 1e-9; };
    // Corners have a share of the sides that meet there, which turns round between right and left, top and bottom.
    Point right = resultant_where(d, *work.forces, [&](const Point &x) { return x[0] > box.upper[0] - 1e-9; });
    const Point top = resultant_where(d, *work.forces, [&](const Point &x) { return x[1] > box.upper[1] - 1e-9; });
    const Point middle =
        resultant_where(d, *work.forces, [&](const Point &x) { return inside(x[0], 0) && inside(x[1], 1); });
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(right[i], s[i == 0 ? 0 : 2] * height, 1e-11 * steel.youngs_modulus);
      EXPECT_NEAR(top[i], s[i == 0 ? 2 : 1] * width, 1e-11 * steel.youngs_modulus);
      EXPECT_NEAR(middle[i], 0, 1e-11 * steel.youngs_modulus);
    }
    const double density = s[0] * slope[0][0] + s[1] * slope[1][1] + s[2] * (slope[0][1] + slope[1][0]);
    EXPECT_NEAR(work.energy_norm_squared, density * width * height, 1e-11 * steel.youngs_modulus);
  }
}

/// Largest |K u - f(u)| over the largest force, of a displacement without any symmetry: the matrix against sums over cells.
double tangent_error(const fem::Discretization &d, const fem::Material &material)
{
  const auto u = interpolate(d, wild);
  Vector force(d.owned_dofs);
  fem::assemble_stiffness(d, material)->apply(*u, force);
  return difference(by_node_id(d, force), by_node_id(d, *fem::internal_work(d, material, *u).forces));
}

TEST(PlaneStress, TheMatrixIsTheTangentOfTheInternalForces)
{
  for (const auto &element : plane_elements())
    EXPECT_LT(tangent_error(bulged(element, Kinematics::plane_stress), steel), 1e-13) << text_of(element);
}

} // namespace
