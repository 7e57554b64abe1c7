// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/rigid_motion.hpp"

#include "bodies.hpp"
#include "rpc/fem/elasticity.hpp"

#include <random>

namespace rigid_motion_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::RigidMotion;

fem::DirichletCondition hold(const std::string &side, const std::vector<int> &components)
{
  fem::DirichletCondition condition{side, side, {}};
  for (const int c : components) condition.displacement[c] = ScalarField(0.);
  return condition;
}

/// The free motions of a small box in words, its single part.
std::vector<std::string> free_of(const mesh::BoxOptions &box, const std::vector<fem::DirichletCondition> &held)
{
  const auto d = body(box, world());
  const auto parts = fem::connected_parts(d);
  const auto motions = fem::free_motions(d, parts, fem::dirichlet_dofs(d, held));
  std::vector<std::string> words;
  for (const RigidMotion &r : fem::readable_basis(motions[0], d.dim()))
    words.push_back(fem::in_words(r, parts.part[0], d.dim()).text());
  return words;
}
using Words = std::vector<std::string>;

const mesh::BoxOptions plane{{-1, 2}, {1.5, 3}, {4, 3}, {2, 1}};
const mesh::BoxOptions space{{-1, 2, 0}, {1, 3, 0.5}, {3, 2, 2}, {3, 1}};

TEST(FreeMotions, OfAnUnheldBodyAreAll)
{
  EXPECT_EQ(free_of(plane, {}), (Words{"translation along (1, 0)", "translation along (0, 1)",
                                       "rotation about (0.25, 2.5), counterclockwise"}));
  const Words words = free_of(space, {});
  ASSERT_EQ(words.size(), 6u);
  EXPECT_EQ(words[2], "translation along (0, 0, 1)");
  EXPECT_EQ(words[3], "rotation about the axis through (0, 2.5, 0.25) along (0, 0, 1)");
  EXPECT_EQ(words[5], "rotation about the axis through (0, 2.5, 0.25) along (1, 0, 0)");
}

TEST(FreeMotions, OfAHeldBodyAreNone)
{
  EXPECT_TRUE(free_of(plane, {hold("left", {0, 1})}).empty());
  EXPECT_TRUE(free_of(plane, {hold("left", {0}), hold("bottom", {1})}).empty());
  EXPECT_TRUE(free_of(space, {hold("left", {0, 1, 2})}).empty());
  EXPECT_TRUE(free_of(space, {hold("left", {0}), hold("bottom", {1}), hold("back", {2})}).empty());
}

TEST(FreeMotions, OfARolledBodySlideAlongTheRollers)
{
  EXPECT_EQ(free_of(plane, {hold("left", {0})}), Words{"translation along (0, 1)"});
  EXPECT_EQ(free_of(space, {hold("bottom", {1}), hold("left", {0})}), Words{"translation along (0, 0, 1)"});
  const Words words = free_of(space, {hold("bottom", {1})});
  ASSERT_EQ(words.size(), 3u);
  EXPECT_EQ(words[2].rfind("rotation about the axis through (", 0), 0u) << words[2];
  EXPECT_NE(words[2].find(") along (0, -1, 0)"), std::string::npos) << words[2];
}

TEST(FreeMotions, OfASideThatAForceMovesKeepItInOnePiece)
{
  const auto pressed = [](const std::vector<int> &held, const int along) {
    auto condition = hold("top", held);
    condition.force[along] = ScalarField(1.);
    return condition;
  };
  EXPECT_EQ(free_of(plane, {pressed({0}, 1)}), Words{"translation along (0, 1)"});
  EXPECT_EQ(free_of(plane, {pressed({}, 1)}), (Words{"translation along (1, 0)", "translation along (0, 1)"}));
  EXPECT_EQ(free_of(space, {pressed({0, 2}, 1)}), Words{"translation along (0, 1, 0)"});
  EXPECT_EQ(free_of(space, {pressed({}, 1)}).size(), 4u); // it also turns about y
}

/// The plane body with Dirichlet flags at the nodes of the left side that satisfy `at`.
std::vector<std::vector<RigidMotion>> free_at_nodes(const std::function<bool(const Point &)> &at, fem::Parts *found)
{
  const auto d = body({{0, 0}, {2, 1}, {2, 1000}, {2, 1}}, world());
  const auto parts = fem::connected_parts(d);
  auto dirichlet = fem::dirichlet_dofs(d, {});
  const auto fixed = to_host(dirichlet.fixed);
  const auto coords = to_host(d.mesh->coords);
  for (LO n = 0; n < d.mesh->num_local_nodes(); ++n)
    for (int c = 0; c < 2; ++c) fixed(2 * n + c) = at({coords(n, 0), coords(n, 1), 0});
  Kokkos::deep_copy(dirichlet.fixed, fixed);
  if (found) *found = parts;
  return fem::free_motions(d, parts, dirichlet);
}

