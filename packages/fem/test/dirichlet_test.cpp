// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/dirichlet.hpp"

#include "bodies.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/fem/elasticity.hpp"

#include <Teuchos_LAPACK.hpp>
#include <limits>

namespace dirichlet_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::DirichletCondition;
using Teuchos::ParameterList;

constexpr fem::Material steel{2000, 0.3};

/// The linear displacement on each side of the box.
std::vector<DirichletCondition> linear_on_all_sides(const fem::Discretization &d)
{
  std::vector<DirichletCondition> conditions;
  const int dim = d.dim();
  for (const auto &side : d.mesh->sides) {
    DirichletCondition condition{side.name, side.name, {}};
    for (int c = 0; c < dim; ++c)
      condition.displacement[c] = field([c, dim](const Point &x) { return linear(x, dim)[c]; });
    conditions.push_back(condition);
  }
  return conditions;
}

/// Left fixed, right pushed in x alone by something curved; the rest free.
std::vector<DirichletCondition> held_and_pushed(const fem::Discretization &d)
{
  DirichletCondition held{"held", "left", {}}, pushed{"pushed", "right", {}};
  for (int c = 0; c < d.dim(); ++c) held.displacement[c] = ScalarField(0);
  pushed.displacement[0] = field([](const Point &x) { return 0.1 + std::sin(x[1]); });
  return {held, pushed};
}

RCP<Vector> some_load(const fem::Discretization &d)
{
  const auto load = rcp(new Vector(d.owned_dofs));
  fem::add_body_force(d, {field([](const Point &x) { return wild(x)[0]; }), ScalarField(-3), ScalarField(1)}, "B",
                      *load);
  return load;
}

struct Eliminated : fem::ElasticProblem {
  RCP<CrsMatrix> stiffness;
};
Eliminated eliminated(const fem::Discretization &d, const std::vector<DirichletCondition> &conditions,
                      const RCP<Vector> &load)
{
  auto dirichlet = fem::dirichlet_dofs(d, conditions);
  const auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, steel), dirichlet.fixed);
  return {fem::elastic_problem(d, K.couplings, load, dirichlet), K.matrix};
}

/// Solution of a dense system by Cholesky's method; fails unless the matrix is positive definite.
std::vector<double> cholesky_solve(const std::vector<std::vector<double>> &a, std::vector<double> b)
{
  const int n = static_cast<int>(a.size());
  std::vector<double> columns;
  for (const auto &row : a) columns.insert(columns.end(), row.begin(), row.end());
  int info = 0;
  Teuchos::LAPACK<int, double>().POSV('L', n, 1, columns.data(), n, b.data(), n, &info);
  EXPECT_EQ(info, 0) << "not positive definite";
  return b;
}
std::vector<double> values_of(const Vector &v)
{
  const auto view = v.getLocalViewHost(Tpetra::Access::ReadOnly);
  return {view.data(), view.data() + view.extent(0)};
}

TEST(DirichletDofs, OfACornerAreThoseOfItsNodeAlone)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto box = small_box(element);
    const auto d = body(box, Tpetra::getDefaultComm());
    DirichletCondition foot{"foot", element.dim == 2 ? "right bottom" : "right bottom back", {}};
    foot.displacement[0] = ScalarField(0.25);
    const auto dirichlet = fem::dirichlet_dofs(d, {foot});
    EXPECT_EQ(dirichlet.num_fixed, 1);
    const auto value = dirichlet.value->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto coords = to_host(d.mesh->coords);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      bool there = coords(n, 0) == box.upper[0];
      for (int c = 1; c < element.dim; ++c) there = there && coords(n, c) == box.lower[c];
      EXPECT_EQ(value(rpc::dof(element.dim, n, 0), 0), there ? 0.25 : 0);
    }
  }
}

TEST(EliminateDirichlet, MatrixIsSymmetric)
{
  for (const auto &element : elements()) {
    const auto d = bulged_body(element, alone());
    for (const auto &conditions : {linear_on_all_sides(d), held_and_pushed(d)})
      EXPECT_LT(asymmetry(dense(*eliminated(d, conditions, some_load(d)).stiffness)), rounding_of(element))
          << text_of(element);
  }
}

