#include "coarse_contact.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace rpc::solver
{
namespace
{

const LO invalid = Teuchos::OrdinalTraits<LO>::invalid();

/// Some of a matrix's own rows, on the host.
struct HostRows {
  std::vector<std::size_t> begin{0}; // (rows + 1) where a row's entries begin here
  HostView<std::size_t *> first;     // (rows)     and among all of the matrix
  HostView<LO *> column;             // (entries)  local
  HostView<double *> value;          // (entries)
};

/// Only these rows leave the device. @param rows  local
HostRows on_host(const CrsMatrix &A, const std::vector<LO> &rows)
{
  const auto matrix = A.getLocalMatrixDevice();
  const auto row = device_values(rows, "rpc::solver::picked_rows");
  const LO n = static_cast<LO>(rows.size());
  const DeviceView<std::size_t *> first("rpc::solver::picked_first", n);
  const DeviceView<LO *> length("rpc::solver::picked_length", n);
  Kokkos::parallel_for(
      "rpc::solver::picked_lengths", device_range(n), KOKKOS_LAMBDA(const LO i) {
        first(i) = matrix.graph.row_map(row(i));
        length(i) = static_cast<LO>(matrix.graph.row_map(row(i) + 1) - first(i));
      });
  Kokkos::fence();
  HostRows picked;
  const auto lengths = to_host(length);
  for (LO i = 0; i < n; ++i) picked.begin.push_back(picked.begin.back() + lengths(i));
  const auto begin = device_values(picked.begin, "rpc::solver::picked_begin");
  const DeviceView<LO *> column("rpc::solver::picked_column", picked.begin.back());
  const DeviceView<double *> value("rpc::solver::picked_value", picked.begin.back());
  Kokkos::parallel_for(
      "rpc::solver::pick_rows", device_range(n), KOKKOS_LAMBDA(const LO i) {
        for (LO e = 0; e < length(i); ++e) {
          column(begin(i) + e) = matrix.graph.entries(first(i) + e);
          value(begin(i) + e) = matrix.values(first(i) + e);
        }
      });
  Kokkos::fence();
  picked.first = to_host(first);
  picked.column = to_host(column);
  picked.value = to_host(value);
  return picked;
}

/// Some rows of an interpolation, from whatever rank owns them.
struct Rows {
  std::unordered_map<GO, std::size_t> place; // by the row's gid
  std::vector<std::size_t> begin{0};
  std::vector<GO> column;
  std::vector<double> value;
};

/// @param wanted  gids of rows, the same on all ranks; collective
Rows rows_of(const CrsMatrix &P, const std::set<GO> &wanted)
{
  const Comm &comm = *P.getComm();
  const Map &rows = *P.getRowMap(), &columns = *P.getColMap();
  std::vector<GO> row, column;
  std::vector<LO> lids;
  for (const GO gid : wanted) {
    const LO lid = rows.getLocalElement(gid);
    if (lid == invalid) continue;
    row.push_back(gid);
    lids.push_back(lid);
  }
  const HostRows mine = on_host(P, lids);
  std::vector<int> length;
  std::vector<double> value(mine.value.data(), mine.value.data() + mine.value.extent(0));
  for (std::size_t i = 0; i < lids.size(); ++i) length.push_back(static_cast<int>(mine.begin[i + 1] - mine.begin[i]));
  for (std::size_t e = 0; e < value.size(); ++e) column.push_back(columns.getGlobalElement(mine.column(e)));
  Rows all;
  all.column = gathered_by_all(comm, std::move(column));
  all.value = gathered_by_all(comm, std::move(value));
  for (const int n : gathered_by_all(comm, std::move(length))) all.begin.push_back(all.begin.back() + n);
  const auto gids = gathered_by_all(comm, std::move(row));
  for (std::size_t k = 0; k < gids.size(); ++k) all.place[gids[k]] = k;
  return all;
}

/// What a point adds to the block of a pair of nodes.
struct Part {
  LO row, column; // owned node; column's node
  int point;
  double coefficient;
};

/// values <- base + sum over parts of stiffness times coefficient m m^T.
template <class Values>
struct WriteBlocks {
  int dim;
  DeviceView<LO *> row, column;     // (blocks)
  DeviceView<std::size_t **> entry; // (blocks, dim)
  DeviceView<double ***> base;      // (blocks, dim, dim)
  DeviceView<std::size_t *> begin;  // (blocks + 1)
  DeviceView<int *> point;          // (parts)
  DeviceView<double *> coefficient; // (parts)
  DeviceView<double **> direction;  // (points, dim)
  DeviceView<char *> prescribed;    // (columns)
  DeviceView<double *> stiffness;   // (points)
  Values values;                    // (matrix entries)  out

  KOKKOS_FUNCTION void operator()(const LO b) const
  {
    double block[3][3] = {};
    for (std::size_t k = begin(b); k < begin(b + 1); ++k) {
      const int p = point(k);
      const double scaled = stiffness(p) * coefficient(k);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) block[i][j] += scaled * direction(p, i) * direction(p, j);
    }
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) {
        const bool held = prescribed(dof(dim, row(b), i)) || prescribed(dof(dim, column(b), j));
        values(entry(b, i) + j) = base(b, i, j) + (held ? 0 : block[i][j]);
      }
  }
};

