#pragma once

#include "around_nodes.hpp"
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

/// The cells of an elastic body: geometry, quadrature and material, with the dilatation in full or projected.
template <int Dim, int Nodes>
struct ElasticCells {
  /// All elements but P1, whose dilatation is constant; its kernels carry no code for that.
  static constexpr bool may_project = !StaticElement<Dim, Nodes>::simplex || StaticElement<Dim, Nodes>::order > 1;
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
  // Of congruent cells, (kinds, points): gradients [1/m], and what a point stands for [m^Dim]. Empty: cells differ.
  DeviceView<signed char *> kind; // (cells)                            in
  DeviceView<double **[Nodes][Dim]> kind_gradient;
  DeviceView<double **> kind_volume;

  KOKKOS_FUNCTION double lambda(const LO cell) const { return lame(block(cell), 0); }
  KOKKOS_FUNCTION double mu(const LO cell) const { return lame(block(cell), 1); }
  KOKKOS_FUNCTION bool projects(const LO cell) const { return projects_in(block(cell)); }
  KOKKOS_FUNCTION bool projects_in(const int of_block) const
  {
    if constexpr (!may_project) return false;
    return projected(of_block) != 0;
  }

  /// Calls work(q, volume, dN, dilatation) at each quadrature point: what the point stands for [m^Dim], the gradients dN(a, i)
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
          work(q, volume, dN, dilatation);
        });
      }
    }
    return at_plain_points(cell,
                           [&](const int q, const double volume, const Gradients &dN) { work(q, volume, dN, dN); });
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
          for (int i = 0; i < Dim; ++i) moments[k][dof(Dim, a, i)] += volume * term[k][0] * dN[a][i];
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
          for (int i = 0; i < Dim; ++i) dN[a][i] = kind_gradient(s, q, a, i);
        work(q, kind_volume(s, q), dN);
      }
      return true;
    }
    const Coords x(coords, cells, cell);
    for (int q = 0; q < points; ++q) {
      const double det = physical_gradients(x, gradient, q, dN);
      if (!(det > 0)) return false;
      work(q, weight(q) * det, dN);
    }
    return true;
  }
};

/// Gradients and volumes at the points of each kind of congruent cells; 0 from the first point on whose Jacobian is <= 0.
template <int Dim, int Nodes>
struct TabulateKind {
  ElasticCells<Dim, Nodes> body;                   //                                     in, without a table
  DeviceView<LO *> example;                        // (kinds)                            in
  DeviceView<double **[Nodes][Dim]> kind_gradient; // (kinds, points, Nodes, Dim) [1/m]  out
  DeviceView<double **> kind_volume;               // (kinds, points)           [m^Dim]  out

  KOKKOS_FUNCTION void operator()(const LO s) const
  {
    body.at_plain_points(example(s), [&](const int q, const double volume, const double(&dN)[Nodes][Dim]) {
      kind_volume(s, q) = volume;
      for (int a = 0; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) kind_gradient(s, q, a, i) = dN[a][i];
    });
  }
};

/// @param table  points in a cell
/// @throws rpc::Error (bad_input) if the materials do not fit the mesh
template <int Dim, int Nodes>
ElasticCells<Dim, Nodes> elastic_cells(const Discretization &d, const Materials &materials, const BasisTable &table)
{
  const mesh::Mesh &mesh = *d.mesh;
  ElasticCells<Dim, Nodes> body;
  body.coords = mesh.coords;
  body.cells = mesh.cells;
  body.block = mesh.block;
  body.value = table.value;
  body.gradient = table.gradient;
  body.weight = table.weight;
  body.lame = lame_table(mesh, materials);
  body.projected = projected_dilatation_table(mesh, materials);
  if (d.congruent.size() == 0) return body;
  const DeviceView<double **[Nodes][Dim]> gradient("rpc::fem::kind_gradient", d.congruent.size(), table.num_points());
  const DeviceView<double **> volume("rpc::fem::kind_volume", d.congruent.size(), table.num_points());
  const TabulateKind<Dim, Nodes> tabulate{body, d.congruent.example, gradient, volume};
  Kokkos::parallel_for("rpc::fem::tabulate_kinds", device_range(d.congruent.size()), tabulate);
  body.kind = d.congruent.of_cell;
  body.kind_gradient = gradient;
  body.kind_volume = volume;
  return body;
}
template <int Dim, int Nodes>
ElasticCells<Dim, Nodes> elastic_cells(const Discretization &d, const Materials &materials)
{
  return elastic_cells<Dim, Nodes>(d, materials, d.reference.cell);
}

