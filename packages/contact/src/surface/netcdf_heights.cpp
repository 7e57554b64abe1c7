// SPDX-License-Identifier: BSD-3-Clause
#include "height_formats.hpp"
#include "rpc/core/child_process.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <netcdf.h>
#include <netcdf_mem.h>
#include <optional>

namespace rpc::contact
{
namespace
{

/// A NetCDF file in memory, of the classic format or of version 4.
class NetcdfHeights
{
public:
  explicit NetcdfHeights(const HeightFile &file) : file_(file)
  {
    is_hdf5_ = file.bytes.compare(0, 8, "\x89HDF\r\n\x1a\n") == 0;
    const std::string begin = file.bytes.substr(0, 4);
    RPC_REQUIRE(is_hdf5_ || begin == std::string("CDF\1") || begin == std::string("CDF\2") ||
                    begin == std::string("CDF\5"),
                file.where << "does not begin as a NetCDF file does. Write it again");
    check(nc_open_mem("heights", NC_NOWRITE, file.bytes.size(), const_cast<char *>(file.bytes.data()), &id_), "open");
  }
  ~NetcdfHeights()
  {
    if (id_ >= 0) nc_close(id_);
  }
  NetcdfHeights(const NetcdfHeights &) = delete;
  NetcdfHeights &operator=(const NetcdfHeights &) = delete;

