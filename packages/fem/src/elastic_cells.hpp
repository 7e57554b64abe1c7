// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kernels.hpp"
#include "patch_polynomial.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"

/// The cells of an elastic body as all its kernels see them: geometry, material, and one reading of the strain.
namespace rpc::fem
{

/// The L2 projection of the dilatation on polynomials over one cell, (2.6): 1, and in Q2 also the coordinates.
///
/// With e_k these polynomials made orthonormal, Z_k(ai) = int e_k D(ai) and Pi div u = sum_k e_k sum_ai Z_k(ai) u_ai, where
/// div u = sum D(ai) u_ai.
template <int Dim, int Nodes>
struct Projection {
  static constexpr bool linear = StaticElement<Dim, Nodes>::order == 2 && !StaticElement<Dim, Nodes>::simplex;
  static constexpr int modes = linear ? 1 + Dim : 1;
  using Gradients = double[Nodes][Dim];

  double centre[Dim];        // of the cell's nodes                         [m]
  double root[modes][modes]; // L with L L^T the products of the polynomials
  Gradients Z[modes];        //                                             [m^(Dim/2 - 1)]

  /// dilatation(a, i) with Pi div u = sum of dilatation(a, i) u_ai at a point [1/m].
  KOKKOS_FUNCTION void gradients(const double (&x)[Dim], Gradients &dilatation) const
  {
    double e[modes][1]; // [m^(-Dim/2)]
    monomials(x, e);
    solve_lower(root, modes, e);
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i) {
        dilatation[a][i] = 0;
        for (int k = 0; k < modes; ++k) dilatation[a][i] += e[k][0] * Z[k][a][i];
      }
  }
  KOKKOS_FUNCTION void monomials(const double (&x)[Dim], double (&term)[modes][1]) const
  {
    term[0][0] = 1;
    for (int k = 1; k < modes; ++k) term[k][0] = x[k - 1] - centre[k - 1];
  }
};

/// The way from a place to the nearest image of another one, along a direction.
/// @param period  0: there are no images
KOKKOS_INLINE_FUNCTION double to_nearest_image(const double way, const double period)
{
  if (period > 0 && way > period / 2) return way - period;
  if (period > 0 && way < -period / 2) return way + period;
  return way;
}

/// The cells of an elastic body: geometry, quadrature and material, with the dilatation in full or projected.
///
/// The gradient of a displacement is (Dim, Dim), of an axisymmetric body (3, 3) with u_r/r as its last entry; so are the
/// gradients of shape functions, whose last column is N_a/r then.                                    doc/theory.md (2.4a)
template <int Dim, int Nodes, bool Axisymmetric = false>
struct ElasticCells {
  /// All elements but P1, whose dilatation is constant; its kernels carry no code for that. (In axisymmetry it is not quite: P1
  /// locks all the same.)
  static constexpr bool may_project = !StaticElement<Dim, Nodes>::simplex || StaticElement<Dim, Nodes>::order > 1;
  static constexpr int columns = Dim + (Axisymmetric ? 1 : 0);
  using Gradients = double[Nodes][columns]; // dN_a/dx_i, and N_a/r       [1/m]
  using Dilatation = double[Nodes][Dim];    // D(ai): sum D u is div u    [1/m]
  using Tensor = double[columns][columns];
  using Coords = CellCoords<Dim, Nodes>;

  DeviceView<double **> coords;      // (places, Dim)         [m]   in
  DeviceView<LO **> places;          // (cells, Nodes)              in, rows of coords
  DeviceView<LO **> cells;           // (cells, Nodes)              in, overlap lids
  DeviceView<int *> block;           // (cells)                     in
  DeviceView<double **> value;       // (points, Nodes)             in
  DeviceView<double ***> gradient;   // (points, Nodes, Dim)        in
  DeviceView<double *> weight;       // (points)                    in
  DeviceView<double **> lame;        // (blocks; lambda, mu)  [Pa]  in
  DeviceView<int *> projected;       // (blocks) 0 or 1             in
  bool plane_stress;                 // no stress across the plane  in
  Kokkos::Array<double, 3> period{}; // 0: does not repeat itself   [m]   in
  // Of congruent cells, (kinds, points): gradients [1/m], and integration weights [m^Dim]. Empty: cells differ.
  DeviceView<signed char *> kind; // (cells)                            in
  DeviceView<double **[Nodes][columns]> kind_gradient;
  DeviceView<double **> kind_volume;

  KOKKOS_FUNCTION double lambda(const LO cell) const { return lame(block(cell), 0); }
  KOKKOS_FUNCTION double mu(const LO cell) const { return lame(block(cell), 1); }
  KOKKOS_FUNCTION bool projects(const LO cell) const { return projects_in(block(cell)); }
  KOKKOS_FUNCTION bool projects_in(const int of_block) const
  {
    if constexpr (!may_project) return false;
    return projected(of_block) != 0;
  }

  /// Whether component i of a translation is no strain.
  static KOKKOS_INLINE_FUNCTION constexpr bool translates(const int i) { return !(Axisymmetric && i == 0); }

