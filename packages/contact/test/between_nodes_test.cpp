// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/between_nodes.hpp"

#include "rpc/contact/clearance.hpp"
#include "rpc/contact/surface/sphere.hpp"
#include "rpc/core/device_values.hpp"
#include "touching_box.hpp"

#include <cmath>
#include <functional>
#include <vector>

namespace between_nodes_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::ContactResult;

constexpr fem::Material steel{2000, 0.3};

/// What is found on a body of 2 x 1 (x 1) m of 4 x 2 (x 2) cells at a displacement of its own, with multipliers that are 0.
struct Looked {
  fem::Discretization d;
  std::vector<contact::ContactOptions> options;
  contact::ContactNodes points;
  RCP<Vector> u;
  ContactResult result;

  Looked(const mesh::Element &element, const contact::ContactOptions &side, const double pressure = 0)
      : Looked(body(element), side, pressure)
  {
  }
  Looked(fem::Discretization of, const contact::ContactOptions &side, const double pressure = 0)
      : d(std::move(of)), options{side}, points(nodes_of(d, options)), u(rcp(new Vector(d.owned_dofs)))
  {
    look([=](const Point &) { return pressure; });
  }
  /// @param pressure  of the contact point at a place [Pa]
  void look(const std::function<double(const Point &)> &pressure)
  {
    contact::ContactState state;
    state.displacement = u;
    const auto at = to_host(d.mesh->coords);
    const auto node = to_host(points.node);
    std::vector<double> of_points;
    for (LO i = 0; i < points.size(); ++i) of_points.push_back(pressure({at(node(i), 0), at(node(i), 1), 0}));
    state.multiplier.normal = device_values(of_points, "pressure");
    const auto sides = contact::contact_sides(*d.mesh, options);
    result = contact::contact_result(d, sides, points, state);
    contact::look_between_nodes(d, sides, options, points, steel, *u, result);
  }
  std::string note(const double energy_norm_squared, const bool adapts = false) const
  {
    return contact::unseen_contact_note(result, options, d.dim(), energy_norm_squared, {}, adapts);
  }
};

/// A gap of `depth` below 0 at x = 0.7 in a parabola of half width b, and 1 beyond twice that.
contact::ContactOptions bump(const double depth, const double b)
{
  auto options = touching("bottom");
  options.gap = ScalarField("bump", [=](const Point &x) {
    const double s = (x[0] - 0.7) / b;
    return std::min(1., depth * (s * s - 1));
  });
  return options;
}

TEST(BetweenNodes, ABumpBetweenTwoNodesIsUnseenAndItsDepthPlaceAndWidthAreTold)
{
  // Nodes at 0.5 and 1.
  const Looked looked({2, 1}, bump(0.02, 0.1));
  const auto &at = looked.result.between.unseen;
  EXPECT_NEAR(at.depth, 0.02, 1e-5);
  EXPECT_NEAR(at.place[0], 0.7, 1e-3);
  EXPECT_EQ(at.place[1], 0);
  EXPECT_NEAR(at.width, 0.2, 1e-3);
  EXPECT_NEAR(at.facet, 0.5, 1e-12);
  EXPECT_EQ(looked.result.total.unseen_penetration, at.depth);
  EXPECT_EQ(looked.result.total.max_penetration_between_nodes, at.depth);
}

TEST(BetweenNodes, SmallestGapIsThatOfSamplesBetweenTheNodesToo)
{
  const auto left = [](const double gap, const double depth) {
    auto options = bump(depth, 0.1);
    const ScalarField of_bump = options.gap;
    options.gap = ScalarField("bump further off", [=](const Point &x) { return gap + of_bump(x); });
    const Looked looked({2, 1}, options);
    return contact::smallest_gap(looked.d.mesh->comm(), looked.points, looked.result);
  };
  EXPECT_NEAR(left(0.03, 0.02), 0.01, 1e-5); // at nodes 0.09 at least
  EXPECT_NEAR(left(0.01, 0.02), -0.01, 1e-5);
  auto face = touching("back"); // a sphere below the middle of a face, whose nodes are alike
  face.obstacle = {contact::Sphere{3}, {0.75, 0.75, -3.001}};
  const Looked looked({3, 1}, face);
  EXPECT_NEAR(contact::smallest_gap(looked.d.mesh->comm(), looked.points, looked.result), 0.001, 1e-6);
}

