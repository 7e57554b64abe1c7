#include "rpc/io/exodus.hpp"

#include "exodus_reader.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/io/atomic_file.hpp"
#include "rpc/mesh/canonical_order.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exodusII.h>
#include <fcntl.h>
#include <memory>
#include <optional>
#include <unistd.h>
#include <utility>

namespace rpc::io
{
namespace
{

/// Facets of the whole mesh, 1-based as Exodus counts, ordered by cell and ordinal; rank 0 only.
struct SideSet {
  std::string name;
  std::vector<int> cell, ordinal;
};

/// What the file's header fixes. It comes before all data, which NetCDF would have to move if it grew later.
struct Header {
  std::string title;
  std::vector<std::string> info, field_names;
  mesh::Element element;
  std::vector<std::string> blocks;
  std::vector<GO> block_sizes; // cells in each
  GO num_nodes, num_cells;
};

/// The library takes arrays of pointers to non-const characters, which it only reads.
std::vector<char *> pointers(std::vector<std::string> &texts)
{
  std::vector<char *> result;
  for (auto &text : texts) result.push_back(text.data());
  return result;
}

std::vector<std::string> cut(std::vector<std::string> texts, const std::size_t length)
{
  for (auto &text : texts) text.resize(std::min(text.size(), length));
  return texts;
}

/// Makes a file end after some of its times. The NetCDF library counts a time as soon as anything of it is written; the number is a
/// big-endian integer after the four letters of the format, of 4 bytes, in its version 5 of 8 (NetCDF's "classic format").
void set_number_of_times(const std::string &path, const int number)
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

/// An open Exodus file on rank 0, under its temporary name until commit() or publish(). `longest` is the length of its names.
class Writer
{
public:
  Writer(const std::string &path, const std::size_t longest) : path_(path), file_(path)
  {
    ex_opts(EX_DEFAULT); // errors come as return codes, not on the console
    int word_size = sizeof(double), file_word_size = sizeof(double);
    id_ = ex_create(file_.temporary().c_str(), EX_CLOBBER | EX_LARGE_MODEL, &word_size, &file_word_size);
    if (id_ < 0) fail("create");
    check(ex_set_max_name_length(id_, static_cast<int>(longest)), "define the names of");
  }
  /// Of a published file a time that could not be written goes.
  ~Writer()
  {
    if (id_ < 0) return;
    ex_close(id_);
    if (published_ && begun_ > whole_) set_number_of_times(path_, whole_);
  }
  Writer(const Writer &) = delete;
  Writer &operator=(const Writer &) = delete;

  void put_header(const Header &header, const std::vector<SideSet> &sides)
  {
    define(header, sides);
    put_names(header, sides);
    put_sides(sides);
  }
  void put_coordinate(const int direction, const std::vector<double> &values)
  {
    std::array<const double *, 3> by_direction{};
    by_direction[direction] = values.data();
    check(ex_put_coord(id_, by_direction[0], by_direction[1], by_direction[2]), "write the coordinates of");
  }
  void put_cells(const std::vector<int> &nodes)
  {
    const int *first = nodes.data(); // cells run block by block
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (blocks_[b] > 0) check(ex_put_conn(id_, EX_ELEM_BLOCK, b + 1, first, nullptr, nullptr), "write the cells of");
      first += blocks_[b] * nodes_per_cell_;
    }
  }
  /// @param step  from 1
  void put_time(const int step, const double time)
  {
    begun_ = step;
    check(ex_put_time(id_, step, &time), "write a time of");
  }
  /// All fields of the time are written.
  void end_time()
  {
    if (published_) check(ex_update(id_), "write a time of");
    whole_ = begun_;
  }
  void publish()
  {
    check(ex_update(id_), "write");
    file_.publish();
    published_ = true;
  }
  void put_field(const int step, const int index, const std::vector<double> &values)
  {
    check(ex_put_nodal_var(id_, step, index + 1, static_cast<int64_t>(values.size()), values.data()),
          "write a field of");
  }
  void commit()
  {
    check(ex_close(std::exchange(id_, -1)), "close");
    file_.commit();
  }

private:
  void define(const Header &header, const std::vector<SideSet> &sides)
  {
    const auto &element = header.element;
    check(ex_put_init(id_, header.title.substr(0, MAX_LINE_LENGTH).c_str(), element.dim, header.num_nodes,
                      header.num_cells, static_cast<int64_t>(header.blocks.size()), 0,
                      static_cast<int64_t>(sides.size())),
          "define");
    std::string program = "rpc", version = RPC_VERSION, date, time;
    char *qa[1][4] = {{program.data(), version.data(), date.data(), time.data()}};
    check(ex_put_qa(id_, 1, qa), "define");
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
    if (!header.field_names.empty())
      check(ex_put_variable_param(id_, EX_NODAL, static_cast<int>(header.field_names.size())), "define");
  }

