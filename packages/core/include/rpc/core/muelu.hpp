// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"
#include "rpc/core/xpetra.hpp"

#include <MueLu_AmalgamationFactory.hpp>
#include <MueLu_AmalgamationInfo.hpp>
#include <MueLu_FactoryManager.hpp>
#include <MueLu_config.hpp>
#include <Xpetra_CrsMatrixWrap.hpp>
#include <Xpetra_TpetraCrsMatrix.hpp>
#include <Xpetra_TpetraMultiVector.hpp>

#if defined(HAVE_MUELU_KOKKOS_REFACTOR) && __has_include(<MueLu_Aggregates_kokkos.hpp>)
#define RPC_MUELU_IS_DOUBLED
#include <MueLu_Aggregates.hpp>
#include <MueLu_Aggregates_kokkos.hpp>
#include <MueLu_AmalgamationFactory_kokkos.hpp>
#include <MueLu_AmalgamationInfo_kokkos.hpp>
#include <MueLu_LWGraph.hpp>
#include <MueLu_LWGraph_kokkos.hpp>
#include <MueLu_UncoupledAggregationFactory.hpp>
#include <MueLu_UncoupledAggregationFactory_kokkos.hpp>
#include <MueLu_Utilities_kokkos.hpp>
#endif

/// Names of MueLu that differ between Trilinos versions, see doc/trilinos_versions.md. Trilinos 13 has most factories twice:
/// for one thread, and for many under a name that ends in _kokkos. Later versions have each of them once.
namespace rpc::muelu
{

/// Whether MueLu can bring the coarse levels to fewer ranks.
#ifdef HAVE_MUELU_ZOLTAN2
inline constexpr bool has_repartitioning = true;
#else
inline constexpr bool has_repartitioning = false;
#endif

using HostAmalgamation = MueLu::AmalgamationFactory<double, LO, GO, Node>;
using HostAmalgamationInfo = MueLu::AmalgamationInfo<LO, GO, Node>;

#ifdef RPC_MUELU_IS_DOUBLED
using HostAggregates = MueLu::Aggregates<LO, GO, Node>;
using HostAggregation = MueLu::UncoupledAggregationFactory<LO, GO, Node>;
using HostGraph = MueLu::LWGraph<LO, GO, Node>; // of nodes
using HostGraphBase = MueLu::GraphBase<LO, GO, Node>;
using DeviceAggregates = MueLu::Aggregates_kokkos<LO, GO, Node>;
using DeviceAggregation = MueLu::UncoupledAggregationFactory_kokkos<LO, GO, Node>;
using DeviceAmalgamation = MueLu::AmalgamationFactory_kokkos<double, LO, GO, Node>;
using DeviceAmalgamationInfo = MueLu::AmalgamationInfo_kokkos<LO, GO, Node>;
using DeviceGraph = MueLu::LWGraph_kokkos<LO, GO, Node>;
using DeviceUtilities = MueLu::Utilities_kokkos<double, LO, GO, Node>;
#else
using DeviceAmalgamation = HostAmalgamation;
using DeviceAmalgamationInfo = HostAmalgamationInfo;
#endif

/// Whether a level is made by the factories for many threads.
inline bool takes_device_factories(const MueLu::FactoryManager<double, LO, GO, Node> &manager)
{
#ifdef RPC_MUELU_IS_DOUBLED
  return manager.GetKokkosRefactor();
#else
  static_cast<void>(manager);
  return true;
#endif
}

/// What MueLu takes in place of Tpetra's matrix and vectors, which it shares.
inline RCP<XpetraMatrix> to_xpetra(const RCP<CrsMatrix> &A)
{
  const RCP<Xpetra::CrsMatrix<double, LO, GO, Node>> inner = rcp(new Xpetra::TpetraCrsMatrix<double, LO, GO, Node>(A));
  return rcp(new Xpetra::CrsMatrixWrap<double, LO, GO, Node>(inner));
}
inline RCP<XpetraVectors> to_xpetra(const RCP<MultiVector> &v)
{
  return Xpetra::toXpetra(v);
}
/// Tpetra's vectors behind MueLu's.
inline const MultiVector &to_tpetra(const XpetraVectors &v)
{
  return Xpetra::toTpetra(v);
}
inline MultiVector &to_tpetra(XpetraVectors &v)
{
  return Xpetra::toTpetra(v);
}

} // namespace rpc::muelu
