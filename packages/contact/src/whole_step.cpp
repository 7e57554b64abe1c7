// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/whole_step.hpp"

#include "rpc/contact/node_columns.hpp"
#include "rpc/core/math.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>

namespace rpc::contact
{

void WholeStep::add(const ContactNodes &points, const ContactResult &part, const RCP<const Map> &owned_nodes)
{
  if (!points.friction.anywhere) return;
  const auto slip = node_columns(points, part.slip, owned_nodes);
  if (!slip_.is_null()) slip->update(1., *slip_, 1.);
  slip_ = slip;
  work_.resize(part.sides.size(), 0.);
  for (std::size_t k = 0; k < work_.size(); ++k) work_[k] += part.sides[k].friction_work;
}

void WholeStep::take(const Comm &comm, const ContactNodes &points, ContactResult &last) const
{
  if (slip_.is_null()) return;
  const auto slip = vectors_at_points(points, *slip_);
  const auto weight = points.weight;
  const auto p = last.pressure;
  const int dim = points.dim;
  last.total.friction_work = last.total.max_slip = 0;
  for (int k = 0; k < points.num_sides(); ++k) {
    double largest = 0;
    Kokkos::parallel_reduce(
        "rpc::contact::whole_slip", Kokkos::RangePolicy<ExecutionSpace, LO>(points.first(k), points.first(k + 1)),
        KOKKOS_LAMBDA(const LO i, double &most) {
          double squares = 0;
          for (int j = 0; j < dim; ++j) squares += slip(i, j) * slip(i, j);
          if (weight(i) > 0 && p(i) > 0) most = math::larger(most, math::sqrt(squares));
        },
        Kokkos::Max<double>(largest));
    ContactSums &side = last.sides[k];
    side.friction_work = work_[k];
    side.max_slip = max_all(comm, std::max(0., largest)); // a maximum over no points is -DBL_MAX
    last.total.friction_work += side.friction_work;
    last.total.max_slip = std::max(last.total.max_slip, side.max_slip);
  }
}

} // namespace rpc::contact
