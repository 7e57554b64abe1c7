// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/linear_solver.hpp"

namespace rpc::solver
{

std::string solver_path(const LinearSolverCounts &counts)
{
  std::string text;
  for (const std::string &taken : counts.path) text += (text.empty() ? "" : " -> ") + taken;
  return text;
}

std::string chosen_solver(const LinearSolverCounts &counts)
{
  return counts.description + (counts.path.size() > 1 ? " (" + solver_path(counts) + ")" : "");
}

} // namespace rpc::solver
