// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/height_file.hpp"

#include "expect_error.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <netcdf.h>
#include <sstream>
#include <unistd.h>

namespace height_file_test
{
namespace
{

using namespace rpc;
using contact::HeightTable;
using rpc::test::expect_error;

HeightTable read(const std::string &name, const std::string &bytes, const int dim = 3)
{
  return contact::read_heights(name, bytes, dim, "Contact->Obstacle->File");
}
void refuse(const std::string &name, const std::string &bytes, const std::initializer_list<std::string> &words,
            const int dim = 3)
{
  expect_error(ExitCode::bad_input, {"\"Contact->Obstacle->File\"", "\"" + name + "\""},
               [&] { read(name, bytes, dim); });
  expect_error(ExitCode::bad_input, words, [&] { read(name, bytes, dim); });
}

/// A number's bytes, the lowest or the highest first.
template <class Number>
std::string bytes_of(const Number value, const bool little)
{
  unsigned char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  std::uint16_t one = 1;
  unsigned char first = 0;
  std::memcpy(&first, &one, 1);
  std::string text(reinterpret_cast<const char *>(raw), sizeof value);
  if ((first == 1) != little) text.assign(text.rbegin(), text.rend());
  return text;
}
/// A .npy file of version 1.
std::string npy(const std::string &type, const std::string &fortran, const std::string &shape, const std::string &data)
{
  const std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + fortran + ", 'shape': (" + shape + "), }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header + data;
}
template <class Number>
std::string numbers(const std::initializer_list<double> &values, const bool little)
{
  std::string text;
  for (const double v : values) text += bytes_of(static_cast<Number>(v), little);
  return text;
}

/// 1 2 3 in the first row, 4 5 6 in the second.
void expect_six(const HeightTable &table)
{
  EXPECT_EQ(table.columns, 3);
  EXPECT_EQ(table.rows, 2);
  EXPECT_EQ(table.height, (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

TEST(Heights, OfNumpyAreReadWhateverTheirTypeAndOrder)
{
  expect_six(read("a.npy", npy("<f8", "False", "2, 3", numbers<double>({1, 2, 3, 4, 5, 6}, true))));
  expect_six(read("a.npy", npy(">f8", "False", "2, 3", numbers<double>({1, 2, 3, 4, 5, 6}, false))));
  expect_six(read("a.npy", npy(">f4", "False", "2, 3", numbers<float>({1, 2, 3, 4, 5, 6}, false))));
  expect_six(read("a.npy", npy("<f4", "True", "2, 3", numbers<float>({1, 4, 2, 5, 3, 6}, true))));
  expect_six(read("a.npy", npy(">i2", "False", "2, 3", numbers<std::int16_t>({1, 2, 3, 4, 5, 6}, false))));
  expect_six(read("A.NPY", npy("|u1", "False", "2, 3", "\1\2\3\4\5\6")));
  EXPECT_EQ(read("a.npy", npy("<i4", "False", "2,", numbers<std::int32_t>({-1, 7}, true)), 2).height,
            (std::vector<double>{-1, 7}));
  const HeightTable column = read("a.npy", npy("|i1", "False", "3, 1", "\1\2\3"), 2);
  EXPECT_EQ(column.columns, 3);
  EXPECT_EQ(column.rows, 1);
}

TEST(Heights, OfDamagedNumpyFilesAreRefused)
{
  const std::string six = numbers<double>({1, 2, 3, 4, 5, 6}, true);
  const std::string whole = npy("<f8", "False", "2, 3", six);
  refuse("a.npy", whole.substr(0, whole.size() - 3), {"is cut off", "48 bytes, it holds 45", "numpy.save"});
  refuse("a.npy", whole + "x", {"goes on behind its numbers"});
  for (const std::size_t size : {0, 5, 9, 11, 40}) refuse("a.npy", whole.substr(0, size), {"numpy.save"});
  refuse("a.npy", npy("<c16", "False", "2, 3", six), {"<c16"});
  refuse("a.npy", npy("|O", "False", "2, 3", six), {"|O"});
  refuse("a.npy", npy("<f8", "False", "1, 2, 3", six), {"two dimensions", "(1, 2, 3)"});
  refuse("a.npy", npy("<f8", "False", "6,", six), {"two dimensions", "(6,)"});
  refuse("a.npy", npy("<f8", "False", "99999999999, 3", six), {"shape"});
  refuse("a.npy", npy("<f8", "False", "999999999, 999999999", six), {"is cut off"});
  refuse("a.npy", npy("<f8", "Maybe", "2, 3", six), {"header"});
  refuse("a.npy", npy("<f8", "False", "2, 3", numbers<double>({1, 2, 3, 4, std::nan(""), 6}, true)),
         {"finite", "row 2, column 2", "Gwyddion"});
}

TEST(Heights, OfATextAreAMatrixOrHaveAHeading)
{
  expect_six(read("a.csv", "# of a profilometer\n1,2,3\r\n4,5,6\r\n"));
  expect_six(read("a.txt", "1 2\t3\n\n 4.0 +5 6e0"));
  expect_six(read("a.csv", "\xEF\xBB\xBF"
                           "1; 2; 3\n4;5;6\n"));
  const HeightTable places = read("a.csv", "\"x\",y,height\n0.5,0,2\n0,0,1\n1,0,3\n1,2,6\n0,2,4\n0.5,2,5\n");
  expect_six(places);
  EXPECT_EQ(places.spacing, (std::array<double, 2>{0.5, 2}));
  const HeightTable profile = read("a.csv", "x height\n3 7\n1 5\n", 2);
  EXPECT_EQ(profile.height, (std::vector<double>{5, 7}));
  EXPECT_EQ(profile.spacing[0], 2);
  EXPECT_EQ(read("a.csv", "1\n2\n3\n", 2).columns, 3);
}

TEST(Heights, OfTextsThatAreNoGridAreRefused)
{
  refuse("a.csv", "", {"holds no heights"});
  refuse("a.csv", "1,2,3\n4,5\n", {"as many numbers in each row", "3, got 2 in line 2"});
  refuse("a.csv", "1,2\n4,lots\n", {"got \"lots\" in line 2, column 2"});
  refuse("a.csv", "1,2\n4,nan\n", {"finite", "row 2, column 2"});
  refuse("a.csv", "1,1e-999\n4,1e999\n2,inf\n", {"finite", "row 2, column 2"});
  refuse("a.csv", "x,y,z\n0,0,1\n1,0,1\n3,0,1\n0,1,1\n1,1,1\n3,1,1\n", {"evenly spaced", "along x", "griddata"});
  refuse("a.csv", "x,y,z\n0,0,1\n1,0,1\n0,1,1\n", {"none at (1, 1)", "griddata"});
  refuse("a.csv", "x,y,z\n0,0,1\n0,0,1\n", {"each place once", "line 3"});
  refuse("a.csv", "x,y,z\n0,0,1\n0,1\n", {"3 numbers in each line", "got 2 in line 3"});
}

TEST(Heights, OfEsriGridsBeginInTheNorth)
{
  const std::string head = "NCOLS 3\nnrows 2\nxllcorner 400\nyllcorner 7\ncellsize 0.25\nNODATA_value -9999\n";
  const HeightTable table = read("a.asc", head + "4 5 6\n1 2\n3\n");
  expect_six(table);
  EXPECT_EQ(table.spacing, (std::array<double, 2>{0.25, 0.25}));
  refuse("a.asc", head + "4 5 6\n1 2\n", {"3 x 2 = 6 heights, got 5"});
  refuse("a.asc", head + "4 5 6\n1 2 3 4\n", {"got more in line 8"});
  refuse("a.asc", head + "4 5 6\n1 -9999 3\n", {"NODATA_value -9999 in line 8"});
  refuse("a.asc", "4 5 6\n1 2 3\n", {"ncols"});
  refuse("a.asc", "ncols 3\nnrows 2\n4 5 6\n1 2 3\n", {"cellsize"});
  refuse("a.asc", "ncols 3\nnrows 2.5\ncellsize 1\n", {"nrows", "2.5"});
}

/// A file of NetCDF's classic format with z(y, x) as 16-bit integers of scale 0.5, and x.
std::string netcdf(const bool upside_down)
{
  const auto word = [](const std::uint32_t n) { return bytes_of(n, false); };
  const auto name = [&](const std::string &text) {
    return word(static_cast<std::uint32_t>(text.size())) + text + std::string((4 - text.size() % 4) % 4, '\0');
  };
  const std::string dimensions = word(10) + word(2) + name("y") + word(2) + name("x") + word(3);
  const std::string scale = word(12) + word(1) + name("scale_factor") + word(6) + word(1) + bytes_of(0.5, false);
  const std::string none = word(0) + word(0);
  const auto file = [&](const std::uint32_t begin) {
    const std::string z = name("z") + word(2) + word(0) + word(1) + scale + word(3) + word(12) + word(begin);
    const std::string y = name("y") + word(1) + word(0) + none + word(6) + word(16) + word(begin + 12);
    return std::string("CDF\1") + word(0) + dimensions + none + word(11) + word(2) + z + y;
  };
  std::string text = file(static_cast<std::uint32_t>(file(0).size()));
  text += upside_down ? numbers<std::int16_t>({8, 10, 12, 2, 4, 6}, false)
                      : numbers<std::int16_t>({2, 4, 6, 8, 10, 12}, false);
  return text + (upside_down ? numbers<double>({3, 1}, false) : numbers<double>({1, 3}, false));
}

TEST(Heights, OfNetcdfAreReadWithTheirPlaces)
{
  for (const bool upside_down : {false, true}) {
    const HeightTable table = read("a.nc", netcdf(upside_down));
    expect_six(table);
    EXPECT_EQ(table.spacing, (std::array<double, 2>{0, 2}));
  }
  const std::string whole = netcdf(false);
  for (std::size_t size = 0; size < whole.size(); size += 7)
    expect_error(ExitCode::bad_input, {"\"a.nc\"", ". "}, [&] { read("a.nc", whole.substr(0, size)); });
  refuse("a.nc", "\x89HDF\r\n\x1a\n and so on", {"damaged"});
}

/// A file of NetCDF's version 4, whose heights are compressed.
std::string netcdf_4()
{
  const std::string path = testing::TempDir() + "rpc_heights_" + std::to_string(::getpid()) + ".nc";
  int file = -1, dimensions[2] = {-1, -1}, z = -1;
  const double heights[6] = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(nc_create(path.c_str(), NC_NETCDF4, &file), NC_NOERR);
  EXPECT_EQ(nc_def_dim(file, "y", 2, &dimensions[0]), NC_NOERR);
  EXPECT_EQ(nc_def_dim(file, "x", 3, &dimensions[1]), NC_NOERR);
  EXPECT_EQ(nc_def_var(file, "z", NC_DOUBLE, 2, dimensions, &z), NC_NOERR);
  EXPECT_EQ(nc_def_var_deflate(file, z, 0, 1, 9), NC_NOERR);
  EXPECT_EQ(nc_enddef(file), NC_NOERR);
  EXPECT_EQ(nc_put_var_double(file, z, heights), NC_NOERR);
  EXPECT_EQ(nc_close(file), NC_NOERR);
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  std::filesystem::remove(path);
  return bytes.str();
}

TEST(Heights, OfNetcdfsVersion4AreReadAndDamagedOnesRefused)
{
  const std::string whole = netcdf_4();
  expect_six(read("a.nc", whole));
  for (std::size_t at = 8; at < whole.size(); at += whole.size() / 40) {
    refuse("a.nc", whole.substr(0, at), {"."});
    std::string damaged = whole;
    for (std::size_t k = at; k < std::min(at + 8, whole.size()); ++k) damaged[k] = static_cast<char>(~damaged[k]);
    try {
      EXPECT_EQ(read("a.nc", damaged).height.size(), 6u) << at; // a byte that means nothing
    } catch (const Error &error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input) << at << ' ' << error.what();
    }
  }
}

} // namespace
} // namespace height_file_test
