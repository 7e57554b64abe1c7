// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/shared_rows.hpp"

#include "rpc/core/kokkos.hpp"

#include <Tpetra_RowMatrixTransposer.hpp>
#include <utility>

namespace rpc::solver
{

SharedRows::SharedRows(RCP<const CrsMatrix> A) : A_(std::move(A))
{
  if (max_all(*A_->getComm(), static_cast<int>(ExecutionSpace().concurrency())) > 1)
    transposed_ = Tpetra::RowMatrixTransposer<double, LO, GO, Node>(A_).createTransposeLocal();
}

} // namespace rpc::solver
