// SPDX-License-Identifier: BSD-3-Clause
#include "factor/low_rank_update.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace low_rank_update_test
{
namespace
{

using rpc::solver::Coupling;
using rpc::solver::LowRankUpdate;
using rpc::solver::RankOneTerm;
using rpc::solver::SparseFactor;
using rpc::solver::SymmetricEntries;

constexpr int size = 12;

/// A chain of springs, each place held by a weak one.
SymmetricEntries chain()
{
  SymmetricEntries entries;
  for (int i = 0; i < size; ++i) {
    entries.row.push_back(i);
    entries.column.push_back(i);
    entries.value.push_back(2.1);
    if (i == 0) continue;
    entries.row.push_back(i);
    entries.column.push_back(i - 1);
    entries.value.push_back(-1);
  }
  return entries;
}

double along(const RankOneTerm &term, const std::vector<double> &x)
{
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    if (term.v[k] != 0) sum += term.v[k] * x[term.first_row + k];
  return sum;
}

void add(const RankOneTerm &term, const double factor, std::vector<double> &y)
{
  for (int k = 0; k < 3; ++k)
    if (term.v[k] != 0) y[term.first_row + k] += factor * term.v[k];
}

std::vector<double> product(const std::vector<RankOneTerm> &terms, const std::vector<Coupling> &couplings,
                            const std::vector<double> &x)
{
  std::vector<double> y(size);
  for (int i = 0; i < size; ++i) y[i] = 2.1 * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < size ? x[i + 1] : 0);
  for (const auto &term : terms) add(term, term.scale * along(term, x), y);
  for (const auto &[i, j, value] : couplings) {
    add(terms[i], value * along(terms[j], x), y);
    add(terms[j], value * along(terms[i], x), y);
  }
  return y;
}

class LowRankUpdateThatKeeps : public testing::TestWithParam<double> // at most so many entries of A^-1 V
{
};

/// Terms that come, change, go and come back; stiff ones, and one that takes away most of what is there.
TEST_P(LowRankUpdateThatKeeps, IsExactForAnyTerms)
{
  const auto entries = chain();
  const auto factor = SparseFactor::analyse(rpc::rcp(new Teuchos::SerialComm<int>), size, entries, 1);
  ASSERT_TRUE(factor->make(entries.value));
  const RankOneTerm slanted{3, {0.6, 0.8, 0}, 5}, stiff{6, {0, 0, 1}, 1e6}, weaker{9, {1, 0, 0}, -0.5},
      across{3, {-0.8, 0.6, 0}, 2};
  RankOneTerm changed = slanted;
  changed.scale = 50;
  for (double &component : changed.v) component *= -1; // the same line
  LowRankUpdate update;
  int columns = 0;
  struct Case {
    std::vector<RankOneTerm> terms;
    int num_new;
    std::vector<Coupling> couplings = {};
  };
  for (const Case &present :
       {Case{{}, 0}, Case{{slanted, stiff}, 2}, Case{{changed, weaker}, 1}, Case{{across}, 1}, Case{{}, 0},
        Case{{slanted, stiff, weaker, across}, 0}, Case{{slanted, across, weaker}, 0, {{0, 1, -1.5}, {2, 0, 0.7}}}}) {
    EXPECT_EQ(update.num_new(present.terms), present.num_new);
    update.set(*factor, size, true, present.terms, present.couplings, GetParam());
    columns += present.num_new;
    std::vector<double> x(size);
    for (int i = 0; i < size; ++i) x[i] = std::sin(1. + i);
    auto solution = product(present.terms, present.couplings, x);
    update.solve(*factor, solution.data());
    for (int i = 0; i < size; ++i) EXPECT_NEAR(solution[i], x[i], 1e-9) << present.terms.size() << " " << i;
  }
  update.forget();
  EXPECT_EQ(update.num_new({slanted, stiff, weaker, across}), 4);
  EXPECT_EQ(columns, 4);
}
// None, two of the four columns, all.
INSTANTIATE_TEST_SUITE_P(Entries, LowRankUpdateThatKeeps, testing::Values(0, 2 * size, 4 * size));

TEST(LowRankUpdate, ForgetsDirectionsOfLongAgo)
{
  const auto entries = chain();
  const auto factor = SparseFactor::analyse(rpc::rcp(new Teuchos::SerialComm<int>), size, entries, 1);
  ASSERT_TRUE(factor->make(entries.value));
  const RankOneTerm stays{0, {1, 0, 0}, 3};
  const auto turned = [](const int step) { return RankOneTerm{6, {std::cos(0.1 * step), std::sin(0.1 * step), 0}, 2}; };
  LowRankUpdate update;
  for (int step = 0; step < 12; ++step) { // two places have six directions: the stay and five turned ones, then anew
    const std::vector<RankOneTerm> terms{stays, turned(step)};
    EXPECT_EQ(update.num_new(terms), step % 5 == 0 ? 2 : 1) << step;
    update.set(*factor, size, true, terms, {}, 1e9);
    std::vector<double> x(size, 1.);
    auto solution = product(terms, {}, x);
    update.solve(*factor, solution.data());
    for (int i = 0; i < size; ++i) EXPECT_NEAR(solution[i], x[i], 1e-12) << step << " " << i;
  }
  EXPECT_EQ(update.num_new({stays, turned(11)}), 0);
  EXPECT_EQ(update.num_new({stays, turned(0)}), 1);
}

} // namespace
} // namespace low_rank_update_test
