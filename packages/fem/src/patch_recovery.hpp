// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "patch_fit.hpp"

/// The recovered stress, from the polynomials of vertices that patch_fit.hpp makes: at nodes, in cells and on sides. (2.13)
namespace rpc::fem
{

/// Stress components as they are recovered: in the order of stress_names, in 2D followed by the one across the plane.
template <int Dim>
struct Components {
  static constexpr int size = Dim == 2 ? 4 : 6;
  static KOKKOS_INLINE_FUNCTION int row(const int k)
  {
    constexpr int r2[] = {0, 1, 0, 2}, r3[] = {0, 1, 2, 0, 1, 0};
    return Dim == 2 ? r2[k % 4] : r3[k];
  }
  static KOKKOS_INLINE_FUNCTION int col(const int k)
  {
    constexpr int c2[] = {0, 1, 1, 2}, c3[] = {0, 1, 2, 1, 2, 2};
    return Dim == 2 ? c2[k % 4] : c3[k];
  }
};

/// The polynomials as they are read: at a vertex, and blended over a cell.
template <int Dim, int Nodes, bool Axisymmetric>
struct Polynomials {
  using Body = ElasticCells<Dim, Nodes, Axisymmetric>;
  using Tensor = typename Body::Tensor;
  using Table = PatchTable<Dim, Nodes, Axisymmetric>;
  using Terms = typename Table::Terms;
  static constexpr int vertices = StaticElement<Dim, Nodes>::vertices;

  Body body;         //                                               in
  ReadColumns table; // (overlap nodes, PatchTable)                   in
  double on_axis;    // where u_r/r is du_r/dr, its limit  [m]        in

  KOKKOS_FUNCTION double trust(const LO vertex) const { return table(vertex, int(Table::trust)); }
  KOKKOS_FUNCTION double best_of(const LO cell) const
  {
    double best = 0;
    for (int a = 0; a < vertices; ++a) best = math::fmax(best, trust(body.cells(cell, a)));
    return best;
  }

  /// grad[j][i] += weight du_i / dx_j by the polynomial of a vertex at x, u_r/r its last entry, and dilatation += weight that
  /// which Hooke's law takes in a cell's block.
  KOKKOS_FUNCTION void add_at(const LO vertex, const LO cell, const double (&x)[Dim], const double weight, Tensor &grad,
                              double &dilatation) const
  {
    double L[Dim][Dim], dx[Dim][1], xi[Dim], term[Terms::size], slope[Terms::size][Dim];
    int column = Table::frame;
    for (int i = 0; i < Dim; ++i) {
      dx[i][0] = to_nearest_image(x[i] - table(vertex, Table::centre + i), body.period[i]);
      for (int j = 0; j <= i; ++j) L[i][j] = table(vertex, column++);
    }
    solve_lower(L, Dim, dx);
    for (int i = 0; i < Dim; ++i) xi[i] = dx[i][0];
    Terms::evaluate(xi, term, slope);
    double own[Dim][Dim] = {}; // (j, i) = du_i / dxi_j, then / dx_j
    for (int t = 1; t < Terms::size; ++t)
      for (int i = 0; i < Dim; ++i, ++column)
        for (int j = 0; j < Dim; ++j) own[j][i] += slope[t][j] * table(vertex, column);
    solve_lower_transposed(L, Dim, own);
    double trace = 0;
    for (int i = 0; i < Dim; ++i) trace += own[i][i];
    if constexpr (Axisymmetric) {
      double hoop = own[0][0];
      if (x[0] > on_axis) {
        double radial = table(vertex, int(Table::radial));
        for (int t = 1; t < Terms::size; ++t) radial += term[t] * table(vertex, Table::coefficients + Dim * (t - 1));
        hoop = radial / x[0];
      }
      trace += hoop;
      grad[Dim][Dim] += weight * hoop;
    }
    if constexpr (ElasticCells<Dim, Nodes>::may_project) {
      if (body.projects(cell)) {
        double of_dilatation[Table::Dilatation::size];
        Table::Dilatation::evaluate(xi, of_dilatation);
        trace = 0;
        for (int t = 0; t < Table::Dilatation::size; ++t)
          trace += of_dilatation[t] * table(vertex, Table::dilatation + t);
      }
    }
    dilatation += weight * trace;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) grad[j][i] += weight * own[j][i];
  }

