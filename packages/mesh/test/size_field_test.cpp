// SPDX-License-Identifier: BSD-3-Clause
// Meshes with cell sizes from a field: what is asked for against what is made.

#include "expect_error.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "same_mesh.hpp"
#include "scratch_file.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <functional>
#include <numeric>
#include <sys/wait.h>
#include <unistd.h>

namespace size_field_test
{
namespace
{

using rpc::ExitCode;
using rpc::LO;
using rpc::mesh::BoxOptions;
using rpc::mesh::GmshOptions;
using rpc::mesh::MeshData;
using rpc::mesh::MeshOptions;
using rpc::mesh::parse_element;
using rpc::mesh::read_gmsh;
using rpc::mesh::SizeField;
using rpc::mesh::with_sizes;
using rpc::test::expect_error;
using rpc::test::expect_same_mesh;
using rpc::test::ScratchFile;

using Size = std::function<double(double, double)>;
using Sizes = std::shared_ptr<const SizeField>;

constexpr double pi = 3.141592653589793;
constexpr const char *all_elements[] = {"P1", "P2", "Q1", "Q2"};

/// Rings of triangles around a point, each wider by a quarter, from `least` until they reach `reach`.
Sizes rings(const double x, const double y, const double least, const double reach, const Size &size)
{
  constexpr int around = 16;
  auto field = std::make_shared<SizeField>();
  const auto add = [&](const double radius, const int step) {
    const double at[2] = {x + radius * std::cos(2 * pi * step / around), y + radius * std::sin(2 * pi * step / around)};
    field->coords.insert(field->coords.end(), at, at + 2);
    field->size.push_back(size(at[0], at[1]));
  };
  add(0, 0);
  for (double radius = least; radius < 1.25 * reach; radius *= 1.25) {
    const int first = static_cast<int>(field->size.size());
    for (int step = 0; step < around; ++step) {
      const int next = (step + 1) % around;
      add(radius, step);
      if (first == 1)
        field->simplices.insert(field->simplices.end(), {0, 1 + step, 1 + next});
      else
        field->simplices.insert(field->simplices.end(), {first - around + step, first + step, first + next,
                                                         first - around + step, first + next, first - around + next});
    }
  }
  return field;
}

/// The same size everywhere, given on a triangle in the unit square.
Sizes constant(const double size)
{
  return std::make_shared<SizeField>(SizeField{{0, 0, .5, 0, 0, .5}, {0, 1, 2}, {size, size, size}});
}

MeshData made(const MeshOptions &options, const Sizes &sizes)
{
  return read_gmsh(std::get<GmshOptions>(with_sizes(options, sizes).value()));
}

BoxOptions box(const std::string &element)
{
  return {{-1, 2}, {1, 3}, {4, 2}, parse_element(element, 2)};
}

struct Edge {
  double x[2], y[2];
  double length() const { return std::hypot(x[1] - x[0], y[1] - y[0]); }
};

Edge edge_of(const MeshData &mesh, const int cell, const int ordinal)
{
  const auto &facet = mesh.element.facets()[ordinal];
  const auto at = [&](const int end, const int d) {
    return mesh.coords[2 * mesh.cells[cell * mesh.element.num_nodes() + facet[end]] + d];
  };
  return {{at(0, 0), at(1, 0)}, {at(0, 1), at(1, 1)}};
}

std::vector<Edge> edges_of(const MeshData &mesh)
{
  std::vector<Edge> edges;
  for (int c = 0; c < mesh.num_cells(); ++c)
    for (int f = 0; f < mesh.element.num_facets(); ++f) edges.push_back(edge_of(mesh, c, f));
  return edges;
}

double area(const MeshData &mesh)
{
  double sum = 0;
  for (const Edge &e : edges_of(mesh)) sum += (e.x[0] * e.y[1] - e.x[1] * e.y[0]) / 2;
  return sum;
}

double length(const MeshData &mesh, const std::size_t side)
{
  double sum = 0;
  for (std::size_t f = 0; f < mesh.sides[side].cell.size(); ++f)
    sum += edge_of(mesh, mesh.sides[side].cell[f], mesh.sides[side].ordinal[f]).length();
  return sum;
}

/// Mean over the edges of the logarithm of length over size, as a factor.
double mean_ratio(const MeshData &mesh, const Size &size)
{
  double sum = 0;
  const auto edges = edges_of(mesh);
  for (const Edge &e : edges) sum += std::log(e.length() / size((e.x[0] + e.x[1]) / 2, (e.y[0] + e.y[1]) / 2));
  return std::exp(sum / static_cast<double>(edges.size()));
}

TEST(SizeField, GradedToACornerHasItsSizesNearAndFar)
{
  const Size size = [](const double x, const double y) { return std::min(.2, 1e-5 + .2 * std::hypot(x + 1, y - 2)); };
  const Sizes field = rings(-1, 2, 1e-5, 3, size);
  for (const std::string element : all_elements) {
    SCOPED_TRACE(element);
    const MeshData mesh = made(box(element), field);
    EXPECT_EQ(mesh.element.name(), element);
    EXPECT_EQ(mesh.blocks, std::vector<std::string>{"body"});
    EXPECT_NEAR(area(mesh), 2, 1e-12);
    EXPECT_NEAR(mean_ratio(mesh, size), 1, .2);
    double shortest = 1, longest = 0;
    for (const Edge &e : edges_of(mesh)) {
      shortest = std::min(shortest, e.length());
      longest = std::max(longest, e.length());
    }
    EXPECT_GT(shortest, 3e-6);
    EXPECT_LT(shortest, 2e-5);
    EXPECT_GT(longest, .1);
    EXPECT_LT(longest, .4);
  }
}

TEST(SizeField, HasAboutTheExpectedNumberOfCells)
{
  const Size size = [](const double x, const double y) { return .01 + .1 * std::hypot(x, y - 2.5); };
  auto field = std::make_shared<SizeField>();
  constexpr int n = 20; // intervals on each side of the box
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      field->coords.insert(field->coords.end(), {-1 + 2. * i / n, 2 + 1. * j / n});
      field->size.push_back(size(-1 + 2. * i / n, 2 + 1. * j / n));
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      field->simplices.insert(field->simplices.end(), {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1});
    }
  const double expected = expected_cells(*field);
  EXPECT_NEAR(made(box("P1"), field).num_cells(), expected, .2 * expected);
}

TEST(SizeField, ExpectedCellsAreTheIntegral)
{
  const auto triangle = [](const double a, const double b, const double c) {
    return SizeField{{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {a, b, c}};
  };
  EXPECT_NEAR(expected_cells(triangle(.1, .1, .1)), 200 / std::sqrt(3.), 1e-10);
  EXPECT_NEAR(expected_cells(triangle(.1, .1 + 1e-5, .1)), 200 / std::sqrt(3.), .1);
  // The integral of (1 - x) / (a + x)^2 from 0 to 1 is (1 + 1/a) - 1 - ln((1 + a)/a).
  const double a = 1e-3, integral = 1 / a - std::log((1 + a) / a);
  for (const SizeField &field : {triangle(a, 1 + a, a), triangle(1 + a, a, a), triangle(a, a, 1 + a)})
    EXPECT_NEAR(expected_cells(field), 4 / std::sqrt(3.) * integral, 1e-9 * integral);
}

TEST(SizeField, BoxHasTheSidesOfAnyBox)
{
  for (const std::string element : all_elements) {
    const MeshData mesh = made(box(element), rings(.3, 2, 1e-3, 3, [](double x, double y) {
                                 return std::min(.3, 1e-3 + .3 * std::hypot(x - .3, y - 2));
                               }));
    ASSERT_EQ(mesh.sides.size(), 4u);
    const char *const names[] = {"left", "right", "bottom", "top"};
    const int direction[] = {0, 0, 1, 1};
    const double place[] = {-1, 1, 2, 3}, lengths[] = {1, 1, 2, 2};
    for (int s = 0; s < 4; ++s) {
      EXPECT_EQ(mesh.sides[s].name, names[s]);
      EXPECT_NEAR(length(mesh, s), lengths[s], 1e-14);
      for (std::size_t f = 0; f < mesh.sides[s].cell.size(); ++f)
        for (const int local : mesh.element.facets()[mesh.sides[s].ordinal[f]])
          EXPECT_EQ(
              mesh.coords[2 * mesh.cells[mesh.sides[s].cell[f] * mesh.element.num_nodes() + local] + direction[s]],
              place[s]);
    }
    for (const double x : {-1, 1})
      for (const double y : {2, 3}) {
        int at_corner = 0;
        for (int n = 0; n < mesh.num_nodes(); ++n)
          at_corner += mesh.coords[2 * n] == x && mesh.coords[2 * n + 1] == y ? 1 : 0;
        EXPECT_EQ(at_corner, 1);
      }
  }
}

/// A ring between circles of radius 1 and 2, in two halves, with cell sizes of its own of all kinds.
std::string ring(const std::string &more)
{
  return "Point(1) = {0, 0, 0, 1e-4};\n"
         "For k In {0:1}\n"
         "  r = 1 + k;\n"
         "  Point(10 + 10 * k) = {r, 0, 0, 1e-4}; Point(11 + 10 * k) = {0, r, 0, 1e-4};\n"
         "  Point(12 + 10 * k) = {-r, 0, 0, 1e-4}; Point(13 + 10 * k) = {0, -r, 0, 1e-4};\n"
         "  Circle(10 + 10 * k) = {10 + 10 * k, 1, 11 + 10 * k}; Circle(11 + 10 * k) = {11 + 10 * k, 1, 12 + 10 * k};\n"
         "  Circle(12 + 10 * k) = {12 + 10 * k, 1, 13 + 10 * k}; Circle(13 + 10 * k) = {13 + 10 * k, 1, 10 + 10 * k};\n"
         "EndFor\n"
         "Line(1) = {10, 20}; Line(2) = {12, 22};\n"
         "Curve Loop(1) = {1, 20, 21, -2, -11, -10}; Plane Surface(1) = {1};\n"
         "Curve Loop(2) = {2, 22, 23, -1, -13, -12}; Plane Surface(2) = {2};\n"
         "Physical Surface(\"upper\", 1) = {1}; Physical Surface(\"lower\", 2) = {2};\n"
         "Physical Curve(\"outer\", 3) = {20:23}; Physical Curve(\"inner\", 4) = {10:13};\n"
         "Field[1] = MathEval; Field[1].F = \"1e-4\"; Background Field = 1;\n"
         "Mesh.MeshSizeMax = 1e-3; Mesh.MeshSizeFactor = .01; MeshSizeFromBoundary Surface{1} = 1;\n" +
         more;
}

TEST(SizeField, RecombinesNothingWhereSimplicesAreAskedFor)
{
  const Sizes field = rings(0, -2, .01, 5, [](double, double) { return .3; });
  const ScratchFile file("ring.geo", ring("Recombine Surface {1, 2};\n"));
  GmshOptions options{file.path(), .1, 2};
  EXPECT_EQ(made(options, field).element.name(), "Q2");
  options.simplices = true;
  EXPECT_EQ(made(options, field).element.name(), "P2");
}

TEST(SizeField, GeoKeepsCirclesNamesAndBlocks)
{
  const Size size = [](const double x, const double y) { return std::min(.4, .02 + .3 * std::hypot(x, y + 2)); };
  const Sizes field = rings(0, -2, .01, 5, size);
  for (const std::string element : all_elements) {
    SCOPED_TRACE(element);
    const ScratchFile file("ring.geo", ring(element[0] == 'Q' ? "Recombine Surface {1, 2};\n" : "\n"));
    const MeshData mesh = made(GmshOptions{file.path(), .1, element[1] - '0'}, field);
    EXPECT_EQ(mesh.element.name(), element);
    EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"upper", "lower"}));
    ASSERT_EQ(mesh.sides.size(), 2u);
    EXPECT_EQ(mesh.sides[0].name, "outer");
    EXPECT_EQ(mesh.sides[1].name, "inner");
    for (int s = 0; s < 2; ++s)
      for (std::size_t f = 0; f < mesh.sides[s].cell.size(); ++f)
        for (const int local : mesh.element.facets()[mesh.sides[s].ordinal[f]]) {
          const double *const x =
              &mesh.coords[2 * mesh.cells[mesh.sides[s].cell[f] * mesh.element.num_nodes() + local]];
          EXPECT_NEAR(std::hypot(x[0], x[1]), 2 - s, 1e-13);
        }
    EXPECT_NEAR(length(mesh, 0), 4 * pi, .05);
    for (int c = 0; c < mesh.num_cells(); ++c) {
      double y = 0;
      for (int v = 0; v < mesh.element.num_vertices(); ++v)
        y += mesh.coords[2 * mesh.cells[c * mesh.element.num_nodes() + v] + 1];
      EXPECT_EQ(mesh.block[c], y > 0 ? 0 : 1);
    }
    EXPECT_NEAR(mean_ratio(mesh, size), 1, .3);
  }
}

