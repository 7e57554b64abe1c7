// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "around_nodes.hpp"
#include "elastic_cells.hpp"
#include "patch_polynomial.hpp"

#include <limits>
#include <type_traits>

/// The fit of a polynomial to the displacements around each vertex, (2.13): by the normal equations of least squares.
namespace rpc::fem
{

using ReadColumns = decltype(std::declval<const MultiVector &>().getLocalViewDevice(Tpetra::Access::ReadOnly));
using WriteColumns = decltype(std::declval<MultiVector &>().getLocalViewDevice(Tpetra::Access::ReadWrite));

/// The table of polynomials: a row per vertex, and its columns.
///
/// A polynomial is one of the displacement, of a degree more than the element's, in xi = L^-1 (x - centre): coordinates
/// in which a patch has size 1 in every direction, however thin its cells are. Where the dilatation is projected, (2.6), a polynomial of that, of a
/// degree more, goes with it. In axisymmetry so does the constant of u_r, for u_r/r.
template <int Dim, int Nodes, bool Axisymmetric>
struct PatchTable {
  static constexpr int degree = StaticElement<Dim, Nodes>::order + 1;
  using Terms = Monomials<Dim, degree>;
  static constexpr int trust = 0, centre = 1, frame = centre + Dim, coefficients = frame + Dim * (Dim + 1) / 2;
  using Dilatation = Monomials<Dim, (Projection<Dim, Nodes>::modes > 1 ? 2 : 1)>;
  static constexpr int dilatation = coefficients + (Terms::size - 1) * Dim; // those before without the constants
  static constexpr int radial = dilatation + (ElasticCells<Dim, Nodes>::may_project ? Dilatation::size : 0);
  static constexpr int columns = radial + (Axisymmetric ? 1 : 0);

  /// Trust is the degree that could be fitted; more than that if cells close all around the vertex, in between for a
  /// polynomial taken over from such a vertex; less than any where blocks meet.
  static constexpr int across_blocks = 0, adopted = degree + 1, inside = degree + 2;
};

/// What the fit around a vertex takes from the places of nodes alone.
template <int Dim, int Terms>
struct PatchGeometry {
  double frame[Dim][Dim], inverse[Dim][Dim]; // L, and L^-1
  double normal[Terms][Terms];               // the factor of the normal equations
  int fitted;                                // its leading rows
  bool inside;                               // cells close all around the vertex
};

/// The same of a patch that the next ones may be translates of: where its neighbours lie, by which these are known, and from the first
/// translate on what a unit displacement of each neighbour adds to the coefficients.
template <int Dim, int Terms, int Most>
struct KnownPatch : PatchGeometry<Dim, Terms> {
  int neighbours = 0, cells = 0;
  double dx[Most][Dim]; // from the vertex to its neighbours  [m]
  int terms = 0;        // of part_of; 0: not computed yet
  double part_of[Most][Terms];
};

/// The polynomial of a vertex, by least squares from the displacements of all nodes that share a cell with it.
///
/// A call fits those of some nodes in turn. A host takes over from one patch to the next what congruent patches have in common.
template <int Dim, int Nodes, bool Axisymmetric>
struct FitPatch {
  using Table = PatchTable<Dim, Nodes, Axisymmetric>;
  using Terms = typename Table::Terms;
  using Coefficients = double[Terms::size][Dim];
  /// What lower terms must leave of a term's square. Patches inside leave 3e-2 at least on meshes that are fit for use.
  static constexpr double threshold = 1e-2;
  /// The same of the square of the constant, in coordinates in which patches have size 1. Products of coordinates vanish at all nodes of some
  /// patches.
  static constexpr double least = 1e-6;
  /// Meshes of simplices have few congruent patches, and a GPU has a thread for each node.
  static constexpr bool takes_over = !on_gpu && !StaticElement<Dim, Nodes>::simplex;
  static constexpr int nodes_per_call = takes_over ? 256 : 1;
  static constexpr int along = 2 * StaticElement<Dim, Nodes>::order + 1; // nodes of two cells, in a row
  static constexpr int most = along * along * (Dim == 3 ? along : 1);
  /// Accuracy of node positions, in multiples of their rounding errors.
  static constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  using Patch = std::conditional_t<takes_over, KnownPatch<Dim, Terms::size, most>, PatchGeometry<Dim, Terms::size>>;

