// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "foundation_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

/// What holds of the smoothed functional for any foundation.
namespace rpc::test
{

/// u + t d
inline RCP<Vector> plus(const Vector &u, const double t, const Vector &d)
{
  const auto sum = rcp(new Vector(u, Teuchos::Copy));
  sum->update(t, d, 1.);
  return sum;
}

/// |H d - (F(u + h d) - F(u - h d)) / 2h|_2 / |H d|_2 for the Hessian that is in the matrix.
inline double hessian_error(const contact::Iterate &iterate, const Vector &u, const Vector &d)
{
  Vector Hd(u.getMap()), up(u.getMap()), down(u.getMap());
  iterate.hessian()->apply(d, Hd);
  const double h = 1e-5; // keeps each node on its piece
  iterate.gradient(*plus(u, h, d), up);
  iterate.gradient(*plus(u, -h, d), down);
  up.update(-1., down, 1.);
  up.update(-1., Hd, 1 / (2 * h));
  return up.norm2() / Hd.norm2();
}

/// The functional falls in each of so many sweeps, after which the gradient along all contact directions is below the bound [N].
inline void expect_sweeps_to_balance(const Scene &scene, const int sweeps, const double bound)
{
  const auto u = scene.vector(0.02, 0.3);
  double before = scene.iterate->value(*u);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    scene.iterate->sweep(*u);
    const double now = scene.iterate->value(*u);
    EXPECT_LE(now, before + 1e-13 * std::abs(before)) << sweep;
    before = now;
  }
  Vector F(u->getMap());
  scene.iterate->gradient(*u, F);
  const auto f = F.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto &c = scene.iterate->points();
  const auto node = to_host(c.node);
  const auto m = to_host(c.direction);
  for (LO i = 0; i < c.size(); ++i) {
    const double along = m(i, 0) * f(2 * node(i), 0) + m(i, 1) * f(2 * node(i) + 1, 0);
    EXPECT_LT(std::abs(along), bound) << i;
  }
}

/// A line's model from `from` along d has the functional's slope, and the curvature that differences of its slope give.
inline void expect_line(const LineFunction &line, const contact::Iterate &iterate, const Vector &from, const Vector &d)
{
  for (const double t : {0., 0.3, 0.77, 1., 1.9, -0.6, -2.}) {
    Vector G(from.getMap());
    iterate.gradient(*plus(from, t, d), G);
    EXPECT_NEAR(line.at(t).slope, G.dot(d), 1e-12 * G.norm2() * d.norm2()) << t;
    const double h = 1e-7;
    const double bend = (line.at(t + h).slope - line.at(t - h).slope) / (2 * h);
    EXPECT_NEAR(line.at(t).curvature, bend, 1e-5 * std::abs(bend)) << t;
  }
}

/// The model of a line through u along d.
inline void expect_line_model(contact::Iterate &iterate, const Vector &u, const Vector &d)
{
  Vector F(u.getMap());
  iterate.gradient(u, F);
  expect_line(*iterate.along(u, d, F), iterate, u, d);
}

/// The model of a line in the span of some directions, from a point there other than u.
inline void expect_lines_within(contact::Iterate &iterate, const Vector &u,
                                const std::vector<RCP<const Vector>> &directions)
{
  Vector F(u.getMap());
  iterate.gradient(u, F);
  const auto model = iterate.within(u, directions, F);
  std::vector<double> a, direction;
  Vector from(u, Teuchos::Copy), d(u.getMap());
  for (std::size_t k = 0; k < directions.size(); ++k) {
    a.push_back(0.5 - 0.4 * double(k));
    direction.push_back(0.4 * std::cos(2. * double(k)));
    from.update(a[k], *directions[k], 1.);
    d.update(direction[k], *directions[k], 1.);
  }
  expect_line(*model->along(a, model->at(a), direction), iterate, from, d);
}

} // namespace rpc::test
