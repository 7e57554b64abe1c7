#include "rpc/contact/prediction.hpp"

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
        for (int k = 0; k < dim; ++k) to(node, k) = from(dim * node + k);
      });
  Kokkos::fence();
}

/// The other way round, but for prescribed dofs.
void from_columns(const MultiVector &columns, const fem::DirichletDofs &dirichlet, const int dim, Vector &u)
{
  const auto fixed = dirichlet.fixed;
  const auto from = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = device_write(u);
  Kokkos::parallel_for(
      "rpc::contact::from_columns", device_range(static_cast<LO>(columns.getLocalLength())),
      KOKKOS_LAMBDA(const LO node) {
        for (int k = 0; k < dim; ++k)
          if (!fixed(dim * node + k)) to(dim * node + k) = from(node, k);
      });
  Kokkos::fence();
}

/// One column of the multipliers for each side, 0 away from it.
void scatter(const ContactNodes &c, const DeviceView<double *> &lambda, MultiVector &columns)
{
  for (int side = 0; side < c.num_sides(); ++side) {
    const LO begin = c.first(side);
    const auto to = columns.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "rpc::contact::scatter_multipliers", device_range(c.first(side + 1) - begin),
        KOKKOS_LAMBDA(const LO i) { to(c.node(begin + i), side) = lambda(begin + i); });
    Kokkos::fence();
  }
}

DeviceView<double *> gathered(const ContactNodes &c, const MultiVector &columns)
{
  const DeviceView<double *> lambda("rpc::contact::gathered_multiplier", c.size());
  for (int side = 0; side < c.num_sides(); ++side) {
    const LO begin = c.first(side);
    const auto from = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    Kokkos::parallel_for(
        "rpc::contact::gather_multipliers", device_range(c.first(side + 1) - begin),
        KOKKOS_LAMBDA(const LO i) { lambda(begin + i) = from(c.node(begin + i), side); });
    Kokkos::fence();
  }
  return lambda;
}

} // namespace

void start_from(const CrsMatrix &interpolation, const SmoothedFunctional &coarse, const Vector &coarse_u,
                SmoothedFunctional &fine, Vector &u)
{
  const int dim = fine.contact().dim, sides = fine.contact().num_sides();
  MultiVector from(interpolation.getDomainMap(), dim), to(interpolation.getRangeMap(), dim);
  to_columns(coarse_u, dim, from);
  interpolation.apply(from, to);
  from_columns(to, fine.problem().dirichlet, dim, u);
  if (sides == 0) return;
  MultiVector lambda_from(interpolation.getDomainMap(), sides), lambda_to(interpolation.getRangeMap(), sides);
  scatter(coarse.contact(), coarse.multipliers(), lambda_from);
  interpolation.apply(lambda_from, lambda_to);
  fine.set_multipliers(gathered(fine.contact(), lambda_to));
}

} // namespace rpc::contact
