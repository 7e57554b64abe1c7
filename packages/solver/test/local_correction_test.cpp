// SPDX-License-Identifier: BSD-3-Clause
#include "factor/local_correction.hpp"

#include "beam.hpp"
#include "rpc/algebra/bounded_update.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <utility>

namespace local_correction_test
{
namespace
{

using namespace rpc;
using rpc::test::Beam;
using rpc::test::open_between;
using solver::LocalCorrection;

/// A diagonal stands for multigrid.
class Diagonal : public Operator
{
public:
  explicit Diagonal(const CrsMatrix &A) : inverse_(A.getRowMap())
  {
    A.getLocalDiagCopy(inverse_);
    inverse_.reciprocal(inverse_);
  }
  RCP<const Map> getDomainMap() const override { return inverse_.getMap(); }
  RCP<const Map> getRangeMap() const override { return inverse_.getMap(); }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const override
  {
    y.elementWiseMultiply(1., inverse_, x, 0.);
  }

private:
  Vector inverse_;
};

/// The matrix of a beam's stiffness as it is now.
struct Written {
  const UpdatedOperator &H;
  RCP<CrsMatrix> A = H.base().copy();
  DeviceView<double ***> update = bounded_update(H);

  explicit Written(const Beam &beam) : H(*beam.iterate->hessian()) { write_update(*A, H, update); }
  std::optional<LocalCorrection> correction() const { return LocalCorrection::around(H, *A, update); }
};

TEST(LocalCorrection, IsNoneWithoutChanges)
{
  Beam beam;
  open_between(beam, 2, 2.1);
  const Written written(beam);
  EXPECT_FALSE(written.correction());
  for (const double to : {2.2, 4.99}) {
    open_between(beam, 2, to);
    EXPECT_TRUE(written.correction()) << to;
  }
}

TEST(LocalCorrection, HoldsTwoLayersAroundTheNode)
{
  Beam beam;
  open_between(beam, 2, 2.001);
  const Written written(beam);
  open_between(beam, 1.99, 2.01); // the node at 2
  const auto correction = written.correction();
  ASSERT_TRUE(correction);
  EXPECT_EQ(correction->size(), 2 * 5 * 3);
}

/// Of two changes, of a 20th and of five times the nodes' own stiffness.
TEST(LocalCorrection, LeavesOutSlightChanges)
{
  Beam beam;
  open_between(beam, 2, 2.001);
  const Written now(beam);
  const auto own = to_host(now.H.base_blocks()), before = to_host(now.update);
  const auto node = to_host(now.H.nodes());
  const auto coordinates = fem::node_coordinates(beam.d);
  const auto at = coordinates->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t n = 0; n < node.extent(0); ++n) {
    const double x = at(node(n), 0);
    if (std::abs(x - 1) < 1e-9) before(n, 1, 1) += own(n, 1, 1) / 20;
    if (std::abs(x - 3) < 1e-9) before(n, 1, 1) += 5 * own(n, 1, 1);
  }
  const auto written = to_device(before);
  const auto around = [&](const double part) { return LocalCorrection::around(now.H, *now.A, written, part); };
  constexpr int of_a_node = 2 * 5 * 3;
  const auto of_both = around(0), of_one = around(0.1);
  ASSERT_TRUE(of_both && of_one);
  EXPECT_EQ(of_both->size(), 2 * of_a_node);
  EXPECT_EQ(of_one->size(), of_a_node);
  EXPECT_FALSE(around(6));
  for (const auto &[part, changes] : {std::pair(0., 2), std::pair(0.1, 1), std::pair(6., 0)})
    EXPECT_EQ(solver::num_changes(now.H, written, part), changes) << part;
}

TEST(LocalCorrection, IsSymmetricPositiveAndExactOnThePatch)
{
  Beam beam;
  open_between(beam, 2, 2.001);
  const Written written(beam);
  open_between(beam, 1.9, 2.2);
  const auto &H = *beam.iterate->hessian();
  const Diagonal M(*written.A);
  const auto correction = written.correction();
  ASSERT_TRUE(correction);
  const auto map = beam.u->getMap();
  Vector x(map), y(map), Bx(map), By(map), HBx(map);
  for (LO i = 0; i < num_local(*map); ++i) {
    const double angle = 0.7 * static_cast<double>(map->getGlobalElement(i));
    x.replaceLocalValue(i, std::sin(angle));
    y.replaceLocalValue(i, std::cos(1 + 1.3 * angle));
  }
  correction->apply(M, x, Bx);
  correction->apply(M, y, By);
  EXPECT_NEAR(Bx.dot(y), By.dot(x), 1e-13 * std::sqrt(Bx.dot(x) * By.dot(y)));
  EXPECT_GT(Bx.dot(x), 0);
  Vector q(map), off_patch(map), z(map), full(map);
  correction->solve_on_patch(x, q, off_patch);
  correction->apply_off_patch(M, off_patch, z);
  correction->apply(M, off_patch, full);
  full.update(-1., z, 1.);
  EXPECT_LT(full.norm2(), 1e-12 * z.norm2()) << "B r, where r is 0 on the patch";
  z.update(1., q, 1.);
  z.update(-1., Bx, 1.);
  EXPECT_LT(z.norm2(), 1e-12 * Bx.norm2()) << "B x = Q x + B (x - H Q x)";
  H.apply(Bx, HBx);
  HBx.update(-1., x, 1.);
  const auto rest = HBx.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto coordinates = fem::node_coordinates(beam.d);
  const auto at = coordinates->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t n = 0; n < at.extent(0); ++n) // one layer around the changed nodes, which the patch holds for sure
    if (at(n, 0) > 1.85 && at(n, 0) < 2.2 && at(n, 1) < 0.1) {
      EXPECT_LT(std::abs(rest(2 * n, 0)) + std::abs(rest(2 * n + 1, 0)), 1e-9) << at(n, 0) << " " << at(n, 1);
    }
}

} // namespace
} // namespace local_correction_test
