#include "rpc/contact/result.hpp"

#include <algorithm>

namespace rpc::contact
{
namespace
{

/// Pressures at nodes that take no part in the solution.
void complete_pressure(const fem::Discretization &d, const mesh::Side &side, const ContactNodes &c,
                       const DeviceView<double *> &p)
{
  Vector value(d.mesh->owned_nodes), known(d.mesh->owned_nodes);
  {
    const auto to = device_write(value);
    const auto flag = device_write(known);
    Kokkos::parallel_for(
        "rpc::contact::known_pressure", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
          if (c.fixed(i) && c.free_gap(i) < 0) p(i) = c.yield(i);
          if (c.fixed(i) && c.free_gap(i) == 0) return;
          to(c.node(i)) = p(i);
          flag(c.node(i)) = 1;
        });
    Kokkos::fence();
  }
  fem::extend_to_unknown(d, side, value, known);
  const auto from = device_read(value);
  Kokkos::parallel_for(
      "rpc::contact::completed_pressure", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (c.fixed(i)) p(i) = clamp(from(c.node(i)), 0, c.yield(i));
      });
}

} // namespace

ContactResult contact_result(const fem::Discretization &d, const mesh::Side *side, const SmoothedFunctional &functional,
                             const Vector &u)
{
  const ContactNodes c = functional.contact();
  const LO n = c.size();
  ContactResult result;
  result.normal_displacement = DeviceView<double *>("rpc::contact::u_nu", n);
  result.penetration = DeviceView<double *>("rpc::contact::penetration", n);
  result.pressure = DeviceView<double *>("rpc::contact::pressure", n);
  result.state = DeviceView<int *>("rpc::contact::state", n);
  Kokkos::deep_copy(result.pressure, functional.multipliers());
  if (side && c.num_fixed > 0) complete_pressure(d, *side, c, result.pressure);

  const auto u_nu = result.normal_displacement;
  const auto v = result.penetration;
  const auto p = result.pressure;
  const auto s = result.state;
  double force[3] = {}, contact = 0, yielded = 0;
  {
    const auto x = device_read(u);
    Kokkos::parallel_reduce(
        "rpc::contact::result_sums", device_range(n),
        KOKKOS_LAMBDA(const LO i, double &fx, double &fy, double &fz, double &touched, double &given_way) {
          u_nu(i) = 0;
          for (int k = 0; k < c.dim; ++k) u_nu(i) += c.normal(i, k) * x(c.dim * c.node(i) + k);
          v(i) = u_nu(i) - c.gap(i);
          s(i) = static_cast<int>(p(i) >= c.yield(i) ? State::yielded : (p(i) > 0 ? State::stuck : State::open));
          const double share = c.weight(i) * p(i);
          fx -= share * c.normal(i, 0);
          fy -= share * c.normal(i, 1);
          if (c.dim == 3) fz -= share * c.normal(i, 2);
          if (p(i) > 0) touched += c.weight(i);
          if (p(i) >= c.yield(i)) given_way += c.weight(i);
        },
        force[0], force[1], force[2], contact, yielded);
  }
  double peak = 0, deepest = 0, initial = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::result_maxima", device_range(n),
      KOKKOS_LAMBDA(const LO i, double &most, double &deep, double &overlap) {
        if (p(i) > most) most = p(i);
        if (v(i) > deep) deep = v(i);
        if (-c.gap(i) > overlap) overlap = -c.gap(i);
      },
      Kokkos::Max<double>(peak), Kokkos::Max<double>(deepest), Kokkos::Max<double>(initial));

  const Comm &comm = d.mesh->comm();
  const double sums[5] = {force[0], force[1], force[2], contact, yielded};
  double all[5];
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 5, sums, all);
  result.force = {all[0], all[1], all[2]};
  result.contact_length = all[3];
  result.yielded_length = all[4];
  const double maxima[3] = {peak, deepest, initial}; // Kokkos' maximum over no nodes is -DBL_MAX
  double largest[3];
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 3, maxima, largest);
  result.max_pressure = std::max(0., largest[0]);
  result.max_penetration = std::max(0., largest[1]);
  result.max_initial_penetration = std::max(0., largest[2]);
  return result;
}

} // namespace rpc::contact
