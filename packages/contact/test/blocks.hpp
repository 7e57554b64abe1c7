// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <functional>
#include <memory>

/// Blocks of any element, and values at their nodes that are functions of the place.
namespace rpc::test
{

using Function = std::function<double(const Point &)>;
using PointFunction = std::function<Point(const Point &)>;

constexpr double cell = 0.25; // edge, in all directions [m]

/// A block of 8 x 2 (x 4) cells, each node moved to where `bend` says.
inline fem::Discretization block(const mesh::Element &element, const PointFunction &bend = {}, const int refinement = 1,
                                 const fem::Kinematics kinematics = fem::Kinematics::plane_strain)
{
  mesh::BoxOptions box{{1, 0, -1}, {3, 0.5, 0}, {8 * refinement, 2 * refinement, 4 * refinement}, element};
  for (auto *const ends : {&box.lower, &box.upper}) ends->resize(element.dim);
  box.cells.resize(element.dim);
  auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
  const auto coords = to_host(mesh->coords);
  for (LO n = 0; bend && n < mesh->num_local_nodes(); ++n) {
    Point x{};
    for (int c = 0; c < element.dim; ++c) x[c] = coords(n, c);
    x = bend(x);
    for (int c = 0; c < element.dim; ++c) coords(n, c) = x[c];
  }
  Kokkos::deep_copy(mesh->coords, coords);
  return fem::discretize(mesh, kinematics);
}

inline Point place_of(const fem::Discretization &d, const LO node)
{
  const auto coords = to_host(d.mesh->coords);
  Point x{};
  for (int c = 0; c < d.dim(); ++c) x[c] = coords(node, c);
  return x;
}

inline RCP<MultiVector> at_nodes(const fem::Discretization &d, const Function &f)
{
  const auto columns = rcp(new MultiVector(d.mesh->owned_nodes, 1));
  const auto to = columns->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) to(n, 0) = f(place_of(d, n));
  return columns;
}

inline RCP<Vector> displacement(const fem::Discretization &d, const PointFunction &u)
{
  const auto vector = rcp(new Vector(d.owned_dofs));
  const auto to = vector->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
    const Point value = u(place_of(d, n));
    for (int c = 0; c < d.dim(); ++c) to(dof(d.dim(), n, c), 0) = value[c];
  }
  return vector;
}

} // namespace rpc::test