/// A strip or a plate of 1 m with so many cells along its edge.
fem::Discretization many_facets(const int dim, const int cells)
{
  mesh::BoxOptions box{{0, 0}, {1, 0.1}, {cells, 1}, {2, 1}};
  if (dim == 3) box = {{0, 0, 0}, {1, 1, 0.1}, {cells, cells, 1}, {3, 1}};
  return fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
}

TEST(BetweenNodes, FacetsWhoseNodesAreAlikeAreLookedAtHoweverManyThereAre)
{
  // Nodes tell nothing of what lies below the middle of one facet.
  const double h = 1. / 1200, depth = 1e-4;
  auto strip = touching("bottom");
  strip.gap = ScalarField("bump", [=](const Point &x) { return std::abs(x[0] - 700.5 * h) < h / 3 ? -depth : 1e-3; });
  EXPECT_NEAR(Looked(many_facets(2, 1200), strip).result.between.unseen.depth, depth, 1e-12);
  auto plate = touching("back");
  plate.normal = contact::Normal::foundation;
  plate.obstacle = {contact::Sphere{0.004}, {20.5 / 40, 10.5 / 40, depth - 0.004}};
  EXPECT_NEAR(Looked(many_facets(3, 40), plate).result.between.unseen.depth, depth, 1e-12);
}

TEST(BetweenNodes, OfASmoothGapTheWorkOfThePressureOverItsInterpolantsErrorIsTold)
{
  // The interpolant of c x^2 on facets of length h is too large by c h^2/6 in the mean; the side is 2 m long.
  const double c = 0.01, h = 0.5, p = 10;
  auto side = touching("bottom");
  side.gap = ScalarField("parabola", [=](const Point &x) { return c * x[0] * x[0]; });
  EXPECT_NEAR(Looked({2, 1}, side, p).result.between.interpolation_work / (-p * 2 * c * h * h / 6), 1, 0.01);
  EXPECT_NEAR(Looked({2, 2}, side, p).result.between.interpolation_work, 0, 1e-12);
  for (const auto shape :
       {mesh::Shape::tensor, mesh::Shape::simplex}) // in space it is 1 m wide, and there are fewer samples
    EXPECT_NEAR(Looked({3, 1, shape}, side, p).result.between.interpolation_work / (-p * 2 * c * h * h / 6), 1, 0.07);
  EXPECT_EQ(Looked({2, 1}, side).result.between.interpolation_work, 0); // nothing touches
  // Simpson's rule is off by c h^4/120 in the mean where the gap is c x^4.
  side.gap = ScalarField("fourth power", [=](const Point &x) { return c * std::pow(x[0], 4); });
  EXPECT_NEAR(Looked({2, 2}, side, p).result.between.interpolation_work / (-p * 2 * c * std::pow(h, 4) / 120), 1, 0.01);
}

TEST(BetweenNodes, OnFacetsOfOrderTwoAKinkWithinAFacetCountsInTheWorkOverItsInterpolant)
{
  // c |x - t| with t at a tenth of a facet: Simpson's rule has (0.1 + 4*0.4 + 0.9)/6 c h, the integral is (0.1^2 + 0.9^2)/2 c h. Samples are off the
  // interpolant by less than a quarter of the range at the nodes.
  const double c = 0.01, h = 0.5, p = 10, t = 1 + 0.1 * h, work = -p * c * h * h * (2.6 / 6 - 0.41);
  auto side = touching("bottom");
  side.gap = ScalarField("kink", [=](const Point &x) { return c * std::abs(x[0] - t); });
  for (const auto shape : {mesh::Shape::tensor, mesh::Shape::simplex}) {
    const auto between = Looked({2, 2, shape}, side, p).result.between;
    EXPECT_EQ(between.misread_energy, 0);
    EXPECT_NEAR(between.interpolation_work / work, 1, 0.01);
  }
}

