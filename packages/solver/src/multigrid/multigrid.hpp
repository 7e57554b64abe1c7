// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <MueLu_TpetraOperator.hpp>
#include <Teuchos_ParameterList.hpp>

namespace rpc::solver
{

using Multigrid = MueLu::TpetraOperator<double, LO, GO, Node>;

/// MueLu's hierarchy for unknowns that lie node by node in every numbering, as MueLu::CreateTpetraPreconditioner would make
/// it, but sooner: MueLu 13.2 finds the nodes of the unknowns by a std::map, on the host, in more time than all else takes on a
/// GPU (14 of 17 s at 10.5M unknowns). Lists that name MueLu's factories themselves, or speak ML's language, go to MueLu as
/// they are. Collective.
/// @param list  of MueLu; its "user data" are Tpetra's
RCP<Multigrid> make_multigrid(const RCP<CrsMatrix> &A, Teuchos::ParameterList list);

/// The same hierarchy for other values of the matrix, zeros among them, as far as "reuse: type" keeps it; collective.
/// @param[in,out] multigrid  null where that fails, for MueLu leaves it half-cleared
/// @return whether it could be done
bool renew_multigrid(const RCP<CrsMatrix> &A, RCP<Multigrid> &multigrid);

} // namespace rpc::solver
