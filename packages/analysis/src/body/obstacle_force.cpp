// SPDX-License-Identifier: BSD-3-Clause
#include "body/obstacle_force.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/contact/support.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/solver/exact_line_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace rpc::analysis
{
namespace
{

constexpr char component_letter[] = "XYZ";

/// `"Contact->Obstacle->Force Y"`, in quotation marks; of a spring alone its stiffness.
std::string force_parameter(const contact::ContactOptions &side, const int c)
{
  return '"' + side.path + "->Obstacle->" + (side.obstacle.force[c] ? "Force " : "Stiffness ") + component_letter[c] +
         '"';
}

/// The force that the deck gives along a component at the obstacle's time [N]; 0 where it gives none.
double given_force(const contact::Obstacle &obstacle, const int c)
{
  return obstacle.force[c] ? (*obstacle.force[c])({}) : 0;
}

/// How far along a force the springs that it stretches let the obstacle go where nothing touches [m]; infinite without one.
double way_to_springs(const contact::Obstacle &obstacle, const Point &force)
{
  double way = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c)
    if (force[c] != 0 && obstacle.stiffness[c] > 0) way = std::min(way, length(force) / obstacle.stiffness[c]);
  return way;
}

/// Whether searches from where a solution leads its obstacle are not expected to lead it further than a tolerance. Collective.  (3.17d)
/// @param before  see Starts::led_before
bool rests_where_led(const Problem &problem, const Point &before, const double tolerance, const StepSolution &s)
{
  if (pressed_by_force(problem.model())->obstacle.surface->is_flat) return true;
  const Point way = left_to_go(problem, s);
  Point expected{}; // each component falls on as it has fallen
  for (int c = 0; c < 3; ++c) expected[c] = before[c] != 0 ? way[c] * way[c] / before[c] : way[c];
  return length(expected) <= tolerance * s.u->normInf();
}

} // namespace

const contact::ContactOptions *pressed_by_force(const Model &model)
{
  const auto found = std::find_if(model.contact.begin(), model.contact.end(),
                                  [](const auto &side) { return side.obstacle.is_moved(); });
  return found == model.contact.end() ? nullptr : &*found;
}

Model seen_from_obstacle(Model model)
{
  const contact::ContactOptions *const pressed = pressed_by_force(model);
  if (pressed == nullptr) return model;
  for (const auto &other : model.contact)
    RPC_REQUIRE(&other == pressed,
                "deck: \"" << pressed->path << "->Obstacle\" is moved by a force, and \"" << other.path
                           << "\" is another foundation, which is not supported: only supports of \"Dirichlet\" may "
                              "hold the body against it. Hold the side \""
                           << other.side
                           << "\" in \"Dirichlet\", or press the body with a force there, "
                              "\"Dirichlet->NAME->Force Y\", and leave the obstacles at rest.");
  for (int c = 0; c < 3; ++c) {
    if (!pressed->obstacle.is_moved_along(c)) continue;
    const std::string parameter = force_parameter(*pressed, c);
    RPC_REQUIRE(model.kinematics != fem::Kinematics::axisymmetric || c == 1,
                "deck: " << parameter
                         << " moves the obstacle of a body of revolution off its axis. Give Force Y, along the axis.");
    bool held = false;
    for (auto &condition : model.dirichlet) {
      RPC_REQUIRE(!condition.rigid, "deck: " << parameter << " moves the obstacle, and \"" << condition.path()
                                             << "\" is a rigid side, which is not supported together. Press the body "
                                                "by \"Force "
                                             << component_letter[c]
                                             << "\" of the rigid side, and leave the obstacle at rest.");
      RPC_REQUIRE(!condition.force[c], "deck: " << parameter << " and \"Dirichlet->" << condition.name << "->Force "
                                                << component_letter[c]
                                                << "\" are both to move along one direction, along which nothing is "
                                                   "held then. Leave one of them out.");
      condition.floats[c] = condition.displacement[c].has_value();
      condition.float_stiffness[c] = condition.floats[c] ? pressed->obstacle.stiffness[c] : 0;
      held = held || condition.floats[c];
    }
    RPC_REQUIRE(held, "deck: " << parameter << " presses a body that nothing holds along " << component_letter[c]
                               << ". Hold a side: \"Dirichlet->NAME->" << component_letter[c] << "\" = 0.");
  }
  return model;
}

