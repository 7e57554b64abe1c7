// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/mesh_picture.hpp"

#include "png.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::io
{
namespace
{

using Vec3 = std::array<double, 3>;

struct NamedColour {
  const char *name;
  Rgb rgb;
};

constexpr NamedColour side_colours[] = {
    {"blue", {31, 119, 180}},    {"orange", {255, 127, 14}}, {"green", {44, 160, 44}},  {"red", {214, 39, 40}},
    {"purple", {148, 103, 189}}, {"brown", {140, 86, 75}},   {"pink", {227, 119, 194}}, {"yellow", {230, 200, 20}},
    {"olive", {128, 128, 0}},    {"cyan", {23, 190, 207}}};
constexpr int num_colours = sizeof(side_colours) / sizeof(side_colours[0]);
constexpr Rgb block_colours[] = {{215, 215, 215}, {190, 190, 190}, {232, 232, 232}};
constexpr int num_block_colours = sizeof(block_colours) / sizeof(block_colours[0]);
constexpr int shades = 16; ///< of each colour, from half as bright to its own
constexpr int background = 0, first_shade = 1;

std::vector<Rgb> palette()
{
  std::vector<Rgb> all = {{255, 255, 255}};
  const auto add = [&](const Rgb &colour) {
    for (int s = 0; s < shades; ++s) {
      Rgb shaded{};
      for (int c = 0; c < 3; ++c) shaded[c] = static_cast<unsigned char>(colour[c] * (0.5 + 0.5 * s / (shades - 1)));
      all.push_back(shaded);
    }
  };
  for (const NamedColour &colour : side_colours) add(colour.rgb);
  for (const Rgb &colour : block_colours) add(colour);
  return all;
}

/// @param colour  of a side, or after these of a block   @param brightness  0 to 1
unsigned char shade_of(const int colour, const double brightness)
{
  return static_cast<unsigned char>(first_shade + shades * colour + std::lround(brightness * (shades - 1)));
}

double dot(const Vec3 &a, const Vec3 &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 cross(const Vec3 &a, const Vec3 &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 unit(const Vec3 &a)
{
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? Vec3{a[0] / length, a[1] / length, a[2] / length} : Vec3{};
}

/// Directions of a picture: to the right, up, and to the eye.
using View = std::array<Vec3, 3>;

View seen_from(const Vec3 &eye)
{
  const Vec3 towards = unit(eye), right = unit(cross({0, 0, 1}, towards));
  return {right, cross(towards, right), towards};
}

/// Places in a picture: x to the right, y down, both in pixels, and depth, which is larger nearer to the eye.
class Canvas
{
public:
  Canvas(const int width, const int height)
      : pixel(std::size_t(width) * height, background), width_(width), height_(height),
        depth_(pixel.size(), -std::numeric_limits<double>::infinity())
  {
  }

  /// A polygon around its centre, darker at its edges unless it is too small for that.
  void add_polygon(const std::vector<Vec3> &corners, const int colour, const double brightness)
  {
    Vec3 centre{};
    for (const Vec3 &corner : corners)
      for (int d = 0; d < 3; ++d) centre[d] += corner[d] / static_cast<double>(corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k)
      add_triangle(centre, corners[k], corners[(k + 1) % corners.size()], colour, brightness);
  }

  /// A line in front of all else.
  void add_line(const Vec3 &a, const Vec3 &b, const int colour)
  {
    constexpr double half_width = 2; // [pixels]
    const Vec3 along = {b[0] - a[0], b[1] - a[1], 0};
    const double squared = dot(along, along);
    each_pixel({a, b}, half_width, [&](const Vec3 &x) {
      const Vec3 from = {x[0] - a[0], x[1] - a[1], 0};
      const double t = squared > 0 ? std::clamp(dot(from, along) / squared, 0., 1.) : 0;
      if (std::hypot(from[0] - t * along[0], from[1] - t * along[1]) <= half_width)
        set(x, std::numeric_limits<double>::infinity(), shade_of(colour, 1));
    });
  }

  std::vector<unsigned char> pixel; ///< (height, width)

private:
  /// Centres of the pixels around some points.
  template <class Each>
  void each_pixel(const std::vector<Vec3> &points, const double beyond, const Each &each) const
  {
    double low[2] = {double(width_), double(height_)}, high[2] = {0, 0};
    for (const Vec3 &x : points)
      for (int d = 0; d < 2; ++d) {
        low[d] = std::min(low[d], x[d] - beyond);
        high[d] = std::max(high[d], x[d] + beyond);
      }
    const int first[2] = {std::max(0, static_cast<int>(low[0])), std::max(0, static_cast<int>(low[1]))};
    const int last[2] = {std::min(width_ - 1, static_cast<int>(high[0])),
                         std::min(height_ - 1, static_cast<int>(high[1]))};
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) each({x + 0.5, y + 0.5, 0});
  }

  void add_triangle(const Vec3 &centre, const Vec3 &a, const Vec3 &b, const int colour, const double brightness)
  {
    constexpr double line = 0.8, least_height = 4; // [pixels]
    const double twice = (a[0] - centre[0]) * (b[1] - centre[1]) - (a[1] - centre[1]) * (b[0] - centre[0]);
    if (twice == 0) return;
    const double height = std::abs(twice) / std::hypot(b[0] - a[0], b[1] - a[1]);
    each_pixel({centre, a, b}, 0, [&](const Vec3 &x) {
      const double of_a = ((x[0] - centre[0]) * (b[1] - centre[1]) - (x[1] - centre[1]) * (b[0] - centre[0])) / twice;
      const double of_b = ((a[0] - centre[0]) * (x[1] - centre[1]) - (a[1] - centre[1]) * (x[0] - centre[0])) / twice;
      const double of_centre = 1 - of_a - of_b;
      if (std::min({of_a, of_b, of_centre}) < -1e-9) return;
      const bool at_edge = height >= least_height && of_centre * height < line;
      set(x, of_centre * centre[2] + of_a * a[2] + of_b * b[2], shade_of(colour, at_edge ? 0 : brightness));
    });
  }

  void set(const Vec3 &x, const double depth, const unsigned char shade)
  {
    const std::size_t at = std::size_t(width_) * static_cast<int>(x[1]) + static_cast<int>(x[0]);
    if (depth < depth_[at]) return;
    depth_[at] = depth;
    pixel[at] = shade;
  }

  int width_, height_;
  std::vector<double> depth_;
};

/// What is to be seen of a mesh.
class Drawn
{
public:
  explicit Drawn(const mesh::MeshData &mesh)
      : mesh_(mesh), dim_(mesh.element.dim), facets_(mesh::facets_of(mesh.element, mesh.cells))
  {
    colour_.assign(facets_.size(), -1);
    for (std::size_t k = 0; k < mesh.sides.size(); ++k)
      for (std::size_t f = 0; f < mesh.sides[k].cell.size(); ++f)
        colour_[facets_.of_cell[std::size_t(facets_.per_cell) * mesh.sides[k].cell[f] + mesh.sides[k].ordinal[f]]] =
            static_cast<int>(k) % num_colours;
  }

  /// The corners of the box around the mesh in a view.
  std::array<Vec3, 2> box(const View &view) const
  {
    constexpr double inf = std::numeric_limits<double>::infinity();
    std::array<Vec3, 2> corners = {Vec3{inf, inf, inf}, Vec3{-inf, -inf, -inf}};
    for (int n = 0; n < mesh_.num_nodes(); ++n)
      for (int d = 0; d < 3; ++d) {
        const double x = dot(place(n), view[d]);
        corners[0][d] = std::min(corners[0][d], x);
        corners[1][d] = std::max(corners[1][d], x);
      }
    return corners;
  }

  /// @param to_pixels  of a point in space
  template <class ToPixels>
  void draw(Canvas &canvas, const View &view, const ToPixels &to_pixels) const
  {
    const mesh::Element outline = dim_ == 2 ? mesh_.element : mesh_.element.facet();
    const auto polygon = [&](const std::vector<int> &nodes) {
      std::vector<Vec3> corners;
      for (const auto &edge : outline.edges()) {
        corners.push_back(to_pixels(place(nodes[edge[0]])));
        if (edge.size() > 2) corners.push_back(to_pixels(place(nodes[edge[2]])));
      }
      return corners;
    };
    const int width = mesh_.element.num_nodes();
    for (int c = 0; dim_ == 2 && c < mesh_.num_cells(); ++c)
      canvas.add_polygon(polygon({&mesh_.cells[std::size_t(width) * c], &mesh_.cells[std::size_t(width) * c] + width}),
                         of_block(c), 1);
    for (int f = 0; f < facets_.size(); ++f) {
      if (facets_.num_cells_at(f) != 1) continue;
      const int cell = facets_.cell(f, 0);
      std::vector<int> nodes;
      for (const int a : mesh_.element.facets()[facets_.ordinal(f, 0)])
        nodes.push_back(mesh_.cells[std::size_t(width) * cell + a]);
      if (dim_ == 3) {
        canvas.add_polygon(polygon(nodes), colour_[f] < 0 ? of_block(cell) : colour_[f], brightness(nodes, view[2]));
      } else if (colour_[f] >= 0) {
        std::vector<Vec3> line = {to_pixels(place(nodes[0])), to_pixels(place(nodes[1]))};
        if (nodes.size() > 2) line.insert(line.begin() + 1, to_pixels(place(nodes[2])));
        for (std::size_t k = 0; k + 1 < line.size(); ++k) canvas.add_line(line[k], line[k + 1], colour_[f]);
      }
    }
  }

private:
  Vec3 place(const int node) const
  {
    Vec3 x{};
    for (int d = 0; d < dim_; ++d) x[d] = mesh_.coords[std::size_t(dim_) * node + d];
    return x;
  }
  int of_block(const int cell) const { return num_colours + mesh_.block[cell] % num_block_colours; }

  /// By the angle to the eye.
  double brightness(const std::vector<int> &nodes, const Vec3 &eye) const
  {
    const Vec3 a = place(nodes[0]), b = place(nodes[1]), c = place(nodes[2]);
    const Vec3 normal = unit(cross({b[0] - a[0], b[1] - a[1], b[2] - a[2]}, {c[0] - a[0], c[1] - a[1], c[2] - a[2]}));
    return 0.3 + 0.7 * std::abs(dot(normal, eye));
  }

  const mesh::MeshData &mesh_;
  int dim_;
  mesh::Entities facets_;
  std::vector<int> colour_; ///< (facets) of their sides, -1: of none
};

} // namespace

std::string colour_of_side(const std::size_t k)
{
  return side_colours[k % num_colours].name;
}

std::string mesh_picture(const mesh::MeshData &mesh)
{
  constexpr int longest = 700, margin = 10; // of a view [pixels]
  const Drawn drawn(mesh);
  const Vec3 corner = {1, -1.6, 0.9};
  const std::vector<View> views =
      mesh.element.dim == 2 ? std::vector<View>{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}}
                            : std::vector<View>{seen_from(corner), seen_from({-corner[0], -corner[1], -corner[2]})};
  const auto [lower, upper] = drawn.box(views.front()); // the other one is its mirror image
  const Vec3 extent = {upper[0] - lower[0], upper[1] - lower[1], 0};
  const double scale = longest / std::max(extent[0], extent[1]);
  const int width = static_cast<int>(scale * extent[0]) + 2 * margin,
            height = static_cast<int>(scale * extent[1]) + 2 * margin, num_views = static_cast<int>(views.size());
  Canvas canvas(width * num_views, height);
  for (int k = 0; k < num_views; ++k) {
    const View &view = views[k];
    const auto corners = drawn.box(view);
    drawn.draw(canvas, view, [&](const Vec3 &x) {
      return Vec3{width * k + margin + scale * (dot(x, view[0]) - corners[0][0]),
                  margin + scale * (corners[1][1] - dot(x, view[1])), dot(x, view[2])};
    });
  }
  return png_of(canvas.pixel, width * num_views, height, palette());
}

} // namespace rpc::io
