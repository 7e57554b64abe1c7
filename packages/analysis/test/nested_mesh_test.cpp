// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/nested_mesh.hpp"

#include "ancestor.hpp"
#include "rpc/analysis/solver_state.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/mesh/box.hpp"
#include "rpc/mesh/refinement.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <utility>

namespace nested_mesh_test
{
namespace
{

using namespace rpc;
using analysis::NestedMesh;
using analysis::Problem;

/// With odd numbers of cells on the way to coarser boxes; triangles and tetrahedra are nested in even ones alone.
std::shared_ptr<const mesh::Mesh> box_of(const mesh::Element &element, const bool odd = true)
{
  const bool plane = element.dim == 2;
  const int n = element.order == 1 ? 2 : 1, less = odd ? 1 : 0;
  const mesh::BoxOptions box =
      plane ? mesh::BoxOptions{{0, 0}, {2, 1}, {(40 - less) * n, (20 - less) * n}, element}
            : mesh::BoxOptions{{0, 0, 0}, {2, 1, 1}, {(16 - less) * n, (8 - less) * n, 8 * n}, element};
  return std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
}

/// A block held at its top that may touch with its bottom.
Problem problem_on(const mesh::Element &element, std::shared_ptr<const mesh::Mesh> mesh = nullptr)
{
  analysis::Model model;
  fem::DirichletCondition held{"held", element.dim == 2 ? "top" : "front", {ScalarField(0.), ScalarField(-0.01)}};
  if (element.dim == 3) held.displacement = {ScalarField(0.), ScalarField(0.), ScalarField(-0.01)};
  model.materials = fem::Material{1000, 0.3};
  model.dirichlet = {held};
  contact::ContactOptions foundation;
  foundation.side = element.dim == 2 ? "bottom" : "back";
  foundation.yield_stress = ScalarField(1.);
  foundation.gap = ScalarField(0.);
  model.contact = {foundation};
  return Problem(mesh ? std::move(mesh) : box_of(element), model);
}

std::size_t num_nodes(const fem::Discretization &d)
{
  return d.mesh->owned_nodes->getGlobalNumElements();
}

TEST(NestedMesh, KeepsWhatItHasMadeUntilToldToForget)
{
  const NestedMesh finest(fem::discretize(box_of({2, 1})));
  EXPECT_TRUE(finest.is_finest());
  EXPECT_TRUE(finest.may_have_coarser());
  EXPECT_EQ(finest.made_coarser(), nullptr);
  const auto coarser = finest.coarser();
  ASSERT_NE(coarser, nullptr);
  EXPECT_FALSE(coarser->is_finest());
  EXPECT_EQ(num_nodes(coarser->discretization()), 40U * 20U);
  EXPECT_EQ(finest.coarser(), coarser);
  EXPECT_EQ(finest.made_coarser(), coarser);
  finest.forget_coarser();
  EXPECT_EQ(finest.made_coarser(), nullptr);
  EXPECT_NE(finest.coarser(), coarser);
}

/// Step by step as by a search.
TEST(NestedMesh, InterpolatesStepByStep)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const NestedMesh finest(fem::discretize(box_of(element, element.shape == mesh::Shape::tensor)));
    const auto coarse = finest.coarser()->coarser();
    ASSERT_NE(coarse, nullptr);
    const auto steps = analysis::interpolation(*coarse, finest);
    const auto search = fem::interpolation(coarse->discretization(), finest.discretization());
    MultiVector values(steps->getDomainMap(), 2), by_steps(steps->getRangeMap(), 2), by_search(steps->getRangeMap(), 2);
    const auto id = coarse->discretization().mesh->node_id;
    for (LO n = 0; n < num_local(*steps->getDomainMap()); ++n)
      for (int k = 0; k < 2; ++k) values.replaceLocalValue(n, k, std::sin(k + 0.7 * static_cast<double>(id(n))));
    steps->apply(values, by_steps);
    search->apply(values, by_search);
    by_search.update(-1., by_steps, 1.);
    for (int k = 0; k < 2; ++k) EXPECT_LT(by_search.getVector(k)->normInf(), 1e-12) << element.name();
    EXPECT_GT(by_steps.getVector(0)->normInf(), 0.5);
  }
}

