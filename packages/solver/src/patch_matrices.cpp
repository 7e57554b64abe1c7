#include "patch_matrices.hpp"

#include "rpc/core/dofs.hpp"
#include "rpc/core/error.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace rpc::solver
{
namespace
{

const LO owned_elsewhere = Teuchos::OrdinalTraits<LO>::invalid();

void append_row(const BlockRows &from, const std::size_t row, const std::size_t area, BlockRows &to)
{
  const auto at = [](const std::size_t k) { return static_cast<std::ptrdiff_t>(k); };
  const std::size_t first = from.begin[row], last = from.begin[row + 1];
  to.column.insert(to.column.end(), from.column.begin() + at(first), from.column.begin() + at(last));
  to.value.insert(to.value.end(), from.value.begin() + at(area * first), from.value.begin() + at(area * last));
  to.begin.push_back(to.column.size());
}

} // namespace

/// The rows of owned nodes.
class PatchMatrices::Rows
{
public:
  Rows(const RepeatedRows &rows, const std::vector<GO> &columns)
      : dim_(rows.dim()), columns_(columns), kind_(to_host(rows.blocks().kind)), begin_(to_host(rows.blocks().begin)),
        offset_(to_host(rows.blocks().offset)), value_(to_host(rows.blocks().value)),
        row_map_(to_host(rows.blocks().rest.graph.row_map)), entries_(to_host(rows.blocks().rest.graph.entries)),
        values_(to_host(rows.blocks().rest.values))
  {
  }
  /// Nodes of one kind have the same rows but for a shift of the columns; < 0: of no kind.
  int kind(const LO node) const { return kind_(node); }
  GO gid(const LO column) const { return columns_[column]; }
  void append(const LO node, BlockRows &to) const
  {
    const int k = kind_(node);
    if (k >= 0) {
      for (LO n = begin_(k); n < begin_(k + 1); ++n) {
        to.column.push_back(columns_[node + offset_(n)]);
        const std::size_t block = RepeatedRows::block_size(dim_) * n;
        for (int i = 0; i < dim_; ++i)
          for (int j = 0; j < dim_; ++j) to.value.push_back(value_(block + RepeatedRows::place_in_block(dim_, i, j)));
      }
    } else {
      const LO row = dim_ * (-1 - k);
      const std::size_t first = row_map_(row), length = row_map_(row + 1) - first;
      for (std::size_t e = 0; e < length; e += dim_) {
        to.column.push_back(columns_[node_of(dim_, entries_(first + e))]);
        for (int i = 0; i < dim_; ++i)
          for (int j = 0; j < dim_; ++j) to.value.push_back(values_(row_map_(row + i) + e + j));
      }
    }
    to.begin.push_back(to.column.size());
  }

private:
  using Matrix = RowsOfNodes::LocalMatrix;

  int dim_;
  std::vector<GO> columns_;
  decltype(to_host(DeviceView<int *>())) kind_;
  decltype(to_host(DeviceView<LO *>())) begin_, offset_;
  decltype(to_host(DeviceView<double *>())) value_;
  decltype(to_host(Matrix::row_map_type())) row_map_;
  decltype(to_host(Matrix::index_type())) entries_;
  decltype(to_host(Matrix::values_type())) values_;
};

PatchMatrices::PatchMatrices(const RepeatedRows &rows, const RCP<const Map> &nodes, const std::vector<GO> &columns,
                             const NodePatches &patches, const AddedBlocks &added)
    : dim_(rows.dim()), nodes_(nodes), num_owned_(num_local(*nodes)), rows_(std::make_shared<Rows>(rows, columns))
{
  for (const std::size_t b : patches.begin) begin_.push_back(static_cast<LO>(b));
  std::unordered_map<GO, LO> place_of_ghost;
  for (const GO gid : patches.node) {
    LO node = nodes->getLocalElement(gid);
    if (node == owned_elsewhere) {
      const auto [at, is_new] = place_of_ghost.try_emplace(gid, num_owned_ + static_cast<LO>(ghosts_.size()));
      if (is_new) ghosts_.push_back(gid);
      node = at->second;
    }
    node_.push_back(node);
  }
  if (nodes->getComm()->getSize() > 1) ask_owners();
  ghost_rows_ = rows_of_ghosts([this](const LO node, BlockRows &to) { rows_->append(node, to); });
  const auto row = to_host(added.row), column = to_host(added.column);
  for (std::size_t b = 0; b < row.extent(0); ++b) {
    added_row_.push_back(row(b));
    added_column_.push_back(rows_->gid(column(b)));
  }
  set_added(added.block);
}

/// Tells the owners of ghosts whose rows this rank wants; collective.
void PatchMatrices::ask_owners()
{
  const Comm &comm = *nodes_->getComm();
  std::vector<int> rank(ghosts_.size()), counts(comm.getSize());
  const auto size = static_cast<Teuchos_Ordinal>(ghosts_.size());
  nodes_->getRemoteIndexList(Teuchos::ArrayView<const GO>(ghosts_.data(), size),
                             Teuchos::ArrayView<int>(rank.data(), size));
  std::vector<std::size_t> order(ghosts_.size()); // of the questions: by the rank that is asked
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](const std::size_t a, const std::size_t b) { return rank[a] < rank[b]; });
  std::vector<double> questions;
  answer_.resize(ghosts_.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    ++counts[rank[order[k]]];
    questions.push_back(static_cast<double>(ghosts_[order[k]]));
    answer_[order[k]] = k;
  }
  exchange_ = std::make_unique<Exchange>(comm, counts);
  for (const double gid : exchange_->forward(questions, 1))
    asked_.push_back(nodes_->getLocalElement(static_cast<GO>(gid)));
}

