// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/hinges.hpp"

#include "pieces.hpp"
#include "pinched_nodes.hpp"
#include "point_text.hpp"
#include "rpc/core/on_root.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rpc::fem
{
namespace
{

using DenseRows = std::vector<std::vector<double>>;

/// Pieces joined to each other in points, of which motions are worked out all at once.
constexpr std::size_t most_pieces = 200;

double dot_of_rows(const std::vector<double> &a, const std::vector<double> &b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
}

/// a -= (a.unit) unit.
void subtract(std::vector<double> &a, const std::vector<double> &unit)
{
  const double part = dot_of_rows(a, unit);
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= part * unit[k];
}

/// Orthonormal basis of the span of rows of size 1, the largest remainder first.
DenseRows basis_of(const DenseRows &rows, const double tolerance)
{
  DenseRows rest = rows, units;
  for (;;) {
    std::size_t best = rest.size();
    double largest = tolerance * tolerance;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (!units.empty()) subtract(rest[i], units.back());
      const double square = dot_of_rows(rest[i], rest[i]);
      if (!(square > largest)) continue;
      largest = square;
      best = i;
    }
    if (best == rest.size()) return units;
    std::vector<double> unit = rest[best];
    for (const auto &other : units) subtract(unit, other); // again, so that the rest is orthogonal to rounding
    const double size = std::sqrt(dot_of_rows(unit, unit));
    for (double &entry : unit) entry /= size;
    units.push_back(unit);
  }
}

/// Pieces of the whole body that points join to each other.
struct Assembly {
  struct Joint {
    Point x; // [m]
    int a, b;
  };
  std::vector<Part> pieces; // centre, radius, number of cells
  std::vector<Joint> joints;
  std::vector<std::vector<RigidMotion>> held; // (pieces) along its modes
  Part whole;
};

/// Rank 0 only.
std::vector<Assembly> assemblies_of(const Pieces &all, const int dim)
{
  const int count = static_cast<int>(all.num_cells.size());
  Sets sets(count);
  for (std::size_t k = 0; k < all.same.size(); k += 2)
    sets.join(static_cast<int>(all.same[k]), static_cast<int>(all.same[k + 1]));
  const std::vector<int> piece = sets.numbers();
  const int num_pieces = count_of(piece);
  Sets joined(num_pieces);
  for (std::size_t j = 0; j < all.joined.size(); j += 2) joined.join(piece[all.joined[j]], piece[all.joined[j + 1]]);
  const std::vector<int> assembly = joined.numbers();

  std::vector<Assembly> assemblies(count_of(assembly));
  std::vector<Bounds> boxes(num_pieces, Bounds::empty()), whole(assemblies.size(), Bounds::empty());
  std::vector<GO> num_cells(num_pieces, 0);
  for (int p = 0; p < count; ++p) {
    const Bounds box = all.box_of(p);
    boxes[piece[p]].add(box);
    whole[assembly[piece[p]]].add(box);
    num_cells[piece[p]] += all.num_cells[p];
  }
  std::vector<int> place(num_pieces);
  for (int p = 0; p < num_pieces; ++p) {
    Assembly &to = assemblies[assembly[p]];
    place[p] = static_cast<int>(to.pieces.size());
    to.pieces.push_back(frame_of(boxes[p]));
    to.pieces.back().num_cells = num_cells[p];
    to.held.emplace_back();
    to.whole = frame_of(whole[assembly[p]]);
  }
  for (std::size_t j = 0; 2 * j < all.joined.size(); ++j) {
    const int a = piece[all.joined[2 * j]], b = piece[all.joined[2 * j + 1]];
    if (a == b) continue;
    Point x{};
    std::copy_n(&all.joint[dim * j], dim, x.begin());
    assemblies[assembly[a]].joints.push_back({x, place[a], place[b]});
  }
  for (Assembly &of : assemblies) { // in an order that ranks have no part in
    for (auto &joint : of.joints)
      if (of.pieces[joint.b].centre < of.pieces[joint.a].centre) std::swap(joint.a, joint.b);
    std::sort(of.joints.begin(), of.joints.end(), [](const auto &one, const auto &other) { return one.x < other.x; });
  }
  for (std::size_t k = 0; k < all.held.size(); ++k) {
    const int p = static_cast<int>(all.held[k]);
    Assembly &to = assemblies[assembly[piece[p]]];
    const int at = place[piece[p]];
    RigidMotion row;
    std::copy_n(&all.held_row[6 * k], 6, row.begin());
    to.held[at].push_back(moved(row, frame_of(all.box_of(p)), to.pieces[at], dim));
  }
  return assemblies;
}

/// What stops motions of the pieces, each by all its modes: prescribed displacements, and places that two of them share.
DenseRows stopped(const Assembly &assembly, const int dim)
{
  const std::size_t modes = num_rigid_modes(dim), size = modes * assembly.pieces.size();
  DenseRows rows;
  const auto put = [&](std::vector<double> &row, const RigidMotion &motion, const int piece, const double factor) {
    for (std::size_t k = 0; k < modes; ++k) row[modes * piece + k] = factor * motion[k];
  };
  for (std::size_t p = 0; p < assembly.pieces.size(); ++p)
    for (const RigidMotion &held : independent_rows(assembly.held[p], rigid_tolerance)) {
      rows.emplace_back(size, 0.);
      put(rows.back(), held, static_cast<int>(p), 1 / std::sqrt(dot(held, held)));
    }
  for (const auto &joint : assembly.joints)
    for (int c = 0; c < dim; ++c) {
      rows.emplace_back(size, 0.);
      put(rows.back(), row_at(joint.x.data(), c, assembly.pieces[joint.a], dim), joint.a, std::sqrt(0.5));
      put(rows.back(), row_at(joint.x.data(), c, assembly.pieces[joint.b], dim), joint.b, -std::sqrt(0.5));
    }
  return rows;
}

/// How many motions prescribed displacements leave to the pieces as one body.
std::size_t num_free_as_one(const Assembly &assembly, const int dim)
{
  std::vector<RigidMotion> rows;
  for (std::size_t p = 0; p < assembly.pieces.size(); ++p)
    for (const RigidMotion &held : assembly.held[p])
      rows.push_back(moved(held, assembly.pieces[p], assembly.whole, dim));
  return num_rigid_modes(dim) - independent_rows(rows, rigid_tolerance).size();
}

/// The joint about which pieces turn most, for a basis of the rows that stop motions.
const Assembly::Joint &loosest(const Assembly &assembly, const DenseRows &units, const int dim)
{
  const std::size_t modes = num_rigid_modes(dim), size = modes * assembly.pieces.size();
  std::size_t best = 0;
  double most = 0;
  for (std::size_t k = 0; k < size; ++k) { // projections of unit motions span what is left
    std::vector<double> motion(size, 0.);
    motion[k] = 1;
    for (int pass = 0; pass < 2; ++pass)
      for (const auto &unit : units) subtract(motion, unit);
    for (std::size_t j = 0; j < assembly.joints.size(); ++j) {
      const auto &joint = assembly.joints[j];
      const double a = assembly.pieces[joint.a].radius, b = assembly.pieces[joint.b].radius;
      double squares = 0;
      for (std::size_t mode = dim; mode < modes; ++mode)
        squares += std::pow(motion[modes * joint.a + mode] / a - motion[modes * joint.b + mode] / b, 2) * a * b;
      if (squares > most * (1 + 1e-6)) {
        most = squares;
        best = j;
      }
    }
  }
  return assembly.joints[best];
}

void check(const Assembly &assembly, const int dim)
{
  if (assembly.pieces.size() < 2) return;
  const std::string only = dim == 2 ? "in single points only" : "in single points or along edges only";
  const std::string remedy = std::string(". Join them over ") + (dim == 2 ? "an edge" : "a face") +
                             " of cells, or prescribe displacements in \"Dirichlet\" that hold each of them.";
  RPC_REQUIRE_CODE(assembly.pieces.size() <= most_pieces, ExitCode::no_solution,
                   "support: the mesh joins " << assembly.pieces.size() << " pieces of the body " << only
                                              << ", too many to tell whether something holds each" << remedy);
  const DenseRows units = basis_of(stopped(assembly, dim), rigid_tolerance);
  const std::size_t free = num_rigid_modes(dim) * assembly.pieces.size() - units.size();
  if (free <= num_free_as_one(assembly, dim)) return;
  const auto &joint = loosest(assembly, units, dim);
  const auto text = [&](const int piece) {
    const Part &p = assembly.pieces[piece];
    return std::to_string(p.num_cells) + (p.num_cells == 1 ? " cell" : " cells") + " around " +
           point_text(p.centre, dim, p.radius);
  };
  throw Error(ExitCode::no_solution, "support: the mesh joins a piece of " + text(joint.a) + " and one of " +
                                         text(joint.b) + " " + only + ", as at " +
                                         point_text(joint.x, dim, assembly.whole.radius) +
                                         ", where they can rotate against each other, and no prescribed displacement "
                                         "stops that" +
                                         remedy);
}

} // namespace

void require_stiff_joints(const Discretization &d, const DirichletDofs &dirichlet)
{
  const bool is_box = d.mesh->box != nullptr; // whose cells are joined over their facets
  if (is_box || d.axisymmetric() || !has_pinched_nodes(d)) return;
  const Pieces pieces = pieces_of(d, dirichlet);
  on_root(d.mesh->comm(), ExitCode::internal_error, [&] {
    for (const Assembly &assembly : assemblies_of(pieces, d.dim())) check(assembly, d.dim());
  });
}

} // namespace rpc::fem
