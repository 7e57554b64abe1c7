#pragma once

#include "solve.hpp"

namespace rpc
{

/// solve() on one mesh, whatever the target for the error is.
/// @param mesh      to be made, in place of the scene's
/// @param previous  solution on another mesh to start from; null: coarser meshes predict it
Solution solve_on(const Scene &scene, const mesh::MeshOptions &mesh, const Solution *previous,
                  const RCP<const Comm> &comm, std::ostream &console);

} // namespace rpc
