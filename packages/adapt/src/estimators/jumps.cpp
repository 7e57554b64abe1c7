// SPDX-License-Identifier: BSD-3-Clause
#include "jumps.hpp"

#include "rpc/fem/surface.hpp"

namespace rpc::adapt
{
namespace
{

/// Slopes of the gap along the facets at their ends, by node: where a facet begins, where one ends.
struct Slopes {
  ContactTerms terms;                                // in
  DeviceView<double *> from, to;                     // (overlap nodes) out
  DeviceView<double *> curvature_from, curvature_to; // (overlap nodes) of these facets, of order 2 [1/m] out
  DeviceView<LO *> after,
      before; // (overlap nodes) next nodes at the other ends of these facets, -1 where there is none, out

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    const LO a = terms.facets(f, 0), b = terms.facets(f, 1);
    const double length = terms.size(f), g = terms.field(a, int(gap)), h = terms.field(b, int(gap));
    const bool quadratic = terms.facets.extent(1) == 3;
    const double middle = quadratic ? terms.field(terms.facets(f, 2), int(gap)) : (g + h) / 2;
    from(a) = (4 * middle - 3 * g - h) / length;
    to(b) = (3 * h + g - 4 * middle) / length;
    curvature_from(a) = curvature_to(b) = (to(b) - from(a)) / length;
    after(a) = b;
    before(b) = a;
  }
};

// What a node knows of the gap beside it.
enum Beside { kink, curvature_before, curvature_after, num_beside };

/// By how much the slope of the gap grows at owned nodes, and its curvature on the facets before and after them, 0 where there is none: on
/// all nodes of the facets around them, (overlap nodes; Beside).
RCP<const MultiVector> kinks(const fem::Discretization &d, const Slopes &slopes)
{
  const auto owned = rcp(new MultiVector(d.mesh->owned_nodes, int(num_beside)));
  {
    const auto to = owned->getLocalViewDevice(Tpetra::Access::ReadWrite);
    const auto coords = d.mesh->coords;
    const bool axisymmetric = d.axisymmetric();
    Kokkos::parallel_for(
        "rpc::adapt::kinks", device_range(static_cast<LO>(to.extent(0))), KOKKOS_LAMBDA(const LO n) {
          const bool begins = slopes.after(n) >= 0, ends = slopes.before(n) >= 0;
          if (begins && ends)
            to(n, int(kink)) = slopes.from(n) - slopes.to(n);
          else if (axisymmetric && coords(n, 0) == 0) // the gap goes on beyond the axis as its mirror image
            to(n, int(kink)) = begins ? 2 * slopes.from(n) : ends ? -2 * slopes.to(n) : 0;
          to(n, int(curvature_before)) = slopes.curvature_to(n);
          to(n, int(curvature_after)) = slopes.curvature_from(n);
        });
    Kokkos::fence();
  }
  return fem::nodes_on_overlap(d, owned);
}

// What the neighbours of a node know of the gap.
enum Neighbour { kink_before, kink_after, num_neighbours };

/// The kinks at the nodes before and after owned nodes, 0 where there is none: on all nodes of the facets around them, (overlap nodes;
/// Neighbour).
/// @param seen  see kinks()
RCP<const MultiVector> kinks_of_neighbours(const fem::Discretization &d, const Slopes &slopes, const ReadColumns &seen)
{
  const auto owned = rcp(new MultiVector(d.mesh->owned_nodes, int(num_neighbours)));
  {
    const auto to = owned->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "rpc::adapt::kinks_of_neighbours", device_range(static_cast<LO>(to.extent(0))), KOKKOS_LAMBDA(const LO n) {
          if (slopes.before(n) >= 0) to(n, int(kink_before)) = seen(slopes.before(n), int(kink));
          if (slopes.after(n) >= 0) to(n, int(kink_after)) = seen(slopes.after(n), int(kink));
        });
    Kokkos::fence();
  }
  return fem::nodes_on_overlap(d, owned);
}

} // namespace

