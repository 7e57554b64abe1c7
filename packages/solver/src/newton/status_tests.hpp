// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/newton.hpp"

namespace rpc::solver
{

/// What ends a minimization whatever its steps are: an interrupt, numbers that are not finite, the deck's own tests.
RCP<NOX::StatusTest::Generic> status_tests(const NewtonOptions &options);

/// What ends Newton's steps; null: the deck's own tests do.
RCP<NOX::StatusTest::Generic> newton_tests(const NewtonOptions &options, const RCP<NewtonContext> &context);

} // namespace rpc::solver