TEST(FreeMotions, OfABodyOnAHingeTurnAboutIt)
{
  fem::Parts parts;
  const auto motions = free_at_nodes([](const Point &x) { return x[0] == 2 && x[1] == 1; }, &parts);
  ASSERT_EQ(motions[0].size(), 1u);
  const auto words = fem::in_words(motions[0][0], parts.part[0], 2);
  EXPECT_TRUE(words.rotates);
  EXPECT_EQ(words.where.rfind("about (2, 1), ", 0), 0u) << words.where;
}

TEST(FreeMotions, OfABodyClampedOnAThousandthOfAnEdgeAreNone)
{
  EXPECT_TRUE(free_at_nodes([](const Point &x) { return x[0] == 0 && x[1] < 1.5e-3; }, nullptr)[0].empty());
}

TEST(NullSpace, StopsWhatIsAboveTheTolerance)
{
  const auto all = fem::all_motions(3);
  const std::vector<RigidMotion> rows = {{1, 0, 0, 0, 0, 0}, {1, 1e-6, 0, 0, 0, 0}, {1, 0, 1e-12, 0, 0, 0}};
  const auto space = fem::null_space(rows, all, 1e-8);
  ASSERT_EQ(space.size(), 4u);
  for (const auto &r : space) {
    EXPECT_NEAR(r[0], 0, 1e-11);
    EXPECT_NEAR(r[1], 0, 1e-5); // the noise over the lever
    EXPECT_NEAR(fem::dot(r, r), 1, 1e-14);
  }
  EXPECT_EQ(fem::independent_rows(rows, 1e-8).size(), 2u);
}

TEST(NullSpace, OfRandomRowsIsOrthogonalToThem)
{
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int count = 0; count <= 6; ++count) {
    std::vector<RigidMotion> rows(count);
    for (auto &row : rows)
      for (double &entry : row) entry = normal(random);
    for (int copies = count; copies > 0; --copies) rows.push_back(rows[copies - 1]);
    const auto space = fem::null_space(rows, fem::all_motions(3), 1e-8);
    ASSERT_EQ(space.size(), 6u - count);
    for (std::size_t i = 0; i < space.size(); ++i) {
      for (const auto &row : rows) EXPECT_NEAR(fem::dot(space[i], row), 0, 1e-12);
      for (std::size_t j = 0; j < space.size(); ++j) EXPECT_NEAR(fem::dot(space[i], space[j]), i == j, 1e-14);
    }
  }
}

TEST(Resultants, AreWhatTheLoadDoesAlongEachMode)
{
  for (const auto &box : {plane, space}) {
    const auto d = body(box, world());
    const auto parts = fem::connected_parts(d);
    Vector load(d.owned_dofs);
    fem::add_traction(d, d.mesh->side("right", "test"), {ScalarField(0.), ScalarField(-3.), ScalarField(0.)}, "t",
                      load);
    const auto resultant = fem::resultants(d, parts, load)[0];
    const double area = d.dim() == 2 ? 1 : 0.5, arm = (box.upper[0] - box.lower[0]) / 2;
    EXPECT_NEAR(resultant.magnitude, 3 * area, 1e-13);
    EXPECT_NEAR(resultant.force[0], 0, 1e-13);
    EXPECT_NEAR(resultant.force[1], -3 * area, 1e-13);
    // counterclockwise in the plane of x and y, over the radius
    EXPECT_NEAR(resultant.force[d.dim()] * parts.part[0].radius, -3 * area * arm, 1e-13);
    for (int k = d.dim() + 1; k < 6; ++k) EXPECT_NEAR(resultant.force[k], 0, 1e-13);
  }
}