/// y at some nodes <- their rows of A times x.
/// @param x  (columns)  @param y  (rows)
void multiply_rows(const CrsMatrix &A, const int dim, const DeviceView<LO *> &nodes, const Vector &x, Vector &y)
{
  const auto matrix = A.getLocalMatrixDevice();
  const auto from = device_read(x);
  const auto to = device_write(y);
  Kokkos::parallel_for(
      "rpc::solver::multiply_rows", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int k = 0; k < dim; ++k) {
          const LO row = dof(dim, nodes(n), k);
          double sum = 0;
          for (auto e = matrix.graph.row_map(row); e < matrix.graph.row_map(row + 1); ++e)
            sum += matrix.values(e) * from(matrix.graph.entries(e));
          to(row) = sum;
        }
      });
  Kokkos::fence();
}

} // namespace

PointSupports point_supports(const NodePoints &points, const Map &dofs)
{
  const auto node = to_host(points.node);
  const auto direction = to_host(points.direction);
  PointSupports result;
  result.dim = points.dim;
  std::vector<GO> gids;
  std::vector<double> along;
  for (LO i = 0; i < points.size(); ++i) {
    gids.push_back(node_of(points.dim, dofs.getGlobalElement(dof(points.dim, node(i), 0))));
    for (int k = 0; k < points.dim; ++k) along.push_back(direction(i, k));
  }
  result.node = gathered_by_all(*dofs.getComm(), std::move(gids));
  result.direction = gathered_by_all(*dofs.getComm(), std::move(along));
  result.weight.assign(result.node.size(), 1.);
  for (std::size_t i = 0; i < result.node.size(); ++i) result.begin.push_back(i + 1);
  return result;
}

PointSupports coarser(const PointSupports &fine, const CrsMatrix &interpolation)
{
  const Rows rows = rows_of(interpolation, std::set<GO>(fine.node.begin(), fine.node.end()));
  PointSupports coarse;
  coarse.dim = fine.dim;
  coarse.direction = fine.direction;
  for (int i = 0; i < fine.size(); ++i) {
    std::map<GO, double> support;
    for (std::size_t k = fine.begin[i]; k < fine.begin[i + 1]; ++k) {
      const std::size_t row = rows.place.at(fine.node[k]);
      for (std::size_t e = rows.begin[row]; e < rows.begin[row + 1]; ++e)
        support[rows.column[e]] += fine.weight[k] * rows.value[e];
    }
    for (const auto &[node, weight] : support) {
      coarse.node.push_back(node);
      coarse.weight.push_back(weight);
    }
    coarse.begin.push_back(coarse.node.size());
  }
  return coarse;
}

