#include "coarse_contact.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace rpc::solver
{
namespace
{

const LO invalid = Teuchos::OrdinalTraits<LO>::invalid();

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
  const auto begin = to_host(P.getLocalMatrixDevice().graph.row_map);
  const auto entries = to_host(P.getLocalMatrixDevice().graph.entries);
  const auto values = to_host(P.getLocalMatrixDevice().values);
  std::vector<GO> row, column;
  std::vector<int> length;
  std::vector<double> value;
  for (const GO gid : wanted) {
    const LO lid = rows.getLocalElement(gid);
    if (lid == invalid) continue;
    row.push_back(gid);
    length.push_back(static_cast<int>(begin(lid + 1) - begin(lid)));
    for (auto e = begin(lid); e < begin(lid + 1); ++e) {
      column.push_back(columns.getGlobalElement(entries(e)));
      value.push_back(values(e));
    }
  }
  Rows all;
  all.column = gathered_by_all(comm, std::move(column));
  all.value = gathered_by_all(comm, std::move(value));
  for (const int n : gathered_by_all(comm, std::move(length))) all.begin.push_back(all.begin.back() + n);
  const auto gids = gathered_by_all(comm, std::move(row));
  for (std::size_t k = 0; k < gids.size(); ++k) all.place[gids[k]] = k;
  return all;
}

/// One pair of nodes with the points that couple them.
using Parts = std::vector<std::pair<int, double>>;

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
  const auto matrix = A_->getLocalMatrixDevice();
  const auto row_map = to_host(matrix.graph.row_map);
  const auto entries = to_host(matrix.graph.entries);
  const auto values = to_host(matrix.values);
  const auto lid = [dim = dim_](const Map &map, const GO node) { return map.getLocalElement(dof(dim, node, 0)); };
  // Where the block of a column's node begins in the first row of a node; the row's length if the nodes share no cell.
  const auto place = [&](const LO row, const LO column) {
    const std::size_t first = row_map(dof(dim_, row, 0)), last = row_map(dof(dim_, row, 0) + 1);
    std::size_t at = first;
    while (at < last && entries(at) != dof(dim_, column, 0)) ++at;
    return at - first;
  };
  std::map<std::pair<LO, LO>, Parts> pairs; // of owned nodes and columns
  for (int p = 0; p < points.size(); ++p)
    for (std::size_t k = points.begin[p]; k < points.begin[p + 1]; ++k) {
      const LO row_dof = lid(rows, points.node[k]);
      if (row_dof == invalid) continue;
      const LO row = node_of(dim_, row_dof);
      const std::size_t length = row_map(row_dof + 1) - row_map(row_dof);
      for (std::size_t l = points.begin[p]; l < points.begin[p + 1]; ++l) {
        const double both = points.weight[k] * points.weight[l];
        const LO column_dof = lid(columns, points.node[l]);
        const LO column = column_dof == invalid ? invalid : node_of(dim_, column_dof);
        if (column != invalid && place(row, column) < length)
          pairs[{row, column}].emplace_back(p, both);
        else
          pairs[{row, row}].emplace_back(p, std::abs(both)); // 2 a b <= a^2 + b^2
      }
    }
  const std::size_t n = pairs.size();
  std::vector<LO> row, column, nodes;
  std::vector<std::size_t> begin{0};
  std::vector<int> point;
  std::vector<double> coefficient;
  entry_ = DeviceView<std::size_t **>("rpc::solver::coarse_entry", n, dim_);
  base_ = DeviceView<double ***>("rpc::solver::coarse_base", n, dim_, dim_);
  const auto entry = Kokkos::create_mirror_view(entry_);
  const auto base = Kokkos::create_mirror_view(base_);
  std::vector<std::size_t> own;
  std::size_t b = 0;
  for (const auto &[pair, parts] : pairs) {
    const std::size_t at = place(pair.first, pair.second);
    for (int i = 0; i < dim_; ++i) {
      entry(b, i) = row_map(dof(dim_, pair.first, i)) + at;
      for (int j = 0; j < dim_; ++j) base(b, i, j) = values(entry(b, i) + j);
    }
    if (pair.first == pair.second) {
      nodes.push_back(pair.first);
      own.push_back(b);
    }
    row.push_back(pair.first);
    column.push_back(pair.second);
    for (const auto &[p, weight] : parts) {
      point.push_back(p);
      coefficient.push_back(weight);
    }
    begin.push_back(point.size());
    ++b;
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
