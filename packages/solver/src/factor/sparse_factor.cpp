// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/sparse_factor.hpp"

#include "factor/band_factor.hpp"
#ifdef RPC_HAVE_MUMPS
#include "factor/mumps_factor.hpp"
#endif

#include "rpc/core/parallel.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <cstdlib>

namespace rpc::solver
{

#ifdef RPC_HAVE_MUMPS
const bool SparseFactor::can_be_shared = true;
#else
const bool SparseFactor::can_be_shared = false;
#endif

#ifdef RPC_HAVE_MUMPS
namespace
{

/// How far from the diagonal entries lie.
int width_of(const SymmetricEntries &entries)
{
  int width = 0;
  for (std::size_t e = 0; e < entries.row.size(); ++e)
    width = std::max(width, std::abs(entries.row[e] - entries.column[e]));
  return width;
}

} // namespace
#endif

SymmetricEntries entries_of_all(const Comm &comm, const SymmetricEntries &mine)
{
  return {gathered_by_all(comm, mine.row), gathered_by_all(comm, mine.column), gathered_by_all(comm, mine.value)};
}

std::unique_ptr<SparseFactor> SparseFactor::analyse(const RCP<const Comm> &comm, const int size,
                                                    const SymmetricEntries &entries, const int dofs_per_node)
{
#ifdef RPC_HAVE_MUMPS
  // A band has no indices and no tree: it is taken where its factor takes no longer than MUMPS' analysis alone.
  if (comm->getSize() == 1) {
    const double seconds_of_analysis = cost_model.analysis_of_row * size;
    if (size <= linear_rules.most_rows_on_each_rank) {
      auto band = BandFactor::in_cuthill_mckee_order(size, entries);
      if (band->cost().seconds <= seconds_of_analysis) return band;
    }
    if (BandFactor::cost_of(size, width_of(entries)).seconds <= seconds_of_analysis)
      return BandFactor::as_numbered(size, entries);
  }
  return std::make_unique<MumpsFactor>(comm, size, entries, dofs_per_node);
#else
  static_cast<void>(comm);
  static_cast<void>(dofs_per_node);
  return BandFactor::in_cuthill_mckee_order(size, entries);
#endif
}

std::unique_ptr<SparseFactor> factor_of(const int size, const SymmetricEntries &entries, const double most_work)
{
  auto factor = SparseFactor::analyse(rcp(new Teuchos::SerialComm<int>), size, entries, 1);
  if (factor->cost().operations > most_work || !factor->make(entries.value)) return nullptr;
  return factor;
}

} // namespace rpc::solver
