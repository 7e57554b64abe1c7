// SPDX-License-Identifier: BSD-3-Clause
#include "star_solves.hpp"

#include "cell_kinds.hpp"

#include <vector>

namespace rpc::bound
{
namespace
{

/// The modes of a star, as kernels see them.
struct StarModes {
  static constexpr int most = 6; ///< on a spoke: those that all hand on, and its own
  CellInput in;
  BoundaryTractions boundary;

  /// Modes that all spokes hand on: two forces and a moment, of a body of revolution the force along its axis.
  KOKKOS_FUNCTION int num_common() const { return in.of_revolution() ? 1 : 3; }
  KOKKOS_FUNCTION int of_each() const { return num_common() + own(); }
  KOKKOS_FUNCTION int own() const ///< modes of each spoke
  {
    if (in.of_revolution()) return 2 * in.reference.degree + 1;
    return in.reference.degree == 1 ? 1 : 3;
  }
  KOKKOS_FUNCTION int size(const LO node) const
  {
    const int spokes = in.facets.num_spokes(node);
    return spokes == 0 ? 0 : num_common() + own() * spokes;
  }
  KOKKOS_FUNCTION std::size_t first(const LO node) const
  {
    return num_common() * static_cast<std::size_t>(node) + own() * in.facets.first_spoke(node);
  }

  /// Components of the traction on a spoke that are free: 0, 1, or 2 for both; -1: none.
  KOKKOS_FUNCTION int free_components(const LO f) const
  {
    if (!in.facets.on_boundary(f)) return 2;
    const bool x = !boundary.known(f, 0), y = !boundary.known(f, 1);
    return x && y ? 2 : (x ? 0 : (y ? 1 : -1));
  }
  KOKKOS_FUNCTION void vector_of(const LO node, const LO f, double (&e)[2]) const
  {
    const int end = in.facets.node(f, 0) == node ? 1 : 0;
    for (int i = 0; i < 2; ++i) e[i] = in.coords(in.facets.node(f, end), i) - in.coords(node, i);
  }
  /// Whether the star hands on forces in x, in y and moments: as far as the free tractions of both ends on the boundary can.
  KOKKOS_FUNCTION void common(const LO node, bool (&may)[3]) const
  {
    const int spokes = in.facets.num_spokes(node);
    may[0] = may[1] = may[2] = true;
    if (spokes == in.facets.num_cells(node)) return;
    for (int k = 0; k < spokes; k += spokes - 1) {
      const LO f = in.facets.spoke(in.facets.first_spoke(node) + k);
      const int free = free_components(f);
      double e[2];
      vector_of(node, f, e);
      // A single component has a moment where it is not along the spoke.
      const double across = free == 0 ? e[1] : e[0], along = free == 0 ? e[0] : e[1];
      const bool has_moment = free == 2 || (free >= 0 && math::magnitude(across) > 0.1 * math::magnitude(along));
      may[0] = may[0] && has_moment && free != 1;
      may[1] = may[1] && has_moment && free != 0;
      may[2] = may[2] && has_moment;
    }
  }

