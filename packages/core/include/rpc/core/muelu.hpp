#pragma once

#include "rpc/core/tpetra.hpp"

#include <MueLu_Aggregates.hpp>
#include <MueLu_AmalgamationFactory.hpp>
#include <MueLu_AmalgamationInfo.hpp>
#include <MueLu_UncoupledAggregationFactory.hpp>
#include <MueLu_Utilities.hpp>
#include <MueLu_config.hpp>

#if defined(HAVE_MUELU_KOKKOS_REFACTOR) && __has_include(<MueLu_Aggregates_kokkos.hpp>)
#define RPC_MUELU_IS_DOUBLED
#include <MueLu_Aggregates_kokkos.hpp>
#include <MueLu_AmalgamationFactory_kokkos.hpp>
#include <MueLu_AmalgamationInfo_kokkos.hpp>
#include <MueLu_UncoupledAggregationFactory_kokkos.hpp>
#include <MueLu_Utilities_kokkos.hpp>
#endif

/// Names of MueLu that differ between Trilinos versions, see doc/trilinos_versions.md. Trilinos 13 has most factories twice:
/// for one thread, and for many under a name that ends in _kokkos. Later versions have merged them; both names are the
/// same there.
namespace rpc::muelu
{

/// Whether MueLu can bring the coarse levels to fewer ranks.
#ifdef HAVE_MUELU_ZOLTAN2
inline constexpr bool has_repartitioning = true;
#else
inline constexpr bool has_repartitioning = false;
#endif

using HostAggregates = MueLu::Aggregates<LO, GO, Node>;
using HostAggregation = MueLu::UncoupledAggregationFactory<LO, GO, Node>;
using HostAmalgamation = MueLu::AmalgamationFactory<double, LO, GO, Node>;
using HostAmalgamationInfo = MueLu::AmalgamationInfo<LO, GO, Node>;
using HostUtilities = MueLu::Utilities<double, LO, GO, Node>;

#ifdef RPC_MUELU_IS_DOUBLED
inline constexpr bool is_doubled = true;
using DeviceAggregates = MueLu::Aggregates_kokkos<LO, GO, Node>;
using DeviceAggregation = MueLu::UncoupledAggregationFactory_kokkos<LO, GO, Node>;
using DeviceAmalgamation = MueLu::AmalgamationFactory_kokkos<double, LO, GO, Node>;
using DeviceAmalgamationInfo = MueLu::AmalgamationInfo_kokkos<LO, GO, Node>;
using DeviceUtilities = MueLu::Utilities_kokkos<double, LO, GO, Node>;
#else
inline constexpr bool is_doubled = false;
using DeviceAggregates = HostAggregates;
using DeviceAggregation = HostAggregation;
using DeviceAmalgamation = HostAmalgamation;
using DeviceAmalgamationInfo = HostAmalgamationInfo;
using DeviceUtilities = HostUtilities;
#endif

} // namespace rpc::muelu
