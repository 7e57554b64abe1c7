// SPDX-License-Identifier: BSD-3-Clause
#include "size_plan.hpp"

#include "rpc/adapt/rules.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <utility>

namespace rpc::adapt
{
namespace
{

// The lowest exponents of elastic bodies: those of cracks.
constexpr double least_exponent = 0.5;
// Exponents are rounded to steps of 1 over this, lest last digits decide which of two like vertices is singular; sizes to steps of 2 to the
// power of 1 over this, lest the last digits of an estimate change a mesh; and an error below this part of what is asked for makes no singularity.
struct SizeRounding {
  static constexpr double exponent_steps = 256, steps_per_octave = 64, negligible_share = 1e-6;
};

/// The simplices that a cell is cut into, by its vertices.
const std::vector<std::vector<int>> &parts_of(const EstimatedMesh &mesh)
{
  static const std::vector<std::vector<int>> triangle{{0, 1, 2}}, quadrilateral{{0, 1, 2}, {0, 2, 3}},
      tetrahedron{{0, 1, 2, 3}},
      hexahedron{{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  if (mesh.dim == 2) return mesh.simplices() ? triangle : quadrilateral;
  return mesh.simplices() ? tetrahedron : hexahedron;
}

/// Area or volume of a simplex of a cell, with its sign. Far from the origin that needs differences.
double signed_measure(const EstimatedMesh &mesh, const int cell, const std::vector<int> &part)
{
  const int *const v = mesh.vertices_of(cell);
  const double *const first = mesh.at(v[part[0]]);
  double arm[3][3] = {};
  for (int a = 0; a < mesh.dim; ++a)
    for (int i = 0; i < mesh.dim; ++i) arm[a][i] = mesh.at(v[part[a + 1]])[i] - first[i];
  if (mesh.dim == 2) return (arm[0][0] * arm[1][1] - arm[0][1] * arm[1][0]) / 2;
  double six_volumes = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    six_volumes += arm[0][i] * (arm[1][j] * arm[2][k] - arm[1][k] * arm[2][j]);
  }
  return six_volumes / 6;
}

struct Geometry {
  std::vector<double> measure, length;       // (cells) area or volume [m^dim]; edge of gmsh's cell of the same size [m]
  std::vector<std::array<double, 3>> centre; // (cells) [m]
  std::vector<std::vector<int>> around;      // (nodes) cells
  std::vector<char> boundary;                // (nodes) vertices on it

  explicit Geometry(const EstimatedMesh &mesh)
      : measure(mesh.num_cells()), length(mesh.num_cells()), centre(mesh.num_cells()), around(mesh.num_nodes()),
        boundary(mesh.num_nodes())
  {
    for (int cell = 0; cell < mesh.num_cells(); ++cell) {
      for (int a = 0; a < mesh.vertices; ++a) {
        const int n = mesh.vertices_of(cell)[a];
        for (int i = 0; i < mesh.dim; ++i) centre[cell][i] += mesh.at(n)[i] / mesh.vertices;
        around[n].push_back(cell);
      }
      for (const auto &part : parts_of(mesh)) measure[cell] += signed_measure(mesh, cell, part);
      measure[cell] = std::abs(measure[cell]);
      length[cell] = mesh.dim == 2 ? std::sqrt(measure[cell] * (mesh.vertices == 3 ? 4 / std::sqrt(3.) : 1))
                                   : std::cbrt(measure[cell] / mesh.cells_per_cell() * mesh::tetrahedra_per_cube);
    }
    const mesh::Element element{mesh.dim, 1, mesh.simplices() ? mesh::Shape::simplex : mesh::Shape::tensor};
    const mesh::Entities facets = mesh::facets_of(element, mesh.cells);
    for (int f = 0; f < facets.size(); ++f)
      for (int a = 0; a < facets.num_vertices && facets.num_cells_at(f) == 1; ++a)
        boundary[facets.vertices[facets.num_vertices * std::size_t(f) + a]] = 1;
  }
};

/// Cells that come of one whose size changes by this ratio.
double cells_at(const double ratio, const int dim)
{
  return 1 / (dim == 2 ? ratio * ratio : ratio * ratio * ratio);
}

/// What ratios of sizes to those at hand come to.
struct Prediction {
  double squared = 0, cells = 0;
};

/// Ratio of the new size of a smooth cell to its size, for a level c that is common to all.
double ratio_of(const EstimatedMesh &mesh, const int cell, const double level, const double most)
{
  const double squared = mesh.squared[cell];
  return squared > 0 ? std::clamp(std::pow(level / squared, 1. / (2 * mesh.order + mesh.dim)),
                                  double(size_rules.least_ratio), most)
                     : most;
}

/// Cells at singular vertices count by their number only: grading leaves little of their error.
Prediction predict(const EstimatedMesh &mesh, const std::vector<char> &at_singularity, const double level,
                   const double max_growth)
{
  Prediction p;
  for (int cell = 0; cell < mesh.num_cells(); ++cell) {
    const double ratio = ratio_of(mesh, cell, level, max_growth);
    if (mesh.dim == 3 || !at_singularity[cell]) p.squared += mesh.squared[cell] * std::pow(ratio, 2 * mesh.order);
    p.cells += mesh.cells_per_cell() * cells_at(ratio, mesh.dim);
  }
  return p;
}

/// The greatest level that keeps the bound on the squared error, or a greater one that keeps the bound on the number of cells.
double level_for(const EstimatedMesh &mesh, const std::vector<char> &at_singularity, const SizeRequest &request)
{
  const double most = *std::max_element(mesh.squared.begin(), mesh.squared.end());
  if (!(most > 0)) return 0;
  double low = std::log(most) - 200, high = std::log(most) + 100;
  for (int k = 0; k < 70; ++k) {
    const double middle = (low + high) / 2;
    const Prediction p = predict(mesh, at_singularity, std::exp(middle), request.max_growth);
    (p.squared <= request.squared_error || p.cells > request.max_cells ? low : high) = middle;
  }
  return std::exp(low);
}

double distance(const EstimatedMesh &mesh, const int n, const double *x)
{
  const double *const at = mesh.at(n);
  if (mesh.dim == 2) return std::hypot(at[0] - x[0], at[1] - x[1]);
  return std::hypot(at[0] - x[0], at[1] - x[1], at[2] - x[2]);
}

/// Sizes that grow from any vertex by no more than the gradation allows.
void limit_growth(const EstimatedMesh &mesh, const Geometry &geometry, std::vector<double> &size)
{
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (int n = 0; n < mesh.num_nodes(); ++n)
    if (!geometry.around[n].empty()) queue.emplace(size[n], n);
  while (!queue.empty()) {
    const auto [least, n] = queue.top();
    queue.pop();
    if (least > size[n]) continue;
    for (const int cell : geometry.around[n])
      for (int a = 0; a < mesh.vertices; ++a) {
        const int m = mesh.vertices_of(cell)[a];
        const double bound = least + size_rules.gradation * distance(mesh, m, mesh.at(n));
        if (bound < size[m]) queue.emplace(size[m] = bound, m);
      }
  }
}

/// Slope of the line through points by least squares.
class Fit
{
public:
  void add(const double x, const double y)
  {
    sum_[0] += 1;
    sum_[1] += x;
    sum_[2] += y;
    sum_[3] += x * x;
    sum_[4] += x * y;
  }
  /// 0 where the points do not tell.
  double slope() const
  {
    const double spread = sum_[0] * sum_[3] - sum_[1] * sum_[1];
    return spread > size_rules.telling_spread * sum_[0] * sum_[0] ? (sum_[0] * sum_[4] - sum_[1] * sum_[2]) / spread
                                                                  : 0;
  }

private:
  double sum_[5] = {};
};

/// What errors are divided by to tell of |u| alone: |T| h_T^2p.
double error_scale(const EstimatedMesh &mesh, const Geometry &geometry, const int cell)
{
  return geometry.measure[cell] * std::pow(geometry.length[cell], 2 * mesh.order);
}

/// @param negligible  a squared error of the whole mesh. Errors of cells that would add up to less, if they were the same
///                    everywhere, tell no exponent: they are rounding, and differ between ranks.
std::vector<double> local_exponents(const EstimatedMesh &mesh, const Geometry &geometry, const double negligible)
{
  double scale = 0;
  for (int cell = 0; cell < mesh.num_cells(); ++cell) scale += error_scale(mesh, geometry, cell);
  const double least = negligible / scale;
  std::vector<double> exponent(mesh.num_nodes(), mesh.order + 1.);
  std::vector<int> seen(mesh.num_cells(), -1);
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    if (!geometry.boundary[n]) continue;
    Fit fit;
    std::vector<int> ring = geometry.around[n];
    for (const int cell : ring) seen[cell] = n;
    for (int k = 0; k < (mesh.dim == 2 ? size_rules.rings : size_rules.rings_in_space); ++k) {
      std::vector<int> next;
      for (const int cell : ring) {
        const double density = mesh.squared[cell] / error_scale(mesh, geometry, cell) + least;
        if (density > 0) fit.add(std::log(distance(mesh, n, geometry.centre[cell].data())), std::log(density) / 2);
        for (int a = 0; a < mesh.vertices; ++a)
          for (const int other : geometry.around[mesh.vertices_of(cell)[a]])
            if (seen[other] != n) {
              seen[other] = n;
              next.push_back(other);
            }
      }
      ring = std::move(next);
    }
    exponent[n] += std::round(fit.slope() * SizeRounding::exponent_steps) / SizeRounding::exponent_steps;
  }
  return exponent;
}

/// The field with the vertices' sizes, but for cells at singular vertices.
class FieldMaker
{
public:
  FieldMaker(const EstimatedMesh &mesh, const std::vector<double> &size, const std::vector<double> &exponent)
      : mesh_(mesh), size_(size), exponent_(exponent), index_(mesh.num_nodes(), -1)
  {
    for (const int n : mesh.cells)
      if (index_[n] < 0) index_[n] = add(mesh.at(n), size[n]);
    field_.dim = mesh.dim;
  }

