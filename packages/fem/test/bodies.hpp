// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "expect_error.hpp"
#include "larger.hpp"
#include "rpc/core/field.hpp"
#include "rpc/fem/discretization.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <array>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

/// Small bodies, fields on them, and values that do not depend on the number of ranks.
namespace rpc::test
{

inline RCP<const Comm> world()
{
  return Tpetra::getDefaultComm();
}
/// This rank by itself: what it makes is the serial result, there to compare with.
inline RCP<const Comm> alone()
{
  static const RCP<const Comm> comm = world()->split(world()->getRank(), 0); // one for all: their number is limited
  return comm;
}

inline const std::vector<mesh::Element> &elements()
{
  return mesh::all_elements();
}
/// What the rounding of sums over the unknowns of a cell may come to, relative to the terms.
inline double rounding_of(const mesh::Element &element)
{
  return 5e-16 * std::max(20, element.dim * element.num_nodes());
}
/// Cells of a mesh in one of a box' lattice.
inline int parts_of_cell(const mesh::Element &element)
{
  if (element.shape == mesh::Shape::tensor) return 1;
  return element.dim == 2 ? 2 : 6;
}
inline std::string text_of(const mesh::Element &element)
{
  return element.name() + " in " + std::to_string(element.dim) + "D";
}

/// Few cells, of different lengths in each direction, away from the origin.
inline mesh::BoxOptions small_box(const mesh::Element &element)
{
  if (element.dim == 2) return {{-1, 2}, {1.5, 3}, {4, 3}, element};
  return {{-1, 2, 0}, {1, 3, 0.5}, {3, 2, 2}, element};
}

using Deformation = std::function<Point(const Point &)>;

inline fem::Discretization body(const mesh::BoxOptions &box, const RCP<const Comm> &comm, const Deformation &move = {},
                                const fem::Kinematics kinematics = fem::Kinematics::plane_strain)
{
  auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, comm));
  const auto coords = Kokkos::create_mirror_view(mesh->coords);
  Kokkos::deep_copy(coords, mesh->coords);
  for (LO n = 0; move && n < mesh->num_local_nodes(); ++n) {
    Point x{};
    for (int d = 0; d < mesh->dim(); ++d) x[d] = coords(n, d);
    x = move(x);
    for (int d = 0; d < mesh->dim(); ++d) coords(n, d) = x[d];
  }
  Kokkos::deep_copy(mesh->coords, coords);
  if (move) mesh->box = nullptr; // evenly divided no more
  return fem::discretize(mesh, kinematics);
}

/// Moves the nodes inside, so that no cell is a parallelogram; the boundary stays.
inline Deformation bulge(const mesh::BoxOptions &box)
{
  return [box](const Point &x) {
    double bubble = 0.08;
    for (int d = 0; d < box.element.dim; ++d) {
      const double t = (x[d] - box.lower[d]) / (box.upper[d] - box.lower[d]);
      bubble *= 4 * t * (1 - t);
    }
    Point moved = x;
    for (int d = 0; d < box.element.dim; ++d) moved[d] += (d == 1 ? -1 : 1) * bubble * (1 + x[0]);
    return moved;
  };
}

/// The small box with its inside out of shape.
inline fem::Discretization bulged_body(const mesh::Element &element, const RCP<const Comm> &comm)
{
  const auto box = small_box(element);
  return body(box, comm, bulge(box));
}

inline Point point_of(const fem::Discretization &d, const LO node)
{
  Point x{};
  for (int c = 0; c < d.dim(); ++c) Kokkos::deep_copy(x[c], Kokkos::subview(d.mesh->coords, node, c));
  return x;
}

/// u(x) at the owned nodes.
template <class Function>
RCP<Vector> interpolate(const fem::Discretization &d, const Function &u)
{
  const auto result = rcp(new Vector(d.owned_dofs));
  const auto values = result->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
    const Point value = u(point_of(d, n));
    for (int c = 0; c < d.dim(); ++c) values(d.dim() * n + c, 0) = value[c];
  }
  return result;
}

/// Something without any symmetry, the same on any number of ranks.
inline Point wild(const Point &x)
{
  return {std::sin(3 * x[0] + x[1] + 0.3), std::cos(2 * x[1] - x[0] * x[2]), std::sin(x[0] - 4 * x[2] + x[1])};
}