TEST(BetweenNodes, EnergyIsThatOfALayerAsDeepAsThePartIsWide)
{
  // (3.16): lambda + 2 mu over b times half of the integral of e^2, 16/15 depth^2 b / 2.
  const double modulus = steel.lambda() + 2 * steel.mu(), integral = 16. / 15 * 0.02 * 0.02 * 0.1;
  const Looked rigid({2, 1}, bump(0.02, 0.1));
  EXPECT_NEAR(rigid.result.total.unseen_energy / (0.5 * modulus / 0.2 * integral), 1, 3e-3);
  auto on_springs = bump(0.02, 0.1);
  on_springs.stiffness = ScalarField(modulus / 0.2); // as stiff as the layer
  EXPECT_NEAR(Looked({2, 1}, on_springs).result.total.unseen_energy / (0.25 * modulus / 0.2 * integral), 1, 3e-3);
  auto soft = bump(0.02, 0.1);
  soft.yield_stress = ScalarField(1e-3); // gives way at once: xi times 4/3 depth b
  EXPECT_NEAR(Looked({2, 1}, soft).result.total.unseen_energy / (1e-3 * 4. / 3 * 0.02 * 0.1), 1, 3e-3);
  double of_facets = 0;
  const auto squared = to_host(rigid.result.between.unseen_squared.at(0));
  const auto cell = to_host(rigid.d.mesh->side("bottom", "test").cell);
  for (std::size_t f = 0; f < squared.extent(0); ++f)
    if (cell(f) < rigid.d.mesh->num_owned_cells) of_facets += squared(f);
  EXPECT_NEAR(sum_all(rigid.d.mesh->comm(), of_facets), 2 * rigid.result.total.unseen_energy, 1e-12);
}

TEST(BetweenNodes, ABumpBetweenNodesThatTouchBesideItIsUnseen)
{
  // All nodes of the facet touch a plane, on which the bump stands. In space it is a tenth of the face wide, between its quarters.
  constexpr double depth = 0.01, b = 0.025;
  for (const mesh::Element &element : {mesh::Element{2, 1}, {2, 2}, {3, 1}, {3, 2}, {3, 1, mesh::Shape::simplex}}) {
    SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim));
    auto side = touching(element.dim == 2 ? "bottom" : "back");
    side.gap = ScalarField("bump on a plane", [=](const Point &x) {
      const double dx = x[0] - 0.82, dy = element.dim == 2 ? 0 : x[1] - 0.06;
      return std::min(0., depth * ((dx * dx + dy * dy) / (b * b) - 1));
    });
    const Looked looked(element, side, 1);
    EXPECT_NEAR(looked.result.total.unseen_penetration, depth, 0.1 * depth);
    EXPECT_NEAR(looked.result.between.unseen.width, element.dim == 2 ? 2 * b : std::sqrt(M_PI) * b, 0.3 * b);
    EXPECT_NE(looked.note(1e-3), "");
    EXPECT_NEAR(looked.result.between.hidden_energy / looked.result.total.unseen_energy, 1, 1e-12);
  }
}

