#include "rpc/solver/mesh_multigrid.hpp"

#include "rpc/algebra/along_points.hpp"
#include "rpc/analysis/mesh_levels.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/box.hpp"
#include "rpc/solver/linear_solver.hpp"
#include "updated.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace
{

using namespace rpc;
using solver::LinearSolver;
using solver::LinearSolverOptions;
using solver::MeshLevels;
using solver::MeshMultigrid;

/// A block with odd numbers of cells, clamped at its left side, that may touch with its bottom (in space: its back).
struct Block {
  fem::Discretization d;
  analysis::Model model;
  fem::DirichletDofs dirichlet;
  contact::ContactNodes points;
  RCP<UpdatedOperator> H;

  /// @param cells   of the lattice, for each direction
  /// @param is_box  whether there are coarser boxes; else the mesh counts as one from a file
  Block(const mesh::Element &element, const std::vector<int> &cells, const bool is_box = true,
        const std::vector<double> &upper = {2, 1, 1})
  {
    mesh::BoxOptions box{{0, 0}, {upper[0], upper[1]}, {cells[0], cells[1]}, element};
    if (element.dim == 3) box = {{0, 0, 0}, upper, cells, element};
    auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
    if (!is_box) mesh->box = nullptr;
    d = fem::discretize(mesh);
    fem::DirichletCondition held{"left", "left", {ScalarField(0.), ScalarField(0.)}};
    if (element.dim == 3) held.displacement[2] = ScalarField(0.);
    model.materials = fem::Material{1000, 0.3};
    model.dirichlet = {held};
    contact::ContactOptions foundation;
    foundation.side = element.dim == 2 ? "bottom" : "back";
    foundation.normal = contact::Normal::fixed; // aslant: no unknown is stiffened by itself
    foundation.direction = element.dim == 2 ? Point{0.6, -0.8, 0} : Point{0.48, 0.36, -0.8};
    foundation.yield_stress = ScalarField(1.);
    foundation.gap = ScalarField(0.);
    model.contact = {foundation};
    dirichlet = fem::dirichlet_dofs(d, model.dirichlet);
    auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, model.materials), dirichlet).matrix;
    points = contact::contact_nodes(d, model.contact, dirichlet, model.materials);
    H = test::updated(K, points);
  }
  MeshLevels levels() const
  {
    analysis::NestedMesh finest(d);
    return analysis::mesh_levels(finest, model, dirichlet.fixed);
  }

  /// Contact nodes for which `is_closed` holds at their x are closed: 1e5 times as stiff as they are.
  void close(const std::function<bool(double)> &is_closed) const
  {
    const auto node = to_host(points.node);
    const auto own = to_host(own_stiffness(H->base(), points)), weight = to_host(points.weight);
    const auto coords = to_host(d.mesh->coords);
    HostView<double *> added("added", points.size());
    for (LO i = 0; i < points.size(); ++i) added(i) = is_closed(coords(node(i), 0)) ? 1e5 * own(i) * weight(i) : 0;
    H->set(points, test::along_directions(points, added));
  }
  void close_half() const
  {
    close([](const double x) { return std::fmod(x, 0.6) < 0.3; });
  }

  /// Without order, 0 where prescribed.
  Vector vector(const double phase) const
  {
    Vector v(d.owned_dofs);
    const auto fixed = to_host(dirichlet.fixed);
    const auto id = d.mesh->node_id;
    for (LO i = 0; i < num_local(*d.owned_dofs); ++i) {
      const double number = static_cast<double>(dof(d.dim(), id(node_of(d.dim(), i)), component_of(d.dim(), i)));
      v.replaceLocalValue(i, fixed(i) ? 0 : std::sin(phase + 12.9898 * number * (1 + 1e-3 * number)));
    }
    return v;
  }
  std::unique_ptr<LinearSolver> solver() const
  {
    LinearSolverOptions options;
    options.multigrid = "mesh";
    return std::make_unique<LinearSolver>(options, H, fem::node_coordinates(d), fem::rigid_body_modes(d),
                                          [this] { return levels(); });
  }
};

