// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/elasticity.hpp"

#include "bodies.hpp"
#include "rpc/core/parameters.hpp"

#include <limits>

namespace materials_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using Teuchos::ParameterList;

constexpr fem::Material steel{2000, 0.3}, rubber{50, 0.45}, nothing{0, 0};

/// The small box in two blocks, "soft" to the left of this plane and "hard" to the right.
double boundary(const mesh::Element &element)
{
  const auto box = small_box(element);
  return box.lower[0] + (box.upper[0] - box.lower[0]) / box.cells[0]; // after the first cell
}
fem::Discretization in_two_blocks(const fem::Discretization &whole)
{
  auto mesh = std::make_shared<mesh::Mesh>(*whole.mesh);
  mesh->blocks = {"soft", "hard"};
  mesh->block = DeviceView<int *>("block", mesh->num_cells());
  const auto block = Kokkos::create_mirror_view(mesh->block);
  const auto cells = to_host(mesh->cells);
  const int vertices = mesh->element.num_vertices();
  for (LO c = 0; c < mesh->num_cells(); ++c) {
    double centre = 0;
    for (int a = 0; a < vertices; ++a) centre += point_of(whole, cells(c, a))[0] / vertices;
    block(c) = centre < boundary(mesh->element) ? 0 : 1;
  }
  Kokkos::deep_copy(mesh->block, block);
  return fem::discretize(mesh);
}

fem::Materials soft_and_hard(const fem::Material &soft, const fem::Material &hard)
{
  fem::Materials materials(soft);
  materials.block["hard"] = hard;
  return materials;
}

/// K u, where nothing is eliminated.
std::vector<double> stiffness_times(const fem::Discretization &d, const fem::Materials &materials, const Vector &u)
{
  Vector force(d.owned_dofs);
  fem::assemble_stiffness(d, materials)->apply(u, force);
  return by_node_id(d, force);
}

/// sigma : eps of the linear displacement.
double linear_energy_density(const fem::Material &material, const int dim)
{
  double trace = 0, square = 0;
  for (int i = 0; i < dim; ++i) {
    trace += slope[i][i];
    for (int j = 0; j < dim; ++j) square += std::pow(0.5 * (slope[i][j] + slope[j][i]), 2);
  }
  return material.lambda() * trace * trace + 2 * material.mu() * square;
}

/// A deck's sublist with its defaults.
ParameterList completed(ParameterList list, const ParameterList &valid)
{
  validate(list, valid);
  return list;
}

fem::Materials read_materials(const ParameterList &list)
{
  return fem::material_options(completed(list, fem::valid_material_parameters()));
}

TEST(MaterialOptions, LameConstantsFollowFromYoungAndPoisson)
{
  ParameterList list;
  list.set("Young's Modulus", 5.).set("Poisson's Ratio", 0.25);
  const auto materials = read_materials(list);
  EXPECT_NEAR(materials.common.lambda(), 2, 1e-15 * 4);
  EXPECT_NEAR(materials.common.mu(), 2, 1e-15 * 4);
  EXPECT_TRUE(materials.block.empty());
}

TEST(MaterialOptions, BlocksHaveMaterialsOfTheirOwn)
{
  ParameterList list;
  list.set("Young's Modulus", 5.).set("Poisson's Ratio", 0.25);
  list.sublist("Blocks").sublist("hard").set("Young's Modulus", 70.).set("Poisson's Ratio", 0.1);
  list.sublist("Blocks").sublist("soft").set("Young's Modulus", 2.).set("Poisson's Ratio", 0.3);
  const auto materials = read_materials(list);
  ASSERT_EQ(materials.block.size(), 2u);
  EXPECT_EQ(materials.common.youngs_modulus, 5);
  EXPECT_EQ(materials.block.at("hard").youngs_modulus, 70);
  EXPECT_EQ(materials.block.at("hard").poissons_ratio, 0.1);
  EXPECT_EQ(materials.block.at("soft").youngs_modulus, 2);
  EXPECT_EQ(materials.block.at("soft").poissons_ratio, 0.3);
  EXPECT_EQ(materials.of("hard").youngs_modulus, 70);
  EXPECT_EQ(materials.of("elsewhere").youngs_modulus, 5);
}

