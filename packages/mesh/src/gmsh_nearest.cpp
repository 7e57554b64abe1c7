// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gmsh.h>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace rpc::mesh
{
namespace
{

using Places = std::vector<double>; // (points, 3)

double distance(const double *const a, const double *const b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The curves in the boundaries of both surfaces.
std::vector<int> shared_curves(const int one, const int other)
{
  const auto curves_of = [](const int surface) {
    gmsh::vectorpair boundary;
    gmsh::model::getBoundary({{2, surface}}, boundary, false, false, false);
    std::vector<int> curves;
    for (const auto &[dim, tag] : boundary) curves.push_back(std::abs(tag));
    std::sort(curves.begin(), curves.end());
    return curves;
  };
  const std::vector<int> a = curves_of(one), b = curves_of(other);
  std::vector<int> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// One step of Gauss and Newton for each point's parameters: what gmsh finds on surfaces may be far from the nearest point.
Places next_parameters(const int dim, const int tag, const Places &wanted, const Places &found,
                       const Places &parameters)
{
  std::vector<double> slopes;
  gmsh::model::getDerivative(dim, tag, parameters, slopes);
  Places next = parameters;
  for (std::size_t n = 0; 3 * n < wanted.size(); ++n) {
    const double *const t = &slopes[3 * std::size_t(dim) * n];
    double A[2][2] = {}, b[2] = {};
    for (int i = 0; i < 3; ++i)
      for (int p = 0; p < dim; ++p) {
        b[p] += t[3 * p + i] * (wanted[3 * n + i] - found[3 * n + i]);
        for (int q = 0; q < dim; ++q) A[p][q] += t[3 * p + i] * t[3 * q + i];
      }
    if (dim == 1) {
      next[n] += A[0][0] > 0 ? b[0] / A[0][0] : 0;
      continue;
    }
    const double determinant = A[0][0] * A[1][1] - A[0][1] * A[1][0];
    if (!(determinant > 0)) continue;
    next[2 * n] += (b[0] * A[1][1] - b[1] * A[0][1]) / determinant;
    next[2 * n + 1] += (b[1] * A[0][0] - b[0] * A[1][0]) / determinant;
  }
  return next;
}

/// (points, 3) Places on one curve or surface.
Places nearest_on(const int dim, const int tag, const Places &wanted)
{
  constexpr int most_steps = 20;
  Places found, parameters;
  gmsh::model::getClosestPoint(dim, tag, wanted, found, parameters);
  for (int step = 0; step < most_steps; ++step) {
    Places next = next_parameters(dim, tag, wanted, found, parameters), places;
    gmsh::model::getValue(dim, tag, next, places);
    bool better = false;
    for (std::size_t n = 0; 3 * n < wanted.size(); ++n) {
      if (!(distance(&places[3 * n], &wanted[3 * n]) < distance(&found[3 * n], &wanted[3 * n]))) continue;
      better = true;
      std::copy_n(&places[3 * n], 3, &found[3 * n]);
      std::copy_n(&next[dim * n], dim, &parameters[dim * n]);
    }
    if (!better) break;
  }
  return found;
}

} // namespace

void take_nearest_points(const GmshRequest &request, GmshContents &contents)
{
  std::map<std::pair<int, int>, std::vector<int>> points; // by tags
  for (std::size_t n = 0; 2 * n < request.near_tags.size(); ++n)
    points[{request.near_tags[2 * n], request.near_tags[2 * n + 1]}].push_back(static_cast<int>(n));
  contents.coords.assign(request.near_coords.size(), std::numeric_limits<double>::quiet_NaN());
  for (const auto &[tags, list] : points) {
    Places wanted;
    for (const int n : list)
      wanted.insert(wanted.end(), &request.near_coords[3 * std::size_t(n)],
                    &request.near_coords[3 * std::size_t(n)] + 3);
    const int dim = tags.second == 0 ? contents.dim - 1 : 1;
    const std::vector<int> entities =
        tags.second == 0 ? std::vector<int>{tags.first} : shared_curves(tags.first, tags.second);
    for (const int entity : entities) {
      const Places found = nearest_on(dim, entity, wanted);
      for (std::size_t k = 0; k < list.size(); ++k) {
        double *const best = &contents.coords[3 * std::size_t(list[k])];
        if (!(distance(best, &wanted[3 * k]) <= distance(&found[3 * k], &wanted[3 * k])))
          std::copy_n(&found[3 * k], 3, best);
      }
    }
  }
}

} // namespace rpc::mesh
