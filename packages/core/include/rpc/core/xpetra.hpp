// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <Xpetra_Map.hpp>
#include <Xpetra_Matrix.hpp>
#include <Xpetra_MultiVector.hpp>

/// Xpetra's types, in which MueLu speaks, and its names that differ between Trilinos versions, see doc/trilinos_versions.md.
namespace rpc
{

using XpetraMap = Xpetra::Map<LO, GO, Node>;
using XpetraMatrix = Xpetra::Matrix<double, LO, GO, Node>;
using XpetraVectors = Xpetra::MultiVector<double, LO, GO, Node>;

/// (num_local) Global indices of this rank.
inline Teuchos::ArrayView<const GO> local_gids(const XpetraMap &map)
{
#if TRILINOS_MAJOR_MINOR_VERSION >= 130400
  return map.getLocalElementList();
#else
  return map.getNodeElementList();
#endif
}

} // namespace rpc
