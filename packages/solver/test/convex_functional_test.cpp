// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/convex_functional.hpp"

#include "rpc/solver/exact_line_search.hpp"
#include "rpc/solver/newton.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <vector>

// The solver knows nothing of contact: here it minimizes a functional of a chain of springs.

namespace convex_functional_test
{
namespace
{

using namespace rpc;

constexpr double push = 0.3, wall = 2; // wall > 0: the chain meets it at u_i = wall

/// slope + curvature t + sum over the chain's points of what the wall adds, on all ranks.
class AlongTheChain : public LineFunction
{
public:
  AlongTheChain(RCP<const Comm> comm, std::vector<double> u, std::vector<double> d, const double hardness,
                const double slope, const double curvature)
      : comm_(std::move(comm)), u_(std::move(u)), d_(std::move(d)), hardness_(hardness), slope_(slope),
        curvature_(curvature)
  {
  }
  Value at(const double t) const override
  {
    double slope = 0, curvature = 0;
    for (std::size_t i = 0; i < u_.size(); ++i) {
      const double now = u_[i] + t * d_[i];
      slope += d_[i] * hardness_ * (std::max(0., now - wall) - std::max(0., u_[i] - wall));
      if (now > wall) curvature += hardness_ * d_[i] * d_[i];
    }
    return {slope_ + curvature_ * t + sum_all(*comm_, slope), curvature_ + sum_all(*comm_, curvature)};
  }

private:
  RCP<const Comm> comm_;
  std::vector<double> u_, d_;
  double hardness_, slope_, curvature_;
};

std::vector<double> values_of(const Vector &v)
{
  const auto host = v.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<double> values(host.extent(0));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = host(i, 0);
  return values;
}

/// u.Ku/2 - push sum_i u_i + hardness/2 sum_i max(0, u_i - wall)^2, with K = tridiag(-1, 2, -1) of n unknowns.
class Chain : public ConvexFunctional
{
public:
  explicit Chain(const int n, const double hardness = 50) : hardness_(hardness)
  {
    const auto comm = Tpetra::getDefaultComm();
    const auto map = rcp(new Map(n, 0, comm));
    const auto K = rcp(new CrsMatrix(map, 3));
    for (LO i = 0; i < num_local(*map); ++i) {
      const GO row = map->getGlobalElement(i);
      if (row > 0) K->insertGlobalValues(row, Teuchos::tuple<GO>(row - 1), Teuchos::tuple(-1.));
      K->insertGlobalValues(row, Teuchos::tuple<GO>(row), Teuchos::tuple(2.));
      if (row < n - 1) K->insertGlobalValues(row, Teuchos::tuple<GO>(row + 1), Teuchos::tuple(-1.));
    }
    K->fillComplete();
    NodePoints points;
    points.dim = 1;
    points.first = HostView<LO *>("first", 2);
    points.first(1) = num_local(*map);
    points.node = DeviceView<LO *>("node", num_local(*map));
    points.weight = DeviceView<double *>("weight", num_local(*map));
    points.direction = DeviceView<double **>("direction", num_local(*map), 1);
    const auto node = Kokkos::create_mirror_view(points.node);
    for (LO i = 0; i < num_local(*map); ++i) node(i) = i;
    Kokkos::deep_copy(points.node, node);
    Kokkos::deep_copy(points.weight, 1.);
    Kokkos::deep_copy(points.direction, 1.);
    hessian_ = rcp(new UpdatedOperator(rcp(new StiffnessOperator(K, 1)), points.node));
    points_ = points;
  }

