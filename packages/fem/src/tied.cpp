// SPDX-License-Identifier: BSD-3-Clause
#include "tied.hpp"

#include "component_name.hpp"
#include "of_time_alone.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::fem
{

void require_of_time_alone(const ScalarField &force, const std::string &parameter, const std::string &remedy)
{
  for (const double t : {0.37, 1., 2.3}) {
    const ScalarField now = force.seen_at(t);
    const double here = now({0, 0, 0}), there = now({0.7, 1.3, 2.1});
    RPC_REQUIRE(here == there || (std::isnan(here) && std::isnan(there)),
                "deck: \"" << parameter
                           << "\" must not depend on x, y or z, for it is the force on the whole side, got "
                           << force.text << ". " << remedy);
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

std::shared_ptr<const TiedUnknowns> tied_unknowns(const Discretization &d,
                                                  const std::vector<DirichletCondition> &conditions,
                                                  const DeviceView<int *> &condition)
{
  const auto moved = moved_by_force(conditions);
  if (moved.empty()) return nullptr;
  auto tied = std::make_shared<TiedUnknowns>();
  const auto of = to_host(condition);
  std::vector<int> group(of.extent(0), -1);
  for (const auto &[k, c] : moved) {
    std::vector<LO> members;
    for (std::size_t i = 0; i < of.extent(0); ++i) {
      if (of(i) != k || component_of(d.dim(), static_cast<LO>(i)) != c) continue;
      members.push_back(static_cast<LO>(i));
      group[i] = tied->size();
    }
    tied->count.push_back(sum_all(d.mesh->comm(), static_cast<GO>(members.size())));
    tied->members.push_back(device_values(members, "rpc::fem::tied"));
  }
  tied->group = device_values(group, "rpc::fem::tied_group");
  return tied;
}

void add_moving_forces(const DirichletDofs &dirichlet, const std::vector<DirichletCondition> &conditions, Vector &load)
{
  if (!dirichlet.tied) return;
  const TiedUnknowns &tied = *dirichlet.tied;
  std::vector<double> share;
  for (const auto &[k, c] : moved_by_force(conditions)) {
    const ScalarField &given = *conditions[k].force[c];
    const double force = given({});
    RPC_REQUIRE(std::isfinite(force), "deck: \"Dirichlet->" << conditions[k].name << "->Force " << component_name[c]
                                                            << "\" must be finite, got " << force << " from "
                                                            << given.text << " at t = " << given.time);
    share.push_back(force / static_cast<double>(tied.count[share.size()]));
  }
  Vector forces(load.getMap());
  set_members(tied, share, forces);
  load.update(1., forces, 1.);
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
  return rcp(new TiedStiffness(std::move(K), *dirichlet.tied, std::move(force)));
}

} // namespace rpc::fem
