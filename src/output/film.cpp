#include "output/film.hpp"

#include "output/paths.hpp"
#include "rpc/core/timed.hpp"
#include "rpc/fem/stress.hpp"

namespace rpc
{
namespace
{

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

std::vector<io::NodalField> nodal_fields(const Scene &scene, const analysis::Solution &s)
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

} // namespace

void Film::write(const Scene &scene, const analysis::Solution &s, const std::string &folder)
{
  const Timed timer("film", seconds_);
  const auto fields = nodal_fields(scene, s);
  if (!file_ || mesh_ != s.discretization.mesh) {
    if (file_) file_->commit();
    std::vector<std::string> names;
    for (const auto &field : fields) names.push_back(field.name);
    mesh_ = s.discretization.mesh;
    files_.push_back(film_part(ResultPaths(scene, folder).exodus, static_cast<int>(files_.size()) + 1));
    file_ = std::make_unique<io::ExodusFile>(files_.back(), scene.name, *mesh_, names);
    const auto before = files_.size() == 1 ? earlier_times(scene, s) : std::vector<double>();
    if (!before.empty() && file_->take_times(files_.back(), before) < static_cast<int>(before.size()))
      note_ = "\"" + files_.back() +
              "\" lacks times before the restart: no film of these fields on this mesh was there to go on with";
  }
  file_->write(s.time, fields);
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
