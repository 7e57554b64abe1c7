// SPDX-License-Identifier: BSD-3-Clause
#include "height_formats.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

/// NetCDF's classic format, by its published grammar: a damaged file breaks down the NetCDF library itself (4.9), and with it the run.
namespace rpc::contact
{
namespace
{

/// The numbers of a file, from the highest byte to the lowest. Versions 1 and 2 have counts of 4 bytes, version 5 of 8; places in the file
/// have 4 bytes in version 1 alone.
class NetcdfBytes
{
public:
  explicit NetcdfBytes(const HeightFile &file) : file_(file), version_(file.bytes.size() > 3 ? file.bytes[3] : 0)
  {
    RPC_REQUIRE(
        file.bytes.compare(0, 8, "\x89HDF\r\n\x1a\n") != 0,
        file.where << "must be of NetCDF's classic format, got HDF5. Convert it: nccopy -k classic in.nc out.nc");
    RPC_REQUIRE(file.bytes.compare(0, 3, "CDF") == 0 && (version_ == 1 || version_ == 2 || version_ == 5),
                file.where << "does not begin as a NetCDF file does. Write it again");
  }
  std::uint64_t whole(const std::size_t size)
  {
    require_room(size);
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < size; ++k) value = value << 8 | static_cast<unsigned char>(file_.bytes[at_ + k]);
    at_ += size;
    return value;
  }
  std::uint64_t count() { return whole(version_ == 5 ? 8 : 4); }
  std::uint64_t place() { return whole(version_ == 1 ? 4 : 8); }
  std::string text(const std::uint64_t size)
  {
    require_room(size);
    const std::string found = file_.bytes.substr(at_, size);
    skip(size);
    return found;
  }
  std::string name() { return text(count()); }
  /// Over values, which are filled up to words of 4 bytes.
  void skip(const std::uint64_t size)
  {
    require_room(size);
    at_ += std::min<std::size_t>(size + (4 - size % 4) % 4, file_.bytes.size() - at_);
  }
  /// How many entries a list has, whose mark is `mark` unless it is empty.
  std::uint64_t list(const std::uint64_t mark)
  {
    const std::uint64_t found = whole(4), entries = count();
    if ((found != mark && (found != 0 || entries != 0)) || entries > file_.bytes.size()) fail();
    return entries;
  }
  void go_to(const std::uint64_t place)
  {
    if (place > file_.bytes.size()) fail();
    at_ = place;
  }
  std::size_t at() const { return at_; }
  /// Whether a file that ends here is cut off.
  void require_room(const std::uint64_t size) const
  {
    if (size > file_.bytes.size() - at_) fail();
  }
  /// A number of one of the format's types.
  double number(const std::uint64_t type)
  {
    const std::uint64_t bits = whole(size_of(type));
    const auto as = [&](auto value, auto same_bits) {
      same_bits = static_cast<decltype(same_bits)>(bits);
      std::memcpy(&value, &same_bits, sizeof value);
      return static_cast<double>(value);
    };
    switch (type) {
    case 1:
      return as(std::int8_t(), std::uint8_t());
    case 3:
      return as(std::int16_t(), std::uint16_t());
    case 4:
      return as(std::int32_t(), std::uint32_t());
    case 5:
      return as(float(), std::uint32_t());
    case 6:
      return as(double(), std::uint64_t());
    case 10:
      return as(std::int64_t(), std::uint64_t());
    default:
      return static_cast<double>(bits); // without sign
    }
  }
  std::size_t size_of(const std::uint64_t type) const
  {
    const std::size_t sizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    if (type < 1 || type > 11) fail();
    return sizes[type];
  }
  [[noreturn]] void fail() const
  {
    throw Error(ExitCode::bad_input, file_.where + "is cut off or damaged: it breaks NetCDF's grammar at byte " +
                                         std::to_string(at_) + ". Write it again");
  }

private:
  const HeightFile &file_;
  int version_;
  std::size_t at_ = 4;
};

/// Marks of lists, and a type.
struct NetcdfWord {
  static constexpr std::uint64_t dimensions = 10, variables = 11, attributes = 12, text = 2;
};

struct NetcdfDimension {
  std::string name;
  std::uint64_t length;
};
struct NetcdfVariable {
  std::string name;
  std::vector<std::size_t> dimension;
  std::map<std::string, double> attribute; // those of one number
  std::uint64_t type, begin;
};

class NetcdfHeights
{
public:
  explicit NetcdfHeights(const HeightFile &file) : file_(file), in_(file)
  {
    in_.count(); // of records
    for (std::uint64_t left = in_.list(NetcdfWord::dimensions); left > 0; --left) {
      const std::string name = in_.name();
      dimensions_.push_back({name, in_.count()});
    }
    attributes();
    for (std::uint64_t left = in_.list(NetcdfWord::variables); left > 0; --left) {
      NetcdfVariable v;
      v.name = in_.name();
      for (std::uint64_t more = in_.count(); more > 0; --more) {
        v.dimension.push_back(in_.count());
        if (v.dimension.back() >= dimensions_.size()) in_.fail();
      }
      v.attribute = attributes();
      v.type = in_.whole(4);
      in_.size_of(v.type);
      in_.count(); // of bytes, which follows from the rest
      v.begin = in_.place();
      variables_.push_back(v);
    }
  }

