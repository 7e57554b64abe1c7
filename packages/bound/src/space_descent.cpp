// SPDX-License-Identifier: BSD-3-Clause
#include "space_descent.hpp"

#include "rpc/core/memory.hpp"

namespace rpc::bound
{
namespace
{

/// t += a d.
void go_along(const double a, const Tractions &d, const Tractions &t)
{
  Kokkos::parallel_for(
      "rpc::bound::go_along", device_range(static_cast<LO>(t.extent(0))),
      KOKKOS_LAMBDA(const LO i) { t(i) += a * d(i); });
  Kokkos::fence();
}

} // namespace

SpaceDescent::SpaceDescent(const SpaceInput &in, const SpaceForms &forms, const RingSolves &rings, const Comm &comm,
                           const Tractions &t)
    : in_(in), forms_(forms), rings_(rings), comm_(comm), t_(t), d_("rpc::bound::d", t.extent(0)),
      g_("rpc::bound::g", t.extent(0))
{
  derivative(in_, forms_, t_, true, rings_.work_space());
  rings_.add_shares(1, rings_.work_space(), g_);
}

double SpaceDescent::step()
{
  const double rho = sum_all(comm_, rings_.solve(g_));
  if (!(rho > 0)) return 0;
  rings_.combine(rho_ > 0 ? rho / rho_ : 0, d_, -1);
  rho_ = rho;
  const DeviceView<float *> Ad = rings_.work_space();
  const double curvature = sum_all(comm_, derivative(in_, forms_, d_, false, Ad));
  if (!(curvature > 0)) return 0;
  const double length = rho / curvature;
  go_along(length, d_, t_);
  rings_.add_shares(length, Ad, g_);
  return rho * length / 2;
}

Descended descended(const SpaceInput &in, const mesh::Mesh &mesh, const fem::NodeToCells &around,
                    const BoundaryTractions &boundary, const SpaceForms &forms, DeviceView<double ***> &Q,
                    const Tractions &mean, const int steps)
{
  const SpaceExchanges exchanges(mesh, in.facets.node);
  Descended found{equilibrated(in, boundary, Q, mean, around, exchanges), {}};
  Q = {};
  return_freed_memory();
  const RingSolves rings(in, boundary, forms, exchanges);
  SpaceDescent descent(in, forms, rings, mesh.comm(), found.t);
  for (int step = 0; step < steps; ++step) found.falls.push_back(descent.step());
  return found;
}

} // namespace rpc::bound
