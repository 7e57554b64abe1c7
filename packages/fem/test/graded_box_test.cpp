// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/interpolation.hpp"

/// What assumes equal cells of a box elsewhere, where they are graded.
namespace graded_box_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr fem::Material steel{2000, 0.3};

/// Graded along the last direction, and less along the first one.
mesh::BoxOptions graded_box(const mesh::Element &element, const int times = 1)
{
  mesh::BoxOptions box{{-1, 2}, {1.5, 3}, {6 * times, 7 * times}, element, {}, 0, {}, false, {0.5, 6}};
  if (element.dim == 3)
    box = {{-1, 2, 0}, {1, 3, 0.5}, {4 * times, 3 * times, 7 * times}, element, {}, 0, {}, false, {0.5, 1, 6}};
  mesh::grade(box);
  return box;
}

bool is_inside(const mesh::BoxOptions &box, const Point &x)
{
  for (int d = 0; d < box.element.dim; ++d)
    if (x[d] < box.lower[d] + 1e-12 || x[d] > box.upper[d] - 1e-12) return false;
  return true;
}

/// The patch test: a linear displacement has no forces inside.
TEST(GradedBox, LinearDisplacementsAreInEquilibriumInside)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = graded_box(element);
    const auto d = body(box, world());
    const auto u = interpolate(d, [&](const Point &x) { return linear(x, d.dim()); });
    Vector force(d.owned_dofs);
    fem::assemble_stiffness(d, fem::Materials(steel))->apply(*u, force);
    const auto f = force.getLocalViewHost(Tpetra::Access::ReadOnly);
    double inside = 0;
    GO count = 0;
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      if (!is_inside(box, point_of(d, n))) continue;
      ++count;
      for (int c = 0; c < d.dim(); ++c) inside = larger(inside, std::abs(f(d.dim() * n + c, 0)));
    }
    EXPECT_GT(sum_all(d.mesh->comm(), count), 0);
    EXPECT_LT(inside, 2e-11 * force.normInf());
  }
}

/// Between all coarser boxes, and a box of other cells.
TEST(GradedBox, InterpolationIsExactForLinearFunctions)
{
  const auto expect_exact = [](const fem::Discretization &coarse, const fem::Discretization &fine) {
    const auto at_nodes = [](const fem::Discretization &d) {
      MultiVector result(d.mesh->owned_nodes, d.dim());
      const auto values = result.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
        const Point value = linear(point_of(d, n), d.dim());
        for (int c = 0; c < d.dim(); ++c) values(n, c) = value[c];
      }
      return result;
    };
    MultiVector result(fine.mesh->owned_nodes, fine.dim());
    fem::interpolation(coarse, fine)->apply(at_nodes(coarse), result);
    result.update(-1., at_nodes(fine), 1.);
    for (int c = 0; c < fine.dim(); ++c) EXPECT_LT(result.getVector(c)->normInf(), 1e-13);
  };
  const auto blocks = [](const mesh::BoxOptions &box) { return mesh::divided(box, world()->getSize(), 1); };
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    auto box = graded_box(element);
    const auto fine = body(box, world());
    auto equal = small_box(element);
    equal.lower = box.lower;
    equal.upper = box.upper;
    expect_exact(body(equal, world()), fine);
    expect_exact(fine, body(equal, world()));
    for (auto coarse = mesh::coarsened(box); coarse; coarse = mesh::coarsened(box)) {
      expect_exact(body(blocks(*coarse), world()), body(blocks(box), world()));
      box = *coarse;
    }
  }
}

/// Each layer is a kind of its own, and nodes between the same layers have the same rows.
TEST(GradedBox, CellsOfALayerAreAlike)
{
  for (const auto &element : elements()) {
    // Where ranks divide a mesh of order 2 too few of its nodes lie inside.
    if (element.shape == mesh::Shape::simplex || (element.order == 2 && world()->getSize() > 1)) continue;
    SCOPED_TRACE(text_of(element));
    auto box = graded_box(element, element.order == 1 ? 3 : 2);
    box.expansion[0] = 1;
    box.cells[0] *= 4; // so that most nodes lie inside
    if (element.dim == 3) box.cells[1] *= 4;
    mesh::grade(box);
    const auto d = body(box, world());
    EXPECT_TRUE(world()->getSize() > 1 || d.congruent.size() == box.cells[element.dim - 1]);
    EXPECT_GT(d.congruent.size(), 0);
    auto other = std::make_shared<mesh::Mesh>(*d.mesh);
    other->box = nullptr; // cells are compared
    auto searched = fem::discretize(other);
    searched.congruent = {};
    fem::DirichletCondition left{"held", "left", {}};
    for (int c = 0; c < d.dim(); ++c) left.displacement[c] = ScalarField(0);
    const auto dirichlet = fem::dirichlet_dofs(d, {left});
    const auto repeated = fem::repeated_stiffness(d, fem::Materials(steel), dirichlet.fixed);
    ASSERT_TRUE(repeated);
    EXPECT_TRUE(repeated->rows.any_repeat());
    const auto K =
        fem::eliminate_dirichlet(d, fem::assemble_stiffness(searched, fem::Materials(steel)), dirichlet.fixed);
    const auto u = interpolate(d, wild);
    Vector by_rows(d.owned_dofs), by_matrix(d.owned_dofs);
    const auto overlap = rcp(new Vector(K.matrix->getColMap()));
    overlap->doImport(*u, Import(d.owned_dofs, K.matrix->getColMap()), Tpetra::INSERT);
    repeated->rows.apply(*overlap, by_rows);
    K.matrix->apply(*u, by_matrix);
    by_rows.update(-1., by_matrix, 1.);
    EXPECT_LT(by_rows.normInf(), 1e-11 * by_matrix.normInf());
  }
}

/// Where the middle of the numbers lies at a side, and there are more layers than kinds that the search looks at before it gives up.
TEST(GradedBox, ManyLayersOfAWideBoxAreAlike)
{
  if (world()->getSize() > 1) GTEST_SKIP() << "ranks have fewer layers";
  mesh::BoxOptions box{{0, 0, 0}, {1, 1, 1}, {64, 64, 28}, {3, 1}, {}, 0, {true, true, false}, false, {1, 1, 32}};
  mesh::grade(box);
  const auto d = body(box, world());
  const auto repeated = fem::repeated_stiffness(d, fem::Materials(steel), DeviceView<char *>("free", 3 * 64 * 64 * 29));
  ASSERT_TRUE(repeated);
  EXPECT_GE(repeated->rows.num_kinds(), 29);
}

} // namespace
} // namespace graded_box_test
