#include "rpc/fem/stress.hpp"

#include "bodies.hpp"

#include <limits>

namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr fem::Material steel{2000, 0.3};

/// Stresses of all nodes by node id, a row per node.
std::vector<double> stresses(const fem::Discretization &d, const Vector &u)
{
  const auto stress = fem::nodal_stresses(d, steel, u);
  const auto values = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
  EXPECT_EQ(values.extent(1), fem::stress_names(d.dim()).size());
  return by_node_id(*d.mesh, static_cast<int>(values.extent(1)), [&](const LO n, const int k) { return values(n, k); });
}

/// sigma = E/(1+nu) (strain + nu/(1-2nu) trace I); in 2D the strain across the plane is 0.
std::vector<double> hookes_law(const int dim)
{
  const double nu = steel.poissons_ratio;
  double strain[3][3] = {}, s[3][3], trace = 0, square = 0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) strain[i][j] = 0.5 * (slope[i][j] + slope[j][i]);
  for (int i = 0; i < 3; ++i) trace += strain[i][i];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      s[i][j] = steel.youngs_modulus / (1 + nu) * (strain[i][j] + (i == j ? nu / (1 - 2 * nu) * trace : 0));
  const double mean = (s[0][0] + s[1][1] + s[2][2]) / 3; // von Mises by the deviator, sqrt(3/2 dev : dev)
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) square += 1.5 * std::pow(s[i][j] - (i == j ? mean : 0), 2);
  if (dim == 2) return {s[0][0], s[1][1], s[0][1], std::sqrt(square)};
  return {s[0][0], s[1][1], s[2][2], s[0][1], s[1][2], s[0][2], std::sqrt(square)};
}

TEST(NodalStresses, LinearDisplacementGivesHookesStressAtEveryNode)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto all = stresses(d, *interpolate(d, [&](const Point &x) { return linear(x, element.dim); }));
    const auto row = hookes_law(element.dim);
    std::vector<double> expected;
    while (expected.size() < all.size()) expected.insert(expected.end(), row.begin(), row.end());
    EXPECT_LT(difference(all, expected), 1e-13);
  }
}

TEST(NodalStresses, RigidMotionGivesNone)
{
  const auto d = bulged_body({2, 2}, world());
  const auto all = stresses(d, *interpolate(d, [](const Point &x) {
                              return Point{1 - 0.1 * x[1], 2 + 0.1 * x[0], 0};
                            }));
  EXPECT_LT(difference(all, std::vector<double>(all.size(), 0)), 1e-13 * steel.youngs_modulus);
}

TEST(NodalStresses, AreTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto all = bulged_body(element, world()), one = bulged_body(element, alone());
    EXPECT_LT(difference(stresses(all, *interpolate(all, wild)), stresses(one, *interpolate(one, wild))), 1e-13);
  }
}

TEST(NodalStresses, AreTheMeanOfTheCellsByVolume)
{
  // Two Q1 cells with lengths 1 and 3, u_x = 0, 1, 1: strain_xx is 1, then 0. The node between sees int N over each.
  const auto d = body({{0, 0}, {2, 1}, {2, 1}, {2, 1}}, alone(), [](const Point &x) {
    return Point{x[0] > 1.5 ? 4 : x[0], x[1], 0};
  });
  const auto all = stresses(d, *interpolate(d, [](const Point &x) { return Point{std::min(x[0], 1.), 0, 0}; }));
  const double stretched = steel.lambda() + 2 * steel.mu();
  for (const int row : {0, 1}) {
    EXPECT_NEAR(all[4 * (3 * row)], stretched, 1e-13 * stretched);
    EXPECT_NEAR(all[4 * (3 * row + 1)], stretched / 4, 1e-13 * stretched);
    EXPECT_NEAR(all[4 * (3 * row + 2)], 0, 1e-13 * stretched);
  }
}

TEST(StressNames, AreOnePerColumnVonMisesLast)
{
  EXPECT_EQ(fem::stress_names(2), (std::vector<std::string>{"stress_xx", "stress_yy", "stress_xy", "von_mises"}));
  EXPECT_EQ(fem::stress_names(3), (std::vector<std::string>{"stress_xx", "stress_yy", "stress_zz", "stress_xy",
                                                            "stress_yz", "stress_xz", "von_mises"}));
}

} // namespace
