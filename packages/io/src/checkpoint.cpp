// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/checkpoint.hpp"

#include "exodus_reader.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/mesh/canonical_order.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

namespace rpc::io
{
namespace
{

// Exodus keeps texts in records of 80 characters, and readers cut blanks at their ends: each record ends with a mark.
constexpr std::size_t record_length = 79;
constexpr char mark = '|';
const std::string signature = "rpc checkpoint ";

std::uint64_t bits_of(const double value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::string in_digits(const std::uint64_t number)
{
  std::ostringstream text;
  text << std::hex << number;
  return text.str();
}
/// sum_of_bits() in hexadecimal digits; collective.
std::string number_of_all(const Comm &comm, const std::uint64_t mine)
{
  return in_digits(sum_of_bits(comm, mine));
}
/// A fingerprint of an array; one rank only.
std::string number_of(const std::vector<double> &values)
{
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < values.size(); ++k) sum += scrambled(k + 1, bits_of(values[k]));
  return in_digits(sum);
}

/// A fingerprint of nodes, cells and sides, the same on any number of ranks; collective.
std::string number_of(const mesh::Mesh &mesh)
{
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  const auto ids = mesh::overlap_node_ids(mesh);
  std::uint64_t sum = 0;
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    for (int d = 0; d < mesh.dim(); ++d)
      sum += scrambled(4 * static_cast<std::uint64_t>(mesh.node_id(n)) + d, bits_of(coords(n, d)));
  const auto width = cells.extent(1);
  for (LO c = 0; c < mesh.num_owned_cells; ++c)
    for (std::size_t a = 0; a < width; ++a)
      sum += scrambled(width * static_cast<std::uint64_t>(mesh.cell_id(c)) + a + 1,
                       static_cast<std::uint64_t>(ids(cells(c, a))));
  for (std::size_t s = 0; s < mesh.sides.size(); ++s) {
    const auto cell = to_host(mesh.sides[s].cell);
    const auto ordinal = to_host(mesh.sides[s].ordinal);
    for (std::size_t f = 0; f < cell.extent(0); ++f)
      if (cell(f) < mesh.num_owned_cells)
        sum += scrambled(scrambled(s + 1, static_cast<std::uint64_t>(mesh.cell_id(cell(f)))),
                         static_cast<std::uint64_t>(ordinal(f)));
  }
  return number_of_all(mesh.comm(), sum);
}

/// A fingerprint of all values of fields at the owned nodes, the same on any number of ranks; collective.
std::string number_of(const mesh::Mesh &mesh, const std::vector<NodalField> &fields)
{
  std::uint64_t sum = 0;
  for (std::size_t f = 0; f < fields.size(); ++f)
    for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
      sum += scrambled(scrambled(f + 1, static_cast<std::uint64_t>(mesh.node_id(n))), bits_of(fields[f].values(n)));
  return number_of_all(mesh.comm(), sum);
}

std::vector<std::string> records_of(const std::string &text)
{
  std::vector<std::string> records;
  for (std::size_t first = 0; first < text.size(); first += record_length)
    records.push_back(text.substr(first, record_length));
  for (std::string &record : records) { // the library leaves what is behind a short record as it is
    record.resize(record_length, ' ');
    record += mark;
  }
  return records;
}

/// The version that wrote a text which does not read as a whole: those before 0.3.0 left the end of the last record open.
std::string version_in(const std::string &text)
{
  const std::string before = "\"version\":\"";
  const auto at = text.compare(0, signature.size(), signature) == 0 ? text.rfind(before) : std::string::npos;
  if (at == std::string::npos) return "";
  const auto first = at + before.size(), last = text.find('"', first);
  return last == std::string::npos ? "" : text.substr(first, last - first);
}

/// A checkpoint's file that is read; rank 0 only.
class Reader
{
public:
  explicit Reader(const std::string &path) : path_(path)
  {
    RPC_REQUIRE(std::filesystem::is_regular_file(path), "restart: there is no file \"" << path << "\"");
    auto file = ExodusReader::open(path);
    if (!file) damaged("it is no Exodus file");
    file_.emplace(std::move(*file));
  }