  /// Of simplices, in the plane with strips towards singular vertices. In space sizes are linear there: along a line of them strips would
  /// be many, and the next mesh shows more.
  mesh::SizeField make(const std::vector<char> &singular)
  {
    for (int cell = 0; cell < mesh_.num_cells(); ++cell)
      for (const auto &part : parts_of(mesh_)) {
        std::vector<int> corner;
        for (const int a : part) corner.push_back(mesh_.vertices_of(cell)[a]);
        for (int k = 0; mesh_.dim == 2 && k < 3 && !singular[corner[0]]; ++k)
          std::rotate(corner.begin(), corner.begin() + 1, corner.end());
        if (mesh_.dim == 2 && singular[corner[0]])
          add_graded(corner[0], corner[1], corner[2]);
        else
          for (const int n : corner) field_.simplices.push_back(index_[n]);
      }
    return std::move(field_);
  }

private:
  int add(const double *x, const double size)
  {
    field_.coords.insert(field_.coords.end(), x, x + mesh_.dim);
    field_.size.push_back(
        std::exp2(std::round(std::log2(size) * SizeRounding::steps_per_octave) / SizeRounding::steps_per_octave));
    return static_cast<int>(field_.size.size()) - 1;
  }

  /// A point that lies at a share t of the way from a singular vertex to another one.
  int add_between(const int vertex, const int other, const double t)
  {
    const double *const x = mesh_.at(vertex), *const y = mesh_.at(other);
    const double at[2] = {x[0] + t * (y[0] - x[0]), x[1] + t * (y[1] - x[1])};
    const double beta = 1 - exponent_[vertex] / (mesh_.order + 1);
    const double grown = size_[vertex] + size_rules.gradation * t * distance(mesh_, vertex, y);
    return add(at, std::min(grown, std::max(size_[vertex], size_[other] * std::pow(t, beta))));
  }

