// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

// A column pressed on a foundation and sheared to and fro: stresses are uniform, and exact with all elements. In the plane its top
// moves along a line, in space around.

namespace friction_column_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr double E = 1000, nu = 0.3, G = E / (2 * (1 + nu)), pressed = 0.01, mu = 0.2;

/// What a body is a section of: its modulus where it can grow no wider, and the share of the pressure that this takes at its sides.
struct Body {
  const char *name;
  int dim;
  double modulus, sideways;
  Assignments deck;
};
constexpr double confined = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
const Body strain{"PlaneStrain", 2, confined, nu / (1 - nu), {}};
const Body stress{"PlaneStress", 2, E / (1 - nu * nu), nu, {"Kinematics=plane stress"}};
const Body space{"Space",
                 3,
                 confined,
                 nu / (1 - nu),
                 {"Mesh->Lower={0, 0, 0}", "Mesh->Upper={2, 1, 1}", "Mesh->Cells={4, 2, 2}",
                  "Dirichlet->top->Side=front", "Contact->Side=back"}};

/// A foundation, and the pressure below a column of this modulus.
struct Ground {
  const char *name;
  Assignments deck;
  double (*pressure)(double modulus);
};
const Ground grounds[] = {
    {"Rigid", {}, [](const double m) { return m * pressed; }},
    {"Yielding", {"Contact->Yield Stress=5"}, [](double) { return 5.; }},
    // p = xi + H w with the dent w = pressed - p/m
    {"Hardening",
     {"Contact->Yield Stress=5", "Contact->Hardening=300"},
     [](const double m) { return (5 + 300 * pressed) / (1 + 300 / m); }},
    // p = k v with v = pressed - p/m
    {"Springs", {"Contact->Stiffness=2000"}, [](const double m) { return pressed / (1 / m + 1 / 2000.); }},
    // pressed = p/m + p/k + (p - xi)/H
    {"SpringsThatYield",
     {"Contact->Yield Stress=5", "Contact->Hardening=300", "Contact->Stiffness=2000"},
     [](const double m) { return (pressed + 5 / 300.) / (1 / m + 1 / 2000. + 1 / 300.); }}};

/// The column of height 1 on an area or length of 2.
struct Column {
  double pressure, bound;
  std::array<double, 2> q{}, top{}, slip{};
  double dissipated = 0;

  explicit Column(const double p) : pressure(p), bound(mu * p) {}

  /// q + G e is the elastic trial, and e points along q: q is the trial, cut to the bound.
  void move_top(const std::array<double, 2> &to)
  {
    std::array<double, 2> before = q;
    for (int k = 0; k < 2; ++k) q[k] += G * (to[k] - top[k]);
    const double trial = std::hypot(q[0], q[1]);
    for (int k = 0; k < 2; ++k) {
      const double elastic = q[k];
      if (trial > bound) q[k] *= bound / trial;
      slip[k] = (elastic - q[k]) / G;
      dissipated += 2 * slip[k] * (q[k] + before[k]) / 2;
    }
    top = to;
  }
};

/// One value at each of the times 1, 2, 3, ...
std::string at_times(const std::vector<double> &values)
{
  std::string expression = text(values.back());
  for (std::size_t k = values.size() - 1; k-- > 0;)
    expression = "(t < " + text(static_cast<double>(k) + 1.5) + " ? " + text(values[k]) + " : " + expression + ")";
  return expression;
}

using Scene2 = std::tuple<Body, Ground, std::string>;
class FrictionColumn : public testing::TestWithParam<Scene2>
{
};
const auto elements = testing::Values("Q1", "Q2", "P1", "P2");
const auto name_of = [](const testing::TestParamInfo<Scene2> &info) {
  return std::string(std::get<0>(info.param).name) + std::get<1>(info.param).name + std::get<2>(info.param);
};
INSTANTIATE_TEST_SUITE_P(Bodies, FrictionColumn,
                         testing::Combine(testing::Values(strain, stress, space), testing::ValuesIn(grounds), elements),
                         name_of);