/// The stiffness of one cell, if it was of a block's material.                                     doc/theory.md (2.4)
template <int Dim, int Nodes>
struct CellStiffness {
  static constexpr int dofs = Dim * Nodes;
  using Gradients = double[Nodes][Dim];

  ElasticCells<Dim, Nodes> body; // in

  /// @param[out] k  (dofs, dofs) [N/m]
  /// @return false if the Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION bool operator()(const LO cell, const int block, double (&k)[dofs][dofs]) const
  {
    if (!integrate(cell, k)) return false;
    Projection<Dim, Nodes> projection;
    const bool projects = body.projects_in(block) && body.project(cell, projection);
    const double lambda = body.lame(block, 0), mu = body.lame(block, 1);
    for (int a = 0; a < Nodes; ++a)
      for (int b = 0; b < Nodes; ++b) {
        double product[Dim][Dim], trace = 0;
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) product[i][j] = k[dof(Dim, a, i)][dof(Dim, b, j)];
        for (int i = 0; i < Dim; ++i) trace += product[i][i];
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) {
            double dilatation = product[i][j];
            if (projects) {
              dilatation = 0;
              for (const auto &Z : projection.Z) dilatation += Z[a][i] * Z[b][j];
            }
            double &entry = k[dof(Dim, a, i)][dof(Dim, b, j)];
            entry = lambda * dilatation + mu * product[j][i];
            if (i == j) entry += mu * trace;
          }
      }
    return true;
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
            for (int j = 0; j < Dim; ++j) product[dof(Dim, a, i)][dof(Dim, b, j)] += volume * dN[a][i] * dN[b][j];
    });
  }
};

/// Place of a node in its row of the node graph, sorted; it is there, for the graph was made of these cells.
KOKKOS_INLINE_FUNCTION LO place_in_row(const DeviceView<LO *> &col, const std::size_t begin, const LO length,
                                       const LO node)
{
  LO low = 0;
  for (LO rest = length; rest > 1;) { // no branch on what is found: searches of a row overlap
    const LO half = rest / 2;
    low += half * (col(begin + low + half) <= node);
    rest -= half;
  }
  return low;
}

/// K += stiffness of one cell, by one thread. Entries are found once per pair of nodes, whose rows share their columns.
template <int Dim, int Nodes>
struct AddStiffness {
  static constexpr int dofs = Dim * Nodes;

  CellStiffness<Dim, Nodes> stiffness; //                             in
  NodeGraph nodes;                     //                             in
  LO num_owned;                        // rows of nodes >= this are another rank's
  DeviceView<double *> values;         // (matrix entries)     [N/m]  inout

  /// @param bad  counts cells whose Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION void operator()(const LO cell, LO &bad) const
  {
    const auto &cells = stiffness.body.cells;
    double k[dofs][dofs];
    if (!stiffness(cell, stiffness.body.block(cell), k)) {
      ++bad;
      return;
    }
    for (int a = 0; a < Nodes; ++a) {
      const LO node = cells(cell, a);
      if (node >= num_owned) continue;
      const std::size_t begin = nodes.row(node);
      const LO length = static_cast<LO>(nodes.row(node + 1) - begin);
      for (int b = 0; b < Nodes; ++b) {
        const LO at = place_in_row(nodes.col, begin, length, cells(cell, b));
        for (int i = 0; i < Dim; ++i) {
          double *const entry = &values(Dim * (Dim * begin + i * length + at));
          for (int j = 0; j < Dim; ++j) entry[j] += k[dof(Dim, a, i)][dof(Dim, b, j)]; // cells share rows
        }
      }
    }
  }
};

/// The stiffness of each cell from a first one on: what many threads, which must not share rows, add node by node.
template <int Dim, int Nodes>
struct TabulateCells {
  static constexpr int dofs = Dim * Nodes;

  CellStiffness<Dim, Nodes> stiffness;     //                             in
  LO first;                                // cell
  DeviceView<double *[dofs][dofs]> matrix; // (cells, dofs, dofs)  [N/m]  out

