// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gmsh.h>
#include <string>
#include <utility>

namespace rpc::mesh
{
namespace
{

using Point = std::array<double, 3>;
using Matrix = std::array<Point, 3>;
using ShapeKind = BoundaryShape::Kind;

/// Points of a curve or surface, about their mean and in units of their size.
struct Samples {
  std::vector<double> parameters;
  std::vector<Point> point;
  Point mean{};
  double size = 0;
};

double inner(const Point &a, const Point &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

constexpr double tolerance = 1e-9; // of the size of the samples

/// At even parameters, away from the ends of surfaces, where some have poles. Few: gmsh takes milliseconds for a point of a sphere.
std::vector<double> parameters(const int dim, const int tag)
{
  std::vector<double> low, high, list;
  gmsh::model::getParametrizationBounds(dim, tag, low, high);
  const auto at = [&](const int d, const double share) { return low[d] + share * (high[d] - low[d]); };
  const int along = dim == 1 ? 9 : 5;
  for (int i = 0; i < along; ++i) {
    if (dim == 1) {
      list.push_back(at(0, double(i) / (along - 1)));
      continue;
    }
    for (int j = 0; j < along; ++j) {
      list.push_back(at(0, (i + 1.) / (along + 1)));
      list.push_back(at(1, (j + 1.) / (along + 1)));
    }
  }
  return list;
}

std::vector<Point> points_of(const std::vector<double> &coords)
{
  std::vector<Point> points;
  for (std::size_t k = 0; k + 2 < coords.size(); k += 3) points.push_back({coords[k], coords[k + 1], coords[k + 2]});
  return points;
}

Samples samples_of(const int dim, const int tag)
{
  Samples samples;
  samples.parameters = parameters(dim, tag);
  std::vector<double> coords;
  gmsh::model::getValue(dim, tag, samples.parameters, coords);
  samples.point = points_of(coords);
  for (const Point &x : samples.point)
    for (int i = 0; i < 3; ++i) samples.mean[i] += x[i] / static_cast<double>(samples.point.size());
  for (Point &x : samples.point)
    for (int i = 0; i < 3; ++i) {
      x[i] -= samples.mean[i];
      samples.size = std::max(samples.size, std::abs(x[i]));
    }
  for (Point &x : samples.point)
    for (int i = 0; i < 3; ++i) x[i] /= samples.size;
  return samples;
}

/// The eigenvectors of a symmetric matrix, by ascending eigenvalues (Jacobi).
Matrix eigenvectors(Matrix A)
{
  Matrix V{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; // columns
  for (int sweep = 0; sweep < 50; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (A[p][q] == 0) continue;
        const double theta = (A[q][q] - A[p][p]) / (2 * A[p][q]),
                     t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::hypot(theta, 1)), c = 1 / std::hypot(t, 1),
                     s = t * c;
        for (auto *const M : {&A, &V})
          for (int k = 0; k < 3; ++k) {
            const double kp = (*M)[k][p], kq = (*M)[k][q];
            (*M)[k][p] = c * kp - s * kq;
            (*M)[k][q] = s * kp + c * kq;
          }
        for (int k = 0; k < 3; ++k) {
          const double pk = A[p][k], qk = A[q][k];
          A[p][k] = c * pk - s * qk;
          A[q][k] = s * pk + c * qk;
        }
      }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](const int a, const int b) { return A[a][a] < A[b][b]; });
  Matrix vectors;
  for (int v = 0; v < 3; ++v)
    for (int k = 0; k < 3; ++k) vectors[v][k] = V[k][order[v]];
  return vectors;
}

Matrix second_moments(const std::vector<Point> &vectors)
{
  Matrix sum{};
  for (const Point &x : vectors)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum[i][j] += x[i] * x[j];
  return sum;
}

/// The sphere around points, or the circle around those in the plane z = 0, by the centre c with least squares of
/// |x|^2 - 2 c x - (r^2 - |c|^2), in its principal directions; points have the mean 0.
struct Round {
  Point centre{};
  double radius = 0;
};
Round round_through(const std::vector<Point> &points)
{
  const Matrix directions = eigenvectors(second_moments(points));
  double mean_square = 0;
  for (const Point &x : points) mean_square += inner(x, x) / static_cast<double>(points.size());
  // In these directions the normal equations of c are diagonal.
  Round round;
  for (const Point &e : directions) {
    double squares = 0, right = 0;
    for (const Point &x : points) {
      squares += inner(e, x) * inner(e, x);
      right += inner(e, x) * (inner(x, x) - mean_square) / 2;
    }
    if (squares < tolerance * tolerance * static_cast<double>(points.size())) continue; // they lie in a plane
    for (int i = 0; i < 3; ++i) round.centre[i] += right / squares * e[i];
  }
  round.radius = std::sqrt(mean_square + inner(round.centre, round.centre));
  return round;
}

bool all_near(const std::vector<Point> &points, const Round &round)
{
  return std::all_of(points.begin(), points.end(), [&](const Point &x) {
    const Point arm{x[0] - round.centre[0], x[1] - round.centre[1], x[2] - round.centre[2]};
    return std::abs(std::sqrt(inner(arm, arm)) - round.radius) <= tolerance * (1 + round.radius);
  });
}

bool all_flat(const std::vector<Point> &points, const Point &normal)
{
  return std::all_of(points.begin(), points.end(),
                     [&](const Point &x) { return std::abs(inner(x, normal)) <= tolerance; });
}

/// Points less what they are along a direction.
std::vector<Point> across(std::vector<Point> points, const Point &direction)
{
  for (Point &x : points) {
    const double along = inner(x, direction);
    for (int i = 0; i < 3; ++i) x[i] -= along * direction[i];
  }
  return points;
}

/// In the units of the samples, about their mean.
BoundaryShape shape_through(const Samples &samples, const int dim, const int tag)
{
  BoundaryShape shape;
  const auto &points = samples.point;
  const auto make_round = [&](const ShapeKind kind, const Round &round) {
    shape.kind = kind;
    shape.point = round.centre;
    shape.radius = round.radius;
    return shape;
  };
  const Matrix axes = eigenvectors(second_moments(points));
  // Of a plane curve the direction with the least moment is z; across a line is the middle one.
  const Point normal = axes[dim == 1 ? 1 : 0];
  if (all_flat(points, normal)) {
    shape.direction = normal;
    return shape;
  }
  if (const Round round = round_through(points); all_near(points, round)) return make_round(ShapeKind::sphere, round);
  if (dim == 2) {
    std::vector<double> normals;
    gmsh::model::getNormal(tag, samples.parameters, normals);
    shape.direction = eigenvectors(second_moments(points_of(normals)))[0];
    const auto section = across(points, shape.direction);
    if (const Round round = round_through(section); all_near(section, round))
      return make_round(ShapeKind::cylinder, round);
  }
  shape.kind = ShapeKind::other;
  return shape;
}

BoundaryShape shape_of(const int dim, const int tag)
{
  BoundaryShape shape;
  shape.kind = ShapeKind::other;
  try {
    const Samples samples = samples_of(dim, tag);
    const bool finite = std::all_of(samples.point.begin(), samples.point.end(),
                                    [](const Point &x) { return std::isfinite(inner(x, x)); });
    if (finite && samples.point.size() > 6) {
      shape = shape_through(samples, dim, tag);
      for (int i = 0; i < 3; ++i) shape.point[i] = samples.mean[i] + samples.size * shape.point[i];
      shape.radius *= samples.size;
    }
  } catch (const std::string &) { // gmsh's, where an entity has no parameters
  }
  shape.tag = tag;
  return shape;
}

} // namespace

void take_boundary(GmshContents &contents)
{
  const int dim = contents.dim - 1;
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dim);
  std::sort(entities.begin(), entities.end());
  for (const auto &[entity_dim, tag] : entities) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dim, tag);
    if (types.empty()) continue;
    const BoundaryShape shape = shape_of(dim, tag);
    for (std::size_t t = 0; t < types.size(); ++t) contents.boundary.push_back({shape, types[t], std::move(nodes[t])});
  }
}

} // namespace rpc::mesh
