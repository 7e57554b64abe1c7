#pragma once

#include "around_nodes.hpp"
#include "elastic_cells.hpp"
#include "patch_polynomial.hpp"

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

/// The polynomial of a vertex, by least squares from the displacements of all nodes that share a cell with it.
template <int Dim, int Nodes, bool Axisymmetric>
struct FitPatch {
  using Table = PatchTable<Dim, Nodes, Axisymmetric>;
  using Terms = typename Table::Terms;
  /// What lower terms must leave of a term's square. Patches inside leave 3e-2 at least on meshes that are fit for use.
  static constexpr double threshold = 1e-2;
  /// The same of the square of the constant, in coordinates in which patches have size 1. Products of coordinates vanish at all nodes of some
  /// patches.
  static constexpr double least = 1e-6;

  ElasticCells<Dim, Nodes, Axisymmetric> body; //                                       in
  DeviceView<double **> recovery;              // (points, Nodes)                       in, shape functions
  ReadVector u;                                // (overlap dofs)                  [m]   in
  DeviceView<std::size_t *> node_row;          // (owned nodes + 1)                     in
  DeviceView<LO *> node_cell;                  // cells around nodes                    in
  NodeGraph graph;                             //                                       in
  DeviceView<int ***> mate;                    // see facet_mates                       in
  WriteColumns table;                          // (overlap nodes, PatchTable)           out, at owned vertices

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const LO first = node_cell(node_row(node));
    if (place_in(body.cells, first, node) >= static_cast<int>(mate.extent(0))) return;
    double L[Dim][Dim] = {}; // second moments of the patch, then their root
    const std::size_t begin = graph.row(node), end = graph.row(node + 1);
    const double part = 1. / static_cast<double>(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      double dx[Dim];
      step(node, graph.col(k), dx);
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j <= i; ++j) L[i][j] += dx[i] * dx[j] * part;
    }
    cholesky(L, 0);
    double inverse[Dim][Dim];
    invert_lower(L, inverse);

    double normal[Terms::size][Terms::size] = {}, c[Terms::size][Dim] = {};
    for (std::size_t k = begin; k < end; ++k) {
      const LO other = graph.col(k);
      double dx[Dim], xi[Dim], term[Terms::size];
      step(node, other, dx);
      in_frame(inverse, dx, xi);
      Terms::evaluate(xi, term);
      for (int s = 0; s < Terms::size; ++s) {
        for (int t = 0; t <= s; ++t) normal[s][t] += term[s] * term[t];
        for (int i = 0; i < Dim; ++i) c[s][i] += term[s] * (u(dof(Dim, other, i)) - u(dof(Dim, node, i)));
      }
    }
    bool one_block = true;
    for (std::size_t k = node_row(node); k < node_row(node + 1); ++k)
      one_block = one_block && body.block(node_cell(k)) == body.block(first);
    const int fitted = cholesky(normal, threshold, least * normal[0][0]);
    int degree = one_block ? Table::degree : 1;
    while (degree > 1 && Terms::up_to(degree) > fitted) --degree;
    const int terms = Terms::up_to(degree);
    solve_lower(normal, terms, c);
    solve_lower_transposed(normal, terms, c);

    const int trust = degree == Table::degree && is_inside(node) ? Table::inside : degree;
    table(node, int(Table::trust)) = one_block ? trust : Table::across_blocks;
    for (int i = 0; i < Dim; ++i) table(node, Table::centre + i) = body.coords(node, i);
    int column = Table::frame;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j <= i; ++j) table(node, column++) = L[i][j];
    for (int s = 1; s < Terms::size; ++s)
      for (int i = 0; i < Dim; ++i) table(node, column++) = s < terms ? c[s][i] : 0;
    if constexpr (Axisymmetric) table(node, int(Table::radial)) = u(dof(Dim, node, 0)) + c[0][0];
    if constexpr (ElasticCells<Dim, Nodes>::may_project)
      if (body.projects(first)) fit_dilatation(node, inverse);
  }

  /// The polynomial of the projected dilatation, by least squares from its values at the points for recovery.
  KOKKOS_FUNCTION void fit_dilatation(const LO node, const double (&inverse)[Dim][Dim]) const
  {
    using Terms = typename Table::Dilatation;
    double normal[Terms::size][Terms::size] = {}, c[Terms::size][1] = {};
    for (std::size_t k = node_row(node); k < node_row(node + 1); ++k) {
      const LO cell = node_cell(k);
      const CellCoords<Dim, Nodes> x(body.coords, body.cells, cell);
      Projection<Dim, Nodes> projection;
      if (!body.project(cell, projection)) continue;
      for (int q = 0; q < static_cast<int>(recovery.extent(0)); ++q) {
        double at[Dim], dilatation[Nodes][Dim], dx[Dim], xi[Dim], term[Terms::size];
        position(x, recovery, q, at);
        projection.gradients(at, dilatation);
        const double value = body.divergence(u, cell, dilatation);
        for (int i = 0; i < Dim; ++i) dx[i] = at[i] - body.coords(node, i);
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
    for (int i = 0; i < Dim; ++i) dx[i] = body.coords(to, i) - body.coords(from, i);
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
      square[0] += (xa - x) * (xa - x);
      square[1] += (xb - x) * (xb - x);
      if (first == 0) first = xa - xb;
    }
    return square[0] == square[1] ? first < 0 : square[0] < square[1];
  }
};

} // namespace rpc::fem
