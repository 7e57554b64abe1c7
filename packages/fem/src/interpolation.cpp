#include "rpc/fem/interpolation.hpp"

#include "cell_search.hpp"
#include "rpc/core/exchange.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace rpc::fem
{
namespace
{

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
DeviceView<double **> boxes(const ShapeFunctions<Dim, Nodes> &shape, const SearchedCells &mesh)
{
  const DeviceView<double **> box("rpc::fem::cell_box", mesh.count, 2 * Dim);
  Kokkos::parallel_for(
      "rpc::fem::cell_boxes", device_range(mesh.count), KOKKOS_LAMBDA(const LO c) {
        for (int d = 0; d < Dim; ++d) {
          double x[Nodes], b[Nodes];
          for (int a = 0; a < Nodes; ++a) x[a] = mesh.coords(mesh.cells(c, a), d);
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
/// @param box     of each cell, at least one
/// @param extents  (Dim)
template <int Dim>
Bins<Dim> bins_of(const DeviceView<double **> &box, const std::vector<Extent> &extents)
{
  const double most = 4. * box.extent(0);
  Bins<Dim> bins;
  double number[Dim], total = 1, length[Dim];
  for (int d = 0; d < Dim; ++d) {
    bins.lower[d] = extents[d].lower;
    length[d] = extents[d].upper - extents[d].lower;
    number[d] = std::min(std::max(1., std::round(length[d] / extents[d].mean)), most);
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
  bins.cells = filled_lists(bins.size(), static_cast<LO>(box.extent(0)), BinsOfCells<Dim>{bins, box});
  return bins;
}

/// What a rank needs for looking into its own cells, and the boxes of all ranks' cells.
template <int Dim, int Nodes>
struct Search {
  ShapeFunctions<Dim, Nodes> shape;
  SearchedCells cells;
  DeviceView<double **> box = {};
  Bins<Dim> bins = {};
  std::vector<double> rank_box = {}; ///< (ranks, 2 Dim) lower, upper ends; upside down where a rank has no cells [m]
  double rounding = 0;               ///< of coordinates [m]
};

/// Collective.
template <int Dim, int Nodes>
Search<Dim, Nodes> search_in(const mesh::Mesh &mesh)
{
  Search<Dim, Nodes> search{{}, {mesh.coords, mesh.cells, to_device(mesh.cell_id), mesh.num_owned_cells}};
  search.box = boxes(search.shape, search.cells);
  std::vector<double> mine(2 * Dim, -std::numeric_limits<double>::infinity());
  std::fill_n(mine.begin(), Dim, std::numeric_limits<double>::infinity());
  if (search.cells.count > 0) {
    std::vector<Extent> extents;
    for (int d = 0; d < Dim; ++d) {
      extents.push_back(extent<Dim>(search.box, d));
      mine[d] = extents[d].lower;
      mine[Dim + d] = extents[d].upper;
    }
    search.bins = bins_of<Dim>(search.box, extents);
  }
  search.rank_box = gathered_by_all(mesh.comm(), mine);
  double farthest = 0;
  for (const double end : search.rank_box)
    if (std::isfinite(end)) farthest = std::max(farthest, std::abs(end));
  search.rounding = 4 * std::numeric_limits<double>::epsilon() * farthest;
  return search;
}

/// Among this rank's cells; fences.
/// @param bound  see FindPlaces; empty: none
template <int Dim, int Nodes>
Places<Dim> find_places(const Search<Dim, Nodes> &search, const DeviceView<double **> &points, const LO num_points,
                        const DeviceView<double *> &bound, const Asked asked)
{
  const Places<Dim> places{DeviceView<LO *>("rpc::fem::place_cell", num_points),
                           DeviceView<double *>("rpc::fem::place_away", num_points),
                           DeviceView<double *[Dim]>("rpc::fem::place_reference", num_points)};
  const FindPlaces<Dim, Nodes> find{search.shape, search.cells, search.box, search.bins, search.rounding,
                                    asked,        points,       bound,      places};
  Kokkos::parallel_for("rpc::fem::find_places", device_range(num_points), find);
  Kokkos::fence();
  return places;
}

/// The best place of each point over all ranks, on the host.
struct Answers {
  std::vector<double> away;      ///< (points) see Places; +inf: none so far
  std::vector<GO> id;            ///< (points) of the cell
  std::vector<double> reference; ///< (points, Dim)
  std::vector<GO> node;          ///< (points, Nodes) gids of the cell's nodes
};

/// Square of the distance of a point from a rank's box, at least or, `farthest`, at most [m^2].
template <int Dim>
double distance_to_rank(const double *const box, const double *const x, const bool farthest)
{
  double sum = 0;
  for (int d = 0; d < Dim; ++d) {
    const double low = box[d] - x[d], high = x[d] - box[Dim + d];
    const double out = farthest ? std::max(std::abs(low), std::abs(high)) : std::max({low, high, 0.});
    sum += out * out;
  }
  return sum;
}

/// Asks the ranks that `is_asked(point, rank)` names, and keeps what is better than what is known; collective.
/// @param points  (points, Dim) [m]
/// @param bound   (points) places farther off do not count [m^2]
template <int Dim, int Nodes, class IsAsked>
void ask(const mesh::Mesh &from, const Search<Dim, Nodes> &search, const std::vector<double> &points,
         const std::vector<double> &bound, const Asked asked, const IsAsked &is_asked, Answers &answers)
{
  const Comm &comm = from.comm();
  std::vector<int> counts(comm.getSize());
  std::vector<double> questions;
  std::vector<std::size_t> sent; // points
  for (int rank = 0; rank < comm.getSize(); ++rank)
    for (std::size_t n = 0; n < bound.size(); ++n) {
      if (!is_asked(n, rank)) continue;
      ++counts[rank];
      sent.push_back(n);
      questions.insert(questions.end(), &points[Dim * n], &points[Dim * n] + Dim);
      questions.push_back(bound[n]);
    }
  const Exchange exchange(comm, counts);
  const std::vector<double> asked_here = exchange.forward(questions, Dim + 1);

  const LO num_asked = exchange.num_received();
  const DeviceView<double **> x("rpc::fem::asked_points", num_asked, Dim);
  const DeviceView<double *> limit("rpc::fem::asked_bounds", num_asked);
  const auto host_x = Kokkos::create_mirror_view(x);
  const auto host_limit = Kokkos::create_mirror_view(limit);
  for (LO n = 0; n < num_asked; ++n) {
    for (int d = 0; d < Dim; ++d) host_x(n, d) = asked_here[(Dim + 1) * n + d];
    host_limit(n) = asked_here[(Dim + 1) * n + Dim];
  }
  Kokkos::deep_copy(x, host_x);
  Kokkos::deep_copy(limit, host_limit);
  const Places<Dim> places = find_places(search, x, num_asked, limit, asked);

  constexpr int width = 2 + Dim + Nodes; // doubles hold gids and ids exactly
  const auto cell = to_host(places.cell);
  const auto away = to_host(places.away);
  const auto reference = to_host(places.reference);
  const auto cells = to_host(from.cells);
  std::vector<double> replies(static_cast<std::size_t>(width) * num_asked, std::numeric_limits<double>::infinity());
  for (LO n = 0; n < num_asked; ++n) {
    if (cell(n) < 0) continue;
    double *const reply = &replies[static_cast<std::size_t>(width) * n];
    reply[0] = away(n);
    reply[1] = static_cast<double>(from.cell_id(cell(n)));
    for (int d = 0; d < Dim; ++d) reply[2 + d] = reference(n, d);
    for (int a = 0; a < Nodes; ++a)
      reply[2 + Dim + a] = static_cast<double>(from.overlap_nodes->getGlobalElement(cells(cell(n), a)));
  }
  const std::vector<double> got = exchange.back(replies, width);
  for (std::size_t k = 0; k < sent.size(); ++k) {
    const double *const reply = &got[width * k];
    const std::size_t n = sent[k];
    if (!std::isfinite(reply[0])) continue;
    const GO id = static_cast<GO>(reply[1]);
    if (std::pair(reply[0], id) >= std::pair(answers.away[n], answers.id[n])) continue;
    answers.away[n] = reply[0];
    answers.id[n] = id;
    std::copy_n(reply + 2, Dim, &answers.reference[Dim * n]);
    for (int a = 0; a < Nodes; ++a) answers.node[Nodes * n + a] = static_cast<GO>(reply[2 + Dim + a]);
  }
}

/// Places of this rank's points in the cells of all ranks: those that hold a point are asked for first; for points outside of
/// the mesh, then, all that may be nearest. Collective.
template <int Dim, int Nodes>
Answers ask_all(const mesh::Mesh &from, const Search<Dim, Nodes> &search, const std::vector<double> &points)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::size_t count = points.size() / Dim;
  const int ranks = from.comm().getSize();
  Answers answers{std::vector<double>(count, infinity), std::vector<GO>(count, std::numeric_limits<GO>::max()),
                  std::vector<double>(Dim * count), std::vector<GO>(Nodes * count)};
  const auto distance = [&](const std::size_t n, const int rank, const bool farthest) {
    return distance_to_rank<Dim>(&search.rank_box[2 * Dim * rank], &points[Dim * n], farthest);
  };
  std::vector<double> bound(count, infinity);
  ask(
      from, search, points, bound, Asked::around_it,
      [&](const std::size_t n, const int rank) { return distance(n, rank, false) == 0; }, answers);

  std::vector<char> done(count);
  for (std::size_t n = 0; n < count; ++n) {
    done[n] = answers.away[n] < 0;
    bound[n] = answers.away[n];
    for (int rank = 0; !done[n] && rank < ranks; ++rank) { // a cell is nowhere farther than its box
      const double most = distance(n, rank, true) * (1 + 1e-9) + search.rounding * search.rounding;
      bound[n] = std::min(bound[n], most);
    }
  }
  ask(
      from, search, points, bound, Asked::nearest,
      [&](const std::size_t n, const int rank) { return !done[n] && distance(n, rank, false) <= bound[n]; }, answers);
  return answers;
}

/// Where each row's entries come from.
template <int Dim, int Nodes>
struct Rows {
  RCP<const Map> columns;              ///< those of the domain map first, then those of others that occur, ascending
  DeviceView<LO **> column;            ///< (rows, Nodes) of the nodes of the cell
  DeviceView<double *[Dim]> reference; ///< (rows) coordinates in that cell
};

/// In one process, where all numberings of the nodes are the same.
template <int Dim, int Nodes>
Rows<Dim, Nodes> own_rows(const mesh::Mesh &from, const mesh::Mesh &to, const Search<Dim, Nodes> &search)
{
  const LO num_rows = to.num_owned_nodes();
  const Places<Dim> places = find_places(search, to.coords, num_rows, {}, Asked::any);
  const Rows<Dim, Nodes> rows{from.owned_nodes, DeviceView<LO **>("rpc::fem::interpolation_column", num_rows, Nodes),
                              places.reference};
  const auto cells = from.cells;
  const auto cell = places.cell;
  const auto column = rows.column;
  Kokkos::parallel_for(
      "rpc::fem::columns_of_rows", device_range(num_rows), KOKKOS_LAMBDA(const LO n) {
        for (int a = 0; a < Nodes; ++a) column(n, a) = cells(cell(n), a);
      });
  return rows;
}

/// With cells of other ranks; collective.
template <int Dim, int Nodes>
Rows<Dim, Nodes> shared_rows(const mesh::Mesh &from, const mesh::Mesh &to, const Search<Dim, Nodes> &search)
{
  const LO num_rows = to.num_owned_nodes(), num_owned = from.num_owned_nodes();
  const auto coords = to_host(to.coords);
  std::vector<double> points(static_cast<std::size_t>(Dim) * num_rows);
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = coords(k / Dim, k % Dim);
  const Answers answers = ask_all(from, search, points);

  const GO first = num_owned > 0 ? from.owned_nodes->getMinGlobalIndex() : 0; // the map is contiguous
  const auto is_own = [&](const GO gid) { return gid >= first && gid < first + num_owned; };
  std::vector<GO> others;
  std::copy_if(answers.node.begin(), answers.node.end(), std::back_inserter(others),
               [&](const GO gid) { return !is_own(gid); });
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  std::vector<GO> gids(num_owned);
  std::iota(gids.begin(), gids.end(), first);
  gids.insert(gids.end(), others.begin(), others.end());

  const Rows<Dim, Nodes> rows{rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                          Teuchos::ArrayView<const GO>(gids), 0, from.owned_nodes->getComm())),
                              DeviceView<LO **>("rpc::fem::interpolation_column", num_rows, Nodes),
                              DeviceView<double *[Dim]>("rpc::fem::place_reference", num_rows)};
  const auto column = Kokkos::create_mirror_view(rows.column);
  const auto reference = Kokkos::create_mirror_view(rows.reference);
  for (LO n = 0; n < num_rows; ++n) {
    for (int a = 0; a < Nodes; ++a) {
      const GO gid = answers.node[static_cast<std::size_t>(Nodes) * n + a];
      const auto place = std::lower_bound(others.begin(), others.end(), gid) - others.begin();
      column(n, a) = static_cast<LO>(is_own(gid) ? gid - first : num_owned + place);
    }
    for (int d = 0; d < Dim; ++d) reference(n, d) = answers.reference[static_cast<std::size_t>(Dim) * n + d];
  }
  Kokkos::deep_copy(rows.column, column);
  Kokkos::deep_copy(rows.reference, reference);
  return rows;
}

/// Whether an entry of the matrix is no rounding.
KOKKOS_INLINE_FUNCTION bool counts(const double N)
{
  return N > 1e-12 || N < -1e-12;
}

/// (rows) number of entries.
template <int Dim, int Nodes>
struct CountEntries {
  ShapeFunctions<Dim, Nodes> shape;    //         in
  DeviceView<double *[Dim]> reference; // (rows)  in
  DeviceView<int *> length;            // (rows)  out

  KOKKOS_FUNCTION void operator()(const LO n) const
  {
    double X[Dim], N[Nodes], dN[Nodes][Dim];
    for (int d = 0; d < Dim; ++d) X[d] = reference(n, d);
    shape.evaluate(X, N, dN);
    int count = 0;
    for (int a = 0; a < Nodes; ++a) count += counts(N[a]) ? 1 : 0;
    length(n) = count;
  }
};

/// The entries of each row, columns ascending.
template <int Dim, int Nodes>
struct FillRows {
  using Offsets = CrsMatrix::local_matrix_device_type::row_map_type::non_const_type;
  using Entries = CrsMatrix::local_matrix_device_type::index_type::non_const_type;
  using Values = CrsMatrix::local_matrix_device_type::values_type::non_const_type;
  ShapeFunctions<Dim, Nodes> shape;    //                 in
  DeviceView<LO **> column;            // (rows, Nodes)   in
  DeviceView<double *[Dim]> reference; // (rows)          in
  Offsets row;                         // (rows + 1)      in
  Entries col;                         // (entries)       out
  Values value;                        // (entries)       out

  KOKKOS_FUNCTION void operator()(const LO n) const
  {
    double X[Dim], N[Nodes], dN[Nodes][Dim], sum = 0;
    for (int d = 0; d < Dim; ++d) X[d] = reference(n, d);
    shape.evaluate(X, N, dN);
    const std::size_t begin = row(n);
    std::size_t end = begin;
    for (int a = 0; a < Nodes; ++a) {
      if (!counts(N[a])) continue;
      std::size_t at = end++;
      for (; at > begin && col(at - 1) > column(n, a); --at) {
        col(at) = col(at - 1);
        value(at) = value(at - 1);
      }
      col(at) = column(n, a);
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
  const Search<Dim, Nodes> search = search_in<Dim, Nodes>(from);
  const Rows<Dim, Nodes> rows = from.comm().getSize() == 1 ? own_rows(from, to, search) : shared_rows(from, to, search);

  const DeviceView<int *> length("rpc::fem::interpolation_row_length", num_rows);
  const CountEntries<Dim, Nodes> count{search.shape, rows.reference, length};
  Kokkos::parallel_for("rpc::fem::count_interpolation", device_range(num_rows), count);
  const auto offsets = offsets_of(length, "rpc::fem::interpolation_offsets");
  const std::size_t num_entries = last_of(offsets);
  using Fill = FillRows<Dim, Nodes>;
  using Kokkos::ViewAllocateWithoutInitializing;
  const typename Fill::Offsets row(ViewAllocateWithoutInitializing("rpc::fem::interpolation_row"), num_rows + 1);
  Kokkos::deep_copy(row, offsets);
  const typename Fill::Entries col(ViewAllocateWithoutInitializing("rpc::fem::interpolation_col"), num_entries);
  const typename Fill::Values value(ViewAllocateWithoutInitializing("rpc::fem::interpolation"), num_entries);
  Kokkos::parallel_for("rpc::fem::fill_interpolation", device_range(num_rows),
                       Fill{search.shape, rows.column, rows.reference, row, col, value});
  Kokkos::fence();
  const CrsMatrix::local_matrix_device_type local("rpc::fem::interpolation", num_rows, num_local(*rows.columns),
                                                  num_entries, value, row, col);
  return rcp(new CrsMatrix(local, to.owned_nodes, rows.columns, from.owned_nodes, to.owned_nodes));
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

} // namespace rpc::fem