  ElasticCells<Dim, Nodes, Axisymmetric> body; //                                       in
  DeviceView<double **> recovery;              // (points, Nodes)                       in, shape functions
  ReadVector u;                                // (overlap dofs)                  [m]   in
  DeviceView<std::size_t *> node_row;          // (owned nodes + 1)                     in
  DeviceView<LO *> node_cell;                  // cells around nodes                    in
  NodeGraph graph;                             //                                       in
  DeviceView<int ***> mate;                    // see facet_mates                       in
  WriteColumns table;                          // (overlap nodes, PatchTable)           out, at owned vertices

  static LO num_calls(const LO num_nodes) { return num_nodes / nodes_per_call + (num_nodes % nodes_per_call > 0); }

  KOKKOS_FUNCTION void operator()(const LO call) const
  {
    const LO all = static_cast<LO>(node_row.extent(0)) - 1, begin = call * nodes_per_call;
    const LO end = all - begin < nodes_per_call ? all : begin + nodes_per_call;
    Patch patch;
    for (LO node = begin; node < end; ++node) {
      const LO first = node_cell(node_row(node));
      if (place_in(body.cells, first, node) < static_cast<int>(mate.extent(0))) fit(node, first, patch);
    }
  }

  /// @param first  cell at the node   @param patch  the last one, then the node's
  KOKKOS_FUNCTION void fit(const LO node, const LO first, Patch &patch) const
  {
    bool is_known = false;
    if constexpr (takes_over) is_known = is_translate(node, patch);
    if (!is_known) look_at(node, patch);

    bool one_block = true;
    for (std::size_t k = node_row(node); k < node_row(node + 1); ++k)
      one_block = one_block && body.block(node_cell(k)) == body.block(first);
    int degree = one_block ? Table::degree : 1;
    while (degree > 1 && Terms::up_to(degree) > patch.fitted) --degree;
    const int terms = Terms::up_to(degree);
    Coefficients c = {};
    if constexpr (takes_over)
      if (is_known) weigh(node, terms, patch, c);
    if (!is_known) solve(node, terms, patch, c);

    const int trust = degree == Table::degree && patch.inside ? Table::inside : degree;
    table(node, int(Table::trust)) = one_block ? trust : Table::across_blocks;
    for (int i = 0; i < Dim; ++i) table(node, Table::centre + i) = body.coords(node, i);
    int column = Table::frame;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j <= i; ++j) table(node, column++) = patch.frame[i][j];
    for (int s = 1; s < Terms::size; ++s)
      for (int i = 0; i < Dim; ++i) table(node, column++) = s < terms ? c[s][i] : 0;
    if constexpr (Axisymmetric) table(node, int(Table::radial)) = u(dof(Dim, node, 0)) + c[0][0];
    if constexpr (ElasticCells<Dim, Nodes>::may_project)
      if (body.projects(first)) fit_dilatation(node, patch.inverse);
  }

  /// Whether a node's patch is the known one elsewhere, up to rounding.
  KOKKOS_FUNCTION bool is_translate(const LO node, const Patch &known) const
  {
    const std::size_t begin = graph.row(node), end = graph.row(node + 1);
    if (end - begin != static_cast<std::size_t>(known.neighbours)) return false;
    if (node_row(node + 1) - node_row(node) != static_cast<std::size_t>(known.cells)) return false;
    double dx[Dim];
    for (std::size_t k = begin; k < end; ++k) {
      step(node, graph.col(k), dx);
      for (int i = 0; i < Dim; ++i) {
        const double size = math::magnitude(body.coords(node, i)) + math::magnitude(dx[i]);
        if (!(math::magnitude(dx[i] - known.dx[k - begin][i]) <= rounding * size)) return false;
      }
    }
    return true;
  }

