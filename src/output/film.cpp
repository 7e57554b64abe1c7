// SPDX-License-Identifier: BSD-3-Clause
#include "output/film.hpp"

#include "output/paths.hpp"
#include "rpc/core/memory.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/timed.hpp"
#include "rpc/fem/stress.hpp"
#include "rpc/io/atomic_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <utility>

namespace rpc
{
namespace
{

constexpr const char *error_field = "error_energy_norm";

HostView<double *> column(const MultiVector &v, const int stride, const int offset, const LO n, const int col)
{
  HostView<double *> values("rpc::output::column", n);
  const auto from = v.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO i = 0; i < n; ++i) values(i) = from(stride * i + offset, col);
  return values;
}

/// The contact point that a node's fields show, -1 for none: of a node of two sides or foundations the one with the higher pressure,
/// of two without pressure that which is nearer to its foundation.
std::vector<LO> shown_points(const contact::ContactNodes &contact, const contact::ContactResult &result,
                             const LO num_nodes)
{
  std::vector<LO> shown(num_nodes, -1);
  const auto node = to_host(contact.node);
  const auto pressure = to_host(result.pressure), penetration = to_host(result.penetration);
  for (LO i = 0; i < contact.size(); ++i) {
    LO &point = shown[node(i)];
    if (point < 0 || std::pair(pressure(i), penetration(i)) > std::pair(pressure(point), penetration(point))) point = i;
  }
  return shown;
}

template <class HostColumn>
HostView<double *> scatter(const std::vector<LO> &shown, const HostColumn &values, const double elsewhere)
{
  HostView<double *> result(Kokkos::ViewAllocateWithoutInitializing("rpc::output::contact_field"), shown.size());
  for (std::size_t n = 0; n < shown.size(); ++n) result(n) = shown[n] < 0 ? elsewhere : values(shown[n]);
  return result;
}

std::vector<io::NodalField> nodal_fields(const Scene &scene, const analysis::Solution &s)
{
  const fem::Discretization &d = s.discretization;
  const int dim = d.dim();
  const LO n = d.mesh->num_owned_nodes();
  std::vector<io::NodalField> fields;
  const char *const displacement[] = {"disp_x", "disp_y", "disp_z"};
  for (int c = 0; c < dim; ++c) fields.push_back({displacement[c], column(*s.u, dim, c, n, 0)});
  return_freed_memory(); // the linear solver's: recovery takes several times as much as the fields
  const auto stress = fem::RecoveredStress(d, scene.model.materials, *s.u).at_nodes();
  return_freed_memory();
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
  const auto add_vector = [&](const std::string &name, const auto &vectors) {
    const std::string axes = "xyz";
    for (int c = 0; c < dim; ++c)
      fields.push_back({name + axes[c], scatter(shown, Kokkos::subview(vectors, Kokkos::ALL, c), 0)});
  };
  add_vector("contact_normal_", normal);
  if (!contact::has_friction(scene.model.contact)) return fields;
  add_vector("friction_", to_host(s.contact.traction));
  add_vector("slip_", to_host(s.contact.slip));
  fields.push_back({"friction_used", scatter(shown, to_host(s.contact.used), 0)});
  fields.push_back({"friction_status", scatter(shown, to_host(s.contact.slip_state), 0)});
  return fields;
}

/// Names of what cells have.
std::vector<std::string> cell_field_names(const Scene &scene, const fem::Discretization &d)
{
  std::vector<std::string> names;
  if (scene.adapt.estimate) names.emplace_back(error_field);
  if (scene.output.cell_stresses)
    for (const std::string &name : fem::stress_names(d)) names.push_back("cell_" + name);
  return names;
}

/// What cells have: the estimated error of each in the energy norm, where there is an estimate, and mean stresses, where they are asked for.
std::vector<io::CellField> cell_fields(const Scene &scene, const analysis::Solution &s)
{
  std::vector<HostView<double *>> values;
  if (scene.adapt.estimate) {
    const auto squared = to_host(s.squared_errors);
    values.emplace_back("rpc::output::error", squared.extent(0));
    for (std::size_t c = 0; c < squared.extent(0); ++c) values.back()(c) = std::sqrt(std::max(0., squared(c)));
  }
  if (scene.output.cell_stresses) {
    const auto stress = to_host(fem::mean_stresses(s.discretization, scene.model.materials, *s.u));
    for (std::size_t k = 0; k < stress.extent(1); ++k) {
      values.emplace_back("rpc::output::cell_stress", stress.extent(0));
      for (std::size_t c = 0; c < stress.extent(0); ++c) values.back()(c) = stress(c, k);
    }
  }
  std::vector<io::CellField> fields;
  for (const std::string &name : cell_field_names(scene, s.discretization))
    fields.push_back({name, values[fields.size()]});
  return fields;
}

/// The units of the file's numbers as pictures read them.
std::vector<std::string> unit_records(const UnitNames &units, const bool per_length)
{
  return {"unit of length: " + units.length, "unit of force: " + units.force, "unit of stress: " + units.stress(),
          "unit of energy: " + units.of(unit::energy, per_length)};
}

/// The number of the step whose solution this is; after a failure the history has one more.
int number_of(const analysis::Solution &s)
{
  const bool one_more = s.failure && !s.history.empty() && !s.history.back().converged;
  return static_cast<int>(s.history.size()) - (one_more ? 1 : 0);
}

/// Times before this one that a film of the whole run has: none but after a restart, which comes to the first of its own only now.
std::vector<double> earlier_times(const Scene &scene, const analysis::Solution &s)
{
  std::vector<double> times;
  const std::size_t every = scene.steps.write_every;
  for (std::size_t step = every; step < s.history.size(); step += every) times.push_back(s.history[step - 1].time);
  return times;
}

/// A film on disk, joined or split as a scene wants it.
struct FilmOnDisk {
  std::string first;
  io::ExodusFiles files;
  const Comm &comm;