  /// The same of the whole cell: each vertex's polynomial by its linear shape function, among those trusted as polynomials
  /// from inside or, where there are none, trusted most.                                              doc/theory.md (10.2)
  KOKKOS_FUNCTION void blend(const LO cell, const double (&x)[Dim], const double (&linear)[vertices], Tensor &grad,
                             double &dilatation) const
  {
    const double least = math::fmin(best_of(cell), double(Table::adopted));
    double sum = 0;
    for (int a = 0; a < vertices; ++a)
      if (trust(body.cells(cell, a)) >= least) sum += linear[a];
    // At a vertex that alone is not trusted, all others have the weight 0: then they count alike.
    const bool even = !(sum > 1e-8);
    int count = 0;
    for (int a = 0; a < vertices; ++a) count += trust(body.cells(cell, a)) >= least;
    dilatation = 0;
    for (auto &row : grad)
      for (double &entry : row) entry = 0;
    for (int a = 0; a < vertices; ++a)
      if (trust(body.cells(cell, a)) >= least)
        add_at(body.cells(cell, a), cell, x, even ? 1. / count : linear[a] / sum, grad, dilatation);
  }

  /// Twice the strain: strain2[i][j] = grad[i][j] + grad[j][i].
  static KOKKOS_FUNCTION void twice_strain(const Tensor &grad, double (&strain2)[3][3])
  {
    constexpr int columns = Body::columns;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        strain2[i][j] =
            i < columns && j < columns ? grad[i % columns][j % columns] + grad[j % columns][i % columns] : 0;
  }
};

/// The shape functions of order 1, those of the vertices, at the nodes of a cell: their values anywhere are sums with the shape
/// functions of the nodes.
template <int Dim, int Nodes>
struct VertexFunctions {
  static constexpr int vertices = StaticElement<Dim, Nodes>::vertices;

  double at_node[Nodes][vertices];

  /// Whether a node lies inside the edge, face or cell that ends in a vertex, or is that vertex.
  KOKKOS_INLINE_FUNCTION bool carries(const int node, const int vertex) const { return at_node[node][vertex] > 0; }

  VertexFunctions()
  {
    const ShapeFunctions<Dim, Nodes> of_nodes;
    const ShapeFunctions<Dim, vertices> of_vertices;
    for (int a = 0; a < Nodes; ++a) {
      double X[Dim], slope[vertices][Dim];
      of_nodes.node(a, X);
      of_vertices.evaluate(X, at_node[a], slope);
    }
  }
};

/// Stresses of a node from the polynomials around it.
template <int Dim, int Nodes, bool Axisymmetric>
struct EvaluatePatches {
  using Fitted = Polynomials<Dim, Nodes, Axisymmetric>;
  using Table = typename Fitted::Table;
  static constexpr int components = Components<Dim>::size, vertices = Fitted::vertices;

  Fitted polynomials;                 //                                  in
  DeviceView<std::size_t *> node_row; // (owned nodes + 1)                in
  DeviceView<LO *> node_cell;         // cells around nodes               in
  VertexFunctions<Dim, Nodes> linear; //                                  in
  WriteColumns result;                // (owned nodes, stress_names) [Pa] out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const LO first = node_cell(node_row(node));
    const int place = place_in(polynomials.body.cells, first, node);
    const auto &cells = polynomials.body.cells;
    double best = 0, own = 0; // trust in the polynomials around, and in those of the vertices that carry the node
    for (std::size_t k = node_row(node); k < node_row(node + 1); ++k)
      best = math::fmax(best, polynomials.best_of(node_cell(k)));
    for (int a = 0; a < vertices; ++a)
      if (linear.carries(place, a)) own = math::fmax(own, polynomials.trust(cells(first, a)));

    double s[components] = {};
    int count = 0;
    if (own == best && own != Table::across_blocks) {
      for (int a = 0; a < vertices; ++a)
        if (linear.carries(place, a)) add(node, first, a, best, s, count);
    } else {
      for (std::size_t k = node_row(node); k < node_row(node + 1); ++k) {
        // Between blocks each side has its say, however well it is fitted.
        const double of_cell = polynomials.best_of(node_cell(k));
        const double trust = own == Table::across_blocks && of_cell > Table::across_blocks ? of_cell : best;
        for (int a = 0; a < vertices; ++a) add(node, node_cell(k), a, trust, s, count);
      }
    }
    const int columns = polynomials.body.plane_stress ? 3 : components; // which has none across the plane
    for (int m = 0; m < components; ++m) s[m] /= count;
    for (int m = 0; m < columns; ++m) result(node, m) = s[m];
    result(node, columns) = von_mises(s);
  }

  /// s += the stress at a node by the polynomial of a cell's vertex and the material of that cell, if it is trusted
  /// enough.
  KOKKOS_FUNCTION void add(const LO node, const LO cell, const int a, const double trust, double (&s)[components],
                           int &count) const
  {
    const auto &body = polynomials.body;
    const LO vertex = body.cells(cell, a);
    if (polynomials.trust(vertex) < trust) return;
    double x[Dim], trace = 0, strain2[3][3]; // across the plane the strain is 0
    typename Fitted::Tensor grad = {};
    for (int i = 0; i < Dim; ++i) x[i] = body.coords(node, i);
    polynomials.add_at(vertex, cell, x, 1, grad, trace);
    polynomials.twice_strain(grad, strain2);
    const double lambda = body.lambda(cell), mu = body.mu(cell);
    for (int m = 0; m < components; ++m) {
      const int i = Components<Dim>::row(m), j = Components<Dim>::col(m);
      const bool across = i >= Dim;
      if (across && body.plane_stress) continue;
      s[m] += mu * strain2[i][j] + (i == j ? lambda * trace : 0);
    }
    ++count;
  }

  static KOKKOS_FUNCTION double von_mises(const double (&s)[components])
  {
    const double xx = s[0], yy = s[1], zz = s[Dim == 2 ? 3 : 2];
    double shear = s[Dim == 2 ? 2 : 3] * s[Dim == 2 ? 2 : 3];
    if constexpr (Dim == 3) shear += s[4] * s[4] + s[5] * s[5];
    const double spread = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
    return math::sqrt(0.5 * spread + 3 * shear);
  }
};

