#include "coarse_contact.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/graph.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
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

/// Blocks of a matrix to which points add, by rows, and what they add.
struct PointBlocks {
  std::vector<LO> nodes;             // owned ones around the points, ascending
  std::vector<LO> row, column;       // (blocks) owned node; column's node
  std::vector<std::size_t> entry;    // (blocks * dim) where the block begins in each of its rows
  std::vector<double> base;          // (blocks * dim * dim)
  std::vector<std::size_t> own;      // (nodes) their blocks on the diagonal
  std::vector<std::size_t> begin{0}; // (blocks + 1) where a block's parts begin
  std::vector<int> point;            // (parts)
  std::vector<double> coefficient;   // (parts) product of the weights at both nodes
};

/// What a point adds to a block of a node's rows.
struct Part {
  std::size_t place; // of the block in the rows
  int point;
  double coefficient;
};

/// Local nodes of some gids, -1 for those that a map of unknowns does not have.
std::vector<LO> local_nodes(const Map &dofs, const int dim, const std::vector<GO> &gids)
{
  std::vector<LO> nodes;
  for (const GO gid : gids) {
    const LO at = dofs.getLocalElement(dof(dim, gid, 0));
    nodes.push_back(at == invalid ? -1 : node_of(dim, at));
  }
  return nodes;
}

/// The entries of the points' supports that lie at each of some nodes.
/// @param nodes  ascending   @param node  (entries) of them, or -1
Lists entries_at(const std::vector<LO> &nodes, const std::vector<LO> &node)
{
  std::vector<std::size_t> number; // of an entry's node
  Lists lists;
  lists.begin.assign(nodes.size() + 1, 0);
  for (const LO n : node) {
    number.push_back(static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), n) - nodes.begin()));
    if (n >= 0) ++lists.begin[number.back() + 1];
  }
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.value.resize(lists.begin.back());
  std::vector<std::size_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (std::size_t k = 0; k < node.size(); ++k)
    if (node[k] >= 0) lists.value[next[number[k]]++] = static_cast<int>(k);
  return lists;
}

/// Appends the blocks of a node's rows, by their columns, with their parts in the order of the points.
/// @param first  the node's first row among `around`
void add_blocks(const HostRows &around, const std::size_t first, const int dim, const std::vector<Part> &parts,
                PointBlocks &blocks)
{
  const LO node = blocks.nodes[first / dim];
  const std::size_t start = around.begin[first], length = around.begin[first + 1] - start;
  std::vector<std::size_t> begin(length / dim + 1);
  for (const Part &part : parts) ++begin[part.place + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  const std::size_t so_far = blocks.point.size();
  for (std::size_t place = 0; place + 1 < begin.size(); ++place) {
    if (begin[place] == begin[place + 1]) continue;
    const LO column = node_of(dim, around.column(start + dim * place));
    if (column == node) blocks.own.push_back(blocks.row.size());
    blocks.row.push_back(node);
    blocks.column.push_back(column);
    blocks.begin.push_back(so_far + begin[place + 1]);
    for (int i = 0; i < dim; ++i) {
      blocks.entry.push_back(around.first(first + i) + dim * place);
      for (int j = 0; j < dim; ++j) blocks.base.push_back(around.value(around.begin[first + i] + dim * place + j));
    }
  }
  blocks.point.resize(so_far + parts.size());
  blocks.coefficient.resize(so_far + parts.size());
  for (const Part &part : parts) {
    const std::size_t to = so_far + begin[part.place]++;
    blocks.point[to] = part.point;
    blocks.coefficient[to] = part.coefficient;
  }
}

/// Couplings of nodes that share no cell of the mesh become their bound on the diagonal, 2 a b <= a^2 + b^2.
PointBlocks blocks_of(const PointSupports &points, const CrsMatrix &A)
{
  const int dim = points.dim;
  const Map &rows = *A.getRowMap(), &columns = *A.getColMap();
  const std::vector<LO> row_node = local_nodes(rows, dim, points.node);
  const std::vector<LO> column_node = local_nodes(columns, dim, points.node);
  PointBlocks blocks;
  auto &nodes = blocks.nodes;
  std::copy_if(row_node.begin(), row_node.end(), std::back_inserter(nodes), [](const LO node) { return node >= 0; });
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.empty()) return blocks;
  std::vector<LO> their_rows;
  for (const LO node : nodes)
    for (int k = 0; k < dim; ++k) their_rows.push_back(dof(dim, node, k));
  const HostRows around = on_host(A, their_rows);
  std::vector<int> point_of; // (supports' entries)
  for (int p = 0; p < points.size(); ++p) point_of.resize(points.begin[p + 1], p);
  const Lists entries = entries_at(nodes, row_node);

  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> place_of(num_local(columns) / dim, none); // of columns' nodes in the rows of a node
  std::vector<Part> parts;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::size_t first = dim * n, start = around.begin[first], places = (around.begin[first + 1] - start) / dim;
    const auto column_at = [&](const std::size_t place) { return node_of(dim, around.column(start + dim * place)); };
    for (std::size_t place = 0; place < places; ++place) place_of[column_at(place)] = place;
    parts.clear();
    for (std::size_t e = entries.begin[n]; e < entries.begin[n + 1]; ++e) {
      const int k = entries.value[e], p = point_of[k];
      for (std::size_t l = points.begin[p]; l < points.begin[p + 1]; ++l) {
        const double both = points.weight[k] * points.weight[l];
        const std::size_t place = column_node[l] < 0 ? none : place_of[column_node[l]];
        if (place == none)
          parts.push_back({place_of[nodes[n]], p, std::abs(both)});
        else
          parts.push_back({place, p, both});
      }
    }
    add_blocks(around, first, dim, parts, blocks);
    for (std::size_t place = 0; place < places; ++place) place_of[column_at(place)] = none;
  }
  return blocks;
}

