#include "output.hpp"

#include "rpc/core/on_root.hpp"
#include "rpc/core/timed.hpp"
#include "rpc/fem/stress.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/io/atomic_file.hpp"
#include "rpc/io/contact_csv.hpp"
#include "rpc/io/exodus.hpp"
#include "rpc/io/gather.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace rpc
{
namespace
{

/// An adaptive run comes to far fewer meshes.
constexpr int most_cycles = 1000;

/// All files that results of one name can have.
std::vector<std::string> all_files(const std::string &name, const std::string &folder)
{
  const std::string stem = (std::filesystem::path(folder) / name).string();
  return {stem + ".e", stem + ".contact.csv", stem + ".json", stem + ".history.csv"};
}

/// Where the results of a scene go under a name; empty what is not asked for.
struct ResultPaths {
  std::string exodus, csv, json, history;

  ResultPaths(const Scene &scene, const std::string &name, const std::string &folder)
  {
    const auto files = all_files(name, folder);
    if (scene.output.exodus) exodus = files[0];
    if (scene.output.csv && !scene.model.contact.empty()) csv = files[1];
    if (scene.output.json) json = files[2];
    if (scene.output.csv && !scene.steps.times.empty()) history = files[3];
  }
  std::vector<std::string> all() const { return {exodus, csv, history, json}; }
  void require_replaceable() const
  {
    for (const std::string &path : all())
      if (!path.empty()) io::require_replaceable(path);
  }
};

HostView<double *> column(const MultiVector &v, const int stride, const int offset, const LO n, const int col)
{
  HostView<double *> values("rpc::output::column", n);
  const auto from = v.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO i = 0; i < n; ++i) values(i) = from(stride * i + offset, col);
  return values;
}

/// The contact point that a node's fields show, -1 for none: of a node of two sides the one with the higher pressure.
std::vector<LO> shown_points(const contact::ContactNodes &contact, const contact::ContactResult &result,
                             const LO num_nodes)
{
  std::vector<LO> shown(num_nodes, -1);
  const auto node = to_host(contact.node);
  const auto pressure = to_host(result.pressure);
  for (LO i = 0; i < contact.size(); ++i) {
    LO &point = shown[node(i)];
    if (point < 0 || pressure(i) > pressure(point)) point = i;
  }
  return shown;
}

template <class HostColumn>
HostView<double *> scatter(const std::vector<LO> &shown, const HostColumn &values, const double elsewhere)
{
  HostView<double *> result("rpc::output::contact_field", shown.size());
  for (std::size_t n = 0; n < shown.size(); ++n) result(n) = shown[n] < 0 ? elsewhere : values(shown[n]);
  return result;
}

std::vector<io::NodalField> nodal_fields(const Scene &scene, const Solution &s)
{
  const fem::Discretization &d = s.discretization;
  const int dim = d.dim();
  const LO n = d.mesh->num_owned_nodes();
  std::vector<io::NodalField> fields;
  const char *const displacement[] = {"disp_x", "disp_y", "disp_z"};
  for (int c = 0; c < dim; ++c) fields.push_back({displacement[c], column(*s.u, dim, c, n, 0)});
  const auto stress = fem::RecoveredStress(d, scene.model.materials, *s.u).at_nodes();
  const auto names = fem::stress_names(d);
  for (std::size_t k = 0; k < names.size(); ++k)
    fields.push_back({names[k], column(*stress, 1, 0, n, static_cast<int>(k))});
  if (scene.model.contact.empty()) return fields;
  const contact::ContactNodes &contact = s.step.contact;
  const auto shown = shown_points(contact, s.contact, n);
  fields.push_back({"contact_pressure", scatter(shown, to_host(s.contact.pressure), 0)});
  fields.push_back({"gap", scatter(shown, to_host(contact.gap), 0)});
  fields.push_back({"dent", scatter(shown, to_host(s.contact.dent), 0)});
  fields.push_back({"penetration", scatter(shown, to_host(s.contact.penetration), 0)});
  fields.push_back({"contact_status", scatter(shown, to_host(s.contact.state), -1)});
  const auto normal = to_host(contact.normal);
  const char *const component[] = {"contact_normal_x", "contact_normal_y", "contact_normal_z"};
  for (int c = 0; c < dim; ++c)
    fields.push_back({component[c], scatter(shown, Kokkos::subview(normal, Kokkos::ALL, c), 0)});
  return fields;
}

/// Where a part of a film goes.
/// @param part  from 1
std::string part_name(const std::string &exodus, const int part)
{
  if (part == 1) return exodus;
  std::ostringstream name;
  name << exodus << "-s" << std::setw(4) << std::setfill('0') << part;
  return name.str();
}

/// [begin, end) of a view, on the host.
template <class Data>
HostView<Data *> part_of(const DeviceView<Data *> &values, const LO begin, const LO end)
{
  HostView<Data *> part(values.label(), end - begin);
  Kokkos::deep_copy(part, Kokkos::subview(values, Kokkos::make_pair(begin, end)));
  return part;
}

void write_csv(const std::string &path, const Scene &scene, const Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto &contact = s.step.contact;
  const HostPoints position = fem::node_positions(mesh, contact.node);
  const auto node_ids = io::overlap_node_ids(mesh);
  std::vector<io::ContactTable> tables;
  for (int k = 0; k < contact.num_sides(); ++k) {
    const LO begin = contact.first(k), end = contact.first(k + 1);
    io::ContactTable table;
    table.side = scene.model.contact[k].side;
    table.id = HostView<GO *>("rpc::output::id", end - begin);
    table.position = HostView<double **>("rpc::output::position", end - begin, mesh.dim());
    const auto node = part_of(contact.node, begin, end);
    for (LO i = 0; i < end - begin; ++i) {
      table.id(i) = mesh.node_id(node(i));
      for (int c = 0; c < mesh.dim(); ++c) table.position(i, c) = position(begin + i, c);
    }
    table.weight = part_of(contact.weight, begin, end);
    table.u_nu = part_of(s.contact.normal_displacement, begin, end);
    table.gap = part_of(contact.gap, begin, end);
    table.pressure = part_of(s.contact.pressure, begin, end);
    table.dent = part_of(s.contact.dent, begin, end);
    table.state = part_of(s.contact.state, begin, end);
    table.facets = io::owned_facets(mesh, mesh.side(table.side, scene.model.contact[k].path + "->Side"), node_ids);
    tables.push_back(table);
  }
  io::write_contact_csv(path, mesh.owned_nodes->getComm(), tables);
}

nlohmann::ordered_json vector_json(const std::array<double, 3> &v, const int dim)
{
  return std::vector<double>(v.begin(), v.begin() + dim);
}

/// "contact_length", or "contact_area" of a body with its whole surface.
std::string extent_key(const std::string &what, const fem::Discretization &d)
{
  return what + (d.per_metre() ? "_length" : "_area");
}

void add_sums(nlohmann::ordered_json &json, const contact::ContactSums &sums, const fem::Discretization &d)
{
  json["contact_nodes"] = sums.num_nodes;
  json["contact_force"] = vector_json(sums.force, d.dim());
  json["max_pressure"] = sums.max_pressure;
  json["max_penetration"] = sums.max_penetration;
  json["max_initial_penetration"] = sums.max_initial_penetration;
  json[extent_key("contact", d)] = sums.contact_length;
  json[extent_key("yielded", d)] = sums.yielded_length;
  json["max_dent"] = sums.max_dent;
  json["dent_volume"] = sums.dent_volume;
}

void add_steps(nlohmann::ordered_json &json, const Solution &s)
{
  auto &steps = json["steps"] = nlohmann::ordered_json::array();
  for (const analysis::StepRecord &step : s.history) {
    nlohmann::ordered_json entry = {{"time", step.time},
                                    {"converged", step.converged},
                                    {"strain_energy", step.energies.strain},
                                    {"foundation_energy", step.energies.foundation},
                                    {"dissipated_energy", step.energies.dissipated},
                                    {"work", step.energies.work}};
    add_sums(entry, step.contact, s.discretization);
    entry["parts"] = step.parts;
    entry["solves"] = step.solves;
    entry["newton_iterations"] = step.newton_iterations;
    entry["linear_solves"] = step.linear_solves;
    entry["linear_iterations"] = step.linear_iterations;
    entry["preconditioner_setups"] = step.preconditioner_setups;
    entry["seconds"] = step.seconds;
    steps.push_back(entry);
  }
}

/// One row for each load step; for each Dirichlet condition its mean displacement and its reaction.
std::string history_text(const Scene &scene, const Solution &s)
{
  const int dim = s.discretization.dim();
  const std::string axes = "xyz";
  std::ostringstream text;
  text.precision(17);
  text << "time,strain_energy,foundation_energy,dissipated_energy,work,max_pressure,max_penetration,max_dent,dent_"
          "volume,"
       << extent_key("contact", s.discretization) << ',' << extent_key("yielded", s.discretization);
  for (int c = 0; c < dim; ++c) text << ",contact_force_" << axes[c];
  for (const auto &condition : scene.model.dirichlet)
    for (const char *const what : {"_displacement_", "_reaction_"})
      for (int c = 0; c < dim; ++c) text << ',' << io::csv_quoted(condition.name + what + axes[c]);
  text << ",newton_iterations,linear_iterations,parts,seconds\n";
  for (const analysis::StepRecord &step : s.history) {
    const contact::ContactSums &sums = step.contact;
    text << step.time << ',' << step.energies.strain << ',' << step.energies.foundation << ','
         << step.energies.dissipated << ',' << step.energies.work << ',' << sums.max_pressure << ','
         << sums.max_penetration << ',' << sums.max_dent << ',' << sums.dent_volume << ',' << sums.contact_length << ','
         << sums.yielded_length;
    for (int c = 0; c < dim; ++c) text << ',' << sums.force[c];
    for (std::size_t k = 0; k < step.reactions.size(); ++k) {
      for (int c = 0; c < dim; ++c) text << ',' << step.displacements[k][c];
      for (int c = 0; c < dim; ++c) text << ',' << step.reactions[k][c];
    }
    text << ',' << step.newton_iterations << ',' << step.linear_iterations << ',' << step.parts << ',' << step.seconds
         << '\n';
  }
  return text.str();
}

/// A number that may be unknown: null then.
nlohmann::ordered_json maybe(const double value)
{
  return std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

void add_errors(nlohmann::ordered_json &json, const Scene &scene, const Solution &s)
{
  if (!s.estimate) return;
  const double relative = relative_estimate(s), exact = exact_error(scene, s);
  json["error_estimate"] = {{"energy_norm", std::sqrt(s.estimate->total())},
                            {"relative", relative},
                            {"recovery", std::sqrt(s.estimate->recovery)},
                            {"contact_equilibrium", std::sqrt(s.estimate->equilibrium)},
                            {"contact_complementarity", std::sqrt(s.estimate->complementarity)},
                            {"rounding", std::sqrt(s.estimate->rounding)},
                            {"exact_relative", maybe(exact)},
                            {"effectivity", maybe(relative / exact)}};
  if (!s.adaptation) return;
  const adapt::Adaptation &a = *s.adaptation;
  json["adaptation"] = {{"target", scene.adapt.target}, {"reached", a.reached}, {"reason", a.reason}};
  json["adaptation"]["errors"] = {{"energy_J", maybe(a.errors.energy)},
                                  {"contact_force", maybe(a.errors.contact_force)},
                                  {"max_pressure", maybe(a.errors.max_pressure)},
                                  {"contact_pressure_l2_relative", maybe(a.errors.contact_pressure)},
                                  {extent_key("contact", s.discretization), maybe(a.errors.contact_length)}};
  auto &unknown = json["adaptation"]["errors_unknown"] = nlohmann::ordered_json::object();
  for (const auto &[name, reason] : a.errors.unknown)
    unknown[name == "contact_length" ? extent_key("contact", s.discretization) : name] = reason;
  auto &cycles = json["adaptation"]["cycles"] = nlohmann::ordered_json::array();
  for (const adapt::Cycle &c : a.cycles)
    cycles.push_back({{"dofs", c.dofs},
                      {"relative_estimate", c.estimate},
                      {"energy_J", c.energy},
                      {"contact_force", vector_json(c.contact_force, s.discretization.dim())},
                      {"max_pressure", c.max_pressure},
                      {extent_key("contact", s.discretization), c.contact_length},
                      {"newton_iterations", c.newton_iterations},
                      {"linear_iterations", c.linear_iterations},
                      {"seconds", c.seconds}});
}

} // namespace

nlohmann::ordered_json summary(const Scene &scene, const Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  nlohmann::ordered_json json;
  json["rpc_version"] = RPC_VERSION;
  json["deck"] = scene.name;
  json["converged"] = s.uzawa.converged;
  json["reason"] = s.uzawa.reason;
  if (mesh.dim() == 2) json["kinematics"] = fem::name_of(s.discretization.kinematics);
  json["element"] = mesh.element.name();
  json["cells"] = sum_all(mesh.comm(), GO(mesh.num_owned_cells));
  json["dofs"] = s.discretization.owned_dofs->getGlobalNumElements();
  json["fixed_contact_nodes"] = s.step.contact.num_fixed;
  json["ranks"] = mesh.comm().getSize();
  json["execution_space"] = ExecutionSpace::name();
  json["time"] = s.time;
  json["energy_J"] = s.energy;
  json["strain_energy"] = 0.5 * s.energy_norm_squared;
  json["energy_norm_squared"] = s.energy_norm_squared;
  add_sums(json, s.contact.total, s.discretization);
  json["contact_sides"] = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < scene.model.contact.size(); ++k)
    add_sums(json["contact_sides"][scene.model.contact[k].side], s.contact.sides[k], s.discretization);
  json["reaction_force"] = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < scene.model.dirichlet.size(); ++k)
    json["reaction_force"][scene.model.dirichlet[k].name] = vector_json(s.reactions[k], mesh.dim());
  json["kkt_residual"] = s.uzawa.residuals.kkt_residual;
  json["equilibrium_residual"] = s.uzawa.residuals.equilibrium_residual;
  json["energy_balance"] = s.uzawa.residuals.energy_balance;
  json["duality_gap"] = s.uzawa.residuals.duality_gap;
  json["multiplier_change"] = s.uzawa.multiplier_change;
  json["uzawa_iterations"] = s.uzawa.iterations;
  json["newton_iterations"] = s.uzawa.newton_iterations;
  json["line_search_steps"] = s.line_search_steps;
  json["linear_solves"] = s.linear.iterations.size();
  json["linear_iterations"] = s.linear.iterations;
  json["preconditioner_setups"] = s.linear.preconditioner_setups;
  json["local_corrections"] = s.linear.local_corrections;
  json["matrix_assemblies"] = s.matrix_assemblies;
  if (!s.history.empty()) add_steps(json, s);
  add_errors(json, scene, s);
  json["skipped"] = s.skipped;
  json["levels"] = nlohmann::ordered_json::array();
  for (const auto &level : s.levels)
    json["levels"].push_back({{"dofs", level.dofs},
                              {"newton_iterations", level.newton_iterations},
                              {"linear_iterations", level.linear_iterations},
                              {"preconditioner_setups", level.preconditioner_setups},
                              {"seconds", level.seconds}});
  const auto &t = s.seconds;
  json["seconds"] = {{"mesh", t.mesh},   {"assembly", t.assembly}, {"prediction", t.prediction}, {"setup", t.setup},
                     {"solve", t.solve}, {"estimate", t.estimate}, {"output", t.output},         {"total", t.total}};
  return json;
}