std::string text_of(const mesh::Element &element)
{
  return element.name() + " in " + std::to_string(element.dim) + "D";
}
std::vector<int> some_cells(const mesh::Element &element)
{
  const bool one = element.order == 1;
  if (element.dim == 2) return one ? std::vector<int>{67, 35, 0} : std::vector<int>{35, 17, 0};
  return one ? std::vector<int>{23, 11, 13} : std::vector<int>{11, 5, 7};
}

/// The solver for the coarsest level that these meshes lead to.
std::unique_ptr<solver::CoarsestSolver> directly(const solver::MeshLevel &level)
{
  return solver::direct_solver(level.stiffness);
}

double relative_difference(const Vector &a, const Vector &b)
{
  Vector difference(a, Teuchos::Copy);
  difference.update(-1., b, 1.);
  return difference.norm2() / b.norm2();
}

TEST(MeshMultigrid, IsSymmetricAndPositive)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const Block block(element, some_cells(element));
    block.close_half();
    const MeshLevels levels = block.levels();
    ASSERT_TRUE(levels.down_to_few) << text_of(element);
    const MeshMultigrid B(block.H, levels, directly);
    const Vector x = block.vector(1), y = block.vector(2);
    Vector Bx(x.getMap()), By(x.getMap());
    B.apply(x, Bx);
    B.apply(y, By);
    EXPECT_NEAR(Bx.dot(y), By.dot(x), 1e-10 * std::sqrt(Bx.dot(x) * By.dot(y))) << text_of(element);
    EXPECT_GT(Bx.dot(x), 0) << text_of(element);
    EXPECT_GT(By.dot(y), 0) << text_of(element);
  }
}

/// Iterations to 1e-8 with an unordered right side, nothing and every other stretch of the contact side closed.
TEST(MeshMultigrid, NeedsFewIterations)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const int most = element.dim == 2 ? (element == mesh::Element{2, 1} ? 12 : 15) : (element.order == 1 ? 14 : 20);
    const Block block(element, some_cells(element));
    const auto solver = block.solver();
    const Vector b = block.vector(3);
    Vector x(b.getMap()), Hx(b.getMap());
    for (const bool closed : {false, true}) {
      if (closed) block.close_half();
      const auto result = solver->solve(b, x, 1e-8);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_LE(result.iterations, most) << text_of(element) << (closed ? ", closed" : "");
      block.H->apply(x, Hx);
      EXPECT_LT(relative_difference(Hx, b), 1.1e-8) << text_of(element);
    }
    EXPECT_EQ(solver->counts().preconditioner_setups, 1) << text_of(element);
    EXPECT_EQ(solver->counts().local_corrections, 1) << text_of(element);
    EXPECT_EQ(solver->counts().fallback, "") << text_of(element);
  }
}

/// A hierarchy that has followed the states is that which is made for them.
TEST(MeshMultigrid, FollowsTheStatesExactly)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const Block block(element, some_cells(element));
    block.close_half();
    MeshMultigrid B(block.H, block.levels(), directly);
    for (int k = 0; k < 3; ++k) {
      block.close([k](const double x) { return std::fmod(x + 0.1 * k, 0.5) < 0.2; });
      B.update();
    }
    const MeshMultigrid anew(block.H, block.levels(), directly);
    const Vector x = block.vector(4);
    Vector Bx(x.getMap()), expected(x.getMap());
    B.apply(x, Bx);
    anew.apply(x, expected);
    EXPECT_LT(relative_difference(Bx, expected), 1e-10) << text_of(element);
  }
}

TEST(MeshMultigrid, IterationsDoNotGrowWithTheMesh)
{
  std::vector<int> iterations;
  for (const int n : {16, 32, 64, 128}) {
    const Block block({2, 1}, {2 * n, n});
    block.close_half();
    const Vector b = block.vector(5);
    Vector x(b.getMap());
    iterations.push_back(block.solver()->solve(b, x, 1e-8).iterations);
  }
  EXPECT_LE(iterations.back(), iterations[1] + 2);
  EXPECT_LE(iterations.back(), 12);
}

/// Stretched cells: only the direction in which they are short is halved, until they are square.
TEST(MeshMultigrid, TakesStretchedCells)
{
  for (const double length : {1., 10., 100.}) {
    const Block block({2, 1}, {40, 40}, true, {length, 1, 1});
    block.close_half();
    const Vector b = block.vector(6);
    Vector x(b.getMap());
    const auto result = block.solver()->solve(b, x, 1e-8);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LE(result.iterations, 25) << length;
  }
}

