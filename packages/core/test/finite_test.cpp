// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/finite.hpp"

#include "expect_error.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace finite_test
{
namespace
{

using namespace rpc;

constexpr double inf = std::numeric_limits<double>::infinity();

/// Five nodes per rank in a row, 1 m apart, with two unknowns each.
struct Row {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  RCP<const Map> nodes = rcp(new Map(5 * comm->getSize(), 0, comm)),
                 dofs = rcp(new Map(10 * comm->getSize(), 10, 0, comm));
  RCP<MultiVector> coordinates = rcp(new MultiVector(nodes, 2));
  Vector v{dofs};

  Row()
  {
    for (LO n = 0; n < 5; ++n) coordinates->replaceLocalValue(n, 0, static_cast<double>(nodes->getGlobalElement(n)));
    v.putScalar(1);
  }
  void set(const GO node, const int direction, const double value)
  {
    if (dofs->isNodeGlobalElement(2 * node + direction)) v.replaceGlobalValue(2 * node + direction, value);
  }
  std::string refusal() const
  {
    const Error error = test::error_of([&] { require_finite(v, "the load", [&] { return coordinates; }); });
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
};

TEST(Finite, OrdinaryNumbersPassWithoutASearch)
{
  const Row row;
  const auto never = []() -> RCP<MultiVector> { throw std::logic_error("searched"); };
  EXPECT_NO_THROW(require_finite(row.v, "the load", never));
}

TEST(Finite, PlaceIsNamedOnEveryRank)
{
  for (const double value : {inf, -inf, std::nan("")}) {
    Row row;
    const GO node = 5 * row.comm->getSize() - 2; // on the last rank
    row.set(node, 1, value);
    row.set(0, 0, 1e300);
    const std::string text = row.refusal();
    EXPECT_NE(text.find("a number that is not finite appeared first in the load: "), std::string::npos) << text;
    EXPECT_NE(text.find("in direction Y of the node at (" + std::to_string(node) + ", 0)"), std::string::npos) << text;
  }
}

TEST(Finite, OverflowOfTheNormNamesTheLargestEntry)
{
  Row row;
  row.set(1, 0, -1e200);
  row.set(2, 0, 1e180);
  const std::string text = row.refusal();
  EXPECT_NE(text.find("squares overflow"), std::string::npos) << text;
  EXPECT_NE(text.find("-1e+200 in direction X of the node at (1, 0)"), std::string::npos) << text;
}

TEST(Finite, MatrixEntryIsNamedByItsRow)
{
  const Row row;
  CrsMatrix A(row.dofs, 2);
  for (LO i = 0; i < 10; ++i) {
    const GO gid = row.dofs->getGlobalElement(i);
    A.insertGlobalValues(gid, Teuchos::tuple<GO>(gid), Teuchos::tuple(gid == 7 ? inf : 1.));
  }
  A.fillComplete();
  test::expect_error(ExitCode::bad_input, "in the matrix: inf in direction Y of the node at (3, 0)",
                     [&] { require_finite(A, "the matrix", [&] { return row.coordinates; }); });
}

} // namespace
} // namespace finite_test
