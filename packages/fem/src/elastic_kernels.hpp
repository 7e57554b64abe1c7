#pragma once

#include "kernels.hpp"
#include "patch_polynomial.hpp"
#include "rpc/fem/elasticity.hpp"

/// The kernels of elasticity: stiffness, energy and internal forces of one cell, with one reading of the strain.
namespace rpc::fem
{

using ReadVector = decltype(device_read(std::declval<const Vector &>()));
using WriteVector = decltype(device_write(std::declval<Vector &>()));

/// The L2 projection of the dilatation on polynomials over one cell, (2.11): 1, and in Q2 also the coordinates.
///
/// With e_k these polynomials made orthonormal, Z_k(ai) = int e_k dN_a/dx_i and Pi div u = sum_k e_k sum_ai Z_k(ai) u_ai.
template <int Dim, int Nodes>
struct Projection {
  static constexpr int modes = Nodes == 9 ? 1 + Dim : 1;
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

/// The cells of an elastic body: geometry, quadrature and material, with the dilatation in full or projected.
template <int Dim, int Nodes>
struct ElasticCells {
  /// All elements but P1, whose dilatation is constant; its kernels carry no code for that.
  static constexpr bool may_project = Nodes > Dim + 1;
  using Gradients = double[Nodes][Dim];
  using Coords = CellCoords<Dim, Nodes>;

  DeviceView<double **> coords;    // (overlap nodes, Dim)  [m]   in
  DeviceView<LO **> cells;         // (cells, Nodes)              in, overlap lids
  DeviceView<int *> block;         // (cells)                     in
  DeviceView<double **> value;     // (points, Nodes)             in
  DeviceView<double ***> gradient; // (points, Nodes, Dim)        in
  DeviceView<double *> weight;     // (points)                    in
  DeviceView<double **> lame;      // (blocks; lambda, mu)  [Pa]  in
  DeviceView<int *> projected;     // (blocks) 0 or 1             in

  KOKKOS_FUNCTION double lambda(const LO cell) const { return lame(block(cell), 0); }
  KOKKOS_FUNCTION double mu(const LO cell) const { return lame(block(cell), 1); }
  KOKKOS_FUNCTION bool projects(const LO cell) const
  {
    if constexpr (!may_project) return false;
    return projected(block(cell)) != 0;
  }

  /// Calls work(volume, dN, dilatation) at each quadrature point: what the point stands for [m^Dim], the gradients dN(a, i)
  /// [1/m], and those whose sum with u_ai is the dilatation: dN again, or the projected ones.
  /// @return false if the Jacobian is <= 0 somewhere; points from there on have been left out
  template <class Work>
  KOKKOS_FUNCTION bool at_points(const LO cell, const Work &work) const
  {
    if constexpr (may_project) {
      if (projects(cell)) {
        const Coords x(coords, cells, cell);
        Projection<Dim, Nodes> projection;
        if (!project(cell, projection)) return false;
        return at_plain_points(cell, [&](const int q, const double volume, const Gradients &dN) {
          double at[Dim];
          Gradients dilatation;
          position(x, value, q, at);
          projection.gradients(at, dilatation);
          work(volume, dN, dilatation);
        });
      }
    }
    return at_plain_points(cell, [&](int, const double volume, const Gradients &dN) { work(volume, dN, dN); });
  }

  /// @return false if the Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION bool project(const LO cell, Projection<Dim, Nodes> &projection) const
  {
    constexpr int modes = Projection<Dim, Nodes>::modes;
    const Coords x(coords, cells, cell);
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
          for (int i = 0; i < Dim; ++i) moments[k][Dim * a + i] += volume * term[k][0] * dN[a][i];
      }
    });
    if (!good || cholesky(products, 0) < modes) return false;
    solve_lower(products, modes, moments);
    for (int k = 0; k < modes; ++k) {
      for (int l = 0; l < modes; ++l) projection.root[k][l] = products[k][l];
      for (int a = 0; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) projection.Z[k][a][i] = moments[k][Dim * a + i];
    }
    return true;
  }

  /// Calls work(q, volume, dN) at each quadrature point.
  /// @return false if the Jacobian is <= 0 somewhere; points from there on have been left out
  template <class Work>
  KOKKOS_FUNCTION bool at_plain_points(const LO cell, const Work &work) const
  {
    const Coords x(coords, cells, cell);
    for (int q = 0; q < static_cast<int>(weight.extent(0)); ++q) {
      Gradients dN;
      const double det = physical_gradients(x, gradient, q, dN);
      if (!(det > 0)) return false;
      work(q, weight(q) * det, dN);
    }
    return true;
  }
};

/// @throws rpc::Error (bad_input) if the materials do not fit the mesh
template <int Dim, int Nodes>
ElasticCells<Dim, Nodes> elastic_cells(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  const BasisTable &table = d.reference.cell;
  return {mesh.coords,
          mesh.cells,
          mesh.block,
          table.value,
          table.gradient,
          table.weight,
          lame_table(mesh, materials),
          projected_dilatation_table(mesh, materials)};
}

/// K += stiffness of one cell. Entries are found once per pair of nodes: a node's rows share their columns.
template <int Dim, int Nodes>
struct Stiffness {
  static constexpr int dofs = Dim * Nodes;
  using Gradients = double[Nodes][Dim];

  ElasticCells<Dim, Nodes> body;      //                                    in
  DeviceView<std::size_t *> node_row; // (owned nodes + 1)                  in
  DeviceView<LO *> node_col;          // (node graph)                       in
  LO num_owned;                       // rows of nodes >= this are another rank's
  DeviceView<double *> values;        // (matrix entries)            [N/m]  inout

