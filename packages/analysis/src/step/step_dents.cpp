// SPDX-License-Identifier: BSD-3-Clause
#include "step/step_dents.hpp"

#include "rpc/contact/node_columns.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/parallel.hpp"

namespace rpc::analysis
{
namespace
{

/// Dents of nodes that are no contact points now, since their normals miss the obstacle, stay as they are.
void keep_dents_elsewhere(const contact::ContactNodes &contact, const MultiVector &before, MultiVector &now)
{
  const contact::ContactNodes c = contact;
  MultiVector kept(before, Teuchos::Copy);
  {
    const auto to = kept.getLocalViewDevice(Tpetra::Access::ReadWrite);
    for (int side = 0; side < c.num_sides(); ++side) {
      const LO begin = c.first(side);
      Kokkos::parallel_for(
          "rpc::analysis::forget_points", device_range(c.first(side + 1) - begin),
          KOKKOS_LAMBDA(const LO i) { to(c.node(begin + i), side) = 0; });
    }
    Kokkos::fence();
  }
  now.update(1., kept, 1.);
}

/// (points) What a step has added to the dents.
DeviceView<double *> added_dents(const contact::ContactNodes &contact, const contact::ContactResult &result)
{
  const contact::ContactNodes c = contact;
  const auto dent = result.dent;
  const DeviceView<double *> added("rpc::analysis::added_dents", c.size());
  Kokkos::parallel_for(
      "rpc::analysis::added_dents", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { added(i) = dent(i) - c.dent(i); });
  Kokkos::fence();
  return added;
}

} // namespace

void remember_dents(const Problem &problem, const std::vector<contact::ContactOptions> &sides,
                    const contact::ContactNodes &points, const Memory *const before, StepSolution &s, Memory &memory)
{
  const fem::Discretization &d = problem.discretization();
  const auto owned_nodes = d.mesh->owned_nodes;
  const auto now = contact::node_columns(points, s.contact.dent, owned_nodes);
  const auto with_body = rcp(new MultiVector(*now, Teuchos::Copy));
  for (std::size_t k = 0; k < sides.size(); ++k)
    if (!sides[k].remembers || sides[k].dents_move_with == contact::DentsMoveWith::foundation)
      with_body->getVectorNonConst(k)->putScalar(0);
  if (before) keep_dents_elsewhere(points, *before->dent, *with_body);
  memory.dent = with_body;
  if (before) memory.foundations = before->foundations;
  contact::press_in(d, sides, *contact::node_columns(points, added_dents(points, s.contact), owned_nodes), *now, *s.u,
                    memory.foundations);
  contact::take_all_dents(sides, memory.foundations, s.contact);
}

Vector moved_along(const Problem &problem, const double t, const Vector &u)
{
  const fem::Discretization &d = problem.discretization();
  const int dim = d.dim();
  const auto dirichlet = fem::dirichlet_dofs(d, problem.model().seen_at(t).dirichlet);
  Vector moved(u, Teuchos::Copy);
  const LO nodes = d.mesh->num_owned_nodes();
  const auto condition = dirichlet.condition;
  const auto group = dirichlet.tied ? dirichlet.tied->group : DeviceView<int *>();
  const bool ties = group.extent(0) > 0;
  std::vector<double> sums(2 * dim, 0.); // of the changes and their numbers, by component
  for (int c = 0; c < dim; ++c) {
    const auto from = device_read(u), to = device_read(*dirichlet.value);
    Kokkos::parallel_reduce(
        "rpc::analysis::moved_along", device_range(nodes),
        KOKKOS_LAMBDA(const LO n, double &change, double &number) {
          const LO i = dof(dim, n, c);
          if (condition(i) < 0 || (ties && group(i) >= 0)) return;
          change += to(i) - from(i);
          number += 1;
        },
        sums[c], sums[dim + c]);
  }
  sums = summed(d.mesh->comm(), sums);
  const auto to = device_write(moved);
  for (int c = 0; c < dim; ++c) {
    if (!(sums[dim + c] > 0)) continue;
    const double mean = sums[c] / sums[dim + c];
    Kokkos::parallel_for(
        "rpc::analysis::move_along", device_range(nodes), KOKKOS_LAMBDA(const LO n) { to(dof(dim, n, c)) += mean; });
  }
  Kokkos::fence();
  return moved;
}

bool settled(const MultiVector &used, const MultiVector &met, const std::vector<contact::FoundationDents> &foundations,
             const double tolerance)
{
  MultiVector change(met, Teuchos::Copy);
  change.update(-1., used, 1.);
  for (std::size_t k = 0; k < foundations.size(); ++k)
    if (change.getVector(k)->normInf() > tolerance * foundations[k].deepest) return false;
  return true;
}

} // namespace rpc::analysis