/// Nested iteration's coarse mesh is one of those that multigrid uses, with a quarter as many nodes in each direction.
TEST(NestedMesh, ServesAProblemOnACoarserMesh)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const Problem problem = problem_on(element);
    const auto coarser = problem.coarser(4, 1);
    ASSERT_EQ(coarser != nullptr, element.order == 1) << element.name();
    if (!coarser) continue;
    const auto first = problem.mesh().made_coarser();
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(&coarser->mesh(), first->made_coarser().get()) << element.name();
    const double ratio = static_cast<double>(num_nodes(problem.discretization())) /
                         static_cast<double>(num_nodes(coarser->discretization()));
    EXPECT_GT(ratio, 0.5 * std::pow(4, element.dim)) << element.name();
    EXPECT_LT(ratio, 1.5 * std::pow(4, element.dim)) << element.name();
    EXPECT_GT(coarser->step(1).contact.num_total, 0);
  }
}

/// Across a beam there are soon no cells to halve: its length counts, not the number of nodes.
TEST(NestedMesh, KeepsCellsAlongASlenderBody)
{
  for (const mesh::Shape shape : {mesh::Shape::simplex, mesh::Shape::tensor}) {
    const mesh::Element element{3, 1, shape};
    const mesh::BoxOptions beam{{0, 0, 0}, {32, 2, 1}, {64, 4, 2}, element};
    const Problem problem =
        problem_on(element, std::make_shared<mesh::Mesh>(mesh::make_box(beam, Tpetra::getDefaultComm())));
    const auto coarser = problem.coarser(4, 1);
    ASSERT_NE(coarser, nullptr);
    EXPECT_EQ(coarser->discretization().mesh->box->cells[0], 16);
  }
}

/// Multigrid of the finest mesh lets the coarser ones go; that of a coarser one leaves them to the finer.
TEST(NestedMesh, IsForgottenByTheFinestMultigridOnly)
{
  const Problem problem = problem_on({2, 1});
  const auto coarser = problem.coarser(2, 1);
  ASSERT_NE(coarser, nullptr);
  const auto solve = [](const Problem &on) {
    Vector b(on.discretization().owned_dofs), x(on.discretization().owned_dofs);
    b.putScalar(1);
    solver::LinearSolverOptions options;
    options.multigrid = "mesh"; // a GPU would take a band factor of so few unknowns
    analysis::SolverState state(on, options);
    state.linear().solve(b, x, 1e-2);
    return state.linear().counts().fallback;
  };
  EXPECT_EQ(solve(*coarser), "");
  EXPECT_NE(coarser->mesh().made_coarser(), nullptr);
  EXPECT_NE(problem.mesh().made_coarser(), nullptr);
  EXPECT_EQ(solve(problem), "");
  EXPECT_EQ(problem.mesh().made_coarser(), nullptr);
}

/// A body that knows nothing of its box, refined.
std::shared_ptr<const mesh::Mesh> refined_body(const mesh::Element &element, const int times)
{
  const mesh::BoxOptions box = element.dim == 2 ? mesh::BoxOptions{{0, 0}, {2, 1}, {4, 3}, element}
                                                : mesh::BoxOptions{{0, 0, 0}, {2, 1, 1}, {3, 2, 2}, element};
  auto coarse = mesh::make_box(box, Tpetra::getDefaultComm());
  coarse.box = nullptr;
  auto mesh = std::make_shared<const mesh::Mesh>(std::move(coarse));
  for (int k = 0; k < times; ++k) mesh = std::make_shared<mesh::Mesh>(mesh::refined(mesh));
  return mesh;
}

/// Of order 2 first the vertices of the same cells, then the vertices of the parents.
TEST(NestedMesh, LeadsToTheParentsOfARefinedMesh)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto mesh = refined_body(element, 2);
    const NestedMesh finest(fem::discretize(mesh));
    EXPECT_TRUE(finest.may_have_coarser());
    std::vector<std::size_t> sizes;
    for (auto coarse = finest.coarser(); coarse; coarse = coarse->coarser()) {
      const auto &d = coarse->discretization();
      EXPECT_EQ(d.mesh->element.order, 1);
      EXPECT_EQ(coarse->to_finer()->getDomainMap()->getGlobalNumElements(), num_nodes(d));
      EXPECT_EQ(d.mesh->sides.size(), mesh->sides.size());
      sizes.push_back(num_nodes(d));
    }
    // Nodes of order 2 are the vertices of a refinement.
    std::vector<std::size_t> expected;
    const mesh::Element linear{element.dim, 1, element.shape};
    for (int times = element.order == 2 ? 2 : 1; times >= 0; --times)
      expected.push_back(refined_body(linear, times)->owned_nodes->getGlobalNumElements());
    EXPECT_EQ(sizes, expected) << element.name();
  }
}

