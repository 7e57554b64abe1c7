// SPDX-License-Identifier: BSD-3-Clause
#include "factor/direct_solver.hpp"

#include "factor/band_factor.hpp"
#include "factor/matrix_changes.hpp"
#include "rpc/core/memory.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/solver/rules.hpp"

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
/// The entries of this rank's rows on and below the diagonal, by gids, without values.
/// @param lower  <- (entries) which of all of the rank's entries each is
SymmetricEntries pattern_of(const CrsMatrix &A, std::vector<std::size_t> &lower)
{
  const Map &rows = *A.getRowMap(), &columns = *A.getColMap();
  const auto graph = A.getLocalMatrixDevice().graph;
  const auto begin = to_host(graph.row_map);
  const auto entries = to_host(graph.entries);
  std::vector<int> gid_of_column(num_local(columns));
  for (LO j = 0; j < num_local(columns); ++j) gid_of_column[j] = static_cast<int>(columns.getGlobalElement(j));
  SymmetricEntries mine;
  lower.clear();
  for (LO row = 0; row < num_local(rows); ++row) {
    const int i = static_cast<int>(rows.getGlobalElement(row));
    for (auto e = begin(row); e < begin(row + 1); ++e) {
      const int j = gid_of_column[entries(e)];
      if (j > i) continue;
      mine.row.push_back(i);
      mine.column.push_back(j);
      lower.push_back(e);
    }
  }
  return mine;
}

/// All unknowns on rank 0, by their gids.
RCP<const Map> on_root(const Map &rows)
{
  const std::size_t all = rows.getGlobalNumElements();
  return rcp(new Map(all, rows.getComm()->getRank() == 0 ? all : 0, 0, rows.getComm()));
}

} // namespace

DirectSolver::DirectSolver(RCP<const CrsMatrix> A, const int dofs_per_node, const bool is_band)
    : A_(std::move(A)), dofs_per_node_(dofs_per_node)
{
  const auto comm = A_->getComm();
  on_one_rank_ = max_all(*comm, static_cast<std::size_t>(num_local(*A_->getRowMap()))) == A_->getGlobalNumRows();
  const int size = static_cast<int>(A_->getGlobalNumRows());
  const SymmetricEntries mine = pattern_of(*A_, lower_);
  if (comm->getSize() == 1 || !SparseFactor::can_be_shared ||
      static_cast<GO>(A_->getGlobalNumRows()) <= linear_rules.most_rows_on_each_rank || is_band) {
    const SymmetricEntries all = comm->getSize() > 1 ? entries_of_all(*comm, mine) : mine;
    if (is_band)
      factor_ = BandFactor::as_numbered(size, all);
    else
      factor_ = SparseFactor::analyse(rcp(new Teuchos::SerialComm<int>), size, all, dofs_per_node);
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
  std::vector<double> value(lower_.size());
  for (std::size_t k = 0; k < lower_.size(); ++k) value[k] = factored_(lower_[k]);
  const Comm &comm = *A_->getComm();
  update_.forget();
  return may_follow_ = factor_->make(to_root_.is_null() && comm.getSize() > 1 ? gathered_by_all(comm, value) : value);
}

/// By terms of rank one, by all of them or by the larger ones, if that takes less time than a new factor.
std::optional<CoarsestSolver::Update> DirectSolver::follow(const double slight)
{
  if (!may_follow_ || cost().seconds < linear_rules.short_time) return std::nullopt;
  const MatrixChanges changes = changes_since(factored_, *A_, dofs_per_node_);
  for (const double least : {0., slight}) {
    const LowRankTerms wanted = low_rank_terms(changes, least, dofs_per_node_);
    if (cost().seconds_of_column * update_.num_new(wanted.terms) > cost().seconds) continue;
    const Comm &comm = *A_->getComm();
    const bool has_vectors = to_root_.is_null() || comm.getRank() == 0;
    const double most_kept = linear_rules.kept_of_free * min_all(comm, memory_left()) / sizeof(double);
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
  return cost().seconds > linear_rules.short_time ? cost().seconds : 0;
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

std::unique_ptr<CoarsestSolver> direct_solver(RCP<const CrsMatrix> A, const int dofs_per_node)
{
  auto solver = std::make_unique<DirectSolver>(std::move(A), dofs_per_node);
  if (!solver->lacks_memory().empty() || !solver->make()) return nullptr;
  return solver;
}

} // namespace rpc::solver
