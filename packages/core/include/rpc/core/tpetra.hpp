// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_RCP.hpp>
#include <Tpetra_CrsGraph.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>
#include <Trilinos_version.h>

/// Tpetra types of this project, and its names that differ between Trilinos versions, see doc/trilinos_versions.md.
namespace rpc
{

using Teuchos::RCP;
using Teuchos::rcp;
using Comm = Teuchos::Comm<int>;
using Map = Tpetra::Map<LO, GO, Node>;
using Import = Tpetra::Import<LO, GO, Node>;
using Vector = Tpetra::Vector<double, LO, GO, Node>;
using MultiVector = Tpetra::MultiVector<double, LO, GO, Node>;
using CrsGraph = Tpetra::CrsGraph<LO, GO, Node>;
using CrsMatrix = Tpetra::CrsMatrix<double, LO, GO, Node>;
using Operator = Tpetra::Operator<double, LO, GO, Node>;

/// Number of indices of a map of Tpetra or Xpetra that this rank holds.
template <class AnyMap>
LO num_local(const AnyMap &map)
{
#if TRILINOS_MAJOR_MINOR_VERSION >= 130400
  return static_cast<LO>(map.getLocalNumElements());
#else
  return static_cast<LO>(map.getNodeNumElements());
#endif
}

/// A vector's first column as a rank-1 device view, to read or to write.
inline auto device_read(const Vector &v)
{
  return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL(), 0);
}
inline auto device_write(Vector &v)
{
  return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::ReadWrite), Kokkos::ALL(), 0);
}

/// What a vector holds at some columns, those of other ranks too; collective.
/// @param importer  of the vector to the columns; null where these are its indices
inline Vector at_columns(const RCP<const Map> &columns, const RCP<const Import> &importer, const Vector &x)
{
  Vector result(columns);
  if (importer.is_null())
    result.update(1., x, 0.);
  else
    result.doImport(x, *importer, Tpetra::INSERT);
  return result;
}

/// The same at the columns of a matrix on whose domain the vector is.
inline Vector at_columns(const CrsMatrix &A, const Vector &x)
{
  return at_columns(A.getColMap(), A.getGraph()->getImporter(), x);
}

/// Sum, maximum or minimum of one number over all ranks; collective.
template <class T>
T sum_all(const Comm &comm, const T value)
{
  T result{};
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, value, Teuchos::outArg(result));
  return result;
}
template <class T>
T max_all(const Comm &comm, const T value)
{
  T result{};
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, value, Teuchos::outArg(result));
  return result;
}
template <class T>
T min_all(const Comm &comm, const T value)
{
  T result{};
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MIN, value, Teuchos::outArg(result));
  return result;
}

} // namespace rpc
