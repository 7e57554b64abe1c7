// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/between_nodes.hpp"

#include "facet_samples.hpp"
#include "gap_reading.hpp"
#include "gap_search.hpp"
#include "rpc/contact/clearance.hpp"
#include "rpc/contact/law/foundation.hpp"
#include "rpc/contact/rounding.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace rpc::contact
{
namespace
{

/// How densely a side is sampled. Cost, not accuracy, bounds it: a sample of an expression takes some 0.2 microseconds on one core.
struct Density {
  /// Samples of a side that are always affordable: in the plane they find what is 1/4000 of a side long, in space 1/128 of it.
  static constexpr double in_plane = 4096, in_space = 16384;
  /// Parts of an edge of a facet, of sides with more facets than that.
  static constexpr int fewest_parts = 4;
  /// Parts of a side's faces in space in which branch and bound looks for contact between samples: some 1 microsecond each.
  static constexpr int searched = 1 << 15;
  /// Of a surface that is given at places of its own: samples for each of their distances, of a side at most, and parts of an edge at most.
  static constexpr double for_detail = 2, of_detail = 1 << 20;
  static constexpr int most_parts = 256;
};
// Unseen contact that changes the solution by less, in the energy norm, is below what any mesh of engineers resolves.
constexpr double notable = 0.05;

/// What the samples of a facet show.
struct Found {
  double deepest = 0; // e [m]
  Point place{};
  double width = 0;      // of the part in the foundation [m]
  double squared = 0;    // of an unseen facet, its part in twice the energy [J]
  double hidden = 0;     // of that, what reaches nearer to the body than under all nodes that bear [J]
  double pressed_in = 0; // how deep the foundation may have been pressed in by an unseen facet [m]
  double largest_excess = -std::numeric_limits<double>::infinity(); // e of all samples, < 0 outside the foundation [m]
};

/// Twice the energy per area that it takes to push a part of a facet out of the foundation: a layer of the body as deep as the part is wide
/// gives way, in series with the foundation. (3.16)
/// @param modulus  lambda + 2 mu of the body [Pa]
double pushed_out(const ContactOptions &options, const double depth, const double modulus, const double width,
                  const Point &x)
{
  const double stiffness = 1 / (width / modulus + 1 / options.stiffness(x)), yield = options.yield_stress(x);
  if (stiffness * depth <= yield) return stiffness * depth * depth;
  return 2 * yield * depth - yield * yield / stiffness;
}

/// Of an obstacle that may have more detail than the mesh; null of others.
const SurfaceDetail *detail_of(const ContactOptions &options)
{
  const auto &surface = options.obstacle.surface;
  return surface && surface->detail ? &*surface->detail : nullptr;
}

/// One side and its foundation.
struct SideSamples {
  const ContactOptions &options;
  const FacetRows &rows;
  const Lattice &lattice;
  bool axisymmetric;

  /// @param modulus  lambda + 2 mu of the cell [Pa]   @param least  what is no more than rounding [m]   @param at  the samples, if they are known
  /// @param counts   whether what lies in the foundation may be unseen: else its energies are left out
  Found look(const LO f, const double modulus, const double least, const SampledFacet *const at = nullptr,
             const bool counts = true) const
  {
    Found found;
    const FacetNodes nodes = facet_nodes(rows, f);
    struct Inside {
      double depth, hidden, dent;
      Point place;
    };
    std::vector<Inside> inside;
    const double lowest = at ? lowest_bearing_gap(f, *at) : std::numeric_limits<double>::infinity();
    double radii = 0; // in axisymmetry the samples count by them
    const std::size_t run = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(lattice.points.size()))));
    bool near = true;
    for (std::size_t n = 0; n < lattice.points.size(); ++n) {
      const FacetShape &shape = lattice.points[n];
      if (n % run == 0) near = some_are_near(f, n, std::min(n + run, lattice.points.size()));
      if (!near) {
        radii += axisymmetric ? place_at(rows, f, shape)[0] : 1;
        continue;
      }
      const FacetSample sample = at ? at->points[n] : sample_at(nodes, shape, options);
      const double depth = at ? at->penetration[n] - sample.allowed : excess_at(sample, options);
      radii += axisymmetric ? sample.place[0] : 1;
      if (depth > found.largest_excess) found.largest_excess = depth;
      if (depth > least) {
        const double nearer = at ? lowest - gap_of(*at, n) : depth;
        inside.push_back({depth, std::clamp(nearer, 0., depth), sample.allowed, sample.place});
      }
      if (!(depth > std::max(least, found.deepest))) continue;
      found.deepest = depth;
      found.place = sample.place;
    }
    if (inside.empty()) return found;
    const double share = double(inside.size()) / static_cast<double>(lattice.points.size());
    found.width = rows.size(f) * std::pow(share, 1. / (rows.dim - 1));
    if (!counts) return found;
    for (const auto &[depth, hidden, dent, place] : inside) {
      const double weight = axisymmetric ? place[0] : 1;
      found.squared += weight * pushed_out(options, depth, modulus, found.width, place);
      found.hidden += weight * pushed_out(options, hidden, modulus, found.width, place);
      if (!at)
        found.pressed_in = std::max(found.pressed_in, pressed_in(options, place, dent, depth, rows.size(f) / modulus));
    }
    for (double *const sum : {&found.squared, &found.hidden}) *sum *= radii > 0 ? rows.area(f) / radii : 0;
    return found;
  }

  /// Of what lies below a sample, without dents [m].
  static double gap_of(const SampledFacet &at, const std::size_t n) { return at.points[n].along - at.penetration[n]; }
  /// The least of the nodes that bear a pressure.
  double lowest_bearing_gap(const LO f, const SampledFacet &at) const
  {
    double lowest = std::numeric_limits<double>::infinity();
    for (int a = 0; a < rows.nodes; ++a)
      if (rows.column(f, a, FacetRows::bearing) > 0) lowest = std::min(lowest, gap_of(at, at.lattice->node[a]));
    return lowest;
  }

  /// Whether some of a run of samples may lie in the foundation. None does that is further from it than the body moves there. Along fixed normals
  /// a sample costs less than to ask.
  bool some_are_near(const LO f, const std::size_t first, const std::size_t last) const
  {
    const SurfaceDetail *const detail = detail_of(options);
    if (detail == nullptr || options.normal != Normal::foundation) return true;
    Bounds places = Bounds::empty();
    double moved = 0;
    for (std::size_t n = first; n < last; ++n) {
      places.add(difference(place_at(rows, f, lattice.points[n]), options.obstacle.point));
      moved = std::max(moved, length(displacement_at(rows, f, lattice.points[n])));
    }
    return detail->clearance(places) <= moved;
  }

  /// An upper bound on e over a facet [m]; infinite where nothing is known of the gap between its nodes.
  /// @param shape, triangle  of the facet
  double most_possible(const LO f, const EvaluateShape &shape, const bool triangle) const
  {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    if (!options.obstacle.exists())
      return rows.dim == 3 && options.gap.bounds ? bound_on_excess(rows, f, shape, options, triangle) : unknown;
    const Obstacle &obstacle = options.obstacle;
    Bounds places = Bounds::empty();
    double moved = 0;
    for (int a = 0; a < rows.nodes; ++a) {
      Point x{}, u{};
      std::copy_n(rows.place(f, a), rows.dim, x.begin());
      std::copy_n(rows.displacement(f, a), rows.dim, u.begin());
      places.add(difference(x, obstacle.point));
      moved = std::max(moved, length(u));
    }
    // Between nodes of order 2 a facet may reach beyond their box by an eighth of it, and displacements may be larger in the same way.
    Point middle = obstacle.point, half{};
    for (int c = 0; c < rows.dim; ++c) {
      const double beyond = (places.upper[c] - places.lower[c]) / 8;
      places.lower[c] -= beyond;
      places.upper[c] += beyond;
      middle[c] += (places.lower[c] + places.upper[c]) / 2;
      half[c] = (places.upper[c] - places.lower[c]) / 2;
    }
    moved *= 25. / 16;
    if (const SurfaceDetail *const detail = detail_of(options)) return moved - detail->clearance(places);
    // The distance from the foundation changes by no more than the way.
    const auto into = direction_into(obstacle, middle);
    const auto distance = into ? distance_along(obstacle, middle, *into) : std::nullopt;
    return distance ? moved + length(half) - *distance : unknown;
  }
};