  /// (2 (k + 1), modes) The tractions of a facet that belong to the modes at its spoke, in the signs of the facet; others are 0.
  KOKKOS_FUNCTION void of_spoke(const LO node, const int k, double (&M)[6][most]) const
  {
    for (auto &row : M)
      for (double &entry : row) entry = 0;
    const std::size_t at = in.facets.first_spoke(node) + k;
    const LO f = in.facets.spoke(at);
    const int free = free_components(f), degree = in.reference.degree;
    if (free < 0) return;
    if (in.of_revolution()) {
      modes_of_revolution(node, f, in.facets.toward(at), M);
      return;
    }
    double e[2];
    vector_of(node, f, e);
    const double squared = e[0] * e[0] + e[1] * e[1], size = math::sqrt(squared), toward = in.facets.toward(at);
    const double odd = in.facets.node(f, 0) == node ? toward : -toward; // of degree 1 from the vertex on
    const double across[2] = {-e[1], e[0]};
    bool may[3];
    common(node, may);
    if (free == 2) {
      for (int c = 0; c < 2; ++c) {
        const double moment = c == 0 ? -e[1] : e[0]; // of the force e_c at the end
        if (may[c]) {
          M[c][c] = toward;
          for (int i = 0; i < 2; ++i) M[2 + i][c] = -3 * odd * moment * across[i] / squared;
        }
      }
      for (int i = 0; i < 2 && may[2]; ++i) M[2 + i][2] = 6 * odd * scale(node) * across[i] / squared;
      for (int i = 0; i < 2; ++i) M[2 + i][3] = odd * e[i] / size;
      if (degree == 2)
        for (int i = 0; i < 2; ++i) M[4 + i][4 + i] = toward;
      return;
    }
    const double moment = free == 0 ? -e[1] : e[0];
    if (may[free]) {
      M[free][free] = toward;
      M[2 + free][free] = -3 * odd; // takes the moment back
    }
    if (may[2]) M[2 + free][2] = 6 * odd * scale(node) / moment;
    if (degree == 2) M[4 + free][4] = toward;
  }
  /// The force along the axis, as far as both ends of the star can hand it on, and all tractions without it; those of a facet that ends on the
  /// axis vanish there.
  KOKKOS_FUNCTION void modes_of_revolution(const LO node, const LO f, const double toward, double (&M)[6][most]) const
  {
    const int degree = in.reference.degree, spokes = in.facets.num_spokes(node);
    const bool first = in.coords(in.facets.node(f, 0), 0) <= in.on_axis,
               second = in.coords(in.facets.node(f, 1), 0) <= in.on_axis;
    if (first && second) return;
    bool hands_on = true;
    if (spokes != in.facets.num_cells(node))
      for (int k = 0; k < spokes; k += spokes - 1) {
        const LO end = in.facets.spoke(in.facets.first_spoke(node) + k);
        hands_on = hands_on && !(in.facets.on_boundary(end) && boundary.known(end, 1));
      }
    for (int i = 0; i < 2; ++i) {
      if (in.facets.on_boundary(f) && boundary.known(f, i)) continue;
      for (int j = 0; j <= degree; ++j) {
        const int mode = i == 1 && j == 0 ? 0 : (i == 0 ? 1 + j : 1 + degree + j);
        if ((mode == 0 && !hands_on) || (j == 1 && (first || second))) continue;
        M[2 * j + i][mode] = toward;
        if (first || second) M[2 + i][mode] = first ? toward : -toward; // P_j is 1 or -1 at the ends
      }
    }
  }
  /// The unit of moments: a length of the star.
  KOKKOS_FUNCTION double scale(const LO node) const
  {
    double e[2];
    vector_of(node, in.facets.spoke(in.facets.first_spoke(node)), e);
    return math::sqrt(e[0] * e[0] + e[1] * e[1]);
  }
  /// The place of a spoke's mode among those of its star.
  KOKKOS_FUNCTION int place(const int k, const int mode) const
  {
    return mode < num_common() ? mode : num_common() + own() * k + mode - num_common();
  }
};

/// The energy of each kind of stars in its modes, and its Cholesky factor: rows one after another.
struct FactorStars {
  StarModes modes;
  CellForms forms;
  DeviceView<LO *> example; // (kinds) node
  DeviceView<std::size_t *> first;
  DeviceView<double *> factor;

  KOKKOS_FUNCTION void add_cell(const LO node, const int k, double *H) const
  {
    const CellInput &in = modes.in;
    const int spokes = in.facets.num_spokes(node), per_facet = 2 * (in.reference.degree + 1), both = modes.of_each();
    const int spoke[2] = {k, (k + 1) % spokes};
    const LO c = in.facets.star_cell(in.facets.first(node) + k);
    const int corner = in.facets.star_corner(in.facets.first(node) + k), sides = in.reference.sides, kind = in.kind(c);
    const int ordinal[2] = {corner, (corner + sides - 1) % sides};
    double M[2][6][StarModes::most]; // outward
    for (int s = 0; s < 2; ++s) {
      modes.of_spoke(node, spoke[s], M[s]);
      for (int p = 0; p < per_facet; ++p)
        for (int b = 0; b < both; ++b) M[s][p][b] *= side_factor(in.facets.sign(c, ordinal[s]), p / 2);
    }
    for (int s = 0; s < 2; ++s)
      for (int r = 0; r < 2; ++r)
        for (int b = 0; b < both; ++b) {
          double Am[6]; // A times a mode
          for (int p = 0; p < per_facet; ++p) {
            Am[p] = 0;
            for (int q = 0; q < per_facet; ++q)
              Am[p] += forms.second(kind, ordinal[s] * per_facet + p, ordinal[r] * per_facet + q) * M[r][q][b];
          }
          for (int a = 0; a < both; ++a) {
            const int row = modes.place(spoke[s], a), column = modes.place(spoke[r], b);
            if (row < column) continue; // the factor is made of the lower part
            double sum = 0;
            for (int p = 0; p < per_facet; ++p) sum += M[s][p][a] * Am[p];
            H[row_of_triangle(row) + column] += sum;
          }
        }
  }

