// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/rigid_motion.hpp"

#include "point_text.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::fem
{
namespace
{

// Searches for motions end with so much of a part's radius between them and what is meant, such as (8e-6, -1, 0).
constexpr double known_to = 1e-4;

double norm(const RigidMotion &a)
{
  return std::sqrt(dot(a, a));
}

/// a -= (a.unit) unit for each; twice, so that the rest is orthogonal to rounding.
RigidMotion without(RigidMotion a, const std::vector<RigidMotion> &units)
{
  for (int pass = 0; pass < 2; ++pass)
    for (const RigidMotion &unit : units) {
      const double part = dot(a, unit);
      for (int k = 0; k < 6; ++k) a[k] -= part * unit[k];
    }
  return a;
}

/// Which rows independent_rows() picks, and the orthonormal basis of their span.
struct Picked {
  std::vector<RigidMotion> rows, units;
};
Picked pick(const std::vector<RigidMotion> &rows, const double tolerance)
{
  Picked picked;
  std::vector<RigidMotion> rest = rows;
  while (picked.rows.size() < 6) {
    std::size_t best = rows.size();
    double largest = tolerance;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (!picked.units.empty()) rest[i] = without(rest[i], {picked.units.back()});
      const double size = norm(rest[i]);
      if (!(size > largest)) continue;
      largest = size;
      best = i;
    }
    if (best == rows.size()) break;
    RigidMotion unit = without(rest[best], picked.units);
    const double size = norm(unit);
    for (double &entry : unit) entry /= size;
    picked.rows.push_back(rows[best]);
    picked.units.push_back(unit);
  }
  return picked;
}

RigidMotion combination(const std::vector<RigidMotion> &space, const RigidMotion &coefficients)
{
  RigidMotion sum{};
  for (std::size_t j = 0; j < space.size(); ++j)
    for (int k = 0; k < 6; ++k) sum[k] += coefficients[j] * space[j][k];
  return sum;
}

/// omega of r(x) = t + omega x (x - centre) [1/m]; in 2D its z component.
Point angular_velocity(const RigidMotion &q, const double radius, const int dim)
{
  if (dim == 2) return {0, 0, q[2] / radius};
  return {q[5] / radius, -q[4] / radius, q[3] / radius};
}

/// Lists the owned nodes with a prescribed unknown, ascending. @return how many there are; an empty list stays empty
LO list_held_nodes(const DeviceView<char *> &fixed, const int dim, const LO num_owned, const DeviceView<LO *> &list)
{
  LO count = 0;
  Kokkos::parallel_scan(
      "rpc::fem::held_nodes", device_range(num_owned),
      KOKKOS_LAMBDA(const LO n, LO &at, const bool last) {
        bool held = false;
        for (int c = 0; c < dim; ++c) held = held || fixed(dof(dim, n, c));
        if (!held) return;
        if (last && list.extent(0) > 0) list(at) = n;
        ++at;
      },
      count);
  return count;
}

DeviceView<LO *> held_nodes(const DirichletDofs &dirichlet, const int dim, const LO num_owned)
{
  const DeviceView<LO *> nodes("rpc::fem::held_nodes", list_held_nodes(dirichlet.fixed, dim, num_owned, {}));
  list_held_nodes(dirichlet.fixed, dim, num_owned, nodes);
  return nodes;
}

/// (nodes, dim + 1) 1 for prescribed components, else 0; then the node's part.
DeviceView<int **> what_is_held(const DirichletDofs &dirichlet, const Parts &parts, const DeviceView<LO *> &nodes,
                                const int dim)
{
  const DeviceView<int **> held("rpc::fem::what_is_held", nodes.extent(0), dim + 1);
  const auto fixed = dirichlet.fixed;
  const auto group = dirichlet.tied ? dirichlet.tied->group : DeviceView<int *>();
  const auto of_node = parts.of_node;
  Kokkos::parallel_for(
      "rpc::fem::what_is_held", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO i) {
        for (int c = 0; c < dim; ++c) {
          const LO unknown = dof(dim, nodes(i), c);
          held(i, c) = fixed(unknown) && !(group.extent(0) > 0 && group(unknown) >= 0) ? 1 : 0;
        }
        held(i, dim) = of_node(nodes(i));
      });
  return held;
}

