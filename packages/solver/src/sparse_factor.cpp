#include "sparse_factor.hpp"

#include "band_factor.hpp"
#ifdef RPC_HAVE_MUMPS
#include "mumps_factor.hpp"
#endif

#include <Teuchos_DefaultSerialComm.hpp>
#include <utility>

namespace rpc::solver
{

#ifdef RPC_HAVE_MUMPS
const bool SparseFactor::can_be_shared = true;
#else
const bool SparseFactor::can_be_shared = false;
#endif

std::unique_ptr<SparseFactor> SparseFactor::analyse(const RCP<const Comm> &comm, const int size,
                                                    SymmetricEntries entries, const int dofs_per_node)
{
#ifdef RPC_HAVE_MUMPS
  // A band has no indices and no tree: it is faster where it is narrow. By measurement.
  constexpr int most_rows_of_band = 6000;
  constexpr double most_work_of_band = 1e8;
  if (comm->getSize() == 1 && size <= most_rows_of_band) {
    auto band = std::make_unique<BandFactor>(size, entries);
    if (band->cost().operations <= most_work_of_band) return band;
  }
  return std::make_unique<MumpsFactor>(comm, size, std::move(entries), dofs_per_node);
#else
  static_cast<void>(comm);
  static_cast<void>(dofs_per_node);
  return std::make_unique<BandFactor>(size, std::move(entries));
#endif
}

std::unique_ptr<SparseFactor> factor_of(const int size, SymmetricEntries entries, const double most_work)
{
  const std::vector<double> value = std::move(entries.value);
  auto factor = SparseFactor::analyse(rcp(new Teuchos::SerialComm<int>), size, std::move(entries), 1);
  if (factor->cost().operations > most_work || !factor->make(value)) return nullptr;
  return factor;
}

} // namespace rpc::solver
