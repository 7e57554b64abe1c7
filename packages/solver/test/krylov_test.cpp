// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/krylov.hpp"

#include "grid.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace krylov_test
{
namespace
{

using namespace rpc;
using rpc::test::Grid;
using solver::Accuracy;
using solver::Krylov;
using solver::KrylovResult;
using solver::LinearSolverOptions;

/// The grid's diagonal.
class Diagonal : public solver::Preconditioner
{
public:
  explicit Diagonal(const CrsMatrix &A) : inverse_(A.getRowMap())
  {
    A.getLocalDiagCopy(inverse_);
    inverse_.reciprocal(inverse_);
  }
  Prepared prepare() override { return Prepared::unchanged; }
  void forget() override { FAIL() << "nobody asked for that"; }
  std::string name() const override { return "diagonal"; }
  RCP<const Map> getDomainMap() const override { return inverse_.getMap(); }
  RCP<const Map> getRangeMap() const override { return inverse_.getMap(); }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp = Teuchos::NO_TRANS, double = 1,
             double = 0) const override
  {
    y.elementWiseMultiply(1., inverse_, x, 0.);
  }

private:
  Vector inverse_;
};

/// The grid's matrix and a rotation of both unknowns of each node: positive, but not symmetric.
class Rotating : public Operator
{
public:
  Rotating(RCP<const CrsMatrix> A, const double rotation) : A_(std::move(A)), rotation_(rotation) {}
  RCP<const Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return A_->getRangeMap(); }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, const double alpha,
             const double beta) const override
  {
    A_->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
    const auto from = x.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto to = y.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t row = 0; row < from.extent(0); row += 2) {
      to(row, 0) += alpha * rotation_ * from(row + 1, 0);
      to(row + 1, 0) -= alpha * rotation_ * from(row, 0);
    }
  }

private:
  RCP<const CrsMatrix> A_;
  double rotation_;
};

/// |b - H x| / |b|
double residual_of(const Operator &H, const Vector &x, const Vector &b)
{
  Vector r(b, Teuchos::Copy);
  H.apply(x, r, Teuchos::NO_TRANS, -1., 1.);
  return r.norm2() / b.norm2();
}

struct Case {
  Grid grid{24};
  Diagonal B{*grid.A};
  RCP<const Operator> H = rcp(new Rotating(grid.A, 2));
  Vector b = grid.right_side(), x{grid.map};

  KrylovResult solve(const LinearSolverOptions &options, const bool is_symmetric = false, const double tolerance = 1e-9)
  {
    return Krylov(options, H).solve(B, is_symmetric, b, x, tolerance);
  }
};

/// 2 times the identity, which counts its products.
class Twice : public Operator
{
public:
  explicit Twice(RCP<const Map> map) : map_(std::move(map)) {}
  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, const double alpha,
             const double beta) const override
  {
    ++products;
    y.update(2 * alpha, x, beta);
  }

  mutable int products = 0;

private:
  RCP<const Map> map_;
};

/// Its inverse.
class Half : public Diagonal
{
public:
  Half(const CrsMatrix &A, const bool is_exact) : Diagonal(A), is_exact_(is_exact) {}
  bool is_exact() const override { return is_exact_; }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp = Teuchos::NO_TRANS, double = 1,
             double = 0) const override
  {
    y.update(0.5, x, 0.);
  }

private:
  bool is_exact_;
};

/// Of a solve that may leave much an exact preconditioner's answer is the result; others look at its residual.
TEST(Krylov, TakesAnExactAnswerAsItIsWhereMuchMayBeLeft)
{
  const Grid grid(24);
  const auto H = rcp(new Twice(grid.map));
  const Vector b = grid.right_side();
  Krylov krylov({}, H);
  for (const bool is_exact : {false, true})
    for (const bool is_symmetric : {false, true})
      for (const double error : {0., 1e-3, 0.1}) {
        SCOPED_TRACE(error);
        const Half B(*grid.A, is_exact);
        Vector x(grid.map);
        H->products = 0;
        const auto result = krylov.solve(B, is_symmetric, b, x, {1e-2, error});
        EXPECT_TRUE(result.converged);
        EXPECT_EQ(result.iterations, 1);
        EXPECT_EQ(H->products == 0, is_exact && is_symmetric && error == 0.1);
        EXPECT_LT(residual_of(*H, x, b), 1e-14);
        if (is_symmetric && error > 0) {
          EXPECT_NEAR(result.energy, 0.5 * b.dot(b), 1e-12 * b.dot(b));
        }
      }
}

