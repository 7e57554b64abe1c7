// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/line_models.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

namespace rpc::test
{

/// A line model of given kinks, all on rank 0, at points with one unknown each; the elastic part is slope(0) and curvature.
struct KinkedLine {
  contact::SmoothedPoints points;
  RCP<Vector> u, d;

  explicit KinkedLine(const int n, const unsigned seed)
  {
    const auto comm = Tpetra::getDefaultComm();
    const int mine = comm->getRank() == 0 ? n : 0;
    const auto fill = [mine](const std::string &label, auto &&value) {
      HostView<double *> host(label, mine);
      for (int i = 0; i < mine; ++i) host(i) = value(i);
      return to_device(host);
    };
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1), sign(-1, 1);
    contact::ContactNodes &nodes = points.points;
    nodes.dim = 1;
    HostView<LO *> node("node", mine);
    for (int i = 0; i < mine; ++i) node(i) = i;
    nodes.node = to_device(node);
    nodes.direction = DeviceView<double **>("direction", mine, 1);
    Kokkos::deep_copy(nodes.direction, 1.);
    nodes.free_gap = DeviceView<double *>("free_gap", mine);
    nodes.fixed = DeviceView<char *>("fixed", mine);
    nodes.weight = fill("weight", [&](int) { return 0.1 + unit(random); });
    nodes.law.yield = fill(
        "yield", [&](int) { return unit(random) < 0.1 ? std::numeric_limits<double>::infinity() : 1 + unit(random); });
    nodes.law.hardening = fill("hardening", [](int) { return 0.; });
    nodes.law.compliance = fill("compliance", [](int) { return 0.; });
    points.penalty = fill("penalty", [&](int) { return std::pow(10, 8 * unit(random)); }); // kinks at all scales
    u = rcp(new Vector(rcp(new Map(n, mine, 0, comm))));
    d = rcp(new Vector(u->getMap()));
    for (Vector *const x : {u.get(), d.get()}) {
      const auto to = x->getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (int i = 0; i < mine; ++i) to(i, 0) = sign(random);
    }
    points.multiplier.normal = fill("lambda", [&](int) { return unit(random); });
  }
  std::unique_ptr<LineFunction> model(const double slope, const double curvature) const
  {
    return contact::line_model(Tpetra::getDefaultComm(), slope, curvature, points, *u, *d);
  }
};

} // namespace rpc::test
