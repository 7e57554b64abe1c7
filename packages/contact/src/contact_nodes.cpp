// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/contact_nodes.hpp"

#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/rounding.hpp"
#include "rpc/contact/tied_points.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/evaluate.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <sstream>

namespace rpc::contact
{
namespace
{

constexpr double largest_gap = 1e50; // [m], as that of meshes: squares must not overflow
// Of the directions of a side, by area, that lead out of the body, against those that lead into it.
constexpr double mostly = 0.5;

std::string place(const HostPoints &points, const LO i)
{
  std::ostringstream text;
  text << "(" << points(i, 0) << ", " << points(i, 1);
  if (points.extent(1) == 3) text << ", " << points(i, 2);
  text << ")";
  return text.str();
}

/// Splits each normal into the free components and those that are prescribed; collective.
void take_over_dirichlet(ContactNodes &c, const fem::DirichletDofs &dirichlet, const Comm &comm)
{
  const auto fixed = dirichlet.fixed;
  const auto group = dirichlet.tied ? dirichlet.tied->group : DeviceView<int *>();
  const auto value = device_read(*dirichlet.value);
  const ContactNodes nodes = c;
  double largest_gap = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_gap", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) {
        const double gap = nodes.gap(i) + nodes.dent(i), size = gap < 0 ? -gap : gap;
        if (size > most) most = size;
      },
      Kokkos::Max<double>(largest_gap));
  // Prescribed displacements and gaps that are meant to be equal differ by rounding: sin(pi) is not 0.
  const double rounding = Rounding::sum * (std::max(0., max_all(comm, largest_gap)) + dirichlet.value->normInf());
  constexpr double least = std::numeric_limits<double>::min();
  Kokkos::parallel_for(
      "rpc::contact::directions", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        double length = 0, free_gap = nodes.gap(i) + nodes.dent(i); // (3.4), (11.1)
        bool tied = false;
        for (int k = 0; k < nodes.dim; ++k) {
          const LO dof = nodes.dof(i, k);
          if (fixed(dof)) free_gap -= nodes.normal(i, k) * value(dof);
          nodes.direction(i, k) = fixed(dof) ? 0 : nodes.normal(i, k);
          length += nodes.direction(i, k) * nodes.direction(i, k);
          tied = tied || (group.extent(0) > 0 && group(dof) >= 0);
        }
        // A remainder of rounding size is no direction to push in.
        const bool weightless = nodes.weight(i) == 0;
        nodes.fixed(i) = weightless || length < Rounding::direction;
        for (int k = 0; k < nodes.dim && nodes.fixed(i); ++k) nodes.direction(i, k) = 0;
        const bool touches = free_gap < rounding && free_gap > -rounding && leaves_pressure_open(nodes.law(i));
        const bool open_to_choice = weightless || touches;
        nodes.free_gap(i) = nodes.fixed(i) && open_to_choice ? 0 : free_gap;
        if (nodes.fixed(i) && tied && !weightless) // settle_tied_points() tells whether it touches
          nodes.free_gap(i) = math::larger(free_gap, least);
      });
  Kokkos::fence();
}

/// Values at this rank's nodes of one side, on the host.
struct SideValues {
  HostView<double *> yield, hardening, stiffness, friction_coefficient, friction_bound, friction_limit, gap;
  HostView<double **> normal;
  std::vector<bool> misses; // whether the normal misses the obstacle
};

/// What is wrong with the normal at a node from which it does not lead to the obstacle.
std::string wrong_normal(const ContactOptions &options, const HostPoints &points, const LO i, const Point &normal,
                         const std::string &fault)
{
  std::ostringstream message;
  message << "deck: \"" << options.path << "\": from the node at " << place(points, i) << " of side \"" << options.side
          << "\" the normal (" << normal[0] << ", " << normal[1];
  if (points.extent(1) == 3) message << ", " << normal[2];
  message << ") " << fault;
  return message.str();
}

