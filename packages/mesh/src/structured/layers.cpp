// SPDX-License-Identifier: BSD-3-Clause
#include "layers.hpp"

#include "rpc/mesh/rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// What lies beyond one side of a sheet.
struct Beyond {
  static constexpr int unseen = -1, body_ends = -2, several = -3;
  int sheet = unseen;
  bool upper = false; ///< of that sheet
};

/// (facets) A number for each combination of sides that a facet belongs to.
std::vector<int> sides_of_facets(const MeshData &mesh, const Entities &facets)
{
  std::vector<int> sides(facets.size(), 0);
  std::map<std::pair<int, std::size_t>, int> combinations;
  for (std::size_t s = 0; s < mesh.sides.size(); ++s)
    for (std::size_t f = 0; f < mesh.sides[s].cell.size(); ++f) {
      int &of_facet =
          sides[facets.of_cell[std::size_t(facets.per_cell) * mesh.sides[s].cell[f] + mesh.sides[s].ordinal[f]]];
      const int next = static_cast<int>(combinations.size()) + 1;
      of_facet = combinations.emplace(std::make_pair(of_facet, s), next).first->second;
    }
  return sides;
}

/// Which sheets follow each other.
class Neighbours
{
public:
  Neighbours(const MeshData &mesh, const Entities &facets, const Sheets &sheets)
      : mesh_(mesh), facets_(facets), sheets_(sheets), places_(facet_places(mesh.element)),
        sides_(sides_of_facets(mesh, facets)), beyond_(2 * std::size_t(sheets.count))
  {
    for (int f = 0; f < facets.size(); ++f) see(f);
    keep_points();
  }
  /// The sheet that follows on one side, with the side of it that is there; none: -1.
  std::pair<int, bool> next(const int sheet, const bool upper) const
  {
    const Beyond &here = at(sheet, upper);
    if (here.sheet < 0 || here.sheet == sheet) return {-1, false};
    const Beyond &back = at(here.sheet, here.upper);
    if (back.sheet != sheet || back.upper != upper) return {-1, false};
    return {here.sheet, here.upper};
  }
  /// Whether the body ends on both sides everywhere.
  bool is_all_of_body(const int sheet) const
  {
    return at(sheet, false).sheet == Beyond::body_ends && at(sheet, true).sheet == Beyond::body_ends;
  }

private:
  const Beyond &at(const int sheet, const bool upper) const
  {
    return beyond_[2 * std::size_t(sheet) + (upper ? 1 : 0)];
  }
  Beyond &at(const int sheet, const bool upper) { return beyond_[2 * std::size_t(sheet) + (upper ? 1 : 0)]; }

