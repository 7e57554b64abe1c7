// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_types.hpp"

#include <iterator>

namespace rpc::mesh
{

const GmshType *gmsh_type(const int number)
{
  static const GmshType types[] = {
      {"Line", 1, 2},         {"Triangle", 2, 3},      {"Quadrilateral", 2, 4}, {"Tetrahedron", 3, 4},
      {"Hexahedron", 3, 8},   {"Prism", 3, 6},         {"Pyramid", 3, 5},       {"Line", 1, 3},
      {"Triangle", 2, 6},     {"Quadrilateral", 2, 9}, {"Tetrahedron", 3, 10},  {"Hexahedron", 3, 27},
      {"Prism", 3, 18},       {"Pyramid", 3, 14},      {"Point", 0, 1},         {"Quadrilateral", 2, 8},
      {"Hexahedron", 3, 20},  {"Prism", 3, 15},        {"Pyramid", 3, 13},      {"Triangle", 2, 9},
      {"Triangle", 2, 10},    {"Triangle", 2, 12},     {"Triangle", 2, 15},     {"Triangle", 2, 15},
      {"Triangle", 2, 21},    {"Line", 1, 4},          {"Line", 1, 5},          {"Line", 1, 6},
      {"Tetrahedron", 3, 20}, {"Tetrahedron", 3, 35},  {"Tetrahedron", 3, 56}};
  return number >= 1 && number <= static_cast<int>(std::size(types)) ? &types[number - 1] : nullptr;
}

std::string name_of_gmsh_type(const int number)
{
  const GmshType *const type = gmsh_type(number);
  return type ? type->name() : std::to_string(number);
}

} // namespace rpc::mesh
