// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/interpolation.hpp"

#include "interpolation_in_box.hpp"
#include "interpolation_search.hpp"
#include "rpc/fem/at_points.hpp"

namespace rpc::fem
{
namespace
{

/// (rows) number of entries.
template <int Nodes, class MakeRow>
struct CountEntries {
  MakeRow make_row;         //         in
  DeviceView<int *> length; // (rows)  out

  KOKKOS_FUNCTION void operator()(const LO n) const
  {
    InterpolationRow<Nodes> row;
    make_row(n, row);
    int count = 0;
    for (int a = 0; a < Nodes; ++a) count += row.weight[a] != 0 ? 1 : 0;
    length(n) = count;
  }
};

/// The entries of each row, columns ascending; their sum is 1.
template <int Nodes, class MakeRow>
struct FillRows {
  using Offsets = CrsMatrix::local_matrix_device_type::row_map_type::non_const_type;
  using Entries = CrsMatrix::local_matrix_device_type::index_type::non_const_type;
  using Values = CrsMatrix::local_matrix_device_type::values_type::non_const_type;
  MakeRow make_row; //             in
  Offsets row;      // (rows + 1)  in
  Entries col;      // (entries)   out
  Values value;     // (entries)   out

  KOKKOS_FUNCTION void operator()(const LO n) const
  {
    InterpolationRow<Nodes> made;
    make_row(n, made);
    const std::size_t begin = row(n);
    std::size_t end = begin;
    double sum = 0;
    for (int a = 0; a < Nodes; ++a) {
      if (made.weight[a] == 0) continue;
      std::size_t at = end++;
      for (; at > begin && col(at - 1) > made.column[a]; --at) {
        col(at) = col(at - 1);
        value(at) = value(at - 1);
      }
      col(at) = made.column[a];
      value(at) = made.weight[a];
      sum += made.weight[a];
    }
    for (std::size_t k = begin; k < end; ++k) value(k) /= sum;
  }
};

/// @param make_row  (row, InterpolationRow &), for kernels
template <int Nodes, class MakeRow>
RCP<CrsMatrix> matrix_of(const MakeRow &make_row, const RCP<const Map> &columns, const mesh::Mesh &from,
                         const mesh::Mesh &to)
{
  const LO num_rows = to.num_owned_nodes();
  const DeviceView<int *> length("rpc::fem::interpolation_row_length", num_rows);
  Kokkos::parallel_for("rpc::fem::count_interpolation", device_range(num_rows),
                       CountEntries<Nodes, MakeRow>{make_row, length});
  const auto offsets = offsets_of(length, "rpc::fem::interpolation_offsets");
  const std::size_t num_entries = last_of(offsets);
  using Fill = FillRows<Nodes, MakeRow>;
  using Kokkos::ViewAllocateWithoutInitializing;
  const typename Fill::Offsets row(ViewAllocateWithoutInitializing("rpc::fem::interpolation_row"), num_rows + 1);
  Kokkos::deep_copy(row, offsets);
  const typename Fill::Entries col(ViewAllocateWithoutInitializing("rpc::fem::interpolation_col"), num_entries);
  const typename Fill::Values value(ViewAllocateWithoutInitializing("rpc::fem::interpolation"), num_entries);
  Kokkos::parallel_for("rpc::fem::fill_interpolation", device_range(num_rows), Fill{make_row, row, col, value});
  Kokkos::fence();
  const CrsMatrix::local_matrix_device_type local("rpc::fem::interpolation", num_rows, num_local(*columns), num_entries,
                                                  value, row, col);
  return rcp(new CrsMatrix(local, to.owned_nodes, columns, from.owned_nodes, to.owned_nodes));
}

template <int Dim, int Nodes>
RCP<CrsMatrix> interpolate(const mesh::Mesh &from, const mesh::Mesh &to)
{
  if (divide_one_box(from, to)) {
    const auto [rows, columns] = rows_in_box<Dim>(ElementsOfCell<Dim, Nodes>(), from, to);
    return matrix_of<Nodes>(rows, columns, from, to);
  }
  const auto [rows, columns] = searched_rows<Dim, Nodes>(from, to);
  return matrix_of<Nodes>(rows, columns, from, to);
}

template <int Dim>
RCP<CrsMatrix> interpolate_mixed(const mesh::Mesh &from, const mesh::Mesh &to)
{
  const MixedElementOfCell<Dim> element(from.element);
  const auto [rows, columns] = rows_in_box<Dim>(element, from, to);
  return matrix_of<MixedElementOfCell<Dim>::nodes>(rows, columns, from, to);
}

} // namespace

RCP<CrsMatrix> interpolation(const Discretization &coarse, const Discretization &fine)
{
  RPC_REQUIRE(coarse.dim() == fine.dim(),
              "fem: a " << coarse.dim() << "D mesh cannot be interpolated to a " << fine.dim() << "D mesh");
  if (coarse.mesh->element.mixed()) {
    RPC_REQUIRE_CODE(divide_one_box(*coarse.mesh, *fine.mesh), ExitCode::internal_error,
                     "fem: a mesh of mixed elements is interpolated to divisions of its box only");
    return coarse.dim() == 2 ? interpolate_mixed<2>(*coarse.mesh, *fine.mesh)
                             : interpolate_mixed<3>(*coarse.mesh, *fine.mesh);
  }
  RCP<CrsMatrix> matrix;
  with_static_extents(coarse.mesh->element, [&](const auto dim, const auto nodes) {
    matrix = interpolate<dim, nodes>(*coarse.mesh, *fine.mesh);
  });
  return matrix;
}

namespace
{

/// (owned dofs) -> (owned nodes; dim).
void to_columns(const Vector &u, const int dim, MultiVector &columns)
{
  const auto from = device_read(u);
  const auto to = columns.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "rpc::fem::to_columns", device_range(static_cast<LO>(columns.getLocalLength())), KOKKOS_LAMBDA(const LO node) {
        for (int k = 0; k < dim; ++k) to(node, k) = from(dof(dim, node, k));
      });
  Kokkos::fence();
}

/// The other way round.
void from_columns(const MultiVector &columns, const int dim, Vector &u)
{
  const auto from = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = device_write(u);
  Kokkos::parallel_for(
      "rpc::fem::from_columns", device_range(static_cast<LO>(columns.getLocalLength())), KOKKOS_LAMBDA(const LO node) {
        for (int k = 0; k < dim; ++k) to(dof(dim, node, k)) = from(node, k);
      });
  Kokkos::fence();
}

} // namespace