  KOKKOS_FUNCTION void look_at(const LO node, Patch &patch) const
  {
    const std::size_t begin = graph.row(node), end = graph.row(node + 1);
    const double part = 1. / static_cast<double>(end - begin);
    auto &L = patch.frame; // second moments of the patch, then their root
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        L[i][j] = 0;
        patch.inverse[i][j] = i == j;
      }
    for (std::size_t k = begin; k < end; ++k) {
      double dx[Dim];
      step(node, graph.col(k), dx);
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j <= i; ++j) L[i][j] += dx[i] * dx[j] * part;
      if constexpr (takes_over)
        for (int i = 0; i < Dim && end - begin <= most; ++i) patch.dx[k - begin][i] = dx[i];
    }
    cholesky(L, 0);
    solve_lower(L, Dim, patch.inverse);
    double normal[Terms::size][Terms::size] = {}, term[Terms::size];
    for (std::size_t k = begin; k < end; ++k) {
      evaluate(node, graph.col(k), patch, term);
      for (int s = 0; s < Terms::size; ++s)
        for (int t = 0; t <= s; ++t) normal[s][t] += term[s] * term[t];
    }
    patch.fitted = cholesky(normal, threshold, least * normal[0][0]);
    for (int s = 0; s < Terms::size; ++s)
      for (int t = 0; t <= s; ++t) patch.normal[s][t] = normal[s][t];
    patch.inside = is_inside(node);
    if constexpr (takes_over) {
      patch.neighbours = end - begin <= most ? static_cast<int>(end - begin) : 0;
      patch.cells = static_cast<int>(node_row(node + 1) - node_row(node));
      patch.terms = 0;
    }
  }

  /// The coefficients by the normal equations.
  KOKKOS_FUNCTION void solve(const LO node, const int terms, const Patch &patch, Coefficients &c) const
  {
    double term[Terms::size];
    for (std::size_t k = graph.row(node); k < graph.row(node + 1); ++k) {
      const LO other = graph.col(k);
      evaluate(node, other, patch, term);
      for (int i = 0; i < Dim; ++i) {
        const double rise = u(dof(Dim, other, i)) - u(dof(Dim, node, i));
        for (int s = 0; s < Terms::size; ++s) c[s][i] += term[s] * rise;
      }
    }
    solve_lower(patch.normal, terms, c);
    solve_lower_transposed(patch.normal, terms, c);
  }

  /// The same from the part that each neighbour has in them.
  KOKKOS_FUNCTION void weigh(const LO node, const int terms, Patch &patch, Coefficients &c) const
  {
    const std::size_t begin = graph.row(node);
    if (patch.terms != terms) {
      for (int k = 0; k < patch.neighbours; ++k) {
        double term[Terms::size], part[Terms::size][1];
        evaluate(node, graph.col(begin + k), patch, term);
        for (int s = 0; s < Terms::size; ++s) part[s][0] = s < terms ? term[s] : 0;
        solve_lower(patch.normal, terms, part);
        solve_lower_transposed(patch.normal, terms, part);
        for (int s = 0; s < Terms::size; ++s) patch.part_of[k][s] = part[s][0];
      }
      patch.terms = terms;
    }
    double by_direction[Dim][Terms::size] = {};
    for (int k = 0; k < patch.neighbours; ++k)
      for (int i = 0; i < Dim; ++i) {
        const double rise = u(dof(Dim, graph.col(begin + k), i)) - u(dof(Dim, node, i));
        for (int s = 0; s < Terms::size; ++s) by_direction[i][s] += patch.part_of[k][s] * rise;
      }
    for (int s = 0; s < Terms::size; ++s)
      for (int i = 0; i < Dim; ++i) c[s][i] = by_direction[i][s];
  }

  /// The terms at a neighbour.
  KOKKOS_FUNCTION void evaluate(const LO node, const LO neighbour, const Patch &patch,
                                double (&term)[Terms::size]) const
  {
    double dx[Dim], xi[Dim];
    step(node, neighbour, dx);
    in_frame(patch.inverse, dx, xi);
    Terms::evaluate(xi, term);
  }

  /// The polynomial of the projected dilatation, by least squares from its values at the points for recovery.
  KOKKOS_FUNCTION void fit_dilatation(const LO node, const double (&inverse)[Dim][Dim]) const
  {
    using Terms = typename Table::Dilatation;
    double normal[Terms::size][Terms::size] = {}, c[Terms::size][1] = {};
    for (std::size_t k = node_row(node); k < node_row(node + 1); ++k) {
      const LO cell = node_cell(k);
      const CellCoords<Dim, Nodes> x(body.coords, body.places, cell);
      Projection<Dim, Nodes> projection;
      if (!body.project(cell, projection)) continue;
      for (int q = 0; q < static_cast<int>(recovery.extent(0)); ++q) {
        double at[Dim], dilatation[Nodes][Dim], dx[Dim], xi[Dim], term[Terms::size];
        position(x, recovery, q, at);
        projection.gradients(at, dilatation);
        const double value = body.divergence(u, cell, dilatation);
        for (int i = 0; i < Dim; ++i) dx[i] = to_nearest_image(at[i] - body.coords(node, i), body.period[i]);
        in_frame(inverse, dx, xi);
        Terms::evaluate(xi, term);
        for (int s = 0; s < Terms::size; ++s) {
          for (int t = 0; t <= s; ++t) normal[s][t] += term[s] * term[t];
          c[s][0] += term[s] * value;
        }
      }
    }
    const int fitted = cholesky(normal, threshold, least * normal[0][0]);
    int degree = 2;
    while (degree > 0 && Terms::up_to(degree) > fitted) --degree;
    const int terms = Terms::up_to(degree);
    solve_lower(normal, terms, c);
    solve_lower_transposed(normal, terms, c);
    for (int s = 0; s < Terms::size; ++s) table(node, Table::dilatation + s) = s < terms ? c[s][0] : 0;
  }

  /// xi = L^-1 dx.
  static KOKKOS_FUNCTION void in_frame(const double (&inverse)[Dim][Dim], const double (&dx)[Dim], double (&xi)[Dim])
  {
    for (int i = 0; i < Dim; ++i) {
      xi[i] = 0;
      for (int j = 0; j <= i; ++j) xi[i] += inverse[i][j] * dx[j];
    }
  }
  KOKKOS_FUNCTION void step(const LO from, const LO to, double (&dx)[Dim]) const
  {
    for (int i = 0; i < Dim; ++i) dx[i] = to_nearest_image(body.coords(to, i) - body.coords(from, i), body.period[i]);
  }

  /// Whether cells close all around a vertex: every facet at it is shared by two of them.
  KOKKOS_FUNCTION bool is_inside(const LO node) const
  {
    for (std::size_t k = node_row(node); k < node_row(node + 1); ++k) {
      const int a = place_in(body.cells, node_cell(k), node);
      for (int f = 0; f < Dim; ++f)
        if (!shares_facet(node, k, a, f)) return false;
    }
    return true;
  }
  /// Whether another cell at a node has the facet f at the vertex a of the node's k-th cell.
  KOKKOS_FUNCTION bool shares_facet(const LO node, const std::size_t k, const int a, const int f) const
  {
    for (std::size_t other = node_row(node); other < node_row(node + 1); ++other) {
      bool all = other != k;
      for (std::size_t m = 0; m < mate.extent(2) && all; ++m)
        all = has_vertex(node_cell(other), body.cells(node_cell(k), mate(a, f, m)));
      if (all) return true;
    }
    return false;
  }
  KOKKOS_FUNCTION bool has_vertex(const LO cell, const LO node) const
  {
    for (std::size_t a = 0; a < mate.extent(0); ++a)
      if (body.cells(cell, a) == node) return true;
    return false;
  }
};

