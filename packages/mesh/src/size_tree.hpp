// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/size_field.hpp"

#include <array>
#include <vector>

namespace rpc::mesh
{

/// Values of a size field at points, by a tree of boxes around its simplices: as fast where these are a millionth of
/// the body as where they are a tenth.
/// @tparam dim  of the field, 2 or 3
template <int dim>
class SizeTree
{
public:
  using Point = std::array<double, dim>;

  /// @param field  of one simplex or more; degenerate ones count as their faces
  explicit SizeTree(const SizeField &field);

  double operator()(const Point &at) const;

private:
  static constexpr int vertices = dim + 1;
  struct Simplex {
    std::array<Point, vertices> vertex;
    std::array<double, vertices> size;
  };
  struct Box {
    Point low, high;
    int first = 0; // of its simplices, or of its two boxes
    int count = 0; // of its simplices, 0 for a box of two boxes
  };
  struct Place {
    Point centre{}; // times the number of vertices
    int simplex = 0;
  };
  void divide(int box, const std::vector<Simplex> &simplices, std::vector<Place> &order, int first, int last);

  std::vector<Box> boxes_;
  std::vector<Simplex> simplices_;
};

/// How many times as large a cell is as the field says at its centre, by cell_size().
template <int dim>
double excess(const SizeTree<dim> &size, const SimplexVertices<dim> &cell)
{
  std::array<double, dim> centre{};
  for (const auto &vertex : cell)
    for (int d = 0; d < dim; ++d) centre[d] += vertex[d] / (dim + 1);
  return cell_size<dim>(cell) / size(centre);
}

extern template class SizeTree<2>;
extern template class SizeTree<3>;

} // namespace rpc::mesh
