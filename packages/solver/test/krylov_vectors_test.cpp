// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/krylov_vectors.hpp"

#include <BelosOrthoManagerFactory.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <string>

namespace krylov_vectors_test
{
namespace
{

using namespace rpc;
using solver::KrylovVectors;
using Vectors = Belos::MultiVec<double>;
using Matrix = KrylovVectors::Matrix;
using Manager = Belos::OrthoManager<double, Vectors>;

RCP<const Map> rows(const GO count)
{
  return rcp(new Map(static_cast<Tpetra::global_size_t>(count), 0, Tpetra::getDefaultComm()));
}

RCP<Manager> manager(const std::string &name)
{
  const auto quiet = rcp(new Belos::OutputManager<double>(Belos::Errors));
  return Belos::OrthoManagerFactory<double, Vectors, Belos::Operator<double>>().makeMatOrthoManager(
      name, Teuchos::null, quiet, "test", Teuchos::null);
}

std::vector<int> first(const int count)
{
  std::vector<int> index(count);
  std::iota(index.begin(), index.end(), 0);
  return index;
}

/// 1 and a little of a wave of its own.
Vector nearly_constant(const RCP<const Map> &map, const int k, const double little)
{
  Vector w(map);
  const auto values = w.getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LO row = 0; row < num_local(*map); ++row) {
    const double at = static_cast<double>(map->getGlobalElement(row));
    values(row, 0) = 1 + little * std::sin(0.01 * (k + 1) * at * (1 + 0.1 * k));
  }
  return w;
}

/// Orthonormal vectors, one after the other, from vectors that all but depend on each other: each has little that those before lack.
/// @param little  of the part that is new, over the vector
RCP<KrylovVectors> orthonormal(const std::string &name, const int count, const double little, double &worst_residual)
{
  const auto map = rows(1000);
  const auto V = rcp(new KrylovVectors(map, std::vector<RCP<Vector>>(count)));
  const auto by = manager(name);
  worst_residual = 0;
  for (int k = 0; k < count; ++k) {
    Vector w = nearly_constant(map, k, little);
    const RCP<Vectors> next = rcp(V->CloneViewNonConst({k}));
    V->vector(k)->assign(w);
    const RCP<Matrix> norm = rcp(new Matrix(1, 1)), products = rcp(new Matrix(std::max(k, 1), 1));
    if (k == 0) {
      by->normalize(*next, norm);
    } else {
      Teuchos::Array<RCP<const Vectors>> before(1, RCP<const Vectors>(rcp(V->CloneView(first(k)))));
      by->projectAndNormalize(*next, Teuchos::Array<RCP<Matrix>>(1, products), norm, before());
      for (int j = 0; j < k; ++j) w.update(-(*products)(j, 0), *V->vector(j), 1.);
    }
    const double scale = std::sqrt(1000.);
    w.update(-(*norm)(0, 0), *V->vector(k), 1.);
    worst_residual = std::max(worst_residual, w.norm2() / scale);
  }
  return V;
}

/// What Gram-Schmidt says of a vector adds up to it, and the basis is orthonormal to rounding, as GMRES needs it.
TEST(KrylovVectors, AreMadeOrthonormalToRoundingHoweverCloseTheyAre)
{
  constexpr int count = 21;
  for (const std::string name : {"ICGS", "DGKS"})
    for (const double little : {1., 1e-3, 1e-6}) {
      SCOPED_TRACE(name + " " + std::to_string(little));
      double worst_residual = 1;
      const auto V = orthonormal(name, count, little, worst_residual);
      EXPECT_LT(worst_residual, 1e-14);
      Matrix products(count, count);
      V->MvTransMv(1, *V, products);
      double worst = 0;
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) worst = std::max(worst, std::abs(products(i, j) - (i == j)));
      EXPECT_LT(worst, 1e-13);
    }
}

/// GMRES asks for all vectors that it may ever take.
TEST(KrylovVectors, AreMadeOnlyOnceTheyAreNeeded)
{
  const auto map = rows(10);
  const KrylovVectors few(map, {rcp(new Vector(map))});
  const auto many = rcp(few.Clone(1000000));
  EXPECT_EQ(many->GetNumberVecs(), 1000000);
  const auto two = rcp(many->CloneViewNonConst({999999, 7}));
  two->MvInit(3);
  EXPECT_EQ(many->vector(7), two->vector(1)) << "a view shares its vectors";
  EXPECT_EQ(many->vector(999999)->norm1(), 30);
  const auto copy = rcp(two->CloneCopy({1}));
  copy->MvScale(2);
  EXPECT_EQ(copy->vector(0)->norm1(), 60);
  EXPECT_EQ(many->vector(7)->norm1(), 30) << "a copy does not";
}

TEST(KrylovVectors, AddAndScaleColumnByColumn)
{
  const auto map = rows(10);
  KrylovVectors x(map, std::vector<RCP<Vector>>(2)), y(map, std::vector<RCP<Vector>>(2));
  x.MvInit(1);
  x.MvScale({2, 3});
  y.MvInit(1);
  y.MvAddMv(2, x, -1, y); // (3, 5)
  std::vector<double> sums(2);
  y.MvNorm(sums, Belos::OneNorm);
  EXPECT_EQ(sums[0], 30);
  EXPECT_EQ(sums[1], 50);
  y.MvDot(x, sums);
  EXPECT_EQ(sums[0], 60);
  EXPECT_EQ(sums[1], 150);
  Matrix B(2, 2);
  B(0, 0) = 1, B(0, 1) = 2, B(1, 0) = 3, B(1, 1) = 4;
  y.MvTimesMatAddMv(10, x, B, 1); // (3 + 10 (2 + 9), 5 + 10 (4 + 12))
  y.MvNorm(sums, Belos::InfNorm);
  EXPECT_EQ(sums[0], 113);
  EXPECT_EQ(sums[1], 165);
  y.SetBlock(x, {1, 0});
  EXPECT_EQ(y.vector(0)->normInf(), 3);
  EXPECT_EQ(y.vector(1)->normInf(), 2);
}

} // namespace
} // namespace krylov_vectors_test
