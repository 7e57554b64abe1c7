// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/contact_blocks.hpp"

#include "multigrid/host_rows.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/graph.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace rpc::solver
{
namespace
{

const LO invalid = Teuchos::OrdinalTraits<LO>::invalid();

/// What a contact node adds to a block of a node's rows.
struct Part {
  std::size_t place; // of the block in the rows
  int contact;
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

/// The entries of supports that lie at each of some nodes.
/// @param nodes  ascending, some   @param node  (entries) of them, or -1
Lists entries_at(const std::vector<LO> &nodes, const std::vector<LO> &node)
{
  std::vector<std::size_t> number_of(nodes.back() + 1), number; // of a node, of an entry's node
  for (std::size_t n = 0; n < nodes.size(); ++n) number_of[nodes[n]] = n;
  Lists lists;
  lists.begin.assign(nodes.size() + 1, 0);
  for (const LO n : node) {
    number.push_back(n >= 0 ? number_of[n] : 0);
    if (n >= 0) ++lists.begin[number.back() + 1];
  }
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.value.resize(lists.begin.back());
  std::vector<std::size_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (std::size_t k = 0; k < node.size(); ++k)
    if (node[k] >= 0) lists.value[next[number[k]]++] = static_cast<int>(k);
  return lists;
}

/// Appends the blocks of a node's rows, by their columns, with their parts in the order of the contact nodes.
/// @param n  number of the node among those of `blocks` and `around`
void add_blocks(const HostRows &around, const std::size_t n, const int dim, const std::vector<Part> &parts,
                ContactBlocks &blocks)
{
  const LO node = blocks.nodes[n];
  const std::size_t start = around.begin[n];
  std::vector<std::size_t> begin(around.begin[n + 1] - start + 1);
  for (const Part &part : parts) ++begin[part.place + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  const std::size_t so_far = blocks.contact.size();
  for (std::size_t place = 0; place + 1 < begin.size(); ++place) {
    if (begin[place] == begin[place + 1]) continue;
    const LO column = around.column(start + place);
    if (column == node) blocks.own.push_back(blocks.row.size());
    blocks.row.push_back(node);
    blocks.column.push_back(column);
    blocks.begin.push_back(so_far + begin[place + 1]);
    blocks.place.push_back(static_cast<LO>(place));
    for (int k = 0; k < dim * dim; ++k) blocks.base.push_back(around.value(dim * dim * (start + place) + k));
  }
  blocks.contact.resize(so_far + parts.size());
  blocks.coefficient.resize(so_far + parts.size());
  for (const Part &part : parts) {
    const std::size_t to = so_far + begin[part.place]++;
    blocks.contact[to] = part.contact;
    blocks.coefficient[to] = part.coefficient;
  }
}

} // namespace

ContactBlocks contact_blocks(const NearSupports &supports, const RepeatedRows &A, const Map &rows, const Map &columns)
{
  const int dim = A.dim();
  const SupportRows &right = supports.column.size() > 0 ? supports.column : supports;
  const std::vector<LO> row_node = local_nodes(rows, dim, supports.node);
  const std::vector<LO> column_node = local_nodes(columns, dim, right.node);
  ContactBlocks blocks;
  auto &nodes = blocks.nodes;
  std::copy_if(row_node.begin(), row_node.end(), std::back_inserter(nodes), [](const LO node) { return node >= 0; });
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.empty()) return blocks;
  const HostRows around = host_blocks(A, nodes);
  std::vector<int> contact_of; // (supports' entries)
  for (int c = 0; c < supports.size(); ++c) contact_of.resize(supports.begin[c + 1], c);
  const Lists entries = entries_at(nodes, row_node);

  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> place_of(num_local(columns) / dim, none); // of columns' nodes in the rows of a node
  std::vector<Part> parts;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::size_t start = around.begin[n], places = around.begin[n + 1] - start;
    const auto column_at = [&](const std::size_t place) { return around.column(start + place); };
    for (std::size_t place = 0; place < places; ++place) place_of[column_at(place)] = place;
    parts.clear();
    for (std::size_t e = entries.begin[n]; e < entries.begin[n + 1]; ++e) {
      const int k = entries.value[e], c = contact_of[k];
      for (std::size_t l = right.begin[c]; l < right.begin[c + 1]; ++l) {
        const double both = supports.weight[k] * right.weight[l];
        const std::size_t place = column_node[l] < 0 ? none : place_of[column_node[l]];
        blocks.bounded += place == none;
        if (place == none)
          parts.push_back({place_of[nodes[n]], c, std::abs(both)});
        else
          parts.push_back({place, c, both});
      }
    }
    add_blocks(around, n, dim, parts, blocks);
    for (std::size_t place = 0; place < places; ++place) place_of[column_at(place)] = none;
  }
  return blocks;
}

} // namespace rpc::solver