SingularNodes singular_nodes(const fem::Discretization &d, const ContactTerms &terms)
{
  constexpr double high = 0.5, twice_pi = 6.28318530717958647692;
  if (d.mesh->dim() != 2) return {};
  const std::size_t n = terms.field.extent(0);
  const Slopes slopes{terms,
                      DeviceView<double *>("rpc::adapt::slope_from", n),
                      DeviceView<double *>("rpc::adapt::slope_to", n),
                      DeviceView<double *>("rpc::adapt::curvature_from", n),
                      DeviceView<double *>("rpc::adapt::curvature_to", n),
                      DeviceView<LO *>("rpc::adapt::node_after", n),
                      DeviceView<LO *>("rpc::adapt::node_before", n)};
  Kokkos::deep_copy(slopes.after, -1);
  Kokkos::deep_copy(slopes.before, -1);
  const auto facets = device_range(static_cast<LO>(terms.facets.extent(0)));
  Kokkos::parallel_for("rpc::adapt::slopes", facets, slopes);
  Kokkos::fence();
  const auto at_nodes = kinks(d, slopes);
  const auto seen = at_nodes->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto of_neighbours = kinks_of_neighbours(d, slopes, seen);
  const auto neighbour = of_neighbours->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto coords = d.mesh->coords;
  const LO num_owned = d.mesh->num_owned_nodes();
  const bool axisymmetric = d.axisymmetric();
  SingularNodes found;
  Kokkos::parallel_reduce(
      "rpc::adapt::singular_nodes", facets,
      KOKKOS_LAMBDA(const LO f, double &largest, double &edges, double &rounded, double &rounded_depth) {
        const double modulus = terms.surface_modulus(f);
        for (int a = 0; a < 2; ++a) {
          const LO node = terms.facets(f, a);
          const double p = node < num_owned ? terms.field(node, int(pressure)) : 0;
          if (!(p > 0 && p >= high * terms.highest)) continue;
          const contact::Foundation law = terms.law_at(f, a);
          const bool yields = p >= contact::yield_limit(law);
          const bool at_end = slopes.after(node) < 0 || slopes.before(node) < 0;
          if (at_end && terms.friction && !yields && !(axisymmetric && coords(node, 0) == 0)) {
            double square = 0; // 0 by symmetry where the end lies on a plane of symmetry
            for (int k = traction; k < traction + 3; ++k) square += terms.field(node, k) * terms.field(node, k);
            if (math::sqrt(square) > Jumps::seen * terms.highest) edges += 1;
          }
          // A curved gap has as much at the neighbours: what they have too is no kink.
          double beside = 0;
          if (slopes.after(node) >= 0) beside = math::fmax(beside, seen(slopes.after(node), int(kink)));
          if (slopes.before(node) >= 0) beside = math::fmax(beside, seen(slopes.before(node), int(kink)));
          if (yields || terms.on_springs(f, a)) {
            // Next to an open node the gap jumps, or contact ends.
            const LO after = slopes.after(node), before = slopes.before(node);
            if ((after >= 0 && !(terms.field(after, int(pressure)) > 0)) ||
                (before >= 0 && !(terms.field(before, int(pressure)) > 0)))
              continue;
            const double off = modulus * (seen(node, int(kink)) - beside) / twice_pi * terms.unresolved(f, a, yields);
            if (!(off > 0)) continue;
            rounded = math::fmax(rounded, off);
            rounded_depth = math::fmax(rounded_depth, off * terms.softness(f, a, yields));
            continue;
          }
          // From before a facet to behind it the slope grows by as much as at a kink within it, wherever that lies; a curved gap shows in
          // the curvature of the next facets of order 2, or at the nodes beyond one of order 1.
          const LO start = terms.facets(f, 0), end = terms.facets(f, 1);
          const bool quadratic = terms.facets.extent(1) == 3;
          double across = slopes.to(end) - slopes.from(start);
          for (int b = 0; b < 2; ++b) { // where the foundation yields at a kink the pressure has a limit
            const LO at = terms.facets(f, b);
            if (!quadratic || terms.field(at, int(pressure)) < contact::yield_limit(terms.law_at(f, b)))
              across += seen(at, int(kink));
          }
          const double curved =
              math::fmax(0., math::fmax(seen(start, int(curvature_before)), seen(end, int(curvature_after))));
          const double beyond =
              math::fmax(0., math::fmax(neighbour(start, int(kink_before)), neighbour(end, int(kink_after))));
          const double within = across - (quadratic ? curved * terms.size(f) : 2 * beyond);
          const double grows = math::fmax(within, seen(node, int(kink)) - beside);
          largest = math::fmax(largest, modulus * grows / (twice_pi * terms.highest));
        }
      },
      Kokkos::Max<double>(found.kink), found.edges, Kokkos::Max<double>(found.rounded),
      Kokkos::Max<double>(found.rounded_depth));
  for (double *const most : {&found.kink, &found.rounded, &found.rounded_depth}) *most = math::fmax(0., *most);
  return found;
}

} // namespace rpc::adapt
