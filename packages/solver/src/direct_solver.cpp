#include "direct_solver.hpp"

#include "matrix_changes.hpp"
#include "rpc/core/memory.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace rpc::solver
{
namespace
{

constexpr const char *no_factor = "a sparse factor: the matrix is not positive definite";
// Rows up to which each rank factors the whole matrix: a solve then takes one sum over the ranks.
constexpr std::size_t most_rows_on_each_rank = 5200;
// A factor that takes less time [s] is made anew for the slightest change.
constexpr double short_time = 5e-3;
// New terms are solved for while they take worth_a_factor times a new factor's time at most. Where none of left_out keeps to that, they may
// take worth_factors times the time of all factors made so far, of most_factors_worth at most: later changes are at the same places.
constexpr double worth_a_factor = 0.7, worth_factors = 1.4;
constexpr int most_factors_worth = 3;
// Where all terms would take longer, those of changes up to such a part of a node's own block are left to CG.          (4.12)
constexpr double left_out[] = {0, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
// What an update keeps, over the entries of the factor, and over the memory that is free.
constexpr double kept_of_factor = 2, kept_of_free = 0.25;

/// Calls work(row, column, value) with gids for the entries of this rank's rows on and below the diagonal.
template <class Work>
void for_lower_entries(const CrsMatrix &A, const Work &work)
{
  const Map &rows = *A.getRowMap(), &columns = *A.getColMap();
  const auto matrix = A.getLocalMatrixDevice();
  const auto begin = to_host(matrix.graph.row_map);
  const auto entries = to_host(matrix.graph.entries);
  const auto values = to_host(matrix.values);
  for (LO row = 0; row < num_local(rows); ++row) {
    const GO i = rows.getGlobalElement(row);
    for (auto e = begin(row); e < begin(row + 1); ++e)
      if (const GO j = columns.getGlobalElement(entries(e)); j <= i) work(i, j, values(e));
  }
}

SymmetricEntries pattern_of(const CrsMatrix &A)
{
  SymmetricEntries mine;
  for_lower_entries(A, [&](const GO row, const GO column, double) {
    mine.row.push_back(static_cast<int>(row));
    mine.column.push_back(static_cast<int>(column));
  });
  return mine;
}

/// All unknowns on rank 0, by their gids.
RCP<const Map> on_root(const Map &rows)
{
  const std::size_t all = rows.getGlobalNumElements();
  return rcp(new Map(all, rows.getComm()->getRank() == 0 ? all : 0, 0, rows.getComm()));
}

} // namespace

DirectSolver::DirectSolver(RCP<const CrsMatrix> A, const int dofs_per_node)
    : A_(std::move(A)), dofs_per_node_(dofs_per_node)
{
  const auto comm = A_->getComm();
  on_one_rank_ = max_all(*comm, static_cast<std::size_t>(num_local(*A_->getRowMap()))) == A_->getGlobalNumRows();
  const int size = static_cast<int>(A_->getGlobalNumRows());
  const SymmetricEntries mine = pattern_of(*A_);
  if (comm->getSize() == 1 || !SparseFactor::can_be_shared || A_->getGlobalNumRows() <= most_rows_on_each_rank) {
    factor_ = SparseFactor::analyse(rcp(new Teuchos::SerialComm<int>), size,
                                    comm->getSize() > 1 ? entries_of_all(*comm, mine) : mine, dofs_per_node);
    return;
  }
  factor_ = SparseFactor::analyse(comm, size, mine, dofs_per_node);
  to_root_ = rcp(new Import(A_->getRowMap(), on_root(*A_->getRowMap())));
}

std::string DirectSolver::lacks_memory() const
{
  const Comm &comm = *A_->getComm();
  const double free = min_all(comm, memory_left()), needed = max_all(comm, cost().bytes * comm.getSize());
  if (needed <= free) return {};
  constexpr double gib = 1024. * 1024 * 1024;
  std::ostringstream text;
  text.precision(2);
  text << "a factor takes " << needed / gib << " GiB of memory, " << free / gib << " GiB are free";
  return text.str();
}

bool DirectSolver::make()
{
  const auto values = A_->getLocalMatrixDevice().values;
  if (factored_.extent(0) != values.extent(0))
    factored_ = HostView<double *>(Kokkos::ViewAllocateWithoutInitializing("rpc::solver::factored"), values.extent(0));
  Kokkos::deep_copy(factored_, values);
  std::vector<double> value;
  for_lower_entries(*A_, [&](GO, GO, const double entry) { value.push_back(entry); });
  const Comm &comm = *A_->getComm();
  update_.forget();
  ++factors_;
  return may_follow_ = factor_->make(to_root_.is_null() && comm.getSize() > 1 ? gathered_by_all(comm, value) : value);
}

/// By terms of rank one, by all of them or by the larger ones, if that takes less time than a new factor, else if it takes not much more
/// than the factors that were made before.
std::optional<CoarsestSolver::Update> DirectSolver::follow(const double slight)
{
  if (!may_follow_ || cost().seconds < short_time) return std::nullopt;
  const MatrixChanges changes = changes_since(factored_, *A_, dofs_per_node_);
  for (const double worth : {worth_a_factor, worth_factors * std::min(factors_, most_factors_worth)})
    for (const double least : left_out) {
      if (least > slight) continue;
      const LowRankTerms wanted = low_rank_terms(changes, least, dofs_per_node_);
      if (cost().seconds_of_column * update_.num_new(wanted.terms) > worth * cost().seconds) continue;
      const Comm &comm = *A_->getComm();
      const bool has_vectors = to_root_.is_null() || comm.getRank() == 0;
      const double most_kept =
          std::min(kept_of_factor * cost().entries, kept_of_free * min_all(comm, memory_left()) / sizeof(double));
      update_.set(*factor_, static_cast<int>(A_->getGlobalNumRows()), has_vectors, wanted.terms, wanted.couplings,
                  most_kept);
      return least == 0 ? Update::exact : Update::rough;
    }
  return std::nullopt;
}

CoarsestSolver::Update DirectSolver::update(const double slight)
{
  if (const auto done = follow(slight)) return *done;
  if (!make()) throw std::runtime_error(no_factor);
  return Update::made;
}

double DirectSolver::seconds_of_update() const
{
  return cost().seconds > short_time ? cost().seconds : 0;
}

void DirectSolver::apply(const Vector &b, Vector &x) const
{
  if (!factor_->exists()) throw std::runtime_error(no_factor); // the last update failed
  if (!to_root_.is_null()) {
    Kokkos::fence(); // the host reads and writes what kernels may still be at
    Vector all(to_root_->getTargetMap());
    all.doImport(b, *to_root_, Tpetra::INSERT);
    {
      const auto values = all.getLocalViewHost(Tpetra::Access::ReadWrite);
      update_.solve(*factor_, b.getMap()->getComm()->getRank() == 0 ? values.data() : nullptr);
    }
    x.doExport(all, *to_root_, Tpetra::INSERT);
    return;
  }
  const Map &map = *b.getMap();
  const LO num_rows = num_local(map);
  if (on_one_rank_ && num_rows == 0) return;
  std::vector<double> all(map.getGlobalNumElements());
  const HostView<double *> mine("rpc::solver::coarsest",
                                num_rows); // a copy: Tpetra's host views would move managed pages
  Kokkos::deep_copy(mine, DeviceView<const double *>(device_read(b)));
  for (LO i = 0; i < num_rows; ++i) all[map.getGlobalElement(i)] = mine(i);
  if (!on_one_rank_) all = summed(*map.getComm(), all);
  update_.solve(*factor_, all.data());
  for (LO i = 0; i < num_rows; ++i) mine(i) = all[map.getGlobalElement(i)];
  Kokkos::deep_copy(DeviceView<double *>(device_write(x)), mine);
}

std::unique_ptr<CoarsestSolver> direct_solver(RCP<const CrsMatrix> A, const int dofs_per_node, const double most_work)
{
  auto solver = std::make_unique<DirectSolver>(std::move(A), dofs_per_node);
  if (solver->cost().operations > most_work || !solver->lacks_memory().empty() || !solver->make()) return nullptr;
  return solver;
}

} // namespace rpc::solver