/// Vertices at the boundary take the polynomial of the nearest vertex inside, for the sake of their neighbours that have
/// no vertex inside around them: corners. Only rows of vertices inside are read, and only others are written.
template <int Dim, int Nodes, bool Axisymmetric>
struct AdoptPolynomial {
  using Table = PatchTable<Dim, Nodes, Axisymmetric>;

  DeviceView<LO **> cells;            // (cells, Nodes)                        in
  DeviceView<std::size_t *> node_row; // (owned nodes + 1)                     in
  DeviceView<LO *> node_cell;         // cells around nodes                    in
  WriteColumns table;                 // (overlap nodes, PatchTable)           inout
  int vertices;                       // per cell
  Kokkos::Array<double, 3> period;    // see ElasticCells                      in

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const double own = table(node, int(Table::trust));
    if (own == Table::across_blocks || own == Table::inside) return; // nodes that are no vertices have the former
    LO nearest = -1;
    for (std::size_t k = node_row(node); k < node_row(node + 1); ++k) {
      for (int a = 0; a < vertices; ++a) {
        const LO other = cells(node_cell(k), a);
        if (table(other, int(Table::trust)) == Table::inside && (nearest < 0 || nearer(node, other, nearest)))
          nearest = other;
      }
    }
    if (nearest < 0) return;
    for (int c = Table::trust + 1; c < Table::columns; ++c) table(node, c) = table(nearest, c);
    table(node, int(Table::trust)) = Table::adopted; // never that of a vertex inside, which another thread may look at
  }

  /// Of equally near ones the first by coordinates, which does not depend on the number of ranks.
  KOKKOS_FUNCTION bool nearer(const LO node, const LO a, const LO b) const
  {
    double square[2] = {}, first = 0;
    for (int i = 0; i < Dim; ++i) {
      const double xa = table(a, Table::centre + i), xb = table(b, Table::centre + i),
                   x = table(node, Table::centre + i);
      const double to_a = to_nearest_image(xa - x, period[i]), to_b = to_nearest_image(xb - x, period[i]);
      square[0] += to_a * to_a;
      square[1] += to_b * to_b;
      if (first == 0) first = to_nearest_image(xa - xb, period[i]);
    }
    return square[0] == square[1] ? first < 0 : square[0] < square[1];
  }
};

} // namespace rpc::fem
