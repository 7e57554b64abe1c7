// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/contact_supports.hpp"

#include "multigrid/host_rows.hpp"
#include "multigrid/owner_questions.hpp"
#include "rpc/core/exchange.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <utility>

// Contact nodes are few, so that their supports live on the host; doubles hold gids exactly.

namespace rpc::solver
{
namespace
{

const LO elsewhere = Teuchos::OrdinalTraits<LO>::invalid();
const auto to_be_counted = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();

/// Some gids, each once, ascending.
std::vector<GO> distinct(std::vector<GO> gids)
{
  std::sort(gids.begin(), gids.end());
  gids.erase(std::unique(gids.begin(), gids.end()), gids.end());
  return gids;
}

std::size_t place_in(const std::vector<GO> &sorted, const GO gid)
{
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), gid) - sorted.begin());
}

/// Numbers of a message: those of a support's entries, and the entries.
void write_row(const SupportRows &rows, const int c, double *&to)
{
  if (rows.size() == 0) return;
  for (std::size_t e = rows.begin[c]; e < rows.begin[c + 1]; ++e) {
    *to++ = static_cast<double>(rows.node[e]);
    *to++ = rows.weight[e];
  }
}
int row_length(const SupportRows &rows, const int c)
{
  return rows.size() == 0 ? 0 : static_cast<int>(rows.begin[c + 1] - rows.begin[c]);
}
const double *read_row(const double *from, const int length, SupportRows &rows)
{
  for (int e = 0; e < length; ++e, from += 2) {
    rows.node.push_back(static_cast<GO>(from[0]));
    rows.weight.push_back(from[1]);
  }
  rows.begin.push_back(rows.node.size());
  return from;
}

/// Appends entries of other rows.
void append(const SupportRows &from, const int row, SupportRows &to)
{
  const auto first = static_cast<std::ptrdiff_t>(from.begin[row]),
             last = static_cast<std::ptrdiff_t>(from.begin[row + 1]);
  to.node.insert(to.node.end(), from.node.begin() + first, from.node.begin() + last);
  to.weight.insert(to.weight.end(), from.weight.begin() + first, from.weight.begin() + last);
  to.begin.push_back(to.node.size());
}

/// Rows of a matrix that this rank has, by their columns' gids.
SupportRows own_rows(const CrsMatrix &P, const std::vector<LO> &rows)
{
  const HostRows mine = host_rows(P, rows);
  const Map &columns = *P.getColMap();
  SupportRows result;
  result.begin = mine.begin;
  result.node.reserve(mine.begin.back());
  for (std::size_t e = 0; e < mine.begin.back(); ++e) result.node.push_back(columns.getGlobalElement(mine.column(e)));
  result.weight.assign(mine.value.data(), mine.value.data() + mine.begin.back());
  return result;
}

/// (gids) Rows of a matrix that other ranks own; collective.
SupportRows rows_of_others(const CrsMatrix &P, const std::vector<GO> &gids)
{
  const OwnerQuestions questions(*P.getRowMap(), gids);
  const SupportRows mine = own_rows(P, questions.asked());
  NumberLists entries; // twice as many numbers
  entries.value.resize(2 * mine.node.size());
  double *to = entries.value.data();
  for (int i = 0; i < mine.size(); ++i) {
    write_row(mine, i, to);
    entries.begin.push_back(2 * mine.begin[i + 1]);
  }
  const NumberLists got = questions.answers(entries);
  SupportRows rows;
  for (std::size_t k = 0; k < gids.size(); ++k)
    read_row(got.value.data() + got.begin[k], static_cast<int>(got.begin[k + 1] - got.begin[k]) / 2, rows);
  return rows;
}

/// (gids) The rows of a matrix, whatever ranks own them; collective.
/// @param gids  ascending, each once
SupportRows rows_of(const CrsMatrix &P, const std::vector<GO> &gids)
{
  const Map &map = *P.getRowMap();
  std::vector<LO> own(gids.size()), here;
  std::vector<GO> others;
  for (std::size_t k = 0; k < gids.size(); ++k) {
    own[k] = map.getLocalElement(gids[k]);
    if (own[k] == elsewhere)
      others.push_back(gids[k]);
    else
      here.push_back(own[k]);
  }
  SupportRows mine = own_rows(P, here);
  if (map.getComm()->getSize() == 1) return mine;
  const SupportRows theirs = rows_of_others(P, others);
  if (others.empty()) return mine;
  SupportRows rows;
  int next_own = 0, next_other = 0;
  for (const LO row : own) row == elsewhere ? append(theirs, next_other++, rows) : append(mine, next_own++, rows);
  return rows;
}

} // namespace