/// What tied unknowns stop: motions that move two nodes of a group by different amounts. @throws rpc::Error (bad_input) where a group is of several
/// parts, which it joins; collective
void add_rows_of_tied(const Discretization &d, const Parts &parts, const DirichletDofs &dirichlet,
                      std::vector<std::vector<RigidMotion>> &rows)
{
  const int dim = d.dim();
  const Comm &comm = d.mesh->comm();
  const TiedUnknowns &tied = *dirichlet.tied;
  const auto of_node = to_host(parts.of_node);
  int of_forces = tied.size(); // the groups of rigid sides follow
  for (const RigidSide &side : dirichlet.rigid) of_forces -= static_cast<int>(side.unknown.size());
  for (int j = 0; j < of_forces; ++j) {
    const auto members = to_host(tied.members[j]);
    std::vector<LO> nodes;
    int first = parts.size(), last = -1, component = 0;
    for (std::size_t i = 0; i < members.extent(0); ++i) {
      nodes.push_back(node_of(dim, members(i)));
      component = component_of(dim, members(i));
      first = std::min(first, of_node(nodes.back()));
      last = std::max(last, of_node(nodes.back()));
    }
    first = min_all(comm, first);
    last = max_all(comm, last);
    component = max_all(comm, component);
    RPC_REQUIRE(first == last,
                "deck: a force of \"Dirichlet\" moves a side of several parts of the body as one. Name a side of each "
                "part, with a force for each. An obstacle that a force moves goes with a body of one part alone.");
    const HostPoints x = node_positions(*d.mesh, device_values(nodes, "rpc::fem::tied_nodes"));
    std::vector<double> middle(dim, 0.);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int c = 0; c < dim; ++c) middle[c] += x(i, c) / tied.square[j];
    middle = summed(comm, middle);
    const int floating = j - dirichlet.first_floating;
    if (floating >= 0 && dirichlet.float_stiffness[floating] > 0) { // its spring stops the mean
      const Part &part = parts.part[last];
      double arm[3] = {0, 0, 0}, unit[3] = {0, 0, 0};
      for (int c = 0; c < dim; ++c) arm[c] = (middle[c] - part.centre[c]) / part.radius;
      unit[component] = 1;
      RigidMotion row{};
      along_modes(dim, arm, unit, row.data());
      rows[last].push_back(row);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Part &part = parts.part[last];
      double arm[3] = {0, 0, 0}, unit[3] = {0, 0, 0};
      for (int c = 0; c < dim; ++c) arm[c] = (x(i, c) - middle[c]) / part.radius;
      unit[component] = 1;
      RigidMotion row{};
      along_modes(dim, arm, unit, row.data());
      std::fill(row.begin(), row.begin() + dim, 0.); // translations move all by the same amount
      rows[last].push_back(row);
    }
  }
}

/// What rigid sides with unknown motions stop: those of their motions that are prescribed, or have springs. @throws rpc::Error (bad_input) where
/// one is of several parts, which it joins; collective
void add_rows_of_rigid(const Discretization &d, const Parts &parts, const std::vector<RigidSide> &sides,
                       std::vector<std::vector<RigidMotion>> &rows)
{
  const int dim = d.dim();
  const auto of_node = to_host(parts.of_node);
  for (const RigidSide &side : sides) {
    if (side.unknown.empty()) continue;
    const auto node = to_host(side.node);
    int first = parts.size(), last = -1;
    for (std::size_t i = 0; i < node.extent(0); ++i) {
      first = std::min(first, of_node(node(i)));
      last = std::max(last, of_node(node(i)));
    }
    first = min_all(d.mesh->comm(), first);
    last = max_all(d.mesh->comm(), last);
    RPC_REQUIRE(first == last,
                "deck: a rigid side of \"Rigid\" is of several parts of the body and joins them. Name a side of "
                "each part, with an entry for each.");
    const Part &part = parts.part[last];
    for (const int motion : side.motions) {
      const auto place = std::find(side.unknown.begin(), side.unknown.end(), motion);
      if (place != side.unknown.end() && side.stiffness[place - side.unknown.begin()] == 0) continue;
      RigidMotion row{};
      if (motion < 3) {
        double arm[3] = {0, 0, 0}, unit[3] = {0, 0, 0};
        for (int c = 0; c < dim; ++c) arm[c] = (side.point[c] - part.centre[c]) / part.radius;
        unit[motion] = 1;
        along_modes(dim, arm, unit, row.data());
      } else { // rotations of (9.1) are in the planes of (x, y), (x, z), (y, z)
        row[dim == 2 ? 2 : 5 - (motion - 3)] = 1;
      }
      rows[last].push_back(row);
    }
  }
}

} // namespace

std::vector<RigidMotion> independent_rows(const std::vector<RigidMotion> &rows, const double tolerance)
{
  return pick(rows, tolerance).rows;
}

