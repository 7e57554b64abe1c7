#include "rpc/fem/dirichlet.hpp"

#include "component_name.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/evaluate.hpp"
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc::fem
{
namespace
{

/// Owned nodes of a side, each once, ascending.
std::vector<LO> owned_nodes_of(const mesh::Mesh &mesh, const mesh::Side &side)
{
  const auto facets = to_host(side.facets);
  std::vector<char> seen(mesh.num_owned_nodes(), 0);
  std::vector<LO> nodes;
  for (std::size_t f = 0; f < facets.extent(0); ++f)
    for (std::size_t a = 0; a < facets.extent(1); ++a)
      if (facets(f, a) < mesh.num_owned_nodes()) seen[facets(f, a)] = 1;
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    if (seen[n]) nodes.push_back(n);
  return nodes;
}

} // namespace

Teuchos::ParameterList valid_dirichlet_parameters()
{
  Teuchos::ParameterList entry, valid("Dirichlet");
  entry.set("Side", "", "Side of the mesh; by default the side that the entry is named after.");
  for (const char *name : component_name)
    set_field(entry, name, "",
              std::string("Displacement in ") + name +
                  " [m], a number or an expression; absent: this component is free.");
  Teuchos::ParameterList parent;
  set_named_entries(parent, "Dirichlet", entry,
                    "Prescribed displacements, any number of entries with names of your choice.");
  return parent.sublist("Dirichlet");
}

std::vector<DirichletCondition> dirichlet_options(const Teuchos::ParameterList &list, const int dim,
                                                  const FieldParser &parse)
{
  std::vector<DirichletCondition> conditions;
  for (auto it = list.begin(); it != list.end(); ++it) {
    DirichletCondition condition;
    condition.name = list.name(it);
    const Teuchos::ParameterList &entry = list.sublist(condition.name);
    const std::string path = "Dirichlet->" + condition.name;
    condition.side = entry.get<std::string>("Side").empty() ? condition.name : entry.get<std::string>("Side");
    bool any = false;
    for (int c = 0; c < 3; ++c) {
      const std::string text = field_text(entry, component_name[c]);
      if (text.empty()) continue;
      RPC_REQUIRE(c < dim, "deck: \"" << path << "->" << component_name[c] << "\" prescribes a component that a " << dim
                                      << "D mesh does not have");
      condition.displacement[c] = parse(text, path + "->" + component_name[c]);
      any = true;
    }
    RPC_REQUIRE(any, "deck: \"" << path << "\" prescribes nothing. Give X, Y or Z [m].");
    conditions.push_back(condition);
  }
  return conditions;
}

DirichletDofs dirichlet_dofs(const Discretization &d, const std::vector<DirichletCondition> &conditions)
{
  const mesh::Mesh &mesh = *d.mesh;
  const int dim = d.dim();
  const LO num_owned = dim * mesh.num_owned_nodes();
  const auto coords = to_host(mesh.coords);
  HostView<double *> value("rpc::fem::dirichlet_value", num_owned);
  std::vector<int> owner(num_owned, -1);                       // condition that prescribed the unknown
  std::vector<std::array<double, 3>> scale(conditions.size()); // largest value: sin(pi) is 0 up to the round-off of sin
  std::optional<std::string> conflict;

  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const DirichletCondition &condition = conditions[k];
    const std::string path = "Dirichlet->" + condition.name;
    const auto nodes = owned_nodes_of(mesh, mesh.side(condition.side, path + "->Side"));
    HostView<double **> points("rpc::fem::side_points", nodes.size(), dim);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (int c = 0; c < dim; ++c) points(n, c) = coords(nodes[n], c);
    for (int c = 0; c < dim; ++c) {
      if (!condition.displacement[c]) continue;
      const auto values = evaluate(*condition.displacement[c], points, path + "->" + component_name[c], mesh.comm());
      double largest = 0;
      for (std::size_t n = 0; n < nodes.size(); ++n) largest = std::max(largest, std::abs(values(n)));
      scale[k][c] = max_all(mesh.comm(), largest);
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        const LO dof = dim * nodes[n] + c;
        const int other = owner[dof];
        const bool differs =
            other >= 0 && std::abs(value(dof) - values(n)) > 1e-12 * std::max(scale[other][c], scale[k][c]);
        if (differs && !conflict) {
          std::ostringstream message;
          message << "deck: \"Dirichlet->" << conditions[other].name << "\" and \"" << path << "\" prescribe different "
                  << component_name[c] << " at one node (" << points(n, 0) << ", " << points(n, 1)
                  << (dim == 3 ? ", " + std::to_string(points(n, 2)) : "") << "): " << value(dof) << " and "
                  << values(n) << " [m]";
          conflict = message.str();
        }
        owner[dof] = static_cast<int>(k);
        value(dof) = values(n);
      }
    }
  }
  throw_if_any(mesh.comm(), ExitCode::bad_input, conflict);

  DirichletDofs dirichlet;
  dirichlet.value = rcp(new Vector(d.owned_dofs));
  Vector fixed(d.owned_dofs), fixed_overlap(d.overlap_dofs);
  GO count = 0;
  {
    const auto value_to = dirichlet.value->getLocalViewHost(Tpetra::Access::OverwriteAll);
    const auto fixed_to = fixed.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO dof = 0; dof < num_owned; ++dof) {
      value_to(dof, 0) = value(dof);
      fixed_to(dof, 0) = owner[dof] >= 0 ? 1 : 0;
      count += owner[dof] >= 0 ? 1 : 0;
    }
  }
  HostView<int *> condition("rpc::fem::dirichlet_condition", num_owned);
  std::copy(owner.begin(), owner.end(), condition.data());
  dirichlet.condition = to_device(condition);
  dirichlet.num_fixed = sum_all(mesh.comm(), count);
  fixed_overlap.doImport(fixed, *d.dof_import,
                         Tpetra::INSERT); // a neighbour's node may lie on a side whose facets are not here
  dirichlet.fixed = DeviceView<char *>("rpc::fem::dirichlet_fixed", num_local(*d.overlap_dofs));
  const auto flag = dirichlet.fixed;
  const auto from = device_read(fixed_overlap);
  Kokkos::parallel_for(
      "rpc::fem::dirichlet_flags", device_range(num_local(*d.overlap_dofs)),
      KOKKOS_LAMBDA(const LO dof) { flag(dof) = from(dof) != 0; });
  Kokkos::fence();
  return dirichlet;
}

