// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

// Cattaneo (1938) and Mindlin (1949): a body is pressed on a cylinder by P and then pushed along by Q < mu P. With a the half width of
// contact, p = p0 sqrt(1 - x^2/a^2); points stick where |x| < c = a sqrt(1 - Q/(mu P)), and
// q = mu p0/a (sqrt(a^2 - x^2) - sqrt(c^2 - x^2)). On a rigid foundation that is so where nu = 1/2.

namespace friction_mindlin_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr double mu = 0.5;

/// sqrt(r^2 - x^2) where that is real.
double cap(const double r, const double x)
{
  return std::abs(x) < r ? std::sqrt(r * r - x * x) : 0;
}

/// The half ellipse k sqrt(r^2 - x^2) whose square, a line in x^2, is nearest to that of the values where they exceed 0.3 of their largest.
struct Ellipse {
  double r = 0, k = 0;

  Ellipse(const std::vector<ContactPoint> &points, const std::vector<double> &values)
  {
    const double largest = *std::max_element(values.begin(), values.end());
    double n = 0, X = 0, Y = 0, XX = 0, XY = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] < 0.3 * largest) continue;
      const double x = std::pow(points[i].x[0], 2), y = std::pow(values[i], 2), w = points[i].weight;
      n += w;
      X += w * x;
      Y += w * y;
      XX += w * x * x;
      XY += w * x * y;
    }
    const double slope = (n * XY - X * Y) / (n * XX - X * X), at_0 = (Y - slope * X) / n;
    r = std::sqrt(-at_0 / slope);
    k = std::sqrt(-slope);
  }
};

class Mindlin : public testing::TestWithParam<double>
{
};
// Motions of the top that lead to Q of about 0.25, 0.5 and 0.8 mu P.
INSTANTIATE_TEST_SUITE_P(Loads, Mindlin, testing::Values(0.0012, 0.0024, 0.0033));

TEST_P(Mindlin, StickWidthAndTractionsAreTheClosedForm)
{
  // Near nu = 1/2 rounding of u leaves an equilibrium residual of 0.94e-8 (Trilinos 13.2) and 1.04e-8 (16.1).
  const auto points = contact_points(
      solved("half_plane", {"Dirichlet->top->X=" + text(GetParam()) + "*(t-1)", "Uzawa->Tolerance=3e-8"}));
  double P = 0, Q = 0;
  std::vector<double> pressure, unused; // mu p - q = mu p0/a sqrt(c^2 - x^2)
  for (const ContactPoint &point : points) {
    P += point.weight * point.pressure;
    Q += point.weight * point.q[0];
    pressure.push_back(point.pressure);
    unused.push_back(mu * point.pressure - std::abs(point.q[0]));
  }
  Q = std::abs(Q);
  const Ellipse outer(points, pressure), inner(points, unused);
  const double a = outer.r, c = a * std::sqrt(1 - Q / (mu * P)), p0 = outer.k * a;
  EXPECT_NEAR(2 * P / (3.14159265358979323846 * a), p0, 0.005 * p0); // Hertz's
  double error = 0, length = 0;
  for (const ContactPoint &point : points) {
    const double x = point.x[0];
    if (std::abs(x) > a) continue;
    error += point.weight * std::abs(std::abs(point.q[0]) - mu * p0 / a * (cap(a, x) - cap(c, x)));
    length += point.weight;
  }
  error /= length * mu * p0;
  RecordProperty("used", text(Q / (mu * P)));
  RecordProperty("inner_width", text(inner.r / a));
  RecordProperty("closed_form", text(c / a));
  RecordProperty("mean_error", text(error));
  EXPECT_GT(Q / (mu * P), 0.15);
  EXPECT_LT(Q / (mu * P), 0.9);
  EXPECT_NEAR(inner.r / a, c / a, 0.005 * c / a);
  EXPECT_LT(error, 0.005);
}

} // namespace
} // namespace friction_mindlin_test