  /// @param bad  counts cells whose Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION void operator()(const LO m, LO &bad) const
  {
    double k[dofs][dofs];
    if (!stiffness(first + m, stiffness.body.block(first + m), k)) {
      ++bad;
      return;
    }
    for (int r = 0; r < dofs; ++r)
      for (int c = 0; c < dofs; ++c) matrix(m, r, c) = k[r][c];
  }
};

/// The rows of one node of K += its tabulated cells, in their order.
template <int Dim, int Nodes>
struct AddTabulated {
  static constexpr int dofs = Dim * Nodes;

  DeviceView<LO **> cells;                 // (cells, Nodes)                       in, overlap lids
  LO first, last;                          // tabulated cells, without the last
  DeviceView<double *[dofs][dofs]> matrix; // (tabulated cells, dofs, dofs) [N/m]  in
  NodeToCells node_to_cells;               //                                      in
  NodeGraph nodes;                         //                                      in
  DeviceView<double *> values;             // (matrix entries)              [N/m]  inout

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const std::size_t begin = nodes.row(node);
    const LO length = static_cast<LO>(nodes.row(node + 1) - begin);
    double *const rows = &values(Dim * Dim * begin);
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k) {
      const LO cell = node_to_cells.cell(k);
      if (cell < first || cell >= last) continue;
      const int a = place_in(cells, cell, node);
      for (int b = 0; b < Nodes; ++b) {
        const LO at = place_in_row(nodes.col, begin, length, cells(cell, b));
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j)
            rows[Dim * (i * length + at) + j] += matrix(cell - first, dof(Dim, a, i), dof(Dim, b, j));
      }
    }
  }
};

/// Rounds the entries of a cell's stiffness so that they, and sums over the cells around a node, are exact, and lets a
/// translation have no force at all. The rounding of a cell by itself is noise, but that of a kind is the same force on all
/// its cells: 1e-16 of each would be as much as a spring of 1e-16 times the number of cells on the whole body.
template <int Nodes, int Dofs>
KOKKOS_INLINE_FUNCTION void balance(double (&k)[Dofs][Dofs])
{
  constexpr int dim = Dofs / Nodes;
  double largest = 0, power = 1;
  for (int r = 0; r < Dofs; ++r)
    for (int c = 0; c < Dofs; ++c) {
      const double size = k[r][c] < 0 ? -k[r][c] : k[r][c];
      if (!(size <= largest)) largest = size;
    }
  if (!(largest > 1e-290 && largest < 1e290)) return;
  while (power < largest) power *= 2;
  while (power > largest) power /= 2;
  const double coarse = 24 * power; // whose last digit all entries are multiples of; 16 entries add up without rounding
  for (int r = 0; r < Dofs; ++r)
    for (int c = r + 1; c < Dofs; ++c) k[r][c] = k[c][r] = (k[r][c] + coarse) - coarse;
  for (int r = 0; r < Dofs; ++r)
    for (int j = 0; j < dim; ++j) {
      double others = 0;
      for (int b = 0; b < Nodes; ++b)
        if (b != node_of(dim, r)) others += k[r][dof(dim, b, j)];
      k[r][dof(dim, node_of(dim, r), j)] = -others;
    }
}

/// The stiffness of a cell of each kind in each block: matrix(kind * blocks + block).
template <int Dim, int Nodes>
struct TabulateStiffness {
  static constexpr int dofs = Dim * Nodes;

  CellStiffness<Dim, Nodes> stiffness;     //                                 in
  DeviceView<LO *> example;                // (kinds)                        in
  int num_blocks;                          //                                 in
  DeviceView<double *[dofs][dofs]> matrix; // (kinds * blocks, dofs, dofs)  [N/m]  out

  /// @param bad  counts kinds whose Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION void operator()(const LO m, LO &bad) const
  {
    double k[dofs][dofs];
    if (!stiffness(example(m / num_blocks), m % num_blocks, k)) ++bad;
    balance<Nodes>(k);
    for (int r = 0; r < dofs; ++r)
      for (int c = 0; c < dofs; ++c) matrix(m, r, c) = k[r][c];
  }
};

/// The rows of one node of K, from the tabulated stiffness of the cells around it: each entry is written by one thread alone,
/// and leaves the cache once.
template <int Dim, int Nodes>
struct NodeStiffness {
  static constexpr int dofs = Dim * Nodes;