TEST(Krylov, SolvesForAMatrixThatIsNotSymmetricByGmres)
{
  Case of;
  const auto result = of.solve({});
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_GE(result.iterations, 51) << "it restarts";
  EXPECT_LE(result.iterations, 100);
  EXPECT_LT(residual_of(*of.H, of.x, of.b), 1.01e-9);
  EXPECT_NEAR(result.residual, residual_of(*of.H, of.x, of.b), 1e-10);
  const auto wrong = of.solve({}, true);
  EXPECT_FALSE(wrong.converged && residual_of(*of.H, of.x, of.b) < 1e-8)
      << "CG needs symmetry: else this tells nothing";
}

TEST(Krylov, KeepsTheDecksMethodWhereItTakesAnyMatrix)
{
  Case of;
  LinearSolverOptions options;
  const int many = of.solve(options).iterations;
  options.method = "Block GMRES";
  options.belos.set("Num Blocks", 3);
  options.belos.set("Maximum Restarts", 500);
  const auto result = of.solve(options);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_GT(result.iterations, many) << "restarts after three iterations make it slower";
}

TEST(Krylov, HandsToEachMethodWhatItKnowsOfTheList)
{
  Case of;
  LinearSolverOptions options;
  options.belos.set("Maximum Iterations", 5);
  options.belos.set("Assert Positive Definiteness", false); // GMRES knows no such name
  options.belos.set("Orthogonalization", "DGKS");           // nor CG this one
  for (const bool is_symmetric : {false, true}) {
    const auto result = of.solve(options, is_symmetric);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.iterations, 5);
  }
  options.belos.set("Orthogonalization", "none of Belos'");
  EXPECT_ANY_THROW(of.solve(options)) << "GMRES has got it";
}

/// H, which counts its products.
class Counting : public Operator
{
public:
  explicit Counting(RCP<const Operator> of) : of_(std::move(of)) {}
  RCP<const Map> getDomainMap() const override { return of_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return of_->getRangeMap(); }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, const double alpha,
             const double beta) const override
  {
    ++products;
    of_->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
  }

  mutable int products = 0;

private:
  RCP<const Operator> of_;
};

/// The diagonal, which counts too.
class CountingDiagonal : public Diagonal
{
public:
  using Diagonal::Diagonal;
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override
  {
    ++products;
    Diagonal::apply(x, y, mode, alpha, beta);
  }

  mutable int products = 0;
};

TEST(Krylov, TakesOneProductWithTheMatrixAndThePreconditionerAnIteration)
{
  Case of;
  const CountingDiagonal B(*of.grid.A);
  for (const bool is_symmetric : {false, true}) {
    SCOPED_TRACE(is_symmetric);
    const auto H = rcp(new Counting(is_symmetric ? RCP<const Operator>(of.grid.A) : of.H));
    B.products = 0;
    const auto result = Krylov({}, H).solve(B, is_symmetric, of.b, of.x, 1e-3);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_EQ(H->products, result.iterations);
    EXPECT_EQ(B.products, result.iterations);
  }
}

TEST(Krylov, SolvesOnceForCGAndOnceForGmresWithOneObject)
{
  Case of;
  Krylov krylov({}, of.grid.A);
  int iterations[2][2];
  for (auto &round : iterations)
    for (const bool is_symmetric : {true, false}) {
      const auto result = krylov.solve(of.B, is_symmetric, of.b, of.x, 1e-9);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_LT(of.grid.relative_residual(of.x, of.b), 1.01e-9);
      round[is_symmetric] = result.iterations;
    }
  for (const bool is_symmetric : {true, false}) EXPECT_EQ(iterations[0][is_symmetric], iterations[1][is_symmetric]);
}

/// GMRES preconditions vectors that are no residuals: what it asks with are the residuals all the same.
TEST(Krylov, AsksBothMethodsWhetherToGiveUpByTheirResiduals)
{
  Case of;
  for (const bool is_symmetric : {true, false}) {
    const RCP<const Operator> H = is_symmetric ? RCP<const Operator>(of.grid.A) : of.H;
    Krylov krylov({}, H);
    std::vector<double> residuals;
    const auto asked = [&](const int iterations, const double residual) {
      if (iterations == static_cast<int>(residuals.size())) residuals.push_back(residual);
      return iterations == 20;
    };
    const auto result = krylov.solve(of.B, is_symmetric, of.b, of.x, 1e-9, asked);
    EXPECT_TRUE(result.given_up);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.iterations, 20);
    EXPECT_EQ(result.reason, is_symmetric ? "given up after 20 CG iterations" : "given up after 20 GMRES iterations");
    ASSERT_EQ(residuals.size(), 21U);
    EXPECT_NEAR(residuals[0], 1, 1e-12);
    EXPECT_LT(residuals[20], 0.1);
    const auto without = krylov.solve(of.B, is_symmetric, of.b, of.x, residuals[15] * (1 + 1e-9));
    EXPECT_TRUE(without.converged) << "it can be used again: " << without.reason;
    EXPECT_EQ(without.iterations, 15) << "the residual after 15 iterations is the one that was told";
    EXPECT_NEAR(residual_of(*H, of.x, of.b), residuals[15], 1e-6 * residuals[15]);
  }
}

