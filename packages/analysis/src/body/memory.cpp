// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/memory.hpp"

#include "rpc/contact/node_columns.hpp"
#include "rpc/fem/interpolation.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::analysis
{

Memory interpolated(const Memory &memory, const fem::Discretization &from, const fem::Discretization &to)
{
  return interpolated(memory, *fem::interpolation(from, to), to);
}

Memory interpolated(const Memory &memory, const Operator &interpolation, const fem::Discretization &to)
{
  const auto columns = [&](const MultiVector &values) {
    const auto result = rcp(new MultiVector(interpolation.getRangeMap(), values.getNumVectors()));
    if (values.getNumVectors() > 0) interpolation.apply(values, *result);
    return result;
  };
  const auto not_below_zero = [](const RCP<MultiVector> &values) { // quadratic interpolants dip
    const auto view = values->getLocalViewDevice(Tpetra::Access::ReadWrite);
    const LO n = static_cast<LO>(view.extent(0)), sides = static_cast<LO>(view.extent(1));
    Kokkos::parallel_for(
        "rpc::analysis::not_below_zero", device_range(n), KOKKOS_LAMBDA(const LO node) {
          for (LO k = 0; k < sides; ++k)
            if (view(node, k) < 0) view(node, k) = 0;
        });
    Kokkos::fence();
    return values;
  };
  Memory result = memory;
  result.displacement = fem::interpolated(interpolation, *memory.displacement, to.dim(), to.owned_dofs);
  result.pressure = not_below_zero(columns(*memory.pressure));
  result.dent = not_below_zero(columns(*memory.dent));
  result.gap = columns(*memory.gap);
  if (!memory.tangential.is_null()) result.tangential = columns(*memory.tangential);
  return result;
}

contact::ContactState state_of(const contact::ContactNodes &points, const Memory &memory)
{
  contact::ContactState state{memory.displacement, contact::at_points(points, *memory.pressure), {}};
  if (!memory.tangential.is_null())
    state.multiplier.tangential = contact::vectors_at_points(points, *memory.tangential);
  return state;
}

contact::ContactState extrapolated(const contact::ContactNodes &points, const Memory &before, const Memory &last,
                                   const double time)
{
  const double ratio = (time - last.time) / (last.time - before.time);
  const auto led_on = [ratio](const auto &then, const auto &now) {
    const auto later = rcp(new std::decay_t<decltype(now)>(now, Teuchos::Copy));
    later->update(-ratio, then, 1 + ratio);
    return later;
  };
  Memory later = last;
  later.displacement = led_on(*before.displacement, *last.displacement);
  later.pressure = led_on(*before.pressure, *last.pressure);
  if (!last.tangential.is_null() && !before.tangential.is_null())
    later.tangential = led_on(*before.tangential, *last.tangential);
  return state_of(points, later);
}

double Energies::largest() const
{
  return std::max({std::abs(strain), std::abs(foundation), std::abs(dissipated), std::abs(work), std::abs(friction)});
}

} // namespace rpc::analysis
