#include "cell_shapes.hpp"

#include "rpc/core/device_values.hpp"

#include <algorithm>
#include <vector>

namespace rpc::fem
{
namespace
{

constexpr int most_shapes = 4; ///< two triangles to a rectangle in two kinds of rectangles
constexpr signed char unknown = -1;

/// The first unless the second is larger: a NaN once there stays.
KOKKOS_INLINE_FUNCTION double larger(const double a, const double b)
{
  return b <= a ? a : b;
}
KOKKOS_INLINE_FUNCTION double magnitude(const double x)
{
  return x < 0 ? -x : x;
}

/// Gives `shape` to the cells without one that differ from the example by a translation and the rounding of coordinates.
/// Never where that rounding is felt, and never with coordinates that are not finite.
template <int Dim>
struct TakeShape {
  DeviceView<double **> coords;      // (overlap nodes, Dim)  [m]  in
  DeviceView<LO **> cells;           // (cells, nodes)             in
  LO example;                        // cell                       in
  signed char shape;                 //                            in
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
    const double rounding = 2e-15 * farthest;
    if (difference <= rounding && rounding <= 1e-10 * size) {
      of_cell(cell) = shape;
      ++took;
    } else if (cell < first) {
      first = cell;
    }
  }
};

/// @param[in,out] next  the example, then the first cell that is left without a shape
/// @return number of cells that took this one
template <int Dim>
LO take_shape(const mesh::Mesh &mesh, const signed char shape, const DeviceView<signed char *> &of_cell, LO &next)
{
  const TakeShape<Dim> kernel{mesh.coords, mesh.cells, next, shape, of_cell};
  LO took = 0;
  Kokkos::parallel_reduce("rpc::fem::cell_shapes", device_range(mesh.num_cells()), kernel, Kokkos::Sum<LO>(took),
                          Kokkos::Min<LO>(next));
  return took;
}

} // namespace

CellShapes cell_shapes(const mesh::Mesh &mesh)
{
  const LO num_cells = mesh.num_cells();
  DeviceView<signed char *> of_cell(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::shape_of_cell"), num_cells);
  Kokkos::deep_copy(of_cell, unknown);
  std::vector<LO> examples;
  LO next = 0;
  for (LO count = 0; count < num_cells;) {
    // Few cells of one shape promise a mesh without order, and each shape costs a pass over the cells.
    if (static_cast<int>(examples.size()) == most_shapes) return {};
    examples.push_back(next);
    const auto shape = static_cast<signed char>(examples.size() - 1);
    const LO took =
        mesh.dim() == 2 ? take_shape<2>(mesh, shape, of_cell, next) : take_shape<3>(mesh, shape, of_cell, next);
    if (took < num_cells / 8) return {};
    count += took;
  }
  return {of_cell, device_values(examples, "rpc::fem::shape_example")};
}

} // namespace rpc::fem
