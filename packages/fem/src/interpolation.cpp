#include "rpc/fem/interpolation.hpp"

#include "around_nodes.hpp"
#include "cell_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::fem
{
namespace
{

/// Sum over all ranks of each value; collective.
template <class T>
DeviceView<T *> summed(const Comm &comm, const DeviceView<T *> &values)
{
  if (comm.getSize() == 1) return values;
  const auto mine = to_host(values);
  const HostView<T *> sum("rpc::fem::sum_over_ranks", values.extent(0));
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(sum.extent(0)), mine.data(), sum.data());
  return to_device(sum);
}

/// The whole mesh on each rank; collective.
GatheredMesh gather(const mesh::Mesh &mesh)
{
  const int dim = mesh.dim(), width = mesh.element.num_nodes();
  const GO nodes = static_cast<GO>(mesh.owned_nodes->getGlobalNumElements()),
           cells = sum_all(mesh.comm(), static_cast<GO>(mesh.num_owned_cells));
  RPC_REQUIRE(std::max(dim * nodes, width * cells) <= std::numeric_limits<int>::max(),
              "fem: a mesh of " << nodes << " nodes is too large to interpolate from: each rank would hold all of it");
  GatheredMesh whole;
  whole.num_nodes = static_cast<LO>(nodes);
  whole.num_cells = static_cast<LO>(cells);
  whole.coords = DeviceView<double *>("rpc::fem::all_coords", dim * nodes);
  whole.cells = DeviceView<LO *>("rpc::fem::all_cells", width * cells);
  const auto gid_of = mesh.overlap_nodes->getLocalMap();
  const auto id_of = to_device(mesh.cell_id);
  const auto coords = mesh.coords;
  const auto local_cells = mesh.cells;
  const auto all_coords = whole.coords;
  const auto all_cells = whole.cells;
  Kokkos::parallel_for(
      "rpc::fem::number_coords", device_range(mesh.num_owned_nodes()), KOKKOS_LAMBDA(const LO node) {
        for (int d = 0; d < dim; ++d) all_coords(dim * gid_of.getGlobalElement(node) + d) = coords(node, d);
      });
  Kokkos::parallel_for(
      "rpc::fem::number_cells", device_range(mesh.num_owned_cells), KOKKOS_LAMBDA(const LO cell) {
        for (int a = 0; a < width; ++a)
          all_cells(width * id_of(cell) + a) = static_cast<LO>(gid_of.getGlobalElement(local_cells(cell, a)));
      });
  Kokkos::fence();
  whole.coords = summed(mesh.comm(), whole.coords);
  whole.cells = summed(mesh.comm(), whole.cells);
  return whole;
}

/// What the boxes of all cells have together in one direction [m].
struct Extent {
  double lower = 0, upper = 0, mean = 0; // ends, and mean length of a cell's box
};

template <int Dim>
Extent extent(const DeviceView<double **> &box, const int d)
{
  Extent all;
  Kokkos::parallel_reduce(
      "rpc::fem::extent", device_range(static_cast<LO>(box.extent(0))),
      KOKKOS_LAMBDA(const LO c, double &least, double &most, double &sum) {
        if (box(c, d) < least) least = box(c, d);
        if (box(c, Dim + d) > most) most = box(c, Dim + d);
        sum += box(c, Dim + d) - box(c, d);
      },
      Kokkos::Min<double>(all.lower), Kokkos::Max<double>(all.upper), Kokkos::Sum<double>(all.mean));
  all.mean /= box.extent(0);
  return all;
}

/// Boxes that hold the cells, curved ones too, and a bit more than rounding.
/// @return (cells, 2 Dim) lower ends, upper ends [m]
template <int Dim, int Nodes>
DeviceView<double **> boxes(const ShapeFunctions<Dim, Nodes> &shape, const GatheredMesh &mesh)
{
  const DeviceView<double **> box("rpc::fem::cell_box", mesh.num_cells, 2 * Dim);
  Kokkos::parallel_for(
      "rpc::fem::cell_boxes", device_range(mesh.num_cells), KOKKOS_LAMBDA(const LO c) {
        for (int d = 0; d < Dim; ++d) {
          double x[Nodes], b[Nodes];
          for (int a = 0; a < Nodes; ++a) x[a] = mesh.coords(Dim * mesh.cells(Nodes * c + a) + d);
          shape.bernstein(x, b);
          double low = b[0], high = b[0];
          for (int a = 1; a < Nodes; ++a) {
            if (b[a] < low) low = b[a];
            if (b[a] > high) high = b[a];
          }
          const double margin = 1e-9 * (high - low);
          box(c, d) = low - margin;
          box(c, Dim + d) = high + margin;
        }
      });
  Kokkos::fence();
  return box;
}

/// Bins of the mean cell's size, but no more than a few for each cell. They begin half a bin before the body, so that the
/// cells of an even mesh lie in two of them in each direction and not in three.
template <int Dim>
Bins<Dim> bins_of(const DeviceView<double **> &box)
{
  const double most = 4. * box.extent(0);
  Bins<Dim> bins;
  double number[Dim], total = 1, length[Dim];
  for (int d = 0; d < Dim; ++d) {
    const Extent all = extent<Dim>(box, d);
    bins.lower[d] = all.lower;
    length[d] = all.upper - all.lower;
    number[d] = std::min(std::max(1., std::round(length[d] / all.mean)), most);
    total *= number[d];
  }
  while (total > most) {
    double *const largest = std::max_element(number, number + Dim);
    const double fewer = std::max(1., std::floor(*largest * most / total));
    total *= fewer / *largest;
    *largest = fewer;
  }
  for (int d = 0; d < Dim; ++d) {
    bins.width[d] = length[d] / number[d];
    bins.lower[d] -= bins.width[d] / 2;
    bins.count[d] = static_cast<int>(number[d]) + 1;
  }

  const LO num_cells = static_cast<LO>(box.extent(0));
  const DeviceView<LO *> size("rpc::fem::bin_size", bins.size());
  Kokkos::parallel_for(
      "rpc::fem::count_bins", device_range(num_cells), KOKKOS_LAMBDA(const LO c) {
        bins.over(box, c).for_each(bins.count, nullptr, [&](const int bin) { Kokkos::atomic_increment(&size(bin)); });
      });
  bins.row = offsets_of(size, "rpc::fem::bin_row");
  bins.cell = DeviceView<LO *>("rpc::fem::bin_cells", last_of(bins.row));
  Kokkos::deep_copy(size, 0);
  const auto row = bins.row;
  const auto list = bins.cell;
  Kokkos::parallel_for(
      "rpc::fem::fill_bins", device_range(num_cells), KOKKOS_LAMBDA(const LO c) {
        bins.over(box, c).for_each(
            bins.count, nullptr, [&](const int bin) { list(row(bin) + Kokkos::atomic_fetch_add(&size(bin), 1)) = c; });
      });
  sort_lists(row, list);
  Kokkos::fence();
  return bins;
}

/// Columns of a matrix with a given domain map: its own indices first, then those of others that occur, ascending.
struct Columns {
  RCP<const Map> map;
  DeviceView<LO *> lid; ///< (all indices) where they occur
};

/// @param occurs  (all indices) 1 for those that occur on this rank
/// Collective.
Columns columns(const RCP<const Map> &domain, const DeviceView<char *> &occurs)
{
  const LO total = static_cast<LO>(occurs.extent(0)), num_owned = num_local(*domain);
  const GO first = num_owned > 0 ? domain->getMinGlobalIndex() : 0; // maps of owned nodes are contiguous
  Columns result{domain, DeviceView<LO *>("rpc::fem::column_lid", total)};
  const auto lid = result.lid;
  LO num_others = 0;
  Kokkos::parallel_scan(
      "rpc::fem::number_columns", device_range(total),
      KOKKOS_LAMBDA(const LO gid, LO &others, const bool last) {
        const bool own = gid >= first && gid < first + num_owned;
        if (last) lid(gid) = own ? static_cast<LO>(gid - first) : num_owned + others;
        others += !own && occurs(gid) ? 1 : 0;
      },
      num_others);
  if (domain->getComm()->getSize() == 1) return result;
  const Kokkos::View<GO *, Map::device_type> gids("rpc::fem::column_gid", num_owned + num_others);
  Kokkos::parallel_for(
      "rpc::fem::column_gids", device_range(total), KOKKOS_LAMBDA(const LO gid) {
        if (occurs(gid) || (gid >= first && gid < first + num_owned)) gids(lid(gid)) = gid;
      });
  Kokkos::fence();
  const Kokkos::View<const GO *, Map::device_type> indices = gids;
  result.map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), indices, 0, domain->getComm()));
  return result;
}

