// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/stored_dents.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/exchange.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"

#include <cmath>
#include <utility>

namespace rpc::contact
{
namespace
{

// A part: how many numbers follow; foundations; of each deepest, volume and sheets; of each sheet dim, order and shape of its facets, spread,
// nodes, places of nodes in facets, and then the lists.

void add_points(const std::vector<Point> &points, std::vector<double> &numbers)
{
  for (const Point &x : points) numbers.insert(numbers.end(), x.begin(), x.end());
}

std::vector<double> part_of(const std::vector<FoundationDents> &foundations)
{
  std::vector<double> numbers = {0, static_cast<double>(foundations.size())};
  for (const FoundationDents &dents : foundations) {
    numbers.insert(numbers.end(), {dents.deepest, dents.volume, static_cast<double>(dents.sheets.size())});
    for (const auto &sheet : dents.sheets) {
      for (const int number : {sheet->facet.dim, sheet->facet.order, static_cast<int>(sheet->facet.shape)})
        numbers.push_back(number);
      numbers.push_back(sheet->spread);
      for (const std::size_t size : {sheet->dent.size(), sheet->facet_node.size()})
        numbers.push_back(static_cast<double>(size));
      add_points(sheet->place, numbers);
      add_points(sheet->direction, numbers);
      numbers.insert(numbers.end(), sheet->dent.begin(), sheet->dent.end());
      numbers.insert(numbers.end(), sheet->facet_node.begin(), sheet->facet_node.end());
    }
  }
  numbers[0] = static_cast<double>(numbers.size() - 1);
  return numbers;
}

/// Numbers one after another.
class Reader
{
public:
  Reader(const std::vector<double> &numbers, const std::size_t at, const std::size_t end)
      : numbers_(numbers), at_(at), end_(end)
  {
    if (end > numbers.size()) refuse();
  }

  [[noreturn]] static void refuse()
  {
    throw Error(ExitCode::bad_input, "restart: the checkpoint is damaged: its dents are not what was written. Take an "
                                     "older one, or start from the first step.");
  }