/// Normal and gap of nodes that face an obstacle; collective.
void face_obstacle(SideValues &values, const ContactOptions &options, const HostPoints &points, const Comm &comm)
{
  const int dim = static_cast<int>(points.extent(1));
  std::optional<std::string> bad, missing;
  for (LO i = 0; i < static_cast<LO>(points.extent(0)) && !bad; ++i) {
    Point x{}, direction{};
    for (int c = 0; c < dim; ++c) {
      x[c] = points(i, c);
      direction[c] = values.normal(i, c);
    }
    if (options.normal == Normal::foundation) {
      const auto into = direction_into(options.obstacle, x);
      if (!into) {
        const std::string where = no_direction_at(options.obstacle);
        std::string noun = where;
        noun[0] = static_cast<char>(std::tolower(noun[0]));
        bad = "deck: \"" + options.path + "->Obstacle->" + where + "\" must be away from the nodes of side \"" +
              options.side + "\", for it has no normal: there is one at " + place(points, i) + ". Move the " + noun +
              ", or give \"Normal\" as numbers.";
        continue;
      }
      direction = *into;
    }
    if (const auto gap = distance_along(options.obstacle, x, direction)) {
      values.gap(i) = *gap;
      for (int c = 0; c < dim; ++c) values.normal(i, c) = direction[c];
    } else if (lies_in(options.obstacle, x)) {
      bad = wrong_normal(options, points, i, direction,
                         "does not lead to the obstacle's surface, though the node lies in the foundation. Use "
                         "\"Normal\" = foundation, or move the obstacle.");
    } else {
      values.misses[i] = true;
      if (!missing) missing = wrong_normal(options, points, i, direction, "does not lead into the obstacle");
    }
  }
  throw_if_any(comm, ExitCode::bad_input, bad);
  const GO facing = std::count(values.misses.begin(), values.misses.end(), false);
  if (options.obstacle.moves() || sum_all(comm, facing) > 0)
    return; // what moves may come from beside the body, or leave it
  if (missing)
    *missing += ", nor from any other node of the side. Use \"Normal\" = foundation, move the obstacle, or make the "
                "mesh finer.";
  throw_if_any(comm, ExitCode::bad_input, missing);
}

/// @param diameter  of the body [m]
SideValues side_values(const ContactOptions &options, const HostPoints &points,
                       const DeviceView<double **> &surface_normal, const double diameter, const Comm &comm)
{
  const LO n = static_cast<LO>(points.extent(0));
  SideValues values;
  values.misses.assign(n, false);
  HostView<double *> *const of_law[] = {&values.yield,          &values.hardening,
                                        &values.stiffness,      &values.friction_coefficient,
                                        &values.friction_bound, &values.friction_limit};
  for (std::size_t k = 0; k < std::size(law_parameters); ++k)
    *of_law[k] =
        evaluate(options.*law_parameters[k].field, points, options.path + "->" + law_parameters[k].name, comm, true);
  values.gap = evaluate(options.gap, points, options.path + "->Gap", comm);
  values.normal = HostView<double **>("rpc::contact::side_normal", n, points.extent(1));
  const auto outward = to_host(surface_normal);
  for (LO i = 0; i < n; ++i)
    for (std::size_t c = 0; c < points.extent(1); ++c)
      values.normal(i, c) = options.normal == Normal::fixed ? options.direction[c] : outward(i, c);
  if (options.obstacle.exists()) face_obstacle(values, options, points, comm);

  std::optional<std::string> bad;
  for (LO i = 0; i < n && !bad; ++i) {
    if (std::abs(values.gap(i)) <= Rounding::gap * diameter) values.gap(i) = 0;
    if (std::abs(values.gap(i)) <= largest_gap) continue;
    std::ostringstream message;
    message << "deck: \"" << options.path << "->Gap\" must be at most " << largest_gap << " [m] in size, got "
            << values.gap(i) << " at " << place(points, i);
    bad = message.str();
  }
  for (std::size_t k = 0; k < std::size(law_parameters); ++k)
    for (LO i = 0; i < n && !bad; ++i) {
      const double value = (*of_law[k])(i);
      if (law_parameters[k].allows(value)) continue;
      const ScalarField &field = options.*law_parameters[k].field;
      std::ostringstream message;
      message << law_parameters[k].rule(options.path) << value;
      if (!field.is_constant()) message << " from \"" << field.text << "\" at " << place(points, i);
      bad = message.str();
    }
  throw_if_any(comm, ExitCode::bad_input, bad);
  return values;
}

