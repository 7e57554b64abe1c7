// SPDX-License-Identifier: BSD-3-Clause
#include "clamped_block.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

/// Nearly incompressible bodies with pressures as unknowns of their own.                       doc/theory.md (4.13) to (4.15)
namespace mixed_form_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::Kinematics;

constexpr mesh::Shape simplex = mesh::Shape::simplex;
constexpr mesh::Element plane_q1{2, 1}, plane_q2{2, 2}, plane_p2{2, 2, simplex}, q1{3, 1}, q2{3, 2}, p2{3, 2, simplex};

std::vector<int> cells_of(const mesh::Element &element)
{
  return element.dim == 2 ? std::vector<int>{35, 17, 0} : std::vector<int>{11, 5, 7};
}

bool is_split(const Block &block)
{
  return static_cast<bool>(
      analysis::mixed_form(std::make_shared<analysis::NestedMesh>(block.d), block.model, block.dirichlet.fixed));
}

/// Iterations to 1e-8 for an unordered right side, nothing and every other stretch of the contact side closed. What is found is the solution
/// of H x = b, by the energy of its error: the residual's norm is that of rounding.
void expect_few(const Block &block, const int most)
{
  const auto solver = block.solver(true), other = block.solver(block.d.mesh->element.order == 1); // CG stalls for Q1
  const Vector b = block.vector(3);
  Vector x(b.getMap()), r(b.getMap()), error(b.getMap());
  for (const bool closed : {false, true}) {
    if (closed) block.close_half();
    const auto result = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LE(result.iterations, most) << (closed ? "closed" : "elastic");
    block.H->apply(x, r);
    r.update(1., b, -1.);
    EXPECT_TRUE(other->solve(r, error, 1e-2).converged);
    EXPECT_LT(std::sqrt(r.dot(error) / b.dot(x)), 1e-5);
  }
  // The energy of a force, F . H^-1 F, by the cycle that stands for H^-1: positive, and of the right size.                (4.16)
  const double exact = b.dot(x), by_cycle = solver->inverse_energy(b);
  EXPECT_GT(by_cycle, 0.1 * exact);
  EXPECT_LT(by_cycle, 2 * exact);
  EXPECT_EQ(solver->counts().path, std::vector<std::string>{"mixed"});
  EXPECT_EQ(solver->counts().preconditioner_setups, 1);
}

TEST(MixedForm, TakesFewIterationsUpToOneHalf)
{
  struct Body {
    mesh::Element element;
    Kinematics kinematics;
    int most;
  };
  for (const auto &[element, kinematics, most] : std::vector<Body>{{plane_q1, Kinematics::plane_strain, 17},
                                                                   {plane_q1, Kinematics::axisymmetric, 17},
                                                                   {q1, Kinematics::plane_strain, 20},
                                                                   {plane_q2, Kinematics::plane_strain, 17},
                                                                   {plane_q2, Kinematics::axisymmetric, 17},
                                                                   {plane_p2, Kinematics::plane_strain, 19},
                                                                   {q2, Kinematics::plane_strain, 19},
                                                                   {p2, Kinematics::plane_strain, 32}})
    for (const double nu : {0.49, 0.499, 0.49999}) {
      SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D, nu " + std::to_string(nu));
      expect_few(Block(element, cells_of(element), true, {2, 1, 1}, nu, kinematics), most);
    }
}

/// No coarser boxes: an algebraic hierarchy of the soft body follows that of order 1.
TEST(MixedForm, TakesBodiesFromFiles)
{
  for (const mesh::Element &element : {plane_q1, q1, plane_p2, p2}) {
    SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D");
    expect_few(Block(element, cells_of(element), false, {2, 1, 1}, 0.4999), element.dim == 2 ? 16 : 26);
  }
}

TEST(MixedForm, TakesStretchedCells)
{
  for (const mesh::Element &element : {plane_q1, q1, plane_q2, plane_p2, q2, p2})
    for (const double ratio : {4., 16.}) {
      SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D, stretched by " + std::to_string(ratio));
      const std::vector<double> upper = {1, 1, 1 / ratio}, upper_in_plane = {ratio, 1, 1};
      const std::vector<int> cells = element.dim == 2 ? std::vector<int>{15, 16, 0} : std::vector<int>{5, 5, 4};
      const int most = element == p2 && ratio > 4 ? 60 : 32;
      expect_few(Block(element, cells, true, element.dim == 2 ? upper_in_plane : upper, 0.499), most);
    }
}

