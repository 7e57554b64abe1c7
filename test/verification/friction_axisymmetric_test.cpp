// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

// A cylinder of radius 1 and height 1 that is pressed on the foundation and grows wider upwards: u_r = r (alpha + c z),
// u_z = -epsilon z. Its shear stress G c r is friction's at z = 0, where it slips by alpha r, or sticks.

namespace friction_axisymmetric_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr double E = 1000, nu = 0.3, G = E / (2 * (1 + nu)), lame = 2 * G * nu / (1 - 2 * nu);
constexpr double pi = 3.14159265358979323846;

struct Cylinder {
  double alpha, c, epsilon = 0.01;

  double pressure() const { return (lame + 2 * G) * epsilon - 2 * lame * alpha; }
  double shear(const double r) const { return G * c * r; }
  /// Loads: sigma_rr = 2 (lambda + G)(alpha + c z) - lambda epsilon and sigma_rz = G c r outside, div sigma = 2 (lambda + G) c along z.
  Assignments deck(const std::string &element, const int cells, const std::string &coefficient) const
  {
    const std::string n = std::to_string(cells);
    return {"Kinematics=axisymmetric",
            "Mesh->Upper={1, 1}",
            "Mesh->Cells={" + n + ", " + n + "}",
            "Mesh->Element=" + element,
            "Steps->Times={1}",
            "Dirichlet->top->X=" + text(alpha + c) + "*x",
            "Dirichlet->top->Y=" + text(-epsilon),
            "Traction->left->X=0",
            "Traction->left->Y=0",
            "Traction->right->X=" + text(2 * (lame + G)) + "*(" + text(alpha) + "+" + text(c) + "*y)-" +
                text(lame * epsilon),
            "Traction->right->Y=" + text(shear(1)),
            "Body Force->Y=" + text(-2 * (lame + G) * c),
            "Contact->Friction Coefficient=" + coefficient};
  }
};
const Cylinder slips{0.001, 0.005}, sticks{0, 0.005};

// Q1's nodal forces of a traction r, over those of a traction 1: int r N r dr / int N r dr. The displacement is one of Q1's, and its
// quadrature exact for it: so are the nodes' tractions.
double mean_radius(const double r, const double h)
{
  if (r < 1 - h / 2) return r + h * h / (6 * r);
  return (h / 2 - h * h / 3 + h * h * h / 12) / (h / 2 - h * h / 6);
}

TEST(FrictionOfACylinder, ThatSticksIsItsShearStress)
{
  constexpr int cells = 8;
  Assignments deck = sticks.deck("Q1", cells, "0.3");
  deck.emplace_back(
      "Uzawa->Tolerance=1e-10"); // the default one lets points that stick slip by 1e-7 of what they bear over k (5.10)
  const Solution s = solved("loop", deck);
  const auto points = contact_points(s);
  ASSERT_EQ(points.size(), cells + 1u);
  const double p = sticks.pressure();
  for (const ContactPoint &point : points) {
    SCOPED_TRACE(point.x[0]);
    EXPECT_NEAR(point.pressure, p, 1e-8 * p);
    if (point.x[0] == 0) continue; // the axis cannot slip
    EXPECT_EQ(point.slip_state, 1);
    EXPECT_NEAR(point.q[0], sticks.shear(mean_radius(point.x[0], 1. / cells)), 1e-8 * p);
    EXPECT_NEAR(point.slip[0], 0, 1e-12);
  }
  EXPECT_EQ(s.contact.total.force[0], 0); // around the axis they cancel
  EXPECT_NEAR(s.contact.total.force[1], pi * p, 1e-8 * p);
}

TEST(FrictionOfACylinder, ThatSlipsOutwardsIsMuP)
{
  constexpr int cells = 8;
  const double h = 1. / cells, p = slips.pressure(), factor = G * slips.c / p;
  const std::string coefficient = text(factor) + "*(x < 1e-9 ? 1 : x < " + text(1 - h / 2) + " ? x + " +
                                  text(h * h / 6) + "/x : " + text(mean_radius(1, h)) + ")";
  const Solution s = solved("loop", slips.deck("Q1", cells, coefficient));
  double work = 0; // sum of w s e
  for (const ContactPoint &point : contact_points(s)) {
    const double r = point.x[0];
    SCOPED_TRACE(r);
    EXPECT_NEAR(point.pressure, p, 1e-8 * p);
    if (r == 0) continue;
    EXPECT_EQ(point.slip_state, 2);
    EXPECT_NEAR(point.q[0], slips.shear(mean_radius(r, h)), 1e-8 * p);
    EXPECT_NEAR(point.slip[0], slips.alpha * r, 1e-8 * slips.alpha);
    // w = 2 pi int N r dr
    const double weight = 2 * pi * (r < 1 - h / 2 ? r * h : h / 2 - h * h / 6);
    EXPECT_NEAR(point.weight, weight, 1e-12);
    work += weight * slips.shear(mean_radius(r, h)) * slips.alpha * r;
  }
  EXPECT_NEAR(s.contact.total.friction_work, work, 1e-8 * work);
  EXPECT_NEAR(s.history.back().energies.friction, work / 2, 1e-8 * work); // the trapezoid from rest
  EXPECT_NEAR(s.contact.total.slip_length, pi, pi * h * h);               // all but the axis' share
}

class CylinderOf : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Elements, CylinderOf, testing::Values("P1", "P2", "Q1", "Q2"));

TEST_P(CylinderOf, AllElementsConvergesToItsClosedForm)
{
  const std::string element = GetParam();
  const double p = slips.pressure();
  const auto error = [&](const int cells) { // root mean square of the slip, over its largest
    const Solution s = solved("loop", slips.deck(element, cells, text(G * slips.c / p) + "*x"));
    double squares = 0, area = 0;
    for (const ContactPoint &point : contact_points(s)) {
      if (!(point.x[0] > 0)) continue;
      squares += point.weight * std::pow(point.slip[0] - slips.alpha * point.x[0], 2);
      area += point.weight;
    }
    return std::sqrt(squares / area) / slips.alpha;
  };
  const double coarse = error(8), fine = error(16);
  RecordProperty("errors", text(coarse) + " " + text(fine));
  EXPECT_LT(fine, element == "P1" ? 0.008 : 0.004);
  EXPECT_GT(std::log2(coarse / fine), 1.6) << coarse << " " << fine;
}

} // namespace
} // namespace friction_axisymmetric_test
