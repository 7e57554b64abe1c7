// SPDX-License-Identifier: BSD-3-Clause
#include "checkpoint.hpp"

#include "continuation.hpp"
#include "output/quantities.hpp"
#include "rpc/contact/stored_dents.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/io/atomic_file.hpp"
#include "rpc/io/checkpoint.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <variant>

namespace rpc
{
namespace
{

using analysis::Energies;
using analysis::Memory;
using analysis::StepRecord;
using contact::ContactSums;
using nlohmann::json;

constexpr std::size_t kept = 2;

json to_json(const ContactSums &s, const ResultScope &scope)
{
  return {{"nodes", s.num_nodes}, {"force", s.force}, {"numbers", kept_numbers(contact::contact_quantities, s, scope)}};
}
ContactSums sums_from(const json &j, const ResultScope &scope)
{
  ContactSums s;
  s.num_nodes = j.at("nodes");
  s.force = j.at("force");
  take_numbers(j.at("numbers"), contact::contact_quantities, s, scope);
  return s;
}

Energies energies_from(const json &j, const ResultScope &scope)
{
  Energies energies;
  take_numbers(j, analysis::energy_quantities, energies, scope);
  return energies;
}

json to_json(const StepRecord &r, const ResultScope &scope)
{
  json entry = {{"time", r.time},
                {"energies", kept_numbers(analysis::energy_quantities, r.energies, scope)},
                {"contact", to_json(r.contact, scope)},
                {"body", kept_numbers(analysis::body_quantities, r.body, scope)},
                {"patches", kept_numbers(contact::patch_quantities, r.patches, scope)},
                {"side_forces", r.side_forces},
                {"displacements", r.displacements},
                {"reactions", r.reactions},
                {"rigid_motions", r.rigid_motions},
                {"rigid_forces", r.rigid_forces},
                {"obstacle", r.obstacle},
                {"work", kept_numbers(analysis::step_work, r, scope)},
                {"from_rest", r.from_rest},
                {"seconds", r.seconds}};
  for (const auto &q : defined_numbers(analysis::step_parts, scope)) entry[q.key] = r.*q.value;
  return entry;
}
StepRecord record_from(const json &j, const ResultScope &scope)
{
  StepRecord r;
  r.time = j.at("time");
  r.converged = true; // no other step is gone on from
  r.energies = energies_from(j.at("energies"), scope);
  r.contact = sums_from(j.at("contact"), scope);
  take_numbers(j.at("body"), analysis::body_quantities, r.body, scope);
  if (j.contains("patches")) take_numbers(j.at("patches"), contact::patch_quantities, r.patches, scope);
  r.side_forces = j.at("side_forces").get<std::vector<std::array<double, 3>>>();
  r.displacements = j.at("displacements").get<std::vector<std::array<double, 3>>>();
  r.reactions = j.at("reactions").get<std::vector<std::array<double, 3>>>();
  r.rigid_motions = j.value("rigid_motions", r.rigid_motions); // older files have no rigid sides
  r.rigid_forces = j.value("rigid_forces", r.rigid_forces);
  r.obstacle = j.value("obstacle", r.obstacle);
  take_numbers(j.at("work"), analysis::step_work, r, scope);
  for (const auto &q : defined_numbers(analysis::step_parts, scope)) r.*q.value = j.at(q.key);
  r.from_rest = j.value("from_rest", false);
  r.seconds = j.at("seconds");
  return r;
}

/// Columns of a vector by node as fields, "name_1" and so on.
void add_columns(std::vector<io::NodalField> &fields, const std::string &name, const MultiVector &columns)
{
  const auto from = columns.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < columns.getNumVectors(); ++k) {
    HostView<double *> values("rpc::checkpoint", from.extent(0));
    for (std::size_t n = 0; n < values.extent(0); ++n) values(n) = from(n, k);
    fields.push_back({name + std::to_string(k + 1), values});
  }
}
void add_components(std::vector<io::NodalField> &fields, const std::string &name, const Vector &u, const int dim)
{
  const auto from = u.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (int c = 0; c < dim; ++c) {
    HostView<double *> values("rpc::checkpoint", from.extent(0) / dim);
    for (std::size_t n = 0; n < values.extent(0); ++n) values(n) = from(dim * n + c, 0);
    fields.push_back({name + std::to_string(c + 1), values});
  }
}

/// Takes fields one after another.
class FieldReader
{
public:
  FieldReader(std::vector<io::NodalField> fields, const fem::Discretization &d) : fields_(std::move(fields)), d_(d) {}

