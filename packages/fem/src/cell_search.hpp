// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "filled_lists.hpp"
#include "kernels.hpp"

/// Search for the cell in which a point lies, or that is next to it; private to interpolation().
namespace rpc::fem
{

/// Cells among which places are looked for: those that one rank owns.
struct SearchedCells {
  DeviceView<double **> coords; ///< (overlap nodes, dim) [m]
  DeviceView<LO **> places;     ///< (local cells, nodes per cell) rows of coords
  DeviceView<GO *> id;          ///< (searched cells) the same on any number of ranks
  LO count = 0;
};

/// A block of bins, first and last one in each direction.
template <int Dim>
struct BinBlock {
  int first[Dim], last[Dim];

  /// Calls visit(bin) for those bins that lie outside `inner`, if there is one.
  /// @param count  of all bins in each direction
  template <class Visit>
  KOKKOS_INLINE_FUNCTION void for_each(const Kokkos::Array<int, Dim> &count, const BinBlock *inner,
                                       const Visit &visit) const
  {
    int at[Dim];
    for (int d = 0; d < Dim; ++d) at[d] = first[d];
    for (int d = 0; d < Dim;) {
      bool seen = inner != nullptr;
      int bin = 0;
      for (int k = Dim - 1; k >= 0; --k) {
        bin = bin * count[k] + at[k];
        seen = seen && inner->first[k] <= at[k] && at[k] <= inner->last[k];
      }
      if (!seen) visit(bin);
      for (d = 0; d < Dim && ++at[d] > last[d]; ++d) at[d] = first[d];
    }
  }
};

/// Boxes of equal size over a mesh, each with a list of the cells whose own box it meets.
template <int Dim>
struct Bins {
  Kokkos::Array<double, Dim> lower{}, width{}; // [m]
  Kokkos::Array<int, Dim> count{};
  FilledLists cells;

  /// The bin of a coordinate in one direction, the last one for coordinates beyond it.
  KOKKOS_INLINE_FUNCTION int along(const int d, const double x) const
  {
    return static_cast<int>(mesh::within(0, (x - lower[d]) / width[d], count[d] - 0.5));
  }
  /// The bins that a box (lower and upper ends) meets.
  template <class Box>
  KOKKOS_INLINE_FUNCTION BinBlock<Dim> over(const Box &box, const LO c) const
  {
    BinBlock<Dim> block;
    for (int d = 0; d < Dim; ++d) {
      block.first[d] = along(d, box(c, d));
      block.last[d] = along(d, box(c, Dim + d));
    }
    return block;
  }
  KOKKOS_INLINE_FUNCTION int size() const
  {
    int size = 1;
    for (int d = 0; d < Dim; ++d) size *= count[d];
    return size;
  }
};

/// The bins that each cell's box meets.
template <int Dim>
struct BinsOfCells {
  Bins<Dim> bins;            // without cells  in
  DeviceView<double **> box; //                in

  template <class Add>
  KOKKOS_INLINE_FUNCTION void operator()(const LO cell, const Add &add) const
  {
    bins.over(box, cell).for_each(bins.count, nullptr, add);
  }
};

/// Which of the cells are asked: those whose box holds the point; all, for the nearest; the nearest of all where none holds
/// it.
enum class Asked { around_it, nearest, any };

/// Where points lie.
template <int Dim>
struct Places {
  DeviceView<LO *> cell;     ///< (points) -1: none
  DeviceView<double *> away; ///< (points) square of the distance from the cell [m^2], -1 if it holds the point
  DeviceView<double *[Dim]> reference; ///< (points) coordinates in the reference cell
};

/// Finds a place among the cells for each point. Of several that hold it, or are equally far from it, that of the least id.
template <int Dim, int Nodes>
struct FindPlaces {
  static constexpr int most_steps = 20;     // Newton's method needs 2 to 5 for a point inside
  static constexpr double converged = 1e-8; // step after which another one changes nothing

  ShapeFunctions<Dim, Nodes> shape; //                                                          in
  SearchedCells mesh;               //                                                          in
  DeviceView<double **> box;        // (cells, 2 Dim) lower, upper ends [m]                     in
  Bins<Dim> bins;                   //                                                          in
  double rounding;                  // of coordinates                   [m]                     in
  Asked asked;                      //                                                          in
  DeviceView<double **> points;     // (points or more, Dim)            [m]                     in
  DeviceView<double *> bound;       // (points) places farther off do not count, or none [m^2]  in
  Places<Dim> found;                //                                                          out

  struct Place {
    LO cell = -1;
    GO id = math::largest<GO>;
    double X[Dim] = {};
    double away = math::infinity<double>; // squared distance [m^2]

    KOKKOS_INLINE_FUNCTION bool nearer_than(const Place &other) const
    {
      return away < other.away || (away == other.away && id < other.id);
    }
  };

  KOKKOS_FUNCTION void operator()(const LO point) const
  {
    double x[Dim];
    for (int d = 0; d < Dim; ++d) x[d] = points(point, d);
    Place place;
    if (bound.extent(0) > 0) place.away = bound(point);
    const bool inside = asked != Asked::nearest && look_inside(x, place);
    if (!inside && asked != Asked::around_it) look_around(x, place);
    found.cell(point) = place.cell;
    found.away(point) = inside ? -1 : place.away;
    for (int d = 0; d < Dim; ++d) found.reference(point, d) = place.X[d];
  }

