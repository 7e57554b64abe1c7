// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/rigid_side.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/values_at.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/mesh/box.hpp"
#include "tied.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc::fem
{
namespace
{

/// Of products of motions of size 1.
struct Alike {
  static constexpr double least_part = 1e-10; ///< less of one that is orthogonal to the others is rounding
};

/// A symmetric positive definite matrix as L D L^T, L unit lower triangular: row after row, D on the diagonal.
struct Factored {
  int size = 0;
  std::vector<double> entries;
  double least = 0; ///< entry of D over that of the matrix

  double at(const int i, const int j) const { return entries[i * size + j]; }
};

Factored factored(std::vector<double> A, const int n)
{
  Factored f{n, std::move(A), 1};
  for (int j = 0; j < n; ++j) {
    const double whole = f.at(j, j);
    for (int k = 0; k < j; ++k) f.entries[j * n + j] -= f.at(j, k) * f.at(j, k) * f.at(k, k);
    f.least = std::min(f.least, whole > 0 ? f.at(j, j) / whole : 0);
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) f.entries[i * n + j] -= f.at(i, k) * f.at(j, k) * f.at(k, k);
      f.entries[i * n + j] /= f.at(j, j);
    }
  }
  return f;
}

std::vector<double> solved(const Factored &f, std::vector<double> b)
{
  for (int i = 0; i < f.size; ++i)
    for (int k = 0; k < i; ++k) b[i] -= f.at(i, k) * b[k];
  for (int i = 0; i < f.size; ++i) b[i] /= f.at(i, i);
  for (int i = f.size - 1; i >= 0; --i)
    for (int k = i + 1; k < f.size; ++k) b[i] -= f.at(k, i) * b[k];
  return b;
}

/// (nodes, dim) Where forces at nodes act: those on the lower side of a periodic box have a part of their area at their images on the upper side.
HostPoints middles_of_areas(const mesh::Mesh &mesh, const HostPoints &x)
{
  const Kokkos::View<double **, Kokkos::HostSpace> middle("rpc::fem::middles_of_areas", x.extent(0), x.extent(1));
  for (std::size_t c = 0; c < x.extent(1); ++c) {
    const int direction = static_cast<int>(c);
    const double last = mesh.box ? mesh.box->last_in(direction) : 1;
    for (std::size_t i = 0; i < x.extent(0); ++i) {
      const bool has_image = mesh.box && x(i, c) == mesh.box->lower[c];
      middle(i, c) = x(i, c) + (has_image ? mesh.box->period(direction) * last / (1 + last) : 0);
    }
  }
  return middle;
}

/// The area's centroid, of a body of revolution that of the whole circumference, on the axis. Collective.
Point centroid(const Discretization &d, const mesh::Side &side, const std::vector<LO> &nodes, const HostPoints &x)
{
  Vector areas(d.owned_dofs);
  add_node_areas(d, side, areas);
  const auto area = values_at(areas, nodes, d.dim());
  std::vector<double> sums(4, 0.);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double here = area(i, 0);
    for (int c = 0; c < d.dim(); ++c) sums[c] += here * x(i, c);
    sums[3] += here;
  }
  sums = summed(d.mesh->comm(), sums);
  if (!(sums[3] > 0)) return {};
  if (d.axisymmetric()) sums[0] = 0;
  return {sums[0] / sums[3], sums[1] / sums[3], sums[2] / sums[3]};
}

const mesh::Side &rigid_side(const Discretization &d, const DirichletCondition &condition)
{
  const std::string parameter = condition.path() + "->Side";
  const auto &points = d.mesh->points;
  RPC_REQUIRE(std::none_of(points.begin(), points.end(), [&](const auto &each) { return each.name == condition.side; }),
              "deck: \"" << parameter << "\" must be a side, got the point \"" << condition.side
                         << "\". Hold a point in \"Dirichlet\".");
  return d.mesh->side(condition.side, parameter);
}

