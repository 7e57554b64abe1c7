// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/peaks.hpp"

#include "bodies.hpp"
#include "rpc/fem/stress.hpp"

namespace peaks_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::Kinematics;

constexpr fem::Material steel{2000, 0.3};

/// Of u_i = sum over j of g[i][j] x_j on a bulged box, in the plane away from the axis.
fem::BodyPeaks peaks_of(const mesh::Element &element, const std::array<Point, 3> &g,
                        const Kinematics kinematics = Kinematics::plane_strain, const fem::Materials &materials = steel)
{
  auto box = small_box(element);
  if (kinematics == Kinematics::axisymmetric) {
    box.lower[0] += 2;
    box.upper[0] += 2;
  }
  const auto d = body(box, world(), bulge(box), kinematics);
  const auto u = interpolate(d, [&](const Point &x) {
    Point value{};
    for (int i = 0; i < element.dim; ++i)
      for (int j = 0; j < element.dim; ++j) value[i] += g[i][j] * x[j];
    return value;
  });
  return fem::body_peaks(d, materials, *u);
}

void expect_near(const fem::BodyPeaks &peaks, const double strain, const double von_mises)
{
  EXPECT_NEAR(peaks.strain, strain, 1e-7 * strain); // double eigenvalues: the root of the rounding
  EXPECT_NEAR(peaks.von_mises, von_mises, 1e-11 * von_mises);
}

TEST(BodyPeaks, OfUniformStrainAreThoseOfHandAlgebra)
{
  const double mu = steel.mu();
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    // One direction alone: (lambda + 2 mu, lambda, lambda) e, in tension and compression.
    expect_near(peaks_of(element, {{{0.01, 0, 0}, {0, 0, 0}, {0, 0, 0}}}), 0.01, 2 * mu * 0.01);
    expect_near(peaks_of(element, {{{0, 0, 0}, {0, -0.01, 0}, {0, 0, 0}}}), 0.01, 2 * mu * 0.01);
    // Shear: strains +-e/2, stress sqrt(3) mu e.
    expect_near(peaks_of(element, {{{0, 0.01, 0}, {0, 0, 0}, {0, 0, 0}}}), 0.005, std::sqrt(3.) * mu * 0.01);
    // In the plane 3 e and 2 e, turned by 45 degrees, and none across: the deviator is (4/3, 1/3, -5/3) e.
    expect_near(peaks_of(element, {{{0.025, 0.005, 0}, {0.005, 0.025, 0}, {0, 0, 0}}}), 0.03,
                2 * mu * 0.01 * std::sqrt(7.));
  }
}

TEST(BodyPeaks, InSpaceTakeTheLargestOfThreePrincipalStrains)
{
  // The symmetric part has the eigenvalues 4, 1, 1 (of [[2,1,1],[1,2,1],[1,1,2]]) times e, its negative -4, -1, -1.
  for (const auto &element : elements()) {
    if (element.dim == 2) continue;
    SCOPED_TRACE(text_of(element));
    for (const double e : {0.01, -0.01}) {
      const Point row[] = {{2 * e, e, e}, {e, 2 * e, e}, {e, e, 2 * e}};
      expect_near(peaks_of(element, {row[0], row[1], row[2]}), 0.04, 2 * steel.mu() * 3 * 0.01); // deviator (2, -1, -1)
    }
    // Eigenvalues 3, 2, -5.
    expect_near(peaks_of(element, {{{3e-2, 0, 0}, {0, 2e-2, 0}, {0, 0, -5e-2}}}), 0.05,
                2 * steel.mu() * 1e-2 * std::sqrt(1.5 * 38));
    // The same in all directions: no von Mises stress.
    const auto swollen = peaks_of(element, {{{1e-2, 0, 0}, {0, 1e-2, 0}, {0, 0, 1e-2}}});
    EXPECT_NEAR(swollen.strain, 0.01, 1e-10);
    EXPECT_LT(swollen.von_mises, 1e-8 * steel.mu());
  }
}