  /// @param bad  counts cells whose Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION void operator()(const LO cell, LO &bad) const
  {
    double product[dofs][dofs];
    if (!integrate(cell, product)) {
      ++bad;
      return;
    }
    Projection<Dim, Nodes> projection;
    const bool projects = body.projects(cell) && body.project(cell, projection);
    const double lambda = body.lambda(cell), mu = body.mu(cell);
    for (int a = 0; a < Nodes; ++a) {
      const LO node = body.cells(cell, a);
      if (node >= num_owned) continue;
      const std::size_t begin = node_row(node), length = node_row(node + 1) - begin;
      for (int b = 0; b < Nodes; ++b) {
        double trace = 0;
        for (int k = 0; k < Dim; ++k) trace += product[Dim * a + k][Dim * b + k];
        const std::size_t at = find(begin, length, body.cells(cell, b));
        for (int i = 0; i < Dim; ++i) {
          double *const entry = &values(Dim * (Dim * begin + i * length + at));
          for (int j = 0; j < Dim; ++j) {
            double dilatation = product[Dim * a + i][Dim * b + j];
            if (projects) {
              dilatation = 0;
              for (const auto &Z : projection.Z) dilatation += Z[a][i] * Z[b][j];
            }
            double k = lambda * dilatation + mu * product[Dim * a + j][Dim * b + i];
            if (i == j) k += mu * trace;
            add_shared(entry[j], k); // cells share rows
          }
        }
      }
    }
  }

  /// product(ai, bj) = int dN_a/dx_i dN_b/dx_j.    @return false if the Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION bool integrate(const LO cell, double (&product)[dofs][dofs]) const
  {
    for (int r = 0; r < dofs; ++r)
      for (int c = 0; c < dofs; ++c) product[r][c] = 0;
    return body.at_plain_points(cell, [&](int, const double volume, const Gradients &dN) {
      for (int a = 0; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i)
          for (int b = 0; b < Nodes; ++b)
            for (int j = 0; j < Dim; ++j) product[Dim * a + i][Dim * b + j] += volume * dN[a][i] * dN[b][j];
    });
  }

  /// Place of a node in a row of the node graph; it is there, for the graph was made of these cells.
  KOKKOS_FUNCTION std::size_t find(const std::size_t begin, const std::size_t length, const LO node) const
  {
    std::size_t low = 0, high = length;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      if (node_col(begin + middle) <= node)
        low = middle;
      else
        high = middle;
    }
    return low;
  }
};

/// energy += int sigma(u) : eps(u) over one cell.
template <int Dim, int Nodes>
struct StrainEnergy {
  using Gradients = double[Nodes][Dim];

  ElasticCells<Dim, Nodes> body; //                       in
  ReadVector u;                  // (overlap dofs)  [m]   in

  KOKKOS_FUNCTION void operator()(const LO cell, double &energy) const
  {
    const double lambda = body.lambda(cell), mu = body.mu(cell);
    body.at_points(cell, [&](const double volume, const Gradients &dN, const Gradients &dilatation) {
      double grad[Dim][Dim];
      displacement_gradient(u, body.cells, cell, dN, grad);
      const double trace = divergence(u, body.cells, cell, dilatation);
      double product = 0;
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) product += 0.25 * (grad[i][j] + grad[j][i]) * (grad[i][j] + grad[j][i]);
      energy += volume * (lambda * trace * trace + 2 * mu * product);
    });
  }
};

/// f(a, i) = int sigma(u) : grad(N_a e_i) over one cell [N].
template <int Dim, int Nodes>
KOKKOS_FUNCTION void cell_forces(const ElasticCells<Dim, Nodes> &body, const LO cell, const ReadVector &u,
                                 double (&force)[Nodes][Dim])
{
  for (int a = 0; a < Nodes; ++a)
    for (int i = 0; i < Dim; ++i) force[a][i] = 0;
  const double lambda = body.lambda(cell), mu = body.mu(cell);
  body.at_points(cell, [&](const double volume, const double(&dN)[Nodes][Dim], const double(&dilatation)[Nodes][Dim]) {
    double grad[Dim][Dim];
    displacement_gradient(u, body.cells, cell, dN, grad);
    const double trace = divergence(u, body.cells, cell, dilatation);
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i) {
        double sum = lambda * trace * dilatation[a][i];
        for (int j = 0; j < Dim; ++j) sum += mu * (grad[i][j] + grad[j][i]) * dN[a][j];
        force[a][i] += volume * sum;
      }
  });
}

/// f(ai) += cell_forces of one cell.
template <int Dim, int Nodes>
struct InternalForces {
  ElasticCells<Dim, Nodes> body; //                       in
  ReadVector u;                  // (overlap dofs)  [m]   in
  LO num_owned;                  // nodes
  WriteVector force;             // (owned dofs)    [N]   inout

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    double own[Nodes][Dim];
    cell_forces(body, cell, u, own);
    for (int a = 0; a < Nodes; ++a) {
      const LO node = body.cells(cell, a);
      for (int i = 0; i < Dim && node < num_owned; ++i) add_shared(force(Dim * node + i), own[a][i]);
    }
  }
};

/// squares += |cell_forces|^2 of one cell [N^2].
template <int Dim, int Nodes>
struct CellForceSquares {
  ElasticCells<Dim, Nodes> body; //                       in
  ReadVector u;                  // (overlap dofs)  [m]   in

  KOKKOS_FUNCTION void operator()(const LO cell, double &squares) const
  {
    double own[Nodes][Dim];
    cell_forces(body, cell, u, own);
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i) squares += own[a][i] * own[a][i];
  }
};

} // namespace rpc::fem
