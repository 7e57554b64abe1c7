// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/parent_interpolation.hpp"

#include "bodies.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/fem/order_one.hpp"
#include "rpc/mesh/refinement.hpp"

#include <algorithm>
#include <cmath>

namespace parent_interpolation_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using Shared = std::shared_ptr<const mesh::Mesh>;

Shared small_body(const mesh::Element &element)
{
  return std::make_shared<mesh::Mesh>(mesh::make_box(small_box(element), world()));
}

Shared finer_than(const Shared &coarse)
{
  return std::make_shared<mesh::Mesh>(mesh::refined(coarse));
}

/// A polynomial of some degree, at the owned nodes.
Vector polynomial(const mesh::Mesh &mesh, const int degree)
{
  Vector values(mesh.owned_nodes);
  const auto coords = to_host(mesh.coords);
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    const double x = coords(n, 0), y = coords(n, 1), z = mesh.dim() == 3 ? coords(n, 2) : 0,
                 linear = 1 + x - 2 * y + 3 * z;
    values.replaceLocalValue(n, degree == 1 ? linear : linear * (2 - y + 0.5 * z) + x * x);
  }
  return values;
}

double difference(const Operator &P, const Vector &coarse, const Vector &fine)
{
  Vector found(fine.getMap());
  P.apply(coarse, found);
  found.update(-1., fine, 1.);
  return found.normInf() / fine.normInf();
}

TEST(ParentInterpolation, IsExactForPolynomialsOfTheOrder)
{
  for (const mesh::Element &element : elements()) {
    const Shared coarse = small_body(element), fine = finer_than(coarse);
    const auto P = fem::interpolation_from_parents(*coarse, *fine, *fine->parents);
    for (int degree = 1; degree <= element.order; ++degree)
      EXPECT_LT(difference(*P, polynomial(*coarse, degree), polynomial(*fine, degree)), 1e-14) << text_of(element);
    EXPECT_GT(difference(*P, polynomial(*coarse, element.order + 1), polynomial(*fine, element.order + 1)) +
                  (element.order == 2 ? 1 : 0),
              1e-4)
        << text_of(element);
  }
}

/// Of any values it gives what a search finds.
TEST(ParentInterpolation, IsWhatASearchFinds)
{
  for (const mesh::Element &element : elements()) {
    const Shared coarse = small_body(element), fine = finer_than(coarse);
    const auto P = fem::interpolation_from_parents(*coarse, *fine, *fine->parents);
    const auto search = fem::interpolation(fem::discretize(coarse), fem::discretize(fine));
    Vector values(coarse->owned_nodes), expected(fine->owned_nodes);
    for (LO n = 0; n < coarse->num_owned_nodes(); ++n)
      values.replaceLocalValue(n, std::sin(0.7 * static_cast<double>(coarse->node_id(n))));
    search->apply(values, expected);
    EXPECT_LT(difference(*P, values, expected), 1e-12) << text_of(element);
  }
}

/// Between the meshes of order 1 on the cells of two meshes of order 2: what multigrid uses.
TEST(ParentInterpolation, LeadsFromVerticesToVertices)
{
  for (const mesh::Element &element : elements()) {
    if (element.order == 1) continue;
    const Shared coarse = small_body(element), fine = finer_than(coarse);
    const auto low = fem::order_one(fem::discretize(coarse)).mesh, high = fem::order_one(fem::discretize(fine)).mesh;
    const auto P = fem::interpolation_from_parents(*low, *high, *fine->parents);
    EXPECT_LT(difference(*P, polynomial(*low, 1), polynomial(*high, 1)), 1e-14) << text_of(element);
    const auto to_nodes = fem::interpolation_from_parents(*low, *fine, *fine->parents);
    EXPECT_LT(difference(*to_nodes, polynomial(*low, 1), polynomial(*fine, 1)), 1e-14) << text_of(element);
  }
}

} // namespace
} // namespace parent_interpolation_test