/// values <- base + sum over parts of coefficient times the point's update.
template <class Values>
struct WriteBlocks {
  int dim;
  DeviceView<LO *> row, column;     // (blocks)
  DeviceView<std::size_t **> entry; // (blocks, dim)
  DeviceView<double ***> base;      // (blocks, dim, dim)
  DeviceView<std::size_t *> begin;  // (blocks + 1)
  DeviceView<int *> point;          // (parts)
  DeviceView<double *> coefficient; // (parts)
  DeviceView<char *> prescribed;    // (columns)
  DeviceView<double ***> update;    // (points, dim, dim)
  Values values;                    // (matrix entries)  out

  KOKKOS_FUNCTION void operator()(const LO b) const
  {
    double block[3][3] = {};
    for (std::size_t k = begin(b); k < begin(b + 1); ++k) {
      const int p = point(k);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) block[i][j] += coefficient(k) * update(p, i, j);
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
      "rpc::solver::multiply_rows", device_range(num_dofs(dim, static_cast<LO>(nodes.extent(0)))),
      KOKKOS_LAMBDA(const LO i) {
        const LO row = dof(dim, nodes(node_of(dim, i)), component_of(dim, i));
        double sum = 0;
        for (auto e = matrix.graph.row_map(row); e < matrix.graph.row_map(row + 1); ++e)
          sum += matrix.values(e) * from(matrix.graph.entries(e));
        to(row) = sum;
      });
  Kokkos::fence();
}

} // namespace

PointSupports point_supports(const DeviceView<LO *> &nodes, const int dim, const Map &dofs)
{
  const auto node = to_host(nodes);
  PointSupports result;
  result.dim = dim;
  std::vector<GO> gids;
  for (std::size_t i = 0; i < node.extent(0); ++i)
    gids.push_back(node_of(dim, dofs.getGlobalElement(dof(dim, node(i), 0))));
  result.node = gathered_by_all(*dofs.getComm(), std::move(gids));
  result.weight.assign(result.node.size(), 1.);
  for (std::size_t i = 0; i < result.node.size(); ++i) result.begin.push_back(i + 1);
  return result;
}

PointSupports coarser(const PointSupports &fine, const CrsMatrix &interpolation)
{
  const Rows rows = rows_of(interpolation, std::set<GO>(fine.node.begin(), fine.node.end()));
  PointSupports coarse;
  coarse.dim = fine.dim;
  std::vector<std::pair<GO, double>> support;
  for (int i = 0; i < fine.size(); ++i) {
    support.clear();
    for (std::size_t k = fine.begin[i]; k < fine.begin[i + 1]; ++k) {
      const std::size_t row = rows.place.at(fine.node[k]);
      for (std::size_t e = rows.begin[row]; e < rows.begin[row + 1]; ++e)
        support.emplace_back(rows.column[e], fine.weight[k] * rows.value[e]);
    }
    std::stable_sort(support.begin(), support.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    for (const auto &[node, weight] : support) {
      if (coarse.node.size() > coarse.begin.back() && coarse.node.back() == node) {
        coarse.weight.back() += weight;
        continue;
      }
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
  const PointBlocks blocks = blocks_of(points, *A_);
  const std::size_t n = blocks.row.size();
  entry_ = DeviceView<std::size_t **>("rpc::solver::coarse_entry", n, dim_);
  base_ = DeviceView<double ***>("rpc::solver::coarse_base", n, dim_, dim_);
  own_entry_ = DeviceView<std::size_t **>("rpc::solver::coarse_own_entry", blocks.own.size(), dim_);
  const auto entry = Kokkos::create_mirror_view(entry_);
  const auto base = Kokkos::create_mirror_view(base_);
  const auto own_entry = Kokkos::create_mirror_view(own_entry_);
  for (std::size_t b = 0; b < n; ++b)
    for (int i = 0; i < dim_; ++i) {
      entry(b, i) = blocks.entry[dim_ * b + i];
      for (int j = 0; j < dim_; ++j) base(b, i, j) = blocks.base[dim_ * (dim_ * b + i) + j];
    }
  for (std::size_t k = 0; k < blocks.own.size(); ++k)
    for (int i = 0; i < dim_; ++i) own_entry(k, i) = entry(blocks.own[k], i);
  row_ = device_values(blocks.row, "rpc::solver::coarse_row");
  column_ = device_values(blocks.column, "rpc::solver::coarse_column");
  nodes_ = device_values(blocks.nodes, "rpc::solver::coarse_nodes");
  begin_ = device_values(blocks.begin, "rpc::solver::coarse_begin");
  point_ = device_values(blocks.point, "rpc::solver::coarse_point");
  coefficient_ = device_values(blocks.coefficient, "rpc::solver::coarse_coefficient");
  Kokkos::deep_copy(entry_, entry);
  Kokkos::deep_copy(base_, base);
  Kokkos::deep_copy(own_entry_, own_entry);
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

void CoarseContact::write(const DeviceView<double ***> &update)
{
  const auto values = A_->getLocalMatrixDevice().values;
  Kokkos::parallel_for("rpc::solver::write_contact", device_range(static_cast<LO>(row_.extent(0))),
                       WriteBlocks<std::decay_t<decltype(values)>>{dim_, row_, column_, entry_, base_, begin_, point_,
                                                                   coefficient_, prescribed_, update, values});
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
