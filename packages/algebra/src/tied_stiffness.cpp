// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/tied_stiffness.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"

#include <utility>

namespace rpc
{
namespace
{

/// This rank's sum of f along the shape of a group.
double sum_over(const DeviceView<LO *> &members, const DeviceView<double *> &shape, const Vector &f)
{
  const auto from = device_read(f);
  const bool shaped = shape.extent(0) > 0;
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::algebra::sum_over_group", device_range(static_cast<LO>(members.extent(0))),
      KOKKOS_LAMBDA(const LO i, double &part) { part += shaped ? shape(i) * from(members(i)) : from(members(i)); },
      sum);
  return sum;
}

/// (groups) Sums over all ranks; collective.
std::vector<double> sums(const TiedUnknowns &tied, const Vector &f)
{
  std::vector<double> mine;
  for (int j = 0; j < tied.size(); ++j) mine.push_back(sum_over(tied.members[j], tied.shape[j], f));
  return summed(*f.getMap()->getComm(), mine);
}

} // namespace

std::vector<double> means(const TiedUnknowns &tied, const Vector &f)
{
  std::vector<double> mean = sums(tied, f);
  for (int j = 0; j < tied.size(); ++j) mean[j] /= tied.square[j];
  return mean;
}

void set_members(const TiedUnknowns &tied, const std::vector<double> &value, Vector &f)
{
  const auto to = device_write(f);
  for (int j = 0; j < tied.size(); ++j) {
    const auto members = tied.members[j];
    const auto shape = tied.shape[j];
    const double here = value[j];
    const bool shaped = shape.extent(0) > 0, adds = tied.adds[j] != 0;
    Kokkos::parallel_for(
        "rpc::algebra::set_group", device_range(static_cast<LO>(members.extent(0))), KOKKOS_LAMBDA(const LO i) {
          const double part = shaped ? shape(i) * here : here;
          to(members(i)) = adds ? to(members(i)) + part : part;
        });
  }
  Kokkos::fence();
}

TiedStiffness::TiedStiffness(RCP<const StiffnessOperator> K, TiedUnknowns tied, std::vector<RCP<Vector>> force,
                             const std::vector<double> &springs)
    : K_(std::move(K)), tied_(std::move(tied)), force_(std::move(force)),
      stiffness_(static_cast<std::size_t>(tied_.size()) * tied_.size())
{
  const std::vector<double> none(tied_.size(), 0.);
  for (int k = 0; k < tied_.size(); ++k) {
    const auto of_members = sums(tied_, *force_[k]);
    for (int j = 0; j < tied_.size(); ++j) stiffness_[j * tied_.size() + k] = of_members[j];
    set_members(tied_, none, *force_[k]);
  }
  for (std::size_t k = 0; k < springs.size(); ++k) stiffness_[k] += springs[k];
}

std::vector<double> TiedStiffness::forces_of(const Vector &x) const
{
  std::vector<double> all;
  for (const auto &force : force_) all.push_back(force->dot(x));
  return all;
}

void TiedStiffness::couple(const Vector &x, Vector &y) const
{
  const std::vector<double> value = means(tied_, x);
  std::vector<double> force = forces_of(x);
  for (int j = 0; j < tied_.size(); ++j) {
    y.update(value[j], *force_[j], 1.);
    for (int k = 0; k < tied_.size(); ++k) force[j] += stiffness(j, k) * value[k];
    force[j] /= tied_.square[j];
  }
  set_members(tied_, force, y);
}

void TiedStiffness::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, const double alpha,
                          const double beta) const
{
  RPC_REQUIRE(x.getNumVectors() == 1, "TiedStiffness: products with one vector at a time");
  const auto column = x.getVector(0);
  Vector product(column->getMap());
  K_->apply(*column, product);
  couple(*column, product);
  y.update(alpha, product, beta);
}

} // namespace rpc
