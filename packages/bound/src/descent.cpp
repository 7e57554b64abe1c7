// SPDX-License-Identifier: BSD-3-Clause
#include "descent.hpp"

#include <utility>

namespace rpc::bound
{
namespace
{

/// x <- a x + b y.
void combine(const double a, const Tractions &x, const double b, const Tractions &y)
{
  Kokkos::parallel_for(
      "rpc::bound::combine", device_range(static_cast<LO>(x.extent(0))),
      KOKKOS_LAMBDA(const LO i) { x(i) = a * x(i) + b * y(i); });
  Kokkos::fence();
}

} // namespace

Descent::Descent(Derivative derivative, Answer answer, Product product, const Tractions &t)
    : derivative_(std::move(derivative)), answer_(std::move(answer)), product_(std::move(product)), t_(t),
      g_("rpc::bound::g", t.extent(0)), z_("rpc::bound::z", t.extent(0)), d_("rpc::bound::d", t.extent(0))
{
  derivative_(t_, true, g_);
}

double Descent::step()
{
  answer_(g_, z_);
  const double rho = product_(g_, z_);
  if (!(rho > 0)) return 0;
  combine(rho_ > 0 ? rho / rho_ : 0, d_, -1, z_);
  rho_ = rho;
  const Tractions &Ad = z_; // which is in d by now
  derivative_(d_, false, Ad);
  const double curvature = product_(d_, Ad);
  if (!(curvature > 0)) return 0;
  const double length = rho / curvature;
  combine(1, t_, length, d_);
  combine(1, g_, length, Ad);
  return rho * length / 2;
}

} // namespace rpc::bound