CoarseContact::CoarseContact(const PointSupports &points, RCP<CrsMatrix> A, const DeviceView<char *> &prescribed)
    : dim_(points.dim), A_(std::move(A)), rows_(RepeatedRows::of(A_, dim_)), prescribed_(prescribed)
{
  const Map &rows = *A_->getRowMap(), &columns = *A_->getColMap();
  std::vector<LO> row_node, column_node; // (supports' entries) local nodes, -1: none here
  const auto local_node = [dim = dim_](const Map &map, const GO node) {
    const LO at = map.getLocalElement(dof(dim, node, 0));
    return at == invalid ? -1 : node_of(dim, at);
  };
  for (const GO node : points.node) {
    row_node.push_back(local_node(rows, node));
    column_node.push_back(local_node(columns, node));
  }
  std::vector<LO> nodes; // owned ones around the points
  std::copy_if(row_node.begin(), row_node.end(), std::back_inserter(nodes), [](const LO node) { return node >= 0; });
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::vector<LO> their_rows;
  for (const LO node : nodes)
    for (int k = 0; k < dim_; ++k) their_rows.push_back(dof(dim_, node, k));
  const HostRows around = on_host(*A_, their_rows);
  const auto number = [&](const LO node) { // of a node's first row
    return dim_ * static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  // Where the block of a column's node begins in each row of a node; the row's length if the nodes share no cell.
  const auto place = [&](const std::size_t row, const LO column) {
    const std::size_t first = around.begin[row], last = around.begin[row + 1];
    std::size_t at = first;
    while (at < last && around.column(at) != dof(dim_, column, 0)) ++at;
    return at - first;
  };
  std::vector<Part> parts;
  for (int p = 0; p < points.size(); ++p)
    for (std::size_t k = points.begin[p]; k < points.begin[p + 1]; ++k) {
      const LO row = row_node[k];
      if (row < 0) continue;
      const std::size_t first = number(row);
      const std::size_t length = around.begin[first + 1] - around.begin[first];
      for (std::size_t l = points.begin[p]; l < points.begin[p + 1]; ++l) {
        const double both = points.weight[k] * points.weight[l];
        const LO column = column_node[l];
        if (column >= 0 && place(first, column) < length)
          parts.push_back({row, column, p, both});
        else
          parts.push_back({row, row, p, std::abs(both)}); // 2 a b <= a^2 + b^2
      }
    }
  std::stable_sort(parts.begin(), parts.end(), [](const Part &a, const Part &b) {
    return a.row < b.row || (a.row == b.row && a.column < b.column);
  });
  std::vector<LO> row, column;
  std::vector<std::size_t> begin;
  std::vector<int> point;
  std::vector<double> coefficient;
  for (const Part &part : parts) {
    if (row.empty() || row.back() != part.row || column.back() != part.column) {
      row.push_back(part.row);
      column.push_back(part.column);
      begin.push_back(point.size());
    }
    point.push_back(part.point);
    coefficient.push_back(part.coefficient);
  }
  begin.push_back(point.size());
  const std::size_t n = row.size();
  entry_ = DeviceView<std::size_t **>("rpc::solver::coarse_entry", n, dim_);
  base_ = DeviceView<double ***>("rpc::solver::coarse_base", n, dim_, dim_);
  const auto entry = Kokkos::create_mirror_view(entry_);
  const auto base = Kokkos::create_mirror_view(base_);
  std::vector<std::size_t> own; // blocks on the diagonal
  for (std::size_t b = 0; b < n; ++b) {
    const std::size_t first = number(row[b]), at = place(first, column[b]);
    for (int i = 0; i < dim_; ++i) {
      entry(b, i) = around.first(first + i) + at;
      for (int j = 0; j < dim_; ++j) base(b, i, j) = around.value(around.begin[first + i] + at + j);
    }
    if (row[b] == column[b]) own.push_back(b);
  }
  own_entry_ = DeviceView<std::size_t **>("rpc::solver::coarse_own_entry", nodes.size(), dim_);
  const auto own_entry = Kokkos::create_mirror_view(own_entry_);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int k = 0; k < dim_; ++k) own_entry(i, k) = entry(own[i], k);
  direction_ = DeviceView<double **>("rpc::solver::point_direction", points.size(), dim_);
  const auto direction = Kokkos::create_mirror_view(direction_);
  for (int p = 0; p < points.size(); ++p)
    for (int k = 0; k < dim_; ++k) direction(p, k) = points.direction[static_cast<std::size_t>(dim_) * p + k];
  row_ = device_values(row, "rpc::solver::coarse_row");
  column_ = device_values(column, "rpc::solver::coarse_column");
  nodes_ = device_values(nodes, "rpc::solver::coarse_nodes");
  begin_ = device_values(begin, "rpc::solver::coarse_begin");
  point_ = device_values(point, "rpc::solver::coarse_point");
  coefficient_ = device_values(coefficient, "rpc::solver::coarse_coefficient");
  Kokkos::deep_copy(entry_, entry);
  Kokkos::deep_copy(base_, base);
  Kokkos::deep_copy(own_entry_, own_entry);
  Kokkos::deep_copy(direction_, direction);
}

void CoarseContact::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  if (!rows_.pays()) return A_->apply(x, y);
  const auto importer = A_->getGraph()->getImporter();
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) {
    RCP<const Vector> columns = x.getVector(k);
    if (!importer.is_null()) {
      const auto imported = rcp(new Vector(A_->getColMap()));
      imported->doImport(*columns, *importer, Tpetra::INSERT);
      columns = imported;
    }
    const auto to = y.getVectorNonConst(k);
    rows_.apply(*columns, *to);
    multiply_rows(*A_, dim_, nodes_, *columns, *to);
  }
}

void CoarseContact::write(const DeviceView<double *> &stiffness)
{
  const auto values = A_->getLocalMatrixDevice().values;
  Kokkos::parallel_for("rpc::solver::write_contact", device_range(static_cast<LO>(row_.extent(0))),
                       WriteBlocks<std::decay_t<decltype(values)>>{dim_, row_, column_, entry_, base_, begin_, point_,
                                                                   coefficient_, direction_, prescribed_, stiffness,
                                                                   values});
  Kokkos::fence();
}

DeviceView<double ***> CoarseContact::blocks() const
{
  const DeviceView<double ***> block("rpc::solver::contact_blocks", nodes_.extent(0), dim_, dim_);
  const auto values = A_->getLocalMatrixDevice().values;
  const auto entry = own_entry_;
  const int dim = dim_;
  Kokkos::parallel_for(
      "rpc::solver::contact_blocks", device_range(static_cast<LO>(block.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) block(n, i, j) = values(entry(n, i) + j);
      });
  Kokkos::fence();
  return block;
}

} // namespace rpc::solver
