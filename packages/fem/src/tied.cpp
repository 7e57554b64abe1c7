// SPDX-License-Identifier: BSD-3-Clause
#include "tied.hpp"

#include "component_name.hpp"
#include "of_time_alone.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::fem
{

void require_of_time_alone(const ScalarField &force, const std::string &parameter, const std::string &remedy,
                           const std::string &why)
{
  for (const double t : {0.37, 1., 2.3}) {
    const ScalarField now = force.seen_at(t);
    const double here = now({0, 0, 0}), there = now({0.7, 1.3, 2.1});
    RPC_REQUIRE(here == there || (std::isnan(here) && std::isnan(there)),
                "deck: \"" << parameter << "\" must not depend on x, y or z, for " << why << ", got " << force.text
                           << ". " << remedy);
  }
}

std::vector<MovedByForce> moved_by_force(const std::vector<DirichletCondition> &conditions)
{
  std::vector<MovedByForce> moved;
  for (std::size_t k = 0; k < conditions.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (conditions[k].force[c]) moved.push_back({static_cast<int>(k), c});
  return moved;
}

void require_movable(const Discretization &d, const std::vector<DirichletCondition> &conditions)
{
  for (const auto &[k, c] : moved_by_force(conditions)) {
    const std::string path = "Dirichlet->" + conditions[k].name, parameter = path + "->Force " + component_name[c];
    const auto &points = d.mesh->points;
    RPC_REQUIRE(std::none_of(points.begin(), points.end(),
                             [&, k = k](const auto &each) { return each.name == conditions[k].side; }),
                "deck: \"" << parameter << "\" must move a side, got the point \"" << conditions[k].side
                           << "\". Press a side of some extent.");
    RPC_REQUIRE(
        !d.axisymmetric() || c == 1,
        "deck: \"" << parameter
                   << "\" moves a side of a body of revolution along its radius, which is no rigid motion. Give "
                      "Force Y, along the axis.");
  }
}

namespace
{

/// A group for each unknown motion of a rigid side, with the unknowns along components that move.
void add_groups(const Discretization &d, const RigidMotions &motions, RigidSide &side, TiedUnknowns &tied,
                std::vector<int> &group)
{
  const auto node = to_host(side.node);
  const auto arm = to_host(side.arm);
  const int modes = static_cast<int>(side.unknown.size());
  side.first_group = tied.size();
  std::vector<LO> members;
  std::vector<std::vector<double>> shapes(modes);
  std::vector<double> squares(modes, 0.);
  for (std::size_t i = 0; i < node.extent(0); ++i)
    for (int c = 0; c < d.dim(); ++c) {
      if (!motions.moves(c)) continue;
      members.push_back(dof(d.dim(), node(i), c));
      group[members.back()] = side.first_group;
      for (int j = 0; j < modes; ++j) {
        shapes[j].push_back(along_mode(side, j, &arm(3 * i), c));
        squares[j] += shapes[j].back() * shapes[j].back();
      }
    }
  squares = summed(d.mesh->comm(), squares);
  const auto of_side = device_values(members, "rpc::fem::tied");
  for (int j = 0; j < modes; ++j) {
    tied.members.push_back(of_side);
    tied.shape.push_back(device_values(shapes[j], "rpc::fem::tied_shape"));
    tied.square.push_back(squares[j]);
    tied.adds.push_back(j > 0 ? 1 : 0);
  }
}

} // namespace

std::shared_ptr<const TiedUnknowns> tied_unknowns(const Discretization &d,
                                                  const std::vector<DirichletCondition> &conditions,
                                                  const DeviceView<int *> &condition, std::vector<RigidSide> &rigid)
{
  const auto moved = moved_by_force(conditions);
  const auto floating = floating_components(conditions);
  const bool turns =
      std::any_of(rigid.begin(), rigid.end(), [](const RigidSide &side) { return !side.unknown.empty(); });
  if (moved.empty() && floating.empty() && !turns) return nullptr;
  auto tied = std::make_shared<TiedUnknowns>();
  const auto of = to_host(condition);
  std::vector<int> group(of.extent(0), -1);
  const auto add_group = [&](const int component, const auto &has) {
    std::vector<LO> members;
    for (std::size_t i = 0; i < of.extent(0); ++i) {
      if (of(i) < 0 || component_of(d.dim(), static_cast<LO>(i)) != component || !has(of(i))) continue;
      members.push_back(static_cast<LO>(i));
      group[i] = tied->size();
    }
    tied->square.push_back(static_cast<double>(sum_all(d.mesh->comm(), static_cast<GO>(members.size()))));
    tied->members.push_back(device_values(members, "rpc::fem::tied"));
    tied->shape.emplace_back();
    tied->adds.push_back(0);
  };
  for (const auto &one : moved) add_group(one.component, [&](const int k) { return k == one.condition; });
  for (const int c : floating) add_group(c, [&](const int k) { return conditions[k].floats[c]; });
  for (RigidSide &side : rigid)
    if (!side.unknown.empty()) add_groups(d, *conditions[side.condition].rigid, side, *tied, group);
  tied->group = device_values(group, "rpc::fem::tied_group");
  return tied;
}

void part_from_modes(const TiedUnknowns &tied, std::vector<RigidSide> &rigid, Vector &value)
{
  const std::vector<double> part = means(tied, value);
  for (RigidSide &side : rigid)
    for (std::size_t j = 0; j < side.unknown.size(); ++j) side.start.push_back(part[side.first_group + j]);
  Vector of_modes(value.getMap());
  set_members(tied, part, of_modes);
  value.update(-1., of_modes, 1.);
}

double add_spring_starts(const DirichletDofs &dirichlet, Vector &load)
{
  const TiedUnknowns &tied = *dirichlet.tied;
  const int n = tied.size();
  std::vector<double> stiffness(static_cast<std::size_t>(n) * n, 0.), start(n, 0.), force(n, 0.);
  add_springs(dirichlet.rigid, n, stiffness);
  for (const RigidSide &side : dirichlet.rigid)
    std::copy(side.start.begin(), side.start.end(), start.begin() + side.first_group);
  double energy = 0;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < n; ++k) force[j] += stiffness[j * n + k] * start[k];
    energy += 0.5 * start[j] * force[j];
    force[j] /= tied.square[j];
  }
  if (energy == 0) return 0;
  Vector forces(load.getMap());
  set_members(tied, force, forces);
  load.update(1., forces, 1.);
  return energy;
}

