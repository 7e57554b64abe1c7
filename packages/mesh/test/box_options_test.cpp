// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/mesh/make_mesh.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Core.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <unistd.h>

namespace box_options_test
{
namespace
{

using rpc::ExitCode;
using rpc::mesh::BoxOptions;
using rpc::mesh::GmshOptions;
using rpc::mesh::MeshOptions;
using rpc::test::expect_error;
using Teuchos::Array;
using Teuchos::ParameterList;
using Teuchos::tuple;

/// What a deck gives, read as the program does.
MeshOptions read(ParameterList list, const std::string &folder = ".")
{
  rpc::validate(list, rpc::mesh::valid_parameters(), "Mesh");
  return rpc::mesh::mesh_options(list, folder, Teuchos::SerialComm<int>());
}
BoxOptions read_box(const ParameterList &list)
{
  return std::get<BoxOptions>(read(list));
}

/// The defaults with one parameter changed.
template <class T>
ParameterList deck(const std::string &name, const T &value)
{
  ParameterList list;
  list.set(name, value);
  return list;
}

void expect_refused(const ParameterList &list, const std::initializer_list<std::string> parts,
                    const std::string &folder = ".")
{
  expect_error(ExitCode::bad_input, parts, [&] { read(list, folder); });
}

TEST(BoxOptions, DefaultsAreTheUnitSquare)
{
  const BoxOptions options = read_box(ParameterList());
  EXPECT_EQ(options.lower, (std::vector<double>{0, 0}));
  EXPECT_EQ(options.upper, (std::vector<double>{1, 1}));
  EXPECT_EQ(options.cells, (std::vector<int>{8, 8}));
  EXPECT_EQ(options.element.name(), "Q1");
  EXPECT_EQ(options.element.dim, 2);
}

TEST(BoxOptions, ElementIsReadByItsName)
{
  for (const std::string name : {"P1", "P2", "Q1", "Q2"})
    EXPECT_EQ(read_box(deck("Element", name)).element.name(), name);
}

TEST(BoxOptions, ThreeNumbersMakeItThreeDimensional)
{
  auto list = deck("Lower", Array<double>(tuple(0., 0., -1.)));
  list.set("Upper", Array<double>(tuple(1., 2., 3.))).set("Cells", Array<int>(tuple(1, 2, 3)));
  const BoxOptions options = read_box(list);
  EXPECT_EQ(options.element.dim, 3);
  EXPECT_EQ(options.element.order, 1);
  EXPECT_EQ(options.upper, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(options.cells, (std::vector<int>{1, 2, 3}));
}

TEST(BoxOptions, BadValuesAreRefusedByName)
{
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(deck("Type", "sphere"), {"\"Mesh->Type\"", "box, gmsh", "\"sphere\""});
  expect_refused(deck("Element", "Q3"), {"\"Mesh->Element\"", "\"Q3\""});
  expect_refused(deck("Lower", Array<double>(tuple(0.))), {"\"Mesh->Lower\"", "2 or 3", "got 1"});
  expect_refused(deck("Lower", Array<double>()), {"\"Mesh->Lower\"", "got 0"});
  expect_refused(deck("Upper", Array<double>(tuple(1., 1., 1.))),
                 {"\"Mesh->Upper\" must hold as many numbers as \"Lower\", 2, got 3"});
  expect_refused(deck("Cells", Array<int>(tuple(1))),
                 {"\"Mesh->Cells\" must hold as many numbers as \"Lower\" and \"Upper\", 2, got 1"});
  expect_refused(deck("Upper", Array<double>(tuple(1., 0.))), {"\"Mesh->Upper\"", "direction 2"});
  expect_refused(deck("Upper", Array<double>(tuple(-1., 1.))), {"\"Mesh->Upper\"", "direction 1"});
  expect_refused(deck("Upper", Array<double>(tuple(inf, 1.))), {"\"Mesh->Upper\"", "inf"});
  expect_refused(deck("Lower", Array<double>(tuple(nan, 0.))), {"\"Mesh->Upper\"", "nan"});
  expect_refused(deck("Cells", Array<int>(tuple(8, 0))), {"\"Mesh->Cells\"", "got 0", "direction 2"});
  expect_refused(deck("Cells", Array<int>(tuple(-8, 8))), {"\"Mesh->Cells\"", "got -8"});
  expect_refused(deck("Upper", Array<double>(tuple(1e308, 1.))), {"\"Mesh->Upper\"", "1e+50 [m]", "got 1e+308"});
  expect_refused(deck("Upper", Array<double>(tuple(1., 1e-200))), {"\"Mesh->Upper\"", "by 1e-50", "direction 2"});
  ParameterList far = deck("Lower", Array<double>(tuple(1e10, 0.)));
  far.set("Upper", Array<double>(tuple(1e10 + 1e-3, 1.)));
  expect_refused(far, {"\"Mesh->Cells\"", "1e-12 times", "1e+10 [m] in direction 1"});
  expect_refused(deck("Cells", Array<int>(tuple(100000, 100000))), {"\"Mesh->Cells\"", "nodes", "supported"});
}

TEST(BoxOptions, ExpansionRatiosGradeIt)
{
  const BoxOptions options = read_box(deck("Expansion Ratio", Array<double>(tuple(1., 8.))));
  EXPECT_FALSE(options.graded(0));
  ASSERT_TRUE(options.graded(1));
  EXPECT_EQ(options.ends[1].size(), 9U);
  const auto ratio = [](const double x, const double y) { return deck("Expansion Ratio", Array<double>(tuple(x, y))); };
  expect_refused(ratio(1, 0), {"\"Mesh->Expansion Ratio\" must be from 0.0001 to 10000", "got 0 in direction 2"});
  expect_refused(ratio(-2, 1), {"\"Mesh->Expansion Ratio\"", "got -2 in direction 1"});
  expect_refused(ratio(std::numeric_limits<double>::quiet_NaN(), 1), {"\"Mesh->Expansion Ratio\"", "got nan"});
  expect_refused(deck("Expansion Ratio", Array<double>(tuple(2.))),
                 {"\"Mesh->Expansion Ratio\" must hold as many numbers as \"Lower\" and \"Upper\", 2, got 1"});
  ParameterList thin = ratio(1, 2);
  thin.set("Cells", Array<int>(tuple(8, 1)));
  expect_refused(thin, {"\"Mesh->Expansion Ratio\" must be 1 in directions of one cell, got 2 in direction 2"});
  ParameterList endless = ratio(2, 1);
  endless.set("Periodic", "X");
  expect_refused(endless, {"\"Mesh->Expansion Ratio\" must be 1 in directions in which the box is periodic, got 2"});
}

TEST(BoxOptions, ParametersOfGmshAreRefusedByNameEvenAtTheirDefaults)
{
  expect_refused(deck("File", "a.msh"), {"\"Mesh->File\"", "does not go with \"Mesh->Type\" = box"});
  expect_refused(deck("Size Factor", 1.), {"\"Mesh->Size Factor\"", "does not go with"});
  expect_refused(deck("Order", 0), {"\"Mesh->Order\"", "does not go with"});
}

/// An own folder with a file in it, gone at the end.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "rpc_box_options_test";
  explicit Folder(const std::string &file)
  {
    path += std::to_string(::getpid()) + "_" +
            std::to_string(reinterpret_cast<std::uintptr_t>(this)); // others may run this test at the same time
    std::filesystem::create_directories(path);
    std::ofstream(path / file) << "// empty\n";
  }
  Folder(const Folder &) = delete;
  Folder &operator=(const Folder &) = delete;
  ~Folder() { std::filesystem::remove_all(path); }
};

ParameterList gmsh_deck(const std::string &file)
{
  ParameterList list;
  list.set("Type", "gmsh").set("File", file);
  return list;
}

TEST(GmshOptions, FileIsLookedForOnTheDiskOfRankZero)
{
  const auto comm = Tpetra::getDefaultComm();
  const Folder folder("body.geo");
  ParameterList list = gmsh_deck("body.geo");
  rpc::validate(list, rpc::mesh::valid_parameters(), "Mesh");
  const std::string where = comm->getRank() == 0 ? folder.path.string() : "no such folder";
  const auto options = std::get<GmshOptions>(rpc::mesh::mesh_options(list, where, *comm));
  EXPECT_EQ(options.file, rpc::text_of_rank(*comm, 0, (folder.path / "body.geo").string()));
}

TEST(GmshOptions, FileIsLookedForBesideTheDeckThenInTheCurrentFolder)
{
  const Folder folder("body.geo");
  const auto beside = std::get<GmshOptions>(read(gmsh_deck("body.geo"), folder.path.string()));
  EXPECT_TRUE(std::filesystem::equivalent(beside.file, folder.path / "body.geo")) << beside.file;
  EXPECT_EQ(beside.size_factor, 1);
  EXPECT_EQ(beside.order, 0);
  const std::string here = std::filesystem::relative(folder.path / "body.geo").string();
  EXPECT_EQ(std::get<GmshOptions>(read(gmsh_deck(here), "no such folder")).file, here);
  const std::string absolute = (folder.path / "body.geo").string();
  EXPECT_EQ(std::get<GmshOptions>(read(gmsh_deck(absolute), "no such folder")).file, absolute);
}

TEST(GmshOptions, FileThatIsNotThereIsRefusedWithThePlacesLookedAt)
{
  const Folder folder("body.geo");
  expect_refused(gmsh_deck("other.msh"), {"\"Mesh->File\"", "\"other.msh\"", folder.path.string(), "current folder"},
                 folder.path.string());
  expect_refused(deck("Type", "gmsh"), {"\"Mesh->File\"", "must name"});
}

TEST(GmshOptions, OtherExtensionsAreRefused)
{
  const Folder folder("body.abc");
  expect_refused(gmsh_deck("body.abc"), {"\"Mesh->File\"", "one of .geo, .step", "\"body.abc\""}, folder.path.string());
  expect_refused(gmsh_deck("body"), {"one of .geo, .step"}, folder.path.string());
}

TEST(GmshOptions, SizeFactorAndOrderHaveTheirRanges)
{
  const Folder folder("body.geo");
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double factor : {0., -1., inf, nan}) {
    auto list = gmsh_deck("body.geo");
    expect_refused(list.set("Size Factor", factor), {"\"Mesh->Size Factor\"", "> 0"}, folder.path.string());
  }
  for (const int order : {-1, 3}) {
    auto list = gmsh_deck("body.geo");
    expect_refused(list.set("Order", order), {"\"Mesh->Order\"", "got " + std::to_string(order)}, folder.path.string());
  }
  auto list = gmsh_deck("body.geo");
  list.set("Size Factor", 0.25).set("Order", 2);
  const auto options = std::get<GmshOptions>(read(list, folder.path.string()));
  EXPECT_EQ(options.size_factor, 0.25);
  EXPECT_EQ(options.order, 2);
}

TEST(GmshOptions, ParametersOfTheBoxAreRefusedByNameEvenAtTheirDefaults)
{
  const Folder folder("body.geo");
  const auto refused = [&](const std::string &name, const auto &value) {
    auto list = gmsh_deck("body.geo");
    expect_refused(list.set(name, value), {"\"Mesh->" + name + "\"", "does not go with \"Mesh->Type\" = gmsh"},
                   folder.path.string());
  };
  refused("Lower", Array<double>(tuple(0., 0.)));
  refused("Upper", Array<double>(tuple(1., 1.)));
  refused("Cells", Array<int>(tuple(8, 8)));
  refused("Element", std::string("Q1"));
}

TEST(MeshOptions, TellTheDimensionBeforeThereIsAMesh)
{
  auto solid = deck("Lower", Array<double>(tuple(0., 0., 0.)));
  solid.set("Upper", Array<double>(tuple(1., 1., 1.))).set("Cells", Array<int>(tuple(1, 1, 1)));
  const auto comm = Tpetra::getDefaultComm();
  EXPECT_EQ(rpc::mesh::dimension(read(ParameterList()), *comm), 2);
  EXPECT_EQ(rpc::mesh::dimension(read(solid), *comm), 3);
}

TEST(Coarser, BoxHasFewerCellsInEachDirectionButOneAtLeast)
{
  const BoxOptions box{{-1, 2, 0}, {1, 3, 0.5}, {320, 7, 2}, {3, 1}};
  const auto options = std::get<BoxOptions>(rpc::mesh::coarser(box, 4).value());
  EXPECT_EQ(options.cells, (std::vector<int>{80, 2, 1}));
  EXPECT_EQ(options.lower, box.lower);
  EXPECT_EQ(options.upper, box.upper);
  EXPECT_TRUE(options.element == box.element);
  EXPECT_EQ(std::get<BoxOptions>(rpc::mesh::coarser(box, 1).value()).cells, box.cells);
  EXPECT_EQ(std::get<BoxOptions>(rpc::mesh::coarser(box, 1e300).value()).cells, (std::vector<int>{1, 1, 1}));
}

TEST(Coarser, GeometryIsMeshedWithLargerCells)
{
  const auto options = std::get<GmshOptions>(rpc::mesh::coarser(GmshOptions{"body.geo", 0.5, 1}, 3).value());
  EXPECT_EQ(options.file, "body.geo");
  EXPECT_EQ(options.size_factor, 1.5);
  EXPECT_EQ(options.order, 1);
}

TEST(Coarser, MeshFileCannotBeCoarsened)
{
  EXPECT_FALSE(rpc::mesh::coarser(GmshOptions{"body.msh"}, 2));
}

TEST(MemoryOfABox, ARefusalTellsHowManyNodesFit)
{
  constexpr double gib = 1 << 30;
  EXPECT_FALSE(rpc::mesh::memory_refusal(1'000'000, 1024, gib, "memory"));
  const auto refusal = rpc::mesh::memory_refusal(2'097'152, 1024, gib, "the GPU's memory");
  ASSERT_TRUE(refusal);
  for (const char *const part : {"2097152 nodes", "at least 2 GiB of the GPU's memory", "at most 1 GiB",
                                 "enough for 1048576 nodes", "more ranks on more machines or GPUs"})
    EXPECT_NE(refusal->find(part), std::string::npos) << *refusal;
}

TEST(Coarser, FactorBelowOneIsRefused)
{
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double factor : {0.5, 0., -2., inf, nan})
    expect_error(ExitCode::bad_input, {"factor", ">= 1"}, [&] { rpc::mesh::coarser(BoxOptions(), factor); });
}

} // namespace
} // namespace box_options_test
