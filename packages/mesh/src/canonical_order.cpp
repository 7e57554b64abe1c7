// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/canonical_order.hpp"

#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/ghost_values.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

namespace rpc::mesh
{

namespace
{

constexpr GO piece_size = GO(1) << 18; // ids: 2 MB a column

} // namespace

CanonicalOrder::CanonicalOrder(const RCP<const Comm> &comm, const Ids &ids, const std::string &what)
    : comm_(comm), size_(sum_all(*comm, static_cast<GO>(ids.size())))
{
  const HostView<GO *> id = ids.list(); // a list: to compute a single id of a box takes divisions
  const LO num_owned = static_cast<LO>(ids.size());
  std::optional<GO> beyond;
  std::vector<LO> sizes(num_pieces(), 0);
  for (LO n = 0; n < num_owned; ++n) {
    if (id(n) >= 0 && id(n) < size_)
      ++sizes[id(n) / piece_size];
    else
      beyond = id(n);
  }
  const auto bad = [&](const GO which, const char *const how) {
    return "mesh: the " + what + " ids must be each of 0 .. " + std::to_string(size_ - 1) + " once, got " +
           std::to_string(which) + how;
  };
  throw_if_any(*comm, ExitCode::internal_error, beyond ? std::optional<std::string>(bad(*beyond, "")) : std::nullopt);
  piece_.assign(1, 0);
  for (const LO size : sizes) piece_.push_back(piece_.back() + size);
  std::vector<LO> next(piece_.begin(), piece_.end() - 1);
  owned_.resize(num_owned);
  places_.resize(num_owned);
  for (LO n = 0; n < num_owned; ++n) {
    const LO at = next[id(n) / piece_size]++;
    owned_[at] = n;
    places_[at] = static_cast<int>(id(n) % piece_size);
  }
  piece_sizes_ = gathered_by_root(*comm, sizes);

  // There are as many ids as places, and none twice: so each is there.
  for (GO piece = 0; piece < num_pieces(); ++piece) {
    const auto mine = places_in(piece);
    const auto places = gathered_by_root(*comm, std::vector<int>(mine.begin(), mine.end()));
    on_root(*comm, ExitCode::internal_error, [&] {
      std::vector<bool> seen(piece_size, false);
      for (const int place : places) {
        RPC_REQUIRE_CODE(!seen[place], ExitCode::internal_error, bad(piece * piece_size + place, " twice"));
        seen[place] = true;
      }
    });
  }
}

GO CanonicalOrder::num_pieces() const
{
  return (size_ + piece_size - 1) / piece_size;
}

template <class T>
void CanonicalOrder::in_pieces(const T *const values, const int width,
                               const std::function<void(GO, const std::vector<T> &)> &take) const
{
  std::vector<T> ordered, others;
  std::vector<int> places_of_others;
  for (GO piece = 0; piece < num_pieces(); ++piece) {
    const auto places = places_in(piece);
    const auto count = static_cast<std::size_t>(places.size());
    const auto row = [&, first = piece_[piece]](const std::size_t k) {
      return values + std::size_t(width) * owned_[first + static_cast<LO>(k)];
    };
    if (comm_->getRank() == 0) {
      ordered.resize(width * std::min(piece_size, size_ - piece * piece_size));
      const auto put = [&](const T *const from, const int place) {
        for (int c = 0; c < width; ++c) ordered[std::size_t(width) * place + c] = from[c];
      };
      for (std::size_t k = 0; k < count; ++k) put(row(k), places[k]);
      for (int rank = 1; rank < comm_->getSize(); ++rank) {
        const LO num_theirs = piece_sizes_[rank * num_pieces() + piece];
        if (num_theirs == 0) continue;
        places_of_others.resize(num_theirs);
        others.resize(std::size_t(width) * num_theirs);
        Teuchos::receive(*comm_, rank, num_theirs, places_of_others.data());
        Teuchos::receive(*comm_, rank, width * num_theirs, others.data());
        for (LO k = 0; k < num_theirs; ++k) put(others.data() + std::size_t(width) * k, places_of_others[k]);
      }
    } else if (count > 0) {
      others.resize(width * count); // here this rank's own
      for (std::size_t k = 0; k < count; ++k) std::copy_n(row(k), width, others.data() + width * k);
      Teuchos::send(*comm_, static_cast<int>(count), places.getRawPtr(), 0);
      Teuchos::send(*comm_, static_cast<int>(others.size()), others.data(), 0);
    }
    on_root(*comm_, ExitCode::internal_error, [&] { take(piece * piece_size, ordered); });
  }
}

void CanonicalOrder::from_pieces(const std::function<std::vector<double>(GO, GO)> &give, double *const values) const
{
  for (GO piece = 0; piece < num_pieces(); ++piece) {
    std::vector<double> ordered;
    on_root(*comm_, ExitCode::internal_error, [&] {
      const GO count = std::min(piece_size, size_ - piece * piece_size);
      ordered = give(piece * piece_size, count);
      RPC_REQUIRE_CODE(static_cast<GO>(ordered.size()) == count, ExitCode::internal_error,
                       "mesh: a piece of " << count << " values has " << ordered.size());
    });
    const auto mine = places_in(piece);
    const LO *const owned = owned_.data() + piece_[piece];
    if (comm_->getRank() == 0) {
      for (LO k = 0; k < mine.size(); ++k) values[owned[k]] = ordered[mine[k]];
      std::vector<int> places;
      std::vector<double> theirs;
      for (int rank = 1; rank < comm_->getSize(); ++rank) {
        const LO count = piece_sizes_[rank * num_pieces() + piece];
        if (count == 0) continue;
        places.resize(count);
        theirs.resize(count);
        Teuchos::receive(*comm_, rank, count, places.data());
        for (LO k = 0; k < count; ++k) theirs[k] = ordered[places[k]];
        Teuchos::send(*comm_, count, theirs.data(), rank);
      }
    } else if (mine.size() > 0) {
      std::vector<double> received(mine.size());
      Teuchos::send(*comm_, static_cast<int>(mine.size()), mine.getRawPtr(), 0);
      Teuchos::receive(*comm_, 0, static_cast<int>(received.size()), received.data());
      for (LO k = 0; k < mine.size(); ++k) values[owned[k]] = received[k];
    }
  }
}

template <class T>
std::vector<T> CanonicalOrder::gather(const T *const values, const int width) const
{
  std::vector<T> all;
  in_pieces<T>(values, width,
               [&](GO, const std::vector<T> &piece) { all.insert(all.end(), piece.begin(), piece.end()); });
  return all;
}

template void CanonicalOrder::in_pieces(const double *, int,
                                        const std::function<void(GO, const std::vector<double> &)> &) const;
template void CanonicalOrder::in_pieces(const int *, int,
                                        const std::function<void(GO, const std::vector<int> &)> &) const;
template void CanonicalOrder::in_pieces(const GO *, int,
                                        const std::function<void(GO, const std::vector<GO> &)> &) const;
template std::vector<double> CanonicalOrder::gather(const double *, int) const;
template std::vector<int> CanonicalOrder::gather(const int *, int) const;
template std::vector<GO> CanonicalOrder::gather(const GO *, int) const;

HostView<GO *> overlap_node_ids(const Mesh &mesh)
{
  const HostView<GO *> own = mesh.node_id.list();
  if (mesh.comm().getSize() == 1) return own;
  const LO num_owned = mesh.num_owned_nodes();
  HostView<GO *> ids("rpc::mesh::overlap_node_ids", mesh.num_local_nodes());
  std::copy_n(own.data(), num_owned, ids.data());
  std::vector<LO> all(mesh.ghosts.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<double> exact(own.data(), own.data() + num_owned); // doubles hold ids exactly
  const auto of_ghosts = GhostValues(mesh, all).of(exact.data());
  for (std::size_t k = 0; k < all.size(); ++k) ids(num_owned + static_cast<LO>(k)) = static_cast<GO>(of_ghosts[k]);
  return ids;
}

HostView<GO **> owned_facets(const Mesh &mesh, const Side &side, const HostView<GO *> &overlap_ids)
{
  const auto nodes = to_host(side.facets);
  const auto cell = to_host(side.cell);
  const auto place = to_host(side.places());
  std::vector<LO> owned;
  for (LO f = 0; f < static_cast<LO>(cell.extent(0)); ++f) {
    bool ends_in_image = false;
    for (std::size_t a = 0; a < place.extent(1); ++a) ends_in_image = ends_in_image || place(f, a) != nodes(f, a);
    if (cell(f) < mesh.num_owned_cells && !ends_in_image) owned.push_back(f);
  }
  HostView<GO **> facets("rpc::mesh::owned_facets", owned.size(), mesh.element.num_facet_nodes());
  for (std::size_t f = 0; f < owned.size(); ++f)
    for (std::size_t a = 0; a < facets.extent(1); ++a) facets(f, a) = overlap_ids(nodes(owned[f], a));
  return facets;
}

} // namespace rpc::mesh
