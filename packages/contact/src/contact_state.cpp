#include "rpc/contact/contact_state.hpp"

#include "rpc/contact/node_columns.hpp"
#include "rpc/contact/result.hpp"
#include "rpc/fem/interpolation.hpp"

namespace rpc::contact
{
ContactState with_weightless(ContactState state, const ContactNodes &c, const fem::Discretization &d,
                             const std::vector<const mesh::Side *> &sides)
{
  if (c.num_weightless == 0) return state;
  const auto completed = completed_pressure(d, sides, c, state.multiplier);
  const DeviceView<double *> lambda("rpc::contact::completed_multiplier", c.size());
  const auto own = state.multiplier;
  Kokkos::parallel_for(
      "rpc::contact::complete_multipliers", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { lambda(i) = c.weight(i) > 0 ? own(i) : completed(i); });
  Kokkos::fence();
  state.multiplier = lambda;
  return state;
}

ContactState interpolated(const Operator &interpolation, const ContactNodes &coarse, const ContactState &state,
                          const ContactNodes &fine, const RCP<const Map> &fine_dofs)
{
  const int sides = fine.num_sides();
  ContactState result{fem::interpolated(interpolation, *state.displacement, fine.dim, fine_dofs), {}, {}};
  if (sides == 0) return result;
  MultiVector lambda(interpolation.getRangeMap(), sides);
  interpolation.apply(*node_columns(coarse, state.multiplier, interpolation.getDomainMap()), lambda);
  result.multiplier = at_points(fine, lambda);
  return result;
}

} // namespace rpc::contact
