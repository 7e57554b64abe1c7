// SPDX-License-Identifier: BSD-3-Clause
#include "congruent_cells.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rpc::fem
{
namespace
{

/// A cell of a box is one cell, two triangles or six tetrahedra.
int parts_of_cell(const mesh::Element &element)
{
  if (element.shape == mesh::Shape::tensor) return 1;
  return element.dim == 2 ? 2 : 6;
}
constexpr signed char unknown = -1;
constexpr double relative_rounding = 2e-15; // of a difference of coordinates

/// The first unless the second is larger: a NaN once there stays.
KOKKOS_INLINE_FUNCTION double larger(const double a, const double b)
{
  return b <= a ? a : b;
}
KOKKOS_INLINE_FUNCTION double magnitude(const double x)
{
  return x < 0 ? -x : x;
}

/// Gives `kind` to the cells without one that differ from the example by a translation and the rounding of coordinates.
/// Never where that rounding is felt, and never with coordinates that are not finite.
template <int Dim>
struct TakeKind {
  DeviceView<double **> coords;      // (overlap nodes, Dim)  [m]  in
  DeviceView<LO **> cells;           // (cells, nodes)             in, rows of coords
  LO example;                        // cell                       in
  signed char kind;                  //                            in
  DeviceView<signed char *> of_cell; // (cells)                    inout

  /// @param took   += 1 if the cell took it
  /// @param first  the first cell that is left without
  KOKKOS_FUNCTION void operator()(const LO cell, LO &took, LO &first) const
  {
    if (of_cell(cell) != unknown) return;
    const int nodes = static_cast<int>(cells.extent(1));
    double size = 0, farthest = 0, difference = 0;
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < Dim; ++d) {
        const double x = coords(cells(example, a), d), y = coords(cells(cell, a), d);
        const double edge = x - coords(cells(example, 0), d), other = y - coords(cells(cell, 0), d);
        size = larger(size, magnitude(edge));
        farthest = larger(farthest, larger(magnitude(x), magnitude(y)));
        difference = larger(difference, magnitude(edge - other));
      }
    const double rounding = relative_rounding * farthest;
    if (difference <= rounding && rounding <= 1e-10 * size) {
      of_cell(cell) = kind;
      ++took;
    } else if (cell < first) {
      first = cell;
    }
  }
};

/// @param[in,out] next  the example, then the first cell that is left without a kind
/// @return number of cells that took this one
template <int Dim>
LO take_kind(const mesh::Mesh &mesh, const signed char kind, const DeviceView<signed char *> &of_cell, LO &next)
{
  const TakeKind<Dim> kernel{mesh.coords, mesh.places(), next, kind, of_cell};
  LO took = 0;
  Kokkos::parallel_reduce("rpc::fem::congruent_cells", device_range(mesh.num_cells()), kernel, Kokkos::Sum<LO>(took),
                          Kokkos::Min<LO>(next));
  return took;
}

/// (examples, nodes * dim + 1) Of each its nodes, seen from the first one, and the largest of its coordinates, which has their rounding. [m]
/// @param examples  cells
std::vector<double> shapes_of(const mesh::Mesh &mesh, const std::vector<LO> &examples)
{
  const int nodes = mesh.element.num_nodes(), dim = mesh.dim(), size = nodes * dim + 1;
  const auto kinds = static_cast<LO>(examples.size());
  const auto example = device_values(examples, "rpc::fem::kind_example");
  const DeviceView<double *> shape("rpc::fem::kind_shape", kinds * size);
  const auto coords = mesh.coords;
  const auto cells = mesh.places();
  Kokkos::parallel_for(
      "rpc::fem::kind_shape", device_range(kinds), KOKKOS_LAMBDA(const LO kind) {
        double farthest = 0;
        for (int a = 0; a < nodes; ++a)
          for (int d = 0; d < dim; ++d) {
            const double x = coords(cells(example(kind), a), d);
            shape(kind * size + a * dim + d) = x - coords(cells(example(kind), 0), d);
            farthest = larger(farthest, magnitude(x));
          }
        shape(kind * size + size - 1) = farthest;
      });
  const auto host = to_host(shape);
  return {host.data(), host.data() + host.extent(0)};
}

/// Of each shape the first one of all ranks' that differs from it by the rounding of coordinates; collective.
/// @param mine  (kinds, size)
std::vector<double> shapes_of_all(const Comm &comm, const std::vector<double> &mine, const int size)
{
  const std::vector<double> all = gathered_by_all(comm, mine);
  std::vector<double> shared;
  for (auto own = mine.begin(); own < mine.end(); own += size) {
    auto first = all.begin();
    const auto is_alike = [&] {
      const double rounding = relative_rounding * std::max(own[size - 1], first[size - 1]);
      return std::equal(own, own + size - 1, first,
                        [&](const double a, const double b) { return std::abs(a - b) <= rounding; });
    };
    while (!is_alike()) first += size; // at last to its own
    shared.insert(shared.end(), first, first + size);
  }
  return shared;
}

/// Gives kinds their cells of their own.
/// @param shapes  (kinds, nodes * dim + 1)
void take_shapes(const mesh::Mesh &mesh, const std::vector<double> &shapes, CongruentCells &kinds)
{
  const int nodes = mesh.element.num_nodes(), dim = mesh.dim(), size = nodes * dim + 1;
  const int num_kinds = static_cast<int>(shapes.size()) / size;
  kinds.coords = DeviceView<double **>("rpc::fem::kind_coords", num_kinds * nodes, dim);
  kinds.cells = DeviceView<LO **>("rpc::fem::kind_cells", num_kinds, nodes);
  const auto coords = Kokkos::create_mirror_view(kinds.coords);
  const auto cells = Kokkos::create_mirror_view(kinds.cells);
  for (int kind = 0; kind < num_kinds; ++kind)
    for (int a = 0; a < nodes; ++a) {
      cells(kind, a) = kind * nodes + a;
      for (int d = 0; d < dim; ++d) coords(cells(kind, a), d) = shapes[kind * size + a * dim + d];
    }
  Kokkos::deep_copy(kinds.coords, coords);
  Kokkos::deep_copy(kinds.cells, cells);
}

/// A cell of each kind of this rank; none where there are more than a few.
/// @param of_cell  (cells) unknown; <- their kinds
std::vector<LO> examples_of(const mesh::Mesh &mesh, const DeviceView<signed char *> &of_cell)
{
  const LO num_cells = mesh.num_cells();
  const int parts = parts_of_cell(mesh.element);
  const int most_kinds =
      parts * (mesh.dim() == 2 ? 4 : 8); // the last cells of a box may have another length in each direction
  std::vector<LO> examples;
  LO next = 0;
  for (LO count = 0; count < num_cells;) {
    // Few cells of the first kinds promise a mesh without order, and each kind costs a pass over the cells.
    if (static_cast<int>(examples.size()) == most_kinds) return {};
    examples.push_back(next);
    const auto kind = static_cast<signed char>(examples.size() - 1);
    const LO took = mesh.dim() == 2 ? take_kind<2>(mesh, kind, of_cell, next) : take_kind<3>(mesh, kind, of_cell, next);
    if (kind < parts && took < num_cells / (4 * parts)) return {};
    count += took;
  }
  return examples;
}

/// Cells of one direction of a box sorted by their lengths.
struct LengthClasses {
  DeviceView<double *> ends; // (cells + 1)  [m]
  DeviceView<int *> of_cell; // (cells)
  int count = 0;

  /// @param rounding  up to which lengths are equal [m]
  /// @param most      classes; one more ends the search, for each cell is compared with all of them
  static LengthClasses of(const std::vector<double> &ends, const double rounding, const std::size_t most)
  {
    std::vector<double> lengths; // of the classes
    std::vector<int> of_cell;
    for (std::size_t k = 0; k + 1 < ends.size() && lengths.size() <= most; ++k) {
      const double length = ends[k + 1] - ends[k];
      const auto alike = std::find_if(lengths.rbegin(), lengths.rend(),
                                      [&](const double other) { return std::abs(length - other) <= rounding; });
      of_cell.push_back(static_cast<int>(lengths.rend() - alike) - 1);
      if (alike != lengths.rend()) continue;
      of_cell.back() = static_cast<int>(lengths.size());
      lengths.push_back(length);
    }
    return {device_values(ends, "rpc::fem::ends_of_cells"), device_values(of_cell, "rpc::fem::class_of_length"),
            static_cast<int>(lengths.size())};
  }
  KOKKOS_INLINE_FUNCTION int at(const double x) const
  {
    LO first = 0, last = static_cast<LO>(of_cell.extent(0)) - 1;
    while (first < last) {
      const LO middle = (first + last + 1) / 2;
      if (ends(middle) <= x)
        first = middle;
      else
        last = middle - 1;
    }
    return of_cell(first);
  }
};

/// Kinds of the cells of a graded box: by the lengths of their sides, and which part of a cell they are.
template <int Dim>
struct KindByLengths {
  DeviceView<double **> coords;      // (overlap nodes, Dim)  [m]  in
  DeviceView<LO **> cells;           // (cells, nodes)             in, rows of coords
  LengthClasses along[3];            //                            in
  int parts;                         //                            in
  DeviceView<signed char *> of_cell; // (cells)                    out
  DeviceView<LO *> example;          // (kinds) the first cell     inout

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    int kind = 0;
    for (int d = 0; d < Dim; ++d) {
      double low = coords(cells(cell, 0), d), high = low;
      for (std::size_t a = 1; a < cells.extent(1); ++a) {
        const double x = coords(cells(cell, a), d);
        low = x < low ? x : low;
        high = x > high ? x : high;
      }
      kind = kind * along[d].count + along[d].at(0.5 * (low + high));
    }
    kind = kind * parts + cell % parts;
    of_cell(cell) = static_cast<signed char>(kind);
    Kokkos::atomic_fetch_min(&example(kind), cell);
  }
};

