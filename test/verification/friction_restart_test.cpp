// SPDX-License-Identifier: BSD-3-Clause
#include "checkpoint.hpp"

#include "friction_scene.hpp"
#include "scratch_file.hpp"

#include <filesystem>

// A run with friction that goes on from a checkpoint is the run without a break, to the last bit.

namespace friction_restart_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// All that a step is known by.
std::vector<double> numbers(const analysis::Solution &s)
{
  std::vector<double> all = {s.time, s.energy, s.energy_norm_squared, s.contact.total.friction_work};
  const analysis::Energies &e = s.history.back().energies;
  all.insert(all.end(), {e.strain, e.foundation, e.dissipated, e.work, e.imbalance, e.friction});
  for (const ContactPoint &c : contact_points(s)) {
    all.insert(all.end(), {c.pressure, c.u_nu, double(c.slip_state)});
    all.insert(all.end(), c.q.begin(), c.q.end());
    all.insert(all.end(), c.slip.begin(), c.slip.end());
  }
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < u.extent(0); ++i) all.push_back(u(i, 0));
  all.insert(all.end(), {double(s.history.back().newton_iterations), double(s.history.back().linear_iterations)});
  return all;
}

/// The steps that a run solves.
std::vector<std::vector<double>> run(const Scene &scene, Checkpoints &checkpoints)
{
  std::vector<std::vector<double>> steps;
  std::ostream nowhere(nullptr);
  const Solution s = solve(
      scene, Tpetra::getDefaultComm(), nowhere, {},
      [&](const Scene &, const analysis::Solution &step) { steps.push_back(numbers(step)); }, &checkpoints);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_EQ(s.history.back().time, scene.steps.times.back());
  EXPECT_GT(s.history.back().energies.friction, 0);
  return steps;
}

const Assignments free_sides = {"Traction->left->X=0", "Traction->left->Y=0", "Traction->right->X=0",
                                "Traction->right->Y=0", "Steps->Checkpoint Every=3"};
const Assignments plane = joined(free_sides, {"Mesh->Cells={16, 8}", "Contact->Yield Stress=14",
                                              "Steps->Times={1, 1.5, 1.7, 2, 2.25, 2.5, 3, 3.3}"});
const Assignments space =
    joined(free_sides,
           {"Mesh->Lower={0, 0, 0}", "Mesh->Upper={2, 1, 1}", "Mesh->Cells={6, 3, 3}", "Dirichlet->top->Side=front",
            "Dirichlet->top->Z=-0.01", "Contact->Side=back", "Contact->Yield Stress=14",
            "Dirichlet->top->Y=0.006*(t-1)^2", "Steps->Times={1, 1.5, 1.7, 2, 2.25, 2.5, 3, 3.3}"});

struct Case {
  const char *name;
  Assignments scene;
};
const Case cases[] = {{"Plane", plane},
                      {"PlaneTresca", joined(plane, {"Contact->Friction Coefficient=0", "Contact->Friction Bound=2"})},
                      {"PlaneQ2", joined(plane, {"Mesh->Element=Q2", "Mesh->Cells={8, 4}"})},
                      {"PlaneWithHardening", joined(plane, {"Contact->Hardening=500", "Contact->Stiffness=20000"})},
                      {"PlaneWithDentsOfTheFoundation",
                       joined(plane, {"Contact->Dents Move With=foundation", "Contact->Obstacle->Type=plane",
                                      "Contact->Obstacle->Normal={0, 1}", "Contact->Obstacle->Point={0.001*t, 0}"})},
                      {"Space", space},
                      {"SpaceTresca", joined(space, {"Contact->Friction Coefficient=0", "Contact->Friction Bound=2"})}};

class FrictionRestart : public testing::TestWithParam<Case>
{
};
INSTANTIATE_TEST_SUITE_P(Scenes, FrictionRestart, testing::ValuesIn(cases),
                         [](const auto &info) { return std::string(info.param.name); });

TEST_P(FrictionRestart, GoesOnBitForBit)
{
  const Scene scene = read_scene(friction_deck("loop"), GetParam().scene);
  const ScratchFile whole("scratch", ""), rest("scratch", "");
  const auto folder = std::filesystem::path(whole.path()).parent_path(),
             other = std::filesystem::path(rest.path()).parent_path();
  Checkpoints first(scene, false, "", folder.string());
  const auto steps = run(scene, first);
  ASSERT_EQ(steps.size(), scene.steps.times.size());
  // The newest two are kept: after steps 3 and 6.
  for (const std::size_t after : {3, 6}) {
    SCOPED_TRACE(after);
    const auto file = folder / (scene.name + ".checkpoint-00000" + std::to_string(after) + ".e");
    Checkpoints second(scene, true, file.string(), other.string());
    const auto later = run(scene, second);
    ASSERT_EQ(later.size(), steps.size() - after);
    for (std::size_t n = 0; n < later.size(); ++n) EXPECT_EQ(later[n], steps[after + n]) << n;
  }
}

TEST(FrictionRestart, OfADeckThatListsLaterTimesOnlyMeetsTheDentsWhereTheyLie)
{
  const Case &dents = cases[4];
  const Scene scene = read_scene(friction_deck("loop"), dents.scene);
  const ScratchFile whole("scratch", ""), rest("scratch", "");
  const auto folder = std::filesystem::path(whole.path()).parent_path(),
             other = std::filesystem::path(rest.path()).parent_path();
  Checkpoints first(scene, false, "", folder.string());
  const auto steps = run(scene, first);
  constexpr std::size_t done = 3;
  std::string times;
  for (std::size_t n = done; n < steps.size(); ++n) times += (n > done ? ", " : "{") + text(scene.steps.times[n]);
  const Scene later = read_scene(friction_deck("loop"), joined(dents.scene, {"Steps->Times=" + times + "}"}));
  Checkpoints second(later, true, (folder / (scene.name + ".checkpoint-000003.e")).string(), other.string());
  const auto resumed = run(later, second);
  ASSERT_EQ(resumed.size(), steps.size() - done);
  for (std::size_t n = 0; n < resumed.size(); ++n) EXPECT_EQ(resumed[n], steps[done + n]) << n;
}

} // namespace
} // namespace friction_restart_test