  /// Strips that halve in width towards a singular vertex.
  void add_graded(const int vertex, const int a, const int b)
  {
    const double least =
        size_[vertex] / std::max(distance(mesh_, vertex, mesh_.at(a)), distance(mesh_, vertex, mesh_.at(b)));
    int outer[2] = {index_[a], index_[b]};
    for (double t = 0.5; t > least / 2; t /= 2) {
      const int inner[2] = {add_between(vertex, a, t), add_between(vertex, b, t)};
      field_.simplices.insert(field_.simplices.end(), {inner[0], outer[0], outer[1], inner[0], outer[1], inner[1]});
      std::copy(inner, inner + 2, outer);
    }
    field_.simplices.insert(field_.simplices.end(), {index_[vertex], outer[0], outer[1]});
  }

  const EstimatedMesh &mesh_;
  const std::vector<double> &size_, &exponent_;
  std::vector<int> index_; // of vertices in the field
  mesh::SizeField field_;
};

/// Sizes where the solution is smooth: the mean over the cells around a vertex that lie at no singular one, if there are any.
std::vector<double> smooth_sizes(const EstimatedMesh &mesh, const Geometry &geometry,
                                 const std::vector<char> &at_singularity, const double level, const double max_growth)
{
  std::vector<double> size(mesh.num_nodes(), 0);
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    double sum[2] = {}, count[2] = {};
    for (const int cell : geometry.around[n]) {
      sum[int(at_singularity[cell])] += std::log(geometry.length[cell] * ratio_of(mesh, cell, level, max_growth));
      ++count[int(at_singularity[cell])];
    }
    const int kind = count[0] > 0 ? 0 : 1;
    if (count[kind] > 0) size[n] = std::exp(sum[kind] / count[kind]);
  }
  return size;
}

/// Size at a singular vertex: where sizes that fall like r^(2 (p + 1 - lambda) / (2p + dim)) from those around it come down to the
/// distance r itself, or less if the cells there err by more than those elsewhere are to.                     (10.6)
double vertex_size(const EstimatedMesh &mesh, const Geometry &geometry, const int vertex, const double exponent,
                   const std::vector<char> &singular, const std::vector<double> &size, const double level)
{
  double ratio = 0, reach = 0, count = 0; // means of log(size / distance) and log(distance) over the vertices around
  double squared = 0;
  for (const int cell : geometry.around[vertex]) {
    squared += mesh.squared[cell];
    for (int a = 0; a < mesh.vertices; ++a) {
      const int n = mesh.vertices_of(cell)[a];
      if (singular[n]) continue;
      const double r = distance(mesh, vertex, mesh.at(n));
      ratio += std::log(size[n] / r);
      reach += std::log(r);
      ++count;
    }
  }
  if (count == 0) return size[vertex];
  const double decay = 2 * exponent + mesh.dim - 2; // of the squared error of a cell at the vertex with its size
  const double graded = std::exp(std::min(0., ratio / count) * (2 * mesh.order + mesh.dim) / decay);
  const double allowed = level * geometry.around[vertex].size();
  const double equal = squared > allowed ? std::pow(allowed / squared, 1 / decay) : 1;
  return std::exp(reach / count) * std::max<double>(std::min(graded, equal), mesh.dim == 2
                                                                                 ? size_rules.least_vertex_ratio
                                                                                 : size_rules.least_ratio);
}

/// Where the exponent is that of a singularity, and no vertex nearby has a lower one, or the same and a lower number. In space, where
/// singular vertices make lines, exponents that differ by a little count as the same, and all of them are singular.
std::vector<char> singular_vertices(const EstimatedMesh &mesh, const Geometry &geometry,
                                    const std::vector<double> &exponent)
{
  std::vector<char> singular(mesh.num_nodes(), 0);
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    singular[n] = exponent[n] < mesh.order - size_rules.margin;
    for (const int cell : geometry.around[n])
      for (int a = 0; a < mesh.vertices && singular[n]; ++a) {
        const int m = mesh.vertices_of(cell)[a];
        const bool stronger = mesh.dim == 2 ? exponent[m] < exponent[n] || (exponent[m] == exponent[n] && m < n)
                                            : exponent[m] < exponent[n] - size_rules.same_in_space;
        if (stronger) singular[n] = 0;
      }
  }
  return singular;
}

} // namespace