/// Refuses directions that lead from the side into the body. They may in part: on a ball that is a side as a whole, half of the nodes look
/// away from each obstacle. Collective.
void require_outward(const ContactOptions &options, const fem::SurfaceNodes &surface, const SideValues &values,
                     const Comm &comm)
{
  const auto outward = to_host(surface.normal);
  const auto weight = to_host(surface.weight);
  std::vector<double> areas(2, 0.); // seen along the directions, by nodes from which they lead out and in
  for (std::size_t i = 0; i < weight.extent(0); ++i) {
    double along = 0;
    for (std::size_t c = 0; c < outward.extent(1); ++c) along += outward(i, c) * values.normal(i, c);
    areas[along > 0 ? 0 : 1] += weight(i) * std::abs(along);
  }
  areas = summed(comm, areas);
  RPC_REQUIRE(
      areas[0] > mostly * areas[1] || sum_all(comm, GO(weight.extent(0))) == 0,
      "deck: \"" << options.path << "->Normal\" must lead out of the body, from side \"" << options.side
                 << "\" into the foundation; it leads into the body. "
                 << (options.obstacle.exists()
                         ? "Turn it round. Where the deck does not give it, the obstacle does: its \"Normal\", or the "
                           "\"Axis\" of a cone, points from the foundation to the body, and \"Encloses Body\" "
                           "tells on which side of a sphere, cylinder or ellipsoid the body lies."
                         : "Turn it round."));
}

/// (n, dim) of the device, from a vector row by row.
DeviceView<double **> device_rows(const std::vector<double> &values, const int dim, const std::string &label)
{
  DeviceView<double **> device(label, values.size() / dim, dim);
  const auto host = Kokkos::create_mirror_view(device);
  for (std::size_t k = 0; k < values.size(); ++k) host(k / dim, k % dim) = values[k];
  Kokkos::deep_copy(device, host);
  return device;
}

/// (points) E / diameter, with the largest Young's modulus among the cells around each point; collective.
DeviceView<double *> scaling_of(const fem::Discretization &d, const fem::Materials &materials,
                                const DeviceView<LO *> &node)
{
  const auto modulus = fem::youngs_modulus_at_nodes(d, materials, node);
  const double diameter = d.diameter;
  DeviceView<double *> scaling("rpc::contact::scaling", node.extent(0));
  Kokkos::parallel_for(
      "rpc::contact::scaling", device_range(static_cast<LO>(node.extent(0))),
      KOKKOS_LAMBDA(const LO i) { scaling(i) = modulus(i) / diameter; });
  return scaling;
}

/// Counts the points; collective.
void count_points(ContactNodes &c, const Comm &comm)
{
  const ContactNodes points = c;
  GO fixed = 0, weightless = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::count_points", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, GO &without, GO &prescribed) {
        const bool carries = points.weight(i) > 0;
        without += carries ? 0 : 1;
        prescribed += carries && points.fixed(i) ? 1 : 0;
      },
      weightless, fixed);
  c.num_weightless = sum_all(comm, weightless);
  c.num_fixed = sum_all(comm, fixed);
  c.num_total = sum_all(comm, GO(c.size())) - c.num_weightless;
}

/// Values of this rank's contact nodes on the host, in the order of the nodes.
struct PointValues {
  std::vector<LO> node;
  std::vector<double> weight, normal, gap, dent, yield, hardening, compliance, penalty;
  std::vector<double> friction_coefficient, friction_bound, friction_limit;
};

/// What slip counts from, and where there is none.
void start_friction(ContactNodes &c, const fem::DirichletDofs &dirichlet, const SlipStart *const before)
{
  const Vector at_rest(dirichlet.value->getMap());
  const auto u = device_read(before ? before->displacement : at_rest);
  const auto fixed = dirichlet.fixed;
  c.friction.from = DeviceView<double **>("rpc::contact::slip_from", c.size(), c.dim);
  c.friction.free = DeviceView<char **>("rpc::contact::free_along", c.size(), c.dim);
  const ContactNodes points = c;
  Kokkos::parallel_for(
      "rpc::contact::start_friction", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        double room = 0; // for slip
        for (int k = 0; k < points.dim; ++k) {
          const bool free = !fixed(points.dof(i, k));
          points.friction.free(i, k) = free;
          if (free) room += 1 - points.normal(i, k) * points.normal(i, k);
        }
        const Along along = slip(points, i, u);
        for (int k = 0; k < points.dim; ++k) points.friction.from(i, k) = along(k);
        if (room > Rounding::sum && !points.fixed(i)) return;
        points.friction.coefficient(i) = 0;
        points.friction.bound(i) = 0;
      });
  Kokkos::fence();
}

