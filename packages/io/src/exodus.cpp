// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/exodus.hpp"

#include "exodus_part.hpp"
#include "exodus_reader.hpp"
#include "exodus_writer.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/canonical_order.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace rpc::io
{
namespace
{

/// Length of the names, 32, which readers expect, unless the mesh has longer ones.
std::size_t longest_name(const mesh::Mesh &mesh)
{
  std::size_t longest = MAX_NAME_LENGTH;
  for (const auto &side : mesh.sides) longest = std::max(longest, side.name.size());
  for (const auto &block : mesh.blocks) longest = std::max(longest, block.size());
  return longest;
}

/// Collective.
void require_names(const mesh::Mesh &mesh, const std::vector<std::string> &fields,
                   const std::vector<std::string> &cell_fields, const std::vector<NamedArray> &arrays)
{
  std::optional<std::string> message;
  const auto check_name = [&](const std::string &name, const std::size_t longest) {
    if (name.empty() || name.size() > longest)
      message =
          "output: an Exodus name must have 1 to " + std::to_string(longest) + " characters, got \"" + name + "\"";
  };
  for (const auto &side : mesh.sides) check_name(side.name, mesh::longest_name);
  for (const auto &block : mesh.blocks) check_name(block, mesh::longest_name);
  for (const auto *const names : {&fields, &cell_fields})
    for (const auto &field : *names) check_name(field, MAX_NAME_LENGTH);
  for (const auto &array : arrays) check_name(array.name, MAX_NAME_LENGTH);
  throw_if_any(mesh.comm(), ExitCode::internal_error, message);
}

/// Collective.
/// @param what    has a value of each field: "nodes"
/// @param number  of those that this rank owns
template <class Field>
void require_fields(const mesh::Mesh &mesh, const std::vector<std::string> &names, const std::vector<Field> &fields,
                    const char *const what, const LO number)
{
  std::optional<std::string> message;
  if (fields.size() != names.size())
    message =
        "output: each time must have " + std::to_string(names.size()) + " fields, got " + std::to_string(fields.size());
  for (std::size_t f = 0; f < fields.size() && !message; ++f) {
    const Field &field = fields[f];
    if (field.name != names[f])
      message = "output: the fields must be the same at all times, \"" + names[f] + "\", got \"" + field.name + "\"";
    if (static_cast<LO>(field.values.extent(0)) != number)
      message = "output: the field \"" + field.name + "\" must have a value for each of " + std::to_string(number) +
                " owned " + what + ", got " + std::to_string(field.values.extent(0));
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

/// (owned nodes) One coordinate [m].
std::vector<double> owned_coordinate(const mesh::Mesh &mesh, const int direction)
{
  const auto coordinate = to_host(Kokkos::subview(mesh.coords, Kokkos::ALL, direction));
  std::vector<double> owned(mesh.num_owned_nodes());
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) owned[n] = coordinate(n);
  return owned;
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
  std::vector<std::string> names;                   // of the fields
  std::vector<std::string> cell_names;              // of those that cells have
  std::unique_ptr<ExodusWriter> writer;             // on ranks that write
  std::optional<mesh::CanonicalOrder> nodes, cells; // joined
  std::unique_ptr<const ExodusPart> part;           // split
  int steps = 0;
};

std::string exodus_file_of(const std::string &path, const int num_ranks, const int rank)
{
  const std::string ranks = std::to_string(num_ranks), number = std::to_string(rank);
  return path + '.' + ranks + '.' + std::string(ranks.size() - number.size(), '0') + number;
}

ExodusFile::ExodusFile(const std::string &path, const std::string &title, const mesh::Mesh &mesh,
                       const std::vector<std::string> &fields, const std::vector<std::string> &info,
                       const std::vector<NamedArray> &arrays, const ExodusFiles files,
                       const std::vector<std::string> &cell_fields)
    : mesh_(mesh)
{
  require_names(mesh, fields, cell_fields, arrays);
  impl_.reset(new Impl{mesh.owned_nodes->getComm(), fields, cell_fields, nullptr, std::nullopt, std::nullopt, nullptr});
  const ExodusHeader header{title, info, fields, cell_fields, mesh.element, mesh.blocks, {}, 0, 0};
  if (files == ExodusFiles::joined)
    begin_joined(path, header, arrays);
  else
    begin_split(path, header);
}

ExodusFile::~ExodusFile() = default;

void ExodusFile::begin_joined(const std::string &path, const ExodusHeader &common,
                              const std::vector<NamedArray> &arrays)
{
  const Comm &comm = *impl_->comm;
  impl_->nodes.emplace(impl_->comm, mesh_.node_id, "node");
  impl_->cells.emplace(impl_->comm, mesh_.cell_id, "cell");
  ExodusHeader header = common;
  header.block_sizes = block_sizes(mesh_);
  header.num_nodes = impl_->nodes->size();
  header.num_cells = impl_->cells->size();
  std::vector<SideSet> sides;
  for (const auto &side : mesh_.sides) sides.push_back(gather_side(mesh_, side));
  auto &writer = impl_->writer;
  on_root(comm, ExitCode::internal_error, [&] {
    writer = std::make_unique<ExodusWriter>(path, longest_name(mesh_));
    writer->put_header(header, sides, arrays);
  });
  for (int d = 0; d < mesh_.dim(); ++d)
    impl_->nodes->in_pieces<double>(
        owned_coordinate(mesh_, d).data(), 1,
        [&](const GO first, const std::vector<double> &piece) { writer->put_coordinate(d, first, piece); });
  impl_->cells->in_pieces<int>(owned_connectivity(mesh_).data(), mesh_.element.num_nodes(),
                               [&](const GO first, const std::vector<int> &piece) { writer->put_cells(first, piece); });
}

void ExodusFile::begin_split(const std::string &path, const ExodusHeader &common)
{
  const Comm &comm = *impl_->comm;
  impl_->part = std::make_unique<const ExodusPart>(mesh_);
  const ExodusPart &part = *impl_->part;
  const ExodusShare share = part.share();
  ExodusHeader header = common;
  header.block_sizes = part.block_sizes();
  header.num_nodes = static_cast<GO>(share.node_number.size());
  header.num_cells = static_cast<GO>(share.cell_number.size());
  on_each(comm, ExitCode::internal_error, [&] {
    auto &writer = impl_->writer;
    writer = std::make_unique<ExodusWriter>(exodus_file_of(path, comm.getSize(), comm.getRank()), longest_name(mesh_));
    writer->put_header(header, part.sides(), {}, &share);
    for (int d = 0; d < mesh_.dim(); ++d) writer->put_coordinate(d, 0, part.coordinate(d));
    writer->put_cells(0, part.connectivity());
  });
}

/// Where files are split all ranks write.
void ExodusFile::on_writers(const std::function<void()> &work)
{
  if (impl_->part)
    on_each(*impl_->comm, ExitCode::internal_error, work);
  else
    on_root(*impl_->comm, ExitCode::internal_error, work);
}

/// @param order  of nodes or cells in a joined file
/// @param mine   this rank's values of a field in a split file
/// @param put    writes the values of field f from `first` on
template <class Fields, class Order, class Mine, class Put>
void ExodusFile::write_fields(const Fields &fields, const Order &order, const Mine &mine, const Put &put)
{
  for (int f = 0; f < static_cast<int>(fields.size()); ++f) {
    const HostView<double *> &values = fields[f].values;
    if (impl_->part) {
      const auto here = mine(values);
      on_writers([&] { put(f, 0, here); });
    } else {
      order->template in_pieces<double>(
          values.data(), 1, [&](const GO first, const std::vector<double> &piece) { put(f, first, piece); });
    }
  }
}

void ExodusFile::write(const double time, const std::vector<NodalField> &fields,
                       const std::vector<CellField> &cell_fields)
{
  require_fields(mesh_, impl_->names, fields, "nodes", mesh_.num_owned_nodes());
  require_fields(mesh_, impl_->cell_names, cell_fields, "cells", mesh_.num_owned_cells);
  const int step = ++impl_->steps;
  auto &writer = impl_->writer;
  on_writers([&] { writer->put_time(step, time); });
  write_fields(
      fields, impl_->nodes, [&](const auto &values) { return impl_->part->at_nodes(values); },
      [&](const int f, const GO first, const auto &values) { writer->put_field(step, f, first, values); });
  write_fields(
      cell_fields, impl_->cells, [&](const auto &values) { return impl_->part->at_cells(values); },
      [&](const int f, const GO first, const auto &values) { writer->put_cell_field(step, f, first, values); });
  on_writers([&] { writer->flush_time(); });
  if (writer) writer->keep_time();
}

/// Collective. @param file  null: there is none, or on ranks that do not write
bool ExodusFile::is_of_this_mesh(const ExodusReader *const file)
{
  const GO num_nodes = impl_->part ? impl_->part->num_nodes() : impl_->nodes->size();
  bool same = file && file->num_nodes() == num_nodes && file->field_names(EX_NODAL) == impl_->names &&
              file->field_names(EX_ELEM_BLOCK) == impl_->cell_names;
  for (int d = 0; d < mesh_.dim(); ++d) {
    if (impl_->part)
      same = same && file->coordinate(d, 0, num_nodes) == impl_->part->coordinate(d);
    else
      impl_->nodes->in_pieces<double>(
          owned_coordinate(mesh_, d).data(), 1, [&](const GO first, const std::vector<double> &piece) {
            same = same && file->coordinate(d, first, static_cast<GO>(piece.size())) == piece;
          });
  }
  const bool writes = impl_->part || impl_->comm->getRank() == 0;
  return min_all(*impl_->comm, same || !writes ? 1 : 0) == 1;
}

int ExodusFile::take_times(const std::string &older, const std::vector<double> &wanted)
{
  const Comm &comm = *impl_->comm;
  const bool split = impl_->part != nullptr;
  const bool writes = split || comm.getRank() == 0;
  const std::string path = split ? exodus_file_of(older, comm.getSize(), comm.getRank()) : older;
  const auto file = writes ? ExodusReader::open(path) : std::nullopt;
  if (!is_of_this_mesh(file ? &*file : nullptr)) return 0;
  const std::vector<double> all = exodus_times(older, comm, split ? ExodusFiles::split : ExodusFiles::joined);
  const std::vector<double> times = file ? file->times() : std::vector<double>();
  constexpr GO at_once = GO(1) << 18; // nodes
  int taken = 0;
  for (const double time : all) {
    if (!std::binary_search(wanted.begin(), wanted.end(), time)) continue;
    const int step = impl_->steps + ++taken;
    on_writers([&] {
      const int from = static_cast<int>(std::find(times.begin(), times.end(), time) - times.begin()) + 1;
      impl_->writer->put_time(step, time);
      const auto require_read = [&](const bool read) {
        RPC_REQUIRE(read, "restart: \"" << path
                                        << "\" cannot be read. Remove it; the times before the restart are lost then.");
      };
      for (int f = 0; f < static_cast<int>(impl_->names.size()); ++f)
        for (GO first = 0; first < file->num_nodes(); first += at_once) {
          const GO count = std::min(at_once, file->num_nodes() - first);
          const auto values = file->field(from, f, first, count);
          require_read(static_cast<GO>(values.size()) == count);
          impl_->writer->put_field(step, f, first, values);
        }
      for (int f = 0; f < static_cast<int>(impl_->cell_names.size()); ++f) {
        const auto values = file->cell_field(from, f);
        require_read(static_cast<GO>(values.size()) == impl_->writer->num_cells());
        impl_->writer->put_cell_field(step, f, 0, values);
      }
      impl_->writer->flush_time();
    });
    if (impl_->writer) impl_->writer->keep_time();
  }
  impl_->steps += taken;
  return taken;
}

void ExodusFile::publish()
{
  on_writers([&] { impl_->writer->publish(); });
}

void ExodusFile::commit()
{
  on_writers([&] { impl_->writer->finish(); }); // none has a name before all are whole
  on_writers([&] { impl_->writer->commit(); });
}

std::vector<double> exodus_times(const std::string &path, const Comm &comm, const ExodusFiles files)
{
  const bool split = files == ExodusFiles::split;
  std::vector<double> times;
  if (split || comm.getRank() == 0)
    if (const auto file = ExodusReader::open(split ? exodus_file_of(path, comm.getSize(), comm.getRank()) : path))
      times = file->times();
  std::vector<double> all = times; // of rank 0
  int count = static_cast<int>(all.size());
  Teuchos::broadcast(comm, 0, &count);
  all.resize(count);
  if (count > 0) Teuchos::broadcast(comm, 0, count, all.data());
  if (!split || count == 0) return all;
  std::vector<int> missing(count);
  for (int k = 0; k < count; ++k) missing[k] = std::find(times.begin(), times.end(), all[k]) == times.end() ? 1 : 0;
  missing = largest(comm, missing);
  std::vector<double> common;
  for (int k = 0; k < count; ++k)
    if (missing[k] == 0) common.push_back(all[k]);
  return common;
}

void end_exodus_after(const std::string &path, const int number, const Comm &comm, const ExodusFiles files)
{
  if (files == ExodusFiles::split)
    set_number_of_times(exodus_file_of(path, comm.getSize(), comm.getRank()), number);
  else if (comm.getRank() == 0)
    set_number_of_times(path, number);
}

void write_exodus(const std::string &path, const std::string &title, const mesh::Mesh &mesh, const double time,
                  const std::vector<NodalField> &fields, const std::vector<std::string> &info, const ExodusFiles files)
{
  require_fields(mesh, names_of(fields), fields, "nodes", mesh.num_owned_nodes()); // before there is a file
  ExodusFile file(path, title, mesh, names_of(fields), info, {}, files);
  file.write(time, fields);
  file.commit();
}

} // namespace rpc::io