  /// The first of the cells that hold x.
  /// @return whether there is one; if not, the nearest of those whose box holds x, if any
  KOKKOS_FUNCTION bool look_inside(const double (&x)[Dim], Place &place) const
  {
    bool inside = false;
    const int bin = bin_of(x);
    for (std::size_t k = bins.cells.row(bin); k < bins.cells.row(bin + 1); ++k) {
      const LO c = bins.cells.item(k);
      if ((inside && mesh.id(c) > place.id) || distance_to_box(c, x) > 0) continue;
      Place here;
      approach(c, x, here);
      double diagonal = 0;
      for (int d = 0; d < Dim; ++d) diagonal += (box(c, Dim + d) - box(c, d)) * (box(c, Dim + d) - box(c, d));
      const bool holds = here.away <= 1e-24 * diagonal + rounding * rounding;
      if (holds || (!inside && here.nearer_than(place))) place = here;
      inside = inside || holds;
    }
    return inside;
  }

  /// The nearest of all cells: blocks of bins around that of x grow until no cell outside can be nearer.
  KOKKOS_FUNCTION void look_around(const double (&x)[Dim], Place &place) const
  {
    BinBlock<Dim> block, seen;
    for (int d = 0; d < Dim; ++d) block.first[d] = block.last[d] = bins.along(d, x[d]);
    const BinBlock<Dim> *inner = nullptr;
    for (bool more = true; more;) {
      block.for_each(bins.count, inner, [&](const int bin) {
        for (std::size_t k = bins.cells.row(bin); k < bins.cells.row(bin + 1); ++k) {
          const LO c = bins.cells.item(k);
          if (c == place.cell || distance_to_box(c, x) > place.away) continue;
          Place here;
          approach(c, x, here);
          if (here.nearer_than(place)) place = here;
        }
      });
      more = false;
      seen = block;
      inner = &seen;
      for (int d = 0; d < Dim; ++d) {
        const double low = x[d] - bins.lower[d] - seen.first[d] * bins.width[d]; // to what is not yet seen
        const double high = bins.lower[d] + (seen.last[d] + 1) * bins.width[d] - x[d];
        if (seen.first[d] > 0) {
          more = more || low * low < place.away;
          --block.first[d];
        }
        if (seen.last[d] + 1 < bins.count[d]) {
          more = more || high * high < place.away;
          ++block.last[d];
        }
      }
    }
  }

  KOKKOS_FUNCTION int bin_of(const double (&x)[Dim]) const
  {
    int bin = 0;
    for (int d = Dim - 1; d >= 0; --d) bin = bin * bins.count[d] + bins.along(d, x[d]);
    return bin;
  }

  /// Square of the distance [m^2], which that to the cell cannot be less than.
  KOKKOS_FUNCTION double distance_to_box(const LO c, const double (&x)[Dim]) const
  {
    double sum = 0;
    for (int d = 0; d < Dim; ++d) {
      const double low = box(c, d) - x[d], high = x[d] - box(c, Dim + d);
      const double out = low > 0 ? low : high > 0 ? high : 0;
      sum += out * out;
    }
    return sum;
  }

  /// Reference coordinates of x in a cell by Newton's method, moved into the reference cell, and how far from x that is.
  KOKKOS_FUNCTION void approach(const LO c, const double (&x)[Dim], Place &place) const
  {
    double seen[Nodes][Dim]; // nodes from x: differences lose nothing far from the origin
    for (int a = 0; a < Nodes; ++a)
      for (int d = 0; d < Dim; ++d) seen[a][d] = mesh.coords(mesh.places(c, a), d) - x[d];
    double N[Nodes], dN[Nodes][Dim];
    place.cell = c;
    place.id = mesh.id(c);
    shape.centre(place.X);
    for (int step = 0; step < most_steps; ++step) {
      shape.evaluate(place.X, N, dN);
      double r[Dim] = {}, jacobian[Dim][Dim] = {}, inverse[Dim][Dim];
      for (int a = 0; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) {
          r[i] += N[a] * seen[a][i];
          for (int j = 0; j < Dim; ++j) jacobian[i][j] += seen[a][i] * dN[a][j];
        }
      invert<Dim>(jacobian, inverse);
      double change = 0;
      for (int i = 0; i < Dim; ++i) {
        double to = place.X[i];
        for (int j = 0; j < Dim; ++j) to -= inverse[i][j] * r[j];
        to = mesh::within(-1.5, to, 1.5); // farther out the map may fold over
        const double moved = to > place.X[i] ? to - place.X[i] : place.X[i] - to;
        if (moved > change) change = moved;
        place.X[i] = to;
      }
      if (change < converged) break;
    }
    shape.clamp(place.X);
    shape.evaluate(place.X, N, dN);
    place.away = 0;
    for (int i = 0; i < Dim; ++i) {
      double r = 0;
      for (int a = 0; a < Nodes; ++a) r += N[a] * seen[a][i];
      place.away += r * r;
    }
  }
};

} // namespace rpc::fem