TEST(BetweenNodes, BetweenNodesThatTouchKinksAndJumpsOfTheGapAreUnseenContactAndSmoothGapsAreNot)
{
  using Gap = std::function<double(const Point &)>;
  const std::vector<std::pair<std::string, Gap>> smooth = {
      {"slope", [](const Point &x) { return -0.01 * x[0]; }},
      {"third power", [](const Point &x) { return -0.1 + 0.01 * std::pow(x[0], 3); }},
      {"wave", [](const Point &x) { return -0.1 + 0.01 * std::sin(3 * x[0] + 2 * x[1]); }},
      {"ball",
       [](const Point &x) { return -0.1 + 3 - std::sqrt(9 - std::pow(x[0] - 0.7, 2) - std::pow(x[1] - 0.4, 2)); }}};
  const std::vector<std::pair<std::string, Gap>> rough = {
      {"kink", [](const Point &x) { return -0.1 + 0.02 * std::abs(x[0] - 0.67); }},
      {"jump", [](const Point &x) { return x[0] < 0.7 ? -0.11 : -0.1; }}};
  for (const mesh::Element &element : std::vector<mesh::Element>{{2, 1},
                                                                 {2, 2},
                                                                 {2, 2, mesh::Shape::simplex},
                                                                 {3, 1},
                                                                 {3, 1, mesh::Shape::simplex},
                                                                 {3, 2},
                                                                 {3, 2, mesh::Shape::simplex}}) {
    auto side = touching(element.dim == 2 ? "bottom" : "back");
    const auto unseen = [&](const std::string &name, const Gap &gap) {
      SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + ", " + name);
      side.gap = ScalarField(name, gap);
      const Looked looked(element, side, 1);
      if (element.order == 1 && name == "ball") {
        EXPECT_GT(looked.result.total.max_penetration_between_nodes, 0.005);
      }
      // Beside a jump the gap is that of a node that bears, but of a vertex without weight; before a kink it is smaller.
      if (element.name() != "P2" || element.dim == 2)
        EXPECT_EQ(looked.result.between.hidden_energy > 0, name == "kink");
      return looked.result.total.unseen_energy;
    };
    for (const auto &[name, gap] : smooth) EXPECT_EQ(unseen(name, gap), 0) << element.name() << ", " << name;
    for (const auto &[name, gap] : rough) EXPECT_GT(unseen(name, gap), 0) << element.name() << ", " << name;
    side.obstacle = {contact::Sphere{3}, {0.7, element.dim == 2 ? -2.5 : 0.4, element.dim == 2 ? 0 : -2.5}};
    EXPECT_EQ(Looked(element, side, 1).result.total.unseen_energy, 0) << element.name() << ", sphere";
  }
}

TEST(BetweenNodes, ASphereBelowAVertexOfQuadraticTrianglesIsUnseenAndTheVertexIsNotOpen)
{
  // Vertices have no weight; the sphere reaches the vertex (1, 0.5, 0) and none of the middle nodes.
  auto side = touching("back");
  side.normal = contact::Normal::fixed;
  side.direction = {0, 0, -1};
  side.obstacle = {contact::Sphere{0.7}, {1, 0.5, -0.69}};
  const Looked looked({3, 2, mesh::Shape::simplex}, side);
  EXPECT_NEAR(looked.result.between.unseen.depth, 0.01, 1e-12);
  EXPECT_NEAR(looked.result.between.unseen.place[0], 1, 1e-12);
  EXPECT_NEAR(looked.result.between.unseen.place[1], 0.5, 1e-12);
  const auto state = to_host(looked.result.state);
  const auto v = to_host(looked.result.penetration);
  GO unseen = 0, inside_but_open = 0;
  for (std::size_t i = 0; i < state.extent(0); ++i) {
    unseen += state(i) == ContactResult::unseen ? 1 : 0;
    inside_but_open += state(i) == 0 && v(i) > 1e-9 ? 1 : 0;
  }
  EXPECT_EQ(sum_all(looked.d.mesh->comm(), unseen), 1);
  EXPECT_EQ(sum_all(looked.d.mesh->comm(), inside_but_open), 0);
}

TEST(BetweenNodes, NothingIsFoundOnAPlaneOrInFrontOfASphereThatIsAway)
{
  for (const mesh::Element element :
       {mesh::Element{2, 1}, mesh::Element{2, 2}, mesh::Element{2, 2, mesh::Shape::simplex}, mesh::Element{3, 1},
        mesh::Element{3, 2}, mesh::Element{3, 2, mesh::Shape::simplex}}) {
    auto side = touching(element.dim == 2 ? "bottom" : "back");
    EXPECT_EQ(Looked(element, side).result.total.max_penetration_between_nodes, 0); // gap 0 everywhere
    side.obstacle = {contact::Sphere{3}, {1, element.dim == 2 ? -3.001 : 0.5, element.dim == 2 ? 0 : -3.001}};
    EXPECT_EQ(Looked(element, side).result.total.max_penetration_between_nodes, 0);
    side.obstacle.point[element.dim - 1] = -2.999;
    EXPECT_NEAR(Looked(element, side).result.total.max_penetration_between_nodes, 1e-3, 1e-6);
  }
}

