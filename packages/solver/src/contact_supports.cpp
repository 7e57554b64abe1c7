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

NearSupports near_supports(const ContactSupports &supports, const Map &mesh)
{
  const Comm &comm = *mesh.getComm();
  const std::vector<GO> nodes = distinct(supports.node);
  const std::vector<int> owner = owners(mesh, nodes);
  int longest = 0;
  std::vector<std::vector<int>> to_rank(comm.getSize()); // contact nodes
  for (int c = 0; c < supports.size(); ++c) {
    longest = std::max(longest, static_cast<int>(supports.begin[c + 1] - supports.begin[c]));
    for (std::size_t e = supports.begin[c]; e < supports.begin[c + 1]; ++e) {
      auto &list = to_rank[owner[place_in(nodes, supports.node[e])]];
      if (list.empty() || list.back() != c) list.push_back(c);
    }
  }
  const int width = 2 + 2 * max_all(comm, longest); // gid of the contact node, number of entries, entries
  std::vector<int> counts;
  std::vector<double> sent;
  for (const auto &list : to_rank) {
    counts.push_back(static_cast<int>(list.size()));
    for (const int c : list) {
      const std::size_t first = sent.size();
      sent.push_back(static_cast<double>(supports.contact->getGlobalElement(c)));
      sent.push_back(static_cast<double>(supports.begin[c + 1] - supports.begin[c]));
      for (std::size_t e = supports.begin[c]; e < supports.begin[c + 1]; ++e) {
        sent.push_back(static_cast<double>(supports.node[e]));
        sent.push_back(supports.weight[e]);
      }
      sent.resize(first + width);
    }
  }
  const Exchange exchange(comm, counts);
  const auto got = exchange.forward(sent, width);
  std::vector<std::pair<GO, std::size_t>> order; // (gid of the contact node, row)
  for (int k = 0; k < exchange.num_received(); ++k)
    order.emplace_back(static_cast<GO>(got[static_cast<std::size_t>(width) * k]), k);
  std::sort(order.begin(), order.end());
  NearSupports near;
  Teuchos::Array<GO> gids;
  for (const auto &[gid, k] : order) {
    gids.push_back(gid);
    const double *const row = &got[width * k];
    for (int e = 0; e < static_cast<int>(row[1]); ++e) {
      near.node.push_back(static_cast<GO>(row[2 + 2 * e]));
      near.weight.push_back(row[3 + 2 * e]);
    }
    near.begin.push_back(near.node.size());
  }
  near.importer = rcp(new Import(supports.contact, rcp(new Map(to_be_counted, gids(), 0, mesh.getComm()))));
  return near;
}

} // namespace rpc::solver