TEST(MaterialOptions, ValuesOutOfRangeAreRefused)
{
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const std::string &name, const double value) {
    ParameterList list, block;
    list.set("Young's Modulus", 1.).set("Poisson's Ratio", 0.3).set(name, value);
    block.sublist("Blocks").sublist("hard") = list;
    expect_error(ExitCode::bad_input, {"\"Material->" + name + "\""}, [&] { read_materials(list); });
    expect_error(ExitCode::bad_input, {"\"Material->Blocks->hard->" + name + "\""}, [&] { read_materials(block); });
  };
  for (const double e : {0., -1., inf, nan}) refused("Young's Modulus", e);
  for (const double nu : {-1., 0.5, 0.7, nan, -inf}) refused("Poisson's Ratio", nu);
}

TEST(MaterialOptions, ModulusAndRatioMustBeGiven)
{
  for (const std::string missing : {"Young's Modulus", "Poisson's Ratio"}) {
    ParameterList list, block;
    list.set(missing == "Young's Modulus" ? "Poisson's Ratio" : "Young's Modulus", 0.25);
    block.sublist("Blocks").sublist("hard") = list;
    expect_error(ExitCode::bad_input, {"\"Material->" + missing + "\" must be given", "Add it to \"Material\""},
                 [&] { read_materials(list); });
    expect_error(ExitCode::bad_input, {"\"Material->Blocks->hard->" + missing + "\" must be given"},
                 [&] { read_materials(block); });
  }
  expect_error(ExitCode::bad_input, {"\"Material->Young's Modulus\" must be given, > 0 and finite [Pa]"},
               [] { read_materials({}); });
}

TEST(MaterialOptions, OfTheBodyMayBeMissingWhereEachBlockHasItsOwn)
{
  const auto d = in_two_blocks(body(small_box({2, 1}), world()));
  ParameterList list;
  for (const std::string &name : d.mesh->blocks)
    list.sublist("Blocks").sublist(name).set("Young's Modulus", 7.).set("Poisson's Ratio", 0.1);
  EXPECT_EQ(to_host(fem::lame_table(d, read_materials(list)))(1, 1), fem::Material({7, 0.1}).mu());
  const std::string first = d.mesh->blocks.front();
  list.sublist("Blocks").remove(first);
  expect_error(ExitCode::bad_input,
               {"\"Material->Young's Modulus\" must be given", "block \"" + first + "\" of the mesh"},
               [&] { fem::lame_table(d, read_materials(list)); });
}

TEST(LameTable, HasARowForEachBlockOfTheMesh)
{
  const auto d = in_two_blocks(body(small_box({2, 1}), world()));
  const auto table = to_host(fem::lame_table(d, soft_and_hard(rubber, steel)));
  ASSERT_EQ(table.extent(0), 2u);
  ASSERT_EQ(table.extent(1), 2u);
  EXPECT_EQ(table(0, 0), rubber.lambda());
  EXPECT_EQ(table(0, 1), rubber.mu());
  EXPECT_EQ(table(1, 0), steel.lambda());
  EXPECT_EQ(table(1, 1), steel.mu());
}

TEST(LameTable, MaterialOfABlockThatTheMeshLacksIsRefusedWithTheListOfBlocks)
{
  const auto d = in_two_blocks(body(small_box({2, 1}), world()));
  fem::Materials materials(steel);
  materials.block["hrad"] = rubber;
  const std::initializer_list<std::string> parts = {"\"Material->Blocks->hrad\"", "soft, hard"};
  expect_error(ExitCode::bad_input, parts, [&] { fem::lame_table(d, materials); });
  expect_error(ExitCode::bad_input, parts, [&] { fem::assemble_stiffness(d, materials); });
}

