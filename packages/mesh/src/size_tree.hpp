#pragma once

#include "rpc/mesh/size_field.hpp"

#include <array>
#include <vector>

namespace rpc::mesh
{

/// Values of a size field at points, by a tree of boxes around its triangles: as fast where these are a millionth of
/// the body as where they are a tenth.
class SizeTree
{
public:
  /// @param field  of one triangle or more; degenerate ones count as their edges
  explicit SizeTree(const SizeField &field);

  double operator()(double x, double y) const;

private:
  using Point = std::array<double, 2>;
  struct Triangle {
    std::array<Point, 3> vertex;
    std::array<double, 3> size;
  };
  struct Box {
    Point low, high;
    int first = 0; // of its triangles, or of its two boxes
    int count = 0; // of its triangles, 0 for a box of two boxes
  };
  struct Place {
    Point centre{}; // times three
    int triangle = 0;
  };
  struct Nearest {
    double square; // of the distance; 0 inside
    double size;
  };

  void divide(int box, const std::vector<Triangle> &triangles, std::vector<Place> &order, int first, int last);
  static Nearest nearest(const Triangle &triangle, const Point &at);

  std::vector<Box> boxes_;
  std::vector<Triangle> triangles_;
};

} // namespace rpc::mesh