double finite_value(const ScalarField &given, const std::string &parameter)
{
  const double value = given({});
  RPC_REQUIRE(std::isfinite(value), "deck: \"" << parameter << "\" must be finite, got " << value << " from "
                                               << given.text << " at t = " << given.time);
  return value;
}

void add_moving_forces(const DirichletDofs &dirichlet, const std::vector<DirichletCondition> &conditions, Vector &load)
{
  if (!dirichlet.tied) return;
  const TiedUnknowns &tied = *dirichlet.tied;
  std::vector<double> share(tied.size(), 0.); // those that float have forces of their own
  int group = 0;
  for (const auto &[k, c] : moved_by_force(conditions)) {
    const double force = finite_value(*conditions[k].force[c], conditions[k].path() + "->" + name_of_force(c));
    share[group] = force / tied.square[group];
    ++group;
  }
  Vector forces(load.getMap());
  set_members(tied, share, forces);
  for (const RigidSide &side : dirichlet.rigid) add_resultants(side, given_forces(conditions[side.condition]), forces);
  load.update(1., forces, 1.);
}

SixNumbers given_forces(const DirichletCondition &condition)
{
  SixNumbers given{};
  for (int k = 0; k < 6; ++k)
    if (const auto &force = condition.rigid->force[k])
      given[k] = finite_value(*force, condition.path() + "->" + name_of_force(k));
  return given;
}

std::vector<int> floating_components(const std::vector<DirichletCondition> &conditions)
{
  std::vector<int> components;
  for (int c = 0; c < 3; ++c)
    if (std::any_of(conditions.begin(), conditions.end(), [c](const auto &each) { return each.floats[c]; }))
      components.push_back(c);
  return components;
}