std::vector<double> local_exponents(const EstimatedMesh &mesh, const double negligible)
{
  return local_exponents(mesh, Geometry(mesh), negligible);
}

namespace
{

/// The squared error that sizes at the vertices bring about. They are smaller than (10.5) wants them where they must not grow too fast, which in
/// space is much of the body. What singular vertices have counts for no more than all the rest: the next mesh shows more of it. (10.5a)
double squared_error_of(const EstimatedMesh &mesh, const Geometry &geometry, const std::vector<double> &size,
                        const std::vector<double> &exponent, const std::vector<char> &singular)
{
  double smooth = 0, at_singularities = 0;
  for (int cell = 0; cell < mesh.num_cells(); ++cell) {
    double mean = 0, slowest = 0; // of the logarithm of the ratio of sizes; of the squared error at singular vertices
    for (int a = 0; a < mesh.vertices; ++a) {
      const int n = mesh.vertices_of(cell)[a];
      const double ratio = size[n] / geometry.length[cell];
      mean += std::log(ratio) / mesh.vertices;
      if (singular[n]) slowest = std::max(slowest, std::pow(ratio, 2 * exponent[n]));
    }
    const double as_smooth = std::exp(2 * mesh.order * mean);
    (slowest > as_smooth ? at_singularities : smooth) += mesh.squared[cell] * std::max(slowest, as_smooth);
  }
  return smooth + std::min(smooth, at_singularities);
}

/// Where contact that is unseen in a cell is more by itself than the error that the next mesh is to have, its vertices get the size that
/// sees it: the mean over the cells around them would ask for little. (10.4b)
/// @param times  that size, where a mesh that sees the contact would have too many cells
/// @return whether a size is smaller for it
bool see_contact(const EstimatedMesh &mesh, const double squared_error, const double times, std::vector<double> &size)
{
  bool smaller = false;
  for (std::size_t cell = 0; cell < mesh.unseen_squared.size(); ++cell)
    for (int a = 0; a < mesh.vertices && mesh.unseen_squared[cell] > squared_error; ++a) {
      double &at_vertex = size[mesh.vertices_of(static_cast<int>(cell))[a]];
      smaller = smaller || times * mesh.seen_from[cell] < at_vertex;
      at_vertex = std::min(at_vertex, times * mesh.seen_from[cell]);
    }
  return smaller;
}

} // namespace

