// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/exodus.hpp"

#include "exodus_content.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Core.hpp>
#include <array>
#include <exodusII.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace exodus_test
{
namespace
{

using rpc::Comm;
using rpc::ExitCode;
using rpc::HostView;
using rpc::LO;
using rpc::RCP;
using rpc::io::NodalField;
using rpc::io::write_exodus;
using rpc::mesh::Element;
using rpc::mesh::Mesh;
using rpc::test::box;
using rpc::test::Content;
using rpc::test::expect_error;
using rpc::test::fields_of;
using rpc::test::FileSizeLimit;
using rpc::test::first_field;
using rpc::test::Scratch;
using rpc::test::text_of;

using Exodus = rpc::test::ExodusTest;

class ExodusElements : public Exodus, public testing::WithParamInterface<Element>
{
};

TEST_P(ExodusElements, ReadsBackAsTheBoxItWas)
{
  const Element element = GetParam();
  const auto mesh = box(element, comm_);
  write_exodus(scratch_.path("a.e"), "a box", mesh, 0.5, fields_of(mesh), {"first line", std::string(200, 'i')});
  if (!root_) return;
  const Content file(scratch_.path("a.e"));
  const int p = element.order, nx = 6 * p + 1, ny = 3 * p + 1, nz = element.dim == 2 ? 1 : 2 * p + 1;
  EXPECT_EQ(file.title, "a box");
  EXPECT_EQ(file.dim, element.dim);
  EXPECT_EQ(file.cells, element.dim == 2 ? 18 : 36);
  EXPECT_EQ(file.blocks, 1);
  EXPECT_EQ(file.block_name, "body");
  EXPECT_EQ(file.topology, element.exodus_name());
  EXPECT_EQ(file.nodes_per_cell, element.num_nodes());
  EXPECT_EQ(file.times, std::vector<double>{0.5});
  EXPECT_EQ(file.num_info, 2);
  EXPECT_EQ(file.field_names, (std::vector<std::string>{"disp_x", "contact_pressure"}));
  ASSERT_EQ(file.nodes, nx * ny * nz);
  ASSERT_EQ(file.fields.size(), 2u);
  for (int n = 0; n < file.nodes; ++n) { // the lattice, x fastest
    const double x = 6. * (n % nx) / (nx - 1), y = -1 + 3. * (n / nx % ny) / (ny - 1);
    EXPECT_NEAR(file.coords[0][n], x, 1e-14);
    EXPECT_NEAR(file.coords[1][n], y, 1e-14);
    const double z = nz == 1 ? 0 : 1. * (n / nx / ny) / (nz - 1);
    EXPECT_NEAR(file.coords[2][n], z, 1e-14);
    EXPECT_NEAR(file.fields[0][n], first_field(x, y), 1e-11);
    EXPECT_NEAR(file.fields[1][n], -x / 3, 1e-14);
  }
}

TEST_P(ExodusElements, CellsKeepTheirPlaceAndNodeOrder)
{
  const Element element = GetParam();
  const auto mesh = box(element, comm_);
  write_exodus(scratch_.path("a.e"), "a box", mesh, 0.5, {});
  if (!root_) return;
  const Content file(scratch_.path("a.e"));
  ASSERT_EQ(file.conn.size(), std::size_t(file.cells) * element.num_nodes());
  const std::array<double, 3> lower = {0, -1, 0}, size = {1, 1, 0.5};
  for (int c = 0; c < file.cells; ++c) {
    const std::array<int, 3> at = {c % 6, c / 6 % 3, c / 18};
    for (int a = 0; a < element.num_nodes(); ++a) {
      const int node = file.conn[c * element.num_nodes() + a] - 1;
      ASSERT_TRUE(node >= 0 && node < file.nodes);
      for (int d = 0; d < element.dim; ++d)
        EXPECT_NEAR(file.coords[d][node],
                    lower[d] + size[d] * (at[d] + double(element.lattice()[a][d]) / element.order), 1e-14);
    }
  }
}

TEST_P(ExodusElements, SideSetsHoldEachFacetOnceWithItsName)
{
  const Element element = GetParam();
  const auto mesh = box(element, comm_);
  write_exodus(scratch_.path("a.e"), "a box", mesh, 0.5, {});
  if (!root_) return;
  const Content file(scratch_.path("a.e"));
  ASSERT_EQ(file.side_names.size(), mesh.sides.size());
  for (std::size_t s = 0; s < file.side_names.size(); ++s) {
    EXPECT_EQ(file.side_names[s], mesh.sides[s].name);
    const bool along_x = file.side_names[s] == "bottom" || file.side_names[s] == "top";
    const bool across_x = file.side_names[s] == "left" || file.side_names[s] == "right";
    const int depth = element.dim == 2 ? 1 : 2;
    ASSERT_EQ(static_cast<int>(file.side_cells[s].size()), along_x ? 6 * depth : across_x ? 3 * depth : 18);
    EXPECT_TRUE(std::is_sorted(file.side_cells[s].begin(), file.side_cells[s].end()));
    if (file.side_names[s] != "bottom") continue;
    for (std::size_t f = 0; f < file.side_cells[s].size(); ++f) {
      const int cell = file.side_cells[s][f] - 1;
      const auto &facet = element.facets()[file.side_ordinals[s][f] - 1];
      for (const int a : facet) EXPECT_EQ(file.coords[1][file.conn[cell * element.num_nodes() + a] - 1], -1);
    }
  }
}

TEST_P(ExodusElements, FileDoesNotDependOnTheNumberOfRanks)
{
  const auto mesh = box(GetParam(), comm_);
  write_exodus(scratch_.path("parallel.e"), "a box", mesh, 0.5, fields_of(mesh));
  const auto serial = box(GetParam(), Teuchos::rcp(new Teuchos::SerialComm<int>));
  const std::string serial_path = scratch_.path("serial" + std::to_string(comm_->getRank()) + ".e");
  write_exodus(serial_path, "a box", serial, 0.5, fields_of(serial));
  comm_->barrier();
  const std::string bytes = text_of(scratch_.path("parallel.e"));
  EXPECT_GT(bytes.size(), 1000u);
  EXPECT_TRUE(bytes == text_of(serial_path));
}

INSTANTIATE_TEST_SUITE_P(All, ExodusElements,
                         testing::Values(Element{2, 1}, Element{2, 2}, Element{3, 1}, Element{3, 2}),
                         [](const auto &info) { return info.param.exodus_name(); });

TEST_F(Exodus, HoldsTheFieldsOfSeveralTimes)
{
  const auto mesh = box(Element{}, comm_);
  const auto scaled = [&](const double factor) {
    auto fields = fields_of(mesh);
    for (auto &field : fields)
      for (std::size_t n = 0; n < field.values.extent(0); ++n) field.values(n) *= factor;
    return fields;
  };
  const std::string path = scratch_.path("steps.e");
  {
    rpc::io::ExodusFile file(path, "steps", mesh, {"disp_x", "contact_pressure"});
    for (const double t : {0.25, 0.5, 1.}) file.write(t, scaled(t));
    EXPECT_THROW(file.write(2, {fields_of(mesh)[0]}), rpc::Error);
    EXPECT_THROW(file.write(2, {fields_of(mesh)[1], fields_of(mesh)[0]}), rpc::Error);
    file.commit();
  }
  if (!root_) return;
  const Content last(path, 3);
  EXPECT_EQ(last.times, (std::vector<double>{0.25, 0.5, 1}));
  for (const int step : {1, 2}) {
    const Content at(path, step);
    for (std::size_t f = 0; f < 2; ++f)
      for (int n = 0; n < last.nodes; ++n)
        EXPECT_NEAR(at.fields[f][n], at.times[step - 1] * last.fields[f][n], 1e-12) << f << " " << n;
  }
}

TEST_F(Exodus, TakesTimesOfAFileOfTheSameMeshOnly)
{
  const Mesh mesh = box({2, 1}, comm_);
  rpc::io::ExodusFile older(scratch_.path("older.e"), "older", mesh, {"disp_x", "contact_pressure"});
  for (const double time : {0.5, 1., 2.}) older.write(time, fields_of(mesh));
  older.commit();
  const std::vector<double> wanted = {0.5, 2., 3.};
  rpc::io::ExodusFile same(scratch_.path("same.e"), "same", mesh, {"disp_x", "contact_pressure"});
  EXPECT_EQ(same.take_times(scratch_.path("older.e"), wanted), 2);
  same.commit();
  // As many nodes, but one place differs.
  const Mesh moved = rpc::mesh::make_box({{0, -1}, {6, 2.0000001}, {6, 3}, {2, 1}}, comm_);
  rpc::io::ExodusFile other(scratch_.path("other.e"), "other", moved, {"disp_x", "contact_pressure"});
  EXPECT_EQ(other.take_times(scratch_.path("older.e"), wanted), 0);
  EXPECT_EQ(rpc::io::exodus_times(scratch_.path("same.e"), *comm_), (std::vector<double>{0.5, 2}));
  EXPECT_TRUE(rpc::io::exodus_times(scratch_.path("none.e"), *comm_).empty());
}

TEST_F(Exodus, EndsAfterSomeOfItsTimes)
{
  const Mesh mesh = box({2, 1}, comm_);
  const std::string path = scratch_.path("a.e");
  rpc::io::ExodusFile file(path, "a", mesh, {"disp_x", "contact_pressure"});
  for (const double time : {0.5, 1., 2.}) file.write(time, fields_of(mesh));
  file.commit();
  rpc::io::end_exodus_after(path, 2, *comm_);
  EXPECT_EQ(rpc::io::exodus_times(path, *comm_), (std::vector<double>{0.5, 1}));
}

TEST_F(Exodus, AFileThatIsNotCommittedDoesNotAppear)
{
  const auto mesh = box(Element{}, comm_);
  {
    rpc::io::ExodusFile file(scratch_.path("half.e"), "half", mesh, {"disp_x", "contact_pressure"});
    file.write(0, fields_of(mesh));
  }
  comm_->barrier();
  EXPECT_FALSE(std::filesystem::exists(scratch_.path("half.e")));
}

TEST_F(Exodus, NamesOf32CharactersAreKept)
{
  const auto mesh = box({2, 1}, comm_);
  const std::string name(32, 'n');
  write_exodus(scratch_.path("a.e"), std::string(200, 't'), mesh, 0.5, {{name, fields_of(mesh)[0].values}});
  if (!root_) return;
  const Content file(scratch_.path("a.e"));
  EXPECT_EQ(file.field_names, std::vector<std::string>{name});
  EXPECT_EQ(file.title, std::string(80, 't'));
}

TEST_F(Exodus, SidesAndBlocksMayHaveLongerNames)
{
  auto mesh = box({2, 1}, comm_);
  const std::string side(255, 's'), block(40, 'b');
  mesh.sides[1].name = side;
  mesh.blocks[0] = block;
  write_exodus(scratch_.path("a.e"), "t", mesh, 0.5, {{"u", fields_of(mesh)[0].values}});
  if (!root_) return;
  const Content file(scratch_.path("a.e"));
  EXPECT_EQ(file.side_names[1], side);
  EXPECT_EQ(file.field_names, std::vector<std::string>{"u"});
}

TEST_F(Exodus, LongNameOrShortFieldIsRefusedOnEveryRank)
{
  const auto mesh = box({2, 1}, comm_);
  const auto values = fields_of(mesh)[0].values;
  expect_error(ExitCode::internal_error, "1 to 32 characters", [&] {
    write_exodus(scratch_.path("a.e"), "t", mesh, 0.5, {{std::string(33, 'n'), values}});
  });
  auto renamed = mesh;
  renamed.sides[0].name = std::string(256, 's');
  expect_error(ExitCode::internal_error, "1 to 255 characters", [&] {
    write_exodus(scratch_.path("a.e"), "t", renamed, 0.5, {{"u", values}});
  });
  const HostView<double *> shorter("shorter", values.extent(0) - (root_ ? 1 : 0));
  expect_error(ExitCode::internal_error, "\"u\" must have a value for each of", [&] {
    write_exodus(scratch_.path("a.e"), "t", mesh, 0.5, {{"u", shorter}});
  });
  comm_->barrier();
  EXPECT_EQ(scratch_.num_files(), 0);
}

TEST_F(Exodus, UnwritableFolderIsBadInputOnEveryRank)
{
  const auto mesh = box({2, 1}, comm_);
  if (root_) scratch_.write("file", "");
  comm_->barrier();
  expect_error(ExitCode::bad_input, "--output=DIR",
               [&] { write_exodus(scratch_.path("file/a.e"), "t", mesh, 0.5, {}); });
}

/// System calls by which this process has written so far; 0 where the kernel does not count them.
long num_writes()
{
  std::ifstream file("/proc/self/io");
  std::string what;
  long count = 0;
  while (file >> what >> count)
    if (what == "syscw:") return count;
  return 0;
}

TEST_F(Exodus, ALargeMeshTakesFewWrites)
{
  if (num_writes() == 0) GTEST_SKIP() << "the kernel does not count writes";
  const auto mesh = rpc::mesh::make_box({{0, 0}, {1, 1}, {300, 300}, Element{2, 1}}, comm_);
  const long before = num_writes();
  write_exodus(scratch_.path("a.e"), "t", mesh, 0.5, fields_of(mesh));
  // It takes 42. It took 2700 when 4 kB were written at a time and arrays moved as the header grew.
  EXPECT_LE(num_writes() - before, 100);
}

/// The number of times in a file's header: a process that is killed leaves it as it is.
int number_of_times(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  std::array<unsigned char, 8> begin{};
  file.read(reinterpret_cast<char *>(begin.data()), begin.size());
  EXPECT_EQ(begin[3], 2) << "another format of NetCDF: the number lies elsewhere";
  return begin[4] << 24 | begin[5] << 16 | begin[6] << 8 | begin[7];
}

TEST_F(Exodus, ATimeIsCountedOnceAllOfItIsInTheFile)
{
  for (const int cells : {4, 10, 60, 300}) {
    SCOPED_TRACE(cells);
    const auto mesh = rpc::mesh::make_box({{0, 0}, {1, 1}, {cells, cells}, Element{2, 1}}, comm_);
    const std::string path = scratch_.path("a" + std::to_string(cells) + ".e");
    const auto fields = fields_of(mesh);
    rpc::io::ExodusFile film(path, "t", mesh, {fields[0].name}, {});
    film.write(1, {fields[0]});
    film.publish();
    comm_->barrier();
    {
      const FileSizeLimit limit(std::filesystem::file_size(path) + 20); // bytes: a part of the next time
      expect_error(ExitCode::internal_error, "cannot", [&] { film.write(2, {fields[0]}); });
    }
    comm_->barrier();
    EXPECT_EQ(number_of_times(path), 1);
    comm_->barrier();
  }
}

TEST_F(Exodus, FullDiskIsToldOnEveryRankAndLeavesTheOldFile)
{
  const auto mesh = rpc::mesh::make_box({{0, 0}, {1, 1}, {200, 200}, Element{2, 1}}, comm_);
  if (root_) scratch_.write("a.e", "old");
  for (const rlim_t bytes : {1000, 1500000}) { // when the header is defined, in the fields
    {
      const FileSizeLimit limit(bytes);
      expect_error(ExitCode::internal_error, "cannot",
                   [&] { write_exodus(scratch_.path("a.e"), "t", mesh, 0.5, fields_of(mesh)); });
    }
    comm_->barrier();
    EXPECT_EQ(scratch_.num_files(), 1);
    EXPECT_EQ(text_of(scratch_.path("a.e")), "old");
  }
}

} // namespace
} // namespace exodus_test