/// The cycle that stands for H^-1 is symmetric and positive, also for forces that are all in the pressures.                   (4.16)
TEST(MixedForm, HasAPositiveCycleForEnergies)
{
  for (const mesh::Element &element : {plane_q1, q1, plane_q2, plane_p2, q2, p2})
    for (const double nu : {0.49, 0.49999}) {
      SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D, nu " + std::to_string(nu));
      const Block block(element, cells_of(element), true, {2, 1, 1}, nu);
      const auto solver = block.solver(true);
      const Vector b = block.vector(1);
      Vector volume(b.getMap());
      block.H->apply(b, volume); // almost all of it is the dilatation's
      EXPECT_GT(solver->inverse_energy(b), 0);
      EXPECT_GT(solver->inverse_energy(volume), 0);
    }
}

/// What takes less time otherwise stays whole.
TEST(MixedForm, IsThatOfNearlyIncompressibleBodiesThatDoNotLock)
{
  const auto block = [](const mesh::Element &element, const double nu,
                        const Kinematics kinematics = Kinematics::plane_strain) {
    return Block(element, cells_of(element), true, {2, 1, 1}, nu, kinematics);
  };
  EXPECT_TRUE(is_split(block(q2, 0.49)));
  EXPECT_TRUE(is_split(block(plane_p2, 0.49)));
  EXPECT_FALSE(is_split(block(q2, 0.47)));
  EXPECT_TRUE(is_split(block(q1, 0.49)));
  EXPECT_FALSE(is_split(block(q1, 0.479)));
  EXPECT_FALSE(is_split(block({3, 1, simplex}, 0.49))) << "most of its pressures move nothing";
  EXPECT_FALSE(is_split(block(plane_q2, 0.49, Kinematics::plane_stress)));

  Block whole = block(plane_p2, 0.49);
  whole.model.materials.common.dilatation = fem::Dilatation::full;
  EXPECT_FALSE(is_split(whole)) << "its dilatation is not one of few modes in a cell";

  Block two = block(plane_p2, 0.49); // one that can be split, and one that stays stiff
  two.model.materials.block["other"] = {1000, 0.4999, fem::Dilatation::full};
  const auto mesh = std::make_shared<mesh::Mesh>(*two.d.mesh);
  mesh->blocks.push_back("other");
  two.d = fem::discretize(mesh);
  EXPECT_FALSE(is_split(two));

  Block alone = block(plane_q2, 0.49), stretched({2, 2}, {35, 17}, true, {20, 1, 1}, 0.49);
  for (Block *const untouched : {&alone, &stretched}) untouched->model.contact.clear();
  EXPECT_TRUE(is_split(alone));
  EXPECT_TRUE(is_split(stretched));
}

/// An active set that leaves the body unheld: the mixed form rests in that solve alone, and is no candidate that was left.
TEST(MixedForm, IsUsedAgainAfterAMatrixThatIsSingular)
{
  const Block block(plane_q1, cells_of(plane_q1), true, {2, 1, 1}, 0.4999);
  const auto solver = block.solver(true);
  const Vector b = block.vector(3);
  Vector x(b.getMap());
  block.close_half();
  EXPECT_TRUE(solver->solve(b, x, 1e-8).converged);
  block.close([](double) { return true; }, -1e5);
  EXPECT_TRUE(solver->solve(b, x, 1e-8).broken);
  const auto row = [&](const std::string &name) {
    const auto &rows = solver->counts().candidates;
    return *std::find_if(rows.begin(), rows.end(), [&](const auto &candidate) { return candidate.name == name; });
  };
  EXPECT_NE(row("mixed").left, "");
  block.close_half();
  EXPECT_TRUE(solver->solve(b, x, 1e-8).converged);
  EXPECT_EQ(row("mixed").left, "");
  EXPECT_GE(row("mixed").solves, 2);
  EXPECT_EQ(solver->counts().description.rfind("mixed", 0), 0U) << solver->counts().description;
}

} // namespace
} // namespace mixed_form_test