  RCP<const Vector> components()
  {
    const int dim = d_.dim();
    const auto u = rcp(new Vector(d_.owned_dofs));
    const auto to = u->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (int c = 0; c < dim; ++c, ++next_)
      for (LO n = 0; n < d_.mesh->num_owned_nodes(); ++n) to(dim * n + c, 0) = fields_.at(next_).values(n);
    return u;
  }
  RCP<const MultiVector> columns(const int count)
  {
    const auto columns = rcp(new MultiVector(d_.mesh->owned_nodes, count));
    const auto to = columns->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (int k = 0; k < count; ++k, ++next_)
      for (LO n = 0; n < d_.mesh->num_owned_nodes(); ++n) to(n, k) = fields_.at(next_).values(n);
    return columns;
  }

private:
  std::vector<io::NodalField> fields_;
  const fem::Discretization &d_;
  std::size_t next_ = 0;
};

/// An array of a file, on rank 0; null: it has none of this name.
const std::vector<double> *array_of(const io::Checkpoint &file, const std::string &name)
{
  for (const io::NamedArray &array : file.arrays())
    if (array.name == name) return &array.values;
  return nullptr;
}

/// The options of a mesh that was made by a field of cell sizes, rank 0 only; null: the deck's mesh, or another rank.
const mesh::GmshOptions *sized_mesh(const analysis::HistoryState &state)
{
  const auto *const gmsh = std::get_if<mesh::GmshOptions>(&state.mesh_options);
  return gmsh && gmsh->sizes ? gmsh : nullptr;
}
/// A field of cell sizes, how often the mesh by it was refined, whether it is nested, and whether it is kept to simplices, as arrays of a file.
std::vector<io::NamedArray> arrays_of(const mesh::GmshOptions &mesh)
{
  const mesh::SizeField &sizes = *mesh.sizes;
  return {{"sizes_coords", sizes.coords},
          {"sizes_simplices", {sizes.simplices.begin(), sizes.simplices.end()}},
          {"sizes_size", sizes.size},
          {"sizes_kind", {double(sizes.dim), double(mesh.refinements), double(mesh.nested), double(mesh.simplices)}}};
}
/// The mesh that a checkpoint is on: the deck's, unless the file has a field of cell sizes.
mesh::MeshOptions mesh_of(const io::Checkpoint &file, const std::string &path, const Scene &scene, const Comm &comm)
{
  const auto *const coords = array_of(file, "sizes_coords"), *const simplices = array_of(file, "sizes_simplices"),
                    *const size = array_of(file, "sizes_size"), *const kind = array_of(file, "sizes_kind");
  if (!coords || !simplices || !size || !kind) return scene.mesh;
  std::shared_ptr<mesh::SizeField> sizes;
  int form[4] = {}; // dimension, how often the mesh by the sizes was refined, whether it is nested, kept to simplices
  on_root(comm, ExitCode::bad_input, [&] { // which has the arrays' values
    RPC_REQUIRE(
        kind->size() == 4 && (kind->front() == 2 || kind->front() == 3),
        "restart: \"" << path
                      << "\" is damaged or no checkpoint: how its adapted mesh was made is not 4 numbers of which the "
                         "first is the dimension. Take an older one, or start from the first step.");
    std::copy(kind->begin(), kind->end(), form);
    sizes = std::make_shared<mesh::SizeField>(
        mesh::SizeField{*coords, {simplices->begin(), simplices->end()}, *size, form[0]});
  });
  Teuchos::broadcast(comm, 0, 4, form);
  std::optional<mesh::MeshOptions> options = mesh::with_sizes(scene.mesh, sizes, form[1]);
  if (form[2]) options = mesh::refined_to_sizes(scene.mesh, sizes);
  if (options) std::get<mesh::GmshOptions>(*options).simplices = form[3];
  RPC_REQUIRE(options && scene.adapt.adapts(),
              "restart: \"" << path
                            << "\" is on a mesh that was adapted, and the deck adapts none. Give it "
                               "\"Adapt->Target Relative Error\", or start from the first step.");
  return *options;
}

std::string stem_of(const Scene &scene)
{
  return scene.name + ".checkpoint-";
}

} // namespace

