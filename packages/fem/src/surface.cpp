// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/surface.hpp"

#include "around_nodes.hpp"
#include "kernels.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/measure.hpp"

namespace rpc::fem
{
namespace
{

/// Integration weight of a facet's point: the rule's weight times the area element, times 2 pi r in axisymmetry.
struct FacetPoints {
  DeviceView<double **> coords;    // (overlap nodes, dim)          [m]  in
  DeviceView<LO **> facets;        // (facets, nodes)                    in, rows of coords
  DeviceView<double **> value;     // (points, nodes)                    in
  DeviceView<double ***> gradient; // (points, nodes, dim - 1)           in
  DeviceView<double *> weight;     // (points)                           in
  bool axisymmetric;

  int num_points() const { return static_cast<int>(weight.extent(0)); }
  /// Outward normal times the area, in the plane the length.
  KOKKOS_INLINE_FUNCTION Kokkos::Array<double, 3> in_mesh(const LO facet, const int q) const
  {
    auto area = area_normal(coords, facets, facet, gradient, q);
    for (int c = 0; c < 3; ++c) area[c] *= weight(q);
    return area;
  }
  /// What an area or length of the mesh is to be multiplied with [1, or m].
  KOKKOS_INLINE_FUNCTION double across(const LO facet, const int q) const
  {
    if (!axisymmetric) return 1;
    double r = 0;
    for (std::size_t a = 0; a < facets.extent(1); ++a) r += value(q, a) * coords(facets(facet, a), 0);
    return circle(r);
  }
};

FacetPoints facet_points(const Discretization &d, const mesh::Side &side, const BasisTable &table)
{
  return {d.mesh->coords, side.places(), table.value, table.gradient, table.weight, d.axisymmetric()};
}

/// The rule of nodal quadrature: one whose points are the nodes, or that of int N_a where this would not meet a constant pressure: with
/// order 1 in axisymmetry, where Lobatto's points would also leave out the axis, and on quadrilaterals that are no parallelograms. (2.7a)
const BasisTable &nodal_rule(const Discretization &d)
{
  const mesh::Element facet = d.mesh->element.facet();
  const bool varies =
      d.axisymmetric() || (facet.dim == 2 && facet.shape == mesh::Shape::tensor); // the area along a facet
  return varies && facet.order == 1 ? d.reference.facet : d.reference.facet_nodal;
}

/// A weight that is less of the facets' areas is rounding: the node has none.
constexpr double least_share = 1e-12;

} // namespace

HostPoints node_positions(const mesh::Mesh &mesh, const DeviceView<LO *> &node)
{
  const DeviceView<double **> points("rpc::fem::node_positions", node.extent(0), mesh.dim());
  const auto coords = mesh.coords;
  Kokkos::parallel_for(
      "rpc::fem::node_positions", device_range(static_cast<LO>(node.extent(0))), KOKKOS_LAMBDA(const LO i) {
        for (std::size_t c = 0; c < coords.extent(1); ++c) points(i, c) = coords(node(i), c);
      });
  return to_host(points);
}

DeviceView<double *> facet_measure(const Discretization &d, const mesh::Side &side)
{
  const FacetPoints rule = facet_points(d, side, d.reference.facet);
  const int points = rule.num_points();
  DeviceView<double *> measure("rpc::fem::facet_measure", side.facets.extent(0) * points);
  Kokkos::parallel_for(
      "rpc::fem::facet_measure", device_range(static_cast<LO>(side.facets.extent(0))), KOKKOS_LAMBDA(const LO facet) {
        for (int q = 0; q < points; ++q)
          measure(facet * points + q) = norm(rule.in_mesh(facet, q)) * rule.across(facet, q);
      });
  return measure;
}

DeviceView<double *> facet_size(const Discretization &d, const mesh::Side &side)
{
  const FacetPoints rule = facet_points(d, side, d.reference.facet);
  const int points = rule.num_points(), dim = d.dim();
  DeviceView<double *> size("rpc::fem::facet_size", side.facets.extent(0));
  Kokkos::parallel_for(
      "rpc::fem::facet_size", device_range(static_cast<LO>(side.facets.extent(0))), KOKKOS_LAMBDA(const LO facet) {
        for (int q = 0; q < points; ++q) size(facet) += norm(rule.in_mesh(facet, q));
        if (dim == 3) size(facet) = math::sqrt(size(facet));
      });
  return size;
}

SideMeasure side_measure(const Discretization &d, const mesh::Side &side)
{
  const FacetPoints rule = facet_points(d, side, d.reference.facet);
  const int points = rule.num_points();
  const LO num_owned_cells = d.mesh->num_owned_cells;
  const auto cell = side.cell;
  std::vector<double> sums(5, 0.); // area, area in the mesh, normals times that
  for (int k = 0; k < 5; ++k)
    Kokkos::parallel_reduce(
        "rpc::fem::side_measure", device_range(static_cast<LO>(side.facets.extent(0))),
        KOKKOS_LAMBDA(const LO facet, double &sum) {
          if (cell(facet) >= num_owned_cells) return; // another rank has it
          for (int q = 0; q < points; ++q) {
            const auto normal = rule.in_mesh(facet, q);
            sum += k == 0 ? norm(normal) * rule.across(facet, q) : k == 1 ? norm(normal) : normal[k - 2];
          }
        },
        sums[k]);
  sums = summed(d.mesh->comm(), sums);
  SideMeasure measure{sums[0]};
  for (int c = 0; c < 3; ++c) measure.normal[c] = sums[1] > 0 ? sums[2 + c] / sums[1] : 0;
  return measure;
}

SurfaceNodes surface_nodes(const Discretization &d, const mesh::Side &side)
{
  const mesh::Mesh &mesh = *d.mesh;
  const LO num_owned = mesh.num_owned_nodes();
  const int dim = d.dim();
  const auto facets = side.facets;
  const NodeToCells node_to_facets = around_nodes(facets, num_owned);
  LO count = 0;
  DeviceView<LO *> node(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::surface_node"), num_owned);
  Kokkos::parallel_scan(
      "rpc::fem::number_surface", device_range(num_owned),
      KOKKOS_LAMBDA(const LO n, LO &sum, const bool last) {
        const bool present = node_to_facets.row(n) < node_to_facets.row(n + 1);
        if (last && present) node(sum) = n;
        sum += present;
      },
      count);

  SurfaceNodes surface;
  surface.node = DeviceView<LO *>("rpc::fem::surface_node", count);
  Kokkos::deep_copy(surface.node, Kokkos::subview(node, Kokkos::make_pair(LO(0), count)));
  surface.weight = DeviceView<double *>("rpc::fem::surface_weight", count);
  surface.normal = DeviceView<double **>("rpc::fem::surface_normal", count, dim);
  const SurfaceNodes to = surface;
  const FacetPoints rule = facet_points(d, side, nodal_rule(d));
  const int points = rule.num_points();
  LO bad = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::surface_weights", device_range(count),
      KOKKOS_LAMBDA(const LO i, LO &wrong) {
        const LO n = to.node(i);
        double size = 0, sum = 0, weighted[3] = {}, plain[3] = {};
        for (std::size_t k = node_to_facets.row(n); k < node_to_facets.row(n + 1); ++k) {
          const LO f = node_to_facets.cell(k);
          const int a = place_in(facets, f, n);
          for (int q = 0; q < points; ++q) {
            const auto area = rule.in_mesh(f, q);
            const double across = rule.across(f, q), share = rule.value(q, a) * across;
            size += norm(area) * across;
            sum += share * norm(area);
            for (int c = 0; c < dim; ++c) {
              weighted[c] += share * area[c];
              plain[c] += area[c];
            }
          }
        }
        const bool has_weight = sum > least_share * size;
        to.weight(i) = has_weight ? sum : 0;
        double length = 0;
        for (int c = 0; c < dim; ++c) {
          to.normal(i, c) = has_weight ? weighted[c] : plain[c];
          length += to.normal(i, c) * to.normal(i, c);
        }
        length = math::sqrt(length);
        if (!(size > 0) || !(length > 0)) ++wrong;
        for (int c = 0; c < dim; ++c) to.normal(i, c) /= length;
      },
      bad);
  const GO all_bad = sum_all(mesh.comm(), GO(bad));
  RPC_REQUIRE_CODE(all_bad == 0, ExitCode::bad_mesh,
                   "mesh: " << all_bad << " nodes of the side \"" << side.name
                            << "\" have no normal or no positive quadrature weight (degenerate facets"
                            << (d.axisymmetric() ? ", or facets on the axis, which is no surface)" : ")"));
  return surface;
}

void extend_to_unknown(const Discretization &d, const mesh::Side &side, Vector &value, const Vector &known)
{
  const mesh::Mesh &mesh = *d.mesh;
  const LO num_owned = mesh.num_owned_nodes();
  const auto value_overlap = nodes_on_overlap(d, Teuchos::rcpFromRef<const MultiVector>(value));
  const auto known_overlap = nodes_on_overlap(d, Teuchos::rcpFromRef<const MultiVector>(known));
  const auto v = value_overlap->getLocalViewDevice(Tpetra::Access::ReadOnly); // in one process that of `value`: nodes
  const auto k = known_overlap->getLocalViewDevice(Tpetra::Access::ReadOnly); // are either read or written
  const auto facets = side.facets;
  const int nodes = static_cast<int>(facets.extent(1));
  const mesh::Element facet = mesh.element.facet();
  const bool quadratic_triangles = facet.dim == 2 && facet.shape == mesh::Shape::simplex && facet.order == 2;
  const bool quadratic_edges = facet.dim == 1 && facet.order == 2;
  const double axis = d.axisymmetric() ? d.on_axis : -1; // nodes with r up to this lie on it
  const auto coords = mesh.coords;
  const NodeToCells node_to_facets = around_nodes(facets, num_owned);
  const auto out = device_write(value);
  Kokkos::parallel_for(
      "rpc::fem::extend", device_range(num_owned), KOKKOS_LAMBDA(const LO n) {
        if (k(n, 0) != 0) return;
        double sum = 0, through = 0;
        int count = 0, functions = 0;
        for (std::size_t m = node_to_facets.row(n); m < node_to_facets.row(n + 1); ++m) {
          const LO f = node_to_facets.cell(m);
          for (int b = 0; b < nodes; ++b) {
            const LO other = facets(f, b);
            if (k(other, 0) == 0) continue;
            sum += v(other, 0);
            ++count;
          }
          const int a = place_in(facets, f, n);
          if (quadratic_edges && a < 2 && k(facets(f, 2), 0) != 0 && k(facets(f, 1 - a), 0) != 0) {
            const double middle = v(facets(f, 2), 0), far = v(facets(f, 1 - a), 0);
            // On the axis a smooth function has no slope.
            through += coords(n, 0) <= axis ? (4 * middle - far) / 3 : 2 * middle - far;
            ++functions;
          }
          if (!quadratic_triangles) continue;
          if (a >= 3) continue; // a middle node
          // Middle node 3 + a lies between vertices a and a + 1.
          const LO beside = facets(f, 3 + a), before = facets(f, 3 + (a + 2) % 3),
                   opposite = facets(f, 3 + (a + 1) % 3);
          if (k(beside, 0) == 0 || k(before, 0) == 0 || k(opposite, 0) == 0) continue;
          through += v(beside, 0) + v(before, 0) - v(opposite, 0);
          ++functions;
        }
        out(n) = functions > 0 ? through / functions : count > 0 ? sum / count : 0;
      });
  Kokkos::fence();
}

} // namespace rpc::fem