  void put_names(const Header &header, const std::vector<SideSet> &sides)
  {
    std::vector<std::string> coordinates = {"x", "y", "z"}, fields = header.field_names;
    check(ex_put_coord_names(id_, pointers(coordinates).data()), "name the coordinates of");
    for (std::size_t b = 0; b < header.blocks.size(); ++b)
      check(ex_put_name(id_, EX_ELEM_BLOCK, b + 1, header.blocks[b].c_str()), "name the blocks of");
    for (std::size_t s = 0; s < sides.size(); ++s)
      check(ex_put_name(id_, EX_SIDE_SET, s + 1, sides[s].name.c_str()), "name the sides of");
    if (!fields.empty())
      check(ex_put_variable_names(id_, EX_NODAL, static_cast<int>(fields.size()), pointers(fields).data()),
            "name the fields of");
  }

  void put_sides(const std::vector<SideSet> &sides)
  {
    for (std::size_t s = 0; s < sides.size(); ++s)
      if (!sides[s].cell.empty())
        check(ex_put_set(id_, EX_SIDE_SET, s + 1, sides[s].cell.data(), sides[s].ordinal.data()), "write the sides of");
  }

  void check(const int status, const char *action) const
  {
    if (status != 0) fail(action);
  }

  [[noreturn]] void fail(const char *action) const
  {
    const char *message = nullptr, *function = nullptr;
    int code = 0;
    ex_get_err(&message, &function, &code);
    std::string text = "output: cannot " + std::string(action) + " \"" + path_ + "\"";
    if (message && *message) text += ": " + std::string(message);
    if (code > 0) text += std::string(" (") + std::strerror(code) + ")"; // NetCDF hands on errno; its own codes are < 0
    throw Error(ExitCode::internal_error, text);
  }

