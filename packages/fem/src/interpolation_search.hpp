// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_search.hpp"
#include "interpolation_rows.hpp"
#include "rpc/core/exchange.hpp"
#include "rpc/core/rank_boxes.hpp"

#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

/// Interpolation between any two meshes: the cells in which nodes lie are looked for, on the ranks whose boxes hold them. Private to
/// interpolation().
namespace rpc::fem
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
          for (int a = 0; a < Nodes; ++a) x[a] = mesh.coords(mesh.places(c, a), d);
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
  RankBoxes of_ranks{{}}; ///< around their cells
  double rounding = 0;    ///< of coordinates [m]
};

/// Collective.
template <int Dim, int Nodes>
Search<Dim, Nodes> search_in(const mesh::Mesh &mesh)
{
  Search<Dim, Nodes> search{{}, {mesh.coords, mesh.places(), to_device(mesh.cell_id.list()), mesh.num_owned_cells}};
  search.box = boxes(search.shape, search.cells);
  Bounds mine = Bounds::empty();
  if (search.cells.count > 0) {
    std::vector<Extent> extents;
    mine.lower = mine.upper = {};
    for (int d = 0; d < Dim; ++d) {
      extents.push_back(extent<Dim>(search.box, d));
      mine.lower[d] = extents[d].lower;
      mine.upper[d] = extents[d].upper;
    }
    search.bins = bins_of<Dim>(search.box, extents);
  }
  search.of_ranks = rank_boxes(mesh.comm(), mine);
  double farthest = 0;
  for (const Bounds &box : search.of_ranks.boxes())
    for (int d = 0; d < Dim && !box.is_empty(); ++d)
      farthest = std::max({farthest, std::abs(box.lower[d]), std::abs(box.upper[d])});
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

/// Asks ranks about points, and keeps an answer that is better than the known one; collective.
/// @param points       (points, Dim) [m]
/// @param bound        (points) places farther off do not count [m^2]
/// @param asked_ranks  (point, visit) calls visit(rank) for those that are asked
template <int Dim, int Nodes, class AskedRanks>
void ask(const mesh::Mesh &from, const Search<Dim, Nodes> &search, const std::vector<double> &points,
         const std::vector<double> &bound, const Asked asked, const AskedRanks &asked_ranks, Answers &answers)
{
  const Comm &comm = from.comm();
  std::vector<int> counts(comm.getSize());
  std::vector<std::pair<int, std::size_t>> sent; // rank, point
  for (std::size_t n = 0; n < bound.size(); ++n) asked_ranks(n, [&](const int rank) { sent.emplace_back(rank, n); });
  std::sort(sent.begin(), sent.end());
  std::vector<double> questions;
  for (const auto &[rank, n] : sent) {
    ++counts[rank];
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
    for (int a = 0; a < Nodes; ++a) reply[2 + Dim + a] = static_cast<double>(from.node_gid(cells(cell(n), a)));
  }
  const std::vector<double> got = exchange.back(replies, width);
  for (std::size_t k = 0; k < sent.size(); ++k) {
    const double *const reply = &got[width * k];
    const std::size_t n = sent[k].second;
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
  Answers answers{std::vector<double>(count, infinity), std::vector<GO>(count, std::numeric_limits<GO>::max()),
                  std::vector<double>(Dim * count), std::vector<GO>(Nodes * count)};
  const auto point = [&](const std::size_t n) {
    Point x{};
    std::copy_n(&points[Dim * n], Dim, x.begin());
    return x;
  };
  std::vector<double> bound(count, infinity);
  ask(
      from, search, points, bound, Asked::around_it,
      [&](const std::size_t n, const auto &visit) { search.of_ranks.within(point(n), 0, visit); }, answers);

  for (std::size_t n = 0; n < count; ++n) {
    bound[n] = answers.away[n]; // -1: a cell holds it
    if (bound[n] < 0) continue;
    const double most = search.of_ranks.least_farthest(point(n)); // a cell is nowhere farther than its box
    bound[n] = std::min(bound[n], most * (1 + 1e-9) + search.rounding * search.rounding);
  }
  ask(
      from, search, points, bound, Asked::nearest,
      [&](const std::size_t n, const auto &visit) {
        if (bound[n] >= 0) search.of_ranks.within(point(n), bound[n], visit);
      },
      answers);
  return answers;
}

/// Rows from the cells in which their points were found.
template <int Dim, int Nodes>
struct SearchedRows {
  ShapeFunctions<Dim, Nodes> shape;    //                                           in
  DeviceView<LO **> column;            // (rows, Nodes) of the nodes of the cell    in
  DeviceView<double *[Dim]> reference; // (rows) coordinates in that cell           in

  KOKKOS_INLINE_FUNCTION void operator()(const LO n, InterpolationRow<Nodes> &row) const
  {
    double X[Dim];
    for (int d = 0; d < Dim; ++d) X[d] = reference(n, d);
    weights_at(shape, X, row.weight);
    for (int a = 0; a < Nodes; ++a) row.column[a] = column(n, a);
  }
};

/// In one process, where all numberings of the nodes are the same.
template <int Dim, int Nodes>
SearchedRows<Dim, Nodes> own_rows(const mesh::Mesh &from, const mesh::Mesh &to, const Search<Dim, Nodes> &search)
{
  const LO num_rows = to.num_owned_nodes();
  const Places<Dim> places = find_places(search, to.coords, num_rows, {}, Asked::any);
  const DeviceView<LO **> column("rpc::fem::interpolation_column", num_rows, Nodes);
  const auto cells = from.cells;
  const auto cell = places.cell;
  Kokkos::parallel_for(
      "rpc::fem::columns_of_rows", device_range(num_rows), KOKKOS_LAMBDA(const LO n) {
        for (int a = 0; a < Nodes; ++a) column(n, a) = cells(cell(n), a);
      });
  return {search.shape, column, places.reference};
}

/// With cells of other ranks; collective.
/// @return the rows, and the matrix' columns
template <int Dim, int Nodes>
std::pair<SearchedRows<Dim, Nodes>, RCP<const Map>> shared_rows(const mesh::Mesh &from, const mesh::Mesh &to,
                                                                const Search<Dim, Nodes> &search)
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

  const SearchedRows<Dim, Nodes> rows{search.shape,
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
  return {rows, columns_of(from, others)};
}

/// Collective.
template <int Dim, int Nodes>
std::pair<SearchedRows<Dim, Nodes>, RCP<const Map>> searched_rows(const mesh::Mesh &from, const mesh::Mesh &to)
{
  const Search<Dim, Nodes> search = search_in<Dim, Nodes>(from);
  if (from.comm().getSize() > 1) return shared_rows(from, to, search);
  return {own_rows(from, to, search), from.owned_nodes};
}

} // namespace rpc::fem