std::string cycle_name(const Scene &scene, const int cycle)
{
  return scene.name + ".cycle" + std::to_string(cycle);
}

void require_writable_results(const Scene &scene, const std::string &folder, const Comm &comm)
{
  on_root(comm, ExitCode::bad_input, [&] {
    io::require_writable_folder(folder);
    ResultPaths(scene, scene.name, folder).require_replaceable();
    std::error_code none;
    for (const std::string &file : all_files(scene.name, folder)) // those that are not written are removed
      if (std::filesystem::is_regular_file(file, none)) io::require_replaceable(file);
    if (!scene.adapt.adapts() || !scene.adapt.write_all) return;
    for (int cycle = 1; cycle <= std::min(scene.adapt.max_cycles, most_cycles); ++cycle)
      ResultPaths(scene, cycle_name(scene, cycle), folder).require_replaceable();
  });
}

/// Files of the same name that an earlier run has left and this run does not write, those of its meshes included.
/// @param parts  of the film that this run has written
std::vector<std::string> older_files(const Scene &scene, const Solution &s, const ResultPaths &paths,
                                     const std::string &folder, const int parts)
{
  std::vector<std::string> older;
  const auto add_existing = [&](const std::string &name) {
    bool found = false;
    for (const std::string &file : all_files(name, folder)) {
      std::error_code none;
      if (const auto ours = paths.all(); std::find(ours.begin(), ours.end(), file) != ours.end()) continue;
      if (!std::filesystem::exists(file, none)) continue;
      older.push_back(file);
      found = true;
    }
    return found;
  };
  add_existing(scene.name);
  for (int part = parts + 1;; ++part) {
    const std::string file = part_name(all_files(scene.name, folder)[0], std::max(part, 2));
    std::error_code none;
    if (!std::filesystem::exists(file, none)) break;
    older.push_back(file);
  }
  int cycle = scene.adapt.write_all && s.adaptation ? static_cast<int>(s.adaptation->cycles.size()) : 0;
  while (add_existing(cycle_name(scene, ++cycle))) {
  }
  return older;
}