/// The matrix from the places of its rows' nodes.
template <int Dim, int Nodes>
struct FillRows {
  using Rows = CrsMatrix::local_matrix_device_type::row_map_type::non_const_type;
  using Entries = CrsMatrix::local_matrix_device_type::index_type::non_const_type;
  using Values = CrsMatrix::local_matrix_device_type::values_type::non_const_type;
  FindPlaces<Dim, Nodes> places; //                         in
  DeviceView<LO *> lid;          // (coarse nodes) columns  in
  Rows row;                      // (rows + 1)              in
  Entries col;                   // (entries)               out
  Values value;                  // (entries)               out

  KOKKOS_FUNCTION void operator()(const LO n) const
  {
    double X[Dim], N[Nodes], dN[Nodes][Dim], sum = 0;
    for (int d = 0; d < Dim; ++d) X[d] = places.reference(n, d);
    places.shape.evaluate(X, N, dN);
    const std::size_t begin = row(n);
    std::size_t end = begin;
    for (int a = 0; a < Nodes; ++a) {
      if (!places.counts(N[a])) continue;
      const LO column = lid(places.mesh.cells(Nodes * places.cell(n) + a));
      std::size_t at = end++;
      for (; at > begin && col(at - 1) > column; --at) {
        col(at) = col(at - 1);
        value(at) = value(at - 1);
      }
      col(at) = column;
      value(at) = N[a];
      sum += N[a];
    }
    for (std::size_t k = begin; k < end; ++k) value(k) /= sum;
  }
};

