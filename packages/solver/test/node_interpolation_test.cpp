// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/node_interpolation.hpp"

#include "lines.hpp"
#include "rpc/core/device_values.hpp"

#include <gtest/gtest.h>

namespace node_interpolation_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using solver::NodeInterpolation;

/// From a coarse line to a fine one, two unknowns a node; some unknowns of both are prescribed.
struct Pair {
  static constexpr int num_fine = 21, num_coarse = 9; // not nested
  Dense dense = dense_interpolation(num_fine, num_coarse);
  RCP<const Map> fine = line_of(num_fine), coarse = line_of(num_coarse);
  RCP<const Map> fine_dofs = unknowns_of(*fine), coarse_dofs = unknowns_of(*coarse);
  RCP<const CrsMatrix> P = distributed(dense, fine, coarse);

  static bool is_prescribed(const GO unknown) { return unknown % 7 == 3; }
  static DeviceView<char *> prescribed(const Map &dofs)
  {
    std::vector<char> held;
    for (LO i = 0; i < num_local(dofs); ++i) held.push_back(is_prescribed(dofs.getGlobalElement(i)));
    return device_values(held, "prescribed");
  }
  NodeInterpolation interpolation() const { return {P, 2, prescribed(*fine_dofs), prescribed(*coarse_dofs)}; }
  /// (P x)_i by hand.
  double at(const GO unknown, const double phase) const
  {
    double sum = 0;
    for (int j = 0; j < num_coarse; ++j)
      sum += dense(node_of(2, unknown), j) * wave(dof<GO>(2, j, component_of(2, unknown)), phase);
    return sum;
  }
};

TEST(NodeInterpolation, ActsOnEachComponentAlike)
{
  const Pair pair;
  Vector y = wave_on(pair.fine_dofs, 5); // what was there does not count
  pair.interpolation().prolong(wave_on(pair.coarse_dofs, 0.4), y, NodeInterpolation::Write::replace);
  const auto found = y.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO i = 0; i < num_local(*pair.fine_dofs); ++i) {
    const GO unknown = pair.fine_dofs->getGlobalElement(i);
    EXPECT_NEAR(found(i, 0), Pair::is_prescribed(unknown) ? 0 : pair.at(unknown, 0.4), 1e-15) << unknown;
  }
}

TEST(NodeInterpolation, AddsToWhatIsThereButWherePrescribed)
{
  const Pair pair;
  Vector y = wave_on(pair.fine_dofs, 5);
  pair.interpolation().prolong(wave_on(pair.coarse_dofs, 0.4), y, NodeInterpolation::Write::add);
  const auto found = y.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO i = 0; i < num_local(*pair.fine_dofs); ++i) {
    const GO unknown = pair.fine_dofs->getGlobalElement(i);
    EXPECT_NEAR(found(i, 0), wave(unknown, 5) + (Pair::is_prescribed(unknown) ? 0 : pair.at(unknown, 0.4)), 2e-15);
  }
}

TEST(NodeInterpolation, HasATranspose)
{
  const Pair pair;
  Vector x = wave_on(pair.coarse_dofs, 1), y = wave_on(pair.fine_dofs, 2);
  for (Vector *const v : {&x, &y}) // prescribed unknowns are 0
    for (LO i = 0; i < num_local(*v->getMap()); ++i)
      if (Pair::is_prescribed(v->getMap()->getGlobalElement(i))) v->replaceLocalValue(i, 0.);
  Vector Px(pair.fine_dofs), Ry(pair.coarse_dofs);
  Ry.putScalar(7); // what was there does not count
  pair.interpolation().prolong(x, Px, NodeInterpolation::Write::replace);
  pair.interpolation().restrict_to(y, Ry);
  EXPECT_GT(std::abs(Px.dot(y)), 0.1);
  EXPECT_NEAR(Px.dot(y), Ry.dot(x), 1e-14 * Px.norm2() * y.norm2());
}

} // namespace
} // namespace node_interpolation_test
