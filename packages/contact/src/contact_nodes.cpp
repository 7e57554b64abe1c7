#include "rpc/contact/contact_nodes.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/evaluate.hpp"
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc::contact
{
namespace
{

std::string place(const HostPoints &points, const LO i)
{
  std::ostringstream text;
  text << "(" << points(i, 0) << ", " << points(i, 1);
  if (points.extent(1) == 3) text << ", " << points(i, 2);
  text << ")";
  return text.str();
}

HostPoints positions(const mesh::Mesh &mesh, const DeviceView<LO *> &node)
{
  DeviceView<double **> points("rpc::contact::points", node.extent(0), mesh.dim());
  const auto coords = mesh.coords;
  Kokkos::parallel_for(
      "rpc::contact::points", device_range(static_cast<LO>(node.extent(0))), KOKKOS_LAMBDA(const LO i) {
        for (std::size_t c = 0; c < coords.extent(1); ++c) points(i, c) = coords(node(i), c);
      });
  return to_host(points);
}

/// Splits each normal into the free components and those that are prescribed; collective.
void take_over_dirichlet(ContactNodes &c, const fem::DirichletDofs &dirichlet, const Comm &comm)
{
  const auto fixed = dirichlet.fixed;
  const auto value = device_read(*dirichlet.value);
  const ContactNodes nodes = c;
  double largest_gap = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_gap", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) {
        const double gap = nodes.gap(i) < 0 ? -nodes.gap(i) : nodes.gap(i);
        if (gap > most) most = gap;
      },
      Kokkos::Max<double>(largest_gap));
  // Prescribed displacements and gaps that are meant to be equal differ by rounding: sin(pi) is not 0.
  const double rounding = 1e-12 * (std::max(0., max_all(comm, largest_gap)) + dirichlet.value->normInf());
  Kokkos::parallel_for(
      "rpc::contact::directions", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        double length = 0, free_gap = nodes.gap(i);
        for (int k = 0; k < nodes.dim; ++k) {
          const LO dof = nodes.dim * nodes.node(i) + k;
          if (fixed(dof)) free_gap -= nodes.normal(i, k) * value(dof);
          nodes.direction(i, k) = fixed(dof) ? 0 : nodes.normal(i, k);
          length += nodes.direction(i, k) * nodes.direction(i, k);
        }
        // A remainder of rounding size is no direction to push in.
        nodes.fixed(i) = length < 1e-16;
        for (int k = 0; k < nodes.dim && nodes.fixed(i); ++k) nodes.direction(i, k) = 0;
        nodes.free_gap(i) = nodes.fixed(i) && free_gap < rounding && free_gap > -rounding ? 0 : free_gap;
      });
  Kokkos::fence();
}

} // namespace

Teuchos::ParameterList valid_contact_parameters()
{
  Teuchos::ParameterList valid("Contact");
  valid.set("Side", "", "Side of the body that may touch the foundation; empty: none.");
  set_field(valid, "Yield Stress", "inf",
            "xi > 0 [Pa]: pressure at which the foundation gives way; `inf`: rigid (Signorini). Number or expression.");
  set_field(valid, "Gap", "0",
            "g [m]: distance to the foundation along the body's outward normal; < 0: initial penetration. Number or "
            "expression.");
  valid.set(
      "Penalty", 1e8,
      "r > 0 [Pa/m] of the modified Lagrangian. The solution does not depend on it, the number of iterations does.");
  return valid;
}

ContactOptions contact_options(const Teuchos::ParameterList &list, const FieldParser &parse)
{
  ContactOptions options;
  options.side = list.get<std::string>("Side");
  options.yield_stress = parse(field_text(list, "Yield Stress"), "Contact->Yield Stress");
  options.gap = parse(field_text(list, "Gap"), "Contact->Gap");
  options.penalty = list.get<double>("Penalty");
  RPC_REQUIRE(options.penalty > 0 && std::isfinite(options.penalty),
              "deck: \"Contact->Penalty\" must be > 0 and finite [Pa/m], got " << options.penalty);
  RPC_REQUIRE(!options.yield_stress.is_constant() || options.yield_stress.constant > 0,
              "deck: \"Contact->Yield Stress\" must be > 0 [Pa] (inf for a rigid foundation), got "
                  << options.yield_stress.text);
  return options;
}

ContactNodes contact_nodes(const fem::Discretization &d, const ContactOptions &options,
                           const fem::DirichletDofs &dirichlet)
{
  ContactNodes c;
  c.dim = d.dim();
  fem::SurfaceNodes surface;
  if (!options.side.empty()) surface = fem::surface_nodes(d, d.mesh->side(options.side, "Contact->Side"));
  c.node = surface.node;
  c.weight = surface.weight;
  c.normal = surface.normal;
  const LO n = c.size();
  const Comm &comm = d.mesh->comm();
  c.direction = DeviceView<double **>("rpc::contact::direction", n, c.dim);
  c.free_gap = DeviceView<double *>("rpc::contact::free_gap", n);
  c.fixed = DeviceView<char *>("rpc::contact::fixed", n);
  c.penalty = DeviceView<double *>("rpc::contact::penalty", n);
  Kokkos::deep_copy(c.penalty, options.penalty);

  const HostPoints points = positions(*d.mesh, c.node);
  const auto xi = evaluate(options.yield_stress, points, "Contact->Yield Stress", comm, true);
  std::optional<std::string> bad;
  for (LO i = 0; i < n && !bad; ++i) {
    std::ostringstream message;
    message << "deck: \"Contact->Yield Stress\" must be > 0 [Pa] (inf for a rigid foundation), got " << xi(i);
    if (!options.yield_stress.is_constant())
      message << " from \"" << options.yield_stress.text << "\" at " << place(points, i);
    if (!(xi(i) > 0)) bad = message.str();
  }
  throw_if_any(comm, ExitCode::bad_input, bad);
  c.yield = to_device(xi);
  c.gap = to_device(evaluate(options.gap, points, "Contact->Gap", comm));
  take_over_dirichlet(c, dirichlet, comm);
  c.num_total = sum_all(comm, GO(n));

  const auto fixed = to_host(c.fixed);
  const auto free_gap = to_host(c.free_gap);
  GO num_fixed = 0;
  for (LO i = 0; i < n; ++i) {
    num_fixed += fixed(i);
    if (!fixed(i) || std::isfinite(xi(i)) || !(-free_gap(i) > 0) || bad) continue;
    std::ostringstream message;
    message << "contact: the prescribed displacement presses the node at " << place(points, i) << " by " << -free_gap(i)
            << " [m] into the foundation of side \"" << options.side
            << "\", which is rigid there. Lower it, or give a finite yield stress.";
    bad = message.str();
  }
  throw_if_any(comm, ExitCode::no_solution, bad);
  c.num_fixed = sum_all(comm, num_fixed);
  return c;
}

} // namespace rpc::contact