  double value(const Vector &u) const override
  {
    Vector Ku(u.getMap());
    hessian_->shared_base()->apply(u, Ku);
    double sum = 0;
    for (const double x : values_of(u)) sum += hardness_ * std::pow(std::max(0., x - wall), 2) / 2 - push * x;
    return u.dot(Ku) / 2 + sum_all(*u.getMap()->getComm(), sum);
  }
  void gradient(const Vector &u, Vector &F) const override
  {
    hessian_->shared_base()->apply(u, F);
    const auto x = values_of(u);
    const auto to = F.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < x.size(); ++i) to(i, 0) += hardness_ * std::max(0., x[i] - wall) - push;
  }
  GO update_hessian(const Vector &u) override
  {
    const auto x = values_of(u);
    const DeviceView<double ***> added("added", x.size(), 1, 1);
    const auto to = Kokkos::create_mirror_view(added);
    for (std::size_t i = 0; i < x.size(); ++i) to(i, 0, 0) = x[i] > wall ? hardness_ : 0;
    Kokkos::deep_copy(added, to);
    return hessian_->set(points_, added);
  }
  const RCP<UpdatedOperator> &hessian() const override { return hessian_; }
  std::unique_ptr<LineFunction> along(const Vector &u, const Vector &d, const Vector &F) const override
  {
    Vector Kd(d.getMap());
    hessian_->shared_base()->apply(d, Kd);
    return std::make_unique<AlongTheChain>(u.getMap()->getComm(), values_of(u), values_of(d), hardness_, F.dot(d),
                                           d.dot(Kd));
  }
  std::unique_ptr<SubspaceFunction> within(const Vector &u, const std::vector<RCP<const Vector>> &directions,
                                           const Vector &) const override
  {
    return std::make_unique<WithinTheChain>(*this, u, directions);
  }

private:
  /// By gradients and products on the whole chain.
  class WithinTheChain : public SubspaceFunction
  {
  public:
    WithinTheChain(const Chain &chain, const Vector &u, std::vector<RCP<const Vector>> directions)
        : chain_(chain), u_(u, Teuchos::Copy), directions_(std::move(directions))
    {
    }
    Value at(const std::vector<double> &a) const override
    {
      const std::size_t n = a.size();
      Vector x(u_, Teuchos::Copy), F(u_.getMap()), Hd(u_.getMap());
      for (std::size_t k = 0; k < n; ++k) x.update(a[k], *directions_[k], 1.);
      chain_.gradient(x, F);
      const auto beyond = values_of(x);
      Value value{std::vector<double>(n), std::vector<double>(n * n)};
      for (std::size_t k = 0; k < n; ++k) {
        value.gradient[k] = directions_[k]->dot(F);
        chain_.hessian_->shared_base()->apply(*directions_[k], Hd);
        const auto d = values_of(*directions_[k]);
        {
          const auto to = Hd.getLocalViewHost(Tpetra::Access::ReadWrite);
          for (std::size_t i = 0; i < d.size(); ++i)
            if (beyond[i] > wall) to(i, 0) += chain_.hardness_ * d[i];
        }
        for (std::size_t l = 0; l < n; ++l) value.curvature[n * k + l] = directions_[l]->dot(Hd);
      }
      return value;
    }
    std::unique_ptr<LineFunction> along(const std::vector<double> &a, const Value &,
                                        const std::vector<double> &direction) const override
    {
      Vector x(u_, Teuchos::Copy), d(u_.getMap()), F(u_.getMap());
      for (std::size_t k = 0; k < a.size(); ++k) {
        x.update(a[k], *directions_[k], 1.);
        d.update(direction[k], *directions_[k], 1.);
      }
      chain_.gradient(x, F);
      return chain_.along(x, d, F);
    }

  private:
    const Chain &chain_;
    Vector u_;
    std::vector<RCP<const Vector>> directions_;
  };

  double hardness_;
  NodePoints points_;
  RCP<UpdatedOperator> hessian_;
};

/// Its sweep leads what has just met the wall back before it, which lowers the value a little.
class ReopenedChain : public Chain
{
public:
  using Chain::Chain;
  void sweep(Vector &u) const override
  {
    const auto x = u.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < x.extent(0); ++i)
      if (x(i, 0) > wall) x(i, 0) = wall - 1e-12;
  }
};

/// @param u  the start, and where it ends
solver::MinimizeResult minimized(Chain &chain, const RCP<Vector> &u, const double scale,
                                 const solver::NewtonReport &report)
{
  const auto map = u->getMap();
  const auto place = rcp(new MultiVector(map, 1)), constant = rcp(new MultiVector(map, 1));
  for (LO i = 0; i < num_local(*map); ++i) place->replaceLocalValue(i, 0, double(map->getGlobalElement(i)));
  constant->putScalar(1);
  solver::LinearSolver linear({}, chain.hessian(), {1, [place] { return place; }, [constant] { return constant; }});
  return solver::minimize(chain, linear, u, scale, {}, nullptr, report);
}

