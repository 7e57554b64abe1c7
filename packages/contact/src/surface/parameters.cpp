// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/parameters.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/core/error.hpp"

#include <Teuchos_Array.hpp>
#include <cmath>

namespace rpc::contact
{

Point unit_vector(const Teuchos::ParameterList &list, const std::string &name, const int dim, const std::string &path)
{
  const auto &numbers = list.get<Teuchos::Array<double>>(name);
  RPC_REQUIRE(numbers.size() == dim, "deck: \"" << path << "->" << name << "\" must hold " << dim << " numbers, got "
                                                << numbers.size()
                                                << (numbers.empty() ? ". It has no default: add it." : ""));
  Point given{};
  for (int c = 0; c < dim; ++c) {
    RPC_REQUIRE(std::isfinite(numbers[c]),
                "deck: \"" << path << "->" << name << "\" must be finite, got " << numbers[c]);
    given[c] = numbers[c];
  }
  const double size = length(given);
  RPC_REQUIRE(size > 0 && std::isfinite(size),
              "deck: \"" << path << "->" << name << "\" must have a length > 0, got " << size);
  return scaled(1 / size, given);
}

Point unit_vector_or(const Teuchos::ParameterList &list, const std::string &name, const Point &fallback, const int dim,
                     const std::string &path)
{
  return list.get<Teuchos::Array<double>>(name).empty() ? fallback : unit_vector(list, name, dim, path);
}

std::array<Point, 3> orthonormal_axes(const Teuchos::ParameterList &list, const int dim, const std::string &path)
{
  const Point first = unit_vector_or(list, "Axis", {1, 0, 0}, dim, path);
  Point second = {-first[1], first[0], 0};
  RPC_REQUIRE(dim == 3 || list.get<Teuchos::Array<double>>("Second Axis").empty(),
              "deck: \"" << path
                         << "->Second Axis\" goes with a body in space; in the plane \"Axis\" tells both. Remove it.");
  if (dim == 3) {
    second = unit_vector_or(list, "Second Axis", {0, 1, 0}, dim, path);
    const double cosine = inner(first, second);
    RPC_REQUIRE(std::abs(cosine) <= Rounding::place,
                "deck: \"" << path << "->Second Axis\" must be at right angles to \"" << path
                           << "->Axis\", got a cosine of " << cosine << " between them");
  }
  return {first, second, cross(first, second)};
}

double positive_of(const Teuchos::ParameterList &list, const std::string &name, const std::string &path,
                   const std::string &unit)
{
  const double value = list.get<double>(name);
  RPC_REQUIRE(value > 0 && std::isfinite(value),
              "deck: \"" << path << "->" << name << "\" must be > 0 and finite " << unit << ", got " << value);
  return value;
}

double radius_of(const Teuchos::ParameterList &list, const std::string &path)
{
  return positive_of(list, "Radius", path);
}

double rounding_of(const Teuchos::ParameterList &list, const std::string &name, const std::string &path)
{
  const double radius = list.get<double>(name);
  RPC_REQUIRE(radius >= 0 && std::isfinite(radius),
              "deck: \"" << path << "->" << name << "\" must be >= 0 and finite [m] (0: sharp), got " << radius);
  return radius;
}

SurfaceParameter radius_parameter()
{
  return {"Radius", 0., "its radius, > 0 [m]"};
}

SurfaceParameter encloses_parameter()
{
  return {"Encloses Body", false, "whether the body lies inside of it and the foundation outside"};
}

} // namespace rpc::contact