/// T of (2.9b), and the products of its columns' motions. @param products  of the unknown motions
/// @return what is larger than Alike::least_part where the nodes of the side tell the motions apart
double set_modes(RigidSide &side, const std::vector<double> &products)
{
  const int n = static_cast<int>(side.unknown.size());
  std::vector<double> size(n), scaled(products);
  for (int k = 0; k < n; ++k) // translations count as they are: without rotations z is the displacement
    size[k] = side.unknown[k] < 3 ? 1 : std::sqrt(products[k * n + k] / side.products.front());
  for (int k = 0; k < n; ++k)
    for (int l = 0; l < n; ++l) scaled[k * n + l] /= size[k] * size[l];
  const Factored f = factored(scaled, n);
  side.to_motions.assign(static_cast<std::size_t>(n) * n, 0.);
  for (int j = 0; j < n; ++j) { // columns of L^-T over the sizes
    std::vector<double> column(n, 0.);
    column[j] = 1;
    for (int i = j - 1; i >= 0; --i)
      for (int k = i + 1; k <= j; ++k) column[i] -= f.at(k, i) * column[k];
    for (int i = 0; i <= j; ++i) side.to_motions[i * n + j] = column[i] / size[i];
  }
  return f.least;
}

/// (motions) This rank's products of their displacements of the nodes with f.
std::vector<double> products_with(const RigidSide &side, const Vector &f)
{
  std::vector<double> all;
  const auto node = side.node;
  const auto arm = side.arm;
  const auto from = device_read(f);
  const int dim = side.num_components;
  for (const int k : side.motions) {
    double sum = 0;
    Kokkos::parallel_reduce(
        "rpc::fem::products_with_motion", device_range(static_cast<LO>(node.extent(0))),
        KOKKOS_LAMBDA(const LO i, double &part) {
          for (int c = 0; c < dim; ++c) part += along_motion(k, &arm(3 * i), c) * from(dof(dim, node(i), c));
        },
        sum);
    all.push_back(sum);
  }
  return all;
}

SixNumbers spring_forces(const RigidSide &side, const SixNumbers &q)
{
  SixNumbers force{};
  for (std::size_t k = 0; k < side.unknown.size(); ++k)
    force[side.unknown[k]] = -side.stiffness[k] * q[side.unknown[k]];
  return force;
}

bool has_springs(const RigidSide &side)
{
  return std::any_of(side.stiffness.begin(), side.stiffness.end(), [](const double each) { return each > 0; });
}

} // namespace

std::vector<RigidSide> rigid_sides(const Discretization &d, const std::vector<DirichletCondition> &conditions)
{
  std::vector<RigidSide> sides;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const DirichletCondition &condition = conditions[k];
    if (!condition.rigid) continue;
    RigidSide side;
    side.condition = static_cast<int>(k);
    side.motions = condition.rigid->motions;
    side.unknown = condition.rigid->unknown();
    side.num_components = d.dim();
    for (const int motion : side.unknown) side.stiffness.push_back(condition.rigid->stiffness[motion]);
    const mesh::Side &of_mesh = rigid_side(d, condition);
    const std::vector<LO> nodes = d.mesh->nodes_of(condition.side, condition.path() + "->Side");
    side.node = device_values(nodes, "rpc::fem::rigid_nodes");
    const HostPoints x = middles_of_areas(*d.mesh, node_positions(*d.mesh, side.node));
    side.point = condition.rigid->point ? *condition.rigid->point : centroid(d, of_mesh, nodes, x);
    std::vector<double> arm;
    const std::size_t n = side.motions.size();
    side.products.assign(n * n, 0.);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      double here[3] = {0, 0, 0};
      for (int c = 0; c < d.dim(); ++c) here[c] = x(i, c) - side.point[c];
      arm.insert(arm.end(), here, here + 3);
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          for (int c = 0; c < d.dim(); ++c)
            side.products[a * n + b] += along_motion(side.motions[a], here, c) * along_motion(side.motions[b], here, c);
    }
    side.products = summed(d.mesh->comm(), side.products);
    side.arm = device_values(arm, "rpc::fem::rigid_arms");
    std::vector<double> of_unknown;
    const auto place = [&](const int motion) {
      return static_cast<std::size_t>(std::find(side.motions.begin(), side.motions.end(), motion) -
                                      side.motions.begin());
    };
    for (const int a : side.unknown)
      for (const int b : side.unknown) of_unknown.push_back(side.products[place(a) * n + place(b)]);
    const double told = side.unknown.empty() ? 1 : set_modes(side, of_unknown);
    RPC_REQUIRE(told > Alike::least_part,
                "deck: \"" << condition.path() << "->Point\" must be nearer to the side \"" << condition.side
                           << "\": from so far away, rotations move its nodes as displacements do, to rounding. Name a "
                              "point near the side, and give forces with their moments about it.");
    sides.push_back(std::move(side));
  }
  return sides;
}