  HeightTable table()
  {
    const NetcdfVariable &z = heights();
    HeightTable table;
    const std::size_t columns_at = z.dimension.back();
    const std::uint64_t rows = z.dimension.size() == 1 ? 1 : dimensions_[z.dimension[0]].length,
                        columns = dimensions_[columns_at].length;
    const std::vector<double> read = numbers(z, rows, columns);
    table.rows = static_cast<int>(rows);
    table.columns = static_cast<int>(columns);
    const auto [dx, along_x] = spacing_along(dimensions_[columns_at]);
    const auto [dy, along_y] =
        z.dimension.size() == 1 ? std::array<double, 2>{0, 1} : spacing_along(dimensions_[z.dimension[0]]);
    table.spacing = {dx, dy};
    for (const char *const name : {"_FillValue", "missing_value"}) {
      if (z.attribute.count(name) == 0) continue;
      const auto found = std::find(read.begin(), read.end(), z.attribute.at(name));
      RPC_REQUIRE(found == read.end(), file_.where << "must have a height at each place, got its " << name << " in row "
                                                   << (found - read.begin()) / table.columns + 1 << ", column "
                                                   << (found - read.begin()) % table.columns + 1
                                                   << ". Fill in what was not measured, or cut it off");
    }
    const double factor = z.attribute.count("scale_factor") > 0 ? z.attribute.at("scale_factor") : 1,
                 offset = z.attribute.count("add_offset") > 0 ? z.attribute.at("add_offset") : 0;
    for (int j = 0; j < table.rows; ++j)
      for (int i = 0; i < table.columns; ++i) {
        const int row = along_y < 0 ? table.rows - 1 - j : j, column = along_x < 0 ? table.columns - 1 - i : i;
        table.height.push_back(factor * read[static_cast<std::size_t>(row) * table.columns + column] + offset);
      }
    return table;
  }

private:
  /// Those of one number; others are passed over.
  std::map<std::string, double> attributes()
  {
    std::map<std::string, double> found;
    for (std::uint64_t left = in_.list(NetcdfWord::attributes); left > 0; --left) {
      const std::string name = in_.name();
      const std::uint64_t type = in_.whole(4), count = in_.count(), size = in_.size_of(type);
      if (count > file_.bytes.size()) in_.fail();
      const std::size_t begin = in_.at();
      in_.skip(count * size);
      const std::size_t end = in_.at();
      if (count != 1 || type == NetcdfWord::text) continue;
      in_.go_to(begin);
      found[name] = in_.number(type);
      in_.go_to(end);
    }
    return found;
  }
  std::vector<double> numbers(const NetcdfVariable &v, const std::uint64_t rows, const std::uint64_t columns)
  {
    RPC_REQUIRE(rows > 0 && columns > 0, file_.where << "has an array " << shown_name(v.name)
                                                     << " along a dimension that may grow, or of length 0. Fix it: "
                                                     << "ncks --fix_rec_dmn NAME in.nc out.nc");
    in_.go_to(v.begin);
    const std::uint64_t most = file_.bytes.size();
    if (rows > most || columns > most || rows * columns > most) in_.fail();
    in_.require_room(rows * columns * in_.size_of(v.type));
    std::vector<double> read(rows * columns);
    for (double &value : read) value = in_.number(v.type);
    return read;
  }
  bool is_coordinate(const NetcdfVariable &v) const
  {
    return v.dimension.size() == 1 && v.name == dimensions_[v.dimension[0]].name;
  }
  static std::string shown_name(std::string name)
  {
    for (char &c : name)
      if (c < ' ' || c > '~') c = '?';
    return "\"" + name.substr(0, 40) + "\"";
  }
  /// The only array of heights, or the one that is called so.
  const NetcdfVariable &heights() const
  {
    std::vector<const NetcdfVariable *> found;
    std::vector<std::string> names;
    for (const NetcdfVariable &v : variables_) {
      const std::size_t dimensions = v.dimension.size();
      const bool fits = dimensions == 2 || (dimensions == 1 && file_.dim == 2);
      if (v.type == NetcdfWord::text || is_coordinate(v) || !fits) continue;
      found.push_back(&v);
      names.push_back(shown_name(v.name));
    }
    RPC_REQUIRE(!found.empty(), file_.where << "has no array of "
                                            << (file_.dim == 2 ? "one or two dimensions" : "two dimensions")
                                            << ". Write the heights as z(y, x)");
    if (found.size() == 1) return *found[0];
    for (const char *const known : {"z", "height", "heights"})
      for (const NetcdfVariable *const v : found)
        if (v->name == known) return *v;
    throw Error(ExitCode::bad_input,
                file_.where + "has several arrays, " + join(names) +
                    ", and none is called z, height or heights. Take one out: ncks -v NAME in.nc out.nc");
  }
  /// The step along a dimension, and its sign; 0 where the file does not say it.
  std::array<double, 2> spacing_along(const NetcdfDimension &dimension)
  {
    for (const NetcdfVariable &v : variables_)
      if (v.type != NetcdfWord::text && is_coordinate(v) && v.name == dimension.name) {
        const auto [step, sign] = even_spacing(file_, shown_name(v.name), numbers(v, 1, dimension.length));
        return {step, sign == 0 ? 1 : sign};
      }
    return {0, 1};
  }

  const HeightFile &file_;
  NetcdfBytes in_;
  std::vector<NetcdfDimension> dimensions_;
  std::vector<NetcdfVariable> variables_;
};

} // namespace

HeightTable read_netcdf(const HeightFile &file)
{
  return NetcdfHeights(file).table();
}

} // namespace rpc::contact