TEST(BodyPeaks, InPlaneStressCountTheStrainAcrossThePlane)
{
  const double e = 0.01, nu = steel.poissons_ratio, E = steel.youngs_modulus;
  const fem::Material soft{E, 0.45};
  for (const auto &element : elements()) {
    if (element.dim == 3) continue;
    SCOPED_TRACE(text_of(element));
    // Equal strains e: stress E e/(1 - nu) in both directions, strain -2 nu/(1 - nu) e across.
    const std::array<Point, 3> both = {{{e, 0, 0}, {0, e, 0}, {0, 0, 0}}};
    expect_near(peaks_of(element, both, Kinematics::plane_stress), e, E * e / (1 - nu));
    expect_near(peaks_of(element, both, Kinematics::plane_stress, soft), 2 * 0.45 / 0.55 * e, E * e / 0.55);
    // Drawn in x, free across: stress E e.
    expect_near(peaks_of(element, {{{e, 0, 0}, {0, -nu * e, 0}, {0, 0, 0}}}, Kinematics::plane_stress), e, E * e);
  }
}

TEST(BodyPeaks, InAxisymmetryCountTheHoopStrain)
{
  const double e = 0.01;
  for (const auto &element : elements()) {
    if (element.dim == 3) continue;
    SCOPED_TRACE(text_of(element));
    // u_r = e r: hoop and radial strain e, none along the axis.
    expect_near(peaks_of(element, {{{e, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, Kinematics::axisymmetric), e,
                2 * steel.mu() * e);
    // Drawn out along the axis: (-nu, 1, -nu) e, stress E e.
    const double across = -steel.poissons_ratio * e;
    expect_near(peaks_of(element, {{{across, 0, 0}, {0, e, 0}, {0, 0, 0}}}, Kinematics::axisymmetric), e,
                steel.youngs_modulus * e);
  }
}

TEST(BodyPeaks, DisplacementIsTheLongestOfAllNodes)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    const auto u = interpolate(d, [&](const Point &x) { return Point{x[0] - 10, 0.5 * x[1], x[2]}; });
    const double z = element.dim == 3 ? box.upper[2] : 0;
    const double most = std::hypot(box.lower[0] - 10, 0.5 * box.upper[1], z);
    EXPECT_NEAR(fem::body_peaks(d, steel, *u).displacement, most, 1e-14 * most);
  }
}

TEST(BodyPeaks, OfATranslationAreItsLengthAndNothingElse)
{
  for (const auto &element : elements()) {
    const auto d = bulged_body(element, world());
    const auto peaks = fem::body_peaks(d, steel, *interpolate(d, [](const Point &) { return Point{3, 4, 0}; }));
    EXPECT_NEAR(peaks.displacement, 5, 1e-14);
    EXPECT_EQ(peaks.strain, 0);
    EXPECT_EQ(peaks.von_mises, 0);
  }
}

TEST(BodyPeaks, EachBlockHasItsMaterial)
{
  fem::Materials materials{fem::Material{50, 0.3}};
  materials.block["body"] = steel;
  const auto peaks = peaks_of({2, 1}, {{{0.01, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, Kinematics::plane_strain, materials);
  expect_near(peaks, 0.01, 2 * steel.mu() * 0.01);
}

TEST(BodyPeaks, AreTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto all = bulged_body(element, world()), one = bulged_body(element, alone());
    const auto a = fem::body_peaks(all, steel, *interpolate(all, wild));
    const auto b = fem::body_peaks(one, steel, *interpolate(one, wild));
    EXPECT_NEAR(a.displacement, b.displacement, 1e-13 * b.displacement);
    EXPECT_NEAR(a.strain, b.strain, 1e-8 * b.strain);
    EXPECT_NEAR(a.von_mises, b.von_mises, 1e-12 * b.von_mises);
  }
}

TEST(BodyPeaks, NearTheStressesThatAreRecovered)
{
  // On a smooth field both tend to the same largest stress.
  mesh::BoxOptions box{{0, 0}, {1, 1}, {48, 48}, {2, 2}};
  const auto d = body(box, world());
  const auto u = interpolate(d, [](const Point &x) { return Point{std::sin(2 * x[0] + x[1]), x[0] * x[1], 0}; });
  const auto stress = fem::RecoveredStress(d, steel, *u).at_nodes();
  const double recovered = stress->getVector(stress->getNumVectors() - 1)->normInf();
  EXPECT_NEAR(fem::body_peaks(d, steel, *u).von_mises, recovered, 0.01 * recovered);
}

} // namespace
} // namespace peaks_test