template <int Dim, int Nodes>
RCP<CrsMatrix> interpolate(const mesh::Mesh &from, const mesh::Mesh &to)
{
  const LO num_rows = to.num_owned_nodes();
  const ShapeFunctions<Dim, Nodes> shape;
  const GatheredMesh whole = gather(from);
  const auto box = boxes(shape, whole);
  const Bins<Dim> bins = bins_of<Dim>(box);
  double largest = 0;
  for (int d = 0; d < Dim; ++d)
    largest = std::max({largest, std::abs(bins.lower[d]), std::abs(bins.lower[d] + bins.count[d] * bins.width[d])});
  const FindPlaces<Dim, Nodes> places{shape,
                                      whole,
                                      box,
                                      bins,
                                      4 * std::numeric_limits<double>::epsilon() * largest,
                                      to.coords,
                                      DeviceView<LO *>("rpc::fem::place_cell", num_rows),
                                      DeviceView<double *[Dim]>("rpc::fem::place_reference", num_rows),
                                      DeviceView<int *>("rpc::fem::interpolation_row_length", num_rows)};
  Kokkos::parallel_for("rpc::fem::find_places", device_range(num_rows), places);

  const DeviceView<char *> occurs("rpc::fem::column_occurs", whole.num_nodes);
  Kokkos::parallel_for(
      "rpc::fem::mark_columns", device_range(num_rows), KOKKOS_LAMBDA(const LO n) {
        for (int a = 0; a < Nodes; ++a)
          occurs(whole.cells(Nodes * places.cell(n) + a)) = 1; // the same from all threads
      });
  const Columns column = columns(from.owned_nodes, occurs);

  const auto offsets = offsets_of(places.length, "rpc::fem::interpolation_offsets");
  const std::size_t num_entries = last_of(offsets);
  using Kokkos::ViewAllocateWithoutInitializing;
  const typename FillRows<Dim, Nodes>::Rows row(ViewAllocateWithoutInitializing("rpc::fem::interpolation_row"),
                                                num_rows + 1);
  Kokkos::deep_copy(row, offsets);
  const typename FillRows<Dim, Nodes>::Entries col(ViewAllocateWithoutInitializing("rpc::fem::interpolation_col"),
                                                   num_entries);
  const typename FillRows<Dim, Nodes>::Values value(ViewAllocateWithoutInitializing("rpc::fem::interpolation"),
                                                    num_entries);
  const FillRows<Dim, Nodes> fill{places, column.lid, row, col, value};
  Kokkos::parallel_for("rpc::fem::fill_interpolation", device_range(num_rows), fill);
  Kokkos::fence();
  const CrsMatrix::local_matrix_device_type local("rpc::fem::interpolation", num_rows, num_local(*column.map),
                                                  num_entries, value, row, col);
  return rcp(new CrsMatrix(local, to.owned_nodes, column.map, from.owned_nodes, to.owned_nodes));
}

} // namespace

RCP<CrsMatrix> interpolation(const Discretization &coarse, const Discretization &fine)
{
  RPC_REQUIRE(coarse.dim() == fine.dim(),
              "fem: a " << coarse.dim() << "D mesh cannot be interpolated to a " << fine.dim() << "D mesh");
  RCP<CrsMatrix> matrix;
  with_static_extents(coarse.mesh->element, [&](const auto dim, const auto nodes) {
    matrix = interpolate<dim, nodes>(*coarse.mesh, *fine.mesh);
  });
  return matrix;
}

} // namespace rpc::fem
