// SPDX-License-Identifier: BSD-3-Clause
// The solution belongs to the scene, not to the units, the axes or the numbers that it is written down in.

#include "larger.hpp"
#include "run_scene.hpp"
#include "scratch_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace invariance_test
{
namespace
{

using namespace rpc;
using Assignments = std::vector<std::string>;

const std::string beam_deck = std::string(RPC_TEST_DECKS) + "/../../../input/beam.xml";
const std::string block_deck = std::string(RPC_TEST_DECKS) + "/block.xml";

std::string text(const double value)
{
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  return digits;
}

/// "{a, b}" for an array parameter.
template <class Pair>
std::string array_text(const Pair &values)
{
  return "{" + text(values[0]) + ", " + text(values[1]) + "}";
}

/// The nodes of a plane box, numbered by their place: i of the first direction and j of the second is i * (n[1] + 1) + j.
struct Lattice {
  std::array<double, 2> lower, upper;
  std::array<int, 2> n; ///< intervals between nodes

  int size() const { return (n[0] + 1) * (n[1] + 1); }
  int index(const int i, const int j) const { return i * (n[1] + 1) + j; }
  int nearest(const double x, const double y) const
  {
    return index(static_cast<int>(std::lround((x - lower[0]) / (upper[0] - lower[0]) * n[0])),
                 static_cast<int>(std::lround((y - lower[1]) / (upper[1] - lower[1]) * n[1])));
  }
};

/// What a run has found, by place and on all ranks.
struct Outcome {
  bool converged;
  std::string reason;
  std::vector<int> newton, linear; ///< iterations per Uzawa iteration, per linear solve
  int uzawa, setups;
  double energy, energy_norm_squared;
  std::vector<double> pressure;         ///< (lattice) [Pa], 0 off the contact side
  std::array<std::vector<double>, 2> u; ///< (lattice) [m]
};

Outcome outcome_of(const Scene &scene, const Lattice &lattice)
{
  std::ostream nowhere(nullptr);
  const Solution s = solve(scene, Tpetra::getDefaultComm(), nowhere);
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto coords = to_host(mesh.coords);
  const auto node = to_host(s.step.contact.node);
  const auto p = to_host(s.contact.pressure);
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto place = [&](const LO n) { return lattice.nearest(coords(n, 0), coords(n, 1)); };
  const auto summed = [&](const std::vector<double> &mine) {
    std::vector<double> all(mine.size());
    Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, lattice.size(), mine.data(), all.data());
    return all;
  };
  Outcome found{s.uzawa.converged,
                s.uzawa.reason,
                s.uzawa.newton_iterations,
                s.linear.iterations,
                s.uzawa.iterations,
                s.linear.preconditioner_setups,
                s.energy,
                s.energy_norm_squared,
                std::vector<double>(lattice.size()),
                {std::vector<double>(lattice.size()), std::vector<double>(lattice.size())}};
  for (LO i = 0; i < s.step.contact.size(); ++i) found.pressure[place(node(i))] = p(i);
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    for (int c = 0; c < 2; ++c) found.u[c][place(n)] = u(2 * n + c, 0);
  found.pressure = summed(found.pressure);
  for (auto &component : found.u) component = summed(component);
  return found;
}

double largest(const std::vector<double> &values)
{
  return std::accumulate(values.begin(), values.end(), 0.,
                         [](double a, double b) { return test::larger(a, std::abs(b)); });
}

/// Largest |values * factor - reference|, over the largest reference.
double difference(std::vector<double> values, const double factor, const std::vector<double> &reference)
{
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = values[k] * factor - reference[k];
  return largest(values) / largest(reference);
}

/// Both solve and take the same Uzawa and Newton iterations.
void expect_same_way(const Outcome &found, const Outcome &reference)
{
  EXPECT_TRUE(found.converged) << found.reason;
  EXPECT_TRUE(reference.converged) << reference.reason;
  EXPECT_EQ(found.uzawa, reference.uzawa);
  EXPECT_EQ(found.newton, reference.newton);
  EXPECT_EQ(found.setups, reference.setups);
}

// Units ---------------------------------------------------------------------------------------------------------------

struct Units {
  const char *name;
  double length, stress; ///< how many of them 1 m and 1 Pa are
  bool binary;           ///< powers of 2: the same digits everywhere, rounding included

  std::string metres(const double value) const { return text(value * length); }
  std::string pascals(const double value) const { return text(value * stress); }
  std::string pascals(const std::string &expression) const { return text(stress) + "*(" + expression + ")"; }
  std::string x() const { return "(x/" + text(length) + ")"; } ///< in m
};
constexpr Units metre{"N-m-Pa", 1, 1, true};
constexpr Units others[] = {{"N-mm-MPa", 1e3, 1e-6, false},
                            {"mN-um-GPa", 1e6, 1e-9, false},
                            {"2^-10 m, 2^20 Pa", 0x1p10, 0x1p-20, true},
                            {"2^-20 m, 2^30 Pa", 0x1p20, 0x1p-30, true}};

/// A box on the foundation at its bottom, in given units. @param cells  also the lattice: order 1
Lattice box_in(const Units &units, const std::array<double, 2> &upper, const std::array<int, 2> &cells,
               Assignments &scene)
{
  const Lattice lattice{{0, 0}, {upper[0] * units.length, upper[1] * units.length}, cells};
  scene.insert(scene.end(), {"Mesh->Upper=" + array_text(lattice.upper), "Mesh->Cells=" + array_text(cells),
                             "Material->Young's Modulus=" + units.pascals(2000)});
  return lattice;
}

Outcome beam_in(const Units &units, const std::string &xi)
{
  Assignments scene;
  const Lattice lattice = box_in(units, {5, 1}, {40, 8}, scene);
  scene.insert(scene.end(),
               {"Contact->Penalty=auto", "Traction->top->Y=" + units.pascals("-20*sin(pi*" + units.x() + "/5)"),
                "Contact->Yield Stress=" + (xi == "inf" ? xi : units.pascals(xi))});
  return outcome_of(read_scene(beam_deck, scene), lattice);
}

/// block.xml with the usual tolerances.
Assignments block_scene()
{
  return {"Uzawa->Tolerance=1e-8", "NOX->Step Tolerance=1e-10", "NOX->Residual Tolerance=1e-11",
          "Linear Solver->Tolerance=1e-8"};
}

/// Held by contact alone, which begins 0.1 m below.
Outcome fallen_block_in(const Units &units)
{
  Assignments scene = block_scene();
  const Lattice lattice = box_in(units, {1, 1}, {14, 10}, scene);
  scene.insert(scene.end(), {"Traction->top->Y=" + units.pascals("-4-2*cos(pi*" + units.x() + ")"),
                             "Contact->Yield Stress=" + units.pascals(5), "Contact->Gap=" + units.metres(0.1)});
  return outcome_of(read_scene(block_deck, scene), lattice);
}

/// Held by contact alone on a rigid-plastic cylinder.
Outcome block_on_cylinder_in(const Units &units)
{
  Assignments scene = block_scene();
  const Lattice lattice = box_in(units, {2, 1}, {32, 16}, scene);
  const std::array<double, 2> centre = {0.9 * units.length, -8 * units.length};
  scene.insert(scene.end(), {"Traction->top->Y=" + units.pascals(-4), "Contact->Yield Stress=" + units.pascals(6),
                             "Contact->Obstacle->Type=circle", "Contact->Obstacle->Centre=" + array_text(centre),
                             "Contact->Obstacle->Radius=" + units.metres(7.99)});
  return outcome_of(read_scene(block_deck, scene), lattice);
}

/// Results in units agree with those in m and Pa. CG iterations too: by one at most where rounding differs and may decide
/// when CG's residual is below its tolerance.
void expect_same_in(const Units &units, const Outcome &found, const Outcome &reference)
{
  SCOPED_TRACE(units.name);
  expect_same_way(found, reference);
  ASSERT_EQ(found.linear.size(), reference.linear.size());
  for (std::size_t k = 0; k < found.linear.size(); ++k)
    EXPECT_NEAR(found.linear[k], reference.linear[k], units.binary ? 0 : 1) << "solve " << k;
  // Powers of two change no digit; but many threads add in the order in which they come, in products of multigrid's matrices.
  const double of_repeats = ExecutionSpace().concurrency() == 1 ? 1e-12 : 1e-10;
  const double joules = 1 / (units.stress * units.length * units.length), tolerance = units.binary ? of_repeats : 1e-9;
  EXPECT_NEAR(found.energy * joules, reference.energy, tolerance * std::abs(reference.energy));
  EXPECT_NEAR(found.energy_norm_squared * joules, reference.energy_norm_squared,
              tolerance * reference.energy_norm_squared);
  EXPECT_LT(difference(found.pressure, 1 / units.stress, reference.pressure), tolerance);
  for (int c = 0; c < 2; ++c) EXPECT_LT(difference(found.u[c], 1 / units.length, reference.u[c]), tolerance);
}

TEST(Units, DoNotMatterToTheBeam)
{
  for (const char *xi : {"2", "16", "inf"}) {
    SCOPED_TRACE(xi);
    const Outcome reference = beam_in(metre, xi);
    for (const Units &units : others) expect_same_in(units, beam_in(units, xi), reference);
  }
}

TEST(Units, DoNotMatterToABlockThatFallsOnItsFoundation)
{
  const Outcome reference = fallen_block_in(metre);
  for (const Units &units : others) expect_same_in(units, fallen_block_in(units), reference);
}

TEST(Units, DoNotMatterToABlockOnACylinder)
{
  const Outcome reference = block_on_cylinder_in(metre);
  for (const Units &units : others) expect_same_in(units, block_on_cylinder_in(units), reference);
}

// Axes ----------------------------------------------------------------------------------------------------------------

/// How the beam of input/beam.xml, 5 m long and 1 m high with its coordinates X and Y, lies in the deck's axes x and y.
struct Frame {
  const char *name;
  std::array<double, 2> lower, upper;
  std::string X;                          ///< of the deck's coordinates
  std::string left, right, bottom, top;   ///< the deck's names of the beam's sides
  std::array<std::array<int, 2>, 2> axes; ///< deck's components from the beam's

  bool along(const int c) const { return axes[c][0] != 0; } ///< whether the deck's direction c is the beam's
  std::array<int, 2> cells() const;
};
const Frame lying{"lying", {0, 0}, {5, 1}, "x", "left", "right", "bottom", "top", {{{1, 0}, {0, 1}}}};
const Frame mirrored{"mirrored", {0, 0}, {5, 1}, "(5-x)", "right", "left", "bottom", "top", {{{-1, 0}, {0, 1}}}};
const Frame upright{"turned by 90 degrees", {-1, 0}, {0, 5}, "y", "bottom", "top", "right", "left",
                    {{{0, -1}, {1, 0}}}};
const Frame hanging{"turned by -90 degrees", {0, -5}, {1, 0}, "(-y)", "top", "bottom", "left", "right",
                    {{{0, 1}, {-1, 0}}}};

/// Linear solves to rounding, so that aggregates, which go by the order of the nodes, do not matter; and Newton's end far
/// enough above rounding that it is the last change of states that decides.
const Assignments tight = {"Linear Solver->Tolerance=1e-13", "NOX->Residual Tolerance=1e-9"};
const Assignments usual = {};

/// No node touches exactly at the start: that would be a matter of rounding.
struct Law {
  const char *name, *xi, *gap; ///< of X
  bool both;                   ///< compare with the usual tolerances too

  std::vector<const Assignments *> solvers() const { return both ? std::vector{&tight, &usual} : std::vector{&tight}; }
};
const Law laws[] = {{"yielding everywhere", "1+0.2*X", "0", false},
                    {"all three states", "9+1.5*X", "0.0004*(X-1.013)^2", true},
                    {"rigid", "inf", "0.0004*(X-1.013)^2", false}};

constexpr std::array<int, 2> beam_cells = {40, 8};

std::array<int, 2> Frame::cells() const
{
  return along(0) ? beam_cells : std::array<int, 2>{beam_cells[1], beam_cells[0]};
}

std::string in_frame(std::string expression, const Frame &frame)
{
  for (std::size_t at; (at = expression.find('X')) != std::string::npos;) expression.replace(at, 1, frame.X);
  return expression;
}

/// Dragged towards its right end and pressed most right of the middle: nothing is symmetric.
Scene beam_in(const Frame &frame, const Law &law, const std::string &element, const Assignments &solver)
{
  const std::array<int, 2> cells = frame.cells();
  const std::array<std::string, 2> traction = {"0.5*X", "-8*X*exp(-(X-3)^2)"};
  Assignments scene = {"Mesh->Lower=" + array_text(frame.lower),
                       "Mesh->Upper=" + array_text(frame.upper),
                       "Mesh->Cells=" + array_text(cells),
                       "Mesh->Element=" + element,
                       "Dirichlet->left->Side=" + frame.left,
                       "Dirichlet->right->Side=" + frame.right,
                       "Traction->top->Side=" + frame.top,
                       "Contact->Side=" + frame.bottom,
                       "Contact->Penalty=auto",
                       "Contact->Yield Stress=" + in_frame(law.xi, frame),
                       "Contact->Gap=" + in_frame(law.gap, frame)};
  for (int c = 0; c < 2; ++c) {
    const int from = frame.along(c) ? 0 : 1;
    scene.push_back(std::string("Traction->top->") + "XY"[c] + "=" + text(frame.axes[c][from]) + "*(" +
                    in_frame(traction[from], frame) + ")");
  }
  scene.insert(scene.end(), solver.begin(), solver.end());
  return read_scene(beam_deck, scene);
}

/// Fields come back in the beam's own axes.
Outcome outcome_in(const Frame &frame, const Scene &scene, const std::string &element)
{
  const int order = element.back() - '0';
  Lattice lattice{frame.lower, frame.upper, frame.cells()};
  for (int &n : lattice.n) n *= order;
  const Outcome there = outcome_of(scene, lattice);
  Outcome here = there;
  const std::array<int, 2> n = {order * beam_cells[0], order * beam_cells[1]};
  for (int i = 0; i <= n[0]; ++i) {
    for (int j = 0; j <= n[1]; ++j) {
      const std::array<int, 2> k = {i, j};
      std::array<int, 2> at{};
      for (int c = 0; c < 2; ++c) {
        const int d = frame.along(c) ? 0 : 1;
        at[c] = frame.axes[c][d] > 0 ? k[d] : n[d] - k[d];
      }
      const int mine = i * (n[1] + 1) + j, its = lattice.index(at[0], at[1]);
      here.pressure[mine] = there.pressure[its];
      for (int d = 0; d < 2; ++d)
        here.u[d][mine] = frame.axes[0][d] * there.u[0][its] + frame.axes[1][d] * there.u[1][its];
    }
  }
  return here;
}

Outcome beam_outcome_in(const Frame &frame, const Law &law, const std::string &element, const Assignments &solver)
{
  return outcome_in(frame, beam_in(frame, law, element, solver), element);
}

/// Tight: the same way to the same solution. Usual: what optimality residuals of 1e-8 leave open.
void expect_same(const Outcome &found, const Outcome &reference, const Assignments &solver)
{
  EXPECT_TRUE(found.converged) << found.reason;
  EXPECT_TRUE(reference.converged) << reference.reason;
  const bool same_way = &solver == &tight;
  SCOPED_TRACE(same_way ? "tight" : "usual");
  if (same_way) expect_same_way(found, reference);
  EXPECT_NEAR(found.energy, reference.energy, 1e-9 * std::abs(reference.energy));
  EXPECT_NEAR(found.energy_norm_squared, reference.energy_norm_squared,
              (same_way ? 1e-9 : 1e-7) * reference.energy_norm_squared);
  EXPECT_LT(difference(found.pressure, 1, reference.pressure), same_way ? 1e-8 : 1e-6);
  for (int c = 0; c < 2; ++c) EXPECT_LT(difference(found.u[c], 1, reference.u[c]), same_way ? 1e-9 : 1e-7);
}

class Axes : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Elements, Axes, testing::Values("Q1", "Q2"));

