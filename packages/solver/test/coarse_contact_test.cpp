// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/coarse_contact.hpp"

#include "lines.hpp"
#include "multigrid/contact_supports.hpp"
#include "rpc/core/device_values.hpp"

#include <gtest/gtest.h>

namespace coarse_contact_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using solver::CoarseContact;

constexpr int dim = 2;

bool in_contact(const GO node)
{
  return node % 3 != 1;
}
/// What contact adds at a node of the finest line: some positive definite block, or none.
double added(const GO node, const int k, const int l)
{
  if (node % 5 == 2) return 0;
  const double m[2] = {wave(node, 0.3), wave(node, 2)};
  return (10 + static_cast<double>(node)) * (m[k] * m[l]) + (k == l ? 0.5 : 0);
}
/// A coarse line's matrix: neighbours are coupled by full blocks.
/// @param even  all rows but the first and the last repeat
Dense dense_matrix(const int nodes, const bool even = false)
{
  Dense A(dim * nodes, dim * nodes);
  for (int n = 0; n < nodes; ++n)
    for (int m = std::max(0, n - 1); m <= std::min(nodes - 1, n + 1); ++m)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          A(dof(dim, n, k), dof(dim, m, l)) =
              (n == m && k == l ? 4 : -0.2) + 0.0071 * (even ? 3 : n + m) * (k + l); // never 0
  return A;
}

/// A mesh with its matrix.
/// @param held       (columns) 1 where prescribed
/// @param assembled  contact may be written into A; else its rows are known, and A stays as it is
solver::MeshLevel level_of(const RCP<CrsMatrix> &A, const std::vector<char> &held, const bool assembled)
{
  solver::MeshLevel level{assembled ? A : Teuchos::null, {}, device_values(held, "prescribed"), {}};
  if (assembled) return level;
  level.unassembled = std::make_shared<const UnassembledMatrix>(
      UnassembledMatrix{RepeatedRows::of(A, dim), A->getDomainMap(),
                        std::make_shared<const Halo>(A->getGraph()->getImporter()), [A] { return A; }});
  level.columns = A->getColMap();
  return level;
}

/// Lines of ever fewer nodes, and contact at nodes of the first one.
struct Lines {
  std::vector<int> num_nodes;
  solver::ContactSupports supports; // of the contact nodes on the last line
  RCP<CrsMatrix> A;                 // of the last line
  RCP<CoarseContact> contact;
  MultiVector update;
  Dense weights; // (nodes of the first line, nodes of the last one)
  bool first_is_prescribed, even;

  explicit Lines(std::vector<int> nodes, const bool with_contact = true, const bool prescribed = false,
                 const bool rows_repeat = false, const bool assembled = true)
      : num_nodes(std::move(nodes)), update(line_of(1), 1), weights(dense_interpolation(num_nodes[0], num_nodes[0])),
        first_is_prescribed(prescribed), even(rows_repeat)
  {
    auto line = line_of(num_nodes[0]);
    std::vector<LO> touching;
    for (LO n = 0; n < num_local(*line) && with_contact; ++n)
      if (in_contact(line->getGlobalElement(n))) touching.push_back(n);
    supports = solver::contact_supports(device_values(touching, "touching"), line);
    const DeviceView<double ***> block("block", touching.size(), dim, dim);
    const auto to = Kokkos::create_mirror_view(block);
    for (std::size_t c = 0; c < touching.size(); ++c)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) to(c, k, l) = added(line->getGlobalElement(touching[c]), k, l);
    Kokkos::deep_copy(block, to);
    update = solver::packed_blocks(supports.contact, block);
    for (std::size_t l = 1; l < num_nodes.size(); ++l) {
      const auto coarse = line_of(num_nodes[l]);
      const Dense P = dense_interpolation(num_nodes[l - 1], num_nodes[l]);
      supports = solver::coarser(supports, *distributed(P, line, coarse));
      weights = product(weights, P);
      line = coarse;
    }
    const auto unknowns = unknowns_of(*line);
    A = distributed(dense_matrix(num_nodes.back(), even), unknowns, unknowns);
    const Map &columns = *A->getColMap();
    std::vector<char> held(num_local(columns));
    for (std::size_t i = 0; i < held.size(); ++i)
      held[i] = prescribed && columns.getGlobalElement(static_cast<LO>(i)) == 0;
    contact = rcp(new CoarseContact(supports, *line, dim, level_of(A, held, assembled)));
  }

  /// A + S^T U S, where couplings of nodes that are no neighbours are bounded on the diagonal.
  Dense expected() const
  {
    const int n = num_nodes.back();
    Dense sum = dense_matrix(n, even);
    for (int c = 0; c < num_nodes[0]; ++c) {
      if (!in_contact(c)) continue;
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
          const double both = weights(c, a) * weights(c, b);
          const bool neighbours = std::abs(a - b) <= 1;
          const int column = neighbours ? b : a;
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l < dim; ++l) {
              const bool held = first_is_prescribed && (dof(dim, a, k) == 0 || dof(dim, column, l) == 0);
              if (!held)
                sum(dof(dim, a, k), dof(dim, column, l)) += (neighbours ? both : std::abs(both)) * added(c, k, l);
            }
        }
    }
    return sum;
  }
  /// @param off  what each row of a product may miss, beside rounding
  void expect_products_of(const Dense &matrix, const double off = 0) const
  {
    const auto map = A->getDomainMap();
    for (const double phase : {0.1, 1.2, 3.1}) {
      Vector y(map);
      contact->apply(wave_on(map, phase), y);
      const auto found = y.getLocalViewHost(Tpetra::Access::ReadOnly);
      for (LO i = 0; i < num_local(*map); ++i) {
        double sum = 0, size = 0;
        for (int j = 0; j < matrix.columns; ++j) {
          const double term = matrix(map->getGlobalElement(i), j) * wave(j, phase);
          sum += term;
          size += std::abs(term);
        }
        EXPECT_NEAR(found(i, 0), sum, off + 1e-14 * size) << map->getGlobalElement(i);
      }
    }
  }
  void expect_blocks_of(const Dense &matrix) const
  {
    const auto node = to_host(contact->nodes());
    const auto block = to_host(contact->blocks());
    for (std::size_t n = 0; n < node.extent(0); ++n)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) {
          const GO first = A->getRowMap()->getGlobalElement(dof(dim, node(n), 0));
          EXPECT_NEAR(block(n, k, l), matrix(first + k, first + l), 1e-13 * std::abs(matrix(first, first)));
        }
  }
};

