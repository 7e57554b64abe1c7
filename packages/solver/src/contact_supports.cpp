#include "contact_supports.hpp"

#include "host_rows.hpp"
#include "rpc/core/exchange.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <map>
#include <utility>

// Contact nodes are few, so that their supports live on the host; doubles hold gids exactly.

namespace rpc::solver
{
namespace
{

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

/// (gids) The rank that owns each of them; collective.
std::vector<int> owners(const Map &map, const std::vector<GO> &gids)
{
  std::vector<int> ranks(gids.size(), 0);
  if (map.getComm()->getSize() > 1)
    map.getRemoteIndexList(Teuchos::ArrayView<const GO>(gids.data(), static_cast<Teuchos_Ordinal>(gids.size())),
                           Teuchos::ArrayView<int>(ranks.data(), static_cast<Teuchos_Ordinal>(ranks.size())));
  return ranks;
}

/// Rows of a matrix, as (column's gid, value).
using Row = std::vector<std::pair<GO, double>>;

/// (gids) The rows of a matrix, whatever ranks own them; collective.
/// @param gids  ascending, each once
std::vector<Row> rows_of(const CrsMatrix &P, const std::vector<GO> &gids)
{
  const Comm &comm = *P.getComm();
  const auto rank = owners(*P.getRowMap(), gids);
  std::vector<std::size_t> order(gids.size()); // of the questions: by the rank that is asked
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](const std::size_t a, const std::size_t b) { return rank[a] < rank[b]; });
  std::vector<int> counts(comm.getSize());
  std::vector<double> questions;
  for (const std::size_t k : order) {
    ++counts[rank[k]];
    questions.push_back(static_cast<double>(gids[k]));
  }
  const Exchange exchange(comm, counts);
  std::vector<LO> asked;
  for (const double gid : exchange.forward(questions, 1))
    asked.push_back(P.getRowMap()->getLocalElement(static_cast<GO>(gid)));
  const HostRows mine = host_rows(P, asked);
  int longest = 0;
  for (std::size_t i = 0; i < asked.size(); ++i)
    longest = std::max(longest, static_cast<int>(mine.begin[i + 1] - mine.begin[i]));
  const int width = 1 + 2 * max_all(comm, longest); // number of entries, entries
  std::vector<double> answers(static_cast<std::size_t>(width) * asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    double *answer = &answers[width * i];
    *answer++ = static_cast<double>(mine.begin[i + 1] - mine.begin[i]);
    for (std::size_t e = mine.begin[i]; e < mine.begin[i + 1]; ++e) {
      *answer++ = static_cast<double>(P.getColMap()->getGlobalElement(mine.column(e)));
      *answer++ = mine.value(e);
    }
  }
  const auto got = exchange.back(answers, width);
  std::vector<Row> rows(gids.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double *const row = &got[width * k];
    for (int e = 0; e < static_cast<int>(row[0]); ++e)
      rows[order[k]].emplace_back(static_cast<GO>(row[1 + 2 * e]), row[2 + 2 * e]);
  }
  return rows;
}

void append_row(const Row &row, SupportRows &rows)
{
  for (const auto &[node, weight] : row) {
    rows.node.push_back(node);
    rows.weight.push_back(weight);
  }
  rows.begin.push_back(rows.node.size());
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
  const std::vector<Row> rows = rows_of(interpolation, wanted);
  ContactSupports coarse;
  coarse.contact = supports.contact;
  std::map<GO, double> sum; // of one contact node
  for (int c = 0; c < supports.size(); ++c) {
    sum.clear();
    for (std::size_t e = supports.begin[c]; e < supports.begin[c + 1]; ++e)
      for (const auto &[node, weight] : rows[place_in(wanted, supports.node[e])])
        sum[node] += supports.weight[e] * weight;
    for (const auto &[node, weight] : sum) {
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
  const std::vector<Row> rows = rows_of(interpolation, wanted);
  ContactSupports supports;
  supports.contact = rcp(new Map(to_be_counted, row.size(), 0, nodes.getComm()));
  for (std::size_t b = 0; b < row.size(); ++b) {
    append_row(rows[place_in(wanted, row[b])], supports);
    append_row(rows[place_in(wanted, column[b])], supports.column);
  }
  return supports;
}

namespace
{

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

NearSupports near_supports(const ContactSupports &supports, const Map &mesh)
{
  const Comm &comm = *mesh.getComm();
  const std::vector<int> owner = owners_of_entries(supports, mesh);
  int longest = 0;
  std::vector<std::vector<int>> to_rank(comm.getSize()); // contact nodes
  for (int c = 0; c < supports.size(); ++c) {
    longest = std::max(longest, row_length(supports, c) + row_length(supports.column, c));
    for (std::size_t e = supports.begin[c]; e < supports.begin[c + 1]; ++e) {
      auto &list = to_rank[owner[e]];
      if (list.empty() || list.back() != c) list.push_back(c);
    }
  }
  constexpr int head = 3; // gid of the contact node, numbers of entries
  const int width = head + 2 * max_all(comm, longest);
  std::vector<int> counts;
  std::size_t num_sent = 0;
  for (const auto &list : to_rank) {
    counts.push_back(static_cast<int>(list.size()));
    num_sent += list.size();
  }
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
  std::vector<std::pair<GO, std::size_t>> order; // (gid of the contact node, row)
  for (int k = 0; k < exchange.num_received(); ++k)
    order.emplace_back(static_cast<GO>(got[static_cast<std::size_t>(width) * k]), k);
  if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
  const bool two_sided = max_all(comm, supports.column.size()) > 0;
  NearSupports near;
  Teuchos::Array<GO> gids;
  for (const auto &[gid, k] : order) {
    gids.push_back(gid);
    const double *const row = &got[width * k];
    const double *const columns = read_row(row + head, static_cast<int>(row[1]), near);
    if (two_sided) read_row(columns, static_cast<int>(row[2]), near.column);
  }
  near.importer = rcp(new Import(supports.contact, rcp(new Map(to_be_counted, gids(), 0, mesh.getComm()))));
  return near;
}

} // namespace rpc::solver
