// SPDX-License-Identifier: BSD-3-Clause
#include "height_formats.hpp"
#include "rpc/core/byte_order.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <regex>

namespace rpc::contact
{
namespace
{

constexpr const char *save_again =
    ". Write it again by numpy.save(\"heights.npy\", numpy.asarray(heights, dtype=float))";

/// A number of `size` bytes, which stand in the machine's order.
double npy_number(const char kind, const int size, const unsigned char *const bytes)
{
  const auto as = [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  if (kind == 'f') return size == 4 ? as(float()) : as(double());
  if (kind == 'i')
    return size == 1   ? as(std::int8_t())
           : size == 2 ? as(std::int16_t())
           : size == 4 ? as(std::int32_t())
                       : as(std::int64_t());
  return size == 1   ? as(std::uint8_t())
         : size == 2 ? as(std::uint16_t())
         : size == 4 ? as(std::uint32_t())
                     : as(std::uint64_t());
}

/// What stands behind 'name': in a header, up to a comma or the end.
std::string npy_entry(const HeightFile &file, const std::string &header, const std::string &form)
{
  std::smatch found;
  RPC_REQUIRE(std::regex_search(header, found, std::regex(form)),
              file.where << "has a header that is no array's of NumPy" << save_again);
  return found[1];
}

} // namespace

/// NumPy's format, versions 1 to 3: a magic word, the length of the header, the header as a Python dictionary, the numbers.
HeightTable read_npy(const HeightFile &file)
{
  const std::string &bytes = file.bytes;
  const auto byte = [&](const std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  RPC_REQUIRE(bytes.size() >= 12 && bytes.compare(0, 6, "\x93NUMPY") == 0 && byte(6) >= 1 && byte(6) <= 3,
              file.where << "does not begin as a .npy file of versions 1 to 3 does" << save_again);
  const std::size_t begin = byte(6) == 1 ? 10 : 12;
  std::size_t length = byte(8) + 256U * byte(9);
  if (byte(6) > 1) length += 65536U * (byte(10) + 256U * byte(11));
  RPC_REQUIRE(length <= bytes.size() - begin, file.where << "is cut off: its header has " << length
                                                         << " bytes, the file " << bytes.size() << save_again);
  RPC_REQUIRE(length <= 4096,
              file.where << "has a header of " << length << " bytes, which no array of numbers has" << save_again);
  const std::string header = bytes.substr(begin, length);
  const std::string type = npy_entry(file, header, "'descr'\\s*:\\s*'([^']*)'");
  const bool is_fortran = npy_entry(file, header, "'fortran_order'\\s*:\\s*(True|False)") == "True";
  const std::string shape_text = npy_entry(file, header, "'shape'\\s*:\\s*\\(([0-9, ]*)\\)");
  const bool known = std::regex_match(type, std::regex("[<>=|](f[48]|[iu][1248])"));
  RPC_REQUIRE(known, file.where << "must hold real numbers of 4 or 8 bytes or integers, got the type \"" << type << "\""
                                << save_again);
  std::vector<std::size_t> shape;
  const std::regex number("[0-9]+");
  for (std::sregex_iterator it(shape_text.begin(), shape_text.end(), number), end; it != end; ++it) {
    RPC_REQUIRE(it->str().size() < 10,
                file.where << "has a shape (" << shape_text << ") beyond all files" << save_again);
    shape.push_back(std::stoul(it->str()));
  }
  RPC_REQUIRE(shape.size() == 2 || (shape.size() == 1 && file.dim == 2),
              file.where << "must be an array of "
                         << (file.dim == 2 ? "one or two dimensions" : "two dimensions, rows and columns")
                         << ", got the shape (" << shape_text << ")");
  if (shape.size() == 1) shape = {1, shape[0]};
  const int size = type[2] - '0';
  const std::size_t count = shape[0] * shape[1], held = bytes.size() - begin - length;
  RPC_REQUIRE(count * size == held, file.where
                                        << (held < count * size ? "is cut off: " : "goes on behind its numbers: ")
                                        << shape[0] << " x " << shape[1] << " numbers of " << size << " bytes are "
                                        << count * size << " bytes, it holds " << held << save_again);
  HeightTable table;
  table.rows = static_cast<int>(shape[0]);
  table.columns = static_cast<int>(shape[1]);
  table.height.resize(count);
  const bool turns = size > 1 && ((type[0] == '<' && !is_little_endian()) || (type[0] == '>' && is_little_endian()));
  for (std::size_t k = 0; k < count; ++k) {
    unsigned char number_bytes[8];
    std::memcpy(number_bytes, bytes.data() + begin + length + k * size, size);
    if (turns) std::reverse(number_bytes, number_bytes + size);
    const std::size_t at = is_fortran ? k % shape[0] * shape[1] + k / shape[0] : k;
    table.height[at] = npy_number(type[1], size, number_bytes);
  }
  return table;
}

} // namespace rpc::contact