  DeviceView<LO **> cells;                 // (cells, Nodes)                         in, overlap lids
  DeviceView<int *> block;                 // (cells)                                in
  DeviceView<signed char *> kind;          // (cells)                                in
  DeviceView<double *[dofs][dofs]> matrix; // (kinds * blocks, dofs, dofs)   [N/m]  in
  int num_blocks;                          //                                        in
  LO num_owned;                            // nodes
  NodeToCells node_to_cells;               //                                        in
  NodeGraph nodes;                         //                                        in
  DeviceView<double *> values;             // (matrix entries)                [N/m]  out

  KOKKOS_FUNCTION void gather(const LO node) const
  {
    const std::size_t begin = nodes.row(node);
    const LO length = static_cast<LO>(nodes.row(node + 1) - begin);
    double *const rows = &values(Dim * Dim * begin);
    for (LO k = 0; k < Dim * Dim * length; ++k) rows[k] = 0;
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k) {
      const LO cell = node_to_cells.cell(k);
      const int m = kind(cell) * num_blocks + block(cell);
      int a = 0;
      while (cells(cell, a) != node) ++a;
      for (int b = 0; b < Nodes; ++b) {
        const LO at = place_in_row(nodes.col, begin, length, cells(cell, b));
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) rows[Dim * (i * length + at) + j] += matrix(m, dof(Dim, a, i), dof(Dim, b, j));
      }
    }
  }

  /// Whether the cells around two nodes are the same ones, but for a shift of all numbers: then so are the rows.
  KOKKOS_FUNCTION bool same_rows(const LO node, const LO other) const
  {
    const std::size_t first = node_to_cells.row(node), of_other = node_to_cells.row(other),
                      count = node_to_cells.row(node + 1) - first;
    if (node_to_cells.row(other + 1) - of_other != count) return false;
    int differs = 0;
    for (std::size_t k = 0; k < count && differs == 0; ++k) {
      const LO c = node_to_cells.cell(first + k), d = node_to_cells.cell(of_other + k);
      differs = (kind(c) != kind(d)) | (block(c) != block(d));
      for (int b = 0; b < Nodes; ++b) differs |= cells(c, b) - cells(d, b) != node - other;
    }
    return differs == 0;
  }

  KOKKOS_FUNCTION void copy(const LO node, const LO from) const
  {
    const std::size_t begin = nodes.row(from), size = Dim * Dim * (nodes.row(from + 1) - begin);
    const double *const source = &values(Dim * Dim * begin);
    double *const rows = &values(Dim * Dim * nodes.row(node));
    for (std::size_t k = 0; k < size; ++k) rows[k] = source[k];
  }
};

/// The rows of one cell's nodes, for others to copy.
template <int Dim, int Nodes>
struct GatherExamples {
  NodeStiffness<Dim, Nodes> stiffness;
  LO example; // cell

  KOKKOS_FUNCTION void operator()(const LO a) const
  {
    const LO node = stiffness.cells(example, a);
    if (node < stiffness.num_owned) stiffness.gather(node);
  }
};

/// All other rows: copied where a mesh repeats itself, which costs a third of gathering them.
template <int Dim, int Nodes>
struct GatherStiffness {
  NodeStiffness<Dim, Nodes> stiffness;
  LO example; // cell

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    for (int a = 0; a < Nodes; ++a) {
      const LO other = stiffness.cells(example, a);
      if (other == node) return;
      if (other < stiffness.num_owned && stiffness.same_rows(node, other)) return stiffness.copy(node, other);
    }
    stiffness.gather(node);
  }
};

/// The same in two passes, for GPUs: where rows repeat, fill_entries() copies them.
template <int Dim, int Nodes>
struct GatherOrFindSource {
  NodeStiffness<Dim, Nodes> stiffness;
  LO example;              // cell
  DeviceView<LO *> source; // (owned nodes) whose rows are to be copied; -1 where nothing is left to do   out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    source(node) = -1;
    for (int a = 0; a < Nodes; ++a) {
      const LO other = stiffness.cells(example, a);
      if (other == node) return;
      if (other < stiffness.num_owned && stiffness.same_rows(node, other)) {
        source(node) = other;
        return;
      }
    }
    stiffness.gather(node);
  }
};

