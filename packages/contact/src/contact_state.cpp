// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/contact_state.hpp"

#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/node_columns.hpp"
#include "rpc/contact/result.hpp"
#include "rpc/fem/interpolation.hpp"

namespace rpc::contact
{
Multipliers Multipliers::copy() const
{
  Multipliers result(DeviceView<double *>("rpc::contact::multiplier", normal.extent(0)));
  Kokkos::deep_copy(result.normal, normal);
  if (has_tangential()) {
    result.tangential = DeviceView<double **>("rpc::contact::tangential", tangential.extent(0), tangential.extent(1));
    Kokkos::deep_copy(result.tangential, tangential);
  }
  return result;
}

ContactState with_weightless(ContactState state, const ContactNodes &c, const fem::Discretization &d,
                             const std::vector<const mesh::Side *> &sides)
{
  if (c.num_weightless == 0) return state;
  const auto completed = completed_pressure(d, sides, c, state.multiplier.normal);
  const DeviceView<double *> lambda("rpc::contact::completed_multiplier", c.size());
  const auto own = state.multiplier.normal;
  Kokkos::parallel_for(
      "rpc::contact::complete_multipliers", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { lambda(i) = c.weight(i) > 0 ? own(i) : completed(i); });
  Kokkos::fence();
  state.multiplier.normal = lambda;
  return state;
}

RCP<Vector> on_foundation(const ContactNodes &points, const ContactState &state)
{
  const ContactNodes c = points;
  const auto p = state.multiplier.normal;
  auto u = rcp(new Vector(*state.displacement, Teuchos::Copy));
  const auto x = device_write(*u);
  for_each_point_by_group( // a node of two sides is moved for one after the other
      "rpc::contact::on_foundation", points, KOKKOS_LAMBDA(const LO i) {
        const Foundation f = c.law(i);
        if (c.fixed(i) || !leaves_pressure_open(f) || state_of_pressure(p(i), f) != State::closed) return;
        const double move = penetration(c, i, x) / squared_length(c, i);
        for (int k = 0; k < c.dim; ++k) x(c.dof(i, k)) -= move * c.direction(i, k);
      });
  Kokkos::fence();
  return u;
}

ContactState interpolated(const Operator &interpolation, const ContactNodes &coarse, const ContactState &state,
                          const ContactNodes &fine, const RCP<const Map> &fine_dofs)
{
  ContactState result{fem::interpolated(interpolation, *state.displacement, fine.dim, fine_dofs), {}, {}};
  if (fine.num_sides() == 0) return result;
  const auto at_fine = [&](const MultiVector &columns) {
    MultiVector values(interpolation.getRangeMap(), columns.getNumVectors());
    interpolation.apply(columns, values);
    return values;
  };
  const auto nodes = interpolation.getDomainMap();
  result.multiplier.normal = at_points(fine, at_fine(*node_columns(coarse, state.multiplier.normal, nodes)));
  if (sum_all(*nodes->getComm(), GO(state.multiplier.has_tangential())) > 0)
    result.multiplier.tangential =
        vectors_at_points(fine, at_fine(*node_columns(coarse, state.multiplier.tangential, nodes)));
  return result;
}

} // namespace rpc::contact
