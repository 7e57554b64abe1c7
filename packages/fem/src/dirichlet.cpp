// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/dirichlet.hpp"

#include "component_name.hpp"
#include "of_time_alone.hpp"
#include "prescribed_couplings.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/evaluate.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/sparse_rows.hpp"
#include "rpc/core/sums.hpp"
#include "rpc/fem/surface.hpp"
#include "tied.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unordered_map>

namespace rpc::fem
{
namespace
{

/// What is prescribed of an unknown, and by which condition.
struct Prescribed {
  double value = 0; // [m]
  int condition = -1;
  bool moved = false; // by a force
};

/// Holds the nodes on the axis of an axisymmetric body, by no condition of the deck.                             (2.4a)
/// @param rounding  of the conditions' values of x [m]
/// @return the message about a condition that moves them; none if there is no such condition
std::optional<std::string> hold_axis(const Discretization &d, const std::vector<DirichletCondition> &conditions,
                                     const std::vector<double> &rounding,
                                     std::unordered_map<LO, Prescribed> &prescribed)
{
  const auto nodes = nodes_on_axis(d);
  const auto node = to_host(nodes);
  const HostPoints points = node_positions(*d.mesh, nodes);
  std::optional<std::string> conflict;
  for (std::size_t n = 0; n < node.extent(0); ++n) {
    Prescribed &dof = prescribed[rpc::dof(d.dim(), node(n), 0)];
    if (dof.condition >= 0 && std::abs(dof.value) > rounding[dof.condition] && !conflict) {
      std::ostringstream message;
      message << "deck: \"" << conditions[dof.condition].path() << "->X\" must be 0 on the axis x = 0 of an "
              << "axisymmetric body, got " << dof.value << " [m] at (" << points(n, 0) << ", " << points(n, 1)
              << "). Multiply it with x, or leave it out.";
      conflict = message.str();
    }
    dof.value = 0;
  }
  return conflict;
}

const RigidSide &side_of(const std::vector<RigidSide> &rigid, const std::size_t condition)
{
  return *std::find_if(rigid.begin(), rigid.end(),
                       [&](const RigidSide &side) { return side.condition == static_cast<int>(condition); });
}

/// (nodes) How far prescribed motions move the nodes of a rigid side along a component.
HostView<double *> given_motion(const RigidSide &side, const DirichletCondition &condition, const int c)
{
  const auto arm = to_host(side.arm);
  HostView<double *> value("rpc::fem::given_motion", side.node.extent(0));
  for (const int k : side.motions) {
    if (!condition.rigid->displacement[k]) continue;
    const double q = finite_value(*condition.rigid->displacement[k], condition.path() + "->" + name_of_motion(k));
    for (std::size_t i = 0; i < value.extent(0); ++i) value(i) += q * along_motion(k, &arm(3 * i), c);
  }
  return value;
}

/// The prescribed unknowns that this rank owns; a node's last condition wins. Collective.
std::unordered_map<LO, Prescribed> prescribed_dofs(const Discretization &d,
                                                   const std::vector<DirichletCondition> &conditions,
                                                   const std::vector<RigidSide> &rigid)
{
  const mesh::Mesh &mesh = *d.mesh;
  const int dim = mesh.dim();
  std::unordered_map<LO, Prescribed> prescribed;
  std::vector<std::array<double, 3>> scale(conditions.size()); // largest value: sin(pi) is 0 up to the round-off of sin
  std::optional<std::string> conflict;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const DirichletCondition &condition = conditions[k];
    const std::string path = condition.path();
    const auto nodes = mesh.nodes_of(condition.side, path + "->Side");
    const HostPoints points = node_positions(mesh, device_values(nodes, "rpc::fem::side_nodes"));
    for (int c = 0; c < dim; ++c) {
      if (!condition.holds(c)) continue;
      const bool moved = condition.moves(c);
      const auto values = condition.rigid ? given_motion(side_of(rigid, k), condition, c)
                                          : evaluate(moved ? ScalarField(0.) : *condition.displacement[c], points,
                                                     path + "->" + component_name[c], mesh.comm());
      double largest = 0;
      for (std::size_t n = 0; n < nodes.size(); ++n) largest = std::max(largest, std::abs(values(n)));
      scale[k][c] = max_all(mesh.comm(), largest);
      RPC_REQUIRE(!condition.floats[c] || scale[k][c] == 0,
                  "deck: \"" << path << "->" << component_name[c]
                             << "\" must be 0 where a force or a spring moves the obstacle along " << component_name[c]
                             << ", got " << scale[k][c] << " [m] in size. Hold the side, and let the obstacle move.");
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        Prescribed &dof = prescribed[rpc::dof(dim, nodes[n], c)];
        const int other = dof.condition;
        const bool differs =
            other >= 0 && std::abs(dof.value - values(n)) > 1e-12 * std::max(scale[other][c], scale[k][c]);
        if (other >= 0 && (moved || dof.moved) && !conflict) {
          std::ostringstream message;
          const bool turns = conditions[other].rigid || condition.rigid;
          message << "deck: \"" << conditions[other].path() << "\" and \"" << path << "\" both hold "
                  << component_name[c] << " of one node (" << points(n, 0) << ", " << points(n, 1)
                  << (dim == 3 ? ", " + std::to_string(points(n, 2)) : "") << "), and "
                  << (turns ? "the rigid side" : std::string("\"Force ") + component_name[c] + "\"")
                  << " is to move it. Leave " << component_name[c] << " out of one of them"
                  << (turns ? ", or give all motions of the rigid side that move it along " +
                                  std::string(component_name[c])
                            : "")
                  << ".";
          conflict = message.str();
        } else if (differs && !conflict) {
          std::ostringstream message;
          message << "deck: \"" << conditions[other].path() << "\" and \"" << path << "\" prescribe different "
                  << component_name[c] << " at one node (" << points(n, 0) << ", " << points(n, 1)
                  << (dim == 3 ? ", " + std::to_string(points(n, 2)) : "") << "): " << dof.value << " and " << values(n)
                  << " [m]";
          conflict = message.str();
        }
        dof = {values(n), static_cast<int>(k), moved};
      }
    }
  }
  if (d.axisymmetric()) {
    std::vector<double> rounding;
    for (const auto &largest : scale) rounding.push_back(1e-12 * largest[0]);
    const auto moves = hold_axis(d, conditions, rounding, prescribed);
    if (!conflict) conflict = moves;
  }
  throw_if_any(mesh.comm(), ExitCode::bad_input, conflict);
  return prescribed;
}