  [[noreturn]] void damaged(const std::string &what) const
  {
    throw Error(ExitCode::bad_input, "restart: \"" + path_ + "\" is damaged or no checkpoint: " + what +
                                         ". Take an older one, or start from the first step.");
  }
  std::string text() const
  {
    const auto records = file_->info();
    if (records.empty()) damaged("it has no text that can be read");
    std::string text;
    bool cut = false;
    for (const std::string &record : records) {
      cut = cut || record.empty() || record.back() != mark;
      text += record.substr(0, record.size() - (record.empty() || record.back() != mark ? 0 : 1));
    }
    if (cut) {
      require_version(version_in(text));
      damaged("its text is cut");
    }
    return text;
  }
  /// @param version  that wrote the file; empty: not known
  void require_version(const std::string &version) const
  {
    RPC_REQUIRE(version.empty() || version == RPC_VERSION,
                "restart: \"" << path_ << "\" was written by version " << version << ", this is " << RPC_VERSION
                              << ". Go on with that version, or start from the first step.");
  }
  double time() const
  {
    const auto times = file_->times();
    if (times.size() != 1) damaged("it has not one time");
    return times.front();
  }
  void require_nodes(const GO num_nodes) const
  {
    if (file_->num_nodes() != num_nodes) damaged("it has another number of nodes than it says");
  }
  /// @param first  node, from 0
  std::vector<double> field(const int index, const GO first, const GO count) const
  {
    auto values = file_->field(1, index, first, count);
    if (values.empty()) damaged("a field cannot be read");
    return values;
  }
  std::vector<double> array(const int index, const std::string &number) const
  {
    auto values = file_->array(index);
    if (!values || number_of(*values) != number) damaged("an array is not what was written");
    return std::move(*values);
  }

private:
  std::string path_;
  std::optional<ExodusReader> file_;
};

} // namespace

void write_checkpoint(const std::string &path, const mesh::Mesh &mesh, const double time,
                      const std::vector<NodalField> &fields, const std::string &text,
                      const std::vector<NamedArray> &arrays)
{
  std::vector<std::string> names;
  for (const auto &field : fields) names.push_back(field.name);
  auto of_arrays = nlohmann::json::array();
  for (const auto &array : arrays) of_arrays.push_back({{"name", array.name}, {"values", number_of(array.values)}});
  const nlohmann::json header = {{"version", RPC_VERSION},
                                 {"mesh", number_of(mesh)},
                                 {"nodes", mesh.owned_nodes->getGlobalNumElements()},
                                 {"values", number_of(mesh, fields)},
                                 {"fields", names},
                                 {"arrays", of_arrays},
                                 {"text", text}};
  ExodusFile file(path, "rpc checkpoint", mesh, names, records_of(signature + header.dump()), arrays);
  file.write(time, fields);
  file.commit();
}

Checkpoint::Checkpoint(const std::string &path, const RCP<const Comm> &comm) : path_(path), comm_(comm)
{
  const std::string common = text_of_root(*comm, ExitCode::bad_input, [&] {
    const Reader reader(path);
    const std::string text = reader.text();
    if (text.compare(0, signature.size(), signature) != 0) reader.damaged("its text is of another kind");
    nlohmann::json header;
    try {
      header = nlohmann::json::parse(text.substr(signature.size()));
      reader.require_version(header.at("version"));
      const GO nodes = header.at("nodes");
      reader.require_nodes(nodes);
      for (std::size_t f = 0; f < header.at("fields").size(); ++f) // a file that is cut is told before a mesh is made
        if (nodes > 0) reader.field(static_cast<int>(f), nodes - 1, 1);
      for (const auto &array : header.at("arrays"))
        arrays_.push_back({array.at("name"), reader.array(static_cast<int>(arrays_.size()), array.at("values"))});
      header["time"] = reader.time();
    } catch (const nlohmann::json::exception &) {
      reader.damaged("its text cannot be read");
    }
    return header.dump();
  });
  const auto header = nlohmann::json::parse(common);
  time_ = header.at("time");
  text_ = header.at("text");
  mesh_number_ = header.at("mesh");
  fields_number_ = header.at("values");
  names_ = header.at("fields").get<std::vector<std::string>>();
  if (comm->getRank() == 0) return;
  for (const auto &array : header.at("arrays")) arrays_.push_back({array.at("name"), {}});
}

bool Checkpoint::is_of(const mesh::Mesh &mesh) const
{
  return number_of(mesh) == mesh_number_;
}

std::vector<NodalField> Checkpoint::fields(const mesh::Mesh &mesh) const
{
  RPC_REQUIRE(is_of(mesh),
              "restart: \"" << path_ << "\" belongs to another mesh. Restart with the mesh that it was written with.");
  const mesh::CanonicalOrder nodes(mesh.owned_nodes->getComm(), mesh.node_id, "node");
  std::unique_ptr<Reader> reader; // rank 0 only
  on_root(*comm_, ExitCode::bad_input, [&] { reader = std::make_unique<Reader>(path_); });
  std::vector<NodalField> fields;
  for (std::size_t f = 0; f < names_.size(); ++f) {
    NodalField field{names_[f], HostView<double *>("rpc::io::restart", mesh.num_owned_nodes())};
    nodes.from_pieces([&](const GO first, const GO count) { return reader->field(static_cast<int>(f), first, count); },
                      field.values.data());
    fields.push_back(field);
  }
  RPC_REQUIRE(number_of(mesh, fields) == fields_number_,
              "restart: \"" << path_
                            << "\" is damaged: its fields are not those that were written. Take an older one, or start "
                            << "from the first step.");
  return fields;
}

} // namespace rpc::io
