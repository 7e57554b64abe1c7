#include "rpc/contact/between_nodes.hpp"

#include "rpc/contact/law/judgement.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/mesh/geometry.hpp"
#include "rpc/mesh/shape_functions.hpp"

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
  /// Of those sides facets are left out that lie further from the foundation than so many times what the penetration varies within them.
  static constexpr double reach = 2;
};
// Of the body's diameter: what lies less deep is rounding of places.
constexpr double rounding = 1e-12;
// Unseen contact that changes the solution by less, in the energy norm, is below what any mesh of engineers resolves.
constexpr double notable = 0.05;

/// Samples of a facet: a lattice of its reference cell, the vertices among them.
struct Lattice {
  int nodes = 0, dim = 0;           // of the facet
  std::vector<double> value, slope; // (samples, nodes), (samples, nodes, dim)

  int size() const { return nodes > 0 ? static_cast<int>(value.size()) / nodes : 0; }
};

template <class Shape>
Lattice lattice_of(const Shape &shape, const int parts)
{
  constexpr int dim = Shape::dim, nodes = Shape::nodes;
  Lattice lattice{nodes, dim, {}, {}};
  int total = 1;
  for (int k = 0; k < dim; ++k) total *= parts + 1;
  for (int s = 0; s < total; ++s) {
    double X[dim], N[nodes], dN[nodes][dim], sum = 0;
    for (int k = 0, rest = s; k < dim; ++k, rest /= parts + 1) {
      X[k] = double(rest % (parts + 1)) / parts;
      sum += X[k];
      if (!Shape::simplex) X[k] = 2 * X[k] - 1;
    }
    if (Shape::simplex && sum > 1 + 1e-9) continue;
    shape.evaluate(X, N, dN);
    for (int a = 0; a < nodes; ++a) {
      lattice.value.push_back(N[a]);
      for (int k = 0; k < dim; ++k) lattice.slope.push_back(dN[a][k]);
    }
  }
  return lattice;
}

Lattice lattice_of(const mesh::Element &facet, const int parts)
{
  Lattice lattice;
  mesh::with_shape_functions(facet, [&](const auto &shape) { lattice = lattice_of(shape, parts); });
  return lattice;
}

/// What a contact point does for its facets.
enum Bearing : int { weightless = -1, open = 0, bears = 1 };
enum Column { allowed, bearing, excess_at_node, num_columns };

/// (overlap nodes; Column) of one side: how deep a point has been pressed in [m], whether it bears a pressure, and how much deeper it lies
/// [m]. A node from which the normal misses the obstacle is open, and may be near.
RCP<const MultiVector> at_overlap_nodes(const fem::Discretization &d, const ContactNodes &points,
                                        const ContactResult &result, const int side)
{
  const auto owned = rcp(new MultiVector(d.mesh->owned_nodes, num_columns));
  const ContactNodes c = points;
  const auto v = result.penetration, p = result.pressure;
  {
    const auto to = owned->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "rpc::contact::bearing_points",
        Kokkos::RangePolicy<ExecutionSpace, LO>(points.first(side), points.first(side + 1)), KOKKOS_LAMBDA(const LO i) {
          const bool weighs = c.weight(i) > 0, pressed = weighs && (p(i) > 0 || c.fixed(i));
          double deep = c.dent(i);
          if (pressed && v(i) > deep) deep = v(i);
          to(c.node(i), int(allowed)) = weighs && deep > 0 ? deep : 0;
          to(c.node(i), int(bearing)) = !weighs ? weightless : pressed ? bears : open;
          to(c.node(i), int(excess_at_node)) = v(i) - (deep > 0 ? deep : 0);
        });
    Kokkos::fence();
  }
  return fem::nodes_on_overlap(d, owned);
}

/// Facets of a side on the host, each with what its nodes have: (facets; nodes * (place, displacement, Column)).
struct FacetRows {
  HostView<double **> row;
  HostView<LO *> cell;           // (facets)
  HostView<double *> size, area; // (facets) [m], [m^(dim-1), axisymmetric: m^2]
  int nodes = 0, dim = 0;

  int width() const { return 2 * dim + num_columns; }
  const double *at(const LO f, const int a) const { return &row(f, a * width()); }
};