  HeightTable table() const
  {
    const int variable = heights();
    const std::vector<int> dimensions = dimensions_of(variable);
    HeightTable table;
    std::array<std::size_t, 2> size{1, 1}; // rows, columns
    const int first = dimensions.size() == 1 ? 1 : 0;
    double signs[2] = {1, 1};
    for (std::size_t k = 0; k < dimensions.size(); ++k) {
      size[first + k] = length_of(dimensions[k]);
      const int c = 1 - static_cast<int>(first + k);
      const auto [step, sign] = spacing_along(dimensions[k]);
      table.spacing[c] = step;
      signs[c] = sign;
    }
    RPC_REQUIRE(size[0] > 0 && size[1] > 0 && size[0] < 1000000 && size[1] < 1000000 &&
                    (is_hdf5_ || size[0] * size[1] <= file_.bytes.size()), // that of version 4 may be compressed
                file_.where << "is cut off: it says " << size[0] << " x " << size[1] << " heights, and has "
                            << file_.bytes.size() << " bytes. Write it again");
    table.rows = static_cast<int>(size[0]);
    table.columns = static_cast<int>(size[1]);
    std::vector<double> read(size[0] * size[1]);
    check(nc_get_var_double(id_, variable, read.data()), "read");
    const double factor = attribute(variable, "scale_factor", 1), offset = attribute(variable, "add_offset", 0);
    for (const char *const name : {"_FillValue", "missing_value"}) {
      const double missing = attribute(variable, name, NAN);
      const auto found = std::find(read.begin(), read.end(), missing);
      RPC_REQUIRE(found == read.end(), file_.where << "must have a height at each place, got its " << name << " in row "
                                                   << (found - read.begin()) / table.columns + 1 << ", column "
                                                   << (found - read.begin()) % table.columns + 1
                                                   << ". Fill in what was not measured, or cut it off");
    }
    table.height.resize(read.size());
    for (int j = 0; j < table.rows; ++j)
      for (int i = 0; i < table.columns; ++i) {
        const int row = signs[1] < 0 ? table.rows - 1 - j : j, column = signs[0] < 0 ? table.columns - 1 - i : i;
        table.height[static_cast<std::size_t>(j) * table.columns + i] =
            factor * read[static_cast<std::size_t>(row) * table.columns + column] + offset;
      }
    return table;
  }

private:
  void check(const int status, const std::string &what) const
  {
    RPC_REQUIRE(status == NC_NOERR, file_.where << "is damaged: NetCDF cannot " << what << " it ("
                                                << nc_strerror(status) << "). Write it again");
  }
  std::string name_of(const int variable) const
  {
    char name[NC_MAX_NAME + 1] = {};
    check(nc_inq_varname(id_, variable, name), "read");
    return name;
  }
  std::vector<int> dimensions_of(const int variable) const
  {
    int count = 0;
    check(nc_inq_varndims(id_, variable, &count), "read");
    std::vector<int> dimensions(count);
    if (count > 0) check(nc_inq_vardimid(id_, variable, dimensions.data()), "read");
    return dimensions;
  }
  std::size_t length_of(const int dimension) const
  {
    std::size_t length = 0;
    check(nc_inq_dimlen(id_, dimension, &length), "read");
    return length;
  }
  double attribute(const int variable, const char *const name, const double standard) const
  {
    std::size_t length = 0;
    nc_type type = NC_NAT;
    double value = standard;
    if (nc_inq_att(id_, variable, name, &type, &length) != NC_NOERR || length != 1 || type == NC_CHAR) return standard;
    check(nc_get_att_double(id_, variable, name, &value), "read");
    return value;
  }
  bool is_coordinate(const int variable) const
  {
    const std::vector<int> dimensions = dimensions_of(variable);
    char name[NC_MAX_NAME + 1] = {};
    if (dimensions.size() != 1) return false;
    check(nc_inq_dimname(id_, dimensions[0], name), "read");
    return name_of(variable) == name;
  }
  /// The only array of heights, or the one that is called so.
  int heights() const
  {
    int count = 0;
    check(nc_inq_nvars(id_, &count), "read");
    std::vector<int> found;
    std::vector<std::string> names;
    for (int variable = 0; variable < count; ++variable) {
      nc_type type = NC_NAT;
      check(nc_inq_vartype(id_, variable, &type), "read");
      const std::size_t dimensions = dimensions_of(variable).size();
      if (type == NC_CHAR || is_coordinate(variable) || !(dimensions == 2 || (dimensions == 1 && file_.dim == 2)))
        continue;
      found.push_back(variable);
      names.push_back(name_of(variable));
    }
    RPC_REQUIRE(!found.empty(), file_.where << "has no array of "
                                            << (file_.dim == 2 ? "one or two dimensions" : "two dimensions")
                                            << ". Write the heights as z(y, x)");
    if (found.size() == 1) return found[0];
    for (const char *const known : {"z", "height", "heights"})
      for (std::size_t k = 0; k < names.size(); ++k)
        if (names[k] == known) return found[k];
    throw Error(ExitCode::bad_input,
                file_.where + "has several arrays, " + join(names) +
                    ", and none is called z, height or heights. Take one out: ncks -v NAME in.nc out.nc");
  }
  std::array<double, 2> spacing_along(const int dimension) const
  {
    char name[NC_MAX_NAME + 1] = {};
    check(nc_inq_dimname(id_, dimension, name), "read");
    int variable = -1;
    if (nc_inq_varid(id_, name, &variable) != NC_NOERR || !is_coordinate(variable)) return {0, 1};
    const std::size_t length = length_of(dimension);
    RPC_REQUIRE(is_hdf5_ || length <= file_.bytes.size(), file_.where << "is cut off. Write it again");
    std::vector<double> places(length);
    check(nc_get_var_double(id_, variable, places.data()), "read");
    const auto [step, sign] = even_spacing(file_, name, places);
    return {step, sign == 0 ? 1 : sign};
  }

  const HeightFile &file_;
  int id_ = -1;
  bool is_hdf5_ = false;
};

/// Numbers of a table, one after the other.
std::string packed(const HeightTable &table)
{
  std::vector<double> numbers{double(table.columns), double(table.rows), table.spacing[0], table.spacing[1]};
  numbers.insert(numbers.end(), table.height.begin(), table.height.end());
  return {reinterpret_cast<const char *>(numbers.data()), numbers.size() * sizeof(double)};
}

HeightTable unpacked_table(const std::string &bytes)
{
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  HeightTable table;
  table.columns = static_cast<int>(numbers[0]);
  table.rows = static_cast<int>(numbers[1]);
  table.spacing = {numbers[2], numbers[3]};
  table.height.assign(numbers.begin() + 4, numbers.end());
  return table;
}

} // namespace

HeightTable read_netcdf(const HeightFile &file)
{
  // Damaged files break down the library, version 4.9.
  const std::optional<std::string> bytes = in_child_process([&] { return packed(NetcdfHeights(file).table()); });
  RPC_REQUIRE(bytes, file.where << "is damaged: the NetCDF library broke down on it. Write it again");
  return unpacked_table(*bytes);
}

} // namespace rpc::contact