  bool at_end() const { return at_ == end_; }
  double number()
  {
    if (at_ >= end_) refuse();
    return numbers_[at_++];
  }
  /// A number of things of which each takes at least one number.
  std::size_t count()
  {
    const double value = number();
    if (!(value >= 0 && value <= static_cast<double>(end_ - at_) && value == std::floor(value))) refuse();
    return static_cast<std::size_t>(value);
  }
  /// One of 0, ..., below - 1.
  int choice(const int below)
  {
    const double value = number();
    if (!(value >= 0 && value < below && value == std::floor(value))) refuse();
    return static_cast<int>(value);
  }

private:
  const std::vector<double> &numbers_;
  std::size_t at_, end_;
};

std::vector<Point> points_from(Reader &reader, const std::size_t count)
{
  std::vector<Point> points(count);
  for (Point &x : points)
    for (double &component : x) component = reader.number();
  return points;
}

DentSheet sheet_from(Reader &reader)
{
  DentSheet sheet;
  sheet.facet.dim = reader.choice(3);
  sheet.facet.order = reader.choice(3);
  sheet.facet.shape = static_cast<mesh::Shape>(reader.choice(2));
  sheet.spread = reader.number();
  const std::size_t nodes = reader.count(), places = reader.count();
  sheet.place = points_from(reader, nodes);
  sheet.direction = points_from(reader, nodes);
  for (std::size_t n = 0; n < nodes; ++n) sheet.dent.push_back(reader.number());
  for (std::size_t k = 0; k < places; ++k) sheet.facet_node.push_back(reader.choice(static_cast<int>(nodes)));
  return sheet;
}

/// Adds the facets of another part of a sheet.
void add_part(DentSheet &sheet, const DentSheet &other)
{
  const LO nodes = static_cast<LO>(sheet.dent.size());
  sheet.place.insert(sheet.place.end(), other.place.begin(), other.place.end());
  sheet.direction.insert(sheet.direction.end(), other.direction.begin(), other.direction.end());
  sheet.dent.insert(sheet.dent.end(), other.dent.begin(), other.dent.end());
  for (const LO node : other.facet_node) sheet.facet_node.push_back(nodes + node);
}

/// The parts that a rank gets, as one.
std::vector<FoundationDents> joined_parts(const std::vector<double> &numbers)
{
  std::vector<FoundationDents> joined;
  std::vector<std::vector<DentSheet>> sheets; // by foundation
  Reader all(numbers, 0, numbers.size());
  for (std::size_t at = 0; at < numbers.size();) {
    const std::size_t length = Reader(numbers, at, numbers.size()).count();
    Reader reader(numbers, at + 1, at + 1 + length);
    const std::size_t foundations = reader.count();
    if (at > 0 && foundations != joined.size()) Reader::refuse(); // all parts have the same sheets
    joined.resize(foundations);
    sheets.resize(foundations);
    for (std::size_t k = 0; k < foundations; ++k) {
      joined[k].deepest = reader.number();
      joined[k].volume = reader.number();
      const std::size_t count = reader.count();
      if (at > 0 && count != sheets[k].size()) Reader::refuse();
      sheets[k].resize(count);
      for (DentSheet &sheet : sheets[k]) {
        DentSheet part = sheet_from(reader);
        if (sheet.facet_node.empty() && sheet.dent.empty())
          sheet = std::move(part);
        else
          add_part(sheet, part);
      }
    }
    if (!reader.at_end()) Reader::refuse();
    at += 1 + length;
  }
  for (std::size_t k = 0; k < joined.size(); ++k)
    for (DentSheet &sheet : sheets[k]) joined[k].sheets.push_back(std::make_shared<DentSheet>(std::move(sheet)));
  return joined;
}

/// The part of a rank that has no facets: all ranks have the same sheets.
std::vector<FoundationDents> without_facets(std::vector<FoundationDents> foundations)
{
  for (FoundationDents &dents : foundations)
    for (auto &sheet : dents.sheets) {
      DentSheet empty;
      empty.facet = sheet->facet;
      empty.spread = sheet->spread;
      sheet = std::make_shared<DentSheet>(std::move(empty));
    }
  return foundations;
}

/// Where parts begin, and the end.
std::vector<std::size_t> starts_of_parts(const std::vector<double> &numbers)
{
  std::vector<std::size_t> starts = {0};
  while (starts.back() < numbers.size())
    starts.push_back(starts.back() + 1 + Reader(numbers, starts.back(), numbers.size()).count());
  return starts;
}

/// What each rank gets; rank 0 only.
struct Dealt {
  std::vector<int> counts;
  std::vector<double> numbers; // for rank 0 first
};
Dealt deal(const std::vector<double> &numbers, const int ranks)
{
  const auto starts = starts_of_parts(numbers);
  const int parts = static_cast<int>(starts.size()) - 1;
  const std::vector<double> none = part_of(without_facets(joined_parts(numbers)));
  Dealt dealt;
  for (int rank = 0; rank < ranks; ++rank) {
    const std::size_t before = dealt.numbers.size();
    for (int part = rank; part < parts; part += ranks)
      dealt.numbers.insert(dealt.numbers.end(), numbers.begin() + static_cast<std::ptrdiff_t>(starts[part]),
                           numbers.begin() + static_cast<std::ptrdiff_t>(starts[part + 1]));
    if (rank >= parts) dealt.numbers.insert(dealt.numbers.end(), none.begin(), none.end());
    dealt.counts.push_back(static_cast<int>(dealt.numbers.size() - before));
  }
  return dealt;
}

} // namespace

std::vector<double> stored_dents(const Comm &comm, const std::vector<FoundationDents> &foundations)
{
  return gathered_by_root(comm, part_of(foundations));
}

std::vector<FoundationDents> dents_from(const Comm &comm, const std::vector<double> &numbers)
{
  Dealt dealt{std::vector<int>(comm.getSize()), {}};
  on_root(comm, ExitCode::bad_input, [&] { dealt = deal(numbers, comm.getSize()); });
  const std::vector<double> mine = Exchange(comm, dealt.counts).forward(dealt.numbers, 1);
  return joined_parts(mine);
}

} // namespace rpc::contact