Checkpoints::Checkpoints(const Scene &scene, const bool restarts, std::string restart, const std::string &folder)
    : scene_(scene), restarts_(restarts), restart_(std::move(restart)), folder_(folder)
{
}

/// A checkpoint that can be read to its end.
struct Checkpoints::Whole {
  std::string path;
  io::Checkpoint file;
  mesh::MeshOptions mesh_options;
  fem::Discretization discretization;
  std::optional<std::vector<io::NodalField>>
      fields; // none on another mesh, which is told once the deck is found to be right
};

/// @throws rpc::Error on every rank if it is none
Checkpoints::Whole Checkpoints::whole(const std::string &path, const RCP<const Comm> &comm) const
{
  io::Checkpoint file(path, comm);
  auto options = mesh_of(file, path, scene_, *comm);
  auto d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_mesh(options, comm)), scene_.model.kinematics);
  Whole whole{path, std::move(file), std::move(options), std::move(d), std::nullopt};
  const mesh::Mesh &mesh = *whole.discretization.mesh;
  if (whole.file.is_of(mesh)) whole.fields = whole.file.fields(mesh);
  return whole;
}

std::optional<analysis::HistoryState> Checkpoints::resume(const RCP<const Comm> &comm)
{
  if (!restarts_) return std::nullopt;
  if (!restart_.empty()) return state_of(whole(restart_, comm));
  const std::string listed = text_of_root(*comm, ExitCode::bad_input, [&] { return json(in_folder()).dump(); });
  const std::vector<std::string> newest_first = json::parse(listed);
  RPC_REQUIRE(!newest_first.empty(), "restart: there is no checkpoint of \""
                                         << scene_.name << "\" in the folder \"" << folder_
                                         << "\". Name one, --restart=FILE, or start from the first step.");
  std::optional<Error> first;
  std::optional<Whole> newest;
  for (const std::string &path : newest_first) {
    try {
      newest.emplace(whole(path, comm));
      break;
    } catch (const Error &error) { // damaged; on all ranks
      if (!first) first = error;
    }
  }
  if (!newest) throw *first;
  restart_ = newest->path;
  return state_of(std::move(*newest));
}

/// Checkpoints of this deck's name, the newest first; rank 0 only.
std::vector<std::string> Checkpoints::in_folder() const
{
  const std::string stem = stem_of(scene_);
  std::vector<std::string> found;
  std::error_code none;
  for (const auto &entry : std::filesystem::directory_iterator(folder_, none)) {
    const std::string name = entry.path().filename().string();
    const bool checkpoint = name.size() == stem.size() + 8 && name.compare(0, stem.size(), stem) == 0 &&
                            name.find_first_not_of("0123456789", stem.size()) == name.size() - 2 &&
                            name.substr(name.size() - 2) == ".e";
    if (checkpoint) found.push_back((std::filesystem::path(folder_) / name).string());
  }
  std::sort(found.rbegin(), found.rend());
  return found;
}