TEST_P(Axes, MirroredAndTurnedBeamsHaveTheMirroredAndTurnedSolution)
{
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    for (const Assignments *solver : law.solvers()) {
      const Outcome reference = beam_outcome_in(lying, law, GetParam(), *solver);
      for (const Frame &frame : {mirrored, upright, hanging}) {
        SCOPED_TRACE(frame.name);
        expect_same(beam_outcome_in(frame, law, GetParam(), *solver), reference, *solver);
      }
    }
  }
}

// Numbers -------------------------------------------------------------------------------------------------------------

/// A gmsh element: type and its nodes, as places in twice the cell's lattice (corner, middle, corner: 0, 1, 2).
struct MshElement {
  int type;
  std::vector<std::array<int, 2>> nodes;
};

std::vector<MshElement> msh_cells(const std::string &element)
{
  if (element == "Q1") return {{3, {{0, 0}, {2, 0}, {2, 2}, {0, 2}}}};
  if (element == "P1") return {{2, {{0, 0}, {2, 0}, {0, 2}}}, {2, {{2, 2}, {0, 2}, {2, 0}}}};
  return {{9, {{0, 0}, {2, 0}, {0, 2}, {1, 0}, {1, 1}, {0, 1}}}, {9, {{2, 2}, {0, 2}, {2, 0}, {1, 2}, {1, 1}, {2, 1}}}};
}

