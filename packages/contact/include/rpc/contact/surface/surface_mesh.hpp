// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/surface.hpp"
#include "rpc/contact/surface/triangles.hpp"
#include "rpc/core/file_reader.hpp"
#include "rpc/core/point.hpp"

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <optional>
#include <string>

namespace rpc::contact
{

/// A body of any shape, by the triangles of its surface. The origin of its file stands at the obstacle's point. What it answers: see
/// Surface; doc/theory.md (3.7c).
struct SurfaceMesh {
  static constexpr const char *point = "Origin";
  static constexpr const char *no_direction_at = "";
  static constexpr bool is_flat = false;

  std::shared_ptr<const ClosedSurface> surface; ///< around the foundation; copies of an obstacle share it
  bool smooth = false;                          ///< its direction interpolates the normals of corners
  bool encloses = false;                        ///< the foundation lies outside of it
  std::string file;                             ///< for users

  std::optional<Point> direction_into(const Point &x) const;
  bool lies_in(const Point &x) const;
  std::optional<double> distance_along(const Point &x, const Point &direction) const;
  SurfaceDetail detail() const;

  static SurfaceKind kind();
  static SurfaceMesh read(const Teuchos::ParameterList &list, int dim, const std::string &path,
                          const FileReader &read_file);

private:
  double size() const; ///< that rounding counts against [m]
};

} // namespace rpc::contact