std::array<double, 3> force_on_floating(const fem::Discretization &d, const Model &now, const Point &obstacle,
                                        const Vector &load)
{
  const contact::ContactOptions &pressed = *pressed_by_force(now);
  std::vector<double> sum(3, 0.);
  const auto from = load.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < from.extent(0); ++i) sum[component_of(d.dim(), static_cast<LO>(i))] += from(i, 0);
  sum = summed(d.mesh->comm(), sum);
  std::array<double, 3> force{};
  for (int c = 0; c < 3; ++c) {
    if (!pressed.obstacle.is_moved_along(c)) continue;
    const double given = given_force(pressed.obstacle, c);
    RPC_REQUIRE(std::isfinite(given), "deck: " << force_parameter(pressed, c) << " must be finite, got " << given
                                               << " from " << pressed.obstacle.force[c]->text
                                               << " at t = " << pressed.obstacle.force[c]->time);
    force[c] = -(given - pressed.obstacle.stiffness[c] * obstacle[c] + sum[c]); // (3.17b), (3.17e)
  }
  return force;
}

Point approach(const fem::Discretization &d, const Model &now)
{
  const contact::ContactOptions &pressed = *pressed_by_force(now);
  Point along{};
  for (int c = 0; c < d.dim(); ++c) along[c] = given_force(pressed.obstacle, c);
  const double size = length(along);
  if (!(size > 0) || !std::isfinite(size)) return {}; // refused as a load that presses nothing
  const Point towards = scaled(-1 / size, along);     // of the body, seen from the obstacle
  const auto sides = contact::contact_sides(*d.mesh, now.contact);
  const HostPoints x = fem::node_positions(*d.mesh, fem::surface_nodes(d, *sides.front()).node);
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  double way = nowhere;
  for (std::size_t n = 0; n < x.extent(0); ++n) {
    Point place{};
    for (int c = 0; c < d.dim(); ++c) place[c] = x(n, c);
    if (const auto distance = contact::distance_along(pressed.obstacle, place, towards)) way = std::min(way, *distance);
  }
  way = std::min(min_all(d.mesh->comm(), way), way_to_springs(pressed.obstacle, along));
  if (way == nowhere) {
    std::ostringstream text;
    text << "contact: the force of \"" << pressed.path << "->Obstacle\" moves the obstacle along (" << along[0] / size
         << ", " << along[1] / size << (d.dim() == 3 ? ", " : "");
    if (d.dim() == 3) text << along[2] / size;
    text << "), and on that way it meets no node of side \"" << pressed.side
         << "\". Turn the force round, or move the obstacle's \"" << contact::point_name(pressed.obstacle)
         << "\" to where it faces the side.";
    throw Error(ExitCode::no_solution, text.str());
  }
  return scaled(-way, towards);
}

Point left_to_go(const Problem &problem, const StepSolution &s)
{
  Point way{};
  const auto &conditions = problem.model().dirichlet;
  const auto floating = fem::floating_components(conditions);
  if (floating.empty()) return way;
  const std::size_t before = fem::moved_by_force(conditions).size();
  const auto moved = means(*s.step.elastic.dirichlet.tied, *s.u);
  for (std::size_t j = 0; j < floating.size(); ++j) way[floating[j]] = -moved[before + j];
  return way;
}

double work_on_obstacle(const Problem &problem, const Step &step, const Point &way)
{
  const Model now = problem.model().seen_at(step.time);
  const contact::ContactOptions *const pressed = pressed_by_force(now);
  double work = 0;
  for (int c = 0; c < 3; ++c) work += given_force(pressed->obstacle, c) * (step.obstacle[c] + way[c]);
  return work;
}

double spring_energy_of_obstacle(const Problem &problem, const Step &step, const Point &way)
{
  const contact::ContactOptions *const pressed = pressed_by_force(problem.model());
  double energy = 0;
  for (int c = 0; pressed && c < 3; ++c) {
    const double moved = step.obstacle[c] + way[c];
    energy += 0.5 * pressed->obstacle.stiffness[c] * moved * moved;
  }
  return energy;
}

Point ObstaclePlaces::next(const Point &place, const Point &way)
{
  if (last_ && inner(last_->way, way) < 0) opposed_ = last_;
  last_ = Led{place, way};
  const Point between = opposed_ ? difference(opposed_->place, place) : Point{};
  return difference(place, scaled(-1, !opposed_ || 2 * length(way) < length(between) ? way : scaled(0.5, between)));
}

