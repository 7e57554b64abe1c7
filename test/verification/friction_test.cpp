#include "run_scene.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

// Friction against an independent program (dense Schur complements of the contact unknowns, exact solves), closed forms and
// published values.

namespace
{

using namespace rpc;

Solution solved(const std::string &name, const std::vector<std::string> &assignments = {})
{
  Solution s = run_scene(std::string(RPC_TEST_DECKS) + "/friction_" + name + ".xml", assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  return s;
}

/// Points in contact that stick, and that slip, over all ranks.
std::array<GO, 2> counts(const Solution &s)
{
  const auto state = to_host(s.contact.slip_state);
  const auto p = to_host(s.contact.pressure);
  std::array<GO, 2> mine{}, all{};
  for (std::size_t i = 0; i < state.extent(0); ++i)
    if (p(i) > 0 && state(i) > 0) ++mine[state(i) - 1];
  Teuchos::reduceAll(s.discretization.mesh->comm(), Teuchos::REDUCE_SUM, 2, mine.data(), all.data());
  return all;
}

struct Reference {
  const char *name;
  double energy, normal;
  std::array<double, 2> tangential; ///< of the body on the foundation
  double max_pressure, max_shear, max_slip, friction_work;
  GO stick, slip; ///< a point that Dirichlet conditions hold along the side counts in neither
};
const Reference references[] = {
    {"greco",
     -117.04849550379957,
     2000000.0000000168,
     {1405376.4079027919, 0.0},
     83880874.19431967,
     71674794.38751553,
     2.4380086358674955e-05,
     8.801919544711591,
     8,
     21},
    {"cantilever_coulomb",
     -3.545445418784337,
     397.54340509272356,
     {16.29095393214964, 0.0},
     299.97791222764494,
     29.107130755283656,
     0.00027377495641104656,
     0.002902441594705082,
     27,
     43},
    {"block_tresca",
     -0.12609266016861514,
     16.43912527770383,
     {-0.6507073908677066, -0.4648631627552676},
     9.375000000000007,
     1.7500000000000058,
     0.0004663224399074821,
     0.00019408928333364405,
     127,
     48},
};

class FrictionScene : public testing::TestWithParam<Reference>
{
};
INSTANTIATE_TEST_SUITE_P(References, FrictionScene, testing::ValuesIn(references),
                         [](const auto &info) { return std::string(info.param.name); });

TEST_P(FrictionScene, IsThatOfAnIndependentProgram)
{
  const Reference &reference = GetParam();
  const Solution s = solved(reference.name);
  const int dim = s.discretization.dim();
  const auto &found = s.contact.total;
  constexpr double close = 1e-8;
  EXPECT_NEAR(s.energy, reference.energy, close * std::abs(reference.energy));
  EXPECT_NEAR(found.force[dim - 1], reference.normal, close * reference.normal);
  for (int k = 0; k + 1 < dim; ++k)
    EXPECT_NEAR(found.force[k], -reference.tangential[k], close * std::abs(reference.tangential[k]));
  EXPECT_NEAR(found.max_pressure, reference.max_pressure, close * reference.max_pressure);
  EXPECT_NEAR(found.max_shear, reference.max_shear, close * reference.max_shear);
  EXPECT_NEAR(found.max_slip, reference.max_slip, close * reference.max_slip);
  EXPECT_NEAR(found.friction_work, reference.friction_work, close * reference.friction_work);
  EXPECT_EQ(counts(s)[0], reference.stick);
  EXPECT_EQ(counts(s)[1], reference.slip);
  EXPECT_LE(s.uzawa.newton_iterations.front(), 12);
  EXPECT_EQ(s.line_search_steps, 0);
  EXPECT_EQ(s.linear.preconditioner_setups, 1);
}

TEST(Wedge, IsHeldByItsClosedForm)
{
  const double slope = std::atan(0.2), mu = 0.3, push = 10;
  const double normal = push / (std::sin(slope) + mu * std::cos(slope));
  const Solution s = solved("wedge");
  const auto &force = s.contact.total.force;
  EXPECT_NEAR(-force[0] * std::sin(slope) + force[1] * std::cos(slope), normal, 1e-9 * normal);
  EXPECT_NEAR(-force[0] * std::cos(slope) - force[1] * std::sin(slope), mu * normal, 1e-9 * normal);
  EXPECT_EQ(counts(s)[1], 33);
  EXPECT_LE(s.uzawa.newton_iterations.front(), 5);
}

TEST(Greco, ProbesAreThePublishedOnes)
{
  const Solution s = solved("greco");
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto x = to_host(mesh.coords);
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  int found = 0;
  for (LO node = 0; node < mesh.num_owned_nodes(); ++node)
    for (const auto &[at, published] : {std::pair(0., 28.6), {0.00125, 27.2}, {0.005, 22.8}, {0.0075, 19.8}}) {
      if (x(node, 1) > 1e-12 || std::abs(x(node, 0) - at) > 1e-9) continue;
      EXPECT_NEAR(1e6 * u(2 * node, 0), published, 0.06) << at;
      ++found;
    }
  EXPECT_EQ(sum_all(mesh.comm(), GO(found)), 4);
}

/// The traction of a column whose top is moved by U: elastic, perfectly plastic friction.
std::vector<double> loop_tractions(const std::vector<double> &moved, const double modulus, const double bound)
{
  std::vector<double> q;
  double now = 0, before = 0;
  for (const double u : moved) {
    now = std::max(-bound, std::min(bound, now + modulus * (u - before)));
    before = u;
    q.push_back(now);
  }
  return q;
}

TEST(Loop, FollowsItsClosedFormThroughReversals)
{
  const Solution s = solved("loop");
  const double shear = 1000 / 2.6, pressure = 1000 * 0.7 / (1.3 * 0.4) * 0.01, bound = 0.2 * pressure;
  ASSERT_EQ(s.history.size(), 21u);
  std::vector<double> moved;
  for (const auto &step : s.history) moved.push_back(step.displacements.front()[0]);
  const auto expected = loop_tractions(moved, shear, bound);
  double slipped = 0, dissipated = 0;
  for (std::size_t k = 0; k < s.history.size(); ++k) {
    SCOPED_TRACE(s.history[k].time);
    const double slip = moved[k] - expected[k] / shear - slipped, before = k > 0 ? expected[k - 1] : 0;
    slipped += slip;
    dissipated += 2 * slip * (expected[k] + before) / 2; // over a side of length 2
    EXPECT_NEAR(s.history[k].contact.force[0], -2 * expected[k], 1e-8 * bound);
    EXPECT_NEAR(s.history[k].contact.force[1], 2 * pressure, 1e-8 * pressure);
    EXPECT_NEAR(s.history[k].energies.friction, dissipated, 1e-8 * bound * 0.01);
    EXPECT_NEAR(s.history[k].energies.imbalance, 0, 1e-10);
    EXPECT_LE(s.history[k].newton_iterations, 4);
  }
}

TEST(Loop, OnAYieldingFoundationSlipsAtTheYieldStressTimesMu)
{
  const Solution s = solved("loop_yield");
  EXPECT_NEAR(s.contact.total.force[0], -2 * 0.2 * 10, 1e-8);
  EXPECT_NEAR(s.contact.total.force[1], 2 * 10, 1e-8);
  EXPECT_NEAR(s.history.back().energies.friction, 0.026892307692307692, 1e-10);
  EXPECT_NEAR(s.contact.total.max_dent, 0.0025714285714285717, 1e-10);
}

TEST(Friction, OfCoefficientZeroIsNoFriction)
{
  const auto numbers = [](const std::string &mu) {
    const Solution s = solved("cantilever_coulomb", {"Contact->Friction Coefficient=" + mu});
    return std::tuple(s.energy, s.contact.total.force[1], s.uzawa.newton_iterations, s.linear.iterations);
  };
  EXPECT_EQ(numbers("0"), numbers("0*x"));
}

TEST(Friction, TopMovedOneWayIsTheFoundationMovedTheOther)
{
  const auto force = [](const std::vector<std::string> &moves) {
    std::vector<std::string> all = {"Contact->Obstacle->Type=plane", "Contact->Obstacle->Normal={0,1}",
                                    "Steps->Times={1,2}", "Contact->Yield Stress=12",
                                    "Contact->Friction Coefficient=0.3"};
    all.insert(all.end(), moves.begin(), moves.end());
    const Solution s = solved("loop", all);
    return std::pair(s.contact.total.force[0], s.history.back().energies.friction);
  };
  const auto body = force({"Dirichlet->top->X=0.004*(t-1)", "Contact->Obstacle->Point={0, 0}"});
  const auto foundation = force({"Dirichlet->top->X=0", "Contact->Obstacle->Point={-0.004*(t-1), 0}"});
  EXPECT_NEAR(body.first, foundation.first, 1e-9 * std::abs(body.first));
  EXPECT_NEAR(body.second, foundation.second, 1e-9 * std::abs(body.second) + 1e-14);
  EXPECT_GT(std::abs(body.first), 0.1);
}

} // namespace