  /// A cell's sheet that ends at one of its facets, and the side of it.
  std::pair<int, bool> side_at(const int cell, const int ordinal) const
  {
    const auto [direction, upper] = places_[ordinal];
    return {sheets_.at(cell, direction), upper == (sheets_.sign_at(cell, direction) > 0)};
  }
  void note(const std::pair<int, bool> &side, const int sheet, const bool upper)
  {
    Beyond &here = at(side.first, side.second);
    if (here.sheet == Beyond::unseen)
      here = {sheet, upper};
    else if (here.sheet != sheet || here.upper != upper)
      here.sheet = Beyond::several;
  }
  void see(const int facet)
  {
    const int cell = facets_.cell(facet, 0), ordinal = facets_.ordinal(facet, 0);
    const auto here = side_at(cell, ordinal);
    if (facets_.num_cells_at(facet) == 1) return note(here, Beyond::body_ends, false);
    const int other = facets_.cell(facet, 1), of_other = facets_.ordinal(facet, 1);
    const auto there = side_at(other, of_other);
    const bool alike = mesh_.block[cell] == mesh_.block[other] && sides_go_on(cell, ordinal, other, of_other);
    note(here, alike ? there.first : Beyond::several, there.second);
    note(there, alike ? here.first : Beyond::several, here.second);
  }
  /// The sides of a facet; -1: it lies inside the body.
  int side_of(const int cell, const int ordinal) const
  {
    const int facet = facets_.of_cell[std::size_t(facets_.per_cell) * cell + ordinal];
    return facets_.num_cells_at(facet) == 1 ? sides_[facet] : -1;
  }
  bool is_at_boundary(const int cell) const
  {
    for (int o = 0; o < facets_.per_cell; ++o)
      if (side_of(cell, o) >= 0) return true;
    return false;
  }
  /// Whether facets of two neighbours that continue each other belong to the same sides, or both lie inside.
  bool sides_go_on(const int cell, const int ordinal, const int other, const int of_other) const
  {
    if (!is_at_boundary(cell) && !is_at_boundary(other)) return true;
    for (int o = 0; o < facets_.per_cell; ++o) {
      if (places_[o].direction == places_[ordinal].direction) continue;
      const int beside = continuation(cell, ordinal, o, other, of_other);
      if (beside < 0 || side_of(other, beside) != side_of(cell, o)) return false;
    }
    return true;
  }
  /// The facet of the other cell that continues facet o of the first one across the facet that they share.
  int continuation(const int cell, const int ordinal, const int o, const int other, const int of_other) const
  {
    const auto common = [this](const int of_cell, const int a, const int b) {
      std::array<int, 2> vertices{-1, -1};
      int count = 0;
      const int width = mesh_.element.num_nodes();
      const int *const nodes = &mesh_.cells[std::size_t(width) * of_cell];
      for (int v = 0; v < mesh_.element.num_vertices(); ++v) {
        const auto &place = mesh_.element.lattice()[v];
        const auto lies_on = [&](const int facet) {
          return (place[places_[facet].direction] > 0) == places_[facet].upper;
        };
        if (lies_on(a) && lies_on(b) && count < 2) vertices[count++] = nodes[v];
      }
      std::sort(vertices.begin(), vertices.end());
      return vertices;
    };
    const auto edge = common(cell, ordinal, o);
    for (int b = 0; b < facets_.per_cell; ++b)
      if (places_[b].direction != places_[of_other].direction && common(other, of_other, b) == edge) return b;
    return -1;
  }
  /// Nodes with a name stay: at vertices between sheets, and in the middle of cells of order 2.
  void keep_points()
  {
    std::vector<char> named(mesh_.num_nodes(), 0);
    bool any = false;
    for (const PointData &set : mesh_.points)
      for (const int node : set.node) {
        named[node] = 1;
        any = true;
      }
    const int width = mesh_.element.num_nodes(), order = mesh_.element.order;
    for (int c = 0; c < mesh_.num_cells() && any; ++c)
      for (int a = 0; a < width; ++a) {
        if (!named[mesh_.cells[std::size_t(width) * c + a]]) continue;
        for (int d = 0; d < mesh_.element.dim; ++d) {
          const int place = mesh_.element.lattice()[a][d];
          const bool along = sheets_.sign_at(c, d) > 0;
          if (place < order) keep(sheets_.at(c, d), !along); // the lower end of the cell, or its middle
          if (place > 0) keep(sheets_.at(c, d), along);
        }
      }
  }
  void keep(const int sheet, const bool upper)
  {
    Beyond &here = at(sheet, upper);
    if (here.sheet >= 0) here.sheet = Beyond::several;
  }

  const MeshData &mesh_;
  const Entities &facets_;
  const Sheets &sheets_;
  std::vector<FacetPlace> places_;
  std::vector<int> sides_;
  std::vector<Beyond> beyond_; // (sheets, sides)
};

/// A list of sheets that follow each other, each with the side on which the next one lies.
struct Stack {
  std::vector<std::pair<int, bool>> sheets;
  bool closed = false; ///< the first follows the last

  int size() const { return static_cast<int>(sheets.size()); }
};

std::vector<Stack> stacks_of(const Neighbours &neighbours, const int num_sheets)
{
  std::vector<char> taken(num_sheets, 0);
  std::vector<Stack> stacks;
  const auto follow = [&](int sheet, bool upper) {
    Stack stack;
    for (;;) {
      taken[sheet] = 1;
      stack.sheets.emplace_back(sheet, upper);
      const auto [next, its_side] = neighbours.next(sheet, upper);
      if (next < 0) break;
      if (taken[next]) {
        stack.closed = next == stack.sheets.front().first;
        break;
      }
      sheet = next;
      upper = !its_side;
    }
    stacks.push_back(std::move(stack));
  };
  for (int s = 0; s < num_sheets; ++s)
    for (const bool upper : {true, false})
      if (!taken[s] && neighbours.next(s, !upper).first < 0) follow(s, upper);
  for (int s = 0; s < num_sheets; ++s)
    if (!taken[s]) follow(s, true);
  return stacks;
}

