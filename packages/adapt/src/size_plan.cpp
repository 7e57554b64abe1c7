#include "size_plan.hpp"

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

// From one mesh to the next a cell of a smooth solution shrinks by no more: the estimate knows no better.
constexpr double least_ratio = 0.1;
// The same at a singular vertex, where cells shrink towards a point and cost little.
constexpr double least_vertex_ratio = 1e-4;
// Growth of sizes with the distance: neighbours differ by about half.
constexpr double gradation = 0.4;
// Rings of cells about a vertex that tell its exponent.
constexpr int rings = 4;
// A vertex is singular if its exponent falls that much short of the order of the elements.
constexpr double margin = 0.25;
// The lowest exponents of elastic bodies: cracks.
constexpr double least_exponent = 0.5;
// Exponents are rounded to steps of 1 over this, lest last digits decide which of two like vertices is singular.
constexpr double exponent_steps = 256;
// The part of the error asked for that makes no singularity.
constexpr double negligible_share = 1e-6;
// Sizes are rounded to steps of this factor, lest the last digits of an estimate change a mesh.
constexpr double steps_per_octave = 64;

struct Geometry {
  std::vector<double> area, length;          // (cells) [m^2], [m]: edge of the equilateral cell of the same area
  std::vector<std::array<double, 2>> centre; // (cells) [m]
  std::vector<std::vector<int>> around;      // (nodes) cells
  std::vector<char> boundary;                // (nodes) vertices on it

  explicit Geometry(const EstimatedMesh &mesh)
      : area(mesh.num_cells()), length(mesh.num_cells()), centre(mesh.num_cells()), around(mesh.num_nodes()),
        boundary(mesh.num_nodes())
  {
    const int nv = mesh.vertices;
    std::map<std::pair<int, int>, int> edges;
    for (int cell = 0; cell < mesh.num_cells(); ++cell) {
      const double *const first = &mesh.coords[2 * mesh.cells[nv * cell]]; // far from the origin areas need differences
      for (int a = 0; a < nv; ++a) {
        const int n = mesh.cells[nv * cell + a], m = mesh.cells[nv * cell + (a + 1) % nv];
        const double *x = &mesh.coords[2 * n], *y = &mesh.coords[2 * m];
        area[cell] += ((x[0] - first[0]) * (y[1] - first[1]) - (x[1] - first[1]) * (y[0] - first[0])) / 2;
        for (int i = 0; i < 2; ++i) centre[cell][i] += x[i] / nv;
        around[n].push_back(cell);
        ++edges[std::minmax(n, m)];
      }
      area[cell] = std::abs(area[cell]);
      length[cell] = std::sqrt(area[cell] * (nv == 3 ? 4 / std::sqrt(3.) : 1));
    }
    for (const auto &[edge, count] : edges)
      if (count == 1) boundary[edge.first] = boundary[edge.second] = 1;
  }
};

/// What ratios of sizes to those at hand come to.
struct Prediction {
  double squared = 0, cells = 0;
};

/// Ratio of the new size of a smooth cell to its size, for a level c that is common to all.
double ratio_of(const double squared, const double level, const int order, const double most)
{
  return squared > 0 ? std::clamp(std::pow(level / squared, 1. / (2 * order + 2)), least_ratio, most) : most;
}

/// Cells at singular vertices count by their number only: grading leaves little of their error.
Prediction predict(const EstimatedMesh &mesh, const std::vector<char> &at_singularity, const double level,
                   const double max_growth)
{
  Prediction p;
  for (int cell = 0; cell < mesh.num_cells(); ++cell) {
    const double squared = mesh.squared[cell], ratio = ratio_of(squared, level, mesh.order, max_growth);
    if (!at_singularity[cell]) p.squared += squared * std::pow(ratio, 2 * mesh.order);
    p.cells += 1 / (ratio * ratio);
  }
  return p;
}