/// |x - y|_A^2
double energy_of_difference(const Operator &A, const Vector &x, const Vector &y)
{
  Vector difference(x, Teuchos::Copy), image(x.getMap());
  difference.update(-1., y, 1.);
  A.apply(difference, image);
  return difference.dot(image);
}

/// The error in energy is what was asked for, while the residual is still much larger than its own bound; for a correction it counts
/// beside the energy of what is corrected.
TEST(Krylov, EndsCGWhereTheErrorInEnergyIsSmallEnough)
{
  Case of;
  const Operator &A = *of.grid.A;
  Krylov krylov({}, of.grid.A);
  Vector exact(of.x.getMap());
  ASSERT_TRUE(krylov.solve(of.B, true, of.b, exact, 1e-12).converged);
  const double energy = exact.dot(of.b);
  int last = 0;
  for (const double wanted : {0.3, 0.1, 0.01}) {
    SCOPED_TRACE(wanted);
    const auto result = krylov.solve(of.B, true, of.b, of.x, {1e-12, wanted});
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_GT(result.iterations, last);
    last = result.iterations;
    const double error = std::sqrt(energy_of_difference(A, of.x, exact) / energy);
    EXPECT_LT(error, 2.5 * wanted) << "gains of CG with a diagonal fall unevenly";
    EXPECT_GT(error, 0.1 * wanted) << "it goes on no longer than it must";
    EXPECT_NEAR(result.energy, of.x.dot(of.b), 1e-12 * energy);
    EXPECT_NEAR(energy - result.energy, energy_of_difference(A, of.x, exact), 1e-9 * energy)
        << "CG's error is H-orthogonal to x";
    EXPECT_NEAR(result.residual, of.grid.relative_residual(of.x, of.b), 1e-9);
  }
  const auto alone = krylov.solve(of.B, true, of.b, of.x, {1e-12, 0.1});
  const auto corrects = krylov.solve(of.B, true, of.b, of.x, {1e-12, 0.1, 99 * energy});
  EXPECT_LT(corrects.iterations, alone.iterations);
  EXPECT_LT(energy_of_difference(A, of.x, exact), 1.5 * 1.5 * 0.01 * 100 * energy);
  const auto other = krylov.solve(of.B, false, of.b, of.x, {1e-9, 0.1});
  EXPECT_LT(of.grid.relative_residual(of.x, of.b), 1.01e-9) << "GMRES knows no energy";
  EXPECT_EQ(other.energy, 0);
}

/// It asks once, with an x as good as wanted, and takes as many iterations in all as to the better one at once. Where it does not get there,
/// the x that was good enough is the result.
TEST(Krylov, GoesOnInItsKrylovSpaceWhereItIsTold)
{
  Case of;
  constexpr double rough = 1e-3, further = 1e-9;
  for (const bool is_symmetric : {true, false})
    for (const bool goes_on : {true, false}) {
      SCOPED_TRACE(is_symmetric);
      const RCP<const Operator> H = is_symmetric ? RCP<const Operator>(of.grid.A) : of.H;
      int asked = 0;
      Accuracy wanted(rough);
      wanted.further = further;
      wanted.goes_on = [&](const Vector &x) {
        ++asked;
        EXPECT_LT(residual_of(*H, x, of.b), 1.01 * rough);
        return goes_on;
      };
      const auto solve = [&](const LinearSolverOptions &options, const Accuracy &to) {
        return Krylov(options, H).solve(of.B, is_symmetric, of.b, of.x, to);
      };
      const int iterations[2] = {solve({}, rough).iterations, solve({}, further).iterations};
      const auto result = solve({}, wanted);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_EQ(asked, 1);
      EXPECT_EQ(result.iterations, iterations[goes_on]);
      EXPECT_LT(residual_of(*H, of.x, of.b), 1.01 * (goes_on ? further : rough));
      LinearSolverOptions few;
      few.max_iterations = iterations[0] + 2;
      const auto short_of_it = solve(few, wanted);
      EXPECT_TRUE(short_of_it.converged) << short_of_it.reason;
      EXPECT_LT(residual_of(*H, of.x, of.b), 1.01 * rough);
    }
}

TEST(Krylov, TellsOfAMatrixThatIsNotPositiveDefinite)
{
  Case of;
  of.grid.A->resumeFill();
  of.grid.A->scale(-1.);
  of.grid.A->fillComplete();
  of.H = of.grid.A;
  const auto result = of.solve({}, true);
  EXPECT_TRUE(result.broken);
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.reason.find("broke down"), std::string::npos) << result.reason;
  EXPECT_TRUE(std::isnan(result.residual));
}

} // namespace
} // namespace krylov_test
