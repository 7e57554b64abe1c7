// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/newton.hpp"

namespace rpc::solver
{

/// What ends the iteration: Newton's tests, an interrupt, numbers that are not finite, or the deck's own tests in the place of Newton's.
RCP<NOX::StatusTest::Generic> status_tests(const NewtonOptions &options, const RCP<NewtonContext> &context);

} // namespace rpc::solver
