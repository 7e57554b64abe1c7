// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/contact_csv.hpp"

#include "rpc/mesh/box.hpp"
#include "rpc/mesh/canonical_order.hpp"
#include "scratch.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <sstream>

namespace contact_csv_test
{
namespace
{

using rpc::Comm;
using rpc::ExitCode;
using rpc::GO;
using rpc::HostView;
using rpc::LO;
using rpc::RCP;
using rpc::io::ContactTable;
using rpc::io::write_contact_csv;
using rpc::test::expect_error;
using rpc::test::text_of;

struct Vertex {
  GO id;
  double x, y;
};

ContactTable empty_table(const std::size_t n, const int dim)
{
  ContactTable table;
  table.side = "side";
  table.id = HostView<GO *>("id", n);
  table.position = HostView<double **>("position", n, dim);
  table.weight = HostView<double *>("weight", n);
  table.u_nu = HostView<double *>("u_nu", n);
  table.gap = HostView<double *>("gap", n);
  table.pressure = HostView<double *>("pressure", n);
  table.dent = HostView<double *>("dent", n);
  table.state = HostView<int *>("state", n);
  table.along = HostView<double **>("along", n, dim);
  table.force = HostView<double **>("force", n, dim);
  return table;
}

/// The vertices and facets dealt out to the ranks like cards, from the last one on, so that no order survives by
/// chance.
ContactTable deal(const Comm &comm, std::vector<Vertex> vertices, std::vector<std::vector<GO>> facets)
{
  const auto mine = [&](auto &items) {
    auto all = items;
    items.clear();
    for (std::size_t k = comm.getRank(); k < all.size(); k += comm.getSize()) items.push_back(all[all.size() - 1 - k]);
  };
  const std::size_t width = facets.empty() ? 2 : facets[0].size();
  mine(vertices);
  mine(facets);
  const std::size_t n = vertices.size();
  ContactTable dealt = empty_table(n, 2);
  dealt.facets = HostView<GO **>("facets", facets.size(), width);
  for (std::size_t k = 0; k < n; ++k) {
    dealt.id(k) = vertices[k].id;
    dealt.position(k, 0) = vertices[k].x;
    dealt.position(k, 1) = vertices[k].y;
    dealt.pressure(k) = static_cast<double>(vertices[k].id);
  }
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (std::size_t a = 0; a < width; ++a) dealt.facets(f, a) = facets[f][a];
  return dealt;
}

std::vector<std::vector<std::string>> cells_of(const std::string &text)
{
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

class ContactCsv : public testing::Test
{
protected:
  using Column = std::vector<double>;

  /// Writes and expects these ids (in the pressure column) and arc lengths, row by row.
  void expect_walk(const std::vector<Vertex> &vertices, const std::vector<std::vector<GO>> &facets,
                   const std::vector<GO> &ids, const Column &lengths)
  {
    const ContactTable dealt = deal(*comm_, vertices, facets);
    write_contact_csv(path_, comm_, {dealt});
    comm_->barrier();
    const auto rows = cells_of(text_of(path_));
    ASSERT_EQ(rows.size(), ids.size() + 1);
    for (std::size_t k = 0; k < ids.size(); ++k) {
      ASSERT_EQ(rows[k + 1].size(), 13u);
      EXPECT_EQ(std::stod(rows[k + 1][5]), ids[k]) << "row " << k;
      EXPECT_NEAR(std::stod(rows[k + 1][2]), lengths[k], 1e-14) << "row " << k;
    }
    comm_->barrier();
  }

  RCP<const Comm> comm_ = Tpetra::getDefaultComm();
  rpc::test::Scratch scratch_{*comm_};
  std::string path_ = scratch_.path("a.contact.csv");
};

TEST_F(ContactCsv, WritesOneRowPerNodeExactly)
{
  const ContactTable dealt = deal(*comm_, {{0, 0.1, 0}, {1, 1. / 3, 0}, {2, 1, 0}}, {{0, 1}, {1, 2}});
  for (std::size_t k = 0; k < dealt.id.extent(0); ++k) {
    const int id = static_cast<int>(dealt.id(k));
    dealt.u_nu(k) = 1e-300 * id;
    dealt.gap(k) = M_PI * id;
    dealt.pressure(k) = 2. / 3 * id;
    dealt.dent(k) = 0.7 * id;
    dealt.state(k) = id;
    dealt.along(k, 0) = 0.3 * id;
    dealt.force(k, 1) = -0.9 * id;
  }
  write_contact_csv(path_, comm_, {dealt});
  comm_->barrier();
  const std::string text = text_of(path_);
  EXPECT_EQ(text.substr(0, text.find('\n')), "x,y,s,u_nu,gap,pressure,state,side,dent,u_t_x,u_t_y,force_x,force_y");
  const auto rows = cells_of(text);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(std::stod(rows[2][0]), 1. / 3);
  EXPECT_EQ(std::stod(rows[3][3]), 2e-300);
  EXPECT_EQ(std::stod(rows[2][4]), M_PI);
  EXPECT_EQ(std::stod(rows[2][5]), 2. / 3);
  EXPECT_EQ(std::stod(rows[2][8]), 0.7);
  EXPECT_EQ(std::stod(rows[2][9]), 0.3);
  EXPECT_EQ(std::stod(rows[2][12]), -0.9);
  EXPECT_EQ(rows[1][0], "0.1");
  EXPECT_EQ(rows[1][6], "open");
  EXPECT_EQ(rows[2][6], "closed");
  EXPECT_EQ(rows[3][6], "yielding");
}

TEST_F(ContactCsv, ChainStartsAtTheEndWithTheSmallerX)
{
  const std::vector<Vertex> bent = {{7, 2, 0}, {3, 0, 0}, {5, 1, 0}, {1, 2, 3}};
  expect_walk(bent, {{5, 3}, {7, 5}, {1, 7}}, {3, 5, 7, 1}, {0, 1, 2, 5});
  expect_walk(bent, {{3, 5}, {5, 7}, {7, 1}}, {3, 5, 7, 1}, {0, 1, 2, 5}); // whatever way the facets point
}

TEST_F(ContactCsv, ChainOfEqualXStartsAtTheSmallerY)
{
  expect_walk({{0, 1, 2}, {1, 1, 1}, {2, 1, 0}}, {{0, 1}, {1, 2}}, {2, 1, 0}, {0, 1, 2});
}

TEST_F(ContactCsv, MiddleNodesOfQuadraticFacetsComeInBetween)
{
  expect_walk({{0, 0, 0}, {1, 2, 0}, {2, 4, 0}, {3, 1, 1}, {4, 3, 0}}, {{1, 0, 3}, {2, 1, 4}}, {0, 3, 1, 4, 2},
              {0, std::sqrt(2), 2 * std::sqrt(2), 1 + 2 * std::sqrt(2), 2 + 2 * std::sqrt(2)});
}

TEST_F(ContactCsv, SeveralChainsFollowEachOtherWithTheirOwnLengths)
{
  expect_walk({{0, 5, 0}, {1, 6, 0}, {2, 0, 0}, {3, 1, 0}, {4, 2, 0}}, {{0, 1}, {3, 2}, {4, 3}}, {2, 3, 4, 0, 1},
              {0, 1, 2, 0, 1});
}

TEST_F(ContactCsv, ClosedChainStartsAtItsLowestPointAndFollowsTheFacets)
{
  const std::vector<Vertex> square = {{0, 1, 1}, {1, 0, 1}, {2, 0, 0}, {3, 1, 0}};
  expect_walk(square, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {2, 3, 0, 1}, {0, 1, 2, 3});
  expect_walk(square, {{1, 0}, {2, 1}, {3, 2}, {0, 3}}, {2, 1, 0, 3}, {0, 1, 2, 3});
}

TEST_F(ContactCsv, NodeThatTheTableLacksIsPassedOver)
{
  expect_walk({{1, 1, 0}, {2, 2, 0}}, {{0, 1}, {1, 2}, {2, 3}}, {1, 2}, {0, 1});
}

TEST_F(ContactCsv, SidesFollowEachOtherUnderTheirNames)
{
  ContactTable left = deal(*comm_, {{0, 0, 0}, {1, 0, 1}}, {{0, 1}});
  ContactTable bottom = deal(*comm_, {{0, 0, 0}, {2, 1, 0}}, {{0, 2}}); // shares a node with the other
  left.side = "left, or \"west\"";
  write_contact_csv(path_, comm_, {left, bottom});
  comm_->barrier();
  EXPECT_EQ(text_of(path_), "x,y,s,u_nu,gap,pressure,state,side,dent,u_t_x,u_t_y,force_x,force_y\n"
                            "0,0,0,0,0,0,open,\"left, or \"\"west\"\"\",0,0,0,0,0\n"
                            "0,1,1,0,0,1,open,\"left, or \"\"west\"\"\",0,0,0,0,0\n"
                            "0,0,0,0,0,0,open,side,0,0,0,0,0\n"
                            "1,0,1,0,0,2,open,side,0,0,0,0,0\n");
}

TEST_F(ContactCsv, EmptyTableGivesAHeaderOnly)
{
  expect_walk({}, {}, {}, {});
}

TEST_F(ContactCsv, BottomOfABoxIsSortedForAnyNumberOfRanks)
{
  for (const int order : {1, 2}) {
    const auto mesh = rpc::mesh::make_box({{0, 0}, {5, 1}, {10, 4}, {2, order}}, comm_);
    const auto ids = rpc::mesh::overlap_node_ids(mesh);
    const auto coords = rpc::to_host(mesh.coords);
    std::vector<LO> bottom;
    for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
      if (coords(n, 1) == 0) bottom.push_back(n);
    const std::size_t count = bottom.size();
    ContactTable table = empty_table(count, 2);
    for (std::size_t k = 0; k < count; ++k) {
      table.id(k) = ids(bottom[k]);
      for (int d = 0; d < 2; ++d) table.position(k, d) = coords(bottom[k], d);
    }
    table.facets = rpc::mesh::owned_facets(mesh, mesh.side("bottom", "test"), ids);
    write_contact_csv(path_, comm_, {table});
    comm_->barrier();
    const auto rows = cells_of(text_of(path_));
    ASSERT_EQ(rows.size(), std::size_t(10 * order + 2));
    for (std::size_t k = 1; k < rows.size(); ++k) {
      EXPECT_NEAR(std::stod(rows[k][0]), 0.5 / order * (k - 1), 1e-14);
      EXPECT_NEAR(std::stod(rows[k][2]), 0.5 / order * (k - 1), 1e-13);
    }
    comm_->barrier();
  }
}

TEST_F(ContactCsv, In3dRowsComeById)
{
  const std::size_t count = comm_->getRank() == comm_->getSize() - 1 ? 2 : 0;
  const ContactTable table = empty_table(count, 3);
  for (std::size_t k = 0; k < count; ++k) {
    table.id(k) = 9 - static_cast<GO>(k);
    table.position(k, 2) = static_cast<double>(9 - k);
    table.weight(k) = 0.25 * static_cast<double>(k);
  }
  write_contact_csv(path_, comm_, {table});
  comm_->barrier();
  EXPECT_EQ(text_of(path_), "x,y,z,area,u_nu,gap,pressure,state,side,dent,u_t_x,u_t_y,u_t_z,force_x,force_y,force_z\n"
                            "0,0,8,0.25,0,0,0,open,side,0,0,0,0,0,0,0\n0,0,9,0,0,0,0,open,side,0,0,0,0,0,0,0\n");
}

TEST_F(ContactCsv, BadTableIsRefusedOnEveryRank)
{
  const ContactTable twice = deal(*comm_, {{4, 0, 0}, {4, 1, 0}}, {});
  expect_error(ExitCode::internal_error, "node 4 is on several ranks",
               [&] { write_contact_csv(path_, comm_, {twice}); });
  const ContactTable state = deal(*comm_, {{4, 0, 0}}, {});
  if (state.state.extent(0) > 0) state.state(0) = 4;
  expect_error(ExitCode::internal_error, "must be 0 to 3, got 4", [&] { write_contact_csv(path_, comm_, {state}); });
  ContactTable shorter = deal(*comm_, {{4, 0, 0}}, {});
  if (comm_->getRank() == 0) shorter.gap = HostView<double *>("gap", 0);
  expect_error(ExitCode::internal_error, "columns", [&] { write_contact_csv(path_, comm_, {shorter}); });
  comm_->barrier();
  EXPECT_EQ(scratch_.num_files(), 0);
}

} // namespace
} // namespace contact_csv_test
