// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/rounded_rows.hpp"

#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <array>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <memory>

namespace rounded_rows_test
{
namespace
{

using namespace rpc;

fem::Discretization body(const mesh::Element &element)
{
  const int n = element.order == 1 ? 9 : 5;
  mesh::BoxOptions box{{0, 0}, {2, 1}, {n, n}, element};
  if (element.dim == 3) box = {{0, 0, 0}, {2, 1, 1}, {n, n, n}, element};
  return fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
}

/// K, of a body that is held at its left side or not at all.
RCP<CrsMatrix> stiffness(const fem::Discretization &d, const bool is_held)
{
  auto K = fem::assemble_stiffness(d, fem::Material{100, 0.3});
  if (!is_held) return K;
  fem::DirichletCondition held{"left", "left", {ScalarField(0.), ScalarField(0.)}};
  return fem::eliminate_dirichlet(d, K, fem::dirichlet_dofs(d, {held}).fixed).matrix;
}

Vector at_columns_of(const CrsMatrix &A, const std::function<double(GO)> &value)
{
  Vector x(A.getColMap());
  for (LO i = 0; i < num_local(*A.getColMap()); ++i) x.replaceLocalValue(i, value(A.getColMap()->getGlobalElement(i)));
  return x;
}

/// |rounded product - product|, |product| of this rank.
std::array<double, 2> error_and_size(const CrsMatrix &A, const int dim, const Vector &x)
{
  Vector y(A.getRowMap()), expected(A.getRowMap());
  A.localApply(x, expected);
  y.putScalar(7);
  RoundedRows(A, dim).apply(x, y);
  y.update(-1., expected, 1.);
  return {y.norm2(), expected.norm2()};
}

/// They are for the host.
class RoundedRowsTest : public testing::Test
{
protected:
  void SetUp() override
  {
    if (!Kokkos::SpaceAccessibility<ExecutionSpace, HostSpace>::accessible) GTEST_SKIP() << "kernels run on a GPU";
  }
};

TEST_F(RoundedRowsTest, GiveProductsUpToSinglePrecision)
{
  for (const mesh::Element &element : mesh::all_elements())
    for (const bool is_held : {false, true}) {
      const auto A = stiffness(body(element), is_held);
      const auto x = at_columns_of(*A, [](const GO i) { return std::sin(12.9898 * static_cast<double>(i)); });
      const auto [error, size] = error_and_size(*A, element.dim, x);
      EXPECT_LT(error, 1e-7 * size) << element.name() << " in " << element.dim << "D";
      EXPECT_GT(error, 1e-10 * size) << element.name() << " in " << element.dim << "D"; // they are rounded
    }
}

TEST_F(RoundedRowsTest, GiveATranslationNoForce)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = body(element);
    const auto A = stiffness(d, false);
    for (int c = 0; c < element.dim; ++c) {
      const auto x = at_columns_of(*A, [&](const GO i) { return i % element.dim == c ? 3. : 0.; });
      const auto [error, size] = error_and_size(*A, element.dim, x);
      EXPECT_LT(error, 1e-14 * A->getFrobeniusNorm()) << element.name() << " in " << element.dim << "D";
    }
  }
}

} // namespace
} // namespace rounded_rows_test
