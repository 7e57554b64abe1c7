// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/joined_sides.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <unordered_map>

namespace rpc::contact
{
namespace
{

/// Infinite where the direction misses the obstacle.
double gap_at_place(const ContactOptions &options, const Point &x, const Point &direction)
{
  if (!options.obstacle.exists()) return options.gap(x);
  return distance_along(options.obstacle, x, direction).value_or(std::numeric_limits<double>::infinity());
}

/// The largest difference at a side on this rank.
UnevenGap uneven_gap_of_side(const mesh::Mesh &mesh, const mesh::Side &side, const ContactOptions &options,
                             const ContactNodes &points, const ContactResult &result, const int k, const double least)
{
  const auto node = to_host(side.facets), place = to_host(side.places());
  const auto point_node = to_host(points.node);
  const auto normal = to_host(points.normal);
  const auto pressure = to_host(result.pressure), u_nu = to_host(result.normal_displacement);
  std::unordered_map<LO, LO> point_at;
  for (LO i = points.first(k); i < points.first(k + 1); ++i) point_at[point_node(i)] = i;
  std::vector<LO> point, from,
      to; // contact points of joined sides, their rows of coordinates and those of their images
  for (std::size_t f = 0; f < node.extent(0); ++f)
    for (std::size_t a = 0; a < node.extent(1); ++a) {
      if (place(f, a) == node(f, a)) continue;
      const auto found = point_at.find(node(f, a));
      if (found == point_at.end()) continue;
      point.push_back(found->second);
      from.push_back(node(f, a));
      to.push_back(place(f, a));
    }
  const auto places = fem::node_positions(mesh, device_values(from, "rpc::contact::joined_points"));
  const auto images = fem::node_positions(mesh, device_values(to, "rpc::contact::images"));
  UnevenGap worst;
  for (std::size_t j = 0; j < point.size(); ++j) {
    const LO i = point[j];
    Point x{}, image{}, direction{};
    for (int c = 0; c < mesh.dim(); ++c) {
      x[c] = places(j, c);
      image[c] = images(j, c);
      direction[c] = normal(i, c);
    }
    const double here = gap_at_place(options, x, direction), there = gap_at_place(options, image, direction);
    const double difference = std::abs(here - there);
    const bool matters = pressure(i) > 0 || u_nu(i) - there > least;
    if (matters && difference > least && difference > worst.difference) worst = {difference, x, k};
  }
  return worst;
}

} // namespace

UnevenGap uneven_gap(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                     const std::vector<ContactOptions> &options, const ContactNodes &points,
                     const ContactResult &result)
{
  const mesh::Mesh &mesh = *d.mesh;
  if (!mesh.box || !mesh::periodic(*mesh.box)) return {};
  const double least = Rounding::depth * d.diameter;
  UnevenGap worst;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const UnevenGap of_side =
        uneven_gap_of_side(mesh, *sides[k], options[k], points, result, static_cast<int>(k), least);
    if (of_side.difference > worst.difference) worst = of_side;
  }
  const double largest = max_all(mesh.comm(), worst.difference);
  if (!(largest > 0)) return {};
  const int rank = min_all(mesh.comm(), worst.difference == largest ? mesh.comm().getRank() : mesh.comm().getSize());
  double numbers[4] = {worst.place[0], worst.place[1], worst.place[2], double(worst.side)};
  Teuchos::broadcast(mesh.comm(), rank, 4, numbers);
  return {largest, {numbers[0], numbers[1], numbers[2]}, static_cast<int>(numbers[3])};
}

std::string uneven_gap_note(const UnevenGap &uneven, const std::vector<ContactOptions> &options, const int dim,
                            const UnitNames &units)
{
  if (!(uneven.difference > 0)) return "";
  std::ostringstream text;
  text << "the foundation of side \"" << options[uneven.side].side << "\" has not the period of the box: at ("
       << uneven.place[0] << ", " << uneven.place[1];
  if (dim == 3) text << ", " << uneven.place[2];
  text << ") ";
  if (std::isfinite(uneven.difference))
    text << "its gap is another by " << uneven.difference << " [" << units.of(unit::length, false)
         << "] than a period further";
  else
    text << "the normal meets it, and a period further it does not";
  text << ". \"Mesh->Periodic\" repeats the body alone, and contact points of joined sides see the foundation at the "
          "lower side: take a foundation that repeats itself, or one that touches away from the joined sides";
  return text.str();
}

} // namespace rpc::contact