void Film::write(const Scene &scene, const Solution &s, const std::string &folder)
{
  const Timed timer("film", seconds_);
  const auto fields = nodal_fields(scene, s);
  if (!file_ || mesh_ != s.discretization.mesh) {
    if (file_) file_->commit();
    std::vector<std::string> names;
    for (const auto &field : fields) names.push_back(field.name);
    mesh_ = s.discretization.mesh;
    files_.push_back(part_name(ResultPaths(scene, scene.name, folder).exodus, static_cast<int>(files_.size()) + 1));
    file_ = std::make_unique<io::ExodusFile>(files_.back(), scene.name, *mesh_, names);
  }
  file_->write(s.time, fields);
  written_ = static_cast<int>(s.history.size());
}

void Film::add(const Scene &scene, const Solution &s, const std::string &folder)
{
  if (scene.output.exodus && s.history.size() % scene.steps.write_every == 0) write(scene, s, folder);
}

void Film::finish(const Scene &scene, const Solution &s, const std::string &folder)
{
  if (!file_ || written_ < static_cast<int>(s.history.size())) write(scene, s, folder);
  file_->commit();
}

std::vector<std::string> write_results(const Scene &scene, Solution &s, const std::string &folder, const double start,
                                       Film &film)
{
  const double begin = Teuchos::Time::wallTime() - film.seconds();
  const ResultPaths paths(scene, scene.name, folder);
  const mesh::Mesh &mesh = *s.discretization.mesh;
  if (!paths.exodus.empty()) film.finish(scene, s, folder);
  if (!paths.csv.empty()) write_csv(paths.csv, scene, s);
  if (!paths.history.empty())
    on_root(mesh.comm(), ExitCode::internal_error, [&] { io::write_text(paths.history, history_text(scene, s)); });
  on_root(mesh.comm(), ExitCode::internal_error, [&] {
    for (const std::string &file : older_files(scene, s, paths, folder, static_cast<int>(film.files().size())))
      io::remove_older(file);
  });
  const double now = Teuchos::Time::wallTime();
  s.seconds.output = now - begin;
  s.seconds.total = now - start;
  if (!paths.json.empty()) { // last: its presence says that the others are complete and of this run
    // Collective, hence outside. A deck's name may be no valid UTF-8.
    const auto json = summary(scene, s);
    const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    on_root(mesh.comm(), ExitCode::internal_error, [&] { io::write_text(paths.json, text); });
  }
  std::vector<std::string> files = film.files();
  for (const std::string &path : paths.all())
    if (!path.empty() && path != paths.exodus) files.push_back(path);
  return files;
}

} // namespace rpc
