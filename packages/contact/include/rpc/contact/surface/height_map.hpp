// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/height_grid.hpp"
#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/surface.hpp"
#include "rpc/core/file_reader.hpp"
#include "rpc/core/point.hpp"

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <optional>
#include <string>

namespace rpc::contact
{

/// A surface by its heights on a regular grid, in the plane a profile: a measured or a synthetic one. Its first height stands at the
/// obstacle's point. What it answers: see Surface.
struct HeightMap {
  static constexpr const char *point = "Origin";
  static constexpr const char *no_direction_at = "";
  static constexpr bool is_flat = false;

  std::shared_ptr<const HeightGrid> grid; ///< copies of an obstacle share it
  Point along_x{{1, 0, 0}}, along_y{{0, 0, 1}},
      normal{{0, 1, 0}}; ///< of the grid; unit, the normal from the foundation to the body
  std::string what;      ///< for users: the file and the interpolation

  std::optional<Point> direction_into(const Point &x) const;
  bool lies_in(const Point &x) const;
  std::optional<double> distance_along(const Point &x, const Point &direction) const;
  SurfaceDetail detail() const;

  static SurfaceKind kind();
  static HeightMap read(const Teuchos::ParameterList &list, int dim, const std::string &path,
                        const FileReader &read_file);

private:
  /// In the directions of the grid.
  Point in_grid(const Point &v) const { return {inner(v, along_x), inner(v, along_y), inner(v, normal)}; }
  double clearance(const Bounds &places) const;
  std::string told(const std::string &unit) const;
};

} // namespace rpc::contact