  KOKKOS_FUNCTION void operator()(const LO kind) const
  {
    const LO node = example(kind);
    const int n = modes.size(node);
    if (n == 0) return;
    double *const H = factor.data() + first(kind);
    for (std::size_t i = 0; i < row_of_triangle(n); ++i) H[i] = 0;
    for (int k = 0; k < modes.in.facets.num_cells(node); ++k) add_cell(node, k, H);
    double *own = H;
    for (int i = 0; i < n; own += ++i) {
      const double before = own[i];
      const double *other = H;
      for (int j = 0; j <= i; other += ++j) {
        double sum = own[j];
        for (int k = 0; k < j; ++k) sum -= own[k] * other[k];
        if (j < i)
          own[j] = other[j] > 0 ? sum / other[j] : 0;
        else
          own[i] = sum > 1e-12 * before ? math::sqrt(sum) : 0; // 0: a mode that is not there
      }
    }
  }
};

/// Kinds of stars: cells of the same kinds in the same places.
Kinds star_kinds(const StarModes &modes)
{
  const CellInput &in = modes.in;
  const LO nodes = static_cast<LO>(in.facets.num_spokes.extent(0));
  Kinds kinds = all_different(nodes);
  if (all_differ(in)) return kinds;
  DeviceView<signed char *> free("rpc::bound::free", in.facets.size());
  Kokkos::parallel_for(
      "rpc::bound::free_components", device_range(in.facets.size()),
      KOKKOS_LAMBDA(const LO f) { free(f) = static_cast<signed char>(modes.free_components(f)); });
  Kokkos::fence();
  const auto on_host = to_host(free), toward = to_host(in.facets.toward);
  const auto first = to_host(in.facets.first);
  const auto cells = to_host(in.facets.star_cell), spokes = to_host(in.facets.spoke);
  const auto corner = to_host(in.facets.star_corner), count = to_host(in.facets.num_spokes), of_cell = to_host(in.kind);
  const auto ends = to_host(in.facets.node);
  const auto kind = Kokkos::create_mirror_view(kinds.kind);
  Found<int> found;
  std::vector<int> key;
  for (LO node = 0; node < nodes; ++node) {
    key.clear();
    const std::size_t begin = first(node);
    const int n = static_cast<int>(first(node + 1) - begin);
    for (int k = 0; k < count(node); ++k) {
      const LO f = spokes(begin + node + k);
      key.push_back(k < n ? of_cell(cells(begin + k)) : -1);
      const int at = k < n ? corner(begin + k) : 0;
      key.push_back(((at * 4 + on_host(f) + 1) * 2 + (ends(f, 0) == node)) * 2 + (toward(begin + node + k) > 0));
    }
    kind(node) = found(key, node);
  }
  Kokkos::deep_copy(kinds.kind, kind);
  kinds.example = device_values(found.example, "rpc::bound::example");
  return kinds;
}

/// Where the factor of each kind begins. @return how many entries they have in all
std::size_t place_factors(const StarModes &modes, const DeviceView<LO *> &example,
                          const DeviceView<std::size_t *> &first)
{
  std::size_t total = 0;
  Kokkos::parallel_scan(
      "rpc::bound::sizes_of_stars", device_range(static_cast<LO>(first.extent(0))),
      KOKKOS_LAMBDA(const LO kind, std::size_t &before, const bool last) {
        if (last) first(kind) = before;
        before += row_of_triangle(modes.size(example(kind)));
      },
      total);
  return total;
}

} // namespace

StarSolves::StarSolves(const CellInput &in, const BoundaryTractions &boundary, const CellForms &forms,
                       const FacetExchange &exchange)
    : in_(in), boundary_(boundary), exchange_(exchange)
{
  const StarModes modes{in, boundary};
  const Kinds kinds = star_kinds(modes);
  kind_ = kinds.kind;
  const LO count = static_cast<LO>(kinds.example.extent(0));
  first_ = DeviceView<std::size_t *>("rpc::bound::first", count);
  const std::size_t total = place_factors(modes, kinds.example, first_);
  factor_ = DeviceView<double *>(Kokkos::view_alloc("rpc::bound::factor", Kokkos::WithoutInitializing), total);
  answer_ = DeviceView<double *>("rpc::bound::answer", modes.num_common() * static_cast<std::size_t>(kind_.extent(0)) +
                                                           modes.own() * in.facets.spoke.extent(0));
  Kokkos::parallel_for("rpc::bound::factor_stars", device_range(count),
                       FactorStars{modes, forms, kinds.example, first_, factor_});
  Kokkos::fence();
}

void StarSolves::apply(const Tractions &g, const Tractions &z) const
{
  const StarModes modes{in_, boundary_};
  const auto first = first_;
  const auto kind = kind_;
  const auto factor = factor_, answer = answer_;
  const int per_facet = 2 * (in_.reference.degree + 1), both = modes.of_each();
  Kokkos::parallel_for(
      "rpc::bound::solve_stars", device_range(static_cast<LO>(in_.facets.num_spokes.extent(0))),
      KOKKOS_LAMBDA(const LO node) {
        const int n = modes.size(node);
        if (n == 0) return;
        double *const y = answer.data() + modes.first(node);
        for (int i = 0; i < n; ++i) y[i] = 0;
        for (int k = 0; k < modes.in.facets.num_spokes(node); ++k) {
          double M[6][StarModes::most];
          modes.of_spoke(node, k, M);
          const LO f = modes.in.facets.spoke(modes.in.facets.first_spoke(node) + k);
          for (int b = 0; b < both; ++b)
            for (int p = 0; p < per_facet; ++p) y[modes.place(k, b)] += M[p][b] * g(f * per_facet + p);
        }
        const double *const L = factor.data() + first(kind(node)), *row = L;
        for (int i = 0; i < n; row += ++i) {
          for (int k = 0; k < i; ++k) y[i] -= row[k] * y[k];
          y[i] = row[i] > 0 ? y[i] / row[i] : 0;
        }
        for (int i = n - 1; i >= 0; --i) {
          row -= i + 1;
          y[i] = row[i] > 0 ? y[i] / row[i] : 0;
          for (int k = 0; k < i; ++k) y[k] -= row[k] * y[i];
        }
      });
  Kokkos::fence();
  // What the stars of both ends make of a facet; those of other ranks' vertices are fetched.
  const DeviceView<double ***> of_end("rpc::bound::of_end", in_.facets.size(), 2, per_facet);
  const auto row = exchange_.row();
  Kokkos::parallel_for(
      "rpc::bound::gather_stars", device_range(in_.facets.size()), KOKKOS_LAMBDA(const LO f) {
        for (int end = 0; end < 2; ++end) {
          if (row(f, end) >= 0) continue;
          const LO node = modes.in.facets.node(f, end);
          const int k = modes.in.facets.place(f, end);
          double M[6][StarModes::most];
          modes.of_spoke(node, k, M);
          for (int p = 0; p < per_facet; ++p) {
            double sum = 0;
            for (int b = 0; b < both; ++b) sum += M[p][b] * answer(modes.first(node) + modes.place(k, b));
            of_end(f, end, p) = sum;
          }
        }
      });
  Kokkos::fence();
  std::vector<double> flip;
  for (int j = 0; j <= in_.reference.degree; ++j) flip.insert(flip.end(), 2, side_factor(-1, j));
  const auto fetched = exchange_.fetch(of_end, flip);
  Kokkos::parallel_for(
      "rpc::bound::add_ends", device_range(in_.facets.size()), KOKKOS_LAMBDA(const LO f) {
        for (int p = 0; p < per_facet; ++p) {
          double sum = 0;
          for (int end = 0; end < 2; ++end) sum += row(f, end) >= 0 ? fetched(row(f, end), p) : of_end(f, end, p);
          z(f * per_facet + p) = sum;
        }
      });
  Kokkos::fence();
}

} // namespace rpc::bound
