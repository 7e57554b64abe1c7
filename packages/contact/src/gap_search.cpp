// SPDX-License-Identifier: BSD-3-Clause
#include "gap_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace rpc::contact
{
namespace
{

// Parts are not divided below this share of a face's edge.
constexpr double finest = 1. / 4096;

/// A square part of the reference cell.
struct FacePart {
  double X[2], size; // its lower corner and edge
  double bound;      // on e [m]

  bool operator<(const FacePart &other) const { return bound < other.bound; }
};

class Search
{
public:
  Search(const FacetRows &rows, const LO f, const EvaluateShape &shape, const ContactOptions &options,
         const bool triangle)
      : rows_(rows), f_(f), shape_(shape), options_(options), triangle_(triangle), nodes_(facet_nodes(rows, f))
  {
    measure_curvature();
  }

  std::optional<HiddenPart> run(const double least, const int most_parts)
  {
    const double edge = length_of_edge();
    std::priority_queue<FacePart> parts;
    parts.push(whole());
    double deepest = least, at[2] = {};
    for (int looked = 0; looked < most_parts && !parts.empty() && parts.top().bound > deepest; ++looked) {
      const FacePart part = parts.top();
      parts.pop();
      const double centre[2] = {part.X[0] + part.size / 2, part.X[1] + part.size / 2};
      if (const double e = excess(centre); e > deepest) {
        deepest = e;
        std::copy_n(centre, 2, at);
      }
      if (part.size <= finest * edge) continue;
      for (const double right : {0., part.size / 2})
        for (const double up : {0., part.size / 2})
          if (!triangle_ || part.X[0] + right + part.X[1] + up < 1)
            parts.push(bounded({part.X[0] + right, part.X[1] + up}, part.size / 2));
    }
    if (!(deepest > least)) return std::nullopt;
    HiddenPart hidden{deepest, sample(at).place, {}};
    for (int g = 0; g < 2; ++g) hidden.width[g] = width_along(at, g, least);
    return hidden;
  }

  /// With the bound on e over the face.
  FacePart whole() const
  {
    const double corner = triangle_ ? 0 : -1;
    return bounded({corner, corner}, length_of_edge());
  }

private:
  double length_of_edge() const { return triangle_ ? 1 : 2; } // of the reference cell
  FacetSample sample(const double *const X) const
  {
    FacetShape shape;
    shape_(X, shape);
    return sample_at(nodes_, shape, options_);
  }
  bool is_inside(const double *const X) const
  {
    return triangle_ ? X[0] >= 0 && X[1] >= 0 && X[0] + X[1] <= 1 : std::abs(X[0]) <= 1 && std::abs(X[1]) <= 1;
  }
  double excess(const double *const X) const
  {
    return is_inside(X) ? excess_at(sample(X), options_) : -std::numeric_limits<double>::infinity();
  }

  /// How far nodes between the vertices lie from where linear interpolation has them: by so much times the square of its size a part
  /// differs from what its corners show.
  void measure_curvature()
  {
    const int vertices = triangle_ ? 3 : 4;
    for (int a = vertices; a < rows_.nodes; ++a) {
      const int middle = a - vertices; // of an edge; the last one of nine is that of the face
      const int first = middle < vertices ? middle : 0, second = middle < vertices ? (middle + 1) % vertices : 2;
      for (int k = 0; k < rows_.dim; ++k) {
        const auto deviation = [&](const double *const at, const double *const left, const double *const right) {
          return std::abs(at[k] - (left[k] + right[k]) / 2);
        };
        bend_ = std::max(bend_, deviation(rows_.place(f_, a), rows_.place(f_, first), rows_.place(f_, second)));
        bend_of_u_ = std::max(bend_of_u_, deviation(rows_.displacement(f_, a), rows_.displacement(f_, first),
                                                    rows_.displacement(f_, second)));
      }
    }
  }

  /// A part with its bound on e: what its corners and the curvature leave for place and displacement, and the least gap in that box.
  FacePart bounded(const std::array<double, 2> &X, const double size) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    double along = -infinity;
    for (const double right : {0., size})
      for (const double up : {0., size}) {
        const double corner[2] = {X[0] + right, X[1] + up};
        const FacetSample at = sample(corner);
        along = std::max(along, at.along);
        for (int k = 0; k < 3; ++k) {
          box.low[k] = std::min(box.low[k], at.place[k]);
          box.high[k] = std::max(box.high[k], at.place[k]);
        }
      }
    const double share = size / length_of_edge(), curved = 4 * share * share;
    for (int k = 0; k < 3; ++k) {
      box.low[k] -= curved * bend_;
      box.high[k] += curved * bend_;
    }
    const double bound = along + curved * bend_of_u_ * std::sqrt(3.) - options_.gap.bounds(box, options_.gap.time).low;
    return {{X[0], X[1]}, size, std::isnan(bound) ? infinity : bound};
  }

  /// How far e stays above rounding to both sides of a point, in one direction of the face [m].
  double width_along(const double *const at, const int direction, const double least) const
  {
    double ends[2][2];
    for (int side = 0; side < 2; ++side) {
      double inside = 0, outside = 2; // steps from the point
      const auto moved = [&](const double step) {
        double X[2] = {at[0], at[1]};
        X[direction] += side == 0 ? -step : step;
        return std::array<double, 2>{X[0], X[1]};
      };
      for (double step = finest; step < 2; step *= 2) {
        if (!(excess(moved(step).data()) > least)) {
          outside = step;
          break;
        }
        inside = step;
      }
      for (int halving = 0; halving < 10; ++halving) {
        const double middle = (inside + outside) / 2;
        (excess(moved(middle).data()) > least ? inside : outside) = middle;
      }
      std::copy_n(moved(inside).data(), 2, ends[side]);
    }
    return length(difference(sample(ends[1]).place, sample(ends[0]).place));
  }

  const FacetRows &rows_;
  LO f_;
  const EvaluateShape &shape_;
  const ContactOptions &options_;
  bool triangle_;
  FacetNodes nodes_;
  double bend_ = 0, bend_of_u_ = 0; // [m]
};

} // namespace

std::optional<HiddenPart> find_hidden_part(const FacetRows &rows, const LO f, const EvaluateShape &shape,
                                           const ContactOptions &options, const bool triangle, const double least,
                                           const int most_parts)
{
  return Search(rows, f, shape, options, triangle).run(least, most_parts);
}

double bound_on_excess(const FacetRows &rows, const LO f, const EvaluateShape &shape, const ContactOptions &options,
                       const bool triangle)
{
  return Search(rows, f, shape, options, triangle).whole().bound;
}

} // namespace rpc::contact