TEST(BetweenNodes, OfAFaceInSpaceThatTouchesAtOneNodeTheDeepestPlaceIsFoundBetweenQuartersOfTheFace)
{
  // A pit around (0.56, 0.5), of radius 0.065: the node (0.5, 0.5) touches. Quarters of faces are 0.125 long.
  auto side = touching("back");
  side.gap = ScalarField("pit", [](const Point &x) {
    return 0.01 * (((x[0] - 0.56) * (x[0] - 0.56) + (x[1] - 0.5) * (x[1] - 0.5)) / (0.065 * 0.065) - 1);
  });
  for (const int order : {1, 2}) {
    Looked looked({3, order}, side);
    const auto pressure = Kokkos::create_mirror_view(looked.result.pressure);
    const auto v = to_host(looked.result.penetration);
    GO touch = 0;
    for (std::size_t i = 0; i < v.extent(0); ++i) {
      pressure(i) = v(i) > 0 ? 1 : 0;
      touch += v(i) > 0 ? 1 : 0;
    }
    EXPECT_EQ(sum_all(looked.d.mesh->comm(), touch), 1);
    Kokkos::deep_copy(looked.result.pressure, pressure);
    looked.result.total = {}; // of the look without a pressure
    const auto sides = contact::contact_sides(*looked.d.mesh, looked.options);
    contact::look_between_nodes(looked.d, sides, looked.options, looked.points, steel, *looked.u, looked.result);
    // 0.01 at the centre, less what the node has; at the nearest quarter of a face 0.
    EXPECT_GT(looked.result.total.max_penetration_between_nodes, 0.008);
  }
}

/// A pit of the gap of 1/1000 of the side, as deep as `depth`, with bounds on it.
ScalarField narrow_pit(const double depth)
{
  const double b = 0.001;
  const Point at{0.7123, 0.3087, 0};
  ScalarField gap("pit", [=](const Point &x) {
    const double dx = (x[0] - at[0]) / b, dy = (x[1] - at[1]) / b;
    return std::min(1e-3, depth * (dx * dx + dy * dy - 1));
  });
  gap.bounds = [=](const Box &box, double) {
    double nearest = 0, farthest = 0;
    for (int k = 0; k < 2; ++k) {
      const double left = (box.low[k] - at[k]) / b, right = (box.high[k] - at[k]) / b;
      const double near = left > 0 ? left : right < 0 ? right : 0, far = std::max(std::abs(left), std::abs(right));
      nearest += near * near;
      farthest += far * far;
    }
    return Interval{std::min(1e-3, depth * (nearest - 1)), std::min(1e-3, depth * (farthest - 1))};
  };
  return gap;
}

TEST(BetweenNodes, APitOfTheGapOfAThousandthOfAFaceIsFoundByBounds)
{
  for (const mesh::Element element : {mesh::Element{3, 1}, mesh::Element{3, 1, mesh::Shape::simplex},
                                      mesh::Element{3, 2}, mesh::Element{3, 2, mesh::Shape::simplex}}) {
    auto side = touching("back");
    side.gap = narrow_pit(1e-4);
    const Looked looked(element, side);
    const auto &at = looked.result.between.unseen;
    EXPECT_NEAR(at.depth, 1e-4, 2e-5);
    EXPECT_NEAR(at.place[0], 0.7123, 5e-4);
    EXPECT_NEAR(at.place[1], 0.3087, 5e-4);
    EXPECT_NEAR(at.width, 0.002, 4e-4);
    side.gap.bounds = nullptr; // samples alone miss it
    EXPECT_EQ(Looked(element, side).result.total.unseen_penetration, 0);
  }
}