/// What is hidden between the samples of a face in space. It is taken for a paraboloid.
/// @param dent  the deepest of the face   @param size  of the face [m]
Found found_in(const HiddenPart &hidden, const ContactOptions &options, const double modulus, const double dent,
               const double size)
{
  const double area = 0.25 * 3.14159265358979 * hidden.width[0] * hidden.width[1];
  const double width = std::sqrt(hidden.width[0] * hidden.width[1]);
  const double squared = area / 3 * pushed_out(options, hidden.depth, modulus, width, hidden.place);
  return {hidden.depth, hidden.place, width,
          squared,      squared,      pressed_in(options, hidden.place, dent, hidden.depth, size / modulus),
          hidden.depth};
}

/// Into how many parts the edges of a side's facets are divided.
/// @param num_facets  over all ranks
int parts_of(const mesh::Element &facet, const GO num_facets)
{
  const double facets = std::max(1., double(num_facets)),
               wanted = facet.dim == 1 ? Density::in_plane : Density::in_space;
  return std::max(Density::fewest_parts, static_cast<int>(std::ceil(std::pow(wanted / facets, 1. / facet.dim))));
}

/// The same for a surface that is given at places of its own: as fine as these, up to the limits of Density.
/// @param longest  facet of the side [m]
int parts_for(const SurfaceDetail &detail, const mesh::Element &facet, const GO num_facets, const double longest)
{
  const double affordable = std::pow(Density::of_detail / std::max(1., double(num_facets)), 1. / facet.dim);
  const double most = std::min<double>(Density::most_parts, affordable);
  return static_cast<int>(std::min(std::ceil(Density::for_detail * longest / detail.spacing), most));
}

