// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/muelu_defaults.hpp"

#include "multigrid/gathered_solver.hpp"
#include "rpc/core/muelu.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>

namespace rpc::solver
{

Teuchos::ParameterList muelu_defaults(const Map &dofs, const int dofs_per_node)
{
  Teuchos::ParameterList list("MueLu");
  list.set("verbosity", "none");
  list.set("problem: symmetric", true);
  list.set("multigrid algorithm", "sa");
  list.set("aggregation: deterministic",
           true); // on threads too, where it costs nothing: 13.2 colors on one thread anyway
  list.set("number of equations", dofs_per_node);
  // An aggregate of few nodes has fewer unknowns than rigid motions: the coarse matrix has rows of zeros.
  list.set("rap: fix zero diagonals", true);
  list.set("smoother: type", "CHEBYSHEV");
  Teuchos::ParameterList &smoother = list.sublist("smoother: params");
  smoother.set("chebyshev: degree", int(linear_rules.muelu_degree));
  smoother.set("chebyshev: ratio eigenvalue", double(linear_rules.smoother_ratio));
  smoother.set("chebyshev: eigenvalue max iterations", 20);
  // On several ranks there is always a level below the finest one, so that what is solved directly has gone to one rank.
  const GO rows = static_cast<GO>(dofs.getGlobalNumElements());
  const bool alone = dofs.getComm()->getSize() == 1;
  const GO few = linear_rules.few_rows;
  list.set("coarse: max size", alone ? static_cast<int>(few)
                                     : static_cast<int>(std::clamp<GO>(rows / linear_rules.least_coarsening, 1, few)));
  if (muelu::has_repartitioning && !alone) { // the direct coarse solvers of 13.2 are wrong on a distributed matrix
    list.set("repartition: enable", true);
    list.set("repartition: partitioner", "zoltan2");
    list.set("repartition: start level", 1);
    list.set("repartition: rebalance P and R", false); // what reuse of prolongators asks for
    Teuchos::ParameterList &partitioner = list.sublist("repartition: params");
    partitioner.set("algorithm", "multijagged");
  }
  return list;
}

} // namespace rpc::solver