/// The beam's box as a .msh 2.2 with nodes and elements numbered and listed by chance, numbers with gaps between them.
std::string shuffled_msh(const std::string &element, const std::array<int, 2> &cells)
{
  std::mt19937 random(7);
  const int order = element.back() - '0';
  const Lattice lattice{{0, 0}, {5, 1}, {order * cells[0], order * cells[1]}};
  std::vector<int> number(lattice.size());
  std::iota(number.begin(), number.end(), 1);
  std::shuffle(number.begin(), number.end(), random);
  for (int &n : number) n = 3 * n + 4;

  std::vector<std::string> nodes, elements;
  for (int i = 0; i <= lattice.n[0]; ++i)
    for (int j = 0; j <= lattice.n[1]; ++j)
      nodes.push_back(std::to_string(number[lattice.index(i, j)]) + " " + text(5. * i / lattice.n[0]) + " " +
                      text(double(j) / lattice.n[1]) + " 0");
  const auto add = [&](const MshElement &e, const int group, const int i, const int j) {
    std::string line = " " + std::to_string(e.type) + " 2 " + std::to_string(group) + " 1";
    for (const auto &at : e.nodes)
      line += " " + std::to_string(number[lattice.index(order * i + at[0] * order / 2, order * j + at[1] * order / 2)]);
    elements.push_back(line);
  };
  const int line = order == 1 ? 1 : 8;
  const auto edge = [&](const std::array<int, 2> from, const std::array<int, 2> to) {
    MshElement e{line, {from, to}};
    if (order == 2) e.nodes.push_back({(from[0] + to[0]) / 2, (from[1] + to[1]) / 2});
    return e;
  };
  for (int i = 0; i < cells[0]; ++i) {
    add(edge({0, 0}, {2, 0}), 1, i, 0);
    add(edge({2, 2}, {0, 2}), 2, i, cells[1] - 1);
    for (int j = 0; j < cells[1]; ++j)
      for (const MshElement &cell : msh_cells(element)) add(cell, 5, i, j);
  }
  for (int j = 0; j < cells[1]; ++j) {
    add(edge({0, 2}, {0, 0}), 3, 0, j);
    add(edge({2, 0}, {2, 2}), 4, cells[0] - 1, j);
  }
  std::shuffle(nodes.begin(), nodes.end(), random);
  std::shuffle(elements.begin(), elements.end(), random);
  for (std::size_t e = 0; e < elements.size(); ++e) elements[e] = std::to_string(2 * e + 11) + elements[e];

  std::string all = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 1 \"bottom\"\n1 2 \"top\"\n1 3 "
                    "\"left\"\n1 4 \"right\"\n2 5 \"body\"\n$EndPhysicalNames\n";
  for (const auto &[section, lines] : {std::pair("Nodes", nodes), std::pair("Elements", elements)}) {
    all += std::string("$") + section + "\n" + std::to_string(lines.size()) + "\n";
    for (const auto &entry : lines) all += entry + "\n";
    all += std::string("$End") + section + "\n";
  }
  return all;
}

class Numbers : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Elements, Numbers, testing::Values("Q1", "P1", "P2"));

TEST_P(Numbers, OfNodesAndCellsDoNotMatter)
{
  const std::string element = GetParam();
  const test::ScratchFile file("beam.msh", shuffled_msh(element, beam_cells));
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    for (const Assignments *solver : law.solvers()) {
      Scene scene = beam_in(lying, law, element, *solver);
      scene.step.prediction.enabled = false; // a mesh from a file has no coarser one
      const Outcome reference = outcome_in(lying, scene, element);
      scene.mesh = mesh::GmshOptions{file.path(), 1, 0};
      Outcome shuffled = outcome_in(lying, scene, element);
      // Multigrid's aggregates follow the order of unknowns, and CG's iterations decide whether it is set up once more.
      EXPECT_LE(std::abs(shuffled.setups - reference.setups), 1);
      shuffled.setups = reference.setups;
      expect_same(shuffled, reference, *solver);
    }
  }
}

} // namespace
} // namespace invariance_test
