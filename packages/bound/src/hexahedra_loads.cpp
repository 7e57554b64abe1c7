// SPDX-License-Identifier: BSD-3-Clause
#include "hexahedra.hpp"
#include "rpc/core/parallel.hpp"

namespace rpc::bound
{
namespace
{

/// How far the middle of a face lies off the diagonal of its halves, times four, which both halves have as - bend lambda_a lambda_b.
KOKKOS_INLINE_FUNCTION double bend_of_face(const HexahedraInput &in, const ReadDisplacement &u, const LO f, const int i)
{
  const int a = in.half(f, 0) == 1 ? 1 : 0, b = in.half(f, 0) == 0 ? 1 : 2;
  return u(dof(3, in.facets.node(f, a), i)) + u(dof(3, in.facets.node(f, b), i)) - u(dof(3, in.half(f, 1), i)) -
         u(dof(3, in.half(f, 2), i));
}

/// Whether the ends of one diagonal have the middle of the other two corners.
KOKKOS_INLINE_FUNCTION bool is_parallelogram(const HexahedraInput &in, const LO (&node)[4])
{
  constexpr double rounding = 1e-13;
  double off = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const double a = in.coords(node[0], i), b = in.coords(node[1], i), c = in.coords(node[2], i),
                 d = in.coords(node[3], i);
    off += math::magnitude(a + b - c - d);
    size += math::magnitude(a) + math::magnitude(b) + math::magnitude(c) + math::magnitude(d);
  }
  return off <= rounding * size;
}

} // namespace

double work_of_loads(const HexahedraInput &in, const Comm &comm, const BoundaryTractions &boundary, const Vector &u)
{
  const auto moments = known_moments(in, boundary);
  const auto load = boundary.load;
  const auto x = device_read(u);
  const LO owned = in.num_owned_cells;
  const SpaceFacets facets = in.facets;
  double work = 0;
  Kokkos::parallel_reduce(
      "rpc::bound::work_of_loads", device_range(facets.num_outer),
      KOKKOS_LAMBDA(const LO f, double &sum) {
        if (!facets.on_boundary(f) || facets.cell(f, 0) < 0 || facets.cell(f, 0) >= owned) return;
        for (int i = 0; i < 3; ++i) {
          for (int a = 0; a < 3; ++a) sum += moments(f, a, i) * x(dof(3, facets.node(f, a), i));
          if (in.half(f, 0) < 0 || in.is_flat(f)) continue;
          const double bend = bend_of_face(in, x, f, i);
          for (std::size_t j = 0; j < load.extent(1); ++j) sum -= load(f, j, i) * in.of_edge(j, in.half(f, 0)) * bend;
        }
      },
      work);
  return sum_all(comm, work);
}

DeviceView<double **> shift_of_loads(const HexahedraInput &in, const BoundaryTractions &boundary)
{
  const DeviceView<double **> shift("rpc::bound::shift", in.num_hexahedra(), 24);
  const auto load = boundary.load;
  const SpaceFacets facets = in.facets;
  // A face's shape function of its corner is that of its halves, less the bend between them: of the ends of the diagonal 1, of the others -1.
  Kokkos::parallel_for(
      "rpc::bound::shift_by_faces", device_range(facets.num_outer), KOKKOS_LAMBDA(const LO f) {
        if (!facets.on_boundary(f) || in.half(f, 0) < 0 || facets.cell(f, 0) < 0) return;
        const LO h = facets.cell(f, 0) / 6;
        const int a = in.half(f, 0) == 1 ? 1 : 0, b = in.half(f, 0) == 0 ? 1 : 2;
        const LO node[4] = {facets.node(f, a), facets.node(f, b), in.half(f, 1), in.half(f, 2)};
        if (!is_parallelogram(in, node)) return; // else the functions of the face have other moments
        for (int i = 0; i < 3; ++i) {
          double moment = 0;
          for (int j = 0; j < static_cast<int>(load.extent(1)); ++j)
            moment += load(f, j, i) * in.of_edge(j, in.half(f, 0));
          for (int k = 0; k < 4; ++k)
            for (int local = 0; local < 8; ++local)
              if (in.hexahedra(h, local) == node[k]) add_shared(shift(h, 3 * local + i), k < 2 ? moment : -moment);
        }
      });
  if (in.loaded())
    Kokkos::parallel_for(
        "rpc::bound::shift_by_body_force", device_range(in.num_hexahedra()), KOKKOS_LAMBDA(const LO h) {
          const int diagonals[4][4] = {{0, 2, 1, 3}, {0, 5, 1, 4}, {0, 7, 3, 4}, {1, 6, 2, 5}};
          for (const auto &face : diagonals) {
            LO node[4];
            for (int k = 0; k < 4; ++k) node[k] = in.hexahedra(h, face[k]);
            if (!is_parallelogram(in, node)) return;
          }
          for (LO c = 6 * h; c < 6 * (h + 1); ++c) {
            const double volume = AffineTetrahedron(in, c).determinant / 6;
            for (int v = 0; v < 4; ++v)
              for (int i = 0; i < 3; ++i) shift(h, 3 * in.corner(c, v) + i) += volume / 4 * in.force[i];
            for (int q = 0; q < static_cast<int>(in.whole_weight.extent(0)); ++q) {
              double x[3] = {}, p[3];
              for (int v = 0; v < 4; ++v) {
                FieldOfHexahedra::place_of(in.corner(c, v), p);
                for (int m = 0; m < 3; ++m) x[m] += in.in_whole(q, v) * p[m];
              }
              for (int a = 0; a < 8; ++a) {
                FieldOfHexahedra::place_of(a, p);
                const double N = (1 + p[0] * x[0]) * (1 + p[1] * x[1]) * (1 + p[2] * x[2]) / 8;
                for (int i = 0; i < 3; ++i) shift(h, 3 * a + i) -= in.whole_weight(q) * 6 * volume * N * in.force[i];
              }
            }
          }
        });
  Kokkos::fence();
  return shift;
}

void add_bends_of_faces(const HexahedraInput &in, const Vector &u, const SpaceForms &forms)
{
  const auto to = forms.boundary;
  const auto x = device_read(u);
  const SpaceFacets facets = in.facets;
  Kokkos::parallel_for(
      "rpc::bound::bends_of_faces", device_range(facets.num_outer), KOKKOS_LAMBDA(const LO f) {
        if (!facets.on_boundary(f) || in.half(f, 0) < 0 || in.is_flat(f)) return;
        for (int i = 0; i < 3; ++i) {
          const double bend = bend_of_face(in, x, f, i);
          for (int j = 0; j < 3; ++j)
            to((static_cast<std::size_t>(f) * 3 + j) * 3 + i) += in.of_edge(j, in.half(f, 0)) * bend;
        }
      });
  Kokkos::fence();
}

} // namespace rpc::bound