/// e(cell) = int (s* - s) : C^-1 (s* - s), s* the recovered stress and s that of u.                   doc/theory.md (10.2)
template <int Dim, int Nodes, bool Axisymmetric>
struct RecoveryDifference {
  using Fitted = Polynomials<Dim, Nodes, Axisymmetric>;
  using Body = typename Fitted::Body;

  Fitted polynomials;                 //                         in, the body with a rule for the difference's square
  VertexFunctions<Dim, Nodes> linear; //                         in
  ReadVector u;                       // (overlap dofs)    [m]   in
  DeviceView<double *> energy;        // (owned cells)     [J]   out

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    constexpr int vertices = Fitted::vertices;
    const Body &body = polynomials.body;
    const CellCoords<Dim, Nodes> coords(body.coords, body.places, cell);
    const double lambda = body.lambda(cell), mu = body.mu(cell);
    double sum = 0;
    body.at_points(cell, [&](const int q, const double volume, const typename Body::Gradients &dN,
                             const typename Body::Dilatation &of_dilatation) {
      double x[Dim], weight[vertices] = {}, dilatation = 0;
      typename Body::Tensor grad, own;
      position(coords, body.value, q, x);
      for (int a = 0; a < Nodes; ++a)
        for (int v = 0; v < vertices; ++v) weight[v] += body.value(q, a) * linear.at_node[a][v];
      polynomials.blend(cell, x, weight, grad, dilatation);
      body.displacement_gradient(u, cell, dN, own); // (i, j) = du_i / dx_j
      dilatation -= body.divergence(u, cell, of_dilatation);
      double density = lambda * dilatation * dilatation;
      for (int i = 0; i < Body::columns; ++i)
        for (int j = 0; j < Body::columns; ++j) {
          const double strain2 = grad[i][j] + grad[j][i] - own[i][j] - own[j][i];
          density += mu / 2 * strain2 * strain2;
        }
      sum += volume * density;
    });
    energy(cell) = sum;
  }
};

/// s* n at the points of a side's facets, n the body's outward normal.
template <int Dim, int Nodes, bool Axisymmetric>
struct RecoveredTraction {
  using Fitted = Polynomials<Dim, Nodes, Axisymmetric>;

  Fitted polynomials;                 //                                             in
  VertexFunctions<Dim, Nodes> linear; //                                             in
  DeviceView<LO **> facets;           // (facets, facet nodes)                       in
  DeviceView<LO *> cell;              // (facets)                                    in
  DeviceView<double **> value;        // (points, facet nodes)                       in
  DeviceView<double ***> gradient;    // (points, facet nodes, Dim - 1)              in
  DeviceView<double ***> traction;    // (facets, points, Dim)                 [Pa]  out

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    constexpr int vertices = Fitted::vertices;
    const auto &body = polynomials.body;
    const double lambda = body.lambda(cell(f)), mu = body.mu(cell(f));
    for (int q = 0; q < static_cast<int>(value.extent(0)); ++q) {
      double x[Dim] = {}, weight[vertices] = {}, trace = 0, strain2[3][3];
      typename Fitted::Tensor grad;
      for (std::size_t b = 0; b < facets.extent(1); ++b) {
        const int a = place_in(body.cells, cell(f), facets(f, b));
        for (int i = 0; i < Dim; ++i) x[i] += value(q, b) * body.coords(facets(f, b), i);
        for (int v = 0; v < vertices; ++v) weight[v] += value(q, b) * linear.at_node[a][v];
      }
      polynomials.blend(cell(f), x, weight, grad, trace);
      polynomials.twice_strain(grad, strain2);
      const auto area = area_normal(body.coords, facets, f, gradient, q);
      const double length = norm(area);
      for (int i = 0; i < Dim; ++i) {
        traction(f, q, i) = lambda * trace * area[i] / length;
        for (int j = 0; j < Dim; ++j) traction(f, q, i) += mu * strain2[i][j] * area[j] / length;
      }
    }
  }
};

} // namespace rpc::fem