  /// D(ai) from the gradients at a point.
  static KOKKOS_INLINE_FUNCTION double dilatation_of(const Gradients &dN, const int a, const int i)
  {
    if constexpr (Axisymmetric)
      if (i == 0) return dN[a][0] + dN[a][Dim];
    return dN[a][i];
  }

  /// u_ai less the translation of the first node. Gradients sum to 0 over the nodes; differences let a translation vanish to the
  /// last digit.
  /// @param u  (overlap dofs) [m]
  template <class U>
  KOKKOS_INLINE_FUNCTION double moved(const U &u, const LO cell, const int a, const int i) const
  {
    const double own = u(dof(Dim, cells(cell, a), i));
    return translates(i) ? own - u(dof(Dim, cells(cell, 0), i)) : own;
  }

  /// grad(i, j) = du_i / dx_j at a point of a cell, and u_r/r, from the gradients dN there.
  /// @param u  (overlap dofs) [m]
  template <class U>
  KOKKOS_FUNCTION void displacement_gradient(const U &u, const LO cell, const Gradients &dN, Tensor &grad) const
  {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        grad[i][j] = 0;
        for (int a = translates(i) ? 1 : 0; a < Nodes; ++a) grad[i][j] += moved(u, cell, a, i) * dN[a][j];
      }
    if constexpr (Axisymmetric) {
      for (int i = 0; i < Dim; ++i) grad[i][Dim] = grad[Dim][i] = 0;
      grad[Dim][Dim] = 0;
      for (int a = 0; a < Nodes; ++a) grad[Dim][Dim] += moved(u, cell, a, 0) * dN[a][Dim];
    }
  }

  /// sum of u_ai D(ai): div u at a point, or its projection.
  /// @param u  (overlap dofs) [m]
  template <class U>
  KOKKOS_FUNCTION double divergence(const U &u, const LO cell, const Dilatation &D) const
  {
    double sum = 0;
    for (int i = 0; i < Dim; ++i) {
      double slope = 0;
      for (int a = translates(i) ? 1 : 0; a < Nodes; ++a) slope += moved(u, cell, a, i) * D[a][i];
      sum += slope;
    }
    return sum;
  }

  /// Calls work(q, volume, dN, dilatation) at each quadrature point: its integration weight [m^Dim, axisymmetric: m^3], the
  /// gradients dN, and the dilatation D(ai), that of dN or projected.
  /// @return false if the Jacobian is <= 0 somewhere; points from there on have been left out
  template <class Work>
  KOKKOS_FUNCTION bool at_points(const LO cell, const Work &work) const
  {
    if constexpr (may_project) {
      if (projects(cell)) {
        const Coords x(coords, places, cell);
        Projection<Dim, Nodes> projection;
        if (!project(cell, projection)) return false;
        return at_plain_points(cell, [&](const int q, const double volume, const Gradients &dN) {
          double at[Dim];
          Dilatation dilatation;
          position(x, value, q, at);
          projection.gradients(at, dilatation);
          work(q, volume, dN, dilatation);
        });
      }
    }
    return at_plain_points(cell, [&](const int q, const double volume, const Gradients &dN) {
      if constexpr (Axisymmetric) {
        Dilatation dilatation;
        for (int a = 0; a < Nodes; ++a)
          for (int i = 0; i < Dim; ++i) dilatation[a][i] = dilatation_of(dN, a, i);
        work(q, volume, dN, dilatation);
      } else {
        work(q, volume, dN, dN);
      }
    });
  }

  /// @return false if the Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION bool project(const LO cell, Projection<Dim, Nodes> &projection) const
  {
    constexpr int modes = Projection<Dim, Nodes>::modes;
    const Coords x(coords, places, cell);
    for (int i = 0; i < Dim; ++i) {
      projection.centre[i] = 0;
      for (int a = 0; a < Nodes; ++a) projection.centre[i] += x.x[a][i] / Nodes;
    }
    double products[modes][modes] = {}, moments[modes][Nodes * Dim] = {};
    const bool good = at_plain_points(cell, [&](const int q, const double volume, const Gradients &dN) {
      double at[Dim], term[modes][1];
      position(x, value, q, at);
      projection.monomials(at, term);
      for (int k = 0; k < modes; ++k) {
        for (int l = 0; l < modes; ++l) products[k][l] += volume * term[k][0] * term[l][0];
        for (int a = 0; a < Nodes; ++a)
          for (int i = 0; i < Dim; ++i) moments[k][dof(Dim, a, i)] += volume * term[k][0] * dilatation_of(dN, a, i);
      }
    });
    if (!good || cholesky(products, 0) < modes) return false;
    solve_lower(products, modes, moments);
    for (int k = 0; k < modes; ++k) {
      for (int l = 0; l < modes; ++l) projection.root[k][l] = products[k][l];
      for (int a = 0; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) projection.Z[k][a][i] = moments[k][dof(Dim, a, i)];
    }
    return true;
  }

  /// Calls work(q, volume, dN) at each quadrature point.
  /// @return false if the Jacobian is <= 0 somewhere; points from there on have been left out
  template <class Work>
  KOKKOS_FUNCTION bool at_plain_points(const LO cell, const Work &work) const
  {
    const int points = static_cast<int>(weight.extent(0));
    Gradients dN;
    if (kind_volume.extent(0) > 0) {
      const int s = kind(cell);
      for (int q = 0; q < points; ++q) {
        if (!(kind_volume(s, q) > 0)) return false;
        for (int a = 0; a < Nodes; ++a)
          for (int i = 0; i < columns; ++i) dN[a][i] = kind_gradient(s, q, a, i);
        work(q, kind_volume(s, q), dN);
      }
      return true;
    }
    const Coords x(coords, places, cell);
    for (int q = 0; q < points; ++q) {
      const double det = physical_gradients(x, gradient, q, dN);
      if (!(det > 0)) return false;
      if constexpr (Axisymmetric) {
        double at[Dim];
        position(x, value, q, at);
        for (int a = 0; a < Nodes; ++a) dN[a][Dim] = value(q, a) / at[0];
        work(q, circle(at[0]) * weight(q) * det, dN);
      } else {
        work(q, weight(q) * det, dN);
      }
    }
    return true;
  }
};