/// The rows that repeat those of another node.                                        for fill_entries()
template <int Dim>
struct CopiedRows {
  NodeGraph nodes;             //                                              in
  DeviceView<LO *> source;     // (owned nodes) as of GatherOrFindSource       in
  DeviceView<double *> values; // (matrix entries)                      [N/m]  in

  KOKKOS_FUNCTION bool has(const LO node) const { return source(node) >= 0; }
  KOKKOS_FUNCTION double value(const LO node, const std::size_t entry) const
  {
    return values(Dim * Dim * nodes.row(source(node)) + entry);
  }
};

/// What a displacement does in one cell: f(ai) += int sigma(u) : grad(N_a e_i) to the cell's nodes, and sums over the cells
/// that this rank owns.
template <int Dim, int Nodes>
struct InternalWorkOfCell {
  using Gradients = double[Nodes][Dim];

  ElasticCells<Dim, Nodes> body; //                       in
  ReadVector u;                  // (overlap dofs)  [m]   in
  LO num_owned;                  // nodes
  LO num_owned_cells;
  WriteVector force;                      // (owned dofs)           [N]  inout, by one thread
  DeviceView<double *[Nodes][Dim]> share; // (cells, Nodes, Dim)    [N]  out, by many: what the cell adds to force

  /// @param squares  += |forces of this cell|^2 [N^2]
  /// @param energy   += int sigma(u) : eps(u) [J]
  KOKKOS_FUNCTION void operator()(const LO cell, double &squares, double &energy) const
  {
    const int block = body.block(cell);
    const double lambda = body.lame(block, 0), mu = body.lame(block, 1);
    double own[Nodes][Dim] = {}, moved[Nodes][Dim], of_cell = 0;
    // Gradients sum to 0 over the nodes; differences let a translation vanish to the last digit.
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i)
        moved[a][i] = u(dof(Dim, body.cells(cell, a), i)) - u(dof(Dim, body.cells(cell, 0), i));
    body.at_points(cell, [&](int, const double volume, const Gradients &dN, const Gradients &dilatation) {
      double stress[Dim][Dim], trace = 0, product = 0; // without the part of the dilatation
      for (int i = 0; i < Dim; ++i)
        for (int a = 1; a < Nodes; ++a) trace += moved[a][i] * dilatation[a][i];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j <= i; ++j) {
          double strain = 0; // twice
          for (int a = 1; a < Nodes; ++a) strain += moved[a][i] * dN[a][j] + moved[a][j] * dN[a][i];
          stress[i][j] = stress[j][i] = volume * mu * strain;
          product += (i == j ? 0.25 : 0.5) * strain * strain;
        }
      of_cell += volume * (lambda * trace * trace + 2 * mu * product);
      for (int a = 1; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) {
          own[a][i] += volume * lambda * trace * dilatation[a][i];
          for (int j = 0; j < Dim; ++j) own[a][i] += stress[i][j] * dN[a][j];
        }
    });
    for (int a = 1; a < Nodes; ++a) // together they move nothing
      for (int i = 0; i < Dim; ++i) own[0][i] -= own[a][i];
    for (int a = 0; a < Nodes; ++a) {
      const LO node = body.cells(cell, a);
      for (int i = 0; i < Dim; ++i)
        if constexpr (!one_thread)
          share(cell, a, i) = own[a][i];
        else if (node < num_owned)
          force(dof(Dim, node, i)) += own[a][i];
    }
    if (cell >= num_owned_cells) return;
    energy += of_cell;
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i) squares += own[a][i] * own[a][i];
  }
};

/// What the cells around a node add to the force there, in their order.
template <int Dim, int Nodes>
struct SumShares {
  DeviceView<LO **> cells;                // (cells, Nodes)               in, overlap lids
  DeviceView<double *[Nodes][Dim]> share; // (cells, Nodes, Dim)    [N]   in
  NodeToCells node_to_cells;              //                              in
  WriteVector force;                      // (owned dofs)           [N]   out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    double sum[Dim] = {};
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k) {
      const int a = place_in(cells, node_to_cells.cell(k), node);
      for (int i = 0; i < Dim; ++i) sum[i] += share(node_to_cells.cell(k), a, i);
    }
    for (int i = 0; i < Dim; ++i) force(dof(Dim, node, i)) = sum[i];
  }
};

} // namespace rpc::fem