/// Whether nothing can lie between the nodes of flat facets: u and the gap are linear between them.
bool is_linear(const mesh::Element &facet, const ContactOptions &options)
{
  const bool plane = options.obstacle.exists() ? options.obstacle.surface->is_flat : options.gap.is_constant();
  return plane && facet.order == 1;
}

/// The deepest of all ranks' places; collective.
PlaceBetweenNodes deepest_of_all(const Comm &comm, const PlaceBetweenNodes &mine)
{
  const double depth = max_all(comm, mine.depth);
  if (!(depth > 0)) return {};
  const int rank = min_all(comm, mine.depth == depth ? comm.getRank() : comm.getSize());
  std::vector<double> numbers{mine.depth,        mine.place[0], mine.place[1], mine.place[2],
                              double(mine.side), mine.width,    mine.facet};
  Teuchos::broadcast(comm, rank, static_cast<int>(numbers.size()), numbers.data());
  return {numbers[0], {numbers[1], numbers[2], numbers[3]}, static_cast<int>(numbers[4]), numbers[5], numbers[6]};
}

/// Looks at the facets of one side.
/// @param open_by  where nothing touches, the smallest gap at nodes [m]: facets that may be nearer have samples then, too; else minus infinity
/// @return twice the energy of its unseen facets, of this rank [J]
double look_at_side(const fem::Discretization &d, const mesh::Side &side, const ContactOptions &options,
                    const ContactNodes &points, const fem::Materials &materials, const Vector &u, const int k,
                    const double open_by, ContactResult &result, BetweenNodes &mine)
{
  const double least = Rounding::depth * d.diameter;
  const mesh::Mesh &mesh = *d.mesh;
  const mesh::Element facet = mesh.element.facet();
  const FacetRows rows = facet_rows(d, side, points, result, k, u);
  std::vector<LO> owned;
  GO partly_open = 0;
  for (LO f = 0; f < rows.num_facets(); ++f) {
    if (rows.cell(f) >= mesh.num_owned_cells) continue;
    owned.push_back(f);
    partly_open += rows.is_partly_open(f) ? 1 : 0;
  }
  const GO num_facets = sum_all(mesh.comm(), GO(owned.size()));
  int parts = parts_of(facet, num_facets);
  const SurfaceDetail *const detail = detail_of(options);
  if (detail != nullptr) {
    double longest = 0;
    for (const LO f : owned) longest = std::max(longest, rows.size(f));
    parts = std::max(parts, parts_for(*detail, facet, num_facets, max_all(mesh.comm(), longest)));
  }
  const auto fine = lattice_of(facet, parts), coarse = lattice_of(facet, Density::fewest_parts);
  const auto touched = lattice_of(facet, parts_with_halves(facet, parts));
  // The part in the foundation of a face in space that touches at one node may be narrow: these faces share as many samples as a side may have.
  const auto at_edges =
      facet.dim == 2 && detail == nullptr
          ? lattice_of(facet, parts_with_halves(facet, parts_of(facet, sum_all(mesh.comm(), partly_open))))
          : touched;
  const bool revolution = d.axisymmetric();
  const SideSamples samples{options, rows, fine, revolution}, few{options, rows, coarse, revolution},
      touching{options, rows, touched, revolution}, edges{options, rows, at_edges, revolution};
  const bool searches = facet.dim == 2 && !options.obstacle.exists() && options.gap.bounds;
  const EvaluateShape shape = shape_of(facet);
  const bool triangle = facet.shape == mesh::Shape::simplex;
  // Facets that cannot reach the foundation need no samples.
  std::vector<double> possible;
  GO to_search = 0;
  for (const LO f : owned) {
    possible.push_back(samples.most_possible(f, shape, triangle));
    to_search += searches && possible.back() >= 0 && rows.bears_nothing(f) ? 1 : 0;
  }
  const GapReading reading{options, rows, revolution, d.diameter};
  const int most_searched =
      static_cast<int>(Density::searched / std::max(GO(1), sum_all(mesh.comm(), to_search))); // of each facet
  const auto block = to_host(mesh.block);
  const auto lame = to_host(fem::lame_table(d, materials));
  std::vector<double> squared(rows.num_facets(), 0.), width(rows.num_facets(), 0.), hidden(rows.num_facets(), 0.);
  SampledFacet sampled;
  std::vector<PlaceBetweenNodes> places;
  std::vector<OffInterpolants> off_interpolant(owned.size());
  double smooth = least; // how far the gap is from its interpolant where it is smooth [m]
  for (std::size_t n = 0; n < owned.size(); ++n) {
    const LO f = owned[n];
    const double lambda = lame(block(rows.cell(f)), 0), mu = lame(block(rows.cell(f)), 1), modulus = lambda + 2 * mu;
    const bool touches = !rows.bears_nothing(f), partly = rows.is_partly_open(f);
    const SideSamples &densely = !touches ? samples : partly ? edges : touching;
    if (touches) {
      reading.sample(f, densely.lattice, sampled);
      off_interpolant[n] = off_interpolants(sampled);
    }
    Found found;
    if (possible[n] >= 0) {
      found = touches ? densely.look(f, modulus, least, &sampled, off_interpolant[n].hides(0))
                      : densely.look(f, modulus, least);
      if (!touches && searches && !(found.deepest > 0))
        if (const auto hidden = find_hidden_part(rows, f, shape, options, triangle, least, most_searched))
          found = found_in(*hidden, options, modulus, rows.most_allowed(f), rows.size(f));
    } else if (possible[n] > -open_by) {
      found = (facet.dim == 1 && detail == nullptr ? samples : few).look(f, modulus, least);
    }
    const PlaceBetweenNodes place{found.deepest, found.place, k, found.width, rows.size(f)};
    if (place.depth > mine.deepest.depth) mine.deepest = place;
    mine.smallest_gap = std::min(mine.smallest_gap, -found.largest_excess);
    const bool looks = touches && (found.deepest > 0 || partly);
    if (looks && (reading.is_off(f, sampled) || reading.has_deep_node(f, modulus))) {
      const Misread misread = reading.read(f, modulus, 4 * mu * (lambda + mu) / modulus, sampled);
      mine.misread_energy += misread.energy;
      mine.misread_force += misread.force;
      mine.misread_penetration = std::max(mine.misread_penetration, misread.penetration);
      mine.misread_ends += misread.ends;
    } else if (touches && detail == nullptr) {
      mine.interpolation_work += reading.work_of_interpolation(f, sampled);
    }
    mine.misread_penetration = std::max(mine.misread_penetration, found.pressed_in);
    if (touches && !off_interpolant[n].hides(0)) smooth = std::max(smooth, off_interpolant[n].whole);
    squared[f] = found.squared;
    hidden[f] = found.hidden;
    places.push_back(place);
  }
  smooth = max_all(mesh.comm(), smooth);
  double sum = 0;
  for (std::size_t n = 0; n < owned.size(); ++n) {
    const LO f = owned[n];
    if (!rows.bears_nothing(f) && !off_interpolant[n].hides(smooth)) {
      squared[f] = 0;
      continue;
    }
    sum += squared[f];
    mine.hidden_energy += 0.5 * hidden[f];
    width[f] = places[n].width;
    if (places[n].depth > mine.unseen.depth) mine.unseen = places[n];
  }
  result.between.unseen_squared.push_back(device_values(squared, "rpc::contact::unseen_squared"));
  result.between.unseen_width.push_back(device_values(width, "rpc::contact::unseen_width"));
  return sum;
}