FacetRows facet_rows(const fem::Discretization &d, const mesh::Side &side, const RCP<const MultiVector> &columns,
                     const Vector &u)
{
  FacetRows rows;
  rows.dim = d.dim();
  rows.nodes = static_cast<int>(side.facets.extent(1));
  const int dim = rows.dim, nodes = rows.nodes, width = rows.width();
  const LO num_facets = static_cast<LO>(side.facets.extent(0));
  const DeviceView<double **> row("rpc::contact::facet_rows", num_facets, nodes * width);
  const DeviceView<double *> area("rpc::contact::facet_area", num_facets);
  const auto on_overlap = fem::on_overlap(d, u);
  const auto x = device_read(*on_overlap);
  const auto column = columns->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto coords = d.mesh->coords;
  const auto facets = side.facets;
  const auto measure = fem::facet_measure(d, side);
  const int points = num_facets > 0 ? static_cast<int>(measure.extent(0)) / num_facets : 0;
  Kokkos::parallel_for(
      "rpc::contact::facet_rows", device_range(num_facets), KOKKOS_LAMBDA(const LO f) {
        for (int q = 0; q < points; ++q) area(f) += measure(f * points + q);
        for (int a = 0; a < nodes; ++a) {
          const LO node = facets(f, a);
          for (int k = 0; k < dim; ++k) {
            row(f, a * width + k) = coords(node, k);
            row(f, a * width + dim + k) = x(rpc::dof(dim, node, k));
          }
          for (int k = 0; k < num_columns; ++k) row(f, a * width + 2 * dim + k) = column(node, k);
        }
      });
  rows.row = to_host(row);
  rows.area = to_host(area);
  rows.size = to_host(fem::facet_size(d, side));
  rows.cell = to_host(side.cell);
  return rows;
}

/// The facets of one side against its foundation.
class SideSamples
{
public:
  SideSamples(const ContactOptions &options, const FacetRows &rows, const Lattice &lattice, const bool axisymmetric)
      : options_(options), rows_(rows), lattice_(lattice), axisymmetric_(axisymmetric)
  {
  }

  /// What the samples of a facet show.
  struct Found {
    double deepest = 0; // e [m]
    Point place{};
    bool unseen = false; // no contact point of the facet bears a pressure
    double width = 0;    // of the part in the foundation [m]
    double squared = 0;  // of an unseen facet, the part in twice the energy [J]
  };
  /// @param modulus  lambda + 2 mu of the cell [Pa]   @param least  what is no more than rounding [m]
  Found look(const LO f, const double modulus, const double least) const
  {
    Found found;
    std::vector<double> depth(lattice_.size()), radius(lattice_.size());
    std::vector<Point> place(lattice_.size());
    double highest = 0; // what weightless points take for allowed: they are not held by themselves
    found.unseen = true;
    for (int a = 0; a < rows_.nodes; ++a) {
      highest = std::max(highest, column(f, a, allowed));
      found.unseen &= !(column(f, a, bearing) > 0);
    }
    int inside = 0;
    for (int s = 0; s < lattice_.size(); ++s) {
      depth[s] = excess(f, s, highest, place[s]);
      radius[s] = axisymmetric_ ? place[s][0] : 1;
      if (!(depth[s] > least)) continue;
      ++inside;
      if (depth[s] <= found.deepest) continue;
      found.deepest = depth[s];
      found.place = place[s];
    }
    if (inside == 0) return found;
    found.width = rows_.size(f) * std::pow(double(inside) / lattice_.size(), 1. / (rows_.dim - 1));
    if (!found.unseen) return found;
    double sum = 0, weights = 0;
    for (int s = 0; s < lattice_.size(); ++s) {
      weights += radius[s];
      if (depth[s] > least) sum += radius[s] * pushed_out(depth[s], modulus, found.width, place[s]);
    }
    if (weights > 0) found.squared = rows_.area(f) * sum / weights;
    return found;
  }

  /// Whether a facet may reach into the foundation: its nodes tell, if what they show varies little.
  bool is_near(const LO f) const
  {
    double most = column(f, 0, excess_at_node), least = most;
    for (int a = 1; a < rows_.nodes; ++a) {
      most = std::max(most, column(f, a, excess_at_node));
      least = std::min(least, column(f, a, excess_at_node));
    }
    return most + Density::reach * (most - least) >= 0;
  }

private:
  double column(const LO f, const int a, const Column which) const { return rows_.at(f, a)[2 * rows_.dim + which]; }

  /// e at a sample (3.15); minus infinity where the normal misses the obstacle. @param[out] x  its place
  double excess(const LO f, const int s, const double weightless_allowed, Point &x) const
  {
    const int dim = rows_.dim;
    Point u{}, tangent[2] = {};
    double room = 0;
    x = {};
    for (int a = 0; a < rows_.nodes; ++a) {
      const double N = lattice_.value[s * rows_.nodes + a], *const at = rows_.at(f, a);
      for (int k = 0; k < dim; ++k) {
        x[k] += N * at[k];
        u[k] += N * at[dim + k];
        for (int g = 0; g < dim - 1; ++g)
          tangent[g][k] += lattice_.slope[(s * rows_.nodes + a) * lattice_.dim + g] * at[k];
      }
      room += N * (column(f, a, bearing) < 0 ? weightless_allowed : column(f, a, allowed));
    }
    Point nu = dim == 2 ? Point{tangent[0][1], -tangent[0][0], 0} : cross(tangent[0], tangent[1]);
    nu = scaled(1 / length(nu), nu);
    const double outside = -std::numeric_limits<double>::infinity();
    if (options_.normal == Normal::fixed) nu = options_.direction;
    double gap = 0;
    if (options_.obstacle.exists()) {
      if (options_.normal == Normal::foundation) {
        const auto into = direction_into(options_.obstacle, x);
        if (!into) return outside;
        nu = *into;
      }
      const auto distance = distance_along(options_.obstacle, x, nu);
      if (!distance) return outside;
      gap = *distance;
    } else {
      gap = options_.gap(x);
    }
    const double e = inner(u, nu) - gap - std::max(room, 0.);
    return std::isfinite(e) ? e : outside;
  }

