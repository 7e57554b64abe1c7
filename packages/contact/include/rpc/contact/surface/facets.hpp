#pragma once

#include "rpc/core/field.hpp"
#include "rpc/fem/discretization.hpp"

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

/// A side's facets, of all ranks and on each of them, at x + u + shift: those of order 2 as several straight ones, quadrilaterals as
/// four triangles about their middle. Collective.
/// @param u       (owned dofs) [m]; null: 0
/// @param values  (owned nodes; columns)
/// @param column  of the values
StraightFacets straight_facets(const fem::Discretization &d, const mesh::Side &side, const Vector *u,
                               const Point &shift, const MultiVector &values, int column);

/// Looks up values of a surface along lines, in a tree of boxes about its facets.
class FacetSurface
{
public:
  /// @param beyond  a line that misses the surface by up to this much, or by half a facet, takes the value at its edge [m]
  explicit FacetSurface(StraightFacets facets, double beyond = 0);

  /// The value where the line through x meets the surface: of several such places that which is nearest to x, among facets whose
  /// normal has a part along the direction. Nothing if it misses the surface. Linear functions are met to rounding.
  /// @param direction  unit
  std::optional<double> along(const Point &x, const Point &direction) const;

private:
  struct Box {
    Point lower, upper;
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

} // namespace rpc::contact