/// The kinds of congruent cells as the cells of a body, without a table. They are in no block.
template <int Dim, int Nodes, bool Axisymmetric>
ElasticCells<Dim, Nodes, Axisymmetric> kinds_of(const CongruentCells &congruent,
                                                ElasticCells<Dim, Nodes, Axisymmetric> body)
{
  body.coords = congruent.coords;
  body.places = congruent.cells;
  body.cells = congruent.cells;
  body.kind_volume = {};
  return body;
}

/// Gradients and volumes at the points of each kind of congruent cells; 0 from the first point on whose Jacobian is <= 0.
template <int Dim, int Nodes>
struct TabulateKind {
  ElasticCells<Dim, Nodes> body;                   // kinds_of()                         in
  DeviceView<double **[Nodes][Dim]> kind_gradient; // (kinds, points, Nodes, Dim) [1/m]  out
  DeviceView<double **> kind_volume;               // (kinds, points)           [m^Dim]  out

  KOKKOS_FUNCTION void operator()(const LO s) const
  {
    body.at_plain_points(s, [&](const int q, const double volume, const double(&dN)[Nodes][Dim]) {
      kind_volume(s, q) = volume;
      for (int a = 0; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) kind_gradient(s, q, a, i) = dN[a][i];
    });
  }
};

/// @param table  points in a cell
/// @throws rpc::Error (bad_input) if the materials do not fit the mesh
template <int Dim, int Nodes, bool Axisymmetric = false>
ElasticCells<Dim, Nodes, Axisymmetric> elastic_cells(const Discretization &d, const Materials &materials,
                                                     const BasisTable &table)
{
  const mesh::Mesh &mesh = *d.mesh;
  ElasticCells<Dim, Nodes, Axisymmetric> body;
  body.coords = mesh.coords;
  body.places = mesh.places();
  body.cells = mesh.cells;
  body.block = mesh.block;
  body.value = table.value;
  body.gradient = table.gradient;
  body.weight = table.weight;
  body.lame = lame_table(d, materials);
  body.projected = projected_dilatation_table(d, materials);
  body.plane_stress = d.kinematics == Kinematics::plane_stress;
  for (int i = 0; i < Dim; ++i) body.period[i] = mesh.box ? mesh.box->period(i) : 0;
  if (d.congruent.size() == 0) return body;
  if constexpr (!Axisymmetric) {
    const DeviceView<double **[Nodes][Dim]> gradient("rpc::fem::kind_gradient", d.congruent.size(), table.num_points());
    const DeviceView<double **> volume("rpc::fem::kind_volume", d.congruent.size(), table.num_points());
    const TabulateKind<Dim, Nodes> tabulate{kinds_of(d.congruent, body), gradient, volume};
    Kokkos::parallel_for("rpc::fem::tabulate_kinds", device_range(d.congruent.size()), tabulate);
    body.kind = d.congruent.of_cell;
    body.kind_gradient = gradient;
    body.kind_volume = volume;
  }
  return body;
}
template <int Dim, int Nodes, bool Axisymmetric = false>
ElasticCells<Dim, Nodes, Axisymmetric> elastic_cells(const Discretization &d, const Materials &materials)
{
  return elastic_cells<Dim, Nodes, Axisymmetric>(d, materials, d.reference.cell);
}

/// Calls work(cells) with the cells of a body, by its element and kinematics.
template <class Work>
void with_elastic_cells(const Discretization &d, const Materials &materials, const BasisTable &table, const Work &work)
{
  with_static_extents(d.mesh->element, [&](const auto dim, const auto nodes) {
    if constexpr (dim == 2)
      if (d.axisymmetric()) return work(elastic_cells<dim, nodes, true>(d, materials, table));
    return work(elastic_cells<dim, nodes>(d, materials, table));
  });
}
template <class Work>
void with_elastic_cells(const Discretization &d, const Materials &materials, const Work &work)
{
  with_elastic_cells(d, materials, d.reference.cell, work);
}

} // namespace rpc::fem
