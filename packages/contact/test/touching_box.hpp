// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <string>
#include <vector>

/// A box whose sides may touch foundations, and what is expected of its contact nodes.
namespace rpc::test
{

constexpr double inf = std::numeric_limits<double>::infinity();

/// A box of 2 x 1 (x 1) m with its lower corner at the origin.
inline fem::Discretization body(const mesh::Element &element = {2, 1})
{
  mesh::BoxOptions box{{0, 0}, {2, 1}, {4, 2}, element};
  if (element.dim == 3) box = {{0, 0, 0}, {2, 1, 1}, {4, 2, 2}, element};
  return fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
}

/// A rigid foundation without gap.
inline contact::ContactOptions touching(const std::string &side)
{
  contact::ContactOptions options;
  options.side = side;
  options.yield_stress = ScalarField(inf);
  return options;
}

inline contact::ContactNodes nodes_of(const fem::Discretization &d, const std::vector<contact::ContactOptions> &options)
{
  return contact::contact_nodes(d, options, fem::dirichlet_dofs(d, {}));
}

/// What every point of a side must have.
struct Expected {
  Point normal{};
  double gap = 0;
};
inline void expect_points(const fem::Discretization &d, const contact::ContactNodes &c,
                          const std::function<Expected(const Point &)> &at, const int side = 0)
{
  const auto coords = to_host(d.mesh->coords);
  const auto node = to_host(c.node);
  const auto gap = to_host(c.gap), free_gap = to_host(c.free_gap);
  const auto normal = to_host(c.normal), direction = to_host(c.direction);
  for (LO i = c.first(side); i < c.first(side + 1); ++i) {
    Point x{};
    for (int k = 0; k < d.dim(); ++k) x[k] = coords(node(i), k);
    const Expected expected = at(x);
    EXPECT_NEAR(gap(i), expected.gap, 1e-14) << testing::PrintToString(x);
    EXPECT_EQ(free_gap(i), gap(i));
    for (int k = 0; k < d.dim(); ++k) {
      EXPECT_NEAR(normal(i, k), expected.normal[k], 1e-15) << testing::PrintToString(x);
      EXPECT_EQ(direction(i, k), normal(i, k));
    }
  }
}

} // namespace rpc::test
