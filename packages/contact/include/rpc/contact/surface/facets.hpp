// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/bounds.hpp"
#include "rpc/core/field.hpp"
#include "rpc/core/kokkos.hpp"
#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/element.hpp"

#include <optional>
#include <vector>

namespace rpc::contact
{

/// A surface of straight facets, in the plane segments and in space triangles, with values at their corners: linear in between.
struct StraightFacets {
  int dim = 2;
  std::vector<double>
      corners; ///< (facets, dim corners, dim) [m]; their order gives the normal, see mesh::Element::facets
  std::vector<double> values; ///< (facets, dim corners)

  std::size_t size() const { return values.size() / dim; }
};

/// Straight facets for those of an element: several for each of order 2, four triangles about the middle for quadrilaterals.
/// @param facet   see mesh::Element::facet()
/// @param places  (facets, nodes of a facet) [m]
/// @param values  (facets, nodes of a facet)
StraightFacets straight_facets(const mesh::Element &facet, const std::vector<Point> &places,
                               const std::vector<double> &values);

/// Looks up values of a surface along lines, in a tree of boxes about its facets.
class FacetSurface
{
public:
  /// @param beyond  a line that misses the surface by up to this much, or by half a facet, takes the value at its edge [m]
  explicit FacetSurface(StraightFacets facets, double beyond = 0);

  /// Where a line meets the surface.
  struct Meeting {
    double off = 0;      ///< by how much it misses the surface [m]
    double distance = 0; ///< from x [m]
    double value = 0;

    /// Whether it counts instead of another one.
    bool before(const Meeting &other) const
    {
      return off < other.off || (off == other.off && distance < other.distance);
    }
  };
  /// Where the line through x meets the surface: of several such places that which is nearest to x, among facets whose normal has
  /// a part along the direction. Nothing if it misses the surface. Linear functions are met to rounding.
  /// @param direction  unit
  std::optional<Meeting> along(const Point &x, const Point &direction) const;
  /// Around all places that count as met by a line; empty without facets.
  Bounds bounds() const;

private:
  struct Box {
    Bounds bounds;
    std::size_t first, last; // of the facets in order_
    std::size_t next;        // box after its parts, which follow it
  };
  void add_box(std::size_t first, std::size_t last);
  Point corner(std::size_t facet, int k) const;

  StraightFacets facets_;
  double beyond_;
  std::vector<std::size_t> order_; // of facets, so that those of a box follow each other
  std::vector<Box> boxes_;         // each before its parts
};

/// Where lines meet a surface of which each rank holds a part: lines go to the ranks whose boxes they meet, and the first meeting of all
/// counts. Collective.
/// @param mine       this rank's part; `beyond` the same on all ranks
/// @param x          (lines) [m]
/// @param direction  (lines) unit
/// @return (lines) nothing where a line misses the surface
std::vector<std::optional<FacetSurface::Meeting>> meetings_along(const Comm &comm, const FacetSurface &mine,
                                                                 const std::vector<Point> &x,
                                                                 const std::vector<Point> &direction);

} // namespace rpc::contact
