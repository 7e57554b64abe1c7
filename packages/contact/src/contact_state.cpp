#include "rpc/contact/contact_state.hpp"

#include "rpc/contact/node_columns.hpp"
#include "rpc/contact/result.hpp"

namespace rpc::contact
{
namespace
{

/// (owned dofs) -> (owned nodes; dim).
void to_columns(const Vector &u, const int dim, MultiVector &columns)
{
  const auto from = device_read(u);
  const auto to = columns.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "rpc::contact::to_columns", device_range(static_cast<LO>(columns.getLocalLength())),
      KOKKOS_LAMBDA(const LO node) {
        for (int k = 0; k < dim; ++k) to(node, k) = from(dof(dim, node, k));
      });
  Kokkos::fence();
}

/// The other way round.
void from_columns(const MultiVector &columns, const int dim, Vector &u)
{
  const auto from = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = device_write(u);
  Kokkos::parallel_for(
      "rpc::contact::from_columns", device_range(static_cast<LO>(columns.getLocalLength())),
      KOKKOS_LAMBDA(const LO node) {
        for (int k = 0; k < dim; ++k) to(dof(dim, node, k)) = from(node, k);
      });
  Kokkos::fence();
}

} // namespace

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

ContactState interpolated(const CrsMatrix &interpolation, const ContactNodes &coarse, const ContactState &state,
                          const ContactNodes &fine, const RCP<const Map> &fine_dofs)
{
  const int dim = fine.dim, sides = fine.num_sides();
  MultiVector from(interpolation.getDomainMap(), dim), to(interpolation.getRangeMap(), dim);
  to_columns(*state.displacement, dim, from);
  interpolation.apply(from, to);
  ContactState result{rcp(new Vector(fine_dofs)), {}, {}};
  from_columns(to, dim, *result.displacement);
  if (sides == 0) return result;
  MultiVector lambda(interpolation.getRangeMap(), sides);
  interpolation.apply(*node_columns(coarse, state.multiplier, interpolation.getDomainMap()), lambda);
  result.multiplier = at_points(fine, lambda);
  return result;
}

} // namespace rpc::contact
