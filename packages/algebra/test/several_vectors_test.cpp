// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/several_vectors.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace several_vectors_test
{
namespace
{

using namespace rpc;

/// Vectors of which the last of several ranks has no row.
struct Case {
  explicit Case(const int count, const GO rows = 4099)
  {
    const auto comm = Tpetra::getDefaultComm();
    const int ranks = comm->getSize(), holders = std::max(1, ranks - 1);
    const GO share = rows / holders;
    const GO mine = comm->getRank() >= holders ? 0 : comm->getRank() == 0 ? rows - share * (holders - 1) : share;
    map =
        rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), static_cast<std::size_t>(mine), 0, comm));
    for (int j = 0; j < count; ++j) x.push_back(filled(j));
    y = filled(0.5);
  }
  RCP<Vector> filled(const double phase) const
  {
    const auto v = rcp(new Vector(map));
    const auto values = v->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO row = 0; row < num_local(*map); ++row)
      values(row, 0) = std::sin(1 + 0.37 * static_cast<double>(map->getGlobalElement(row)) * (1 + phase));
    return v;
  }

  RCP<const Map> map;
  std::vector<RCP<const Vector>> x;
  RCP<Vector> y;
};

TEST(SeveralVectors, HaveTheDotsOfEachOne)
{
  for (const int count : {0, 1, 2, 3, 7, 8, 9, 17, 50}) {
    SCOPED_TRACE(count);
    const Case of(count);
    const auto all = dots(of.x, *of.y);
    ASSERT_EQ(all.size(), of.x.size());
    for (int j = 0; j < count; ++j) {
      const double scale = of.x[j]->norm2() * of.y->norm2();
      EXPECT_NEAR(all[j], of.x[j]->dot(*of.y), 1e-14 * scale) << j;
    }
  }
}

TEST(SeveralVectors, AddUpLikeOneAfterTheOther)
{
  for (const int count : {0, 1, 2, 3, 7, 8, 9, 17, 50})
    for (const double beta : {0., 1., -2.}) {
      SCOPED_TRACE(count);
      const Case of(count);
      std::vector<double> a(count);
      Vector expected(*of.y, Teuchos::Copy);
      expected.scale(beta);
      for (int j = 0; j < count; ++j) {
        a[j] = std::cos(j);
        expected.update(a[j], *of.x[j], 1.);
      }
      add_combination(a, of.x, beta, *of.y);
      expected.update(-1., *of.y, 1.);
      EXPECT_LT(expected.normInf(), 1e-14 * (1 + count));
    }
}

TEST(SeveralVectors, OverwriteWhatIsNoNumberWhereNothingOfItIsKept)
{
  const Case of(3);
  for (const int count : {0, 3}) {
    of.y->putScalar(std::numeric_limits<double>::quiet_NaN());
    add_combination(std::vector<double>(count, 1.), {of.x.begin(), of.x.begin() + count}, 0., *of.y);
    EXPECT_TRUE(std::isfinite(of.y->norm2()));
  }
}

} // namespace
} // namespace several_vectors_test
