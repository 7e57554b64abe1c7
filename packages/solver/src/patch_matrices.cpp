// SPDX-License-Identifier: BSD-3-Clause
#include "patch_matrices.hpp"

#include "host_rows.hpp"
#include "rpc/core/dofs.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <iterator>
#include <map>
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

PatchMatrices::PatchMatrices(const RepeatedRows &rows, const RCP<const Map> &nodes, const std::vector<GO> &columns,
                             const NodePatches &patches, const AddedBlocks &added)
    : dim_(rows.dim()), nodes_(nodes), num_owned_(num_local(*nodes)), rows_(rows), columns_(columns),
      kind_(to_host(rows.blocks().kind))
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
  if (nodes->getComm()->getSize() > 1) {
    questions_ = std::make_unique<OwnerQuestions>(*nodes, ghosts_);
    const HostRows asked = host_blocks(*rows_, questions_->asked());
    BlockRows mine;
    mine.begin = asked.begin;
    for (std::size_t b = 0; b < asked.begin.back(); ++b) mine.column.push_back(columns_[asked.column(b)]);
    mine.value.assign(asked.value.data(), asked.value.data() + asked.value.extent(0));
    ghost_rows_ = rows_of_ghosts(mine);
  }
  const auto row = to_host(added.row), column = to_host(added.column);
  for (std::size_t b = 0; b < row.extent(0); ++b) {
    added_row_.push_back(row(b));
    added_column_.push_back(columns_[column(b)]);
  }
  set_added(added.block);
}

void PatchMatrices::forget_rows()
{
  rows_.reset();
  ghost_rows_ = {};
}

/// (ghosts) The rows that their owners have; collective.
/// @param mine  (nodes that this rank is asked for)
BlockRows PatchMatrices::rows_of_ghosts(const BlockRows &mine) const
{
  const std::size_t area = static_cast<std::size_t>(dim_) * dim_;
  NumberLists blocks; // each a column and its values
  for (std::size_t r = 0; r + 1 < mine.begin.size(); ++r) {
    for (std::size_t b = mine.begin[r]; b < mine.begin[r + 1]; ++b) {
      const double *const value = &mine.value[area * b];
      blocks.value.push_back(static_cast<double>(mine.column[b]));
      blocks.value.insert(blocks.value.end(), value, value + area);
    }
    blocks.begin.push_back(blocks.value.size());
  }
  const NumberLists got = questions_->answers(blocks);
  BlockRows rows;
  for (std::size_t g = 0; g + 1 < got.begin.size(); ++g) {
    for (std::size_t at = got.begin[g]; at < got.begin[g + 1]; at += 1 + area) {
      const double *const value = &got.value[at] + 1;
      rows.column.push_back(static_cast<GO>(got.value[at]));
      rows.value.insert(rows.value.end(), value, value + area);
    }
    rows.begin.push_back(rows.column.size());
  }
  return rows;
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
    const int kind = node_[e] < num_owned_ ? kind_(node_[e]) : -1;
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
  std::vector<LO> own;
  std::copy_if(node_.begin() + begin_[patch], node_.begin() + begin_[patch + 1], std::back_inserter(own),
               [this](const LO node) { return node < num_owned_; });
  const HostRows rows = host_blocks(*rows_, own);
  const std::size_t area = static_cast<std::size_t>(dim_) * dim_;
  std::size_t next = 0; // of `own`
  return gathered(patch, [&](const LO node, const TakeBlock &take) {
    if (node < num_owned_) {
      for (std::size_t b = rows.begin[next]; b < rows.begin[next + 1]; ++b)
        take(columns_[rows.column(b)], &rows.value(area * b));
      ++next;
    } else {
      take_row(ghost_rows_, node - num_owned_, take);
    }
  });
}

/// The blocks of a row.
void PatchMatrices::take_row(const BlockRows &rows, const std::size_t row, const TakeBlock &take) const
{
  for (std::size_t b = rows.begin[row]; b < rows.begin[row + 1]; ++b)
    take(rows.column[b], &rows.value[static_cast<std::size_t>(dim_) * dim_ * b]);
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
  added_ = {};
  for (LO n = 0; n < num_owned_; ++n) append_added(n, value, added_);
  if (!questions_) return;
  BlockRows mine;
  for (const LO node : questions_->asked()) append_added(node, value, mine);
  const BlockRows of_ghosts = rows_of_ghosts(mine);
  for (std::size_t g = 0; g < ghosts_.size(); ++g)
    append_row(of_ghosts, g, static_cast<std::size_t>(dim_) * dim_, added_);
}

std::vector<double> PatchMatrices::added(const int patch) const
{
  return gathered(patch, [this](const LO node, const TakeBlock &take) { take_row(added_, node, take); });
}

} // namespace rpc::solver