/// Points without weight that lie in the foundation are not open.
void mark_unseen_points(const ContactNodes &points, const double least, const ContactResult &result)
{
  const ContactNodes c = points;
  const auto p = result.pressure, v = result.penetration;
  const auto state = result.state;
  Kokkos::parallel_for(
      "rpc::contact::unseen_points", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (!(c.weight(i) > 0) && !(p(i) > 0) && v(i) - c.dent(i) > least) state(i) = ContactResult::unseen;
      });
  Kokkos::fence();
}

} // namespace

void look_between_nodes(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                        const std::vector<ContactOptions> &options, const ContactNodes &points,
                        const fem::Materials &materials, const Vector &u, ContactResult &result)
{
  const Comm &comm = d.mesh->comm();
  result.between = {};
  if (sides.empty()) return;
  if (points.num_weightless > 0) mark_unseen_points(points, Rounding::depth * d.diameter, result);
  const double open_by =
      result.total.contact_length > 0 ? -std::numeric_limits<double>::infinity() : smallest_gap(comm, points, result);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    BetweenNodes mine;
    double squared = 0;
    if (is_linear(d.mesh->element.facet(), options[k]))
      for (auto *const none : {&result.between.unseen_squared, &result.between.unseen_width})
        none->push_back(DeviceView<double *>("rpc::contact::nothing_unseen", sides[k]->facets.extent(0)));
    else
      squared =
          look_at_side(d, *sides[k], options[k], points, materials, u, static_cast<int>(k), open_by, result, mine);
    for (const auto sum : {&BetweenNodes::misread_energy, &BetweenNodes::misread_force, &BetweenNodes::misread_ends,
                           &BetweenNodes::interpolation_work, &BetweenNodes::hidden_energy})
      result.between.*sum += sum_all(comm, mine.*sum);
    result.between.misread_penetration =
        std::max(result.between.misread_penetration, max_all(comm, mine.misread_penetration));
    result.between.smallest_gap = std::min(result.between.smallest_gap, min_all(comm, mine.smallest_gap));
    const auto deepest = deepest_of_all(comm, mine.deepest), unseen = deepest_of_all(comm, mine.unseen);
    ContactSums &sums = result.sides[k];
    sums.max_penetration_between_nodes = deepest.depth;
    sums.unseen_penetration = unseen.depth;
    sums.unseen_energy = 0.5 * sum_all(comm, squared);
    result.total.max_penetration_between_nodes =
        std::max(result.total.max_penetration_between_nodes, sums.max_penetration_between_nodes);
    result.total.unseen_penetration = std::max(result.total.unseen_penetration, sums.unseen_penetration);
    result.total.unseen_energy += sums.unseen_energy;
    if (deepest.depth > result.between.deepest.depth) result.between.deepest = deepest;
    if (unseen.depth > result.between.unseen.depth) result.between.unseen = unseen;
  }
}

bool misses_contact(const ContactSums &sums, const double energy_norm_squared)
{
  return 2 * sums.unseen_energy > notable * notable * energy_norm_squared;
}

std::string unseen_contact_note(const ContactResult &result, const std::vector<ContactOptions> &options, const int dim,
                                const double energy_norm_squared, const UnitNames &units, const bool adapts)
{
  const PlaceBetweenNodes &at = result.between.unseen;
  if (!(at.depth > 0) || !misses_contact(result.total, energy_norm_squared)) return "";
  std::ostringstream text;
  const std::string unit = " [" + units.of(unit::length, false) + "]";
  text << std::setprecision(4) << "unseen contact: at (" << at.place[0] << ", " << at.place[1];
  if (dim == 3) text << ", " << at.place[2];
  text << std::setprecision(2) << ") side \"" << options[at.side].side << "\" lies " << at.depth << unit
       << " inside the foundation, between contact points, so that the contact force lacks it. The facet "
          "is "
       << at.facet << unit << " long there; cells of " << at.width / 2 << unit
       << " would see it. Make the mesh finer there, or " << (adapts ? "lower" : "give")
       << " \"Adapt->Target Relative Error\".";
  return text.str();
}

} // namespace rpc::contact
