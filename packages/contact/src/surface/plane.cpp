// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/plane.hpp"

#include "parameters.hpp"

namespace rpc::contact
{

std::optional<Point> Plane::direction_into(const Point &) const
{
  return scaled(-1, normal);
}

bool Plane::lies_in(const Point &x) const
{
  return inner(x, normal) < -Rounding::place * length(x);
}

std::optional<double> Plane::distance_along(const Point &x, const Point &direction) const
{
  const double descent = -inner(direction, normal);
  if (!(descent > Rounding::place)) return std::nullopt;
  return inner(x, normal) / descent;
}

SurfaceKind Plane::kind()
{
  return {{"plane"}, "Point", {"Normal"}, ""};
}

Plane Plane::read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
{
  return {unit_vector(list, "Normal", dim, path)};
}

} // namespace rpc::contact
