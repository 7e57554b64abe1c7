// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "rpc/algebra/along_points.hpp"
#include "rpc/algebra/updated_operator.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "same_rows.hpp"

namespace repeated_stiffness_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr fem::Material steel{2000, 0.3}, rubber{50, 0.45}; // the second one projects its dilatation

/// So many cells that most nodes lie inside, on three ranks too.
mesh::BoxOptions many_cells(const mesh::Element &element)
{
  const int n = element.order == 1 ? 24 : 12;
  if (element.dim == 2) return {{-1, 2}, {1.5, 3}, {2 * n, n}, element};
  return {{-1, 2, 0}, {1, 3, 0.5}, {n, n, n}, element};
}

/// The upper half of the cells is another block.
fem::Discretization in_two_layers(const fem::Discretization &whole)
{
  auto mesh = std::make_shared<mesh::Mesh>(*whole.mesh);
  mesh->blocks = {"below", "above"};
  mesh->block = DeviceView<int *>("block", mesh->num_cells());
  const auto block = Kokkos::create_mirror_view(mesh->block);
  const auto cells = to_host(mesh->cells);
  for (LO c = 0; c < mesh->num_cells(); ++c) {
    double y = 0;
    for (int a = 0; a < mesh->element.num_vertices(); ++a)
      y += point_of(whole, cells(c, a))[1] / mesh->element.num_vertices();
    block(c) = y > 2.5;
  }
  Kokkos::deep_copy(mesh->block, block);
  return fem::discretize(mesh);
}

fem::Materials in_layers(const fem::Discretization &d)
{
  fem::Materials materials(steel);
  if (d.mesh->blocks.size() > 1) materials.block["above"] = rubber;
  return materials;
}

/// Left fixed, right held in x alone.
fem::DirichletDofs held(const fem::Discretization &d)
{
  fem::DirichletCondition left{"held", "left", {}}, right{"pushed", "right", {}};
  for (int c = 0; c < d.dim(); ++c) left.displacement[c] = ScalarField(0);
  right.displacement[0] = ScalarField(0.1);
  return fem::dirichlet_dofs(d, {left, right});
}

template <class View>
std::vector<double> values_of(const View &view)
{
  const auto host = to_host(view);
  return {host.data(), host.data() + host.extent(0)};
}

TEST(RepeatedStiffness, HasTheRowsAndTheCouplingsOfTheAssembledMatrix)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto whole = body(many_cells(element), world());
    for (const auto &d : {whole, in_two_layers(whole)}) {
      const auto dirichlet = held(d);
      const auto repeated = fem::repeated_stiffness(d, in_layers(d), dirichlet.fixed);
      ASSERT_TRUE(repeated);
      EXPECT_TRUE(repeated->rows.matrix().is_null());
      const auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, in_layers(d)), dirichlet.fixed);
      expect_same_rows(repeated->rows, *K.matrix);
      EXPECT_EQ(values_of(repeated->couplings.row), values_of(K.couplings.row));
      EXPECT_EQ(values_of(repeated->couplings.begin), values_of(K.couplings.begin));
      EXPECT_EQ(values_of(repeated->couplings.column), values_of(K.couplings.column));
      EXPECT_EQ(values_of(repeated->couplings.value), values_of(K.couplings.value));
    }
  }
}

TEST(RepeatedStiffness, IsNotThereWhereCellsDiffer)
{
  const auto bent = body(many_cells({2, 1}), world(), [](const Point &x) {
    return Point{x[0] + 0.02 * std::sin(7 * x[1]) * std::cos(5 * x[0]), x[1], x[2]};
  });
  EXPECT_FALSE(fem::repeated_stiffness(bent, steel, held(bent).fixed));
}

TEST(RepeatedStiffness, LeavesWhatIsWrongToTheAssemblyThatSaysIt)
{
  const auto d = body(many_cells({2, 1}), world());
  EXPECT_FALSE(fem::repeated_stiffness(d, fem::Material{1e160, 0.3}, held(d).fixed));
  const auto mirrored = body(many_cells({2, 1}), world(), [](const Point &x) { return Point{-x[0], x[1], x[2]}; });
  EXPECT_FALSE(fem::repeated_stiffness(mirrored, steel, held(mirrored).fixed));
}

/// Every third node may touch, some of them twice.
NodePoints some_points(const fem::Discretization &d)
{
  const LO n = d.mesh->num_owned_nodes() / 3;
  NodePoints points;
  points.dim = d.dim();
  points.node = DeviceView<LO *>("node", 2 * n);
  points.weight = DeviceView<double *>("weight", 2 * n);
  points.direction = DeviceView<double **>("direction", 2 * n, d.dim());
  points.first = HostView<LO *>("first", 3);
  points.first(1) = n;
  points.first(2) = 2 * n;
  const auto node = Kokkos::create_mirror_view(points.node);
  const auto direction = Kokkos::create_mirror_view(points.direction);
  for (LO i = 0; i < 2 * n; ++i) {
    node(i) = 3 * (i % n) + (i < n ? 0 : i % 2);
    for (int c = 0; c < d.dim(); ++c) direction(i, c) = std::sin(1 + i + 2 * c);
  }
  Kokkos::deep_copy(points.node, node);
  Kokkos::deep_copy(points.direction, direction);
  Kokkos::deep_copy(points.weight, 0.1);
  return points;
}

TEST(RepeatedStiffness, MakesAnOperatorThatIsAssembledWhenSomebodyAsks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = body(many_cells(element), world());
    const auto dirichlet = held(d);
    const auto repeated = fem::repeated_stiffness(d, steel, dirichlet.fixed);
    ASSERT_TRUE(repeated);
    const auto assemble = [&] {
      return fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, steel), dirichlet.fixed).matrix;
    };
    const auto points = some_points(d);
    const auto nodes = distinct_nodes({points.node});
    const auto K = rcp(new StiffnessOperator({repeated->rows, d.owned_dofs, d.halo, assemble}));
    const auto assembled = rcp(new StiffnessOperator(assemble(), d.dim()));
    UpdatedOperator H(K, nodes), expected(assembled, nodes);
    const auto u = interpolate(d, wild);
    const auto expect_same_products = [&] {
      Vector y(d.owned_dofs), by_matrix(d.owned_dofs);
      H.apply(*u, y);
      expected.apply(*u, by_matrix);
      EXPECT_LT(difference(by_node_id(d, y), by_node_id(d, by_matrix)), rounding_of(element));
      H.shared_base()->apply(*u, y);
      expected.shared_base()->apply(*u, by_matrix);
      EXPECT_LT(difference(by_node_id(d, y), by_node_id(d, by_matrix)), rounding_of(element));
    };
    EXPECT_EQ(values_of(own_stiffness(*K, points)), values_of(own_stiffness(*assembled, points)));
    EXPECT_EQ(values_of(coupled_stiffness(*K, points)), values_of(coupled_stiffness(*assembled, points)));
    expect_same_products();
    const DeviceView<double ***> added("added", points.size(), d.dim(), d.dim());
    Kokkos::deep_copy(added, 700.);
    for (UpdatedOperator *const A : {&H, &expected}) A->set(points, added);
    EXPECT_EQ(K->assemblies(), 0);
    expect_same_products();
    Vector y(d.owned_dofs), by_matrix(d.owned_dofs);
    K->copy()->apply(*u, y);
    EXPECT_EQ(K->assemblies(), 1);
    assembled->matrix()->apply(*u, by_matrix);
    EXPECT_LT(difference(by_node_id(d, y), by_node_id(d, by_matrix)), rounding_of(element));
  }
}

} // namespace
} // namespace repeated_stiffness_test