  /// Collective: rank 0 looks.
  bool has(const int part) const
  {
    const std::string path = exodus_on_disk(film_part(first, part), files, comm.getSize()).front();
    return text_of_root(comm, ExitCode::internal_error,
                        [&] { return std::string(std::filesystem::exists(path) ? "yes" : ""); }) == "yes";
  }
  std::vector<double> times(const int part) const { return io::exodus_times(film_part(first, part), comm, files); }
  void remove(const int part) const
  {
    on_root(comm, ExitCode::internal_error, [&] {
      for (const std::string &path : exodus_on_disk(film_part(first, part), files, comm.getSize()))
        io::remove_older(path);
    });
  }
};

/// How many of some times each part of a film on disk has, from the first part to the last that has any. Collective.
std::vector<int> times_in_parts(const FilmOnDisk &film, const std::vector<double> &wanted)
{
  std::vector<int> all;
  std::size_t last = 0;
  for (int part = 1; film.has(part); ++part) {
    const auto times = film.times(part);
    all.push_back(static_cast<int>(std::count_if(times.begin(), times.end(), [&](const double t) {
      return std::binary_search(wanted.begin(), wanted.end(), t);
    })));
    if (all.back() > 0) last = all.size();
  }
  all.resize(last);
  return all;
}

/// Removes the parts behind some, and of the last of these the times behind a last one. Collective.
void end_parts(const FilmOnDisk &film, const int parts, const double last)
{
  for (int part = std::max(parts, 1) + 1; film.has(part); ++part) film.remove(part);
  if (parts == 0) return;
  const auto times = film.times(parts);
  const auto kept = std::upper_bound(times.begin(), times.end(), last) - times.begin();
  if (kept < static_cast<std::ptrdiff_t>(times.size()))
    io::end_exodus_after(film_part(film.first, parts), static_cast<int>(kept), film.comm, film.files);
}

} // namespace

std::unique_ptr<io::ExodusFile> Film::opened(const Scene &scene, const analysis::Solution &s, const std::string &path,
                                             const std::vector<std::string> &fields) const
{
  return std::make_unique<io::ExodusFile>(
      path, scene.name, *on_file_.mesh, fields, unit_records(scene.model.units, s.discretization.per_length()),
      std::vector<io::NamedArray>(), scene.output.exodus_files, cell_field_names(scene, s.discretization));
}

/// Takes over the parts that a run before has left, as far as it is gone on from, and removes the others. Opens the last one if it is of
/// the present mesh. Collective.
void Film::go_on(const Scene &scene, const analysis::Solution &s, const std::string &first,
                 const std::vector<std::string> &fields)
{
  const auto before = earlier_times(scene, s);
  const FilmOnDisk film{first, scene.output.exodus_files, mesh_->comm()};
  const auto found = times_in_parts(film, before);
  const int parts = static_cast<int>(found.size());
  int taken = 0;
  if (parts > 0) {
    file_ = opened(scene, s, film_part(first, parts), fields);
    taken = file_->take_times(film_part(first, parts), before);
    if (taken == 0) file_.reset();
  }
  // A run on one mesh has no use for files on others.
  const int others = taken > 0 ? parts - 1 : scene.adapt.adapts() ? parts : 0;
  for (int part = 1; part <= others + (taken > 0); ++part) files_.push_back(film_part(first, part));
  if (std::accumulate(found.begin(), found.begin() + others, taken) < static_cast<int>(before.size()))
    note_ = "\"" + film_part(first, others + 1) +
            "\" lacks times before the restart: no film of these fields on this mesh was there to go on with";
  if (taken > 0)
    end_parts(film, parts, std::numeric_limits<double>::infinity());
  else
    end_parts(film, others, before.empty() ? 0 : before.back());
}

void Film::write(const Scene &scene, const analysis::Solution &s, const std::string &folder)
{
  const Timed timer("film", seconds_);
  auto fields = nodal_fields(scene, s);
  if (!file_ || mesh_ != s.discretization.mesh) {
    if (file_) file_->commit();
    file_.reset();
    std::vector<std::string> names;
    for (const auto &field : fields) names.push_back(field.name);
    mesh_ = s.discretization.mesh;
    on_file_ = mesh::unrolled(mesh_);
    const std::string first = ResultPaths(scene, folder).exodus;
    if (files_.empty() && scene.has_steps()) go_on(scene, s, first, names);
    if (!file_) {
      files_.push_back(film_part(first, static_cast<int>(files_.size()) + 1));
      file_ = opened(scene, s, files_.back(), names);
    }
  }
  for (auto &field : fields) field.values = on_file_.at_nodes(field.values);
  file_->write(s.time, fields, cell_fields(scene, s));
  if (scene.has_steps()) file_->publish();
  written_ = number_of(s);
}

void Film::add(const Scene &scene, const analysis::Solution &s, const std::string &folder)
{
  if (scene.output.exodus && s.history.size() % scene.steps.write_every == 0) write(scene, s, folder);
}

void Film::finish(const Scene &scene, const analysis::Solution &s, const std::string &folder)
{
  if (!file_ || written_ < number_of(s)) write(scene, s, folder);
  file_->commit();
}

} // namespace rpc