void PatchMatrices::forget_rows()
{
  rows_.reset();
  ghost_rows_ = {};
}

/// (ghosts) What their owners append for them; collective.
BlockRows PatchMatrices::rows_of_ghosts(const AppendRow &append) const
{
  BlockRows result;
  if (!exchange_) return result;
  BlockRows mine;
  for (const LO node : asked_) append(node, mine);
  const std::size_t area = static_cast<std::size_t>(dim_) * dim_;
  std::size_t longest = 0;
  for (std::size_t r = 0; r < asked_.size(); ++r) longest = std::max(longest, mine.begin[r + 1] - mine.begin[r]);
  longest = max_all(*nodes_->getComm(), longest);
  const std::size_t width = 1 + longest * (1 + area); // the number of blocks, their columns, their values
  const double bytes =
      static_cast<double>(max_all(*nodes_->getComm(), asked_.size())) * static_cast<double>(width) * sizeof(double);
  RPC_REQUIRE_CODE(bytes < std::numeric_limits<int>::max(), ExitCode::bad_mesh,
                   "multigrid: neighbouring ranks would exchange "
                       << bytes << " bytes, of which a message has at most 2^31. Use more ranks.");
  std::vector<double> answers(width * asked_.size());
  for (std::size_t r = 0; r < asked_.size(); ++r) {
    const std::size_t first = mine.begin[r], size = mine.begin[r + 1] - first;
    double *const to = &answers[width * r];
    to[0] = static_cast<double>(size);
    for (std::size_t b = 0; b < size; ++b) to[1 + b] = static_cast<double>(mine.column[first + b]);
    std::copy_n(mine.value.begin() + static_cast<std::ptrdiff_t>(area * first), area * size, to + 1 + longest);
  }
  const auto got = exchange_->back(answers, static_cast<int>(width));
  for (const std::size_t answer : answer_) {
    const double *const from = &got[width * answer], *const value = from + 1 + longest;
    const auto size = static_cast<std::size_t>(from[0]);
    for (std::size_t b = 0; b < size; ++b) result.column.push_back(static_cast<GO>(from[1 + b]));
    result.value.insert(result.value.end(), value, value + area * size);
    result.begin.push_back(result.column.size());
  }
  return result;
}

