// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::solver
{

/// Thrown on all ranks where the run has been asked to stop; no std::exception, of which Belos would tell the console.
struct Interrupted {
};

} // namespace rpc::solver
