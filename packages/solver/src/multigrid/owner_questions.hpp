// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/exchange.hpp"

#include <vector>

namespace rpc::solver
{

/// (gids) The rank that owns each index of a map; collective.
std::vector<int> owners(const Map &map, const std::vector<GO> &gids);

/// Lists of numbers, one after the other.
struct NumberLists {
  std::vector<std::size_t> begin{0}; ///< (lists + 1) where a list begins
  std::vector<double> value;         ///< doubles hold gids exactly
};

/// Questions to the ranks that own some indices of a map, which answer with a list of numbers for each index, as often as they are asked.
class OwnerQuestions
{
public:
  /// Collective. @param gids  of indices of the map, which any ranks own
  OwnerQuestions(const Map &map, const std::vector<GO> &gids);

  /// (questions that this rank answers) local indices.
  const std::vector<LO> &asked() const { return asked_; }
  /// (gids) The lists of their owners; collective. @param mine  (asked())
  /// @throws rpc::Error (bad_mesh) on all ranks if a message would be longer than MPI allows
  NumberLists answers(const NumberLists &mine) const;

private:
  /// What is counted for Exchange: rows for each rank, the questions in the order of these ranks.
  struct Plan {
    std::vector<int> counts;            // (ranks)
    std::vector<double> questions;      // gids
    std::vector<std::size_t> answer_of; // (gids) place among the questions
  };
  static Plan plan(const Map &map, const std::vector<GO> &gids);
  OwnerQuestions(const Map &map, Plan plan);

  RCP<const Comm> comm_;
  Exchange exchange_;
  std::vector<std::size_t> answer_of_;
  std::vector<LO> asked_;
};

} // namespace rpc::solver