TEST(NestedMesh, SharesParentsBetweenPredictionAndMultigrid)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const NestedMesh finest(fem::discretize(refined_body(element, 2)));
    EXPECT_EQ(finest.made_parent(), nullptr);
    const auto parent = finest.parent(), first = parent->parent();
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(first->parent(), nullptr);
    EXPECT_EQ(parent->discretization().mesh->element.order, element.order);
    const auto steps = analysis::interpolation(*first, finest);
    const auto search = fem::interpolation(first->discretization(), finest.discretization());
    Vector values(steps->getDomainMap()), by_steps(steps->getRangeMap()), by_search(steps->getRangeMap());
    const auto id = first->discretization().mesh->node_id;
    for (LO n = 0; n < num_local(*steps->getDomainMap()); ++n)
      values.replaceLocalValue(n, std::sin(0.7 * static_cast<double>(id(n))));
    steps->apply(values, by_steps);
    search->apply(values, by_search);
    by_search.update(-1., by_steps, 1.);
    EXPECT_LT(by_search.normInf(), 1e-12) << element.name();
    if (element.order == 1) {
      EXPECT_EQ(finest.coarser(), parent);
    } else {
      const auto low = finest.coarser()->coarser();
      EXPECT_EQ(low->discretization().mesh, parent->coarser()->discretization().mesh) << element.name();
    }
    finest.forget_coarser();
    EXPECT_EQ(finest.made_parent(), nullptr);
  }
}

/// CG's iterations do not grow with the number of refinements.
TEST(NestedMesh, MakesMultigridOfRefinedMeshesFast)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    std::vector<int> iterations;
    const int most = element.dim == 2 ? 4 : element.order == 1 ? 3 : 2;
    for (int times = 1; times <= most; ++times) {
      const Problem problem = problem_on(element, refined_body(element, times));
      Vector b(problem.discretization().owned_dofs), x(problem.discretization().owned_dofs);
      b.putScalar(1);
      solver::LinearSolverOptions options;
      options.multigrid = "mesh";
      analysis::SolverState state(problem, options);
      state.linear().solve(b, x, 1e-8);
      EXPECT_EQ(state.linear().counts().fallback, "");
      iterations.push_back(state.linear().counts().iterations.back());
    }
    EXPECT_LE(iterations.back(), 20) << element.name() << " in " << element.dim << "D";
    EXPECT_LE(iterations.back(), iterations[most - 2] + 3) << element.name() << " in " << element.dim << "D";
  }
}

/// Nested iteration's mesh is of the same order, and has cells at least four times as long if there are such parents, in space twice.
TEST(NestedMesh, ServesAProblemOnAParent)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto mesh = refined_body(element, 3);
    const Problem problem = problem_on(element, mesh);
    const auto coarser = problem.coarser(4, 1);
    ASSERT_NE(coarser, nullptr);
    EXPECT_EQ(coarser->discretization().mesh, test::ancestor(mesh, element.dim == 2 ? 2 : 1));
    const auto coarsest = problem.coarser(100, 1);
    ASSERT_NE(coarsest, nullptr);
    EXPECT_EQ(coarsest->discretization().mesh, test::ancestor(mesh, 3));
    EXPECT_EQ(coarsest->coarser(4, 1), nullptr);
  }
}

/// A mesh that is no box, and was not refined, has none that could predict.
TEST(NestedMesh, LeavesOtherMeshesAlone)
{
  for (const int order : {1, 2}) {
    auto mesh = std::make_shared<mesh::Mesh>(*box_of({2, order}));
    mesh->box = nullptr;
    const NestedMesh finest(fem::discretize(mesh));
    EXPECT_EQ(finest.may_have_coarser(), order == 2);
    const auto coarser = finest.coarser();
    EXPECT_EQ(coarser != nullptr, order == 2);
    if (coarser) {
      EXPECT_EQ(coarser->coarser(), nullptr);
    }
  }
}

} // namespace
} // namespace nested_mesh_test