/// load <- load - K u_D at free and tied unknowns, diag(K) u_D at prescribed ones.
/// @param value  (overlap dofs) u_D
/// @return this rank's part of u_D K u_D/2 + u_D diag(K) u_D/2, of which diag(K) is in the eliminated problem
/// @param group  (owned dofs) of tied unknowns, or -1; empty: there are none
double add_prescribed_forces(const PrescribedCouplings &K, const DeviceView<char *> &fixed,
                             const DeviceView<int *> &group, const Vector &value, Vector &load)
{
  const auto u = device_read(value);
  const auto b = device_write(load);
  double energy = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::prescribed_forces", device_range(static_cast<LO>(K.row.extent(0))),
      KOKKOS_LAMBDA(const LO i, double &sum) {
        const LO row = K.row(i);
        double force = 0, own = 0;
        for (std::size_t k = K.begin(i); k < K.begin(i + 1); ++k) {
          const double part = K.value(k) * u(K.column(k));
          force += part;
          if (K.column(k) == row) own = part;
        }
        const bool is_tied = group.extent(0) > 0 && group(row) >= 0;
        b(row) = fixed(row) && !is_tied ? own : b(row) - force;
        if (fixed(row)) sum += 0.5 * u(row) * (is_tied ? force : force + own);
      },
      energy);
  return energy;
}

void clear_fixed(const DeviceView<char *> &fixed, Vector &f)
{
  const auto to = device_write(f);
  Kokkos::parallel_for(
      "rpc::fem::clear_prescribed", device_range(static_cast<LO>(f.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
        if (fixed(dof)) to(dof) = 0;
      });
  Kokkos::fence();
}

} // namespace

