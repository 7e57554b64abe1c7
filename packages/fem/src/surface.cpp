#include "rpc/fem/surface.hpp"

#include "around_nodes.hpp"
#include "kernels.hpp"

namespace rpc::fem
{

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
  const int points = d.reference.facet.num_points();
  const auto gradient = d.reference.facet.gradient;
  const auto weight = d.reference.facet.weight;
  const auto coords = d.mesh->coords;
  const auto facets = side.facets;
  DeviceView<double *> measure("rpc::fem::facet_measure", facets.extent(0) * points);
  Kokkos::parallel_for(
      "rpc::fem::facet_measure", device_range(static_cast<LO>(facets.extent(0))), KOKKOS_LAMBDA(const LO facet) {
        for (int q = 0; q < points; ++q)
          measure(facet * points + q) = weight(q) * norm(area_normal(coords, facets, facet, gradient, q));
      });
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
  const auto lid = surface.node;
  const auto weight = surface.weight;
  const auto normal = surface.normal;
  const auto coords = mesh.coords;
  const auto gradient = d.reference.facet_nodal.gradient;
  const auto rule = d.reference.facet_nodal.weight;
  Kokkos::parallel_for(
      "rpc::fem::surface_weights", device_range(count), KOKKOS_LAMBDA(const LO i) {
        for (std::size_t k = node_to_facets.row(lid(i)); k < node_to_facets.row(lid(i) + 1); ++k) {
          const LO f = node_to_facets.cell(k);
          const int a = place_in(facets, f, lid(i)); // the rule's points are the nodes
          const auto area = area_normal(coords, facets, f, gradient, a);
          weight(i) += rule(a) * norm(area);
          for (int c = 0; c < dim; ++c) normal(i, c) += (rule(a) > 0 ? rule(a) : 1) * area[c];
        }
      });
  LO bad = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::surface_normals", device_range(count),
      KOKKOS_LAMBDA(const LO i, LO &wrong) {
        double length = 0;
        for (int c = 0; c < dim; ++c) length += normal(i, c) * normal(i, c);
        length = math::sqrt(length);
        const int a = place_in(facets, node_to_facets.cell(node_to_facets.row(lid(i))), lid(i));
        if (!(weight(i) > 0 || rule(a) == 0) || !(length > 0)) ++wrong;
        for (int c = 0; c < dim; ++c) normal(i, c) /= length;
      },
      bad);
  const GO all_bad = sum_all(mesh.comm(), GO(bad));
  RPC_REQUIRE_CODE(all_bad == 0, ExitCode::bad_mesh,
                   "mesh: " << all_bad << " nodes of the side \"" << side.name
                            << "\" have no normal or no positive quadrature weight (degenerate facets)");
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
  const NodeToCells node_to_facets = around_nodes(facets, num_owned);
  const auto out = device_write(value);
  Kokkos::parallel_for(
      "rpc::fem::extend", device_range(num_owned), KOKKOS_LAMBDA(const LO n) {
        if (k(n, 0) != 0) return;
        double sum = 0, linear = 0;
        int count = 0, triangles = 0;
        for (std::size_t m = node_to_facets.row(n); m < node_to_facets.row(n + 1); ++m) {
          const LO f = node_to_facets.cell(m);
          for (int b = 0; b < nodes; ++b) {
            const LO other = facets(f, b);
            if (k(other, 0) == 0) continue;
            sum += v(other, 0);
            ++count;
          }
          if (!quadratic_triangles) continue;
          const int a = place_in(facets, f, n);
          if (a >= 3) continue; // a middle node
          // Middle node 3 + a lies between vertices a and a + 1.
          const LO beside = facets(f, 3 + a), before = facets(f, 3 + (a + 2) % 3),
                   opposite = facets(f, 3 + (a + 1) % 3);
          if (k(beside, 0) == 0 || k(before, 0) == 0 || k(opposite, 0) == 0) continue;
          linear += v(beside, 0) + v(before, 0) - v(opposite, 0);
          ++triangles;
        }
        out(n) = triangles > 0 ? linear / triangles : count > 0 ? sum / count : 0;
      });
  Kokkos::fence();
}

} // namespace rpc::fem