bool DirichletDofs::has_springs() const
{
  const auto any = [](const std::vector<double> &stiffness) {
    return std::any_of(stiffness.begin(), stiffness.end(), [](const double each) { return each > 0; });
  };
  return any(float_stiffness) ||
         std::any_of(rigid.begin(), rigid.end(), [&](const RigidSide &side) { return any(side.stiffness); });
}

void subtract_spring_forces(const DirichletDofs &dirichlet, const Vector &u, Vector &f)
{
  if (!dirichlet.has_springs()) return;
  subtract_spring_forces(dirichlet.rigid, u, f);
  if (dirichlet.float_stiffness.empty()) return;
  const TiedUnknowns &tied = *dirichlet.tied;
  const std::vector<double> moved = means(tied, u);
  std::vector<double> share(tied.size(), 0.);
  for (std::size_t j = 0; j < dirichlet.float_stiffness.size(); ++j) {
    const std::size_t group = dirichlet.first_floating + j;
    share[group] = dirichlet.float_stiffness[j] * moved[group] / tied.square[group];
  }
  Vector forces(f.getMap());
  set_members(tied, share, forces);
  f.update(1., forces, 1.);
}

RCP<Vector> forces_on_floating(const Discretization &d, const DirichletDofs &dirichlet,
                               const std::vector<DirichletCondition> &conditions, const std::array<double, 3> &force)
{
  const TiedUnknowns &tied = *dirichlet.tied;
  std::vector<double> share(tied.size(), 0.);
  std::size_t group = moved_by_force(conditions).size();
  for (const int c : floating_components(conditions)) {
    share[group] = force[c] / tied.square[group];
    ++group;
  }
  const auto forces = rcp(new Vector(d.owned_dofs));
  set_members(tied, share, *forces);
  return forces;
}

namespace
{

/// (owned dofs) The forces where a group moves by 1, and nothing else does; 0 at prescribed unknowns that are no members.
RCP<Vector> forces_of_group(const Discretization &d, const PrescribedCouplings &K, const DirichletDofs &dirichlet,
                            const int group)
{
  const auto moved = rcp(new Vector(d.owned_dofs)), force = rcp(new Vector(d.owned_dofs));
  std::vector<double> unit(dirichlet.tied->size(), 0.);
  unit[group] = 1;
  set_members(*dirichlet.tied, unit, *moved);
  const auto at_overlap = on_overlap(d, *moved);
  const auto u = device_read(*at_overlap);
  const auto to = device_write(*force);
  const auto fixed = dirichlet.fixed;
  const auto of = dirichlet.tied->group;
  Kokkos::parallel_for(
      "rpc::fem::forces_of_group", device_range(static_cast<LO>(K.row.extent(0))), KOKKOS_LAMBDA(const LO i) {
        const LO row = K.row(i);
        if (fixed(row) && of(row) < 0) return;
        double sum = 0;
        for (std::size_t k = K.begin(i); k < K.begin(i + 1); ++k) sum += K.value(k) * u(K.column(k));
        to(row) = sum;
      });
  Kokkos::fence();
  return force;
}

} // namespace

RCP<const TiedStiffness> tied_stiffness(const Discretization &d, const PrescribedCouplings &couplings,
                                        const DirichletDofs &dirichlet, RCP<const StiffnessOperator> K)
{
  if (!dirichlet.tied) return Teuchos::null;
  std::vector<RCP<Vector>> force;
  for (int j = 0; j < dirichlet.tied->size(); ++j) force.push_back(forces_of_group(d, couplings, dirichlet, j));
  const int n = dirichlet.tied->size();
  std::vector<double> springs(static_cast<std::size_t>(n) * n, 0.);
  add_springs(dirichlet.rigid, n, springs);
  for (std::size_t j = 0; j < dirichlet.float_stiffness.size(); ++j) {
    const std::size_t group = dirichlet.first_floating + j;
    springs[group * n + group] += dirichlet.float_stiffness[j];
  }
  return rcp(new TiedStiffness(std::move(K), *dirichlet.tied, std::move(force), springs));
}

} // namespace rpc::fem