Teuchos::ParameterList valid_dirichlet_parameters()
{
  Teuchos::ParameterList entry, valid("Dirichlet");
  entry.set(
      "Side", "",
      "Side of the mesh; by default the side that the entry is named after. A single point holds a body that would "
      "float otherwise: a corner of a box, `left bottom` or in space `left bottom back`, or a physical point of "
      "gmsh.");
  for (const char *name : component_name)
    set_field(entry, name, "",
              std::string("Displacement in ") + name +
                  " [m], a number or an expression; absent: this component is free.");
  for (const char *name : component_name)
    set_field(entry, std::string("Force ") + name, "",
              std::string("Force in ") + name +
                  " on the whole side [N], in the plane per m, axisymmetric on the whole circumference: the side moves "
                  "along " +
                  name +
                  " as one rigid piece, as far as the force moves it. A number or an expression of t. Instead of " +
                  name + ".");
  Teuchos::ParameterList parent;
  set_named_entries(parent, "Dirichlet", entry,
                    "Prescribed displacements, any number of entries with names of your choice.");
  return parent.sublist("Dirichlet");
}

std::vector<DirichletCondition> dirichlet_options(const Teuchos::ParameterList &list, const int dim,
                                                  const FieldParser &parse)
{
  std::vector<DirichletCondition> conditions;
  const auto exists = [&](const std::string &parameter, const int c) {
    RPC_REQUIRE(c < dim, "deck: \"" << parameter << "\" prescribes a component that a " << dim
                                    << "D mesh does not have. It has X and Y; of a body of revolution Y runs along the "
                                       "axis.");
  };
  for (auto it = list.begin(); it != list.end(); ++it) {
    DirichletCondition condition;
    condition.name = list.name(it);
    const Teuchos::ParameterList &entry = list.sublist(condition.name);
    const std::string path = "Dirichlet->" + condition.name;
    condition.side = entry.get<std::string>("Side").empty() ? condition.name : entry.get<std::string>("Side");
    bool any = false;
    for (int c = 0; c < 3; ++c) {
      const std::string parameter = path + "->" + component_name[c], by_force = path + "->Force " + component_name[c];
      const std::string text = field_text(entry, component_name[c]);
      const std::string force = field_text(entry, std::string("Force ") + component_name[c]);
      if (!text.empty()) {
        exists(parameter, c);
        condition.displacement[c] = parse(text, parameter);
      }
      if (!force.empty()) {
        exists(by_force, c);
        RPC_REQUIRE(text.empty(), "deck: \"" << path << "\" must have " << component_name[c] << " or Force "
                                             << component_name[c] << ", got both. Leave one of them out.");
        condition.force[c] = parse(force, by_force);
        require_of_time_alone(*condition.force[c], by_force, "Give a number or an expression of t.");
      }
      any = any || condition.holds(c);
    }
    RPC_REQUIRE(any,
                "deck: \"" << path << "\" prescribes nothing. Give X, Y or Z [m], or Force X, Force Y or Force Z [N].");
    conditions.push_back(condition);
  }
  return conditions;
}

DirichletDofs dirichlet_dofs(const Discretization &d, const std::vector<DirichletCondition> &conditions)
{
  require_movable(d, conditions);
  DirichletDofs dirichlet;
  dirichlet.rigid = rigid_sides(d, conditions);
  const auto prescribed = prescribed_dofs(d, conditions, dirichlet.rigid);
  std::vector<LO> dofs;
  std::vector<double> values;
  std::vector<int> owners;
  for (const auto &[dof, what] : prescribed) {
    dofs.push_back(dof);
    values.push_back(what.value);
    owners.push_back(what.condition);
  }
  dirichlet.num_fixed = sum_all(d.mesh->comm(), GO(dofs.size()));
  dirichlet.value = rcp(new Vector(d.owned_dofs));
  dirichlet.condition = DeviceView<int *>(
      Kokkos::view_alloc("rpc::fem::dirichlet_condition", Kokkos::WithoutInitializing), num_local(*d.owned_dofs));
  dirichlet.fixed = DeviceView<char *>("rpc::fem::dirichlet_fixed", d.num_overlap_dofs());
  Kokkos::deep_copy(dirichlet.condition, -1);
  Vector mark(d.owned_dofs);
  const auto dof = device_values(dofs, "rpc::fem::prescribed_dofs");
  const auto value = device_values(values, "rpc::fem::prescribed_values");
  const auto owner = device_values(owners, "rpc::fem::prescribed_by");
  {
    const auto condition = dirichlet.condition;
    const auto value_to = device_write(*dirichlet.value);
    const auto mark_to = device_write(mark);
    Kokkos::parallel_for(
        "rpc::fem::prescribe", device_range(static_cast<LO>(dofs.size())), KOKKOS_LAMBDA(const LO i) {
          value_to(dof(i)) = value(i);
          condition(dof(i)) = owner(i);
          mark_to(dof(i)) = 1;
        });
    Kokkos::fence();
  }
  // A neighbour's node may lie on a side whose facets are not here.
  const auto mark_overlap = on_overlap(d, mark);
  const auto flag = dirichlet.fixed;
  const auto from = device_read(*mark_overlap);
  Kokkos::parallel_for(
      "rpc::fem::dirichlet_flags", device_range(d.num_overlap_dofs()),
      KOKKOS_LAMBDA(const LO i) { flag(i) = from(i) != 0; });
  Kokkos::fence();
  dirichlet.tied = tied_unknowns(d, conditions, dirichlet.condition, dirichlet.rigid);
  dirichlet.first_floating = static_cast<int>(moved_by_force(conditions).size());
  for (const int c : floating_components(conditions)) {
    double stiffness = 0;
    for (const auto &condition : conditions) stiffness = std::max(stiffness, condition.float_stiffness[c]);
    dirichlet.float_stiffness.push_back(stiffness);
  }
  if (dirichlet.tied && !dirichlet.rigid.empty()) part_from_modes(*dirichlet.tied, dirichlet.rigid, *dirichlet.value);
  return dirichlet;
}

