// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/cylinder.hpp"

#include "round.hpp"

namespace rpc::contact
{
namespace
{

/// A vector without its part along the axis.
Point across(const Point &axis, const Point &v)
{
  return difference(v, scaled(inner(v, axis), axis));
}

} // namespace

std::optional<Point> Cylinder::direction_into(const Point &x) const
{
  return direction_into_round(across(axis, x), encloses);
}

bool Cylinder::lies_in(const Point &x) const
{
  return lies_in_round(across(axis, x), radius, encloses);
}

std::optional<double> Cylinder::distance_along(const Point &x, const Point &direction) const
{
  return distance_along_round(across(axis, x), across(axis, direction), radius, encloses);
}

SurfaceKind Cylinder::kind()
{
  return {{"cylinder"}, "Point", {"Axis", "Radius", "Encloses Body"}, "circle"};
}

Cylinder Cylinder::read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
{
  const Point axis = unit_vector(list, "Axis", dim, path);
  return {axis, radius_of(list, path), list.get<bool>("Encloses Body")};
}

} // namespace rpc::contact