std::vector<std::vector<RigidMotion>>
independent_rows_of_all(const Comm &comm, const std::vector<std::vector<RigidMotion>> &rows, const double tolerance)
{
  const std::size_t num_lists = rows.size();
  std::vector<double> mine(num_lists * 36, 0.), all(mine.size() * comm.getSize());
  std::vector<std::vector<RigidMotion>> picked(num_lists);
  for (std::size_t list = 0; list < num_lists; ++list) {
    picked[list] = independent_rows(rows[list], tolerance);
    for (std::size_t i = 0; i < picked[list].size(); ++i)
      std::copy(picked[list][i].begin(), picked[list][i].end(), &mine[36 * list + 6 * i]);
  }
  if (comm.getSize() == 1) return picked;
  // What each rank has picked, raw: remainders would carry their rounding to the other ranks.
  Teuchos::gatherAll(comm, static_cast<int>(mine.size()), mine.data(), static_cast<int>(all.size()), all.data());
  for (std::size_t list = 0; list < num_lists; ++list) {
    std::vector<RigidMotion> together(6 * comm.getSize());
    for (int rank = 0; rank < comm.getSize(); ++rank)
      for (int i = 0; i < 6; ++i)
        std::copy_n(&all[mine.size() * rank + 36 * list + 6 * i], 6, together[6 * rank + i].begin());
    picked[list] = independent_rows(together, tolerance);
  }
  return picked;
}

std::vector<RigidMotion> null_space(const std::vector<RigidMotion> &rows, const std::vector<RigidMotion> &space,
                                    const double tolerance)
{
  std::vector<RigidMotion> inside; // rows in the coordinates of the space
  for (const RigidMotion &row : rows) {
    RigidMotion coefficients{};
    for (std::size_t j = 0; j < space.size(); ++j) coefficients[j] = dot(row, space[j]);
    inside.push_back(coefficients);
  }
  std::vector<RigidMotion> units = pick(inside, tolerance).units;
  std::vector<RigidMotion> basis;
  while (units.size() < space.size()) { // completed by what is left of the unit vectors
    RigidMotion best{};
    for (std::size_t j = 0; j < space.size(); ++j) {
      RigidMotion unit{};
      unit[j] = 1;
      const RigidMotion rest = without(unit, units);
      if (norm(rest) > norm(best) * (1 + 1e-12)) best = rest;
    }
    const double size = norm(best);
    for (double &entry : best) entry /= size;
    units.push_back(best);
    basis.push_back(combination(space, best));
  }
  return basis;
}

std::vector<RigidMotion> all_motions(const int dim, const Kinematics kinematics)
{
  if (kinematics == Kinematics::axisymmetric) return {{0, 1}};
  std::vector<RigidMotion> units(num_rigid_modes(dim), RigidMotion{});
  for (std::size_t k = 0; k < units.size(); ++k) units[k][k] = 1;
  return units;
}

std::vector<RigidMotion> all_motions(const Discretization &d)
{
  auto motions = all_motions(d.dim(), d.kinematics);
  const mesh::BoxOptions *const box = d.mesh->box.get();
  if (!box || !mesh::periodic(*box)) return motions;
  int mode = d.dim();
  std::vector<RigidMotion> kept(motions.begin(), motions.begin() + d.dim());
  for (int i = 0; i < d.dim(); ++i)
    for (int j = i + 1; j < d.dim(); ++j, ++mode)
      if (!box->wraps(i) && !box->wraps(j)) kept.push_back(motions[mode]);
  return kept;
}

std::vector<std::vector<RigidMotion>> free_motions(const Discretization &d, const Parts &parts,
                                                   const DirichletDofs &dirichlet)
{
  const mesh::Mesh &mesh = *d.mesh;
  const int dim = d.dim();
  const DeviceView<LO *> nodes = held_nodes(dirichlet, dim, mesh.num_owned_nodes());
  const HostPoints x = node_positions(mesh, nodes);
  const auto held = to_host(what_is_held(dirichlet, parts, nodes, dim));
  std::vector<std::vector<RigidMotion>> rows(parts.size());
  for (std::size_t n = 0; n < x.extent(0); ++n) {
    const int p = held(n, dim);
    for (int i = 0; i < dim; ++i) {
      if (!held(n, i)) continue;
      const Part &part = parts.part[p];
      double arm[3] = {0, 0, 0}, unit[3] = {0, 0, 0};
      for (int c = 0; c < dim; ++c) arm[c] = (x(n, c) - part.centre[c]) / part.radius;
      unit[i] = 1;
      RigidMotion row{};
      along_modes(dim, arm, unit, row.data());
      rows[p].push_back(row);
    }
  }
  if (dirichlet.tied) add_rows_of_tied(d, parts, dirichlet, rows);
  add_rows_of_rigid(d, parts, dirichlet.rigid, rows);
  rows = independent_rows_of_all(mesh.comm(), rows, rigid_tolerance);
  std::vector<std::vector<RigidMotion>> motions;
  for (const auto &stopped : rows) motions.push_back(null_space(stopped, all_motions(d), rigid_tolerance));
  return motions;
}