ContactSupports contact_supports(const DeviceView<LO *> &nodes, const RCP<const Map> &mesh)
{
  const auto node = to_host(nodes);
  ContactSupports supports;
  supports.contact = rcp(new Map(to_be_counted, node.extent(0), 0, mesh->getComm()));
  for (std::size_t c = 0; c < node.extent(0); ++c) {
    supports.node.push_back(mesh->getGlobalElement(node(c)));
    supports.weight.push_back(1);
    supports.begin.push_back(c + 1);
  }
  return supports;
}

ContactSupports coarser(const ContactSupports &supports, const CrsMatrix &interpolation)
{
  const std::vector<GO> wanted = distinct(supports.node);
  const SupportRows rows = rows_of(interpolation, wanted);
  ContactSupports coarse;
  coarse.contact = supports.contact;
  std::vector<std::pair<GO, double>> sum; // of one contact node
  for (int c = 0; c < supports.size(); ++c) {
    sum.clear();
    for (std::size_t e = supports.begin[c]; e < supports.begin[c + 1]; ++e) {
      const std::size_t row = place_in(wanted, supports.node[e]);
      for (std::size_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k)
        sum.emplace_back(rows.node[k], supports.weight[e] * rows.weight[k]);
    }
    std::stable_sort(sum.begin(), sum.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    const std::size_t first = coarse.node.size();
    for (const auto &[node, weight] : sum) {
      if (coarse.node.size() > first && coarse.node.back() == node) {
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

ContactSupports supports_of_blocks(const std::vector<GO> &row, const std::vector<GO> &column,
                                   const CrsMatrix &interpolation)
{
  std::vector<GO> wanted = row; // ascending
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const Map &nodes = *interpolation.getRowMap();
  std::vector<GO> others;
  for (const GO gid : column)
    if (!nodes.isNodeGlobalElement(gid)) others.push_back(gid);
  others = distinct(std::move(others));
  const auto own = static_cast<std::ptrdiff_t>(wanted.size());
  wanted.insert(wanted.end(), others.begin(), others.end());
  std::inplace_merge(wanted.begin(), wanted.begin() + own, wanted.end());
  const SupportRows rows = rows_of(interpolation, wanted);
  std::vector<int> number(num_local(nodes)); // of an owned node among these
  for (std::size_t k = 0; k < wanted.size(); ++k)
    if (const LO node = nodes.getLocalElement(wanted[k]); node != elsewhere) number[node] = static_cast<int>(k);
  const auto row_of = [&](const GO gid) {
    const LO node = nodes.getLocalElement(gid);
    return node == elsewhere ? static_cast<int>(place_in(wanted, gid)) : number[node];
  };
  ContactSupports supports;
  supports.contact = rcp(new Map(to_be_counted, row.size(), 0, nodes.getComm()));
  for (SupportRows *const rows_of_side : {static_cast<SupportRows *>(&supports), &supports.column}) {
    rows_of_side->begin.reserve(row.size() + 1);
    rows_of_side->node.reserve(4 * row.size()); // on a flat side at most
    rows_of_side->weight.reserve(4 * row.size());
  }
  for (std::size_t b = 0; b < row.size(); ++b) {
    append(rows, row_of(row[b]), supports);
    append(rows, row_of(column[b]), supports.column);
  }
  return supports;
}

namespace
{

/// (entries) The ranks that own the nodes; collective.
std::vector<int> owners_of_entries(const SupportRows &supports, const Map &mesh)
{
  std::vector<GO> others;
  for (const GO gid : supports.node)
    if (!mesh.isNodeGlobalElement(gid)) others.push_back(gid);
  others = distinct(std::move(others));
  const std::vector<int> owner = owners(mesh, others);
  const int here = mesh.getComm()->getRank();
  std::vector<int> ranks;
  ranks.reserve(supports.node.size());
  for (const GO gid : supports.node)
    ranks.push_back(mesh.isNodeGlobalElement(gid) ? here : owner[place_in(others, gid)]);
  return ranks;
}

} // namespace

namespace
{

/// Contact nodes with an entry at a node of another rank, for each rank, in their order; `own`: those with one at a node of this rank.
struct Destinations {
  std::vector<std::vector<int>> to_rank; // none to this one
  std::vector<int> own;
};

Destinations destinations(const ContactSupports &supports, const Map &mesh)
{
  const int here = mesh.getComm()->getRank();
  const std::vector<int> owner = owners_of_entries(supports, mesh);
  Destinations to{std::vector<std::vector<int>>(mesh.getComm()->getSize()), {}};
  for (int c = 0; c < supports.size(); ++c)
    for (std::size_t e = supports.begin[c]; e < supports.begin[c + 1]; ++e) {
      auto &list = owner[e] == here ? to.own : to.to_rank[owner[e]];
      if (list.empty() || list.back() != c) list.push_back(c);
    }
  return to;
}

/// Supports that other ranks have sent, by the gids of their contact nodes.
struct Received : SupportRows {
  std::vector<GO> gid;
  SupportRows column;
};

/// Collective.
Received exchange_supports(const ContactSupports &supports, const std::vector<std::vector<int>> &to_rank,
                           const bool two_sided, const Comm &comm)
{
  int longest = 0;
  std::vector<int> counts;
  std::size_t num_sent = 0;
  for (const auto &list : to_rank) {
    counts.push_back(static_cast<int>(list.size()));
    num_sent += list.size();
    for (const int c : list) longest = std::max(longest, row_length(supports, c) + row_length(supports.column, c));
  }
  constexpr int head = 3; // gid of the contact node, numbers of entries
  const int width = head + 2 * max_all(comm, longest);
  std::vector<double> sent(width * num_sent);
  double *next = sent.data();
  for (const auto &list : to_rank)
    for (const int c : list) {
      double *to = next;
      *to++ = static_cast<double>(supports.contact->getGlobalElement(c));
      *to++ = row_length(supports, c);
      *to++ = row_length(supports.column, c);
      write_row(supports, c, to);
      write_row(supports.column, c, to);
      next += width;
    }
  const Exchange exchange(comm, counts);
  const auto got = exchange.forward(sent, width);
  Received received;
  for (int k = 0; k < exchange.num_received(); ++k) {
    const double *const row = &got[static_cast<std::size_t>(width) * k];
    received.gid.push_back(static_cast<GO>(row[0]));
    const double *const columns = read_row(row + head, static_cast<int>(row[1]), received);
    if (two_sided) read_row(columns, static_cast<int>(row[2]), received.column);
  }
  return received;
}

} // namespace

NearSupports near_supports(const ContactSupports &supports, const Map &mesh)
{
  const Comm &comm = *mesh.getComm();
  const Destinations to = destinations(supports, mesh);
  const bool two_sided = max_all(comm, supports.column.size()) > 0;
  Received received;
  if (comm.getSize() > 1) received = exchange_supports(supports, to.to_rank, two_sided, comm);
  std::vector<std::pair<GO, int>> order; // (gid of the contact node, row): of this rank's own ones, then of the others
  for (const int c : to.own) order.emplace_back(supports.contact->getGlobalElement(c), c);
  for (std::size_t k = 0; k < received.gid.size(); ++k)
    order.emplace_back(received.gid[k], supports.size() + static_cast<int>(k));
  if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
  NearSupports near;
  for (auto [rows, own] : {std::pair<SupportRows *, const SupportRows *>(&near, &supports),
                           std::pair<SupportRows *, const SupportRows *>(&near.column, &supports.column)}) {
    rows->begin.reserve(order.size() + 1);
    rows->node.reserve(own->node.size());
    rows->weight.reserve(own->weight.size());
  }
  Teuchos::Array<GO> gids;
  gids.reserve(static_cast<Teuchos::Array<GO>::size_type>(order.size()));
  for (const auto &[gid, k] : order) {
    gids.push_back(gid);
    const bool own = k < supports.size();
    const int row = own ? k : k - supports.size();
    append(own ? static_cast<const SupportRows &>(supports) : received, row, near);
    if (two_sided) append(own ? supports.column : received.column, row, near.column);
  }
  RCP<const Map> their_map = supports.contact;
  if (comm.getSize() > 1 || near.size() != supports.size())
    their_map = rcp(new Map(to_be_counted, gids(), 0, mesh.getComm()));
  near.importer = rcp(new Import(supports.contact, their_map));
  return near;
}

} // namespace rpc::solver
