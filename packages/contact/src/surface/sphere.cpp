// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/sphere.hpp"

#include "round.hpp"

namespace rpc::contact
{

std::optional<Point> Sphere::direction_into(const Point &x) const
{
  return direction_into_round(x, encloses);
}

bool Sphere::lies_in(const Point &x) const
{
  return lies_in_round(x, radius, encloses);
}

std::optional<double> Sphere::distance_along(const Point &x, const Point &direction) const
{
  return distance_along_round(x, direction, radius, encloses);
}

SurfaceKind Sphere::kind()
{
  return {{"sphere", "circle"}, "Centre", {"Radius", "Encloses Body"}, ""};
}

Sphere Sphere::read(const Teuchos::ParameterList &list, int, const std::string &path)
{
  return {radius_of(list, path), list.get<bool>("Encloses Body")};
}

} // namespace rpc::contact
