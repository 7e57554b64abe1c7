#include "rpc/solver/sparse_factor.hpp"

#include "band_factor.hpp"
#ifdef RPC_HAVE_MUMPS
#include "mumps_factor.hpp"
#endif

#include "rpc/core/parallel.hpp"

#include <Teuchos_DefaultSerialComm.hpp>

namespace rpc::solver
{

#ifdef RPC_HAVE_MUMPS
const bool SparseFactor::can_be_shared = true;
#else
const bool SparseFactor::can_be_shared = false;
#endif

SymmetricEntries entries_of_all(const Comm &comm, const SymmetricEntries &mine)
{
  return {gathered_by_all(comm, mine.row), gathered_by_all(comm, mine.column), gathered_by_all(comm, mine.value)};
}

std::unique_ptr<SparseFactor> SparseFactor::analyse(const RCP<const Comm> &comm, const int size,
                                                    const SymmetricEntries &entries, const int dofs_per_node)
{
#ifdef RPC_HAVE_MUMPS
  // A band has no indices and no tree: it is faster where it is narrow. By measurement.
  constexpr int most_rows_of_band = 6000;
  constexpr double most_work_of_band = 1e8;
  if (comm->getSize() == 1 && size <= most_rows_of_band) {
    auto band = std::make_unique<BandFactor>(size, entries);
    if (band->cost().operations <= most_work_of_band) return band;
  }
  return std::make_unique<MumpsFactor>(comm, size, entries, dofs_per_node);
#else
  static_cast<void>(comm);
  static_cast<void>(dofs_per_node);
  return std::make_unique<BandFactor>(size, entries);
#endif
}

std::unique_ptr<SparseFactor> factor_of(const int size, const SymmetricEntries &entries, const double most_work)
{
  auto factor = SparseFactor::analyse(rcp(new Teuchos::SerialComm<int>), size, entries, 1);
  if (factor->cost().operations > most_work || !factor->make(entries.value)) return nullptr;
  return factor;
}

} // namespace rpc::solver