TEST(Stiffness, OfTwoBlocksIsTheSumOfTheirs)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = in_two_blocks(bulged_body(element, world()));
    const auto u = interpolate(d, wild);
    const auto both = stiffness_times(d, soft_and_hard(rubber, steel), *u);
    const auto soft = stiffness_times(d, soft_and_hard(rubber, nothing), *u);
    const auto hard = stiffness_times(d, soft_and_hard(nothing, steel), *u);
    std::vector<double> sum;
    for (std::size_t k = 0; k < both.size(); ++k) sum.push_back(soft[k] + hard[k]);
    EXPECT_LT(difference(both, sum), 1e-14);
    EXPECT_LT(difference(stiffness_times(d, soft_and_hard(steel, steel), *u), stiffness_times(d, steel, *u)), 1e-15);
    // Each is at home on its side of the boundary alone.
    const auto straight = body(small_box(element), world()); // where the boundary is a plane
    const auto places = by_node_id(*d.mesh, 1, [&](const LO n, int) { return point_of(straight, n)[0]; });
    double of_soft = 0, of_hard = 0;
    for (std::size_t node = 0; node < places.size(); ++node) {
      for (int c = 0; c < d.dim(); ++c) {
        const std::size_t dof = d.dim() * node + c;
        if (places[node] > boundary(element) + 1e-9) {
          EXPECT_EQ(soft[dof], 0);
          of_hard = larger(of_hard, std::abs(hard[dof]));
        } else if (places[node] < boundary(element) - 1e-9) {
          EXPECT_EQ(hard[dof], 0);
          of_soft = larger(of_soft, std::abs(soft[dof]));
        }
      }
    }
    EXPECT_GT(of_soft, 0.01 * rubber.youngs_modulus);
    EXPECT_GT(of_hard, 0.01 * steel.youngs_modulus);
  }
}

TEST(Stiffness, OfTwoBlocksIsTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    const auto force = [&](const RCP<const Comm> &comm) {
      const auto d = in_two_blocks(bulged_body(element, comm));
      return stiffness_times(d, soft_and_hard(rubber, steel), *interpolate(d, wild));
    };
    EXPECT_LT(difference(force(world()), force(alone())), 1e-13) << text_of(element);
  }
}

/// The owned nodes.
DeviceView<LO *> all_nodes(const fem::Discretization &d)
{
  HostView<LO *> nodes("rpc::test::nodes", d.mesh->num_owned_nodes());
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) nodes(n) = n;
  return to_device(nodes);
}

TEST(YoungsModulusAtNodes, IsTheLargestAmongTheCellsAround)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = in_two_blocks(body(small_box(element), world()));
    for (const bool swapped : {false, true}) {
      const fem::Material left = swapped ? steel : rubber, right = swapped ? rubber : steel;
      const auto modulus = to_host(fem::youngs_modulus_at_nodes(d, soft_and_hard(left, right), all_nodes(d)));
      ASSERT_EQ(static_cast<LO>(modulus.extent(0)), d.mesh->num_owned_nodes());
      for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
        const double x = point_of(d, n)[0] - boundary(element);
        const double expected = std::abs(x) < 1e-9 ? steel.youngs_modulus : (x < 0 ? left : right).youngs_modulus;
        EXPECT_NEAR(modulus(n), expected, 1e-13 * expected) << x;
      }
    }
  }
}

TEST(YoungsModulusAtNodes, RefusesABlockThatIsNotThere)
{
  const auto d = body(small_box({2, 1}), world());
  expect_error(ExitCode::bad_input, "Blocks->hard\" names a block that the mesh does not have",
               [&] { fem::youngs_modulus_at_nodes(d, soft_and_hard(rubber, steel), all_nodes(d)); });
}

/// sigma_ij of the linear displacement, in plane strain in 2D.
double linear_stress(const fem::Material &material, const int dim, const int i, const int j)
{
  double trace = 0;
  for (int k = 0; k < dim; ++k) trace += slope[k][k];
  return (i == j ? material.lambda() * trace : 0) + material.mu() * (slope[i][j] + slope[j][i]);
}