void clear_prescribed(const DirichletDofs &dirichlet, Vector &f)
{
  const auto kept = dirichlet.tied ? means(*dirichlet.tied, f) : std::vector<double>();
  clear_fixed(dirichlet.fixed, f);
  if (dirichlet.tied) set_members(*dirichlet.tied, kept, f);
}

DeviceView<LO *> nodes_beside_prescribed(const Discretization &d, const DeviceView<char *> &fixed)
{
  const LO num_nodes = d.mesh->num_owned_nodes();
  const DeviceView<LO *> beside("rpc::fem::beside_prescribed", num_nodes);
  const auto nodes = d.nodes();
  const int dim = d.dim();
  Kokkos::parallel_for(
      "rpc::fem::find_prescribed_neighbours", device_range(num_nodes), KOKKOS_LAMBDA(const LO node) {
        for (auto k = nodes.row(node); k < nodes.row(node + 1); ++k)
          for (int c = 0; c < dim; ++c) beside(node) |= fixed(dof(dim, nodes.col(k), c));
      });
  return sparse_rows(beside, "rpc::fem::beside_prescribed").row;
}

PrescribedCouplings listed_couplings(const RowsOfNodes &list, const int dim, const DeviceView<char *> &fixed)
{
  const auto A = list.rows;
  const auto node = list.node, place = list.place;
  const DeviceView<LO *> count("rpc::fem::prescribed_columns", num_dofs(dim, list.size()));
  Kokkos::parallel_for(
      "rpc::fem::count_prescribed_columns", device_range(num_dofs(dim, list.size())), KOKKOS_LAMBDA(const LO i) {
        const LO row = dof(dim, place(node_of(dim, i)), component_of(dim, i));
        for (auto k = A.graph.row_map(row); k < A.graph.row_map(row + 1); ++k)
          count(i) += fixed(A.graph.entries(k)) != 0;
      });
  const SparseRows rows = sparse_rows(count, "rpc::fem::coupled");
  const auto listed = rows.row;
  const auto begin = rows.begin;
  const DeviceView<LO *> row("rpc::fem::coupled_row", listed.extent(0)),
      column("rpc::fem::coupling_column", rows.num_entries);
  const DeviceView<double *> value("rpc::fem::coupling", rows.num_entries);
  Kokkos::parallel_for(
      "rpc::fem::list_couplings", device_range(static_cast<LO>(listed.extent(0))), KOKKOS_LAMBDA(const LO i) {
        const LO of_list = node_of(dim, listed(i)), from = dof(dim, place(of_list), component_of(dim, listed(i)));
        row(i) = dof(dim, node(of_list), component_of(dim, listed(i)));
        std::size_t next = begin(i);
        for (auto k = A.graph.row_map(from); k < A.graph.row_map(from + 1); ++k)
          if (fixed(A.graph.entries(k))) {
            column(next) = A.graph.entries(k);
            value(next++) = A.values(k);
          }
      });
  Kokkos::fence();
  return {row, begin, column, value};
}

