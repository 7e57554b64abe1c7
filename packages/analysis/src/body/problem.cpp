// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/problem.hpp"

#include "body/obstacle_force.hpp"
#include "rpc/analysis/mesh_levels.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/analysis/stiffness.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

namespace rpc::analysis
{
namespace
{

fem::VectorField seen_at(fem::VectorField field, const double t)
{
  for (auto &component : field) component = component.seen_at(t);
  return field;
}

/// The nodal forces of a model's loads. Collective. @throws rpc::Error (bad_input) where numbers overflow
RCP<Vector> loads_of(const fem::Discretization &d, const Model &model)
{
  const auto coordinates = [&d] { return fem::node_coordinates(d); };
  const auto load = rcp(new Vector(d.owned_dofs));
  fem::add_body_force(d, model.body_force, "Body Force", *load);
  require_finite(*load, "the forces of \"Body Force\"", coordinates);
  for (const auto &traction : model.tractions) {
    const std::string path = "Traction->" + traction.name;
    const mesh::Side &side = d.mesh->side(traction.side, path + "->Side");
    fem::add_traction(d, side, fem::force_per_area(d, side, traction), path, *load);
    require_finite(*load, "the forces of \"" + path + "\"", coordinates);
  }
  return load;
}

/// The names in the deck of loads that depend on time or place, and may so be zero at some time only.
std::vector<std::string> varying_loads(const Model &model)
{
  std::vector<std::string> names;
  const auto add = [&](const fem::VectorField &load, const std::string &name) {
    if (std::any_of(load.begin(), load.end(), [](const ScalarField &f) { return !f.is_constant(); }))
      names.push_back('"' + name + '"');
  };
  add(model.body_force, "Body Force");
  for (const auto &load : model.tractions) {
    add(load.traction, "Traction->" + load.name);
    add(load.force, "Traction->" + load.name);
  }
  for (const auto &condition : model.dirichlet) {
    std::vector<std::optional<ScalarField>> forces(condition.force.begin(), condition.force.end());
    if (condition.rigid) forces.assign(condition.rigid->force.begin(), condition.rigid->force.end());
    for (const auto &force : forces)
      if (force && !force->is_constant()) names.push_back('"' + condition.path() + '"');
  }
  for (const auto &side : model.contact)
    for (const auto &force : side.obstacle.force)
      if (force && !force->is_constant()) names.push_back('"' + side.path + "->Obstacle\"");
  return names;
}

/// What becomes of a body that its load at a time does not hold. Where all loads are zero then, the message says so. Collective.
contact::Support support_of(const fem::Discretization &d, const contact::FreeParts &free_parts, const Step &step,
                            const Model &now)
{
  try {
    return contact::check_support(d, free_parts, *step.elastic.applied_load, step.contact, now.contact, now.units);
  } catch (const Error &error) { // on all ranks
    const auto loads = varying_loads(now);
    const contact::ContactOptions *const pressed = pressed_by_force(now);
    const bool is_zero = step.elastic.applied_load->normInf() == 0;
    if (error.code() == ExitCode::no_solution && pressed && !is_zero)
      throw Error(error.code(), std::string(error.what()) + " The load is the force on the obstacle of \"" +
                                    pressed->path + "\", the other way round.");
    if (error.code() != ExitCode::no_solution || loads.empty() || !is_zero) throw;
    std::ostringstream text;
    text << error.what() << " At t = " << step.time << " the load is zero:";
    for (const std::string &name : loads) text << ' ' << name;
    text << ". Leave that time out of \"Steps->Times\", or without steps choose another \"Time\".";
    throw Error(error.code(), text.str());
  }
}

/// Collective. @throws rpc::Error (bad_input) where numbers overflow
fem::DirichletDofs prescribed_of(const fem::Discretization &d, const Model &model)
{
  auto dirichlet = fem::dirichlet_dofs(d, model.dirichlet);
  require_finite(*dirichlet.value, "the displacements that \"Dirichlet\" prescribes",
                 [&d] { return fem::node_coordinates(d); });
  return dirichlet;
}

/// (n) Owned nodes of some sides, ascending.
DeviceView<LO *> nodes_of(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides)
{
  std::vector<DeviceView<LO *>> lists;
  for (const mesh::Side *const side : sides) lists.push_back(fem::surface_nodes(d, *side).node);
  return distinct_nodes(lists);
}

} // namespace

std::vector<Point> foundations_moved(const Model &model, const double from, const double to, const Point &before,
                                     const Point &now)
{
  const auto a = model.seen_at(from, before).contact, b = model.seen_at(to, now).contact;
  std::vector<Point> motion(b.size(), Point{});
  for (std::size_t k = 0; k < b.size(); ++k)
    if (b[k].obstacle.exists()) motion[k] = difference(b[k].obstacle.point, a[k].obstacle.point);
  return motion;
}

Point obstacle_displacement(const Model &model, const double t, const Point &obstacle)
{
  const auto *const pressed = pressed_by_force(model);
  return pressed ? foundations_moved(model, 0, t, {}, obstacle)[pressed - model.contact.data()] : Point{};
}

std::optional<Point> spring_force_on_obstacle(const Model &model, const Point &obstacle)
{
  const auto *const pressed = pressed_by_force(model);
  if (pressed == nullptr || !pressed->obstacle.has_springs()) return std::nullopt;
  Point force{};
  for (int c = 0; c < 3; ++c)
    if (pressed->obstacle.stiffness[c] > 0) force[c] = -pressed->obstacle.stiffness[c] * obstacle[c];
  return force;
}

double time_at_rest(const double first)
{
  return std::min(0., first);
}

Model Model::seen_at(const double t, const Point &obstacle) const
{
  Model model = *this;
  for (auto &condition : model.dirichlet)
    for (int c = 0; c < 3; ++c) {
      if (condition.displacement[c]) condition.displacement[c] = condition.displacement[c]->seen_at(t);
      if (condition.force[c]) condition.force[c] = condition.force[c]->seen_at(t);
    }
  for (auto &condition : model.dirichlet)
    if (condition.rigid) condition.rigid = condition.rigid->seen_at(t);
  for (auto &load : model.tractions) {
    load.traction = analysis::seen_at(load.traction, t);
    load.force = analysis::seen_at(load.force, t);
  }
  model.body_force = analysis::seen_at(model.body_force, t);
  for (auto &side : model.contact) {
    side.yield_stress = side.yield_stress.seen_at(t);
    side.hardening = side.hardening.seen_at(t);
    side.stiffness = side.stiffness.seen_at(t);
    side.friction_coefficient = side.friction_coefficient.seen_at(t);
    side.friction_bound = side.friction_bound.seen_at(t);
    side.friction_limit = side.friction_limit.seen_at(t);
    side.gap = side.gap.seen_at(t);
    side.obstacle = side.obstacle.seen_at(t);
    for (int c = 0; c < 3 && side.obstacle.is_moved(); ++c) side.obstacle.point[c] += obstacle[c];
  }
  return model;
}

Problem::Problem(std::shared_ptr<const mesh::Mesh> mesh, const Model &model, const double t)
    : Problem(std::make_shared<NestedMesh>(fem::discretize(std::move(mesh), model.kinematics)), model, t)
{
}

Problem::Problem(std::shared_ptr<const NestedMesh> mesh, const Model &model, const double t)
    : model_(seen_from_obstacle(model.seen_at(t))), mesh_(std::move(mesh))
{
  const fem::Discretization &d = discretization();
  const auto dirichlet = prescribed_of(d, model_);
  prescribed_ = dirichlet.fixed;
  free_parts_ = contact::free_parts(d, dirichlet);
  const Stiffness K = stiffness_of(*mesh_, model_.materials, prescribed_);
  stiffness_ = K.rows;
  couplings_ = K.couplings;
  stiffness_of_tied_ = fem::tied_stiffness(d, couplings_, dirichlet, stiffness_);
  candidates_ = nodes_of(d, contact_sides());
}

solver::MakeMeshLevels Problem::mesh_levels() const
{
  return mesh_->may_have_coarser() ? make_mesh_levels(mesh_, model_, prescribed_) : solver::MakeMeshLevels();
}

solver::MakeMixedForm Problem::mixed_form() const
{
  return analysis::mixed_form(mesh_, model_, prescribed_);
}

Step Problem::step(const double t, const MultiVector *const dents, const Memory *const before,
                   const Point *const obstacle) const
{
  const fem::Discretization &d = discretization();
  const bool by_force = pressed_by_force(model_) != nullptr;
  const bool slips_first = !before && has_friction(model_.contact);
  Point moved = before ? before->obstacle : Point{};
  if (by_force && !before && (!obstacle || slips_first)) moved = approach(d, model_.seen_at(t));
  const Point slips_from = moved; // a tool's way to its first touch is no slip
  if (obstacle) moved = *obstacle;
  const Model now = model_.seen_at(t, moved);
  auto dirichlet = prescribed_of(d, now);
  const Vector at_rest(d.owned_dofs);
  std::optional<contact::SlipStart> slip_start;
  if (has_friction(now.contact))
    slip_start.emplace(
        contact::SlipStart{before ? *before->displacement : at_rest,
                           foundations_moved(model_, before ? before->time : time_at_rest(t), t, slips_from, moved)});
  Step step{
      t,
      {},
      contact::contact_nodes(d, now.contact, dirichlet, now.materials, dents, slip_start ? &*slip_start : nullptr),
      {}};
  const auto load = loads_of(d, now);
  if (by_force) {
    const auto force = force_on_floating(d, now, moved, *load);
    step.on_floating = fem::forces_on_floating(d, dirichlet, now.dirichlet, force);
  }
  fem::add_moving_forces(dirichlet, now.dirichlet, *load);
  if (by_force) load->update(1., *step.on_floating, 1.);
  step.elastic = fem::elastic_problem(d, couplings_, load, std::move(dirichlet));
  step.elastic.stiffness_of_tied = stiffness_of_tied_;
  require_finite(*step.elastic.load, "the forces of prescribed displacements",
                 [&d] { return fem::node_coordinates(d); });
  step.support = support_of(d, free_parts_, step, now);
  if (before) step.energies_before = before->energy_scale;
  step.obstacle = moved;
  // Where springs bear all of a force, what is left of the body's energies is rounding of theirs.
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  step.energies_before = std::max(step.energies_before, rounding * spring_energy_of_obstacle(*this, step, {}));
  return step;
}

fem::DirichletDofs Problem::dirichlet(const double t) const
{
  return prescribed_of(discretization(), model_.seen_at(t));
}

std::shared_ptr<const Problem> Problem::coarser(const double factor, const double t) const
{
  const mesh::Mesh &own = *discretization().mesh;
  if (own.parents) {
    const double wanted = own.dim() == 3 ? factor / 2 : factor; // a mesh of half as long cells costs an eighth in space
    const auto nodes = [](const NestedMesh &of) {
      return static_cast<double>(of.discretization().mesh->owned_nodes->getGlobalNumElements());
    };
    // Times as long as the cells of a mesh with so many nodes; near a boundary there are more of them.
    const auto longer = [&](const NestedMesh &than) { return std::pow(nodes(*mesh_) / nodes(than), 1. / own.dim()); };
    auto mesh = mesh_->parent();
    const auto has_parent = [&] { return mesh->discretization().mesh->parents != nullptr; };
    while (longer(*mesh) < step_rules.boundary * wanted && has_parent()) mesh = mesh->parent();
    // Of contracted meshes every second one: the prediction by the one between costs more than it saves.   doc/measurements.md
    if (own.dim() == 3 && !own.parents->nested && has_parent()) mesh = mesh->parent();
    return std::make_shared<Problem>(mesh, model_, t);
  }
  if (!own.box || own.element.order == 2) return nullptr;
  const auto &cells = own.box->cells;
  const auto direction = std::max_element(cells.begin(), cells.end()) - cells.begin();
  const int most = static_cast<int>(std::lround(cells[direction] / factor));
  auto mesh = mesh_;
  do mesh = mesh->coarser();
  while (mesh && mesh->discretization().mesh->box->cells[direction] > most);
  return mesh ? std::make_shared<Problem>(mesh, model_, t) : nullptr;
}

std::vector<const mesh::Side *> Problem::contact_sides() const
{
  return contact::contact_sides(*discretization().mesh, model_.contact);
}

} // namespace rpc::analysis
