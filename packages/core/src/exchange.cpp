#include "rpc/core/exchange.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rpc
{

Exchange::Exchange(const Comm &comm, std::vector<int> counts)
    : comm_(comm), to_(std::move(counts)), from_(comm.getSize())
{
  const int ranks = comm.getSize();
  std::vector<int> all(static_cast<std::size_t>(ranks) * ranks);
  Teuchos::gatherAll(comm, ranks, to_.data(), static_cast<int>(all.size()), all.data());
  for (int rank = 0; rank < ranks; ++rank) from_[rank] = all[static_cast<std::size_t>(rank) * ranks + comm.getRank()];
}

int Exchange::num_sent() const
{
  return std::accumulate(to_.begin(), to_.end(), 0);
}

int Exchange::num_received() const
{
  return std::accumulate(from_.begin(), from_.end(), 0);
}

std::vector<double> Exchange::forward(const std::vector<double> &rows, const int width) const
{
  return exchange(to_, from_, rows, width);
}

std::vector<double> Exchange::back(const std::vector<double> &rows, const int width) const
{
  return exchange(from_, to_, rows, width);
}

std::vector<double> Exchange::exchange(const std::vector<int> &to, const std::vector<int> &from,
                                       const std::vector<double> &rows, const int width) const
{
  constexpr int tag = 1;
  const auto total = [width](const std::vector<int> &counts) {
    return std::accumulate(counts.begin(), counts.end(), std::size_t(0)) * width;
  };
  std::vector<double> received(total(from));
  std::vector<RCP<Teuchos::CommRequest<int>>> requests;
  std::size_t at = 0, own = 0;
  for (int rank = 0; rank < comm_.getSize(); at += std::size_t(from[rank]) * width, ++rank) {
    if (rank == comm_.getRank()) own = at;
    if (rank == comm_.getRank() || from[rank] == 0) continue;
    const Teuchos::ArrayRCP<double> buffer(received.data() + at, 0, from[rank] * width, false);
    requests.push_back(Teuchos::ireceive(buffer, rank, tag, comm_));
  }
  at = 0;
  for (int rank = 0; rank < comm_.getSize(); at += std::size_t(to[rank]) * width, ++rank) {
    if (rank == comm_.getRank()) {
      std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(at), std::size_t(to[rank]) * width,
                  received.begin() + static_cast<std::ptrdiff_t>(own));
    } else if (to[rank] > 0) {
      const Teuchos::ArrayRCP<const double> buffer(rows.data() + at, 0, to[rank] * width, false);
      requests.push_back(Teuchos::isend(buffer, rank, tag, comm_));
    }
  }
  Teuchos::waitAll(comm_, Teuchos::ArrayView<RCP<Teuchos::CommRequest<int>>>(requests));
  return received;
}

} // namespace rpc