TEST(CoarseContact, IsTheProductWithTheInterpolations)
{
  for (const std::vector<int> &nodes :
       {std::vector<int>{33, 17}, std::vector<int>{33, 17, 9}, std::vector<int>{33, 17, 9, 5}}) {
    const Lines lines(nodes);
    lines.expect_products_of(dense_matrix(nodes.back()));
    lines.contact->write(lines.update);
    lines.expect_products_of(lines.expected());
    lines.expect_blocks_of(lines.expected());
  }
}

/// On nested meshes the blocks of the finer one will do in the contact nodes' stead, from one to the next.
TEST(CoarseContact, IsThatOfTheFinerMeshInterpolated)
{
  const std::vector<int> num_nodes{33, 17, 9, 5};
  const Lines lines(num_nodes, true, true); // from the contact nodes
  const Lines finer({33, 17}, true, true);
  ASSERT_FALSE(finer.contact->is_bounded());
  RCP<CoarseContact> contact = finer.contact;
  contact->write(finer.update);
  RCP<CrsMatrix> A;
  for (std::size_t l = 2; l < num_nodes.size(); ++l) {
    const auto line = line_of(num_nodes[l]);
    const auto P = distributed(dense_interpolation(num_nodes[l - 1], num_nodes[l]), line_of(num_nodes[l - 1]), line);
    const auto supports = contact->coarser_supports(*P);
    const auto unknowns = unknowns_of(*line);
    A = distributed(dense_matrix(num_nodes[l]), unknowns, unknowns);
    std::vector<char> held;
    for (LO i = 0; i < num_local(*A->getColMap()); ++i) held.push_back(A->getColMap()->getGlobalElement(i) == 0);
    const auto coarse = rcp(new CoarseContact(supports, *line, dim, level_of(A, held, true)));
    EXPECT_FALSE(coarse->is_bounded());
    coarse->write(contact->packed_sums(supports.contact));
    contact = coarse;
  }
  Vector x(contact->getDomainMap()), y(x.getMap()), expected(x.getMap());
  x.randomize();
  lines.contact->write(lines.update);
  lines.contact->apply(x, expected);
  contact->apply(x, y);
  y.update(-1., expected, 1.);
  EXPECT_GT(expected.normInf(), 0.1);
  EXPECT_LT(y.normInf(), 1e-13 * expected.normInf());
}

/// Where meshes are not nested, supports reach beyond the cells of the coarse one.
TEST(CoarseContact, BoundsCouplingsThatTheMatrixHasNoRoomFor)
{
  const Lines lines({31, 19, 12, 8});
  EXPECT_TRUE(lines.contact->is_bounded());
  int far = 0;
  for (int c = 0; c < 31; ++c)
    for (int a = 0; a + 2 < 8; ++a) far += lines.weights(c, a) != 0 && lines.weights(c, a + 2) != 0;
  ASSERT_GT(far, 0);
  lines.contact->write(lines.update);
  lines.expect_products_of(lines.expected());
  lines.expect_blocks_of(lines.expected());
}

TEST(CoarseContact, LeavesPrescribedUnknownsAsTheyAre)
{
  const Lines lines({33, 17}, true, true);
  lines.contact->write(lines.update);
  lines.expect_products_of(lines.expected());
}