  /// Twice the energy per area that it takes to push a part of a facet out of the foundation: a layer of the body as deep as the part is wide
  /// gives way, in series with the foundation. (3.16)
  double pushed_out(const double depth, const double modulus, const double width, const Point &x) const
  {
    const double stiffness = 1 / (width / modulus + 1 / options_.stiffness(x)), yield = options_.yield_stress(x);
    if (stiffness * depth <= yield) return stiffness * depth * depth;
    return 2 * yield * depth - yield * yield / stiffness;
  }

  const ContactOptions &options_;
  const FacetRows &rows_;
  const Lattice &lattice_;
  bool axisymmetric_;
};

/// Into how many parts the edges of a side's facets are divided.
/// @param num_facets  over all ranks
int parts_of(const mesh::Element &facet, const GO num_facets)
{
  const double facets = std::max(1., double(num_facets)),
               wanted = facet.dim == 1 ? Density::in_plane : Density::in_space;
  return std::max(Density::fewest_parts, static_cast<int>(std::ceil(std::pow(wanted / facets, 1. / facet.dim))));
}

/// Whether nothing can lie between the nodes of flat facets: u and the gap are linear between them.
bool is_linear(const mesh::Element &facet, const ContactOptions &options)
{
  const bool plane =
      options.obstacle.exists() ? std::holds_alternative<Plane>(*options.obstacle.surface) : options.gap.is_constant();
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

/// Looks at the facets of one side. @return twice the energy of its unseen facets, of this rank [J]
double look_at_side(const fem::Discretization &d, const mesh::Side &side, const ContactOptions &options,
                    const ContactNodes &points, const fem::Materials &materials, const Vector &u, const int k,
                    const double least, ContactResult &result, BetweenNodes &mine)
{
  const mesh::Mesh &mesh = *d.mesh;
  const mesh::Element facet = mesh.element.facet();
  const FacetRows rows = facet_rows(d, side, at_overlap_nodes(d, points, result, k), u);
  const LO num_facets = static_cast<LO>(rows.cell.extent(0));
  GO owned = 0;
  for (LO f = 0; f < num_facets; ++f) owned += rows.cell(f) < mesh.num_owned_cells ? 1 : 0;
  const int parts = parts_of(facet, sum_all(mesh.comm(), owned));
  const Lattice lattice = lattice_of(facet, parts);
  const SideSamples samples(options, rows, lattice, d.axisymmetric());
  const auto block = to_host(mesh.block);
  const auto lame = to_host(fem::lame_table(d, materials));
  std::vector<double> squared(num_facets, 0.);
  double sum = 0;
  for (LO f = 0; f < num_facets; ++f) {
    if (rows.cell(f) >= mesh.num_owned_cells) continue;
    if (parts == Density::fewest_parts && !samples.is_near(f)) continue;
    const int of = block(rows.cell(f));
    const auto found = samples.look(f, lame(of, 0) + 2 * lame(of, 1), least);
    sum += squared[f] = found.squared;
    const PlaceBetweenNodes place{found.deepest, found.place, k, found.width, rows.size(f)};
    if (place.depth > mine.deepest.depth) mine.deepest = place;
    if (found.unseen && place.depth > mine.unseen.depth) mine.unseen = place;
  }
  result.between.unseen_squared.push_back(device_values(squared, "rpc::contact::unseen_squared"));
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
  const double least = rounding * mesh::diameter(*d.mesh);
  if (points.num_weightless > 0) mark_unseen_points(points, least, result);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    BetweenNodes mine;
    double squared = 0;
    if (is_linear(d.mesh->element.facet(), options[k]))
      result.between.unseen_squared.push_back(
          DeviceView<double *>("rpc::contact::unseen_squared", sides[k]->facets.extent(0)));
    else
      squared = look_at_side(d, *sides[k], options[k], points, materials, u, static_cast<int>(k), least, result, mine);
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

std::string unseen_contact_note(const ContactResult &result, const std::vector<ContactOptions> &options, const int dim,
                                const double energy_norm_squared)
{
  const PlaceBetweenNodes &at = result.between.unseen;
  const double squared = 2 * result.total.unseen_energy;
  if (!(at.depth > 0) || !(squared > notable * notable * energy_norm_squared)) return "";
  std::ostringstream text;
  text << std::setprecision(4) << "contact is there that the mesh does not see: at (" << at.place[0] << ", "
       << at.place[1];
  if (dim == 3) text << ", " << at.place[2];
  text << std::setprecision(2) << ") side \"" << options[at.side].side << "\" lies " << at.depth
       << " [m] inside the foundation, between contact points that are open, so that the contact force lacks it. The "
          "facet is "
       << at.facet << " [m] long there; cells of " << at.width / 2
       << " [m] would see it. Make the mesh finer there, or give \"Adapt->Target Relative Error\".";
  return text.str();
}

} // namespace rpc::contact
