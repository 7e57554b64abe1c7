// SPDX-License-Identifier: BSD-3-Clause
#include "gap_slopes.hpp"

#include "rpc/fem/surface.hpp"

namespace rpc::adapt
{

RCP<const MultiVector> gap_slopes(const fem::Discretization &d, const GapSlopes &slopes)
{
  Kokkos::deep_copy(slopes.steepest, -1.);
  Kokkos::parallel_for("rpc::adapt::gap_slopes", device_range(static_cast<LO>(slopes.terms.facets.extent(0))), slopes);
  Kokkos::fence();
  const auto owned = rcp(new MultiVector(d.mesh->owned_nodes, int(GapSlopes::num_around)));
  {
    const auto to = owned->getLocalViewDevice(Tpetra::Access::ReadWrite);
    const auto steepest = slopes.steepest;
    Kokkos::parallel_for(
        "rpc::adapt::owned_gap_slopes", device_range(static_cast<LO>(to.extent(0))), KOKKOS_LAMBDA(const LO n) {
          for (int k = 0; k < int(GapSlopes::num_around); ++k) to(n, k) = steepest(n, k);
        });
    Kokkos::fence();
  }
  return fem::nodes_on_overlap(d, owned);
}

} // namespace rpc::adapt