std::vector<Resultant> resultants(const Discretization &d, const Parts &parts, const Vector &force)
{
  const int dim = d.dim();
  DeviceView<double *[7]> sums("rpc::fem::resultants", parts.size());
  const auto coords = d.mesh->coords;
  const auto of_node = parts.of_node;
  const auto centre = parts.centre;
  const auto radius = parts.radius;
  const auto f = device_read(force);
  Kokkos::parallel_for(
      "rpc::fem::resultants", device_range(d.mesh->num_owned_nodes()), KOKKOS_LAMBDA(const LO n) {
        double arm[3] = {0, 0, 0}, at[3] = {0, 0, 0}, along[6], size = 0;
        const int p = of_node(n);
        for (int c = 0; c < dim; ++c) {
          arm[c] = (coords(n, c) - centre(p, c)) / radius(p);
          at[c] = f(dof(dim, n, c));
          size += at[c] < 0 ? -at[c] : at[c];
        }
        if (size == 0) return;
        along_modes(dim, arm, at, along);
        for (int k = 0; k < 6; ++k) add_shared(sums(p, k), along[k]);
        add_shared(sums(p, 6), size);
      });
  const auto host = to_host(sums);
  std::vector<double> mine(7 * parts.size());
  for (std::size_t k = 0; k < mine.size(); ++k) mine[k] = host(k / 7, k % 7);
  const std::vector<double> all = summed(d.mesh->comm(), mine);
  std::vector<Resultant> result(parts.size());
  for (int p = 0; p < parts.size(); ++p) {
    std::copy_n(&all[7 * p], 6, result[p].force.begin());
    result[p].magnitude = all[7 * p + 6];
  }
  return result;
}

std::vector<RigidMotion> readable_basis(std::vector<RigidMotion> motions, const int dim)
{
  // Reduced row echelon form with the rotations' columns first: the rows that get no pivot there are translations.
  std::size_t done = 0;
  const int modes = num_rigid_modes(dim);
  for (int step = 0; step < modes && done < motions.size(); ++step) {
    const int column = step < modes - dim ? dim + step : step - (modes - dim);
    const auto larger = [column](const RigidMotion &a, const RigidMotion &b) {
      return std::abs(a[column]) < std::abs(b[column]);
    };
    std::swap(*std::max_element(motions.begin() + done, motions.end(), larger), motions[done]);
    RigidMotion &pivot = motions[done];
    const double value = pivot[column];
    if (!(std::abs(value) > 1e-6)) continue;
    for (double &entry : pivot) entry /= value;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const double factor = motions[i][column];
      for (int k = 0; i != done && k < 6; ++k) motions[i][k] -= factor * pivot[k];
    }
    ++done;
  }
  const auto turns = [dim](const RigidMotion &q) {
    return std::any_of(q.begin() + dim, q.end(), [](const double entry) { return std::abs(entry) > 1e-6; });
  };
  std::stable_partition(motions.begin(), motions.end(), [&](const RigidMotion &q) { return !turns(q); });
  return motions;
}

std::string place_in_words(const Point &x, const Part &part, const int dim)
{
  return rounded_point_text(x, dim, std::pow(10, std::floor(std::log10(known_to * part.radius))));
}

MotionInWords in_words(const RigidMotion &q, const Part &part, const int dim)
{
  const Point t{q[0], q[1], dim == 3 ? q[2] : 0.};
  const Point omega = angular_velocity(q, part.radius, dim);
  MotionInWords words;
  words.rotates = length(omega) * part.radius > 1e-6 * length(t);
  words.size = words.rotates ? length(omega) : length(t);
  if (!words.rotates) {
    words.where = "along " + rounded_point_text(scaled(1 / words.size, t), dim, known_to);
    return words;
  }
  // r = 0 at centre + omega x t / |omega|^2, in 3D up to the advance along the axis
  const Point offset = scaled(1 / (words.size * words.size), cross(omega, t));
  const Point at{part.centre[0] + offset[0], part.centre[1] + offset[1], part.centre[2] + offset[2]};
  const std::string place = place_in_words(at, part, dim);
  if (dim == 2) {
    words.where = "about " + place + (omega[2] > 0 ? ", counterclockwise" : ", clockwise");
    return words;
  }
  const Point axis = scaled(1 / words.size, omega);
  words.where = "about the axis through " + place + " along " + rounded_point_text(axis, dim, known_to);
  const double advance = (t[0] * axis[0] + t[1] * axis[1] + t[2] * axis[2]) / words.size;
  if (std::abs(advance) > 1e-6 * part.radius) {
    std::ostringstream screw;
    screw << " that advances " << advance << " m per radian";
    words.where += screw.str();
  }
  return words;
}

} // namespace rpc::fem