/// A cell of each kind of this rank's part of a graded box, of which each layer has a kind of its own; none where there are too many.
/// @param of_cell  (cells) <- their kinds
template <int Dim>
std::vector<LO> examples_of_layers(const mesh::Mesh &mesh, const DeviceView<signed char *> &of_cell)
{
  constexpr LO most_kinds = std::numeric_limits<signed char>::max();
  const LO num_cells = mesh.num_cells();
  KindByLengths<Dim> kernel{mesh.coords, mesh.places(), {}, parts_of_cell(mesh.element), of_cell, {}};
  LO kinds = kernel.parts;
  double farthest = 0;
  for (int d = 0; d < Dim; ++d)
    farthest = larger(farthest, larger(magnitude(mesh.box->lower[d]), magnitude(mesh.box->upper[d])));
  const double rounding = relative_rounding * farthest;
  for (int d = 0; d < Dim; ++d) {
    if (!(rounding <= 1e-10 * mesh.box->node_distance(d))) return {};
    kernel.along[d] = LengthClasses::of(mesh::cell_ends(*mesh.box, d), rounding, most_kinds);
    kinds *= kernel.along[d].count;
    if (kinds > most_kinds) return {};
  }
  kernel.example = DeviceView<LO *>("rpc::fem::examples_of_layers", kinds);
  Kokkos::deep_copy(kernel.example, num_cells);
  Kokkos::parallel_for("rpc::fem::kinds_of_layers", device_range(num_cells), kernel);
  const auto found = to_host(kernel.example);
  std::vector<LO> examples;
  std::vector<signed char> present(kinds, unknown);
  for (LO kind = 0; kind < kinds; ++kind) {
    if (found(kind) == num_cells) continue;
    present[kind] = static_cast<signed char>(examples.size());
    examples.push_back(found(kind));
  }
  const auto renumbered = device_values(present, "rpc::fem::present_kinds");
  Kokkos::parallel_for(
      "rpc::fem::number_kinds", device_range(num_cells),
      KOKKOS_LAMBDA(const LO cell) { of_cell(cell) = renumbered(of_cell(cell)); });
  Kokkos::fence();
  return examples;
}

bool is_graded(const mesh::Mesh &mesh)
{
  return mesh.box && (mesh.box->graded(0) || mesh.box->graded(1) || mesh.box->graded(2));
}

} // namespace

CongruentCells congruent_cells(const mesh::Mesh &mesh)
{
  const DeviceView<signed char *> of_cell(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::kind_of_cell"),
                                          mesh.num_cells());
  Kokkos::deep_copy(of_cell, unknown);
  const std::vector<LO> examples = !is_graded(mesh)  ? examples_of(mesh, of_cell)
                                   : mesh.dim() == 2 ? examples_of_layers<2>(mesh, of_cell)
                                                     : examples_of_layers<3>(mesh, of_cell);
  const std::vector<double> mine = shapes_of(mesh, examples),
                            shared = shapes_of_all(mesh.comm(), mine, mesh.element.num_nodes() * mesh.dim() + 1);
  CongruentCells kinds;
  if (!examples.empty()) kinds.of_cell = of_cell;
  take_shapes(mesh, shared, kinds);
  return kinds;
}

} // namespace rpc::fem