analysis::HistoryState Checkpoints::state_of(Whole whole) const
{
  const std::string &path = whole.path;
  analysis::HistoryState state;
  state.discretization = std::move(whole.discretization);
  state.mesh_options = std::move(whole.mesh_options);
  const fem::Discretization &d = state.discretization;
  const int sides = static_cast<int>(scene_.model.contact.size());
  const ResultScope scope = analysis::result_scope(scene_.model, d);
  try {
    const json text = json::parse(whole.file.text());
    for (const json &record : text.at("records")) state.records.push_back(record_from(record, scope));
    std::vector<std::pair<std::string, std::string>> before;
    for (const auto &[name, content] : text.at("deck").items()) before.emplace_back(name, content);
    require_continuation(scene_, d, before, state.records, path);
    FieldReader reader(whole.fields ? std::move(*whole.fields) : whole.file.fields(*d.mesh), d);
    state.last.time = whole.file.time();
    state.last.energies = energies_from(text.at("energies"), scope);
    state.last.energy_scale = text.at("energy_scale");
    state.last.obstacle = text.value("obstacle", Point{});
    state.last.displacement = reader.components();
    state.last.pressure = reader.columns(sides);
    state.last.dent = reader.columns(sides);
    state.last.gap = reader.columns(sides);
    const bool tangential = text.contains("tangential"); // multipliers along the sides, where the law has them
    if (tangential) state.last.tangential = reader.columns(sides * d.dim());
    if (text.contains("before")) {
      state.before.emplace();
      state.before->time = text.at("before");
      state.before->obstacle = text.value("obstacle_before", Point{});
      state.before->displacement = reader.components();
      state.before->pressure = reader.columns(sides);
      if (tangential) state.before->tangential = reader.columns(sides * d.dim());
    }
    if (const auto *const dents = array_of(whole.file, "foundation_dents"))
      state.last.foundations = contact::dents_from(d.mesh->comm(), *dents);
    state.matrix_assemblies = text.at("assemblies");
    if (const auto largest = text.find("largest_estimate"); largest != text.end() && !largest->is_null()) // NaN is null
      state.largest_estimate = *largest;
    state.misread_force = text.at("misread_force");
    state.misread_energy = text.at("misread_energy");
    state.misread_penetration = text.at("misread_penetration");
  } catch (const json::parse_error &) { // on all ranks: they read the same text
    throw Error(ExitCode::bad_input, "restart: \"" + path +
                                         "\" is damaged: its text is not what was written. Take an older one, "
                                         "or start from the first step.");
  } catch (const json::exception &) { // the text is whole, but not this program's
    throw Error(ExitCode::bad_input, "restart: \"" + path + "\" was written by an earlier state of version " +
                                         RPC_VERSION +
                                         ", with other contents. Go on with that program, or start "
                                         "from the first step.");
  }
  RPC_REQUIRE(scene_.steps.times.back() > state.last.time,
              "restart: \"" << path << "\" is of t = " << state.last.time
                            << ", and none of \"Steps->Times\" is later: there is nothing to do");
  return state;
}

void Checkpoints::write(const analysis::HistoryState &state)
{
  const fem::Discretization &d = state.discretization;
  const ResultScope scope = analysis::result_scope(scene_.model, d);
  json text = {{"energies", kept_numbers(analysis::energy_quantities, state.last.energies, scope)},
               {"energy_scale", state.last.energy_scale},
               {"obstacle", state.last.obstacle},
               {"assemblies", state.matrix_assemblies},
               {"largest_estimate", state.largest_estimate},
               {"misread_force", state.misread_force},
               {"misread_energy", state.misread_energy},
               {"misread_penetration", state.misread_penetration}};
  for (const auto &[name, content] : scene_.identity) text["deck"][name] = content;
  text["records"] = json::array();
  for (const StepRecord &record : state.records) text["records"].push_back(to_json(record, scope));
  std::vector<io::NodalField> fields;
  add_components(fields, "displacement_", *state.last.displacement, d.dim());
  add_columns(fields, "pressure_", *state.last.pressure);
  add_columns(fields, "dent_", *state.last.dent);
  add_columns(fields, "gap_", *state.last.gap);
  const bool tangential = !state.last.tangential.is_null();
  if (tangential) {
    text["tangential"] = true;
    add_columns(fields, "tangential_", *state.last.tangential);
  }
  if (state.before) {
    text["before"] = state.before->time;
    text["obstacle_before"] = state.before->obstacle;
    add_components(fields, "before_displacement_", *state.before->displacement, d.dim());
    add_columns(fields, "before_pressure_", *state.before->pressure);
    if (tangential) add_columns(fields, "before_tangential_", *state.before->tangential);
  }
  std::ostringstream name;
  name << stem_of(scene_) << std::setw(6) << std::setfill('0') << state.records.size() << ".e";
  const std::string path = (std::filesystem::path(folder_) / name.str()).string();
  const auto *const sized = sized_mesh(state);
  auto arrays = sized ? arrays_of(*sized) : std::vector<io::NamedArray>();
  if (!state.last.foundations.empty())
    arrays.push_back({"foundation_dents", contact::stored_dents(d.mesh->comm(), state.last.foundations)});
  io::write_checkpoint(path, *d.mesh, state.last.time, fields, text.dump(), arrays);
  on_root(d.mesh->comm(), ExitCode::internal_error, [&] { remove_others(path); });
}

void Checkpoints::remove_others(const std::string &newest)
{
  written_.push_back(newest);
  const auto keep = [&](const std::string &path) {
    std::error_code none;
    const bool ours =
        std::find(written_.end() - std::min(written_.size(), kept), written_.end(), path) != written_.end();
    return ours || (written_.size() < kept && std::filesystem::equivalent(path, restart_, none));
  };
  for (const std::string &path : in_folder())
    if (!keep(path)) io::remove_older(path);
}

} // namespace rpc
