// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/owner_questions.hpp"

#include "rpc/core/error.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace rpc::solver
{

std::vector<int> owners(const Map &map, const std::vector<GO> &gids)
{
  std::vector<int> ranks(gids.size(), 0);
  if (map.getComm()->getSize() > 1)
    map.getRemoteIndexList(Teuchos::ArrayView<const GO>(gids.data(), static_cast<Teuchos_Ordinal>(gids.size())),
                           Teuchos::ArrayView<int>(ranks.data(), static_cast<Teuchos_Ordinal>(ranks.size())));
  return ranks;
}

OwnerQuestions::Plan OwnerQuestions::plan(const Map &map, const std::vector<GO> &gids)
{
  const auto rank = owners(map, gids);
  std::vector<std::size_t> order(gids.size()); // of the questions: by the rank that is asked
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](const std::size_t a, const std::size_t b) { return rank[a] < rank[b]; });
  Plan plan{std::vector<int>(map.getComm()->getSize()), {}, std::vector<std::size_t>(gids.size())};
  for (std::size_t k = 0; k < order.size(); ++k) {
    ++plan.counts[rank[order[k]]];
    plan.questions.push_back(static_cast<double>(gids[order[k]]));
    plan.answer_of[order[k]] = k;
  }
  return plan;
}

OwnerQuestions::OwnerQuestions(const Map &map, const std::vector<GO> &gids) : OwnerQuestions(map, plan(map, gids)) {}

OwnerQuestions::OwnerQuestions(const Map &map, Plan plan)
    : comm_(map.getComm()), exchange_(*comm_, plan.counts), answer_of_(std::move(plan.answer_of))
{
  for (const double gid : exchange_.forward(plan.questions, 1))
    asked_.push_back(map.getLocalElement(static_cast<GO>(gid)));
}

NumberLists OwnerQuestions::answers(const NumberLists &mine) const
{
  std::size_t longest = 0;
  for (std::size_t r = 0; r < asked_.size(); ++r) longest = std::max(longest, mine.begin[r + 1] - mine.begin[r]);
  const std::size_t width = 1 + max_all(*comm_, longest); // the list's length and its numbers
  const double bytes =
      static_cast<double>(max_all(*comm_, asked_.size())) * static_cast<double>(width) * sizeof(double);
  RPC_REQUIRE_CODE(bytes < std::numeric_limits<int>::max(), ExitCode::bad_mesh,
                   "multigrid: neighbouring ranks would exchange "
                       << bytes << " bytes, of which a message has at most 2^31. Use more ranks.");
  std::vector<double> rows(width * asked_.size());
  for (std::size_t r = 0; r < asked_.size(); ++r) {
    const std::size_t first = mine.begin[r], size = mine.begin[r + 1] - first;
    rows[width * r] = static_cast<double>(size);
    std::copy_n(mine.value.data() + first, size, &rows[width * r] + 1);
  }
  const auto got = exchange_.back(rows, static_cast<int>(width));
  NumberLists lists;
  for (const std::size_t answer : answer_of_) {
    const double *const row = &got[width * answer];
    lists.value.insert(lists.value.end(), row + 1, row + 1 + static_cast<std::size_t>(row[0]));
    lists.begin.push_back(lists.value.size());
  }
  return lists;
}

} // namespace rpc::solver
