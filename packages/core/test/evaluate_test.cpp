// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/evaluate.hpp"

#include "rpc/core/error.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace evaluate_test
{
namespace
{

using rpc::Error;
using rpc::evaluate;
using rpc::ExitCode;
using rpc::HostView;
using rpc::Point;
using rpc::ScalarField;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Points (k, 10 k) with k = 0 .. n-1.
HostView<double **> some_points(const int n)
{
  HostView<double **> points("points", n, 2);
  for (int k = 0; k < n; ++k) {
    points(k, 0) = k;
    points(k, 1) = 10 * k;
  }
  return points;
}

template <class Points>
std::string message_of(const ScalarField &field, const Points &points, const bool allow_infinite = false)
{
  try {
    evaluate(field, points, "Contact->Gap", *Tpetra::getDefaultComm(), allow_infinite);
  } catch (const Error &error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
  return "";
}

TEST(Evaluate, GivesTheValueAtEachPointInAnyLayout)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto points = some_points(4);
  const Kokkos::View<double **, Kokkos::LayoutLeft, Kokkos::HostSpace> left("left", 4, 2);
  Kokkos::deep_copy(left, points);
  const HostView<const double **> read_only = points;
  const ScalarField field("x + y + z", [](const Point &x) { return x[0] + x[1] + x[2]; });
  for (const auto &values : {evaluate(field, points, "A", *comm), evaluate(field, left, "A", *comm),
                             evaluate(field, read_only, "A", *comm)}) {
    ASSERT_EQ(values.extent(0), 4u);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(values(k), 11 * k);
  }
}

TEST(Evaluate, ConstantIsTheSameEverywhere)
{
  const auto values = evaluate(ScalarField(2.5), some_points(3), "A", *Tpetra::getDefaultComm());
  ASSERT_EQ(values.extent(0), 3u);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(values(k), 2.5);
}

TEST(Evaluate, InfinityPassesOnlyWhereAllowed)
{
  const auto points = some_points(3);
  const ScalarField constant(inf), field("1/x", [](const Point &x) { return 1 / x[0]; });
  EXPECT_EQ(evaluate(constant, points, "A", *Tpetra::getDefaultComm(), true)(2), inf);
  EXPECT_EQ(evaluate(field, points, "A", *Tpetra::getDefaultComm(), true)(0), inf);
  EXPECT_NE(message_of(constant, points).find("got inf"), std::string::npos) << message_of(constant, points);
  EXPECT_EQ(message_of(field, points),
            "deck: \"Contact->Gap\" = \"1/x\" must be a finite number everywhere, got inf at (0, 0)");
}

TEST(Evaluate, NanIsRefusedWithItsFirstPoint)
{
  const ScalarField field("f", [](const Point &x) { return x[0] < 2 ? 1 : nan; });
  const std::string message = message_of(field, some_points(5), true);
  EXPECT_EQ(message, "deck: \"Contact->Gap\" = \"f\" must be a number or inf everywhere, got nan at (2, 20)");
  EXPECT_NE(message_of(ScalarField(nan), some_points(1), true), "");
}

TEST(Evaluate, BadValueOnOneRankIsThrownOnAll)
{
  const auto comm = Tpetra::getDefaultComm();
  const bool last = comm->getRank() == comm->getSize() - 1;
  const ScalarField field("f", [last](const Point &) { return last ? nan : 1; });
  EXPECT_NE(message_of(field, some_points(2)).find("got nan at (0, 0)"), std::string::npos);
  EXPECT_EQ(message_of(field, some_points(0)), ""); // no point, no value
}

} // namespace
} // namespace evaluate_test