TEST(SizeField, CurvatureThatAGeoAsksForStays)
{
  const ScratchFile file("ring.geo", ring("Mesh.MeshSizeFromCurvature = 40;\n"));
  const MeshData mesh = made(GmshOptions{file.path(), 1, 1}, constant(.5));
  EXPECT_NEAR(static_cast<double>(mesh.sides[1].cell.size()), 44, 8); // each of four arcs has a cell or two too many
}

TEST(SizeField, TakesTheNearestSizeOutsideItsMesh)
{
  const Sizes field = std::make_shared<SizeField>(SizeField{{-1, 2, -.9, 2, -1, 2.1}, {0, 1, 2}, {.1, .2, .1}});
  EXPECT_NEAR(mean_ratio(made(box("P1"), field),
                         [](const double x, const double y) {
                           const double t = std::clamp((x + 1 - (y - 2) + .1) / .2, 0., 1.); // along the slanted side
                           return .1 + .1 * t;
                         }),
              1, .15);
}

TEST(SizeField, ReplacesTheOneBefore)
{
  const auto first = with_sizes(box("P2"), constant(.3)), second = with_sizes(*first, constant(.2));
  expect_same_mesh(read_gmsh(std::get<GmshOptions>(*second)), made(box("P2"), constant(.2)), "box");
  EXPECT_LT(read_gmsh(std::get<GmshOptions>(coarser(*second, 3).value())).num_cells(),
            read_gmsh(std::get<GmshOptions>(*first)).num_cells());
}

