// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/repeated_rows.hpp"

#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"
#include "same_rows.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

namespace repeated_rows_test
{
namespace
{

using namespace rpc;

/// K of a box that is held at its left side; its upper half may be shorn off its cells' shape.
RCP<CrsMatrix> stiffness(const mesh::Element &element, const double shear = 0)
{
  const int n = element.order == 1 ? 14 : 8;
  mesh::BoxOptions box{{0, 0}, {2, 1}, {n, n}, element};
  if (element.dim == 3) box = {{0, 0, 0}, {2, 1, 1}, {n, n, n}, element};
  auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
  if (shear > 0) {
    const auto coords = Kokkos::create_mirror_view(mesh->coords);
    Kokkos::deep_copy(coords, mesh->coords);
    for (std::size_t node = 0; node < coords.extent(0); ++node)
      coords(node, 0) += shear * std::sin(7 * coords(node, 0)) * std::cos(5 * coords(node, 1));
    Kokkos::deep_copy(mesh->coords, coords);
    mesh->box = nullptr;
  }
  const auto d = fem::discretize(mesh);
  fem::DirichletCondition held{"left", "left", {ScalarField(0.), ScalarField(0.)}};
  const auto dirichlet = fem::dirichlet_dofs(d, {held});
  return fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, fem::Material{100, 0.3}), dirichlet.fixed).matrix;
}

/// |y - A x| / |A x| on this rank, x without order.
double difference(const RepeatedRows &rows, const CrsMatrix &A)
{
  Vector x(A.getColMap()), y(A.getRowMap()), expected(A.getRowMap());
  for (LO i = 0; i < num_local(*A.getColMap()); ++i)
    x.replaceLocalValue(i, std::sin(12.9898 * static_cast<double>(A.getColMap()->getGlobalElement(i))));
  A.localApply(x, expected);
  y.putScalar(7);
  rows.apply(x, y);
  const auto found = y.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto values = expected.getLocalViewHost(Tpetra::Access::ReadOnly);
  double difference = 0, size = 0; // of this rank: others may have no rows that repeat
  for (std::size_t i = 0; i < found.extent(0); ++i) {
    difference += (found(i, 0) - values(i, 0)) * (found(i, 0) - values(i, 0));
    size += values(i, 0) * values(i, 0);
  }
  return std::sqrt(difference / size);
}

TEST(RepeatedRows, GiveTheProductsOfTheMatrix)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto A = stiffness(element);
    const auto rows = RepeatedRows::of(A, element.dim);
    // Where a rank's border leaves few rows inside, it may have none.
    if (A->getComm()->getSize() == 1) {
      EXPECT_GT(rows.num_kinds(), 1) << element.name();
      EXPECT_LT(rows.num_kinds(), element.dim == 2 ? 60 : 600) << element.name();
    }
    EXPECT_FALSE(rows.matrix().is_null());
    EXPECT_LT(difference(rows, *A), 1e-14) << element.name() << " in " << element.dim << "D";
  }
}

/// One unknown at each point of a grid, coupled with those around it.
TEST(RepeatedRows, HaveOneUnknownANode)
{
  constexpr int nx = 41, ny = 17;
  const auto comm = Tpetra::getDefaultComm();
  const auto map = rcp(new Map(GO(nx) * ny * comm->getSize(), nx * ny, 0, comm));
  for (const bool alike : {true, false}) {
    const auto A = rcp(new CrsMatrix(map, 9));
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (int q = std::max(j - 1, 0); q <= std::min(j + 1, ny - 1); ++q)
          for (int p = std::max(i - 1, 0); p <= std::min(i + 1, nx - 1); ++p) {
            const GO first = map->getMinGlobalIndex(), row = first + nx * j + i, column = first + nx * q + p;
            const double value = 3 + 2 * (p - i) - 0.5 * (q - j) + (alike ? 0 : 1e-3 * std::sin(1. + row * row));
            A->insertGlobalValues(row, Teuchos::tuple(column), Teuchos::tuple(value));
          }
    A->fillComplete();
    const auto rows = RepeatedRows::of(A, 1);
    EXPECT_EQ(rows.num_kinds(), alike ? 9 : 0);
    EXPECT_EQ(rows.pays(), alike) << "Tpetra's product is as fast";
    EXPECT_LT(difference(rows, *A), 1e-14);
    test::expect_same_rows(rows, *A);
  }
}

TEST(RepeatedRows, RowsThatAreAloneAreReadFromTheMatrix)
{
  const auto A = stiffness({2, 1});
  {
    const auto values = A->getLocalMatrixHost().values;
    for (int k = 0; k < 40; ++k) values(values.extent(0) / 2 + 3 * k) *= 1 + 0.01 * k;
  }
  const auto rows = RepeatedRows::of(A, 2);
  if (A->getComm()->getSize() == 1) {
    EXPECT_GT(rows.num_kinds(), 0);
  }
  EXPECT_LT(difference(rows, *A), 1e-14);
}

TEST(RepeatedRows, HaveNoKindsWhereCellsDiffer)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto A = stiffness(element, 0.02);
    const auto rows = RepeatedRows::of(A, element.dim);
    EXPECT_EQ(rows.num_kinds(), 0) << element.name() << " in " << element.dim << "D";
    EXPECT_LT(difference(rows, *A), 1e-14) << element.name() << " in " << element.dim << "D";
  }
}

TEST(RepeatedRows, BlocksAreThoseOfTheMatrix)
{
  for (const mesh::Element &element : mesh::all_elements())
    for (const double shear : {0., 0.02}) {
      SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D, shear " + std::to_string(shear));
      const auto A = stiffness(element, shear);
      const auto rows = RepeatedRows::of(A, element.dim);
      test::expect_same_rows(rows, *A);
    }
}

} // namespace
} // namespace repeated_rows_test
