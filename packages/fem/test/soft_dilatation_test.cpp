// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/soft_dilatation.hpp"

#include <cmath>

// The split of a nearly incompressible stiffness, doc/theory.md (4.13).

namespace soft_dilatation_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::Dilatation;

constexpr fem::Material rubber{50, 0.4999, Dilatation::projected};

TEST(SoftDilatation, AndWhatItLacksAreTheStiffness)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    if (element.shape == mesh::Shape::simplex && element.order == 1) continue; // has no projection
    SCOPED_TRACE(text_of(element));
    const auto d = body(small_box(element), world());
    const fem::Material material{50, 0.4999, Dilatation::projected};
    const auto soft = fem::softened(d, material, 0.4);
    ASSERT_TRUE(soft);
    EXPECT_NEAR(soft->of(d.mesh->blocks[0]).mu(), material.mu(), 1e-12 * material.mu());
    EXPECT_EQ(soft->of(d.mesh->blocks[0]).poissons_ratio, 0.4);
    const auto fixed = fem::dirichlet_dofs(d, {{"left", "left", {ScalarField(0.)}}}).fixed;
    const auto eliminated = [&](const fem::Materials &materials) {
      return fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, materials), fixed).matrix;
    };
    const auto K = eliminated(material), K_0 = eliminated(*soft);
    const auto split = fem::stiff_dilatation(d, material, *soft, fixed, true);
    const int modes = element.order == 2 && element.shape != mesh::Shape::simplex ? 1 + element.dim : 1;
    EXPECT_EQ(num_local(*split.modes->getRangeMap()), modes * d.mesh->num_owned_cells);

    Vector u(d.owned_dofs), whole(d.owned_dofs), sum(d.owned_dofs), volume(split.modes->getRangeMap());
    const auto is_fixed = to_host(fixed);
    for (LO i = 0; i < num_local(*d.owned_dofs); ++i)
      if (!is_fixed(i))
        u.replaceLocalValue(i, std::sin(1 + 7. * static_cast<double>(d.owned_dofs->getGlobalElement(i))));
    K->apply(u, whole);
    K_0->apply(u, sum);
    split.modes->apply(u, volume);
    const auto s = to_host(split.stiffness), modulus = to_host(split.wave_modulus), bulk = to_host(split.bulk_modulus);
    for (LO m = 0; m < num_local(*volume.getMap()); ++m) {
      EXPECT_NEAR(s(m), material.lambda() - soft->of(d.mesh->blocks[0]).lambda(), 1e-10 * s(m));
      EXPECT_NEAR(bulk(m), soft->of(d.mesh->blocks[0]).lambda() + 2 * material.mu() / d.dim(), 1e-10 * s(m));
      EXPECT_NEAR(modulus(m), soft->of(d.mesh->blocks[0]).lambda() + 2 * material.mu(), 1e-10 * s(m));
      volume.replaceLocalValue(m, s(m) * volume.getData()[m]);
    }
    split.modes->apply(volume, sum, Teuchos::TRANS, 1., 1.);
    sum.update(-1., whole, 1.);
    EXPECT_LT(sum.norm2(), 1e-10 * whole.norm2());
  }
}