  std::string path_;
  AtomicFile file_;
  int id_ = -1;
  int begun_ = 0, whole_ = 0; // times that are begun, and whole
  bool published_ = false;
  std::vector<GO> blocks_; // cells in each
  int nodes_per_cell_ = 0;
};

/// Length of the names, 32, which readers expect, unless the mesh has longer ones.
std::size_t longest_name(const mesh::Mesh &mesh)
{
  std::size_t longest = MAX_NAME_LENGTH;
  for (const auto &side : mesh.sides) longest = std::max(longest, side.name.size());
  for (const auto &block : mesh.blocks) longest = std::max(longest, block.size());
  return longest;
}

/// Collective.
void require_names(const mesh::Mesh &mesh, const std::vector<std::string> &fields)
{
  std::optional<std::string> message;
  const auto check_name = [&](const std::string &name, const std::size_t longest) {
    if (name.empty() || name.size() > longest)
      message =
          "output: an Exodus name must have 1 to " + std::to_string(longest) + " characters, got \"" + name + "\"";
  };
  for (const auto &side : mesh.sides) check_name(side.name, mesh::longest_name);
  for (const auto &block : mesh.blocks) check_name(block, mesh::longest_name);
  for (const auto &field : fields) check_name(field, MAX_NAME_LENGTH);
  throw_if_any(mesh.comm(), ExitCode::internal_error, message);
}

/// Collective.
void require_fields(const mesh::Mesh &mesh, const std::vector<std::string> &names,
                    const std::vector<NodalField> &fields)
{
  std::optional<std::string> message;
  if (fields.size() != names.size())
    message =
        "output: each time must have " + std::to_string(names.size()) + " fields, got " + std::to_string(fields.size());
  for (std::size_t f = 0; f < fields.size() && !message; ++f) {
    const NodalField &field = fields[f];
    if (field.name != names[f])
      message = "output: the fields must be the same at all times, \"" + names[f] + "\", got \"" + field.name + "\"";
    if (static_cast<LO>(field.values.extent(0)) != mesh.num_owned_nodes())
      message = "output: the field \"" + field.name + "\" must have a value for each of " +
                std::to_string(mesh.num_owned_nodes()) + " owned nodes, got " + std::to_string(field.values.extent(0));
  }
  throw_if_any(mesh.comm(), ExitCode::internal_error, message);
}

/// Number of cells in each block, over all ranks.
std::vector<GO> block_sizes(const mesh::Mesh &mesh)
{
  const auto block = to_host(mesh.block);
  std::vector<GO> mine(mesh.blocks.size(), 0), all(mesh.blocks.size());
  for (LO c = 0; c < mesh.num_owned_cells; ++c) ++mine[block(c)];
  Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), all.data());
  return all;
}

SideSet gather_side(const mesh::Mesh &mesh, const mesh::Side &side)
{
  const auto cell = to_host(side.cell);
  const auto ordinal = to_host(side.ordinal);
  std::vector<GO> owned_cell;
  std::vector<int> owned_ordinal;
  for (std::size_t f = 0; f < cell.extent(0); ++f) {
    if (cell(f) >= mesh.num_owned_cells) continue;
    owned_cell.push_back(mesh.cell_id(cell(f)));
    owned_ordinal.push_back(ordinal(f));
  }
  const auto all_cells = gathered_by_root(mesh.comm(), owned_cell);
  const auto all_ordinals = gathered_by_root(mesh.comm(), owned_ordinal);
  std::vector<std::pair<GO, int>> facets;
  for (std::size_t f = 0; f < all_cells.size(); ++f) facets.emplace_back(all_cells[f], all_ordinals[f]);
  std::sort(facets.begin(), facets.end());

  SideSet set{side.name, {}, {}};
  for (const auto &facet : facets) {
    set.cell.push_back(static_cast<int>(facet.first) + 1);
    set.ordinal.push_back(facet.second + 1);
  }
  return set;
}

/// Node numbers of owned cells, 1-based: (owned cells, nodes per cell), row by row.
std::vector<int> owned_connectivity(const mesh::Mesh &mesh)
{
  const auto ids = mesh::overlap_node_ids(mesh);
  const auto cells = to_host(mesh.cells);
  const int width = mesh.element.num_nodes();
  std::vector<int> nodes;
  nodes.reserve(std::size_t(mesh.num_owned_cells) * width);
  for (LO c = 0; c < mesh.num_owned_cells; ++c)
    for (int a = 0; a < width; ++a) nodes.push_back(static_cast<int>(ids(cells(c, a))) + 1);
  return nodes;
}

std::vector<std::string> names_of(const std::vector<NodalField> &fields)
{
  std::vector<std::string> names;
  for (const auto &field : fields) names.push_back(field.name);
  return names;
}

} // namespace

struct ExodusFile::Impl {
  RCP<const Comm> comm;
  mesh::CanonicalOrder nodes;
  std::vector<std::string> names; // of the fields
  std::unique_ptr<Writer> writer; // rank 0 only
  int steps = 0;
};

