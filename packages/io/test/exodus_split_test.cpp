// SPDX-License-Identifier: BSD-3-Clause
#include "exodus_content.hpp"
#include "rpc/io/exodus.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <exodusII.h>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>
#include <utility>
#include <vector>

namespace exodus_split_test
{
namespace
{

using rpc::ExitCode;
using rpc::io::write_exodus;
using rpc::mesh::Element;
using rpc::mesh::Mesh;
using rpc::test::box;
using rpc::test::Content;
using rpc::test::expect_error;
using rpc::test::fields_of;
using ExodusSplit = rpc::test::ExodusTest;

/// Numbers that a split file gives its nodes or cells, from 0.
std::vector<int> numbers_of(const std::string &path, const ex_entity_type what, const int count)
{
  int word = sizeof(double), file_word = 0;
  float version = 0;
  const int id = ex_open(path.c_str(), EX_READ, &word, &file_word, &version);
  std::vector<int> numbers(count);
  if (count > 0) {
    EXPECT_EQ(ex_get_id_map(id, what, numbers.data()), 0);
  }
  ex_close(id);
  for (int &number : numbers) --number;
  return numbers;
}

/// What a split file says of all of them.
struct Share {
  explicit Share(const std::string &path)
  {
    int word = sizeof(double), file_word = 0;
    float version = 0;
    char kind[2] = {};
    const int id = ex_open(path.c_str(), EX_READ, &word, &file_word, &version);
    EXPECT_EQ(ex_get_init_info(id, &parts, &here, kind), 0);
    EXPECT_EQ(ex_get_init_global(id, &nodes, &cells, &blocks, &node_sets, &side_sets), 0);
    EXPECT_EQ(kind[0], 'p');
    std::vector<int> ids(std::max(blocks, side_sets)), none(side_sets);
    cells_of_block.resize(blocks);
    facets_of_side.resize(side_sets);
    EXPECT_EQ(ex_get_eb_info_global(id, ids.data(), cells_of_block.data()), 0);
    EXPECT_EQ(ex_get_ss_param_global(id, ids.data(), facets_of_side.data(), none.data()), 0);
    ex_close(id);
  }
  int parts = 0, here = 0, nodes = 0, cells = 0, blocks = 0, node_sets = 0, side_sets = 0;
  std::vector<int> cells_of_block, facets_of_side;
};

TEST_F(ExodusSplit, SplitFilesHaveWhatTheJoinedOneHas)
{
  for (const Element &element :
       {Element{2, 1}, Element{2, 2, rpc::mesh::Shape::simplex}, Element{3, 1}, Element{3, 2}}) {
    SCOPED_TRACE(element.name());
    const Mesh mesh = box(element, comm_);
    write_exodus(scratch_.path("a.e"), "a box", mesh, 0.5, fields_of(mesh));
    write_exodus(scratch_.path("a.e"), "a box", mesh, 0.5, fields_of(mesh), {}, rpc::io::ExodusFiles::split);
    if (!root_) continue;
    const Content joined(scratch_.path("a.e"));
    const int ranks = comm_->getSize(), width = joined.nodes_per_cell;
    std::vector<int> node_seen(joined.nodes, 0), cell_seen(joined.cells, 0);
    std::vector<std::set<std::pair<int, int>>> facets(joined.side_names.size());
    for (int rank = 0; rank < ranks; ++rank) {
      const std::string path = rpc::io::exodus_file_of(scratch_.path("a.e"), ranks, rank);
      const Content part(path);
      const auto node = numbers_of(path, EX_NODE_MAP, part.nodes), cell = numbers_of(path, EX_ELEM_MAP, part.cells);
      EXPECT_EQ(part.topology, joined.topology);
      EXPECT_EQ(part.block_name, joined.block_name);
      EXPECT_EQ(part.side_names, joined.side_names);
      EXPECT_EQ(part.field_names, joined.field_names);
      EXPECT_EQ(part.times, joined.times);
      EXPECT_TRUE(std::is_sorted(node.begin(), node.end()));
      for (int n = 0; n < part.nodes; ++n) {
        ++node_seen.at(node[n]);
        for (int d = 0; d < element.dim; ++d) EXPECT_EQ(part.coords[d][n], joined.coords[d][node[n]]);
        for (std::size_t f = 0; f < part.fields.size(); ++f)
          EXPECT_EQ(part.fields[f][n], joined.fields[f][node[n]]) << part.field_names[f];
      }
      for (int c = 0; c < part.cells; ++c) {
        ++cell_seen.at(cell[c]);
        for (int a = 0; a < width; ++a)
          EXPECT_EQ(node.at(part.conn[c * width + a] - 1), joined.conn[cell[c] * width + a] - 1);
      }
      for (std::size_t s = 0; s < facets.size(); ++s)
        for (std::size_t f = 0; f < part.side_cells[s].size(); ++f)
          EXPECT_TRUE(facets[s].emplace(cell.at(part.side_cells[s][f] - 1) + 1, part.side_ordinals[s][f]).second);
      const Share share(path);
      EXPECT_EQ(std::pair(share.parts, share.here), std::pair(ranks, 1));
      EXPECT_EQ(std::pair(share.nodes, share.cells), std::pair(joined.nodes, joined.cells));
      EXPECT_EQ(std::pair(share.blocks, share.side_sets), std::pair(joined.blocks, joined.side_sets));
      EXPECT_EQ(share.cells_of_block, std::vector<int>{joined.cells});
      for (std::size_t s = 0; s < facets.size(); ++s)
        EXPECT_EQ(share.facets_of_side[s], static_cast<int>(joined.side_cells[s].size()));
    }
    EXPECT_EQ(std::count(node_seen.begin(), node_seen.end(), 0), 0);
    EXPECT_EQ(cell_seen, std::vector<int>(joined.cells, 1));
    for (std::size_t s = 0; s < facets.size(); ++s) {
      std::set<std::pair<int, int>> expected;
      for (std::size_t f = 0; f < joined.side_cells[s].size(); ++f)
        expected.emplace(joined.side_cells[s][f], joined.side_ordinals[s][f]);
      EXPECT_EQ(facets[s], expected) << joined.side_names[s];
    }
  }
}

TEST_F(ExodusSplit, TheNumberOfARankHasAsManyDigitsAsThatOfTheRanks)
{
  EXPECT_EQ(rpc::io::exodus_file_of("a.e", 1, 0), "a.e.1.0");
  EXPECT_EQ(rpc::io::exodus_file_of("a.e", 16, 3), "a.e.16.03");
}

TEST_F(ExodusSplit, SplitFilesGrowTogetherAndTakeTimesOfOlderOnes)
{
  constexpr auto split = rpc::io::ExodusFiles::split;
  const Mesh mesh = box({2, 1}, comm_);
  const std::vector<std::string> names = {"disp_x", "contact_pressure"};
  const std::string older = scratch_.path("older.e");
  const std::string mine = rpc::io::exodus_file_of(older, comm_->getSize(), comm_->getRank());
  {
    rpc::io::ExodusFile file(older, "older", mesh, names, {}, {}, split);
    file.write(0.5, fields_of(mesh));
    file.publish();
    file.write(1, fields_of(mesh));
    EXPECT_EQ(rpc::io::exodus_times(older, *comm_, split), (std::vector<double>{0.5, 1}));
    file.write(2, fields_of(mesh));
    file.commit();
  }
  // As a run that is killed leaves them: one rank was not so far.
  comm_->barrier();
  if (comm_->getRank() == comm_->getSize() - 1) rpc::io::end_exodus_after(mine, 2, Teuchos::SerialComm<int>());
  comm_->barrier();
  EXPECT_EQ(rpc::io::exodus_times(older, *comm_, split), (std::vector<double>{0.5, 1}));
  rpc::io::ExodusFile file(scratch_.path("a.e"), "a", mesh, names, {}, {}, split);
  EXPECT_EQ(file.take_times(older, {0.5, 1, 2}), 2);
  file.write(3, fields_of(mesh));
  file.commit();
  EXPECT_EQ(rpc::io::exodus_times(scratch_.path("a.e"), *comm_, split), (std::vector<double>{0.5, 1, 3}));
  const Content first(rpc::io::exodus_file_of(scratch_.path("a.e"), comm_->getSize(), comm_->getRank()), 1),
      last(rpc::io::exodus_file_of(scratch_.path("a.e"), comm_->getSize(), comm_->getRank()), 3);
  EXPECT_EQ(first.fields, last.fields);
  rpc::io::ExodusFile joined(scratch_.path("joined.e"), "a", mesh, names);
  EXPECT_EQ(joined.take_times(older, {0.5, 1, 2}), 0);
}

/// A box of two blocks; the first 10 cells are the first one.
Mesh two_blocks(const rpc::RCP<const rpc::Comm> &comm)
{
  Mesh mesh = box({2, 1}, comm);
  mesh.blocks = {"low", "high"};
  const auto block = rpc::to_host(mesh.block);
  for (rpc::LO c = 0; c < mesh.num_owned_cells; ++c) block(c) = mesh.cell_id(c) < 10 ? 0 : 1;
  Kokkos::deep_copy(mesh.block, block);
  return mesh;
}

/// Each cell has its number, times a factor.
std::vector<rpc::io::CellField> cell_numbers(const Mesh &mesh, const double factor)
{
  rpc::HostView<double *> values("values", mesh.num_owned_cells);
  for (rpc::LO c = 0; c < mesh.num_owned_cells; ++c) values(c) = factor * static_cast<double>(mesh.cell_id(c));
  return {{"error_energy_norm", values}};
}

TEST_F(ExodusSplit, CellsHaveTheirFieldsInJoinedAndInSplitFiles)
{
  const Mesh mesh = two_blocks(comm_);
  const std::vector<std::string> names = {"disp_x", "contact_pressure"};
  for (const auto files : {rpc::io::ExodusFiles::joined, rpc::io::ExodusFiles::split}) {
    const bool split = files == rpc::io::ExodusFiles::split;
    const std::string older = scratch_.path("cells.e"), path = scratch_.path("more_cells.e");
    {
      rpc::io::ExodusFile file(older, "cells", mesh, names, {}, {}, files, {"error_energy_norm"});
      EXPECT_THROW(file.write(0.25, fields_of(mesh)), rpc::Error); // lacks the cells' field
      for (const double t : {0.5, 1.}) file.write(t, fields_of(mesh), cell_numbers(mesh, t));
      file.commit();
    }
    {
      rpc::io::ExodusFile file(path, "cells", mesh, names, {}, {}, files, {"error_energy_norm"});
      EXPECT_EQ(file.take_times(older, {1}), 1);
      file.write(3, fields_of(mesh), cell_numbers(mesh, 3));
      file.commit();
      rpc::io::ExodusFile other(scratch_.path("none.e"), "cells", mesh, names, {}, {}, files);
      EXPECT_EQ(other.take_times(older, {1}), 0); // the older one has a field more
    }
    if (!split && !root_) continue;
    const std::string mine = split ? rpc::io::exodus_file_of(path, comm_->getSize(), comm_->getRank()) : path;
    for (const int step : {1, 2}) {
      const Content file(mine, step);
      EXPECT_EQ(file.cell_field_names, std::vector<std::string>{"error_energy_norm"});
      ASSERT_EQ(file.cell_fields.size(), 1u);
      ASSERT_EQ(static_cast<int>(file.cell_fields[0].size()), file.cells);
      const auto number = split ? numbers_of(mine, EX_ELEM_MAP, file.cells) : std::vector<int>();
      for (int c = 0; c < file.cells; ++c)
        EXPECT_EQ(file.cell_fields[0][c], (step == 1 ? 1 : 3) * (split ? number[c] : c)) << c;
    }
  }
}

TEST_F(ExodusSplit, AFileThatOneRankCannotWriteIsAnErrorOnAllOfThem)
{
  const Mesh mesh = box({2, 1}, comm_);
  const std::string path = scratch_.path("a.e");
  const int last = comm_->getSize() - 1;
  if (root_) std::filesystem::create_directory(rpc::io::exodus_file_of(path, last + 1, last)); // in the way
  comm_->barrier();
  expect_error(ExitCode::bad_input, rpc::io::exodus_file_of("a.e", last + 1, last),
               [&] { write_exodus(path, "a", mesh, 0.5, fields_of(mesh), {}, rpc::io::ExodusFiles::split); });
  comm_->barrier();
  for (int rank = 0; rank < last; ++rank)
    EXPECT_FALSE(std::filesystem::exists(rpc::io::exodus_file_of(path, last + 1, rank)));
}

} // namespace
} // namespace exodus_split_test
