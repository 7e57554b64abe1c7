// SPDX-License-Identifier: BSD-3-Clause
// A block pressed onto a rigid-plastic foundation, and onto an obstacle of its own, from C++: contact force and pressures.
#include "ridge.hpp"

#include <Tpetra_Core.hpp>
#include <iostream>
#include <rpc/analysis/load_history.hpp>
#include <rpc/mesh/box.hpp>

int main(int argc, char **argv)
{
  const Tpetra::ScopeGuard scope(&argc, &argv);
  rpc::mesh::BoxOptions box; // 2 m x 1 m
  box.lower = {0, 0};
  box.upper = {2, 1};
  box.cells = {32, 16};
  const auto mesh = std::make_shared<rpc::mesh::Mesh>(rpc::mesh::make_box(box, Tpetra::getDefaultComm()));

  rpc::analysis::Model model;
  model.materials = rpc::fem::Material{2000, 0.3}; // E [Pa], nu
  model.dirichlet = {{"left", "left", {rpc::ScalarField(0.), std::nullopt, std::nullopt}}};
  const rpc::ScalarField push("push", [](const rpc::Point &x, double t) { return -5 * t * (1 + x[0]); }); // [Pa]
  model.tractions = {{"top", "top", {rpc::ScalarField(0.), push, rpc::ScalarField(0.)}}};
  rpc::contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.yield_stress = rpc::ScalarField(14.); // [Pa]
  model.contact = {foundation};

  // Each step starts from the one before, on the dents that it has left.
  rpc::analysis::LoadHistory history(std::make_shared<rpc::analysis::Problem>(mesh, model), {}, 6);
  for (const double t : {0.5, 1.}) {
    const auto solution = history.advance(t);
    if (!solution.uzawa.converged) return 1;
    const auto pressure = rpc::to_host(solution.contact.pressure);
    std::cout << "t = " << t << ": contact force " << solution.contact.total.force[1] << " N/m, largest pressure "
              << solution.contact.total.max_pressure << " Pa, " << solution.contact.total.yielded_length
              << " m yield, pressure at the first of this rank's " << pressure.extent(0) << " contact nodes "
              << (pressure.extent(0) > 0 ? pressure(0) : 0) << " Pa" << std::endl;
  }

  model.contact[0].obstacle = {Ridge{0.01}, {1, 0, 0}};
  const auto on_ridge =
      rpc::analysis::LoadHistory(std::make_shared<rpc::analysis::Problem>(mesh, model), {}, 6).advance(1);
  if (!on_ridge.uzawa.converged) return 1;
  std::cout << "on a ridge: contact force " << on_ridge.contact.total.force[1] << " N/m, on "
            << on_ridge.contact.total.contact_length << " m" << std::endl;
}
