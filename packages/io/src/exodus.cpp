#include "rpc/io/exodus.hpp"

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
                   const std::vector<NamedArray> &arrays)
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
  for (const auto &array : arrays) check_name(array.name, MAX_NAME_LENGTH);
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

/// Rank 0: one coordinate of all nodes in the order of their ids; empty elsewhere. Collective.
std::vector<double> gathered_coordinate(const mesh::Mesh &mesh, const mesh::CanonicalOrder &nodes, const int direction)
{
  const auto coords = to_host(mesh.coords);
  std::vector<double> owned(mesh.num_owned_nodes());
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) owned[n] = coords(n, direction);
  return nodes.gather(owned.data());
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
  std::vector<std::string> names;       // of the fields
  std::unique_ptr<ExodusWriter> writer; // rank 0 only
  int steps = 0;
};

ExodusFile::ExodusFile(const std::string &path, const std::string &title, const mesh::Mesh &mesh,
                       const std::vector<std::string> &fields, const std::vector<std::string> &info,
                       const std::vector<NamedArray> &arrays)
    : mesh_(mesh)
{
  require_names(mesh, fields, arrays);
  const Comm &comm = mesh.comm();
  const RCP<const Comm> shared_comm = mesh.owned_nodes->getComm();
  impl_.reset(new Impl{shared_comm, mesh::CanonicalOrder(shared_comm, mesh.node_id, "node"), fields, nullptr});
  const mesh::CanonicalOrder cells(shared_comm, mesh.cell_id, "cell");
  std::vector<SideSet> sides;
  for (const auto &side : mesh.sides) sides.push_back(gather_side(mesh, side));
  const ExodusHeader header{
      title, info, fields, mesh.element, mesh.blocks, block_sizes(mesh), impl_->nodes.size(), cells.size()};
  auto &writer = impl_->writer;
  on_root(comm, ExitCode::internal_error, [&] {
    writer = std::make_unique<ExodusWriter>(path, longest_name(mesh));
    writer->put_header(header, sides, arrays);
  });
  for (int d = 0; d < mesh.dim(); ++d) {
    const auto all = gathered_coordinate(mesh, impl_->nodes, d);
    on_root(comm, ExitCode::internal_error, [&] { writer->put_coordinate(d, all); });
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
  std::vector<std::vector<double>> coords; // (dim; nodes)
  for (int d = 0; d < mesh_.dim(); ++d) coords.push_back(gathered_coordinate(mesh_, impl_->nodes, d));
  on_root(*impl_->comm, ExitCode::internal_error, [&] {
    const auto file = ExodusReader::open(older);
    if (!file || file->num_nodes() != impl_->nodes.size() || file->field_names() != impl_->names) return;
    for (int d = 0; d < mesh_.dim(); ++d)
      if (file->coordinate(d) != coords[d]) return;
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

std::vector<double> exodus_times(const std::string &path)
{
  const auto file = ExodusReader::open(path);
  return file ? file->times() : std::vector<double>();
}

void end_exodus_after(const std::string &path, const int number)
{
  set_number_of_times(path, number);
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
