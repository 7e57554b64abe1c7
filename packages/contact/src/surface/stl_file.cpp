// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/stl_file.hpp"

#include "rpc/core/error.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>

namespace rpc::contact
{
namespace
{

constexpr const char *convert = ". Export the tool as STL, or make one of CAD or any surface mesh: gmsh tool.step -2 "
                                "-o tool.stl, gmsh tool.msh -save -o tool.stl";

/// Puts corners together.
class Gathered
{
public:
  void add(const Point &x, const std::string &where)
  {
    RPC_REQUIRE(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]),
                where << "must hold finite numbers, got (" << x[0] << ", " << x[1] << ", " << x[2] << ") in facet "
                      << count_ / 3 + 1 << ". Export it again");
    Point y = x;
    for (double &c : y) c += 0.; // -0 and 0 are one
    const auto [found, is_new] = numbers_.emplace(y, static_cast<int>(triangles.points.size()));
    if (is_new) triangles.points.push_back(y);
    if (count_ % 3 == 0) triangles.corners.emplace_back();
    triangles.corners.back()[count_ % 3] = found->second;
    ++count_;
  }
  std::size_t count() const { return count_; }
  Triangles triangles;

private:
  std::map<Point, int> numbers_;
  std::size_t count_ = 0; // of corners
};

std::uint32_t whole_number_at(const std::string &bytes, const std::size_t place)
{
  std::uint32_t value = 0; // least byte first, whatever the machine's order is
  for (int k = 3; k >= 0; --k) value = 256 * value + static_cast<unsigned char>(bytes[place + k]);
  return value;
}

double number_at(const std::string &bytes, const std::size_t place)
{
  const std::uint32_t bits = whole_number_at(bytes, place);
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

} // namespace

Triangles triangles_of_stl(const std::string &bytes, const std::string &where)
{
  constexpr std::size_t head = 84, per_facet = 50; // bytes of a binary file: a title and the number of facets; of each
  Gathered gathered;
  const bool has_head = bytes.size() >= head;
  const std::size_t told = has_head ? whole_number_at(bytes, head - 4) : 0;
  if (has_head && bytes.size() == head + per_facet * told) {
    for (std::size_t n = 0; n < told; ++n)
      for (std::size_t k = 1; k < 4; ++k) { // behind its normal
        const std::size_t here = head + per_facet * n + 12 * k;
        gathered.add({number_at(bytes, here), number_at(bytes, here + 4), number_at(bytes, here + 8)}, where);
      }
    return gathered.triangles;
  }
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  RPC_REQUIRE(begin != std::string::npos && bytes.compare(begin, 5, "solid") == 0 &&
                  bytes.find("facet") != std::string::npos,
              where << "must be an STL file of facets, text or binary, got "
                    << (bytes.empty() ? "an empty one" : "another one, or one that has been cut off") << convert);
  std::istringstream text(bytes);
  std::string word;
  bool closed = false;
  while (text >> word) {
    closed = word == "endsolid" || (closed && word != "facet");
    if (word == "endfacet")
      RPC_REQUIRE(gathered.count() % 3 == 0 && gathered.count() > 0,
                  where << "must have three vertices in each facet, got another number by facet "
                        << gathered.count() / 3 + 1 << ". Export it again");
    if (word != "vertex") continue;
    Point x{};
    std::string numbers[3];
    for (int c = 0; c < 3; ++c) {
      if (!(text >> numbers[c])) break;
      char *end = nullptr;
      x[c] = std::strtod(numbers[c].c_str(), &end);
      RPC_REQUIRE(*end == '\0', where << "must hold numbers, got \"" << numbers[c] << "\" in facet "
                                      << gathered.count() / 3 + 1 << ". Export it again");
    }
    if (text) gathered.add(x, where);
  }
  RPC_REQUIRE(closed && gathered.count() % 3 == 0, where << "must end with \"endsolid\", got no more after facet "
                                                         << gathered.count() / 3
                                                         << ": it has been cut off. Copy or export it again");
  return gathered.triangles;
}

} // namespace rpc::contact
