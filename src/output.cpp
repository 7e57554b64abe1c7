#include "output.hpp"

#include "rpc/fem/stress.hpp"
#include "rpc/io/atomic_file.hpp"
#include "rpc/io/contact_csv.hpp"
#include "rpc/io/exodus.hpp"
#include "rpc/io/gather.hpp"
#include "rpc/io/on_root.hpp"

#include <Teuchos_Time.hpp>
#include <filesystem>

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

template <class DeviceColumn>
HostView<double *> scatter(const contact::ContactNodes &contact, const DeviceColumn &values, const LO num_nodes,
                           const double elsewhere)
{
  HostView<double *> result("rpc::output::contact_field", num_nodes);
  Kokkos::deep_copy(result, elsewhere);
  const auto node = to_host(contact.node);
  const auto from = to_host(values);
  for (LO i = 0; i < contact.size(); ++i) result(node(i)) = from(i);
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
  const auto stress = fem::nodal_stresses(d, scene.material, *s.u);
  const auto names = fem::stress_names(dim);
  for (std::size_t k = 0; k < names.size(); ++k)
    fields.push_back({names[k], column(*stress, 1, 0, n, static_cast<int>(k))});
  if (scene.contact.side.empty()) return fields;
  const auto &contact = s.functional->contact();
  fields.push_back({"contact_pressure", scatter(contact, s.contact.pressure, n, 0)});
  fields.push_back({"gap", scatter(contact, contact.gap, n, 0)});
  fields.push_back({"penetration", scatter(contact, s.contact.penetration, n, 0)});
  fields.push_back({"contact_status", scatter(contact, s.contact.state, n, -1)});
  return fields;
}

void write_csv(const std::string &path, const Scene &scene, const Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto &contact = s.functional->contact();
  const auto node = to_host(contact.node);
  const auto coords = to_host(mesh.coords);
  io::ContactTable table;
  const LO n = contact.size();
  table.id = HostView<GO *>("rpc::output::id", n);
  table.position = HostView<double **>("rpc::output::position", n, mesh.dim());
  for (LO i = 0; i < n; ++i) {
    table.id(i) = mesh.node_id(node(i));
    for (int c = 0; c < mesh.dim(); ++c) table.position(i, c) = coords(node(i), c);
  }
  table.u_nu = to_host(s.contact.normal_displacement);
  table.gap = to_host(contact.gap);
  table.pressure = to_host(s.contact.pressure);
  table.state = to_host(s.contact.state);
  const auto facets =
      io::owned_facets(mesh, mesh.side(scene.contact.side, "Contact->Side"), io::overlap_node_ids(mesh));
  io::write_contact_csv(path, mesh.owned_nodes->getComm(), table, facets);
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
  json["element"] = mesh.element.name();
  json["cells"] = sum_all(mesh.comm(), GO(mesh.num_owned_cells));
  json["dofs"] = s.discretization.owned_dofs->getGlobalNumElements();
  json["contact_nodes"] = s.functional->contact().num_total;
  json["fixed_contact_nodes"] = s.functional->contact().num_fixed;
  json["ranks"] = mesh.comm().getSize();
  json["execution_space"] = ExecutionSpace::name();
  json["energy_J"] = s.energy;
  json["strain_energy"] = s.strain_energy;
  json["contact_force"] = std::vector<double>(s.contact.force.begin(), s.contact.force.begin() + mesh.dim());
  json["max_pressure"] = s.contact.max_pressure;
  json["max_penetration"] = s.contact.max_penetration;
  json["max_initial_penetration"] = s.contact.max_initial_penetration;
  json["contact_length"] = s.contact.contact_length;
  json["yielded_length"] = s.contact.yielded_length;
  json["kkt_residual"] = s.uzawa.certificate.kkt_residual;
  json["equilibrium_residual"] = s.uzawa.certificate.equilibrium_residual;
  json["multiplier_change"] = s.uzawa.multiplier_change;
  json["uzawa_iterations"] = s.uzawa.iterations;
  json["newton_iterations"] = s.uzawa.newton_iterations;
  json["linear_solves"] = s.linear.iterations.size();
  json["linear_iterations"] = s.linear.iterations;
  json["preconditioner_setups"] = s.linear.preconditioner_setups;
  json["matrix_assemblies"] = s.matrix_assemblies;
  const auto &t = s.seconds;
  json["seconds"] = {{"mesh", t.mesh},   {"assembly", t.assembly}, {"setup", t.setup},
                     {"solve", t.solve}, {"output", t.output},     {"total", t.total}};
  return json;
}

std::vector<std::string> write_results(const Scene &scene, Solution &s, const std::string &folder, const double start)
{
  const double begin = Teuchos::Time::wallTime();
  const std::string stem = (std::filesystem::path(folder) / scene.name).string();
  const mesh::Mesh &mesh = *s.discretization.mesh;
  std::vector<std::string> files;
  if (scene.output.exodus) {
    files.push_back(stem + ".e");
    io::write_exodus(files.back(), scene.name, mesh, nodal_fields(scene, s));
  }
  if (scene.output.csv && !scene.contact.side.empty()) {
    files.push_back(stem + ".contact.csv");
    write_csv(files.back(), scene, s);
  }
  const double now = Teuchos::Time::wallTime();
  s.seconds.output = now - begin;
  s.seconds.total = now - start;
  if (scene.output.json) { // last: its presence says that the others are complete
    files.push_back(stem + ".json");
    // Collective, hence outside. A deck's name may be no valid UTF-8.
    const auto json = summary(scene, s);
    const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    io::on_root(mesh.comm(), ExitCode::internal_error, [&] { io::write_text(files.back(), text); });
  }
  return files;
}

} // namespace rpc
