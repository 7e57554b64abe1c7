// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

// Tractions and displacements converge where a part sticks and a part slips.

namespace friction_order_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// Points of the mesh with 16 cells, out of a finer one.
std::vector<ContactPoint> thinned(const std::vector<ContactPoint> &points, const std::size_t every)
{
  std::vector<ContactPoint> some;
  for (std::size_t i = 0; i < points.size(); i += every) some.push_back(points[i]);
  return some;
}

struct Errors {
  double q, p, slip; ///< root mean squares over the contact side, by the reference's
};
Errors errors(const std::vector<ContactPoint> &points, const std::vector<ContactPoint> &fine)
{
  const auto reference = thinned(fine, (fine.size() - 1) / (points.size() - 1));
  EXPECT_EQ(points.size(), reference.size());
  std::array<double, 3> differences{}, sizes{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].x[0], reference[i].x[0], 1e-12);
    const auto add = [&](const int k, const double mine, const double its) {
      differences[k] += points[i].weight * std::pow(mine - its, 2);
      sizes[k] += points[i].weight * its * its;
    };
    add(0, points[i].q[0], reference[i].q[0]);
    add(1, points[i].pressure, reference[i].pressure);
    add(2, points[i].slip[0], reference[i].slip[0]);
  }
  return {std::sqrt(differences[0] / sizes[0]), std::sqrt(differences[1] / sizes[1]),
          std::sqrt(differences[2] / sizes[2])};
}

std::vector<ContactPoint> solution(const std::string &element, const int cells)
{
  return contact_points(solved("wave", {"Mesh->Element=" + element, "Mesh->Cells={" + std::to_string(cells) + ", " +
                                                                        std::to_string(cells / 2) + "}"}));
}

class FrictionOrder : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Elements, FrictionOrder, testing::Values("P1", "Q1", "Q2"));

// Where slip begins q has a kink of the root's kind: u is in H^(5/2). Elements of order 1 have the full order 2 for displacements, and
// the nodes' tractions, means over a cell, at least 1.5; order 2 gains no order, but is nearer.
TEST_P(FrictionOrder, OfTractionsAndSlip)
{
  const std::string element = GetParam();
  const bool quadratic = element == "Q2";
  const auto fine = solution(element, quadratic ? 128 : 256);
  const FrictionCounts n = friction_counts(fine);
  EXPECT_GT(n.stick, 20);
  EXPECT_GT(n.slip, 20);
  std::vector<Errors> found;
  for (const int cells : {16, 32, 64}) found.push_back(errors(solution(element, quadratic ? cells / 2 : cells), fine));
  const auto order = [&](double Errors::*value) { return std::log2(found.front().*value / found.back().*value) / 2; };
  for (const Errors &e : found) RecordProperty("errors" + text(e.q), text(e.q) + " " + text(e.p) + " " + text(e.slip));
  RecordProperty("orders", text(order(&Errors::q)) + " " + text(order(&Errors::p)) + " " + text(order(&Errors::slip)));
  EXPECT_GT(order(&Errors::q), 1.3) << found[0].q << " " << found[1].q << " " << found[2].q;
  EXPECT_GT(order(&Errors::p), 1.3) << found[0].p << " " << found[1].p << " " << found[2].p;
  EXPECT_GT(order(&Errors::slip), 1.6) << found[0].slip << " " << found[1].slip << " " << found[2].slip;
  EXPECT_LT(found.back().q, element == "P1" ? 0.015 : 0.003);
}

} // namespace
} // namespace friction_order_test