TEST(EliminateDirichlet, MatrixIsPositiveOnEveryFieldThatIsNotZero)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto problem = eliminated(d, held_and_pushed(d), some_load(d));
    Vector force(d.owned_dofs);
    for (int k = 0; k < 5; ++k) {
      const auto u = interpolate(d, [&](const Point &x) { return wild({x[0] + k, k * x[1], x[2] - k}); });
      problem.stiffness->apply(*u, force);
      EXPECT_GT(u->dot(force), 0.01 * steel.mu());
    }
    const auto modes = fem::rigid_body_modes(d);
    for (std::size_t mode = 0; mode < modes->getNumVectors(); ++mode) {
      problem.stiffness->apply(*modes->getVector(mode), force);
      EXPECT_GT(modes->getVector(mode)->dot(force), 0.01 * steel.mu());
    }
  }
}

TEST(EliminateDirichlet, RowsAndColumnsOfPrescribedUnknownsKeepTheirDiagonalAlone)
{
  const auto d = bulged_body({2, 1}, alone());
  const auto before = dense(*fem::assemble_stiffness(d, steel));
  const auto problem = eliminated(d, held_and_pushed(d), some_load(d));
  const auto after = dense(*problem.stiffness);
  const auto fixed = to_host(problem.dirichlet.fixed);
  for (std::size_t i = 0; i < after.size(); ++i)
    for (std::size_t j = 0; j < after.size(); ++j)
      EXPECT_EQ(after[i][j], i != j && (fixed(i) || fixed(j)) ? 0 : before[i][j]);
}

TEST(EliminateDirichlet, LinearFieldOnTheBoundaryIsSolvedExactly)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, alone());
    const auto problem = eliminated(d, linear_on_all_sides(d), rcp(new Vector(d.owned_dofs)));
    const auto u = cholesky_solve(dense(*problem.stiffness), values_of(*problem.load));
    EXPECT_LT(difference(u, values_of(*interpolate(d, [&](const Point &x) { return linear(x, element.dim); }))), 1e-12);
  }
}

TEST(EliminateDirichlet, LinearFieldSolvesTheSystemOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto problem = eliminated(d, linear_on_all_sides(d), rcp(new Vector(d.owned_dofs)));
    Vector residual(*problem.load, Teuchos::Copy);
    const double scale = residual.normInf();
    problem.stiffness->apply(*interpolate(d, [&](const Point &x) { return linear(x, element.dim); }), residual,
                             Teuchos::NO_TRANS, 1., -1.);
    EXPECT_LT(residual.norm2(), 1e-13 * scale);
  }
}

TEST(EliminateDirichlet, SystemIsTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto parts = [&](const RCP<const Comm> &comm) {
      const auto d = bulged_body(element, comm);
      const auto problem = eliminated(d, held_and_pushed(d), some_load(d));
      Vector force(d.owned_dofs);
      problem.stiffness->apply(*interpolate(d, wild), force);
      return std::array<std::vector<double>, 4>{by_node_id(d, force),
                                                by_node_id(d, *problem.load),
                                                by_node_id(d, *problem.applied_load),
                                                {problem.energy_offset}};
    };
    const auto all = parts(world()), one = parts(alone());
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_LT(difference(all[k], one[k]), 1e-13) << "part " << k;
  }
}

TEST(EliminateDirichlet, EnergyWithItsOffsetIsThatOfTheFullProblem)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    for (const auto &conditions : {linear_on_all_sides(d), held_and_pushed(d)}) {
      const auto full = fem::assemble_stiffness(d, steel);
      const auto load = some_load(d);
      const auto problem = eliminated(d, conditions, some_load(d));
      // any field that has the prescribed values
      auto u = interpolate(d, wild);
      {
        const auto fixed = to_host(problem.dirichlet.fixed);
        const auto value = problem.dirichlet.value->getLocalViewHost(Tpetra::Access::ReadOnly);
        const auto to = u->getLocalViewHost(Tpetra::Access::ReadWrite);
        for (std::size_t dof = 0; dof < to.extent(0); ++dof)
          if (fixed(dof)) to(dof, 0) = value(dof, 0);
      }
      const auto energy = [&](const CrsMatrix &K, const Vector &b) {
        Vector force(d.owned_dofs);
        K.apply(*u, force);
        return 0.5 * u->dot(force) - b.dot(*u);
      };
      const double expected = energy(*full, *load);
      EXPECT_NE(problem.energy_offset, 0);
      EXPECT_NEAR(energy(*problem.stiffness, *problem.load) + problem.energy_offset, expected,
                  1e-13 * std::abs(expected));
      Vector change(*problem.applied_load, Teuchos::Copy);
      change.update(-1., *load, 1.);
      EXPECT_LT(change.norm2(), 1e-14 * load->normInf()); // threads sum in any order
    }
  }
}

