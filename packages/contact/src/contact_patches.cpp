// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/contact_patches.hpp"

#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace rpc::contact
{
namespace
{

/// Of all ranks' points of a side, in the order of their nodes.
struct PointsOfSide {
  std::vector<GO> node;
  std::vector<double> weight, pressure, distance;
};

/// On rank 0; collective.
PointsOfSide points_of_side(const mesh::Mesh &mesh, const ContactNodes &c, const ContactResult &result, const int side)
{
  const auto node = to_host(c.node);
  const auto weight = to_host(c.weight), dent = to_host(result.dent), below = to_host(result.penetration),
             pressure = to_host(result.pressure);
  std::vector<GO> nodes;
  std::vector<double> numbers; // (points, 3)
  for (LO i = c.first(side); i < c.first(side + 1); ++i) {
    nodes.push_back(mesh.node_gid(node(i)));
    numbers.insert(numbers.end(), {weight(i), pressure(i), pressure(i) > 0 ? 0 : std::max(dent(i) - below(i), 0.)});
  }
  nodes = gathered_by_root(mesh.comm(), nodes);
  numbers = gathered_by_root(mesh.comm(), numbers);
  std::vector<std::size_t> order(nodes.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) { return nodes[a] < nodes[b]; });
  PointsOfSide all;
  for (const std::size_t k : order) {
    all.node.push_back(nodes[k]);
    all.weight.push_back(numbers[3 * k]);
    all.pressure.push_back(numbers[3 * k + 1]);
    all.distance.push_back(numbers[3 * k + 2]);
  }
  return all;
}

/// (facets of all ranks, facet nodes) Nodes, on rank 0; collective.
std::vector<GO> facets_of_all(const mesh::Mesh &mesh, const mesh::Side &side)
{
  const auto facets = to_host(side.facets);
  const auto cell = to_host(side.cell);
  std::vector<GO> nodes;
  for (std::size_t f = 0; f < facets.extent(0); ++f) {
    if (cell(f) >= mesh.num_owned_cells) continue;
    for (std::size_t a = 0; a < facets.extent(1); ++a) nodes.push_back(mesh.node_gid(facets(f, a)));
  }
  return gathered_by_root(mesh.comm(), nodes);
}

/// Sets of numbers that grow together.
class Joined
{
public:
  explicit Joined(const std::size_t size) : above_(size) { std::iota(above_.begin(), above_.end(), std::size_t(0)); }
  std::size_t top(std::size_t at)
  {
    while (above_[at] != at) at = above_[at] = above_[above_[at]];
    return at;
  }
  void join(const std::size_t a, const std::size_t b) { above_[top(a)] = top(b); }

private:
  std::vector<std::size_t> above_;
};

/// @param facets  (facets, size)
std::vector<double> sizes_of_patches(const PointsOfSide &points, const std::vector<GO> &facets, const std::size_t size)
{
  Joined patch(points.node.size());
  for (std::size_t first = 0; first < facets.size(); first += size) {
    std::size_t before = points.node.size();
    for (std::size_t a = first; a < first + size; ++a) {
      const auto found = std::lower_bound(points.node.begin(), points.node.end(), facets[a]);
      const auto at = static_cast<std::size_t>(found - points.node.begin());
      if (found == points.node.end() || *found != facets[a] || !(points.pressure[at] > 0)) continue;
      if (before < points.node.size()) patch.join(before, at);
      before = at;
    }
  }
  std::vector<double> of_top(points.node.size()), sizes;
  for (std::size_t i = 0; i < points.node.size(); ++i)
    if (points.pressure[i] > 0) of_top[patch.top(i)] += points.weight[i];
  std::copy_if(of_top.begin(), of_top.end(), std::back_inserter(sizes), [](const double area) { return area > 0; });
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return sizes;
}

ContactPatches patches_of(const PointsOfSide &points, const std::vector<GO> &facets, const std::size_t size)
{
  ContactPatches patches;
  patches.size = sizes_of_patches(points, facets, size);
  double whole = 0;
  for (std::size_t i = 0; i < points.node.size(); ++i) {
    whole += points.weight[i];
    patches.mean_gap += points.weight[i] * points.distance[i];
    patches.max_pressure = std::max(patches.max_pressure, points.pressure[i]);
  }
  patches.whole = whole;
  if (whole > 0) patches.mean_gap /= whole;
  for (std::size_t i = 0; i < points.node.size(); ++i) {
    if (!(points.pressure[i] > 0)) continue;
    const double place = ContactPatches::bins * points.pressure[i] / patches.max_pressure;
    patches.size_by_pressure[std::min(static_cast<int>(place), ContactPatches::bins - 1)] += points.weight[i];
  }
  return patches;
}

} // namespace

PatchCount counted(const std::vector<ContactPatches> &sides)
{
  PatchCount all;
  double whole = 0;
  for (const ContactPatches &side : sides) {
    all.count += static_cast<double>(side.size.size());
    if (!side.size.empty()) all.largest = std::max(all.largest, side.size.front());
    all.mean_gap += side.whole * side.mean_gap;
    whole += side.whole;
  }
  if (whole > 0) all.mean_gap /= whole;
  return all;
}

std::vector<ContactPatches> contact_patches(const mesh::Mesh &mesh, const std::vector<const mesh::Side *> &sides,
                                            const ContactNodes &points, const ContactResult &result)
{
  std::vector<ContactPatches> all;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const PointsOfSide of_side = points_of_side(mesh, points, result, static_cast<int>(k));
    const std::vector<GO> facets = facets_of_all(mesh, *sides[k]);
    if (mesh.comm().getRank() == 0) all.push_back(patches_of(of_side, facets, sides[k]->facets.extent(1)));
  }
  return all;
}

} // namespace rpc::contact