double along_mode(const RigidSide &side, const int mode, const double *const arm, const int component)
{
  const int n = static_cast<int>(side.unknown.size());
  double sum = 0;
  for (int k = 0; k <= mode; ++k) sum += side.to_motions[k * n + mode] * along_motion(side.unknown[k], arm, component);
  return sum;
}

void add_springs(const std::vector<RigidSide> &sides, const int groups, std::vector<double> &stiffness)
{
  for (const RigidSide &side : sides) {
    const int n = static_cast<int>(side.unknown.size());
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        for (int k = 0; k < n; ++k)
          stiffness[(side.first_group + a) * groups + side.first_group + b] +=
              side.to_motions[k * n + a] * side.stiffness[k] * side.to_motions[k * n + b];
  }
}

void add_resultants(const RigidSide &side, const SixNumbers &given, Vector &f)
{
  const int n = static_cast<int>(side.motions.size());
  std::vector<double> wanted;
  for (const int k : side.motions) wanted.push_back(given[k]);
  if (std::all_of(wanted.begin(), wanted.end(), [](const double each) { return each == 0; })) return;
  const std::vector<double> part = solved(factored(side.products, n), wanted);
  Kokkos::Array<double, 6> along{};
  for (int k = 0; k < n; ++k) along[side.motions[k]] = part[k];
  const auto node = side.node;
  const auto arm = side.arm;
  const auto to = device_write(f);
  const int dim = side.num_components;
  Kokkos::parallel_for(
      "rpc::fem::add_resultants", device_range(static_cast<LO>(node.extent(0))), KOKKOS_LAMBDA(const LO i) {
        for (int c = 0; c < dim; ++c)
          for (int k = 0; k < 6; ++k)
            if (along[k] != 0) to(dof(dim, node(i), c)) += along[k] * along_motion(k, &arm(3 * i), c);
      });
  Kokkos::fence();
}

SixNumbers motions_of(const RigidSide &side, const Vector &u)
{
  const std::vector<double> q = solved(factored(side.products, static_cast<int>(side.motions.size())),
                                       summed(*u.getMap()->getComm(), products_with(side, u)));
  SixNumbers all{};
  for (std::size_t k = 0; k < q.size(); ++k) all[side.motions[k]] = q[k];
  return all;
}

SixNumbers resultants_on(const RigidSide &side, const DeviceView<int *> &condition, const Vector &f)
{
  Vector held(f, Teuchos::Copy);
  {
    const auto to = device_write(held);
    const int own = side.condition;
    Kokkos::parallel_for(
        "rpc::fem::forces_of_condition", device_range(static_cast<LO>(condition.extent(0))), KOKKOS_LAMBDA(const LO i) {
          if (condition(i) != own) to(i) = 0;
        });
    Kokkos::fence();
  }
  const std::vector<double> sums = summed(*f.getMap()->getComm(), products_with(side, held));
  SixNumbers all{};
  for (std::size_t k = 0; k < sums.size(); ++k) all[side.motions[k]] = sums[k];
  return all;
}

void subtract_spring_forces(const std::vector<RigidSide> &sides, const Vector &u, Vector &f)
{
  for (const RigidSide &side : sides) {
    if (!has_springs(side)) continue;
    SixNumbers force = spring_forces(side, motions_of(side, u));
    for (double &each : force) each = -each;
    add_resultants(side, force, f);
  }
}

double spring_energy(const std::vector<RigidSide> &sides, const Vector &u)
{
  double energy = 0;
  for (const RigidSide &side : sides) {
    if (!has_springs(side)) continue;
    const SixNumbers q = motions_of(side, u), force = spring_forces(side, q);
    for (int k = 0; k < 6; ++k) energy -= 0.5 * force[k] * q[k];
  }
  return energy;
}

} // namespace rpc::fem