void clear_couplings(const RowsOfNodes &list, const int dim, const DeviceView<char *> &fixed)
{
  const auto A = list.rows;
  const auto node = list.node, place = list.place;
  Kokkos::parallel_for(
      "rpc::fem::clear_couplings", device_range(num_dofs(dim, list.size())), KOKKOS_LAMBDA(const LO i) {
        const LO own = dof(dim, node(node_of(dim, i)), component_of(dim, i)),
                 row = dof(dim, place(node_of(dim, i)), component_of(dim, i));
        for (auto k = A.graph.row_map(row); k < A.graph.row_map(row + 1); ++k) {
          const LO col = A.graph.entries(k); // a row's own column has its lid in both maps
          if (col != own && (fixed(own) || fixed(col))) A.values(k) = 0;
        }
      });
  Kokkos::fence();
}

EliminatedStiffness eliminate_dirichlet(const Discretization &d, RCP<CrsMatrix> K, const DeviceView<char *> &prescribed)
{
  const auto nodes = nodes_beside_prescribed(d, prescribed); // few: the others' entries need not be read
  const RowsOfNodes rows{nodes, nodes, K->getLocalMatrixDevice()};
  EliminatedStiffness eliminated{std::move(K), listed_couplings(rows, d.dim(), prescribed)};
  clear_couplings(rows, d.dim(), prescribed); // paper (2), (2.9)
  return eliminated;
}

ElasticProblem elastic_problem(const Discretization &d, const PrescribedCouplings &couplings, RCP<Vector> applied_load,
                               DirichletDofs dirichlet)
{
  ElasticProblem problem;
  const Vector &prescribed = *dirichlet.value;
  problem.load = rcp(new Vector(*applied_load, Teuchos::Copy));
  if (prescribed.normInf() > 0) {
    const double own_energy =
        add_prescribed_forces(couplings, dirichlet.fixed, dirichlet.tied ? dirichlet.tied->group : DeviceView<int *>(),
                              *on_overlap(d, prescribed), *problem.load);
    if (dirichlet.tied) set_members(*dirichlet.tied, means(*dirichlet.tied, *problem.load), *problem.load);
    problem.energy_offset = sum_all(d.mesh->comm(), own_energy) - applied_load->dot(prescribed);
  } else {
    clear_prescribed(dirichlet, *problem.load);
  }
  if (dirichlet.tied) problem.energy_offset += add_spring_starts(dirichlet, *problem.load);
  problem.applied_load = std::move(applied_load);
  problem.dirichlet = std::move(dirichlet);
  return problem;
}

std::vector<std::array<double, 3>> reaction_forces(const Discretization &d, const DirichletDofs &dirichlet,
                                                   const int num_conditions, const Vector &out_of_balance)
{
  const int dim = d.dim();
  const auto condition = dirichlet.condition;
  const auto force = device_read(out_of_balance);
  std::vector<std::array<double, 3>> reactions(num_conditions);
  for (int k = 0; k < num_conditions; ++k) {
    const auto local = sums_over(
        "rpc::fem::reactions", device_range(static_cast<LO>(condition.extent(0))), 3,
        KOKKOS_LAMBDA(const LO dof, double sum[]) {
          if (condition(dof) == k) sum[component_of(dim, dof)] += force(dof);
        });
    Teuchos::reduceAll(d.mesh->comm(), Teuchos::REDUCE_SUM, 3, local.data(), reactions[k].data());
    if (d.axisymmetric()) reactions[k][0] = 0; // around the axis radial forces cancel
  }
  return reactions;
}

GO num_not_held(const DirichletDofs &dirichlet, const DeviceView<LO *> &nodes, const int dim, const int component)
{
  const auto fixed = dirichlet.fixed;
  const auto group = dirichlet.tied ? dirichlet.tied->group : DeviceView<int *>();
  const LO num_grouped = static_cast<LO>(group.extent(0));
  GO number = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::num_not_held", device_range(static_cast<LO>(nodes.extent(0))),
      KOKKOS_LAMBDA(const LO n, GO &sum) {
        const LO i = dof(dim, nodes(n), component);
        if (fixed(i) == 0 || (i < num_grouped && group(i) >= 0)) ++sum;
      },
      number);
  return number;
}

} // namespace rpc::fem
