#include "held_part.hpp"

#include "rpc/contact/law/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rpc::contact
{
namespace
{

using fem::dot;
using fem::RigidMotion;
using Coefficients = Kokkos::Array<double, 6>;

Coefficients coefficients_of(const RigidMotion &motion)
{
  Coefficients r;
  for (int k = 0; k < 6; ++k) r[k] = motion[k];
  return r;
}

/// m . r at contact node i.
template <class Along>
KOKKOS_INLINE_FUNCTION double speed(const Along &along, const LO i, const Coefficients &r)
{
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += along(i, k) * r[k];
  return sum;
}

/// m . r_k of the rigid node that the motion presses in most for the size of its row; 0 if it presses in none.
RigidMotion steepest(const Comm &comm, const Reactions &reactions, const int mine, const RigidMotion &motion)
{
  using Location = Kokkos::MaxLoc<double, LO>;
  const Coefficients r = coefficients_of(motion);
  const auto along = reactions.along;
  const auto limit = reactions.limit;
  const auto part = reactions.part;
  Location::value_type worst;
  Kokkos::parallel_reduce(
      "rpc::contact::steepest", device_range(static_cast<LO>(part.extent(0))),
      KOKKOS_LAMBDA(const LO i, Location::value_type &most) {
        if (part(i) != mine || !is_rigid(limit(i))) return;
        double squares = 0;
        for (int k = 0; k < 6; ++k) squares += along(i, k) * along(i, k);
        const double relative = speed(along, i, r) / std::sqrt(squares);
        if (!(relative > most.val)) return;
        most.val = relative;
        most.loc = i;
      },
      Location(worst));
  const double most = max_all(comm, std::max(0., worst.val)); // a maximum over no nodes is -DBL_MAX
  RigidMotion local{}, all{};
  if (!(most > 1e-10 * std::sqrt(dot(motion, motion)))) return all;
  const int owner = min_all(comm, worst.val == most ? comm.getRank() : comm.getSize());
  if (owner == comm.getRank()) {
    const auto rows = to_host(along);
    for (int k = 0; k < 6; ++k) local[k] = rows(worst.loc, k);
  }
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 6, local.data(), all.data());
  return all;
}

} // namespace

Reactions reactions_of(const fem::Discretization &d, const fem::Parts &parts, const ContactNodes &contact)
{
  Reactions reactions{DeviceView<double *[6]>("rpc::contact::along_modes", contact.size()),
                      DeviceView<double *>("rpc::contact::limit", contact.size()),
                      DeviceView<int *>("rpc::contact::part", contact.size()), std::vector<double>(parts.size())};
  const DeviceView<double *> strength("rpc::contact::strength", parts.size());
  const ContactNodes c = contact;
  const auto along = reactions.along;
  const auto limit = reactions.limit;
  const auto part = reactions.part;
  const auto coords = d.mesh->coords;
  const auto of_node = parts.of_node;
  const auto centre = parts.centre;
  const auto radius = parts.radius;
  Kokkos::parallel_for(
      "rpc::contact::along_modes", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        const int p = of_node(c.node(i));
        part(i) = c.fixed(i) ? -1 : p;
        if (c.fixed(i)) return;
        double arm[3] = {0, 0, 0}, m[3] = {0, 0, 0}, row[6];
        for (int k = 0; k < c.dim; ++k) {
          arm[k] = (coords(c.node(i), k) - centre(p, k)) / radius(p);
          m[k] = c.direction(i, k);
        }
        fem::along_modes(c.dim, arm, m, row);
        for (int k = 0; k < 6; ++k) along(i, k) = row[k];
        limit(i) = c.weight(i) * largest_bearable(c.law(i));
        if (!is_rigid(limit(i))) add_shared(strength(p), limit(i));
      });
  const auto mine = to_host(strength);
  Teuchos::reduceAll(d.mesh->comm(), Teuchos::REDUCE_SUM, parts.size(), mine.data(), reactions.strength.data());
  return reactions;
}

HeldPart::HeldPart(const Comm &comm, const Reactions &reactions, const int part, std::vector<RigidMotion> motions)
    : comm_(comm), reactions_(reactions), part_(part), motions_(std::move(motions))
{
}

RigidMotion HeldPart::motion(const std::vector<double> &q) const
{
  RigidMotion r{};
  for (std::size_t j = 0; j < q.size(); ++j)
    for (int k = 0; k < 6; ++k) r[k] += q[j] * motions_[j][k];
  return r;
}

std::vector<double> HeldPart::coordinates(const RigidMotion &force) const
{
  std::vector<double> q;
  for (const RigidMotion &r : motions_) q.push_back(dot(force, r));
  return q;
}

Furthest HeldPart::furthest(const std::vector<double> &q) const
{
  const RigidMotion r = motion(q);
  Furthest endless{coordinates(steepest(comm_, reactions_, part_, r)), true};
  double squares = 0;
  for (const double entry : endless.at) squares += entry * entry;
  if (squares == 0) return {coordinates(carried(r)), false};
  for (double &entry : endless.at) entry /= std::sqrt(squares);
  return endless;
}

RigidMotion HeldPart::carried(const RigidMotion &motion, const LO begin, const LO end) const
{
  const DeviceView<double[6]> sum("rpc::contact::carried");
  const Coefficients r = coefficients_of(motion);
  const auto along = reactions_.along;
  const auto limit = reactions_.limit;
  const auto part = reactions_.part;
  const int mine = part_;
  const double rounding = 1e-14 * std::sqrt(dot(motion, motion));
  Kokkos::parallel_for(
      "rpc::contact::carried", Kokkos::RangePolicy<ExecutionSpace, LO>(begin, end), KOKKOS_LAMBDA(const LO i) {
        if (part(i) != mine || is_rigid(limit(i)) || !(speed(along, i, r) > rounding)) return;
        for (int k = 0; k < 6; ++k) add_shared(sum(k), limit(i) * along(i, k));
      });
  const auto local = to_host(sum);
  RigidMotion all;
  Teuchos::reduceAll(comm_, Teuchos::REDUCE_SUM, 6, local.data(), all.data());
  return all;
}

RigidMotion HeldPart::carried(const RigidMotion &motion) const
{
  return carried(motion, 0, static_cast<LO>(reactions_.part.extent(0)));
}

} // namespace rpc::contact
