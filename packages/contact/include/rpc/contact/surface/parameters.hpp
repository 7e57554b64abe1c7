// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/kind.hpp"
#include "rpc/core/point.hpp"

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <string>

/// Parameters that several surfaces have.
namespace rpc::contact
{

/// Unit vector from one of any length.
/// @param path  of the list, for messages   @throws rpc::Error (bad_input)
Point unit_vector(const Teuchos::ParameterList &list, const std::string &name, int dim, const std::string &path);

/// The same, or another one where the list has none.
Point unit_vector_or(const Teuchos::ParameterList &list, const std::string &name, const Point &fallback, int dim,
                     const std::string &path);

/// Three unit vectors at right angles to each other: the first two are `Axis` and, in space, `Second Axis`, by default x and y. In the plane the second one
/// is at right angles to the first.
std::array<Point, 3> orthonormal_axes(const Teuchos::ParameterList &list, int dim, const std::string &path);

/// A number in [m], or of another unit. @throws rpc::Error (bad_input) unless it is > 0 and finite
double positive_of(const Teuchos::ParameterList &list, const std::string &name, const std::string &path,
                   const std::string &unit = "[m]");
/// The same of `Radius`.
double radius_of(const Teuchos::ParameterList &list, const std::string &path);
/// A radius by which something is rounded [m]. @throws rpc::Error (bad_input) unless it is >= 0 and finite
double rounding_of(const Teuchos::ParameterList &list, const std::string &name, const std::string &path);

SurfaceParameter radius_parameter();   ///< `Radius`
SurfaceParameter encloses_parameter(); ///< `Encloses Body`

} // namespace rpc::contact
