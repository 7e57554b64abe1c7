// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/io/exodus.hpp"
#include "rpc/mesh/box.hpp"
#include "scratch.hpp"

#include <Tpetra_Core.hpp>
#include <array>
#include <exodusII.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

/// Exodus files of small boxes, and what is read back of them.
namespace rpc::test
{

using io::NodalField;
using mesh::Element;
using mesh::Mesh;

inline Mesh box(const Element &element, const RCP<const Comm> &comm)
{
  if (element.dim == 2) return mesh::make_box({{0, -1}, {6, 2}, {6, 3}, element}, comm);
  return mesh::make_box({{0, -1, 0}, {6, 2, 1}, {6, 3, 2}, element}, comm);
}

inline double first_field(const double x, const double y)
{
  return x + 100 * y;
}

inline std::vector<NodalField> fields_of(const Mesh &mesh)
{
  const auto coords = to_host(mesh.coords);
  HostView<double *> first("first", mesh.num_owned_nodes()), second("second", mesh.num_owned_nodes());
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    first(n) = first_field(coords(n, 0), coords(n, 1));
    second(n) = -coords(n, 0) / 3;
  }
  return {{"disp_x", first}, {"contact_pressure", second}};
}

/// A file read back whole; rank 0 only.
struct Content {
  /// @param step  time whose fields are read, from 1
  explicit Content(const std::string &path, const int step = 1)
  {
    int word = sizeof(double), file_word = 0;
    float version = 0;
    const int id = ex_open(path.c_str(), EX_READ, &word, &file_word, &version);
    if (id < 0) {
      ADD_FAILURE() << "cannot open " << path;
      return;
    }
    EXPECT_EQ(ex_large_model(id), 1);
    EXPECT_EQ(file_word, static_cast<int>(sizeof(double)));
    char text[MAX_LINE_LENGTH + 1] = {};
    EXPECT_EQ(ex_get_init(id, text, &dim, &nodes, &cells, &blocks, &node_sets, &side_sets), 0);
    title = text;
    std::vector<double> x(nodes), y(nodes), z(nodes);
    EXPECT_EQ(ex_get_coord(id, x.data(), y.data(), z.data()), 0);
    coords = {x, y, z};
    ex_block block{};
    block.id = 1;
    block.type = EX_ELEM_BLOCK;
    EXPECT_EQ(ex_get_block_param(id, &block), 0);
    topology = block.topology;
    nodes_per_cell = static_cast<int>(block.num_nodes_per_entry);
    conn.resize(block.num_entry * nodes_per_cell);
    EXPECT_EQ(ex_get_conn(id, EX_ELEM_BLOCK, 1, conn.data(), nullptr, nullptr), 0);
    ex_set_max_name_length(id, 255);
    char name[256] = {};
    EXPECT_EQ(ex_get_name(id, EX_ELEM_BLOCK, 1, name), 0);
    block_name = name;
    read_sides(id);
    read_fields(id, step);
    read_cell_fields(id, step);
    const int steps = static_cast<int>(ex_inquire_int(id, EX_INQ_TIME));
    times.resize(steps);
    if (steps > 0) {
      EXPECT_EQ(ex_get_all_times(id, times.data()), 0);
    }
    EXPECT_EQ(ex_inquire_int(id, EX_INQ_QA), 1);
    num_info = static_cast<int>(ex_inquire_int(id, EX_INQ_INFO));
    ex_close(id);
  }

  void read_sides(const int id)
  {
    for (int s = 1; s <= side_sets; ++s) {
      char name[256] = {};
      EXPECT_EQ(ex_get_name(id, EX_SIDE_SET, s, name), 0);
      side_names.push_back(name);
      int count = 0, factors = 0;
      EXPECT_EQ(ex_get_set_param(id, EX_SIDE_SET, s, &count, &factors), 0);
      std::vector<int> cell(count), ordinal(count);
      if (count > 0) { // else the library warns
        EXPECT_EQ(ex_get_set(id, EX_SIDE_SET, s, cell.data(), ordinal.data()), 0);
      }
      side_cells.push_back(cell);
      side_ordinals.push_back(ordinal);
    }
  }

  void read_fields(const int id, const int step)
  {
    int count = 0;
    EXPECT_EQ(ex_get_variable_param(id, EX_NODAL, &count), 0);
    for (int f = 1; f <= count; ++f) {
      char name[256] = {}; // the library writes as many as names may have
      EXPECT_EQ(ex_get_variable_name(id, EX_NODAL, f, name), 0);
      field_names.push_back(name);
      std::vector<double> values(nodes);
      EXPECT_EQ(ex_get_nodal_var(id, step, f, nodes, values.data()), 0);
      fields.push_back(values);
    }
  }

  void read_cell_fields(const int id, const int step)
  {
    int count = 0;
    EXPECT_EQ(ex_get_variable_param(id, EX_ELEM_BLOCK, &count), 0);
    for (int f = 1; f <= count; ++f) {
      char name[256] = {};
      EXPECT_EQ(ex_get_variable_name(id, EX_ELEM_BLOCK, f, name), 0);
      cell_field_names.push_back(name);
      cell_fields.emplace_back();
      for (int b = 1; b <= blocks; ++b) {
        ex_block block{};
        block.id = b;
        block.type = EX_ELEM_BLOCK;
        EXPECT_EQ(ex_get_block_param(id, &block), 0);
        if (block.num_entry == 0) continue;
        std::vector<double> values(block.num_entry);
        EXPECT_EQ(ex_get_var(id, step, EX_ELEM_BLOCK, f, b, block.num_entry, values.data()), 0);
        cell_fields.back().insert(cell_fields.back().end(), values.begin(), values.end());
      }
    }
  }

  std::string title, topology, block_name;
  int dim = 0, nodes = 0, cells = 0, blocks = 0, node_sets = 0, side_sets = 0, nodes_per_cell = 0, num_info = 0;
  std::vector<double> times;
  std::array<std::vector<double>, 3> coords;
  std::vector<int> conn;
  std::vector<std::string> side_names, field_names, cell_field_names;
  std::vector<std::vector<int>> side_cells, side_ordinals;
  std::vector<std::vector<double>> fields, cell_fields;
};

/// Of tests of Exodus files.
class ExodusTest : public testing::Test
{
protected:
  RCP<const Comm> comm_ = Tpetra::getDefaultComm();
  Scratch scratch_{*comm_};
  const bool root_ = comm_->getRank() == 0;
};

} // namespace rpc::test