TEST(InternalForceNorm, OfALinearDisplacementIsTheStressOnTheFacesOfEachCell)
{
  // A node of a brick takes 2^(1 - dim) of the stress on each of the dim faces that meet in it, +- by its corner: cross
  // terms cancel over the corners.
  for (const mesh::Element element : {mesh::Element{2, 1}, mesh::Element{3, 1}}) {
    SCOPED_TRACE(text_of(element));
    const int dim = element.dim;
    const auto box = small_box(element);
    double volume = 1, squares[2] = {0, 0}, others = 1; // of one soft and one hard cell
    double width[3];
    for (int k = 0; k < dim; ++k) {
      width[k] = (box.upper[k] - box.lower[k]) / box.cells[k];
      volume *= width[k];
      if (k > 0) others *= box.cells[k];
    }
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        for (int hard = 0; hard < 2; ++hard)
          squares[hard] +=
              std::pow(2, dim) *
              std::pow(linear_stress(hard ? steel : rubber, dim, i, j) * volume / width[j] * std::pow(2, 1 - dim), 2);
    const double expected = std::sqrt(others * (squares[0] + (box.cells[0] - 1) * squares[1]));
    const auto d = in_two_blocks(body(box, world()));
    const auto u = interpolate(d, [&](const Point &x) { return linear(x, dim); });
    const double norm = fem::internal_work(d, soft_and_hard(rubber, steel), *u).force_norm;
    EXPECT_NEAR(norm, expected, 1e-13 * expected);
  }
}

TEST(InternalForceNorm, OfOneCellIsThatOfTheForcesOnItsNodes)
{
  for (auto element : elements()) {
    if (element.shape == mesh::Shape::simplex) continue; // a box has two of them at least
    SCOPED_TRACE(text_of(element));
    auto box = small_box(element);
    box.cells.assign(element.dim, 1);
    const auto d = body(box, alone());
    const auto u = interpolate(d, wild);
    const double expected = fem::internal_work(d, steel, *u).forces->norm2();
    EXPECT_NEAR(fem::internal_work(d, steel, *u).force_norm, expected, 1e-13 * expected);
  }
}

TEST(InternalForceNorm, IsTheSameOnAnyNumberOfRanksAndDoesNotSeeTranslations)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto norm = [&](const RCP<const Comm> &comm, const double shift) {
      const auto d = in_two_blocks(bulged_body(element, comm));
      const auto u = interpolate(d, [&](const Point &x) {
        Point value = wild(x);
        for (double &component : value) component += shift;
        return value;
      });
      return fem::internal_work(d, soft_and_hard(rubber, steel), *u).force_norm;
    };
    const double serial = norm(alone(), 0);
    EXPECT_GT(serial, 0);
    EXPECT_NEAR(norm(world(), 0), serial, 1e-13 * serial);
    EXPECT_NEAR(norm(world(), 1000), serial, 1e-11 * serial);
  }
}

TEST(StrainEnergy, OfALinearDisplacementIsSummedOverTheVolumesOfTheBlocks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = in_two_blocks(body(box, world()));
    const auto u = interpolate(d, [&](const Point &x) { return linear(x, element.dim); });
    double across = 1;
    for (int i = 1; i < element.dim; ++i) across *= box.upper[i] - box.lower[i];
    const double energy = across * ((boundary(element) - box.lower[0]) * linear_energy_density(rubber, element.dim) +
                                    (box.upper[0] - boundary(element)) * linear_energy_density(steel, element.dim));
    EXPECT_NEAR(fem::internal_work(d, soft_and_hard(rubber, steel), *u).energy_norm_squared, energy, 1e-13 * energy);
    Vector force(d.owned_dofs);
    fem::assemble_stiffness(d, soft_and_hard(rubber, steel))->apply(*u, force);
    EXPECT_NEAR(u->dot(force), energy, 50 * rounding_of(element) * energy);
  }
}

TEST(InternalForces, OfTwoBlocksAreTheStiffnessTimesTheDisplacement)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = in_two_blocks(bulged_body(element, world()));
    const auto u = interpolate(d, wild);
    const auto materials = soft_and_hard(rubber, steel);
    EXPECT_LT(
        difference(by_node_id(d, *fem::internal_work(d, materials, *u).forces), stiffness_times(d, materials, *u)),
        1e-13);
  }
}

TEST(InternalForces, OfTwoBlocksAreTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    const auto forces = [&](const RCP<const Comm> &comm) {
      const auto d = in_two_blocks(bulged_body(element, comm));
      return by_node_id(d, *fem::internal_work(d, soft_and_hard(rubber, steel), *interpolate(d, wild)).forces);
    };
    EXPECT_LT(difference(forces(world()), forces(alone())), 1e-13) << text_of(element);
  }
}

} // namespace
} // namespace materials_test
