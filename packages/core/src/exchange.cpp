// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/exchange.hpp"

#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <array>

namespace rpc
{
namespace
{

constexpr int rows_tag = 1, count_tag = 2; // of messages
using Requests = std::vector<RCP<Teuchos::CommRequest<int>>>;

void wait_all(const Comm &comm, Requests &requests)
{
  Teuchos::waitAll(comm, Teuchos::ArrayView<RCP<Teuchos::CommRequest<int>>>(requests));
}

} // namespace

Exchange::Exchange(const Comm &comm, const std::vector<int> &counts) : comm_(comm)
{
  for (int rank = 0; rank < comm.getSize(); ++rank)
    if (counts[rank] > 0) to_.push_back({rank, counts[rank]});
  from_ = received_by(comm, to_);
}

/// Each rank learns from how many others it gets rows (one sum of as many numbers as there are ranks), and the counts from these.
Exchange::Shares Exchange::received_by(const Comm &comm, const Shares &sent)
{
  std::vector<int> senders(comm.getSize());
  for (const Share &share : sent) senders[share.rank] = 1;
  senders = summed(comm, senders);
  std::vector<std::array<int, 2>> to, from(senders[comm.getRank()]); // rank, count
  Requests requests;
  for (auto &message : from)
    requests.push_back(Teuchos::ireceive(Teuchos::ArrayRCP<int>(message.data(), 0, 2, false), -1, count_tag, comm));
  for (const Share &share : sent) to.push_back({comm.getRank(), share.count});
  for (std::size_t k = 0; k < to.size(); ++k)
    requests.push_back(
        Teuchos::isend(Teuchos::ArrayRCP<const int>(to[k].data(), 0, 2, false), sent[k].rank, count_tag, comm));
  wait_all(comm, requests);
  std::sort(from.begin(), from.end());
  Shares received;
  for (const auto &[rank, count] : from) received.push_back({rank, count});
  return received;
}

int Exchange::total(const Shares &shares)
{
  int total = 0;
  for (const Share &share : shares) total += share.count;
  return total;
}

int Exchange::num_sent() const
{
  return total(to_);
}

int Exchange::num_received() const
{
  return total(from_);
}

std::vector<std::pair<int, int>> Exchange::senders() const
{
  std::vector<std::pair<int, int>> senders;
  for (const Share &share : from_) senders.emplace_back(share.rank, share.count);
  return senders;
}

std::vector<double> Exchange::forward(const std::vector<double> &rows, const int width) const
{
  return exchange(to_, from_, rows, width);
}

std::vector<double> Exchange::back(const std::vector<double> &rows, const int width) const
{
  return exchange(from_, to_, rows, width);
}

std::vector<double> Exchange::exchange(const Shares &to, const Shares &from, const std::vector<double> &rows,
                                       const int width) const
{
  std::vector<double> received(std::size_t(total(from)) * width);
  Requests requests;
  std::size_t at = 0, own = 0;
  for (const auto &[rank, count] : from) {
    if (rank == comm_.getRank())
      own = at;
    else
      requests.push_back(Teuchos::ireceive(Teuchos::ArrayRCP<double>(received.data() + at, 0, count * width, false),
                                           rank, rows_tag, comm_));
    at += std::size_t(count) * width;
  }
  at = 0;
  for (const auto &[rank, count] : to) {
    const std::size_t size = std::size_t(count) * width;
    if (rank == comm_.getRank())
      std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(at), size,
                  received.begin() + static_cast<std::ptrdiff_t>(own));
    else
      requests.push_back(Teuchos::isend(
          Teuchos::ArrayRCP<const double>(rows.data() + at, 0, static_cast<int>(size), false), rank, rows_tag, comm_));
    at += size;
  }
  wait_all(comm_, requests);
  return received;
}

} // namespace rpc