/// Of order 2 without coarser boxes: MueLu's hierarchy follows the mesh of order 1.
TEST(MeshMultigrid, EndsAlgebraicallyWhereThereIsNoCoarserMesh)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    if (element.order == 1) continue;
    const Block block(element, some_cells(element), false);
    const MeshLevels levels = block.levels();
    ASSERT_EQ(levels.level.size(), 1U) << text_of(element);
    const auto solver = block.solver();
    const Vector b = block.vector(7);
    Vector x(b.getMap());
    for (const bool closed : {false, true}) {
      if (closed) block.close_half();
      const auto result = solver->solve(b, x, 1e-8);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_LE(result.iterations, element.dim == 2 ? 15 : 20) << text_of(element) << (closed ? ", closed" : "");
    }
    EXPECT_EQ(solver->counts().preconditioner_setups, 1) << text_of(element);
  }
}

/// A solver for the coarsest mesh that counts how often it is made to follow the states.
class Counting : public solver::CoarsestSolver
{
public:
  Counting(std::unique_ptr<CoarsestSolver> solver, int &updates) : solver_(std::move(solver)), updates_(updates) {}
  void update() override
  {
    ++updates_;
    solver_->update();
  }
  double most_change() const override { return 0.1; }
  void apply(const Vector &b, Vector &x) const override { solver_->apply(b, x); }

private:
  std::unique_ptr<CoarsestSolver> solver_;
  int &updates_;
};

/// Small changes add up until the coarsest solver follows.
TEST(MeshMultigrid, RenewsWhatIsDearWhereMuchHasChanged)
{
  const Block block({2, 1}, {67, 35});
  const auto close_up_to = [&](const double x) { block.close([x](const double at) { return at < x; }); };
  close_up_to(1);
  int updates = 0;
  MeshMultigrid B(block.H, block.levels(),
                  [&](const solver::MeshLevel &level) { return std::make_unique<Counting>(directly(level), updates); });
  B.update();
  EXPECT_EQ(updates, 0); // nothing has changed
  close_up_to(1.06);
  B.update();
  EXPECT_EQ(updates, 0);
  close_up_to(1.2); // a sixth more than it was made for
  B.update();
  EXPECT_EQ(updates, 1);
  close_up_to(1.14);
  B.update();
  EXPECT_EQ(updates, 1);
  close_up_to(0);
  B.update();
  EXPECT_EQ(updates, 2);
}

/// Coarse matrices that are not positive definite: the algebraic hierarchy takes over, and the counts say why.
TEST(MeshMultigrid, GivesWayToTheAlgebraicOneWhereItFails)
{
  const Block block({2, 1}, {67, 35});
  LinearSolverOptions options;
  options.multigrid = "mesh";
  LinearSolver solver(options, block.H, fem::node_coordinates(block.d), fem::rigid_body_modes(block.d), [&] {
    MeshLevels levels = block.levels();
    CrsMatrix &coarsest = *levels.level.back().stiffness;
    coarsest.resumeFill();
    coarsest.scale(-1.);
    coarsest.fillComplete();
    return levels;
  });
  const Vector b = block.vector(8);
  Vector x(b.getMap()), Hx(b.getMap());
  const auto result = solver.solve(b, x, 1e-8);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_NE(solver.counts().fallback.find("not positive definite"), std::string::npos) << solver.counts().fallback;
  block.H->apply(x, Hx);
  EXPECT_LT(relative_difference(Hx, b), 1.1e-8);
}

/// A mesh of few unknowns that could be solved directly has a coarser one all the same; where none can be had, none is used.
TEST(MeshMultigrid, TakesSmallMeshes)
{
  const Block block({2, 1}, {12, 6});
  const Vector b = block.vector(10);
  Vector x(b.getMap());
  const auto solver = block.solver();
  EXPECT_TRUE(solver->solve(b, x, 1e-8).converged);
  EXPECT_EQ(solver->counts().fallback, "");
  LinearSolverOptions options;
  options.multigrid = "mesh";
  LinearSolver without(options, block.H, fem::node_coordinates(block.d), fem::rigid_body_modes(block.d),
                       [] { return MeshLevels(); });
  EXPECT_TRUE(without.solve(b, x, 1e-8).converged);
  EXPECT_NE(without.counts().fallback, "");
}