TEST(CoarseContact, IsWrittenInPlaceOfWhatWasThere)
{
  const Lines lines({33, 17, 9});
  MultiVector other(lines.update, Teuchos::Copy);
  other.scale(1e8);
  lines.contact->write(other);
  lines.contact->write(lines.update);
  lines.expect_products_of(lines.expected());
  other.putScalar(0);
  lines.contact->write(other);
  lines.expect_products_of(dense_matrix(9));
}

TEST(CoarseContact, IsAddedToRowsThatRepeat)
{
  const Lines lines({129, 65}, true, true, true);
  EXPECT_GT(RepeatedRows::of(lines.A, dim).num_kinds(), 0);
  lines.contact->write(lines.update);
  lines.expect_products_of(lines.expected());
}

/// Nothing is written then: contact is added in all rows, those that do not repeat too.
TEST(CoarseContact, NeedsNoMatrix)
{
  for (const bool rows_repeat : {false, true}) {
    const Lines lines({129, 65}, true, true, rows_repeat, false);
    EXPECT_EQ(RepeatedRows::of(lines.A, dim).num_kinds() > 0, rows_repeat);
    for (int k = 0; k < 2; ++k) lines.contact->write(lines.update);
    lines.expect_products_of(lines.expected());
    lines.expect_blocks_of(lines.expected());
    MultiVector none(lines.update, Teuchos::Copy);
    none.putScalar(0);
    lines.contact->write(none);
    lines.expect_products_of(dense_matrix(65, rows_repeat));
  }
}

/// Single precision would be off by a part of contact's 1e9.
TEST(CoarseContact, RoundsTheBodyButNotContact)
{
  for (const bool rows_repeat : {false, true}) {
    Lines lines({129, 65}, true, true, rows_repeat);
    lines.update.scale(1e8);
    const auto product = [&] {
      Vector y(lines.A->getDomainMap());
      lines.contact->apply(wave_on(y.getMap(), 1.2), y);
      return y;
    };
    const Vector exact = product();
    lines.contact->allow_rounding();
    Vector rounded = product();
    rounded.update(-1., exact, 1.);
    EXPECT_EQ(rounded.norm2() > 0, !on_gpu && !rows_repeat);
    lines.contact->write(lines.update);
    Dense expected = lines.expected();
    const Dense A = dense_matrix(65, rows_repeat);
    for (std::size_t k = 0; k < A.value.size(); ++k) expected.value[k] += (1e8 - 1) * (expected.value[k] - A.value[k]);
    lines.expect_products_of(expected, 1e-6);
  }
}

TEST(CoarseContact, IsSymmetricToTheLastBit)
{
  const Lines lines({31, 19, 12});
  lines.contact->write(lines.update);
  const auto matrix = lines.A->getLocalMatrixDevice();
  const auto begin = to_host(matrix.graph.row_map);
  const auto entries = to_host(matrix.graph.entries);
  const auto values = to_host(matrix.values);
  const auto entry = [&](const LO row, const LO column) {
    for (auto e = begin(row); e < begin(row + 1); ++e)
      if (entries(e) == column) return values(e);
    return 0.;
  };
  for (LO row = 0; row < matrix.numRows(); ++row)
    for (auto e = begin(row); e < begin(row + 1); ++e)
      if (entries(e) < matrix.numRows()) { // of this rank
        EXPECT_EQ(values(e), entry(entries(e), row)) << row << " " << entries(e);
      }
}

TEST(CoarseContact, OfABodyThatTouchesNothingIsItsMatrix)
{
  const Lines lines({33, 17, 9}, false);
  EXPECT_EQ(lines.contact->nodes().extent(0), 0U);
  lines.contact->write(lines.update);
  lines.expect_products_of(dense_matrix(9));
}

TEST(ContactSupports, OfARankAreThoseAroundItsNodes)
{
  const Lines lines({33, 17, 9});
  const solver::NearSupports near = solver::near_supports(lines.supports, *line_of(9));
  const Map &contact = *near.importer->getTargetMap();
  const auto line = line_of(9);
  std::vector<int> touching;
  for (int n = 0; n < 33; ++n)
    if (in_contact(n)) touching.push_back(n);
  int expected = 0;
  for (const int n : touching) {
    bool is_near = false;
    for (LO m = 0; m < num_local(*line); ++m) is_near = is_near || lines.weights(n, line->getGlobalElement(m)) != 0;
    expected += is_near;
  }
  ASSERT_EQ(near.size(), expected);
  for (int c = 0; c < near.size(); ++c) {
    if (c > 0) {
      EXPECT_LT(contact.getGlobalElement(c - 1), contact.getGlobalElement(c));
    }
    const int node = touching[contact.getGlobalElement(c)];
    double sum = 0;
    for (std::size_t e = near.begin[c]; e < near.begin[c + 1]; ++e) {
      EXPECT_DOUBLE_EQ(near.weight[e], lines.weights(node, near.node[e]));
      sum += near.weight[e];
    }
    EXPECT_DOUBLE_EQ(sum, 1);
  }
}

} // namespace
} // namespace coarse_contact_test