/// The greatest level that keeps the bound on the squared error, or a greater one that keeps to so many cells.
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
  return std::hypot(mesh.coords[2 * n] - x[0], mesh.coords[2 * n + 1] - x[1]);
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
        const int m = mesh.cells[mesh.vertices * cell + a];
        const double bound = least + gradation * distance(mesh, m, &mesh.coords[2 * n]);
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
    return spread > 0.05 * sum_[0] * sum_[0] ? (sum_[0] * sum_[4] - sum_[1] * sum_[2]) / spread : 0;
  }

private:
  double sum_[5] = {};
};

/// What errors are divided by to tell of |u| alone: eta_T^2 / (|T| h_T^2p).
double error_scale(const EstimatedMesh &mesh, const Geometry &geometry, const int cell)
{
  return geometry.area[cell] * std::pow(geometry.length[cell], 2 * mesh.order);
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
    for (int k = 0; k < rings; ++k) {
      std::vector<int> next;
      for (const int cell : ring) {
        const double density = mesh.squared[cell] / error_scale(mesh, geometry, cell) + least;
        if (density > 0) fit.add(std::log(distance(mesh, n, geometry.centre[cell].data())), std::log(density) / 2);
        for (int a = 0; a < mesh.vertices; ++a)
          for (const int other : geometry.around[mesh.cells[mesh.vertices * cell + a]])
            if (seen[other] != n) {
              seen[other] = n;
              next.push_back(other);
            }
      }
      ring = std::move(next);
    }
    exponent[n] += std::round(fit.slope() * exponent_steps) / exponent_steps;
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
      if (index_[n] < 0) index_[n] = add(&mesh.coords[2 * n], size[n]);
  }

  mesh::SizeField make(const std::vector<char> &singular)
  {
    for (int cell = 0; cell < mesh_.num_cells(); ++cell) {
      const int *const v = &mesh_.cells[mesh_.vertices * cell];
      for (int a = 2; a < mesh_.vertices; ++a) {
        int corner[3] = {v[0], v[a - 1], v[a]};
        for (int k = 0; k < 3 && !singular[corner[0]]; ++k) std::rotate(corner, corner + 1, corner + 3);
        if (singular[corner[0]])
          add_graded(corner[0], corner[1], corner[2]);
        else
          field_.triangles.insert(field_.triangles.end(), {index_[corner[0]], index_[corner[1]], index_[corner[2]]});
      }
    }
    return std::move(field_);
  }

private:
  int add(const double *x, const double size)
  {
    field_.coords.insert(field_.coords.end(), {x[0], x[1]});
    field_.size.push_back(std::exp2(std::round(std::log2(size) * steps_per_octave) / steps_per_octave));
    return static_cast<int>(field_.size.size()) - 1;
  }

  /// A point that lies at a share t of the way from a singular vertex to another one.
  int add_between(const int vertex, const int other, const double t)
  {
    const double *const x = &mesh_.coords[2 * vertex], *const y = &mesh_.coords[2 * other];
    const double at[2] = {x[0] + t * (y[0] - x[0]), x[1] + t * (y[1] - x[1])};
    const double beta = 1 - exponent_[vertex] / (mesh_.order + 1);
    const double grown = size_[vertex] + gradation * t * distance(mesh_, vertex, y);
    return add(at, std::min(grown, std::max(size_[vertex], size_[other] * std::pow(t, beta))));
  }

  /// Strips that halve in width towards a singular vertex.
  void add_graded(const int vertex, const int a, const int b)
  {
    const double least = size_[vertex] / std::max(distance(mesh_, vertex, &mesh_.coords[2 * a]),
                                                  distance(mesh_, vertex, &mesh_.coords[2 * b]));
    int outer[2] = {index_[a], index_[b]};
    for (double t = 0.5; t > least / 2; t /= 2) {
      const int inner[2] = {add_between(vertex, a, t), add_between(vertex, b, t)};
      field_.triangles.insert(field_.triangles.end(), {inner[0], outer[0], outer[1], inner[0], outer[1], inner[1]});
      std::copy(inner, inner + 2, outer);
    }
    field_.triangles.insert(field_.triangles.end(), {index_[vertex], outer[0], outer[1]});
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
      sum[int(at_singularity[cell])] +=
          std::log(geometry.length[cell] * ratio_of(mesh.squared[cell], level, mesh.order, max_growth));
      ++count[int(at_singularity[cell])];
    }
    const int kind = count[0] > 0 ? 0 : 1;
    if (count[kind] > 0) size[n] = std::exp(sum[kind] / count[kind]);
  }
  return size;
}

