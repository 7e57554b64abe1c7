// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"
#include "rpc/core/kokkos.hpp"
#include "rpc/io/atomic_file.hpp"
#include "rpc/io/exodus.hpp"
#include "rpc/mesh/element.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exodusII.h>
#include <fcntl.h>
#include <netcdf.h>
#include <numeric>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace rpc::io
{

/// Facets of a file's mesh, 1-based as Exodus counts, ordered by cell and ordinal.
struct SideSet {
  std::string name;
  std::vector<int> cell, ordinal;
};

/// What the file's header fixes.
struct ExodusHeader {
  std::string title;
  std::vector<std::string> info, field_names, cell_field_names;
  mesh::Element element;
  std::vector<std::string> blocks;
  std::vector<GO> block_sizes; // cells in each
  GO num_nodes, num_cells;
};

/// What a file that has a rank's part of a mesh says of the whole.
struct ExodusShare {
  int num_parts = 0;
  GO num_nodes = 0, num_cells = 0;           // of the whole mesh
  std::vector<int> block_sizes, side_sizes;  // cells in each block, facets of each side
  std::vector<int> node_number, cell_number; // (nodes), (cells) in the whole mesh, 1-based
};

/// The library takes arrays of pointers to non-const characters, which it only reads.
inline std::vector<char *> pointers(std::vector<std::string> &texts)
{
  std::vector<char *> result;
  for (auto &text : texts) result.push_back(text.data());
  return result;
}

inline std::vector<std::string> cut(std::vector<std::string> texts, const std::size_t length)
{
  for (auto &text : texts) text.resize(std::min(text.size(), length));
  return texts;
}

/// Makes a file end after some of its times. The NetCDF library counts a time as soon as anything of it is written; the number is a
/// big-endian integer after the four letters of the format, of 4 bytes, in its version 5 of 8 (NetCDF's "classic format").
inline void set_number_of_times(const std::string &path, const int number)
{
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) return;
  std::array<char, 4> letters{};
  std::array<unsigned char, 8> bytes{};
  if (::pread(fd, letters.data(), letters.size(), 0) == 4 && std::memcmp(letters.data(), "CDF", 3) == 0) {
    const std::size_t size = letters[3] == 5 ? 8 : 4;
    for (std::size_t k = 0; k < 4; ++k) bytes[size - 1 - k] = static_cast<unsigned char>(number >> 8 * k);
    while (::pwrite(fd, bytes.data(), size, 4) < 0 && errno == EINTR) {
    }
  }
  ::close(fd);
}

/// An Exodus file that one rank writes, under its temporary name until commit() or publish(). Private to io.
/// The Exodus library defines all arrays and writes the small ones. rpc writes coordinates, cells, times and fields by calls of NetCDF, the
/// library that Exodus itself writes by: a file that Exodus has opened is read and written 4 kB at a time, which it offers no way to change.
class ExodusWriter
{
public:
  /// @param longest  length of its names
  ExodusWriter(const std::string &path, const std::size_t longest) : path_(path), file_(path)
  {
    ex_opts(EX_DEFAULT); // errors come as return codes, not on the console
    int word_size = sizeof(double), file_word_size = sizeof(double);
    id_ = ex_create(file_.temporary().c_str(), EX_CLOBBER | EX_LARGE_MODEL, &word_size, &file_word_size);
    if (id_ < 0) fail("create");
    check(ex_set_max_name_length(id_, static_cast<int>(longest)), "define the names of");
  }
  /// Of a published file a time that could not be written goes.
  ~ExodusWriter()
  {
    if (id_ >= 0) ex_close(id_);
    if (netcdf_ >= 0) nc_close(netcdf_);
    if (published_ && begun_ > whole_) set_number_of_times(path_, whole_);
  }
  ExodusWriter(const ExodusWriter &) = delete;
  ExodusWriter &operator=(const ExodusWriter &) = delete;