bool PatchMatrices::changes(const int patch) const
{
  return std::any_of(node_.begin() + begin_[patch], node_.begin() + begin_[patch + 1],
                     [&](const LO n) { return added_.begin[n + 1] > added_.begin[n]; });
}

/// The kinds of its nodes, and how they are numbered.
std::vector<LO> PatchMatrices::likeness(const int patch) const
{
  std::vector<LO> likeness;
  for (LO e = begin_[patch]; e < begin_[patch + 1]; ++e) {
    const int kind = node_[e] < num_owned_ ? rows_->kind(node_[e]) : -1;
    if (kind < 0) return {};
    likeness.push_back(kind);
    likeness.push_back(node_[e] - node_[begin_[patch]]);
  }
  return likeness;
}

/// @param blocks_of  the blocks in a node's rows
std::vector<double> PatchMatrices::gathered(const int patch,
                                            const std::function<void(LO node, const TakeBlock &take)> &blocks_of) const
{
  const LO first = begin_[patch], size = begin_[patch + 1] - first, rows = dim_ * size;
  std::map<GO, LO> place_of;
  for (LO i = 0; i < size; ++i) {
    const LO n = node_[first + i];
    place_of.emplace(n < num_owned_ ? nodes_->getGlobalElement(n) : ghosts_[n - num_owned_], i);
  }
  std::vector<double> matrix(static_cast<std::size_t>(rows) * rows);
  for (LO i = 0; i < size; ++i)
    blocks_of(node_[first + i], [&](const GO column, const double *const value) {
      const auto found = place_of.find(column);
      if (found == place_of.end()) return;
      for (int k = 0; k < dim_; ++k)
        for (int l = 0; l < dim_; ++l)
          matrix[static_cast<std::size_t>(rows) * dof(dim_, i, k) + dof(dim_, found->second, l)] += value[dim_ * k + l];
    });
  return matrix;
}

std::vector<double> PatchMatrices::without_contact(const int patch) const
{
  const auto take_row = [this](const BlockRows &rows, const std::size_t row, const TakeBlock &take) {
    for (std::size_t b = rows.begin[row]; b < rows.begin[row + 1]; ++b)
      take(rows.column[b], &rows.value[static_cast<std::size_t>(dim_) * dim_ * b]);
  };
  return gathered(patch, [&](const LO node, const TakeBlock &take) {
    if (node >= num_owned_) return take_row(ghost_rows_, node - num_owned_, take);
    BlockRows own;
    rows_->append(node, own);
    take_row(own, 0, take);
  });
}

/// Appends what contact adds in the rows of an owned node.
void PatchMatrices::append_added(const LO node, const BlocksOnHost &block, BlockRows &to) const
{
  const auto [first, last] = std::equal_range(added_row_.begin(), added_row_.end(), node);
  for (auto row = first; row != last; ++row) {
    const auto b = static_cast<std::size_t>(row - added_row_.begin());
    to.column.push_back(added_column_[b]);
    for (int k = 0; k < dim_; ++k)
      for (int l = 0; l < dim_; ++l) to.value.push_back(block(b, k, l));
  }
  to.begin.push_back(to.column.size());
}

void PatchMatrices::set_added(const DeviceView<double ***> &block)
{
  const auto value = to_host(block);
  const auto append = [&](const LO node, BlockRows &to) { append_added(node, value, to); };
  added_ = {};
  for (LO n = 0; n < num_owned_; ++n) append(n, added_);
  const BlockRows of_ghosts = rows_of_ghosts(append);
  for (std::size_t g = 0; g < ghosts_.size(); ++g)
    append_row(of_ghosts, g, static_cast<std::size_t>(dim_) * dim_, added_);
}

std::vector<double> PatchMatrices::added(const int patch) const
{
  return gathered(patch, [this](const LO node, const TakeBlock &take) {
    for (std::size_t b = added_.begin[node]; b < added_.begin[node + 1]; ++b)
      take(added_.column[b], &added_.value[static_cast<std::size_t>(dim_) * dim_ * b]);
  });
}

} // namespace rpc::solver
