// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/checkpoint.hpp"

#include "rpc/mesh/box.hpp"
#include "scratch.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace checkpoint_test
{
namespace
{

using namespace rpc;
using rpc::io::Checkpoint;
using rpc::io::NodalField;
using rpc::io::write_checkpoint;
using rpc::test::expect_error;
using rpc::test::Scratch;
using rpc::test::text_of;

mesh::Mesh box(const int cells = 5)
{
  return mesh::make_box({{0, 0}, {2, 1}, {cells, 3}, {2, 1}}, Tpetra::getDefaultComm());
}

/// Values with all their digits, which depend on the place alone.
std::vector<NodalField> fields_of(const mesh::Mesh &mesh)
{
  const auto coords = to_host(mesh.coords);
  HostView<double *> first("first", mesh.num_owned_nodes()), second("second", mesh.num_owned_nodes());
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    first(n) = std::sin(coords(n, 0) + 3 * coords(n, 1)) / 3;
    second(n) = -1e-300 * coords(n, 0);
  }
  return {{"dent_1", first}, {"pressure_1", second}};
}

// Longer than a record of Exodus, with blanks and quotes where records may end.
std::string long_text()
{
  std::string text = "{\"list\": [";
  for (int k = 0; k < 100; ++k) text += std::to_string(k) + ",      ";
  return text + "\"end \\\" |\"]}";
}

TEST(Checkpoint, ReadsBackWhatWasWritten)
{
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const mesh::Mesh mesh = box();
  const auto fields = fields_of(mesh);
  const std::string path = scratch.path("a.e");
  write_checkpoint(path, mesh, 0.1 + 0.2, fields, long_text());
  const Checkpoint read(path, comm);
  EXPECT_EQ(read.time(), 0.1 + 0.2);
  EXPECT_EQ(read.text(), long_text());
  const auto found = read.fields(mesh);
  ASSERT_EQ(found.size(), fields.size());
  for (std::size_t f = 0; f < fields.size(); ++f) {
    EXPECT_EQ(found[f].name, fields[f].name);
    for (LO n = 0; n < mesh.num_owned_nodes(); ++n) EXPECT_EQ(found[f].values(n), fields[f].values(n)); // every bit
  }
}

// A library that keeps its buffers writes what it had written before behind a text that ends within a record.
TEST(Checkpoint, ReadsBackTextsOfAnyLengthAfterLongOnes)
{
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const mesh::Mesh mesh = box();
  const auto fields = fields_of(mesh);
  const std::string path = scratch.path("a.e");
  for (std::size_t length = 0; length < 160; length += 3) {
    write_checkpoint(path, mesh, 1, fields, std::string(5000, 'l'));
    const std::string text(length, 's');
    write_checkpoint(path, mesh, 1, fields, text);
    EXPECT_EQ(Checkpoint(path, comm).text(), text);
  }
}

TEST(Checkpoint, HoldsArraysOfAnySize)
{
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const mesh::Mesh mesh = box();
  std::vector<io::NamedArray> arrays = {{"none", {}}, {"one", {-0.0}}, {"many", std::vector<double>(1000)}};
  for (std::size_t k = 0; k < 1000; ++k) arrays[2].values[k] = std::exp(static_cast<double>(k) - 700);
  const std::string path = scratch.path("a.e");
  write_checkpoint(path, mesh, 1, fields_of(mesh), "{}", arrays);
  const auto found = Checkpoint(path, comm).arrays();
  ASSERT_EQ(found.size(), arrays.size());
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    EXPECT_EQ(found[a].name, arrays[a].name);
    if (comm->getRank() == 0)
      EXPECT_EQ(found[a].values, arrays[a].values);
    else
      EXPECT_TRUE(found[a].values.empty());
  }
}

TEST(Checkpoint, RefusesAnArrayThatIsDamaged)
{
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const double value = 0.123456789;
  write_checkpoint(scratch.path("a.e"), box(), 1, fields_of(box()), "{}", {{"array", {value}}});
  if (comm->getRank() == 0) {
    std::string text = text_of(scratch.path("a.e")), bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    std::reverse(bytes.begin(), bytes.end()); // the file is big-endian
    const auto at = text.find(bytes);
    ASSERT_NE(at, std::string::npos);
    text[at + 5] ^= 1;
    scratch.write("flipped.e", text);
  }
  comm->barrier();
  expect_error(ExitCode::bad_input, {"flipped.e", "damaged", "array"},
               [&] { Checkpoint(scratch.path("flipped.e"), comm); });
}

TEST(Checkpoint, RefusesAnotherMesh)
{
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const mesh::Mesh mesh = box();
  write_checkpoint(scratch.path("a.e"), mesh, 1, fields_of(mesh), "{}");
  const Checkpoint read(scratch.path("a.e"), comm);
  expect_error(ExitCode::bad_input, {"a.e", "another mesh"}, [&] { read.fields(box(6)); });
  // As many nodes and cells, but one place differs.
  const auto moved = mesh::make_box({{0, 0}, {2, 1.0000001}, {5, 3}, {2, 1}}, comm);
  expect_error(ExitCode::bad_input, {"a.e", "another mesh"}, [&] { read.fields(moved); });
}

TEST(Checkpoint, RefusesWhatIsDamagedOrNoCheckpoint)
{
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const mesh::Mesh mesh = box();
  const std::string path = scratch.path("a.e");
  write_checkpoint(path, mesh, 1, fields_of(mesh), long_text());
  io::write_exodus(scratch.path("result.e"), "result", mesh, 1, fields_of(mesh));
  const std::string good = comm->getRank() == 0 ? text_of(path) : "";
  const auto refuses = [&](const std::string &name, const std::string &reason) {
    expect_error(ExitCode::bad_input, {name, reason}, [&] { Checkpoint(scratch.path(name), comm).fields(mesh); });
  };
  if (comm->getRank() == 0) {
    scratch.write("half.e", good.substr(0, good.size() / 2));
    scratch.write("text.e", "no Exodus file");
    std::string other = good;
    const auto at = other.find("\"version\":\"");
    ASSERT_NE(at, std::string::npos);
    other[at + 11] = '9';
    scratch.write("version.e", other);
    std::string open = other; // the last record without its mark, as versions before 0.3.0 wrote it
    const auto end = open.find('|', at);
    ASSERT_NE(end, std::string::npos);
    open[end] = ' ';
    scratch.write("open.e", open);
    std::string cut = good;
    cut[cut.find('|', cut.find("\"version\":\""))] = ' ';
    scratch.write("cut.e", cut);
    std::string flipped = good;
    flipped[flipped.size() - 20] ^= 0x10; // in the last field's values, or behind them
    scratch.write("flipped.e", flipped);
  }
  comm->barrier();
  refuses("none.e", "there is no file");
  refuses("text.e", "no Exodus file");
  refuses("half.e", "damaged");
  refuses("flipped.e", "damaged");
  refuses("result.e", "no checkpoint");
  refuses("version.e", "was written by version 9");
  refuses("open.e", "was written by version 9");
  refuses("cut.e", "damaged");
}

} // namespace
} // namespace checkpoint_test