SizePlan plan_sizes(const EstimatedMesh &mesh, const SizeRequest &request)
{
  const Geometry geometry(mesh);
  std::vector<double> exponent =
      local_exponents(mesh, geometry, SizeRounding::negligible_share * request.squared_error);
  const std::vector<char> singular = singular_vertices(mesh, geometry, exponent);
  std::vector<char> at_singularity(mesh.num_cells(), 0);
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    exponent[n] = std::max(exponent[n], least_exponent);
    for (const int cell : geometry.around[n])
      if (singular[n]) at_singularity[cell] = 1;
  }
  double level = level_for(mesh, at_singularity, request), seen_times = 1;
  for (int corrections = mesh.dim == 2 ? 0 : size_rules.most_corrections;; --corrections) {
    std::vector<double> size = smooth_sizes(mesh, geometry, at_singularity, level, request.max_growth);
    for (int n = 0; n < mesh.num_nodes(); ++n)
      if (singular[n]) size[n] = vertex_size(mesh, geometry, n, exponent[n], singular, size, level);
    const bool sees = see_contact(mesh, request.squared_error, seen_times, size);
    limit_growth(mesh, geometry, size);
    const double excess =
        corrections > 0 ? request.squared_error / squared_error_of(mesh, geometry, size, exponent, singular) : 1;
    if (excess > size_rules.most_above || 1 / excess > size_rules.most_above) {
      level *=
          std::pow(excess, 1 + mesh.dim / (2. * mesh.order)); // cells of equal errors: eta^2 ~ level^(2p / (2p + dim))
      continue;
    }
    SizePlan plan{FieldMaker(mesh, size, exponent).make(singular), 0};
    plan.cells = mesh::expected_cells(plan.field) / (mesh.dim == 3 || mesh.simplices() ? 1 : 4 / std::sqrt(3.));
    const double least = mesh.num_cells() * mesh.cells_per_cell() / std::pow(request.max_growth, mesh.dim) * 1.0001;
    const bool coarsest = predict(mesh, at_singularity, level, request.max_growth).cells <= least;
    if (plan.cells <= request.max_cells || (coarsest && (!sees || plan.cells <= request.most_cells))) return plan;
    const double step = size_rules.level_step;
    level *= step; // grading adds cells, which the prediction leaves out
    if (plan.cells > request.most_cells) seen_times *= std::pow(step, 1. / (2 * mesh.order + mesh.dim)); // as (10.5)
  }
}

} // namespace rpc::adapt