void clear_prescribed(const DirichletDofs &dirichlet, Vector &f)
{
  const auto fixed = dirichlet.fixed;
  const auto to = device_write(f);
  Kokkos::parallel_for(
      "rpc::fem::clear_prescribed", device_range(static_cast<LO>(f.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
        if (fixed(dof)) to(dof) = 0;
      });
  Kokkos::fence();
}

ElasticProblem eliminate_dirichlet(const Discretization &d, RCP<CrsMatrix> stiffness, RCP<Vector> load,
                                   DirichletDofs dirichlet)
{
  ElasticProblem problem;
  const Vector &prescribed = *dirichlet.value;
  const bool moves = prescribed.normInf() > 0;
  Vector force(d.owned_dofs); // of the prescribed displacement, K u_D
  problem.applied_load = rcp(new Vector(*load, Teuchos::Copy));
  if (moves) {
    stiffness->apply(prescribed, force);
    problem.energy_offset = 0.5 * prescribed.dot(force) - load->dot(prescribed);
    load->update(-1., force, 1.);
  }

  const auto fixed = dirichlet.fixed;
  const auto value = device_read(prescribed);
  const auto b = device_write(*load);
  const auto A = stiffness->getLocalMatrixDevice();
  const auto nodes = d.nodes;
  const int dim = d.dim();
  double own_energy = 0; // of the prescribed unknowns in the eliminated problem: -u_D diag(K) u_D / 2
  Kokkos::parallel_reduce(
      "rpc::fem::eliminate_dirichlet", device_range(d.mesh->num_owned_nodes()),
      KOKKOS_LAMBDA(const LO node, double &energy) {
        int touched = 0; // few nodes are: the others' entries need not be read
        for (auto k = nodes.row(node); k < nodes.row(node + 1); ++k)
          for (int c = 0; c < dim; ++c) touched |= fixed(dim * nodes.col(k) + c);
        if (touched == 0) return;
        for (LO row = dim * node; row < dim * (node + 1); ++row) {
          for (auto k = A.graph.row_map(row); k < A.graph.row_map(row + 1); ++k) {
            const LO col = A.graph.entries(k);
            if (col == row) { // a row's own column has its lid in both maps
              if (!fixed(row)) continue;
              b(row) = A.values(k) * value(row);
              energy -= 0.5 * value(row) * b(row);
            } else if (fixed(row) || fixed(col)) {
              A.values(k) = 0;
            }
          }
        }
      },
      own_energy);
  problem.energy_offset -= sum_all(d.mesh->comm(), own_energy);
  problem.stiffness = stiffness;
  problem.load = load;
  problem.dirichlet = std::move(dirichlet);
  return problem;
}

std::vector<std::array<double, 3>> reaction_forces(const Discretization &d, const DirichletDofs &dirichlet,
                                                   const int num_conditions, const Vector &out_of_balance)
{
  const int dim = d.dim();
  DeviceView<double **> sums("rpc::fem::reaction", num_conditions, 3);
  const auto condition = dirichlet.condition;
  const auto force = device_read(out_of_balance);
  Kokkos::parallel_for(
      "rpc::fem::reactions", device_range(static_cast<LO>(condition.extent(0))), KOKKOS_LAMBDA(const LO dof) {
        if (condition(dof) >= 0) add_shared(sums(condition(dof), dof % dim), force(dof));
      });
  const auto mine = to_host(sums);
  std::vector<std::array<double, 3>> reactions(num_conditions);
  for (int k = 0; k < num_conditions; ++k) {
    const double local[3] = {mine(k, 0), mine(k, 1), mine(k, 2)};
    Teuchos::reduceAll(d.mesh->comm(), Teuchos::REDUCE_SUM, 3, local, reactions[k].data());
  }
  return reactions;
}

} // namespace rpc::fem