/// Size at a singular vertex: where sizes that fall like r^(1 - lambda / (p + 1)) from those around it come down to the
/// distance r itself, or less if the cells there err by more than those elsewhere are to.
double vertex_size(const EstimatedMesh &mesh, const Geometry &geometry, const int vertex, const double exponent,
                   const std::vector<char> &singular, const std::vector<double> &size, const double level)
{
  double ratio = 0, reach = 0, count = 0; // means of log(size / distance) and log(distance) over the vertices around
  double squared = 0;
  for (const int cell : geometry.around[vertex]) {
    squared += mesh.squared[cell];
    for (int a = 0; a < mesh.vertices; ++a) {
      const int n = mesh.cells[mesh.vertices * cell + a];
      if (singular[n]) continue;
      const double r = distance(mesh, vertex, &mesh.coords[2 * n]);
      ratio += std::log(size[n] / r);
      reach += std::log(r);
      ++count;
    }
  }
  if (count == 0) return size[vertex];
  const double graded = std::exp(std::min(0., ratio / count) * (mesh.order + 1) / exponent);
  const double allowed = level * geometry.around[vertex].size();
  const double equal = squared > allowed ? std::pow(allowed / squared, 1 / (2 * exponent)) : 1;
  return std::exp(reach / count) * std::max(std::min(graded, equal), least_vertex_ratio);
}

/// Where the exponent is that of a singularity, and no vertex nearby has a lower one, or the same and a lower number.
std::vector<char> singular_vertices(const EstimatedMesh &mesh, const Geometry &geometry,
                                    const std::vector<double> &exponent)
{
  std::vector<char> singular(mesh.num_nodes(), 0);
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    singular[n] = exponent[n] < mesh.order - margin;
    for (const int cell : geometry.around[n])
      for (int a = 0; a < mesh.vertices; ++a)
        if (const int m = mesh.cells[mesh.vertices * cell + a];
            exponent[m] < exponent[n] || (exponent[m] == exponent[n] && m < n))
          singular[n] = 0;
  }
  return singular;
}

} // namespace

std::vector<double> local_exponents(const EstimatedMesh &mesh, const double negligible)
{
  return local_exponents(mesh, Geometry(mesh), negligible);
}

SizePlan plan_sizes(const EstimatedMesh &mesh, const SizeRequest &request)
{
  const Geometry geometry(mesh);
  std::vector<double> exponent = local_exponents(mesh, geometry, negligible_share * request.squared_error);
  const std::vector<char> singular = singular_vertices(mesh, geometry, exponent);
  std::vector<char> at_singularity(mesh.num_cells(), 0);
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    exponent[n] = std::max(exponent[n], least_exponent);
    for (const int cell : geometry.around[n])
      if (singular[n]) at_singularity[cell] = 1;
  }
  double level = level_for(mesh, at_singularity, request);
  for (;;) {
    std::vector<double> size = smooth_sizes(mesh, geometry, at_singularity, level, request.max_growth);
    for (int n = 0; n < mesh.num_nodes(); ++n)
      if (singular[n]) size[n] = vertex_size(mesh, geometry, n, exponent[n], singular, size, level);
    limit_growth(mesh, geometry, size);
    SizePlan plan{FieldMaker(mesh, size, exponent).make(singular), 0};
    plan.cells = mesh::expected_cells(plan.field) / (mesh.vertices == 3 ? 1 : 4 / std::sqrt(3.));
    const double least = mesh.num_cells() / std::pow(request.max_growth, 2) * 1.0001;
    if (plan.cells <= request.max_cells || predict(mesh, at_singularity, level, request.max_growth).cells <= least)
      return plan;
    level *= 1.5; // grading adds cells, which the prediction leaves out
  }
}

} // namespace rpc::adapt