/// A foundation's motion along itself counts as the body's slip the other way.
void add_motion(const ContactNodes &points, const int side, const Point &motion)
{
  const ContactNodes c = points;
  const Along moved{{motion[0], motion[1], motion[2]}};
  Kokkos::parallel_for(
      "rpc::contact::add_motion", Kokkos::RangePolicy<ExecutionSpace, LO>(c.first(side), c.first(side + 1)),
      KOKKOS_LAMBDA(const LO i) {
        double normal = 0;
        for (int k = 0; k < c.dim; ++k) normal += c.normal(i, k) * moved(k);
        for (int k = 0; k < c.dim; ++k) c.friction.from(i, k) += moved(k) - normal * c.normal(i, k);
      });
  Kokkos::fence();
}

/// (points) 1 where nothing can press a point in.
DeviceView<char *> rigid_points(const ContactNodes &points)
{
  const ContactNodes c = points;
  const DeviceView<char *> rigid("rpc::contact::rigid", c.size());
  Kokkos::parallel_for(
      "rpc::contact::rigid_points", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { rigid(i) = !gives_way(c.law(i)); });
  Kokkos::fence();
  return rigid;
}

/// Refuses nodes that a prescribed displacement presses into a foundation that cannot give way; collective.
void require_room(const ContactNodes &c, const std::vector<ContactOptions> &options, const mesh::Mesh &mesh)
{
  const HostPoints points = fem::node_positions(mesh, c.node);
  const auto fixed = to_host(c.fixed);
  const auto free_gap = to_host(c.free_gap);
  const auto rigid = to_host(rigid_points(c));
  std::optional<std::string> bad;
  for (int side = 0; side < c.num_sides(); ++side)
    for (LO i = c.first(side); i < c.first(side + 1) && !bad; ++i) {
      if (!fixed(i) || rigid(i) == 0 || !(-free_gap(i) > 0)) continue;
      std::ostringstream message;
      message << "contact: the prescribed displacement presses the node at " << place(points, i) << " by "
              << -free_gap(i) << " [m] into the foundation of side \"" << options[side].side
              << "\", which is rigid there. Lower it, or give a finite yield stress.";
      bad = message.str();
    }
  throw_if_any(mesh.comm(), ExitCode::no_solution, bad);
}

} // namespace

std::vector<const mesh::Side *> contact_sides(const mesh::Mesh &mesh, const std::vector<ContactOptions> &options)
{
  std::vector<const mesh::Side *> sides;
  for (const ContactOptions &contact : options) sides.push_back(&mesh.side(contact.side, contact.path + "->Side"));
  return sides;
}