TEST(BetweenNodes, DisplacementAndDentsCount)
{
  // Moved down by 0.03 as a whole, over a gap of 0.05 that the bump makes 0.02 smaller: 0.02 + 0.03 - 0.05 = 0 inside; by 0.04: 0.01.
  auto side = touching("bottom");
  side.gap = ScalarField("bump", [](const Point &x) { return std::abs(x[0] - 0.7) < 0.05 ? 0.03 : 0.05; });
  Looked looked({2, 1}, side);
  for (const double down : {0.029, 0.04}) {
    const auto u = looked.u->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 1; i < u.extent(0); i += 2) u(i, 0) = -down;
    looked.look([](const Point &) { return 0; });
    EXPECT_NEAR(looked.result.total.unseen_penetration, std::max(0., down - 0.03), 1e-12);
  }
}

TEST(BetweenNodes, WhereTheGapJumpsWithinAFacetReadingItAtNodesLeavesEnergyForceAndDepthOpen)
{
  // Springs of 1/k = 0.001 m/Pa under nodes at 0, 0.5, 1, ..., in contact: pressed in by 0.01 m to the left of x = 0.7.
  const double k = 1000, p = 10, jump = 0.01, h = 0.5;
  auto side = touching("bottom");
  side.yield_stress = ScalarField(1e300);
  side.stiffness = ScalarField(k);
  side.gap = ScalarField("step", [=](const Point &x) { return x[0] < 0.7 ? -jump : 0; });
  const Looked looked({2, 1}, side, p);
  const double modulus = steel.lambda() + 2 * steel.mu();
  const double layer = h / modulus, stiffness = 1 / (layer + 1 / k), left = jump + layer * p, right = layer * p;
  // What linear interpolation between 0.5 and 1 has too much or too little: on 0.4 of the facet and on 0.6 of it.
  const double share = h * (0.4 * 0.4 + 0.6 * 0.6) / 2;
  const auto &between = looked.result.between;
  EXPECT_NEAR(between.misread_energy / (share * 0.5 * stiffness * (left * left - right * right)), 1, 5e-3);
  EXPECT_NEAR(between.misread_force / (share * stiffness * (left - right)), 1, 5e-3);
  EXPECT_NEAR(between.misread_penetration, left * stiffness / k, 1e-12);
  EXPECT_EQ(between.misread_ends, 0); // both parts bear a pressure
  side.gap = ScalarField("higher step", [=](const Point &x) { return x[0] < 0.7 ? -jump : jump; });
  EXPECT_NEAR(Looked({2, 1}, side, p).result.between.misread_ends, h / 2, 1e-12);
  // Not where nothing bears a pressure, nor where the gap is smooth or its jump lies at a node.
  EXPECT_EQ(Looked({2, 1}, side).result.between.misread_energy, 0);
  for (const auto &gap : {ScalarField("slope", [](const Point &x) { return -0.01 * x[0]; }),
                          ScalarField("parabola", [](const Point &x) { return -0.01 * (x[0] + 1) * (x[0] + 1); })}) {
    side.gap = gap;
    EXPECT_EQ(Looked({2, 1}, side, p).result.between.misread_energy, 0);
  }
}

TEST(BetweenNodes, SamplesOfFacesCountByTheTrapezoidalRule)
{
  // The same in space, with a step at x = 0.7.
  const double k = 1000, p = 10, jump = 0.01, h = 0.5;
  auto side = touching("bottom");
  side.yield_stress = ScalarField(1e300);
  side.stiffness = ScalarField(k);
  side.gap = ScalarField("step", [=](const Point &x) { return x[0] < 0.7 ? -jump : 0; });
  for (const auto shape : {mesh::Shape::tensor, mesh::Shape::simplex}) {
    const double size = shape == mesh::Shape::tensor ? h : h / std::sqrt(2.); // the root of the area
    const double stiffness = 1 / (size / (steel.lambda() + 2 * steel.mu()) + 1 / k);
    const Looked looked({3, 1, shape}, side, p);
    const double all = looked.result.between.misread_force / (h * 1 * stiffness * jump);
    EXPECT_NEAR(all, (0.4 * 0.4 + 0.6 * 0.6) / 2, 0.003);
  }
}