/// Cells 312:1 of a beam: K has the condition number 3e13. Rounding leaves a residual on the patch of the local correction, and CG
/// breaks down with an x that is as good as can be.
TEST(LinearSolver, GoesOnFromTheResidualWhereRoundingEndsCG)
{
  if (Tpetra::getDefaultComm()->getSize() > 1) GTEST_SKIP() << "the factor of the whole matrix is that of one rank";
  const Block block({2, 2}, {16, 24}, false, {1, 0.0048});
  LinearSolverOptions options;
  options.multigrid = "algebraic";
  options.muelu.set("coarse: max size", 100000); // a factor
  options.reuse = "none";
  LinearSolver solver(options, block.H, fem::node_coordinates(block.d), fem::rigid_body_modes(block.d));
  const Vector b = block.vector(11);
  Vector x(b.getMap()), residual(b.getMap());
  for (int k = 0; k < 2; ++k) {
    block.close([k](const double place) { return std::fmod(place + 0.03 * k, 0.25) < 0.05; });
    for (const double tolerance : {5e-3, 1e-6}) {
      const auto result = solver.solve(b, x, tolerance);
      EXPECT_FALSE(result.broken) << result.reason;
      block.H->apply(x, residual);
      residual.update(1., b, -1.);
      EXPECT_LT(std::sqrt(solver.inverse_energy(residual) / solver.inverse_energy(b)), 1e-4);
    }
  }
}

/// Few unknowns are factored for each choice of states, unless the deck says otherwise.
TEST(LinearSolver, FactorsFewUnknowns)
{
  const Block block({2, 1}, {20, 10});
  const Vector b = block.vector(12);
  Vector x(b.getMap());
  const auto iterations = [&](const std::function<void(LinearSolverOptions &)> &set) {
    LinearSolverOptions options;
    set(options);
    LinearSolver solver(options, block.H, fem::node_coordinates(block.d), fem::rigid_body_modes(block.d));
    int most = 0;
    for (const double end : {0., 0.7, 1.3}) {
      block.close([end](const double at) { return at < end; });
      const auto result = solver.solve(b, x, 1e-6);
      EXPECT_TRUE(result.converged) << result.reason;
      most = std::max(most, result.iterations);
    }
    EXPECT_EQ(solver.counts().preconditioner_setups, 3);
    return most;
  };
  EXPECT_EQ(iterations([](LinearSolverOptions &) {}), 1);
  const auto small_levels = [](LinearSolverOptions &options) { options.muelu.set("coarse: max size", 20); };
  EXPECT_GT(iterations(small_levels), 1);
}

/// Where nothing holds the body there is no factor; that is a result, not an exception.
TEST(LinearSolver, TellsWhereFewUnknownsHaveNoFactor)
{
  const Block block({2, 1}, {20, 10});
  const auto K = fem::assemble_stiffness(block.d, block.model.materials); // nothing is prescribed
  K->resumeFill();
  K->scale(-1.);
  K->fillComplete();
  const auto H = test::updated(K, block.points);
  LinearSolver solver({}, H, fem::node_coordinates(block.d), fem::rigid_body_modes(block.d));
  const Vector b = block.vector(13);
  Vector x(b.getMap());
  EXPECT_FALSE(solver.solve(b, x, 1e-6).converged);
}

TEST(LinearSolver, TakesMeshesUnlessMueLuIsGiven)
{
  const Block block({2, 1}, {67, 35});
  const Vector b = block.vector(9);
  Vector x(b.getMap());
  const auto makes_levels = [&](const std::function<void(LinearSolverOptions &)> &set) {
    bool made = false;
    LinearSolverOptions options;
    set(options);
    LinearSolver solver(options, block.H, fem::node_coordinates(block.d), fem::rigid_body_modes(block.d), [&] {
      made = true;
      return block.levels();
    });
    EXPECT_TRUE(solver.solve(b, x, 1e-6).converged);
    return made;
  };
  EXPECT_TRUE(makes_levels([](LinearSolverOptions &) {}));
  EXPECT_FALSE(makes_levels([](LinearSolverOptions &options) { options.multigrid = "algebraic"; }));
  EXPECT_FALSE(makes_levels([](LinearSolverOptions &options) { options.muelu.set("max levels", 3); }));
  EXPECT_TRUE(makes_levels([](LinearSolverOptions &options) {
    options.muelu.set("max levels", 3);
    options.multigrid = "mesh";
  }));
}