TEST(ConvexFunctional, ThatHasNothingToDoWithContactIsMinimized)
{
  for (const int n : {40, 3000}) { // factored, and by multigrid
    Chain chain(n);
    const auto map = chain.hessian()->getDomainMap();
    const auto u = rcp(new Vector(map));
    std::vector<double> values;
    const auto record = [&](const solver::NewtonStep &, const Vector &at) { values.push_back(chain.value(at)); };
    const auto result = minimized(chain, u, push * std::sqrt(n), record);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_GE(result.steps, 2);
    EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend())) << "the functional falls";
    Vector F(map);
    chain.gradient(*u, F);
    EXPECT_LE(F.normInf(), 1e-10 * push * std::sqrt(n));
    GO beyond = 0;
    for (const double x : values_of(*u)) beyond += x > wall;
    beyond = sum_all(*map->getComm(), beyond);
    EXPECT_GT(beyond, n / 2);
    EXPECT_LT(beyond, n) << "the ends are held at 0";
  }
}

TEST(ConvexFunctional, SlopesAlongLinesAreThoseOfTheValue)
{
  Chain chain(60);
  const auto map = chain.hessian()->getDomainMap();
  Vector u(map), d(map), F(map);
  for (LO i = 0; i < num_local(*map); ++i) {
    u.replaceLocalValue(i, 2 + 0.3 * std::sin(double(map->getGlobalElement(i))));
    d.replaceLocalValue(i, std::cos(2. * double(map->getGlobalElement(i))));
  }
  chain.gradient(u, F);
  const auto line = chain.along(u, d, F);
  for (const double t : {0., 0.4, 2.}) {
    double previous = 0;
    for (const double h : {1e-3, 5e-4}) {
      const auto at = [&](const double s) {
        Vector there(u, Teuchos::Copy);
        there.update(s, d, 1.);
        return chain.value(there);
      };
      const double error = std::abs((at(t + h) - at(t - h)) / (2 * h) - line->at(t).slope);
      EXPECT_LT(error, 1e-3 * std::abs(line->at(t).slope));
      if (previous > 1e-7) {
        EXPECT_LT(error, 0.6 * previous); // kinks of the slope leave first order
      }
      previous = error;
    }
  }
}

TEST(ConvexFunctional, IsLeastWithinASubspaceWhereItsGradientVanishes)
{
  const Chain chain(60, 1e6);
  const auto map = chain.hessian()->getDomainMap();
  Vector u(map), F(map);
  u.putScalar(1.9);
  std::vector<RCP<const Vector>> directions;
  for (int k = 0; k < 4; ++k) {
    const auto d = rcp(new Vector(map));
    for (LO i = 0; i < num_local(*map); ++i)
      d->replaceLocalValue(i, std::sin(0.05 * (k + 1) * double(map->getGlobalElement(i) + 1)));
    directions.push_back(d);
  }
  directions.push_back(directions[0]); // dependent
  chain.gradient(u, F);
  const auto function = chain.within(u, directions, F);
  const std::vector<double> start{0.1, 0, 0.2, 0, 0};
  const auto value_at = [&](const std::vector<double> &a) {
    Vector there(u, Teuchos::Copy);
    for (std::size_t k = 0; k < a.size(); ++k) there.update(a[k], *directions[k], 1.);
    return chain.value(there);
  };
  const auto least = solver::least_within(*function, start);
  EXPECT_LT(value_at(least), value_at(start));
  double before = 0;
  for (const double slope : function->at(start).gradient) before = std::max(before, std::abs(slope));
  for (const double slope : function->at(least).gradient) EXPECT_LT(std::abs(slope), 1e-6 * before);
}

TEST(ConvexFunctional, IsMinimizedThoughItsSweepsLeadBackBeforeKinks)
{
  // Three unknowns in the middle meet the wall. With a sweep before each direction, each step would end at once at the wall.
  ReopenedChain chain(9, 1e9);
  const auto map = chain.hessian()->getDomainMap();
  const auto u = rcp(new Vector(map));
  const auto result = minimized(chain, u, push, [](const solver::NewtonStep &, const Vector &) {});
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_LE(result.steps, 20);
  Vector F(map);
  chain.gradient(*u, F);
  const double rounding = 1e9 * std::numeric_limits<double>::epsilon() * u->normInf(); // of a wall's force
  EXPECT_LE(F.normInf(), 5 * rounding);
}

} // namespace
} // namespace convex_functional_test