/// (stacks) Whether sheets are to be joined.
std::vector<char> joined_stacks(const Sheets &sheets, const Neighbours &neighbours, const std::vector<Stack> &stacks,
                                const std::vector<int> &stack_of)
{
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> thickness(stacks.size(), 0), least(stacks.size(), infinite);
  std::vector<char> joined(stacks.size(), 0);
  for (std::size_t s = 0; s < stacks.size(); ++s) {
    for (const auto &sheet : stacks[s].sheets) thickness[s] += sheets.thickness[sheet.first] / stacks[s].size();
    const int fewest_cells = stacks[s].closed ? 3 : 1; // around a hole
    joined[s] = stacks[s].size() >= 2 * fewest_cells ? 1 : 0;
    if (joined[s]) least[s] = thickness[s];
  }
  const std::vector<char> can_be = joined;
  const std::size_t num_cells = sheets.of_cell.size() / sheets.dim;
  for (std::size_t c = 0; c < num_cells; ++c)
    for (int a = 0; a < sheets.dim; ++a)
      for (int b = 0; b < sheets.dim; ++b) {
        const int sheet = sheets.of_cell[sheets.dim * c + b], crossed = stack_of[sheet];
        const int own = stack_of[sheets.of_cell[sheets.dim * c + a]];
        if (own == crossed) joined[own] = a == b ? joined[own] : 0; // a stack that crosses itself has no two directions
        if (can_be[crossed]) least[own] = std::min(least[own], thickness[crossed]);
        const bool bends = a != b && neighbours.is_all_of_body(sheet) &&
                           thickness[crossed] < coarsening_rules.equally_long * thickness[own];
        if (bends) joined[own] = 0;
      }
  for (std::size_t s = 0; s < stacks.size(); ++s)
    if (!(thickness[s] <= coarsening_rules.equally_long * least[s])) joined[s] = 0;
  return joined;
}

/// Joins the sheets of a stack.
void join(const Stack &stack, const Sheets &sheets, int &num_groups, Layers &layers)
{
  const int size = stack.size();
  for (int first = 0; first < size;) {
    const int left = size - first, count = left == 3 ? 3 : std::min(2, left);
    double whole = 0, below = 0;
    for (int k = 0; k < count; ++k) whole += sheets.thickness[stack.sheets[first + k].first];
    const auto rounded = [&](const double part, const int sheets_below) {
      constexpr double parts =
          60; // few different ones, so that kinds of children take little memory where no two layers are alike
      return std::clamp(std::round(part / whole * parts), double(sheets_below), parts - (count - sheets_below)) / parts;
    };
    for (int k = 0; k < count; ++k) {
      const int sheet = stack.sheets[first + k].first;
      layers.group[sheet] = num_groups;
      layers.begin[sheet] = rounded(below, k);
      below += sheets.thickness[sheet];
      layers.end[sheet] = rounded(below, k + 1);
    }
    layers.coarser = layers.coarser || count > 1;
    ++num_groups;
    first += count;
  }
}

} // namespace

Layers layers_of(const MeshData &mesh, const Entities &facets, const Sheets &sheets)
{
  const Neighbours neighbours(mesh, facets, sheets);
  const std::vector<Stack> stacks = stacks_of(neighbours, sheets.count);
  Layers layers;
  for (auto *const list : {&layers.stack, &layers.number, &layers.group}) list->resize(sheets.count);
  layers.sign.resize(sheets.count);
  layers.begin.assign(sheets.count, 0);
  layers.end.assign(sheets.count, 1);
  for (std::size_t s = 0; s < stacks.size(); ++s) {
    layers.length.push_back(stacks[s].size());
    for (int k = 0; k < stacks[s].size(); ++k) {
      const auto [sheet, upper] = stacks[s].sheets[k];
      layers.stack[sheet] = static_cast<int>(s);
      layers.number[sheet] = k;
      layers.sign[sheet] = upper ? 1 : -1;
    }
  }
  const std::vector<char> joined = joined_stacks(sheets, neighbours, stacks, layers.stack);
  int num_groups = 0;
  for (std::size_t s = 0; s < stacks.size(); ++s) {
    if (joined[s]) {
      join(stacks[s], sheets, num_groups, layers);
    } else {
      for (const auto &sheet : stacks[s].sheets) layers.group[sheet.first] = num_groups++;
    }
  }
  return layers;
}

} // namespace rpc::mesh
