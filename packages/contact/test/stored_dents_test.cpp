// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/stored_dents.hpp"

#include "blocks.hpp"
#include "expect_error.hpp"
#include "rpc/core/parallel.hpp"

#include <gtest/gtest.h>

namespace stored_dents_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::FoundationDents;

/// Dents of two steps, in the right half of the bottom, and a side without any.
std::vector<FoundationDents> some_dents(const fem::Discretization &d)
{
  contact::ContactOptions bottom;
  bottom.side = "bottom";
  bottom.dents_move_with = contact::DentsMoveWith::foundation;
  contact::ContactOptions top;
  top.side = "top";
  std::vector<FoundationDents> dents;
  for (const double shift : {0., 0.1}) {
    const auto half = at_nodes(d, [](const Point &x) { return std::max(0., x[0] - 2); });
    const auto added = rcp(new MultiVector(d.mesh->owned_nodes, 2));
    added->getVectorNonConst(0)->update(1., *half->getVector(0), 0.);
    const auto u = displacement(d, [&](const Point &x) { return Point{shift * x[0], shift, 0}; });
    contact::press_in(d, {bottom, top}, *added, *added, *u, dents);
  }
  return dents;
}

void expect_same(const contact::DentSheet &a, const contact::DentSheet &b)
{
  EXPECT_EQ(a.facet.name(), b.facet.name());
  EXPECT_EQ(a.facet.dim, b.facet.dim);
  EXPECT_EQ(a.spread, b.spread);
  EXPECT_EQ(a.place, b.place);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.dent, b.dent);
  EXPECT_EQ(a.facet_node, b.facet_node);
}

TEST(StoredDents, AreTheSameOnAsManyRanks)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = block(element);
    const Comm &comm = d.mesh->comm();
    const auto dents = some_dents(d);
    const auto numbers = contact::stored_dents(comm, dents);
    EXPECT_EQ(numbers.empty(), comm.getRank() != 0);
    const auto found = contact::dents_from(comm, numbers);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_TRUE(found[1].sheets.empty());
    EXPECT_EQ(found[0].deepest, dents[0].deepest);
    EXPECT_EQ(found[0].volume, dents[0].volume);
    ASSERT_EQ(found[0].sheets.size(), 2u);
    for (int k = 0; k < 2; ++k) expect_same(*found[0].sheets[k], *dents[0].sheets[k]);
  }
}

TEST(StoredDents, AreDealtOutAmongFewerAndMoreRanks)
{
  const auto d = block({3, 2, mesh::Shape::simplex});
  const auto comm = d.mesh->owned_nodes->getComm();
  const auto alone = comm->split(comm->getRank(), 0);
  const auto dents = some_dents(d);
  const auto numbers = contact::stored_dents(*comm, dents);
  const GO facets = sum_all(*comm, GO(dents[0].sheets[0]->facet_node.size()));
  EXPECT_GT(facets, 0);
  if (comm->getRank() == 0) {
    const auto all = contact::dents_from(*alone, numbers);
    EXPECT_EQ(GO(all[0].sheets[0]->facet_node.size()), facets);
  }

  const auto mine = contact::stored_dents(*alone, dents); // as of a run on one rank
  const auto found = contact::dents_from(*comm, comm->getRank() == 0 ? mine : std::vector<double>());
  ASSERT_EQ(found.size(), 2u);
  ASSERT_EQ(found[0].sheets.size(), 2u);
  EXPECT_EQ(found[0].volume, dents[0].volume);
  if (comm->getRank() == 0) {
    expect_same(*found[0].sheets[1], *dents[0].sheets[1]);
  } else {
    EXPECT_TRUE(found[0].sheets[1]->facet_node.empty());
  }
}

TEST(StoredDents, ThatAreDamagedAreRefusedOnAllRanks)
{
  const auto d = block({2, 1});
  const Comm &comm = d.mesh->comm();
  const auto numbers = contact::stored_dents(comm, some_dents(d));
  for (const std::size_t place : {std::size_t(0), std::size_t(1), std::size_t(4), std::size_t(9)})
    for (const double wrong : {-1., 0.5, 1., 1e6}) {
      auto damaged = numbers;
      if (comm.getRank() == 0) damaged[place] = wrong;
      expect_error(ExitCode::bad_input, {"damaged", "older one"}, [&] { contact::dents_from(comm, damaged); });
    }
}

} // namespace
} // namespace stored_dents_test