TEST_P(FrictionColumn, FollowsItsClosedForm)
{
  const auto &[body, ground, element] = GetParam();
  const double p = ground.pressure(body.modulus);
  const bool plane = body.dim == 2;
  // A stick of 0.2 p / G is about 0.004. In space the path turns by 90 degrees, and comes back another way.
  const std::vector<std::array<double, 2>> path =
      plane
          ? std::vector<std::array<double, 2>>{{0, 0}, {0.002, 0}, {0.012, 0}, {0.009, 0}, {-0.012, 0}, {0, 0}}
          : std::vector<std::array<double, 2>>{{0, 0}, {0.002, 0.001}, {0.012, 0.003}, {0.011, 0.012}, {-0.004, 0.001}};
  Column column(p);
  std::vector<Column> expected;
  std::array<std::vector<double>, 2> tops, tractions, against;
  std::string times;
  for (const auto &to : path) {
    column.move_top(to);
    expected.push_back(column);
    times += (times.empty() ? "{" : ", ") + std::to_string(expected.size());
    for (int k = 0; k < 2; ++k) {
      tops[k].push_back(to[k]);
      tractions[k].push_back(column.q[k]);
      against[k].push_back(-column.q[k]);
    }
  }
  const std::string aside = text(body.sideways * p), inwards = text(-body.sideways * p);
  const std::string along = plane ? "Y" : "Z"; // the column's axis
  Assignments deck = joined(body.deck, ground.deck);
  deck =
      joined(deck, {"Mesh->Element=" + element, "Steps->Times=" + times + "}", "Dirichlet->top->X=" + at_times(tops[0]),
                    "Dirichlet->top->" + along + "=" + text(-pressed), "Traction->left->X=" + aside,
                    "Traction->right->X=" + inwards, "Traction->left->Y=0", "Traction->right->Y=0"});
  deck = joined(deck, {"Traction->left->" + along + "=" + at_times(against[0]),
                       "Traction->right->" + along + "=" + at_times(tractions[0])});
  if (!plane)
    deck = joined(deck, {"Dirichlet->top->Y=" + at_times(tops[1]), "Traction->bottom->Y=" + aside,
                         "Traction->bottom->Z=" + at_times(against[1]), "Traction->behind->Side=top",
                         "Traction->behind->Y=" + inwards, "Traction->behind->Z=" + at_times(tractions[1])});
  const auto steps = solved_steps("loop", joined(tight, deck));
  ASSERT_EQ(steps.size(), expected.size());
  for (std::size_t n = 0; n < steps.size(); ++n) {
    SCOPED_TRACE(n);
    const Column &now = expected[n];
    const auto &sums = steps[n].contact.total;
    EXPECT_NEAR(sums.force[body.dim - 1], 2 * p, 1e-8 * p);
    for (int k = 0; k < body.dim - 1; ++k) EXPECT_NEAR(sums.force[k], -2 * now.q[k], 1e-8 * now.bound);
    EXPECT_NEAR(sums.max_pressure, p, 1e-8 * p);
    EXPECT_NEAR(sums.max_shear, std::hypot(now.q[0], now.q[1]), 1e-8 * now.bound);
    EXPECT_NEAR(sums.max_slip, std::hypot(now.slip[0], now.slip[1]), 1e-8 * pressed);
    const auto &energies = steps[n].history.back().energies;
    EXPECT_NEAR(energies.friction, now.dissipated, 1e-8 * now.bound * pressed);
    for (const ContactPoint &point : contact_points(steps[n]))
      for (int k = 0; k < body.dim - 1; ++k)
        EXPECT_NEAR(point.q[k], point.slip_state == 0 ? 0 : now.q[k], 1e-8 * now.bound);
  }
}

} // namespace
} // namespace friction_column_test