ExodusFile::ExodusFile(const std::string &path, const std::string &title, const mesh::Mesh &mesh,
                       const std::vector<std::string> &fields, const std::vector<std::string> &info)
    : mesh_(mesh)
{
  require_names(mesh, fields);
  const Comm &comm = mesh.comm();
  const RCP<const Comm> shared_comm = mesh.owned_nodes->getComm();
  impl_.reset(new Impl{shared_comm, mesh::CanonicalOrder(shared_comm, mesh.node_id, "node"), fields, nullptr});
  const mesh::CanonicalOrder cells(shared_comm, mesh.cell_id, "cell");
  std::vector<SideSet> sides;
  for (const auto &side : mesh.sides) sides.push_back(gather_side(mesh, side));
  const Header header{title,       info, fields, mesh.element, mesh.blocks, block_sizes(mesh), impl_->nodes.size(),
                      cells.size()};
  auto &writer = impl_->writer;
  on_root(comm, ExitCode::internal_error, [&] {
    writer = std::make_unique<Writer>(path, longest_name(mesh));
    writer->put_header(header, sides);
  });
  {
    const auto coords = to_host(mesh.coords);
    std::vector<double> owned(mesh.num_owned_nodes());
    for (int d = 0; d < mesh.dim(); ++d) {
      for (LO n = 0; n < mesh.num_owned_nodes(); ++n) owned[n] = coords(n, d);
      const auto all = impl_->nodes.gather(owned.data());
      on_root(comm, ExitCode::internal_error, [&] { writer->put_coordinate(d, all); });
    }
  }
  const auto all = cells.gather(owned_connectivity(mesh).data(), mesh.element.num_nodes());
  on_root(comm, ExitCode::internal_error, [&] { writer->put_cells(all); });
}

ExodusFile::~ExodusFile() = default;

void ExodusFile::write(const double time, const std::vector<NodalField> &fields)
{
  require_fields(mesh_, impl_->names, fields);
  const int step = ++impl_->steps;
  on_root(*impl_->comm, ExitCode::internal_error, [&] { impl_->writer->put_time(step, time); });
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto all = impl_->nodes.gather(fields[f].values.data());
    on_root(*impl_->comm, ExitCode::internal_error, [&] { impl_->writer->put_field(step, static_cast<int>(f), all); });
  }
  on_root(*impl_->comm, ExitCode::internal_error, [&] { impl_->writer->end_time(); });
}

int ExodusFile::take_times(const std::string &older, const std::vector<double> &wanted)
{
  int taken = 0;
  on_root(*impl_->comm, ExitCode::internal_error, [&] {
    const auto file = ExodusReader::open(older);
    if (!file || file->num_nodes() != impl_->nodes.size() || file->field_names() != impl_->names) return;
    const std::vector<double> times = file->times();
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (!std::binary_search(wanted.begin(), wanted.end(), times[k])) continue;
      const int step = impl_->steps + taken + 1;
      impl_->writer->put_time(step, times[k]);
      for (int f = 0; f < static_cast<int>(impl_->names.size()); ++f) {
        const auto values = file->field(static_cast<int>(k) + 1, f);
        RPC_REQUIRE(static_cast<GO>(values.size()) == impl_->nodes.size(),
                    "restart: \"" << older
                                  << "\" cannot be read. Remove it; the times before the restart are lost then.");
        impl_->writer->put_field(step, f, values);
      }
      impl_->writer->end_time();
      ++taken;
    }
  });
  Teuchos::broadcast(*impl_->comm, 0, &taken);
  impl_->steps += taken;
  return taken;
}

void ExodusFile::publish()
{
  on_root(*impl_->comm, ExitCode::internal_error, [&] { impl_->writer->publish(); });
}

void ExodusFile::commit()
{
  on_root(*impl_->comm, ExitCode::internal_error, [&] { impl_->writer->commit(); });
}

void write_exodus(const std::string &path, const std::string &title, const mesh::Mesh &mesh, const double time,
                  const std::vector<NodalField> &fields, const std::vector<std::string> &info)
{
  require_fields(mesh, names_of(fields), fields); // before there is a file
  ExodusFile file(path, title, mesh, names_of(fields), info);
  file.write(time, fields);
  file.commit();
}

} // namespace rpc::io