TEST(SizeField, EqualOptionsGiveEqualMeshesBitByBit)
{
  const Sizes field = rings(-1, 2, 1e-4, 3, [](const double x, const double y) {
    return std::min(.2, 1e-4 + .25 * std::hypot(x + 1, y - 2));
  });
  const MeshData mesh = made(box("P2"), field);
  made(box("Q2"), constant(.2)); // leaves no trace
  EXPECT_EQ(made(box("P2"), field).coords, mesh.coords);
  double sum = std::accumulate(mesh.coords.begin(), mesh.coords.end(), 0.), others = sum;
  Teuchos::broadcast(*Tpetra::getDefaultComm(), 0, 1, &others); // of another process
  EXPECT_EQ(sum, others);
}

TEST(SizeField, Refusals)
{
  EXPECT_FALSE(with_sizes(GmshOptions{"body.msh", 1, 0}, constant(1)));
  const auto refused = [](const SizeField &field, const std::initializer_list<std::string> &parts) {
    expect_error(ExitCode::bad_mesh, parts, [&] { made(box("P1"), std::make_shared<SizeField>(field)); });
  };
  const double nan = std::nan("");
  refused({{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {1e-300, 1e-300, 1}}, {"mesh: box: ", "too small", "at most 5e+06"});
  refused({{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {1e-5, 1e-5, 1e-5}}, {"too small", "1.1547e+10 cells"});
  refused({{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {1, 0, 1}}, {"must be > 0", "got 0"});
  refused({{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {1, nan, 1}}, {"must be > 0", "nan"});
  refused({{0, 0, nan, 0, 0, 1}, {0, 1, 2}, {1, 1, 1}}, {"finite coordinates"});
  refused({{0, 0, 1, 0, 0, 1}, {0, 1, 3}, {1, 1, 1}}, {"one triangle or tetrahedron or more, of its nodes"});
  refused({{}, {}, {}}, {"one triangle or tetrahedron or more"});
}

TEST(SizeField, RefusesAGeoThatFixesItsDivision)
{
  const std::string square = "Point(1) = {0, 0, 0, .5}; Point(2) = {1, 0, 0, .5}; Line(1) = {1, 2};\n";
  const auto refused = [](const std::string &text) {
    const ScratchFile file("fixed.geo", text + "Physical Surface(\"body\") = {Surface{:}};\n");
    expect_error(ExitCode::bad_mesh, {"fixed.geo\": gmsh: curve ", "Transfinite or Layers", "nested"}, [&] {
      made(GmshOptions{file.path(), 1, 1}, constant(.1));
    });
  };
  refused(square + "Extrude {0, 1, 0} { Line{1}; Layers{3}; }\n");
  refused(square + "Extrude {0, 1, 0} { Line{1}; }\nTransfinite Curve {1} = 4;\n");
}

TEST(SizeField, MakeMeshDealsItOut)
{
  const auto comm = Tpetra::getDefaultComm();
  const Sizes field = comm->getRank() == 0 ? constant(.1) : nullptr;
  const auto mesh = make_mesh(with_sizes(box("P2"), field).value(), comm);
  int cells = 0;
  Teuchos::reduceAll<int, int>(*comm, Teuchos::REDUCE_SUM, mesh.num_owned_cells, Teuchos::outArg(cells));
  EXPECT_NEAR(cells, 2 * 4 / std::sqrt(3.) / .01, 100);
  const Sizes absurd = comm->getRank() == 0 ? constant(1e-9) : nullptr;
  expect_error(ExitCode::bad_mesh, "too small", [&] { make_mesh(with_sizes(box("P2"), absurd).value(), comm); });
}

/// Numbers of the running programs of that name whose parent is this process: MPI may have children of its own.
std::vector<pid_t> programs()
{
  std::vector<pid_t> result;
  std::ifstream children("/proc/self/task/" + std::to_string(::getpid()) + "/children");
  for (pid_t child; children >> child;) {
    std::string name;
    std::ifstream("/proc/" + std::to_string(child) + "/comm") >> name;
    if (name == "rpc_gmsh") result.push_back(child);
  }
  return result;
}

TEST(SizeField, OneProgramMakesAllMeshesAndANewOneComesWhenItIsKilled)
{
  const MeshData mesh = made(box("P1"), constant(.2));
  const auto before = programs();
  ASSERT_EQ(before.size(), 1u);
  EXPECT_EQ(made(box("P1"), constant(.2)).coords, mesh.coords);
  EXPECT_EQ(programs(), before);
  ::kill(before[0], SIGKILL);
  ::usleep(50000);
  EXPECT_EQ(made(box("P1"), constant(.2)).coords, mesh.coords);
  EXPECT_EQ(programs().size(), 1u);
  EXPECT_NE(programs(), before);
}

/// Whether a process is there, and more than what its parent has yet to take note of.
bool runs(const pid_t process)
{
  std::string number, name, state;
  std::ifstream("/proc/" + std::to_string(process) + "/stat") >> number >> name >> state;
  return !state.empty() && state != "Z";
}

TEST(SizeField, TheProgramEndsWithTheProcessThatStartedIt)
{
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0); // inherited by the program, were it not to close what it inherits
  const pid_t child = ::fork();
  if (child == 0) {
    made(box("P1"), constant(.3));
    const auto mine = programs();
    if (mine.size() == 1 && ::write(ends[1], &mine[0], sizeof(pid_t)) > 0) ::pause();
    ::_exit(1);
  }
  ::close(ends[1]);
  pid_t program = 0;
  ASSERT_EQ(::read(ends[0], &program, sizeof program), ssize_t(sizeof program));
  EXPECT_TRUE(runs(program));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  char byte = 0;
  EXPECT_EQ(::read(ends[0], &byte, 1), 0) << "somebody holds the other end";
  ::close(ends[0]);
  for (int wait = 0; runs(program) && wait < 500; ++wait) ::usleep(10000);
  EXPECT_FALSE(runs(program));
  EXPECT_GT(made(box("P1"), constant(.3)).num_cells(), 0) << "the program of this process is there still";
}

} // namespace
} // namespace size_field_test