ContactNodes contact_nodes(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                           const fem::DirichletDofs &dirichlet, const fem::Materials &materials,
                           const MultiVector *const dents, const SlipStart *const slip_start)
{
  const mesh::Mesh &mesh = *d.mesh;
  const Comm &comm = mesh.comm();
  ContactNodes c;
  c.dim = d.dim();
  c.first = HostView<LO *>("rpc::contact::first", options.size() + 1);
  PointValues points;
  const std::vector<const mesh::Side *> sides = contact_sides(mesh, options);
  const bool with_friction = has_friction(options);
  decltype(dents->getLocalViewHost(Tpetra::Access::ReadOnly)) host_dents;
  if (dents) host_dents = dents->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < options.size(); ++k) {
    const auto surface = fem::surface_nodes(d, *sides[k]);
    const SideValues values =
        side_values(options[k], fem::node_positions(mesh, surface.node), surface.normal, d.diameter, comm);
    require_outward(options[k], surface, values, comm);
    const auto side_node = to_host(surface.node);
    const auto side_weight = to_host(surface.weight);
    for (std::size_t i = 0; i < side_node.extent(0); ++i) {
      if (values.misses[i]) {
        ++c.num_missing;
        continue;
      }
      const double dent = dents ? host_dents(side_node(i), k) : 0;
      points.node.push_back(side_node(i));
      points.weight.push_back(side_weight(i));
      points.gap.push_back(values.gap(i));
      points.dent.push_back(dent);
      points.yield.push_back(values.yield(i) + values.hardening(i) * dent); // (11.1)
      points.hardening.push_back(values.hardening(i));
      points.compliance.push_back(1 / values.stiffness(i));
      points.penalty.push_back(options[k].penalty);
      if (with_friction) {
        points.friction_coefficient.push_back(values.friction_coefficient(i));
        points.friction_bound.push_back(values.friction_bound(i));
        points.friction_limit.push_back(values.friction_limit(i));
      }
      for (int component = 0; component < c.dim; ++component) points.normal.push_back(values.normal(i, component));
    }
    c.first(k + 1) = static_cast<LO>(points.node.size());
  }
  c.node = device_values(points.node, "rpc::contact::node");
  c.weight = device_values(points.weight, "rpc::contact::weight");
  c.gap = device_values(points.gap, "rpc::contact::gap");
  c.dent = device_values(points.dent, "rpc::contact::dent");
  c.law.yield = device_values(points.yield, "rpc::contact::yield");
  c.law.hardening = device_values(points.hardening, "rpc::contact::hardening");
  c.law.compliance = device_values(points.compliance, "rpc::contact::compliance");
  c.given_penalty = device_values(points.penalty, "rpc::contact::penalty");
  if (!options.empty()) c.scaling = scaling_of(d, materials, c.node);
  c.normal = device_rows(points.normal, c.dim, "rpc::contact::normal");
  c.direction = DeviceView<double **>("rpc::contact::direction", points.node.size(), c.dim);
  c.free_gap = DeviceView<double *>("rpc::contact::free_gap", points.node.size());
  c.fixed = DeviceView<char *>("rpc::contact::fixed", points.node.size());
  c.num_missing = sum_all(comm, c.num_missing);
  take_over_dirichlet(c, dirichlet, comm);
  const auto above_0 = [](const std::vector<double> &values) {
    return std::any_of(values.begin(), values.end(), [](const double value) { return value > 0; });
  };
  const bool acts = above_0(points.friction_coefficient) || above_0(points.friction_bound);
  if (max_all(comm, static_cast<int>(acts)) > 0) {
    c.friction.anywhere = true;
    c.friction.coefficient = device_values(points.friction_coefficient, "rpc::contact::friction_coefficient");
    c.friction.bound = device_values(points.friction_bound, "rpc::contact::friction_bound");
    c.friction.limit = device_values(points.friction_limit, "rpc::contact::friction_limit");
    start_friction(c, dirichlet, slip_start);
    require_no_friction_on_tied(d, c, dirichlet, options);
    for (int side = 0; slip_start && side < c.num_sides(); ++side) add_motion(c, side, slip_start->motion[side]);
  }
  count_points(c, comm);
  require_room(c, options, mesh);
  return c;
}

DeviceView<double *> penetrations(const ContactNodes &points, const Vector &u)
{
  const ContactNodes c = points;
  const DeviceView<double *> v("rpc::contact::penetrations", c.size());
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::penetrations", device_range(c.size()), KOKKOS_LAMBDA(const LO i) { v(i) = penetration(c, i, x); });
  Kokkos::fence();
  return v;
}

DeviceView<int *> points_of_nodes(const ContactNodes &points, const LO num_nodes)
{
  const ContactNodes c = points;
  if (!c.friction.exists() || c.num_groups() < 2) return {};
  const DeviceView<int *> count("rpc::contact::points_of_nodes", num_nodes);
  for_each_point_by_group(
      "rpc::contact::points_of_nodes", c, KOKKOS_LAMBDA(const LO i) { ++count(c.node(i)); });
  Kokkos::fence();
  return count;
}

} // namespace rpc::contact
