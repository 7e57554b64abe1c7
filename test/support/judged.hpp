// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/energies.hpp"
#include "rpc/contact/iterate.hpp"

namespace rpc::test
{

/// An iterate's multipliers with a displacement from 0, whatever its origin is.
inline contact::ContactState judged_at(const contact::Iterate &iterate, const Vector &from_0)
{
  return {rcp(new Vector(from_0, Teuchos::Copy)), iterate.duals().multipliers(), {}};
}
inline double contact_law_residual(const contact::Iterate &iterate, const Vector &from_0)
{
  return contact::contact_law_residual(iterate.points(), judged_at(iterate, from_0));
}
inline contact::ContactEnergy contact_energy(const contact::Iterate &iterate, const Vector &from_0)
{
  return contact::contact_energy(iterate.points(), judged_at(iterate, from_0));
}
/// Pi(u) [J]
inline double elastic_energy(const Operator &K, const fem::ElasticProblem &elastic, const Vector &u)
{
  Vector Ku(u.getMap());
  K.apply(u, Ku);
  return 0.5 * u.dot(Ku) - elastic.load->dot(u) + elastic.energy_offset;
}
inline double energy(const contact::Iterate &iterate, const fem::ElasticProblem &elastic, const Vector &from_0)
{
  return contact::energy(elastic_energy(iterate.hessian()->base(), elastic, from_0), iterate.points(),
                         judged_at(iterate, from_0));
}
inline Vector multiplier_forces(const contact::Iterate &iterate)
{
  return contact::multiplier_forces(iterate.points(), iterate.duals().multipliers(), iterate.hessian()->getDomainMap());
}

} // namespace rpc::test