/// By hand: u = x/dim expands by 1 everywhere, so that the constant mode, made orthonormal, is the root of the cell's volume, and others are 0.
TEST(SoftDilatation, ModesOfAnExpansionAreTheRootsOfVolumes)
{
  for (const mesh::Element &element : {mesh::Element{2, 1}, mesh::Element{3, 1}, mesh::Element{2, 2},
                                       mesh::Element{3, 2}, mesh::Element{3, 2, mesh::Shape::simplex}}) {
    SCOPED_TRACE(text_of(element));
    const auto d = one_cell(element);
    const fem::Material material{50, 0.4999, Dilatation::projected};
    const DeviceView<char *> nothing("nothing", d.num_overlap_dofs());
    const auto split = fem::stiff_dilatation(d, material, *fem::softened(d, material, 0.4), nothing, true);
    Vector u(d.owned_dofs), volumes(split.modes->getRangeMap());
    const auto coords = to_host(d.mesh->coords);
    for (LO i = 0; i < num_local(*d.owned_dofs); ++i)
      u.replaceLocalValue(i, coords(node_of(d.dim(), i), component_of(d.dim(), i)) / d.dim());
    split.modes->apply(u, volumes);
    const auto of_mode = volumes.getData();
    EXPECT_NEAR(volumes.norm2() * volumes.norm2(), volume(d), 1e-12); // of all cells
    const LO modes = num_local(*volumes.getMap()) / d.mesh->num_owned_cells;
    for (LO m = 0; m < num_local(*volumes.getMap()); ++m)
      if (m % modes > 0) {
        EXPECT_NEAR(of_mode[m], 0, 1e-12);
      }
    EXPECT_EQ(split.at_nodes.is_null(), modes > 1);
    EXPECT_EQ(split.alternating_ones_move, element.order == 2);
    EXPECT_TRUE(
        fem::stiff_dilatation(d, material, *fem::softened(d, material, 0.4), nothing, false).at_nodes.is_null());
    if (modes > 1) continue;
    // The same root at each vertex of the cell: its product with 1 at all nodes, and with the root itself the other way.
    Vector ones(split.at_nodes->getDomainMap()), sums(split.at_nodes->getRangeMap()), around(ones.getMap());
    ones.putScalar(1);
    split.at_nodes->apply(ones, sums);
    sums.update(-element.num_vertices(), volumes, 1.);
    EXPECT_LT(sums.norm2(), 1e-12);
    split.at_nodes->apply(volumes, around, Teuchos::TRANS);
    EXPECT_NEAR(around.normInf(), volume(d), 1e-12);
  }
}

/// Of two blocks one is split: cells of the other one have no modes, and K_0 is K there.
TEST(SoftDilatation, SplitsTheBlocksThatAreStiff)
{
  const auto both = body(small_box({2, 2}), world());
  const auto mesh = std::make_shared<mesh::Mesh>(*both.mesh);
  mesh->blocks.push_back("steel");
  const auto block = to_host(mesh->block);
  const DeviceView<int *> blocks("blocks", block.extent(0));
  const auto host = Kokkos::create_mirror_view(blocks);
  for (std::size_t c = 0; c < block.extent(0); ++c) host(c) = static_cast<int>(c % 2);
  Kokkos::deep_copy(blocks, host);
  mesh->block = blocks;
  const auto d = fem::discretize(mesh);
  fem::Materials materials(rubber);
  materials.block["steel"] = {1000, 0.3};
  const auto soft = fem::softened(d, materials, 0.4);
  ASSERT_TRUE(soft);
  EXPECT_EQ(soft->of("steel").poissons_ratio, 0.3);
  const DeviceView<char *> nothing("nothing", d.num_overlap_dofs());
  const auto split = fem::stiff_dilatation(d, materials, *soft, nothing, true);
  const auto s = to_host(split.stiffness);
  Vector u(d.owned_dofs), volumes(split.modes->getRangeMap());
  u.randomize();
  split.modes->apply(u, volumes);
  for (LO m = 0; m < num_local(*volumes.getMap()); ++m) {
    const bool is_stiff = host(m / 3) == 0;
    EXPECT_EQ(s(m) > 0, is_stiff);
    EXPECT_EQ(volumes.getData()[m] != 0, is_stiff);
  }
}

TEST(SoftDilatation, LeavesOtherMaterialsAlone)
{
  const auto d = body(small_box({2, 2}), world());
  EXPECT_FALSE(fem::softened(d, fem::Material{50, 0.39}, 0.4));
  EXPECT_FALSE(fem::softened(d, fem::Material{50, 0.49, Dilatation::full}, 0.4));
  const auto p2 = body(small_box({2, 2, mesh::Shape::simplex}), world());
  EXPECT_FALSE(fem::softened(p2, fem::Material{50, 0.47}, 0.4)) << "P2 projects above 0.48 alone";
  EXPECT_TRUE(fem::softened(p2, fem::Material{50, 0.49}, 0.4));
}

} // namespace
} // namespace soft_dilatation_test