// What is left of a rigid motion and of a displacement `other` that vanishes where the body is held.
void expect_rest(const fem::Discretization &d, const std::vector<fem::DirichletCondition> &held,
                 const std::function<Point(const Point &)> &rigid, const std::function<Point(const Point &)> &other)
{
  const auto sum = [&](const Point &x) {
    const Point a = rigid(x), b = other(x);
    return Point{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  };
  Vector error = fem::without_rigid_motion(d, fem::dirichlet_dofs(d, held), *interpolate(d, sum));
  error.update(-1., *interpolate(d, other), 1.);
  EXPECT_LT(error.normInf(), 1e-13);
}

TEST(WithoutRigidMotion, LeavesWhatIsNotPrescribed)
{
  const auto turned = [](const Point &x) {
    return Point{3 - 0.2 * x[1] + 0.4 * x[2], -7 + 0.2 * x[0] - 0.3 * x[2], 5 - 0.4 * x[0] + 0.3 * x[1]};
  };
  const auto turned_in_plane = [](const Point &x) { return Point{3 - 0.2 * x[1], -7 + 0.2 * x[0], 0}; };
  const auto from_left = [](const Point &x) { return Point{std::sin(x[0] + 1), (x[0] + 1) * x[1], 0}; }; // x = -1
  expect_rest(body(plane, world()), {hold("left", {0, 1})}, turned_in_plane, from_left);
  expect_rest(body(space, world()), {hold("left", {0, 1, 2})}, turned, from_left);
  // One end of a rolled body says nothing of motions along the rollers.
  const auto along_rollers = [](const Point &x) { return Point{4 + x[1], 0, 0}; };
  const auto turned_about_centre = [](const Point &x) { return Point{x[1] - 2.5, 2 - x[0], 0}; };
  expect_rest(body(plane, world()), {hold("bottom", {1})}, turned_about_centre, along_rollers);
  expect_rest(
      body(plane, world()), {}, [](const Point &) { return Point{}; }, from_left);
}

TEST(WithoutRigidMotion, OfAnAxisymmetricBodyIsAlongItsAxis)
{
  const auto d = body({{1, 0}, {2, 1}, {3, 2}, {2, 1}}, world(), {}, fem::Kinematics::axisymmetric);
  expect_rest(
      d, {hold("top", {0, 1})},
      [](const Point &) {
        return Point{0, 9, 0};
      },
      [](const Point &x) {
        return Point{0.1 + x[0], x[1] - 1, 0};
      });
}

/// The forces of a body that turns by 0.3 and moves by 2 and hardly strains are those of the strain alone.
void expect_forces_of_the_strain(const mesh::BoxOptions &box, const double strain)
{
  const auto d = body(box, world());
  const int dim = d.dim();
  const fem::Materials materials = fem::Material{1, 0.3};
  Vector u(d.owned_dofs), rest(d.owned_dofs), strained(d.owned_dofs);
  {
    const auto x = to_host(d.mesh->coords);
    const auto whole = u.getLocalViewHost(Tpetra::Access::OverwriteAll),
               left = rest.getLocalViewHost(Tpetra::Access::OverwriteAll),
               alone = strained.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      const double small[3] = {strain * x(n, 0) * x(n, 1), strain * x(n, 1), strain * x(n, 0)};
      const long double turned[3] = {2.L - 0.3L * x(n, 1), 1.L + 0.3L * x(n, 0), 0.5L};
      for (int c = 0; c < dim; ++c) {
        alone(dim * n + c, 0) = small[c];
        whole(dim * n + c, 0) = static_cast<double>(turned[c] + small[c]);
        left(dim * n + c, 0) = static_cast<double>(turned[c] + small[c] - whole(dim * n + c, 0));
      }
    }
  }
  const auto forces = [&](const Vector &of) { return fem::internal_work(d, materials, of).forces; };
  const auto expected = forces(strained);
  const auto error = [&](const Vector &of) {
    Vector difference(*forces(of), Teuchos::Copy);
    difference.update(-1., *expected, 1.);
    return difference.norm2() / expected->norm2();
  };
  EXPECT_GT(error(u), 1e-8);
  EXPECT_LT(error(fem::strained_part(d, u, rest)), 0.05 * error(u)); // what long doubles leave
}

TEST(StrainedPart, HasTheForcesOfABodyThatMovesFar)
{
  expect_forces_of_the_strain(plane, 1e-10);
  expect_forces_of_the_strain(space, 1e-10);
}

TEST(MotionInWords, NamesTheAxisOfAScrew)
{
  fem::Part part;
  part.centre = {1, 2, 3};
  part.radius = 2;
  // omega = (0, 0, 1/2), t = (1, 0, 0.25): the axis passes where omega x (x - c) = -(1, 0, 0)
  const auto words = fem::in_words({1, 0, 0.25, 1, 0, 0}, part, 3);
  EXPECT_TRUE(words.rotates);
  EXPECT_EQ(words.size, 0.5);
  EXPECT_EQ(words.where, "about the axis through (1, 4, 3) along (0, 0, 1) that advances 0.5 m per radian");
}

TEST(MotionInWords, RoundsWhatSearchesLeave)
{
  fem::Part part;
  part.centre = {1, 2, 3};
  part.radius = 2;
  EXPECT_EQ(fem::in_words({7.98598e-06, -1, -1e-7}, part, 3).where, "along (0, -1, 0)");
  EXPECT_EQ(fem::in_words({0.6, -0.8}, part, 2).where, "along (0.6, -0.8)");
  EXPECT_EQ(fem::in_words({1, 0, 0.25, 1, 1e-5, 0}, part, 3).where.substr(0, 52),
            "about the axis through (1, 4, 3) along (0, 0, 1) tha");
}

} // namespace
} // namespace rigid_motion_test