RCP<Vector> interpolated(const Operator &interpolation, const Vector &u, const int dim, const RCP<const Map> &fine_dofs)
{
  MultiVector from(interpolation.getDomainMap(), dim), to(interpolation.getRangeMap(), dim);
  to_columns(u, dim, from);
  interpolation.apply(from, to);
  const auto result = rcp(new Vector(fine_dofs));
  from_columns(to, dim, *result);
  return result;
}

namespace
{

/// Points as the nodes of a mesh without cells, on rank 0.
Discretization nodes_without_cells(const std::vector<Point> &points, const mesh::Mesh &body)
{
  const RCP<const Comm> comm = body.owned_nodes->getComm();
  const std::size_t count = comm->getRank() == 0 ? points.size() : 0;
  auto mesh = std::make_shared<mesh::Mesh>();
  mesh->element = body.element;
  const auto count_them = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  mesh->owned_nodes = rcp(new Map(count_them, count, 0, comm));
  mesh->coords = DeviceView<double **>("rpc::fem::points", count, body.dim());
  const auto coords = Kokkos::create_mirror_view(mesh->coords);
  for (std::size_t k = 0; k < count; ++k)
    for (int c = 0; c < body.dim(); ++c) coords(k, c) = points[k][c];
  Kokkos::deep_copy(mesh->coords, coords);
  Discretization d;
  d.mesh = mesh;
  return d;
}

} // namespace

AtPoints::AtPoints(const Discretization &d, const std::vector<Point> &points)
    : d_(d), points_(points), from_nodes_(interpolation(d, nodes_without_cells(points, *d.mesh)))
{
}

std::vector<std::vector<double>> AtPoints::of(const MultiVector &at_nodes) const
{
  MultiVector at_points(from_nodes_->getRangeMap(), at_nodes.getNumVectors());
  from_nodes_->apply(at_nodes, at_points);
  const auto values = at_points.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<std::vector<double>> rows(values.extent(0), std::vector<double>(values.extent(1)));
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t c = 0; c < rows[k].size(); ++c) rows[k][c] = values(k, c);
  return rows;
}

std::vector<double> AtPoints::distances() const
{
  std::vector<double> distance;
  for (const std::vector<double> &nearest : of(*node_coordinates(d_))) {
    const Point &x = points_[distance.size()];
    double square = 0;
    for (int c = 0; c < d_.dim(); ++c) {
      double beside = x[c] - nearest[c];
      if (const auto &box = d_.mesh->box; box && box->wraps(c)) // whose last cells end at the first nodes
        beside = std::max({0., box->lower[c] - x[c], x[c] - box->upper[c]});
      square += beside * beside;
    }
    distance.push_back(std::sqrt(square));
  }
  return distance;
}

} // namespace rpc::fem