/// A linear displacement, and its gradient du_i / dx_j.
constexpr double slope[3][3] = {{0.3, -0.2, 0.5}, {0.7, -0.4, 0.1}, {-0.6, 0.25, 0.15}};
inline Point linear(const Point &x, const int dim)
{
  Point u{0.1, -0.2, dim == 3 ? 0.3 : 0.};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) u[i] += slope[i][j] * x[j];
  return u;
}

/// Values of all nodes on every rank, by node id, `size` to a node; value(node, k) for owned nodes.
template <class Value>
std::vector<double> by_node_id(const mesh::Mesh &mesh, const int size, const Value &value)
{
  std::vector<double> mine(mesh.owned_nodes->getGlobalNumElements() * size, 0.), all(mine.size());
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    for (int k = 0; k < size; ++k) mine[mesh.node_id(n) * size + k] = value(n, k);
  Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), all.data());
  return all;
}
inline std::vector<double> by_node_id(const fem::Discretization &d, const Vector &dofs)
{
  const auto values = dofs.getLocalViewHost(Tpetra::Access::ReadOnly);
  return by_node_id(*d.mesh, d.dim(), [&](const LO n, const int c) { return values(d.dim() * n + c, 0); });
}

/// Ids of all nodes of local cells.
inline std::vector<GO> overlap_node_ids(const mesh::Mesh &mesh)
{
  Vector owned(mesh.owned_nodes), overlap(mesh.overlap_nodes());
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) owned.replaceLocalValue(n, static_cast<double>(mesh.node_id(n)));
  overlap.doImport(owned, Import(mesh.owned_nodes, mesh.overlap_nodes()), Tpetra::INSERT);
  const auto values = overlap.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<GO> ids;
  for (LO n = 0; n < mesh.num_local_nodes(); ++n) ids.push_back(static_cast<GO>(values(n, 0)));
  return ids;
}

/// Largest |a - b|, relative to the largest |b|.
inline double difference(const std::vector<double> &a, const std::vector<double> &b)
{
  EXPECT_EQ(a.size(), b.size());
  double largest = 0, scale = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    largest = larger(largest, std::abs(a[k] - b[k]));
    scale = std::max(scale, std::abs(b[k]));
  }
  return scale > 0 ? largest / scale : largest;
}

/// Sum over all nodes of each component.
inline Point resultant(const fem::Discretization &d, const Vector &force)
{
  const auto values = by_node_id(d, force);
  Point sum{};
  for (std::size_t k = 0; k < values.size(); ++k) sum[k % d.dim()] += values[k];
  return sum;
}

/// All entries, row by row, of a matrix that one rank has whole.
inline std::vector<std::vector<double>> dense(const CrsMatrix &matrix)
{
  const auto local = matrix.getLocalMatrixHost();
  std::vector<std::vector<double>> rows(local.numRows(), std::vector<double>(local.numCols(), 0.));
  for (LO row = 0; row < local.numRows(); ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      rows[row][local.graph.entries(k)] = local.values(k);
  return rows;
}

/// Largest |a_ij - a_ji|, relative to the largest entry.
inline double asymmetry(const std::vector<std::vector<double>> &a)
{
  double largest = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      largest = larger(largest, std::abs(a[i][j] - a[j][i]));
      scale = std::max(scale, std::abs(a[i][j]));
    }
  }
  return largest / scale;
}

/// A field given by a function; the text is what messages would show.
inline ScalarField field(std::function<double(const Point &)> function, const std::string &text = "f")
{
  return ScalarField(text, std::move(function));
}

/// Reads constants only, as a deck without expressions.
inline ScalarField parse_constant(const std::string &text, const std::string &)
{
  ScalarField constant(std::stod(text));
  constant.text = text;
  return constant;
}

/// One cell with no two sides parallel; hexahedra with faces that are not plane.
inline fem::Discretization one_cell(const mesh::Element &element)
{
  const std::vector<double> lower(element.dim, 0.), upper(element.dim, 1.);
  const auto skew = [](const Point &x) {
    return Point{x[0] + 0.2 * x[0] * x[1] - 0.1 * x[2], x[1] + 0.15 * x[0] * (1 - x[1]) + 0.1 * x[1] * x[2],
                 x[2] * (1 + 0.2 * x[0] * x[1])};
  };
  return body({lower, upper, std::vector<int>(element.dim, 1), element}, alone(), skew);
}

inline double volume(const fem::Discretization &d)
{
  fem::VectorField unit = {field([](const Point &) { return 1.; }), ScalarField(0.), ScalarField(0.)};
  Vector load(d.owned_dofs);
  fem::add_body_force(d, unit, "test", load);
  return resultant(d, load)[0];
}

} // namespace rpc::test