bool obstacle_rests(const Problem &problem, const StepSolution &s, const double tolerance)
{
  const double rounding = std::numeric_limits<double>::epsilon() * length(s.step.obstacle);
  return !(length(left_to_go(problem, s)) > tolerance * s.u->normInf() + rounding);
}

bool closes_under_force(const Problem &problem, const Step &step)
{
  const contact::ContactOptions *const pressed = pressed_by_force(problem.model());
  if (pressed == nullptr || pressed->yield_stress.at || !std::isinf(pressed->yield_stress.constant)) return false;
  bool is_free = false; // along a direction without a spring
  for (int c = 0; c < 3; ++c)
    is_free = is_free || (pressed->obstacle.is_moved_along(c) && !(pressed->obstacle.stiffness[c] > 0));
  if (!is_free) return false;
  std::size_t motions = 0;
  for (const auto &of_part : contact::free_parts(problem.discretization(), step.elastic.dirichlet).motions)
    motions += of_part.size();
  return motions == 1;
}

void settle_obstacle(const Problem &problem, const ConvexFunctional &functional, Vector &u)
{
  std::vector<RCP<const Vector>> translations; // which strain nothing
  for (const int c : fem::floating_components(problem.model().dirichlet)) {
    Point along{};
    along[c] = 1;
    translations.push_back(shifted(Vector(u.getMap()), along, problem.discretization().dim()));
  }
  if (translations.empty()) return;
  Vector F(u.getMap());
  functional.gradient(u, F);
  const auto within = functional.within(u, translations, F);
  const auto way = solver::least_within(*within, std::vector<double>(translations.size()));
  for (std::size_t k = 0; k < translations.size(); ++k) u.update(way[k], *translations[k], 1.);
}

bool leads_on(const Problem &problem, const StepSolution &s, const Starts &starts, const StepOptions &options)
{
  const double tolerance = options.uzawa.tolerance;
  return options.on_the_way > 0 && s.uzawa.residuals.holds(options.on_the_way) &&
         !obstacle_rests(problem, s, step_rules.of_rounding * tolerance) &&
         !(starts.may_rest && rests_where_led(problem, starts.led_before, tolerance, s));
}

void rest_where_led(const Problem &problem, const Point &before, const double tolerance, StepSolution &s)
{
  if (!rests_where_led(problem, before, tolerance, s)) return;
  const Point way = left_to_go(problem, s);
  const int dim = problem.discretization().dim();
  s.state = shifted(std::move(s.state), way, dim);
  s.u = s.state.displacement;
  for (int c = 0; c < 3; ++c) s.step.obstacle[c] += way[c];
  const contact::ContactNodes points = s.step.contact;
  const double by[3] = {way[0], way[1], way[2]};
  const bool rubs = points.friction.anywhere;
  Kokkos::parallel_for(
      "rpc::analysis::rest_where_led", device_range(points.size()), KOKKOS_LAMBDA(const LO i) {
        double further = 0;
        for (int c = 0; c < points.dim; ++c) further += points.normal(i, c) * by[c];
        points.gap(i) += further;
        if (!points.fixed(i)) points.free_gap(i) += further; // else it says whether the point may touch
        for (int c = 0; rubs && c < points.dim; ++c)
          points.friction.from(i, c) += by[c] - further * points.normal(i, c);
      });
  Kokkos::fence();
}

RCP<const Vector> shifted(const Vector &u, const Point &shift, const int dim)
{
  const auto moved = rcp(new Vector(u, Teuchos::Copy));
  const auto to = device_write(*moved);
  const double by[3] = {shift[0], shift[1], shift[2]};
  Kokkos::parallel_for(
      "rpc::analysis::shifted", device_range(static_cast<LO>(u.getLocalLength())),
      KOKKOS_LAMBDA(const LO i) { to(i) += by[component_of(dim, i)]; });
  Kokkos::fence();
  return moved;
}

contact::ContactState shifted(contact::ContactState state, const Point &shift, const int dim)
{
  state.displacement = shifted(*state.displacement, shift, dim);
  state.rest = Teuchos::null;
  return state;
}

} // namespace rpc::analysis