  /// @param share  null: the file has the whole mesh
  void put_header(const ExodusHeader &header, const std::vector<SideSet> &sides, const std::vector<NamedArray> &arrays,
                  const ExodusShare *const share = nullptr)
  {
    if (share) {
      std::string kind = "p"; // one rank's part
      check(ex_put_init_info(id_, share->num_parts, 1, kind.data()), "define");
      check(ex_put_init_global(id_, share->num_nodes, share->num_cells, static_cast<int64_t>(header.blocks.size()),
                               static_cast<int64_t>(arrays.size()), static_cast<int64_t>(sides.size())),
            "define");
    }
    define(header, sides, arrays);
    put_names(header, sides, arrays);
    put_sides(sides);
    put_arrays(arrays);
    if (share) {
      put_whole(*share);
      if (header.num_nodes > 0)
        check(ex_put_id_map(id_, EX_NODE_MAP, share->node_number.data()), "write the numbers of the nodes of");
      if (header.num_cells > 0)
        check(ex_put_id_map(id_, EX_ELEM_MAP, share->cell_number.data()), "write the numbers of the cells of");
    }
    check(ex_close(std::exchange(id_, -1)), "write");
    open_for_data(header);
  }
  /// @param first  node, from 0
  void put_coordinate(const int direction, const GO first, const std::vector<double> &values)
  {
    if (values.empty()) return;
    const std::size_t start = first, count = values.size();
    check_netcdf(nc_put_vara_double(netcdf_, coordinates_[direction], &start, &count, values.data()),
                 "write the coordinates of");
  }
  /// @param first  cell, from 0; they run block by block   @param nodes  (cells, nodes per cell)
  void put_cells(const GO first, const std::vector<int> &nodes)
  {
    in_blocks(first, static_cast<GO>(nodes.size()) / nodes_per_cell_,
              [&](const std::size_t block, const std::size_t begin, const std::size_t number, const GO offset) {
                const std::array start = {begin, std::size_t(0)};
                const std::array count = {number, static_cast<std::size_t>(nodes_per_cell_)};
                check_netcdf(nc_put_vara_int(netcdf_, cells_[block], start.data(), count.data(),
                                             nodes.data() + offset * nodes_per_cell_),
                             "write the cells of");
              });
  }
  /// @param first  cell, from 0; they run block by block
  void put_cell_field(const int step, const int index, const GO first, const std::vector<double> &values)
  {
    in_blocks(first, static_cast<GO>(values.size()),
              [&](const std::size_t block, const std::size_t begin, const std::size_t number, const GO offset) {
                const std::array start = {static_cast<std::size_t>(step - 1), begin};
                const std::array count = {std::size_t(1), number};
                check_netcdf(nc_put_vara_double(netcdf_, cell_fields_[index][block], start.data(), count.data(),
                                                values.data() + offset),
                             "write a field of");
              });
  }
  GO num_cells() const { return std::accumulate(blocks_.begin(), blocks_.end(), GO(0)); }
  /// @param step  from 1
  void put_time(const int step, const double time)
  {
    begun_ = step;
    const std::size_t start = step - 1;
    check_netcdf(nc_put_var1_double(netcdf_, time_, &start, &time), "write a time of");
  }
  /// All fields of the time are written.
  void flush_time()
  {
    if (published_) check_netcdf(nc_sync(netcdf_), "write a time of");
  }
  /// The time stays, in the files of other ranks too.
  void keep_time() { whole_ = begun_; }
  void publish()
  {
    check_netcdf(nc_sync(netcdf_), "write");
    file_.publish();
    published_ = true;
  }
  /// @param first  node, from 0
  void put_field(const int step, const int index, const GO first, const std::vector<double> &values)
  {
    if (values.empty()) return;
    const std::array start = {static_cast<std::size_t>(step - 1), static_cast<std::size_t>(first)};
    const std::array count = {std::size_t(1), values.size()};
    check_netcdf(nc_put_vara_double(netcdf_, fields_[index], start.data(), count.data(), values.data()),
                 "write a field of");
  }
  /// Closes the file, and brings it to the disk.
  void finish()
  {
    check_netcdf(nc_close(std::exchange(netcdf_, -1)), "close");
    file_.sync();
  }
  /// Gives the finished file its name, if it has none yet.
  void commit() { file_.publish(); }

private:
  /// Calls `put` with the parts of cells first .. first + number - 1 that lie in each block: the block, the first cell in it, how many there
  /// are, and how many cells lie between `first` and them.
  template <class Put>
  void in_blocks(const GO first, const GO number, const Put &put) const
  {
    const GO end = first + number;
    GO block_begin = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const GO from = std::max(first, block_begin), to = std::min(end, block_begin + blocks_[b]);
      if (from < to)
        put(b, static_cast<std::size_t>(from - block_begin), static_cast<std::size_t>(to - from), from - first);
      block_begin += blocks_[b];
    }
  }

  static constexpr std::size_t room_for_file = 1 << 14; // bytes

  /// Leaves free bytes between the header, with which the file begins, and the first array. Exodus defines a file in steps, each of which
  /// lengthens the header. Without free bytes NetCDF moves all arrays each time, though nothing is written to them yet.
  /// To be called when the file has an array: NetCDF forgets the free bytes of a file without one. NetCDF's number of a file is Exodus' number.
  /// @param count  of blocks, sides, arrays and fields that are to be defined
  void leave_room(const std::size_t count)
  {
    constexpr std::size_t for_each = 1 << 10, alignment = 4; // bytes
    check_netcdf(nc_redef(id_), "define");
    check_netcdf(nc__enddef(id_, room_for_file + for_each * count, alignment, 0, alignment), "define");
  }

  void define(const ExodusHeader &header, const std::vector<SideSet> &sides, const std::vector<NamedArray> &arrays)
  {
    std::string program = "rpc", version = RPC_VERSION, date, time;
    char *qa[1][4] = {{program.data(), version.data(), date.data(), time.data()}};
    check(ex_put_qa(id_, 1, qa), "define");
    leave_room(header.blocks.size() * (1 + header.cell_field_names.size()) + sides.size() + arrays.size() +
               header.field_names.size());
    const auto &element = header.element;
    check(ex_put_init(id_, header.title.substr(0, MAX_LINE_LENGTH).c_str(), element.dim, header.num_nodes,
                      header.num_cells, static_cast<int64_t>(header.blocks.size()), static_cast<int64_t>(arrays.size()),
                      static_cast<int64_t>(sides.size())),
          "define");
    auto info = cut(header.info, MAX_LINE_LENGTH);
    if (!info.empty()) check(ex_put_info(id_, static_cast<int>(info.size()), pointers(info).data()), "define");
    blocks_ = header.block_sizes;
    nodes_per_cell_ = element.num_nodes();
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      check(
          ex_put_block(id_, EX_ELEM_BLOCK, b + 1, element.exodus_name().c_str(), blocks_[b], nodes_per_cell_, 0, 0, 0),
          "define");
    for (std::size_t s = 0; s < sides.size(); ++s)
      check(ex_put_set_param(id_, EX_SIDE_SET, s + 1, static_cast<int64_t>(sides[s].cell.size()), 0), "define");
    for (std::size_t a = 0; a < arrays.size(); ++a) {
      const auto size = static_cast<int64_t>(arrays[a].values.size());
      check(ex_put_set_param(id_, EX_NODE_SET, a + 1, size, size), "define");
    }
    if (!header.field_names.empty())
      check(ex_put_variable_param(id_, EX_NODAL, static_cast<int>(header.field_names.size())), "define");
    if (!header.cell_field_names.empty()) {
      const int number = static_cast<int>(header.cell_field_names.size());
      check(ex_put_variable_param(id_, EX_ELEM_BLOCK, number), "define");
      std::vector<int> has; // (blocks, fields)
      for (const GO cells : blocks_) has.insert(has.end(), number, cells > 0 ? 1 : 0);
      check(ex_put_truth_table(id_, EX_ELEM_BLOCK, static_cast<int>(blocks_.size()), number, has.data()), "define");
    }
  }

  /// Blocks and sides of the whole mesh.
  void put_whole(const ExodusShare &share)
  {
    std::vector<int> blocks(share.block_sizes.size()), sides(share.side_sizes.size()), none(share.side_sizes.size());
    std::iota(blocks.begin(), blocks.end(), 1);
    std::iota(sides.begin(), sides.end(), 1);
    std::vector<int> cells = share.block_sizes, facets = share.side_sizes; // the library only reads them
    check(ex_put_eb_info_global(id_, blocks.data(), cells.data()), "write the blocks of");
    if (!sides.empty())
      check(ex_put_ss_param_global(id_, sides.data(), facets.data(), none.data()), "write the sides of");
  }

  void put_names(const ExodusHeader &header, const std::vector<SideSet> &sides, const std::vector<NamedArray> &arrays)
  {
    std::vector<std::string> coordinates = {"x", "y", "z"}, fields = header.field_names,
                             cell_fields = header.cell_field_names;
    check(ex_put_coord_names(id_, pointers(coordinates).data()), "name the coordinates of");
    for (std::size_t b = 0; b < header.blocks.size(); ++b)
      check(ex_put_name(id_, EX_ELEM_BLOCK, b + 1, header.blocks[b].c_str()), "name the blocks of");
    for (std::size_t s = 0; s < sides.size(); ++s)
      check(ex_put_name(id_, EX_SIDE_SET, s + 1, sides[s].name.c_str()), "name the sides of");
    for (std::size_t a = 0; a < arrays.size(); ++a)
      check(ex_put_name(id_, EX_NODE_SET, a + 1, arrays[a].name.c_str()), "name the arrays of");
    if (!fields.empty())
      check(ex_put_variable_names(id_, EX_NODAL, static_cast<int>(fields.size()), pointers(fields).data()),
            "name the fields of");
    if (!cell_fields.empty())
      check(
          ex_put_variable_names(id_, EX_ELEM_BLOCK, static_cast<int>(cell_fields.size()), pointers(cell_fields).data()),
          "name the fields of");
  }

  void put_sides(const std::vector<SideSet> &sides)
  {
    for (std::size_t s = 0; s < sides.size(); ++s)
      if (!sides[s].cell.empty())
        check(ex_put_set(id_, EX_SIDE_SET, s + 1, sides[s].cell.data(), sides[s].ordinal.data()), "write the sides of");
  }

  /// Exodus has no arrays of any size but those that go with sets: each is the distribution factors of a set that has the first
  /// node as often as it takes.
  void put_arrays(const std::vector<NamedArray> &arrays)
  {
    for (std::size_t a = 0; a < arrays.size(); ++a) {
      const std::vector<double> &values = arrays[a].values;
      if (values.empty()) continue;
      const std::vector<int> nodes(values.size(), 1);
      check(ex_put_set(id_, EX_NODE_SET, a + 1, nodes.data(), nullptr), "write the arrays of");
      check(ex_put_set_dist_fact(id_, EX_NODE_SET, a + 1, values.data()), "write the arrays of");
    }
  }

  /// Bytes that are read or written at once: so many that they stay in a core's cache, but fewer than lie before the first time. NetCDF holds
  /// two such blocks. With those of a time among them it would write the time and, at the file's beginning, the number of times in one go,
  /// and a process that is killed meanwhile would leave a number that counts a time whose end is missing.
  static std::size_t bytes_at_once(const ExodusHeader &header)
  {
    constexpr std::size_t most = 1 << 18, least = 1 << 12;
    const auto before = room_for_file +
                        sizeof(double) * header.element.dim * static_cast<std::size_t>(header.num_nodes) +
                        sizeof(int) * header.element.num_nodes() * static_cast<std::size_t>(header.num_cells);
    std::size_t bytes = most;
    while (bytes > least && 4 * bytes > before) bytes /= 2;
    return bytes;
  }

  /// Opens the file that Exodus has defined and closed.
  void open_for_data(const ExodusHeader &header)
  {
    std::size_t block = bytes_at_once(header);
    check_netcdf(nc__open(file_.temporary().c_str(), NC_WRITE, &block, &netcdf_), "open");
    int old_fill = 0;
    check_netcdf(nc_set_fill(netcdf_, NC_NOFILL, &old_fill), "open");
    const auto variable = [&](const std::string &name) {
      int number = -1;
      check_netcdf(nc_inq_varid(netcdf_, name.c_str(), &number), "find an array of");
      return number;
    };
    const std::array<const char *, 3> directions = {"coordx", "coordy", "coordz"};
    for (int d = 0; d < header.element.dim && header.num_nodes > 0; ++d) coordinates_[d] = variable(directions[d]);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      cells_.push_back(blocks_[b] > 0 ? variable("connect" + std::to_string(b + 1)) : -1);
    time_ = variable("time_whole");
    for (std::size_t f = 0; f < header.field_names.size() && header.num_nodes > 0; ++f)
      fields_.push_back(variable("vals_nod_var" + std::to_string(f + 1)));
    for (std::size_t f = 0; f < header.cell_field_names.size(); ++f) {
      const std::string stem = "vals_elem_var" + std::to_string(f + 1) + "eb";
      cell_fields_.emplace_back();
      for (std::size_t b = 0; b < blocks_.size(); ++b)
        cell_fields_.back().push_back(blocks_[b] > 0 ? variable(stem + std::to_string(b + 1)) : -1);
    }
  }

  void check(const int status, const char *action) const
  {
    if (status != 0) fail(action);
  }

  void check_netcdf(const int status, const char *action) const
  {
    if (status != NC_NOERR) fail(action, nc_strerror(status));
  }

  [[noreturn]] void fail(const char *action) const
  {
    const char *message = nullptr, *function = nullptr;
    int code = 0;
    ex_get_err(&message, &function, &code);
    std::string text = message ? message : "";
    if (code > 0) text += std::string(" (") + std::strerror(code) + ")"; // NetCDF hands on errno; its own codes are < 0
    fail(action, text);
  }

  [[noreturn]] void fail(const char *action, const std::string &message) const
  {
    std::string text = "output: cannot " + std::string(action) + " \"" + path_ + "\"";
    if (!message.empty()) text += ": " + message;
    throw Error(ExitCode::internal_error, text);
  }

  std::string path_;
  AtomicFile file_;
  int id_ = -1;     // the file's number while Exodus writes, else -1
  int netcdf_ = -1; // its number while NetCDF writes, else -1
  std::array<int, 3> coordinates_ = {-1, -1, -1};
  std::vector<int> cells_, fields_;           // by block and by field
  std::vector<std::vector<int>> cell_fields_; // (fields, blocks); these five are NetCDF's numbers of arrays
  int time_ = -1;
  int begun_ = 0, whole_ = 0; // times that are begun, and whole
  bool published_ = false;
  std::vector<GO> blocks_; // cells in each
  int nodes_per_cell_ = 0;
};

} // namespace rpc::io