TEST(BetweenNodes, DepthsBesideAJumpOfTheGapCountFromTheSurfaceWithoutDents)
{
  // The same by a step before, whose dents are as deep everywhere as the body has moved since.
  const double deep = 0.02;
  auto side = touching("bottom");
  side.yield_stress = ScalarField(1e300);
  side.stiffness = ScalarField(1000.);
  side.gap = ScalarField("step", [](const Point &x) { return x[0] < 0.7 ? -0.01 : 0; });
  Looked looked({2, 1}, side, 10);
  const auto alone = looked.result.between;
  const auto u = looked.u->getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t i = 1; i < u.extent(0); i += 2) u(i, 0) = -deep;
  Kokkos::deep_copy(looked.points.dent, deep);
  looked.look([](const Point &) { return 10; });
  EXPECT_NEAR(looked.result.between.misread_energy / alone.misread_energy, 1, 1e-9);
  EXPECT_NEAR(looked.result.between.misread_penetration, deep + alone.misread_penetration, 1e-12);
}

TEST(BetweenNodes, WhereContactEndsAtAJumpWithinAFacetTheBodyMayBePressedInDeeper)
{
  // Pressed in by 0.01 m with 10 Pa to the left of x = 0.7, nothing to the right: half a facet more or less of these 10 Pa moves the surface.
  const double k = 1000, p = 10, h = 0.5;
  auto side = touching("bottom");
  side.yield_stress = ScalarField(1e300);
  side.stiffness = ScalarField(k);
  side.gap = ScalarField("step", [=](const Point &x) { return x[0] < 0.7 ? -p / k : 1; });
  Looked looked({2, 1}, side);
  looked.look([=](const Point &x) { return x[0] < 0.7 ? p : 0; });
  const double of_surface = 2000 / (1 - 0.3 * 0.3), moved = 2 * p * (h / 2) / (std::acos(-1) * of_surface);
  EXPECT_NEAR(looked.result.between.misread_penetration, p / k + moved * (1 + std::log(std::sqrt(5.) / (h / 2))), 1e-9);
}

TEST(BetweenNodes, SpringsUnderAFacetThatMissesThemMayBePressedIn)
{
  const double k = 1000, depth = 0.02, h = 0.5, layer = h / (steel.lambda() + 2 * steel.mu());
  auto side = bump(depth, 0.1);
  side.yield_stress = ScalarField(1e300);
  side.stiffness = ScalarField(k);
  const double pressed_in = depth * (1 / k) / (1 / k + layer);
  EXPECT_NEAR(Looked({2, 1}, side).result.between.misread_penetration, pressed_in, 1e-5);
}

TEST(BetweenNodes, TheNoteNamesPlaceDepthAndTheSizeThatWouldSee)
{
  const Looked looked({2, 1}, bump(0.02, 0.1));
  for (const std::string part :
       {"side \"bottom\" lies 0.02 [m] inside the foundation", "at (0.7", "0.5 [m] long", "cells of 0.1"})
    EXPECT_NE(looked.note(0).find(part), std::string::npos) << looked.note(0);
  EXPECT_NE(looked.note(0).find("or give \"Adapt->Target Relative Error\""), std::string::npos);
  EXPECT_NE(looked.note(0, true).find("or lower \"Adapt->Target Relative Error\""), std::string::npos);
  const double squared = 2 * looked.result.total.unseen_energy;
  EXPECT_NE(looked.note(399 * squared), "");
  EXPECT_EQ(looked.note(401 * squared), ""); // below a twentieth of the solution in the energy norm
}

} // namespace
} // namespace between_nodes_test