TEST(EliminateDirichlet, NothingMovedMeansNoOffsetAndTheLoadOfFreeUnknownsAsItIs)
{
  const auto d = bulged_body({2, 1}, world());
  auto conditions = held_and_pushed(d);
  conditions[1].displacement[0] = ScalarField(0);
  const auto problem = eliminated(d, conditions, some_load(d));
  EXPECT_EQ(problem.energy_offset, 0);
  const auto fixed = to_host(problem.dirichlet.fixed);
  const auto load = values_of(*problem.load), applied = values_of(*problem.applied_load);
  for (std::size_t dof = 0; dof < load.size(); ++dof) EXPECT_EQ(load[dof], fixed(dof) ? 0 : applied[dof]);
  EXPECT_LT(difference(by_node_id(d, *problem.applied_load), by_node_id(d, *some_load(d))),
            1e-14); // reactions need all
}

TEST(DirichletDofs, MarkThePrescribedComponentsOfOwnedAndGhostNodes)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    const auto dirichlet = fem::dirichlet_dofs(d, held_and_pushed(d));
    const auto fixed = to_host(dirichlet.fixed);
    const auto value = dirichlet.value->getLocalViewHost(Tpetra::Access::ReadOnly);
    ASSERT_EQ(static_cast<LO>(fixed.extent(0)), d.dim() * d.mesh->num_local_nodes());
    for (LO n = 0; n < d.mesh->num_local_nodes(); ++n) {
      const Point x = point_of(d, n);
      const bool left = x[0] == box.lower[0], right = x[0] == box.upper[0];
      for (int c = 0; c < d.dim(); ++c) {
        const bool pushed = right && c == 0;
        EXPECT_EQ(fixed(d.dim() * n + c) != 0, left || pushed);
        if (n < d.mesh->num_owned_nodes()) {
          EXPECT_NEAR(value(d.dim() * n + c, 0), pushed ? 0.1 + std::sin(x[1]) : 0, 1e-15);
        }
      }
    }
    int across = 1; // nodes of the side
    for (int c = 1; c < d.dim(); ++c) across *= box.cells[c] * element.order + 1;
    EXPECT_EQ(dirichlet.num_fixed, across * (d.dim() + 1));
  }
}

TEST(DirichletDofs, ForcesOnThemAreCleared)
{
  const auto d = body(small_box({2, 1}), world());
  const auto dirichlet = fem::dirichlet_dofs(d, held_and_pushed(d));
  const auto full = interpolate(d, [](const Point &) { return Point{3, 4}; });
  Vector force(*full, Teuchos::Copy);
  fem::clear_prescribed(dirichlet, force);
  const auto cleared = interpolate(d, [](const Point &x) {
    const bool left = x[0] == -1, right = x[0] == 1.5;
    return Point{left || right ? 0. : 3., left ? 0. : 4.};
  });
  EXPECT_EQ(by_node_id(d, force), by_node_id(d, *cleared));
}

TEST(DirichletDofs, TellWhichConditionPrescribesAnUnknownTheLastOfSeveral)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    DirichletCondition wall{"wall", "left", {}}, floor{"floor", "bottom", {}};
    wall.displacement[0] = wall.displacement[1] = floor.displacement[0] = ScalarField(0);
    const auto condition = to_host(fem::dirichlet_dofs(d, {wall, floor}).condition);
    ASSERT_EQ(static_cast<LO>(condition.extent(0)), d.dim() * d.mesh->num_owned_nodes());
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      const Point x = point_of(d, n);
      const bool left = x[0] == box.lower[0], bottom = x[1] == box.lower[1];
      EXPECT_EQ(condition(d.dim() * n), bottom ? 1 : left ? 0 : -1);
      EXPECT_EQ(condition(d.dim() * n + 1), left ? 0 : -1);
      if (d.dim() == 3) {
        EXPECT_EQ(condition(d.dim() * n + 2), -1);
      }
    }
  }
}

/// What dirichlet_dofs makes of x on the left and at the bottom, which share a corner.
void prescribe(const fem::Discretization &d, const ScalarField &left, const ScalarField &bottom)
{
  DirichletCondition wall{"wall", "left", {}}, floor{"floor", "bottom", {}};
  wall.displacement[0] = left;
  floor.displacement[0] = bottom;
  fem::dirichlet_dofs(d, {wall, floor});
}

