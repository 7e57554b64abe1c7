// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/gathered_solver.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/muelu.hpp"
#include "rpc/core/parallel.hpp"

#include <MueLu_Level.hpp>
#include <limits>
#include <stdexcept>

namespace rpc::solver
{
namespace
{

constexpr std::size_t most_rows = 5000; // on each rank

} // namespace

RCP<const Teuchos::ParameterList> GatheredSolver::GetValidParameterList() const
{
  const auto valid = Teuchos::parameterList();
  valid->set<RCP<const MueLu::FactoryBase>>("A", Teuchos::null);
  return valid;
}

void GatheredSolver::DeclareInput(MueLu::Level &level) const
{
  Input(level, "A");
}

void GatheredSolver::Setup(MueLu::Level &level)
{
  const auto A = Get<RCP<XpetraMatrix>>(level, "A");
  const auto &rows = *A->getRowMap(), &columns = *A->getColMap();
  RPC_REQUIRE(rows.getGlobalNumElements() <= most_rows,
              "deck: multigrid ends with a level of "
                  << rows.getGlobalNumElements() << " rows; without Zoltan2 several ranks can solve at most "
                  << most_rows << " of them together. Lower \"Linear Solver->MueLu->coarse: max size\", raise "
                  << "\"max levels\", or give a \"coarse: type\".");
  size_ = static_cast<int>(rows.getGlobalNumElements());
  SymmetricEntries mine;
  for (int row = 0; row < num_local(rows); ++row) {
    Teuchos::ArrayView<const int> column;
    Teuchos::ArrayView<const double> value;
    A->getLocalRowView(row, column, value);
    for (Teuchos_Ordinal k = 0; k < column.size(); ++k) { // coarse levels number their unknowns from 0
      mine.row.push_back(static_cast<int>(rows.getGlobalElement(row)));
      mine.column.push_back(static_cast<int>(columns.getGlobalElement(column[k])));
      mine.value.push_back(value[k]);
    }
  }
  factor_ = factor_of(size_, entries_of_all(*rows.getComm(), mine), std::numeric_limits<double>::infinity());
  if (!factor_) throw std::runtime_error("the coarse matrix is not positive definite");
  IsSetup(true);
}

void GatheredSolver::Apply(XpetraVectors &x, const XpetraVectors &b, bool) const
{
  const rpc::MultiVector &from = muelu::to_tpetra(b);
  rpc::MultiVector &to = muelu::to_tpetra(x);
  const rpc::Map &map = *from.getMap();
  const int num_local = static_cast<int>(from.getLocalLength());
  Kokkos::fence(); // the host reads and writes what kernels may still be at
  const auto right = from.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto left = to.getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (std::size_t k = 0; k < from.getNumVectors(); ++k) {
    std::vector<double> mine(size_, 0.);
    for (int i = 0; i < num_local; ++i) mine[map.getGlobalElement(i)] = right(i, k);
    std::vector<double> all = summed(*map.getComm(), mine);
    factor_->solve(all.data());
    for (int i = 0; i < num_local; ++i) left(i, k) = all[map.getGlobalElement(i)];
  }
}

RCP<CoarseSolver> GatheredSolver::Copy() const
{
  return rcp(new GatheredSolver(*this));
}

} // namespace rpc::solver