/// x by a dense factor of the whole matrix, which is made column by column.
Vector solved_densely(const Operator &H, const Vector &b)
{
  const Map &map = *b.getMap();
  const int n = static_cast<int>(map.getGlobalNumElements());
  const LO own = num_local(map);
  std::vector<double> matrix(static_cast<std::size_t>(n) * n), x(n);
  Vector unit(b.getMap()), column(b.getMap());
  const auto place = [&](const LO i) { return static_cast<std::size_t>(map.getGlobalElement(i)); };
  const auto copy = [&](const Vector &from, double *const to) {
    const auto values = from.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO i = 0; i < own; ++i) to[place(i)] = values(i, 0);
  };
  for (int j = 0; j < n; ++j) {
    const LO here = map.getLocalElement(j);
    unit.putScalar(0);
    if (here >= 0) unit.replaceLocalValue(here, 1.);
    H.apply(unit, column);
    copy(column, matrix.data() + static_cast<std::size_t>(n) * j);
  }
  copy(b, x.data());
  matrix = summed(*map.getComm(), matrix);
  x = summed(*map.getComm(), x);
  std::vector<int> pivots(n);
  int info = 0;
  Teuchos::LAPACK<int, double>().GESV(n, 1, matrix.data(), n, pivots.data(), x.data(), n, &info);
  EXPECT_EQ(info, 0);
  Vector solution(b.getMap());
  for (LO i = 0; i < own; ++i) solution.replaceLocalValue(i, x[place(i)]);
  return solution;
}

/// Friction's tangent at closed nodes, with the coefficient of friction 0.3: the tangential force follows the normal one,
/// s w m m^T + 0.3 s w t m^T. Preconditioners take its symmetric part.
TEST(LinearSolver, SolvesByGmresWhereContactIsNotSymmetric)
{
  const Block block({2, 1}, {16, 9});
  const auto own = to_host(own_stiffness(block.H->base(), block.points)), weight = to_host(block.points.weight);
  const auto direction = to_host(block.points.direction);
  const DeviceView<double ***> update("update", block.points.size(), 2, 2);
  const auto host_update = Kokkos::create_mirror_view(update);
  constexpr double stiffness = 1, friction = 0.3;
  for (LO i = 0; i < block.points.size(); ++i) {
    const double m[2] = {direction(i, 0), direction(i, 1)}, t[2] = {m[1], -m[0]};
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l)
        host_update(i, k, l) = stiffness * own(i) * weight(i) * (m[k] + friction * t[k]) * m[l];
  }
  EXPECT_TRUE(block.H->is_symmetric());
  Kokkos::deep_copy(update, host_update);
  block.H->set(block.points, update);
  EXPECT_FALSE(block.H->is_symmetric());
  const Vector b = block.vector(14);
  const Vector expected = solved_densely(*block.H, b);
  Vector x(b.getMap());
  struct Kind {
    const char *multigrid, *path;
    int most;
  };
  for (const Kind &kind : {Kind{"mesh", "meshes", 20}, {"algebraic", "algebraic", 20}, {"auto", "factor", 15}}) {
    LinearSolverOptions options;
    options.multigrid = kind.multigrid;
    LinearSolver solver(options, block.H, fem::node_coordinates(block.d), fem::rigid_body_modes(block.d),
                        kind.path == std::string("meshes") ? solver::MakeMeshLevels([&] { return block.levels(); })
                                                           : solver::MakeMeshLevels());
    const auto result = solver.solve(b, x, 1e-9);
    EXPECT_TRUE(result.converged) << kind.path << ": " << result.reason;
    EXPECT_GT(result.iterations, 2) << kind.path;
    EXPECT_LE(result.iterations, kind.most) << kind.path;
    EXPECT_LT(relative_difference(x, expected), 1e-6) << kind.path;
    EXPECT_EQ(solver_path(solver.counts()), kind.path);
  }
}

} // namespace