TEST(DirichletDofs, DifferentValuesAtOneNodeNameBothEntriesOnEveryRank)
{
  const auto d = body(small_box({2, 1}), world());
  expect_error(ExitCode::bad_input, {"\"Dirichlet->wall\"", "\"Dirichlet->floor\"", " X ", "(-1, 2", "0.5"},
               [&] { prescribe(d, ScalarField(0), ScalarField(0.5)); });
}

TEST(DirichletDofs, EqualValuesAtOneNodeAndRoundOffAreNoConflict)
{
  const auto d = body(small_box({2, 1}), world());
  EXPECT_NO_THROW(prescribe(d, ScalarField(0.5), ScalarField(0.5)));
  EXPECT_NO_THROW(prescribe(d, ScalarField(0.3), field([](const Point &x) { return -0.1 * x[0] * 3; })));
  // sin(pi) is 1e-16 instead of 0
  EXPECT_NO_THROW(
      prescribe(d, ScalarField(0), field([](const Point &x) { return std::sin(3.14159265358979323846 * x[0]); })));
  EXPECT_NO_THROW(
      prescribe(d, field([](const Point &x) { return std::sin(3.14159265358979323846 * x[1]); }), ScalarField(0)));
  // small displacements are no round-off
  expect_error(ExitCode::bad_input, {"prescribe different"}, [&] { prescribe(d, ScalarField(0), ScalarField(1e-14)); });
}

TEST(DirichletDofs, DifferentComponentsMayMeetAtANode)
{
  const auto d = body(small_box({2, 1}), world());
  DirichletCondition wall{"wall", "left", {}}, floor{"floor", "bottom", {}};
  wall.displacement[0] = ScalarField(1);
  floor.displacement[1] = ScalarField(2);
  EXPECT_NO_THROW(fem::dirichlet_dofs(d, {wall, floor}));
}

TEST(DirichletDofs, UnknownSideAndNanAreRefusedByName)
{
  const auto d = body(small_box({2, 1}), world());
  DirichletCondition nowhere{"hold", "lft", {}}, bad{"push", "right", {}};
  nowhere.displacement[0] = ScalarField(0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  bad.displacement[1] = field([&](const Point &x) { return x[1] > 2.5 ? nan : 0; }, "sqrt(-y)");
  expect_error(ExitCode::bad_input, {"\"Dirichlet->hold->Side\"", "\"lft\"", "left, right, bottom, top"},
               [&] { fem::dirichlet_dofs(d, {nowhere}); });
  expect_error(ExitCode::bad_input, {"\"Dirichlet->push->Y\"", "\"sqrt(-y)\"", "nan at (1.5, "},
               [&] { fem::dirichlet_dofs(d, {bad}); });
}

std::vector<DirichletCondition> options_of(ParameterList list, const int dim = 2)
{
  validate(list, fem::valid_dirichlet_parameters());
  return fem::dirichlet_options(list, dim, parse_constant);
}

TEST(DirichletOptions, AbsentComponentsAreFreeAndTheNameIsTheDefaultSide)
{
  ParameterList list;
  list.sublist("left").set("X", 0).set("Y", 0.5);
  list.sublist("push").set("Side", "right").set("Y", "-1");
  const auto conditions = options_of(list);
  ASSERT_EQ(conditions.size(), 2u);
  EXPECT_EQ(conditions[0].side, "left");
  EXPECT_EQ(conditions[0].displacement[1]->constant, 0.5);
  EXPECT_TRUE(conditions[0].displacement[0]->is_zero());
  EXPECT_FALSE(conditions[0].displacement[2]);
  EXPECT_EQ(conditions[1].name, "push");
  EXPECT_EQ(conditions[1].side, "right");
  EXPECT_FALSE(conditions[1].displacement[0]);
  EXPECT_EQ(conditions[1].displacement[1]->constant, -1);
}

TEST(DirichletOptions, MayBeNone)
{
  EXPECT_TRUE(options_of({}).empty());
}

TEST(DirichletOptions, AnEmptyEntryAndAMissingDirectionAreRefused)
{
  ParameterList nothing, depth;
  nothing.sublist("left");
  depth.sublist("left").set("Z", 0);
  expect_error(ExitCode::bad_input, {"\"Dirichlet->left\"", "nothing"}, [&] { options_of(nothing); });
  expect_error(ExitCode::bad_input, {"\"Dirichlet->left->Z\"", "2D"}, [&] { options_of(depth); });
  EXPECT_TRUE(options_of(depth, 3)[0].displacement[2]);
}

} // namespace
} // namespace dirichlet_test
