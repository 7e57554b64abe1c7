#include "rpc/fem/reference_element.hpp"

#include "rpc/core/error.hpp"
#include "shape_functions.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace rpc::fem
{
namespace
{

struct Rule1d {
  std::vector<double> point, weight; // on [-1, 1]
};

Rule1d gauss(const int points)
{
  switch (points) {
  case 1:
    return {{0}, {2}};
  case 2:
    return {{-1 / std::sqrt(3.), 1 / std::sqrt(3.)}, {1, 1}};
  case 3:
    return {{-std::sqrt(0.6), 0, std::sqrt(0.6)}, {5. / 9, 8. / 9, 5. / 9}};
  case 4: {
    const double a = std::sqrt(3. / 7 - 2. / 7 * std::sqrt(1.2)), b = std::sqrt(3. / 7 + 2. / 7 * std::sqrt(1.2));
    const double wa = (18 + std::sqrt(30.)) / 36, wb = (18 - std::sqrt(30.)) / 36;
    return {{-b, -a, a, b}, {wb, wa, wa, wb}};
  }
  default:
    throw Error(ExitCode::internal_error, "fem::gauss: no rule of " + std::to_string(points) + " points");
  }
}

Rule1d lobatto(const int order)
{
  return order == 1 ? Rule1d{{-1, 1}, {1, 1}} : Rule1d{{-1, 0, 1}, {1. / 3, 4. / 3, 1. / 3}};
}

/// Nodes of a facet on its own lattice {0..order}^d, in the order of Element::facets.
std::vector<std::vector<int>> facet_lattice(const mesh::Element &element)
{
  if (element.dim == 3) return mesh::Element{2, element.order}.lattice();
  std::vector<std::vector<int>> nodes = {{0}, {element.order}};
  if (element.order == 2) nodes.push_back({1});
  return nodes;
}

BasisTable device_table(const HostView<double **> &value, const HostView<double ***> &gradient,
                        const HostView<double *> &weight)
{
  BasisTable table;
  table.value = DeviceView<double **>("rpc::fem::basis_value", value.extent(0), value.extent(1));
  table.gradient =
      DeviceView<double ***>("rpc::fem::basis_gradient", gradient.extent(0), gradient.extent(1), gradient.extent(2));
  table.weight = DeviceView<double *>("rpc::fem::quadrature_weight", weight.extent(0));
  const auto copy = [](const auto &device, const auto &host) { // layouts may differ
    auto mirror = Kokkos::create_mirror_view(device);
    Kokkos::deep_copy(mirror, host);
    Kokkos::deep_copy(device, mirror);
  };
  copy(table.value, value);
  copy(table.gradient, gradient);
  copy(table.weight, weight);
  return table;
}

/// Tensor product of a 1d rule; `lattice` (nodes, d) names the node of each shape function in each direction.
BasisTable tensor_table(const std::vector<std::vector<int>> &lattice, const int order, const Rule1d &rule)
{
  const int d = static_cast<int>(lattice[0].size()), nodes = static_cast<int>(lattice.size());
  const int n = static_cast<int>(rule.point.size());
  const int points = static_cast<int>(std::lround(std::pow(n, d)));
  HostView<double **> value("rpc::fem::value", points, nodes);
  HostView<double ***> gradient("rpc::fem::gradient", points, nodes, d);
  HostView<double *> weight("rpc::fem::weight", points);
  for (int q = 0; q < points; ++q) {
    std::vector<int> at(d);
    weight(q) = 1;
    for (int k = 0, rest = q; k < d; ++k, rest /= n) {
      at[k] = rest % n;
      weight(q) *= rule.weight[at[k]];
    }
    for (int a = 0; a < nodes; ++a) {
      value(q, a) = 1;
      for (int g = 0; g < d; ++g) gradient(q, a, g) = 1;
      for (int k = 0; k < d; ++k) {
        const Lagrange shape = lagrange(order, rule.point[at[k]]);
        const int node = lattice[a][k];
        value(q, a) *= shape.value[node];
        for (int g = 0; g < d; ++g) gradient(q, a, g) *= g == k ? shape.slope[node] : shape.value[node];
      }
    }
  }
  return device_table(value, gradient, weight);
}

struct TriangleRule {
  std::vector<std::array<double, 2>> point;
  std::vector<double> weight; // their sum is 1/2, the triangle's area
};

/// Symmetric rules of degree 1, 2 and 4.
TriangleRule triangle_rule(const int points)
{
  TriangleRule rule;
  const auto orbit = [&](const double a, const double weight) { // (a, a) and its images
    for (const auto &p : {std::array{a, a}, std::array{1 - 2 * a, a}, std::array{a, 1 - 2 * a}}) {
      rule.point.push_back(p);
      rule.weight.push_back(weight);
    }
  };
  if (points == 1) return {{{1. / 3, 1. / 3}}, {0.5}};
  if (points == 3) {
    orbit(1. / 6, 1. / 6);
  } else {
    // Two orbits whose moments up to degree 4 are the triangle's.
    const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), mean = 8 - std::sqrt(10.);
    const double w = std::sqrt(213125 - 53320 * std::sqrt(10.));
    orbit((mean + root) / 18, (620 + w) / 7440);
    orbit((mean - root) / 18, (620 - w) / 7440);
  }
  return rule;
}

template <int Nodes>
BasisTable triangle_table(const TriangleRule &rule)
{
  const int points = static_cast<int>(rule.weight.size());
  HostView<double **> value("rpc::fem::value", points, Nodes);
  HostView<double ***> gradient("rpc::fem::gradient", points, Nodes, 2);
  HostView<double *> weight("rpc::fem::weight", points);
  for (int q = 0; q < points; ++q) {
    const double X[2] = {rule.point[q][0], rule.point[q][1]};
    double N[Nodes], dN[Nodes][2];
    triangle_shapes(X, N, dN);
    weight(q) = rule.weight[q];
    for (int a = 0; a < Nodes; ++a) {
      value(q, a) = N[a];
      for (int g = 0; g < 2; ++g) gradient(q, a, g) = dN[a][g];
    }
  }
  return device_table(value, gradient, weight);
}

BasisTable triangle_table(const int order, const TriangleRule &rule)
{
  return order == 1 ? triangle_table<3>(rule) : triangle_table<6>(rule);
}

} // namespace

ReferenceElement tabulate(const mesh::Element &element)
{
  const int order = element.order;
  const auto on_facet = facet_lattice(element);
  ReferenceElement reference;
  reference.element = element;
  if (element.shape == mesh::Shape::simplex) {
    reference.cell = triangle_table(order, triangle_rule(order == 1 ? 1 : 3));
    reference.cell_load = triangle_table(order, triangle_rule(order == 1 ? 3 : 6));
    reference.recovery = reference.cell;
  } else {
    reference.cell = tensor_table(element.lattice(), order, gauss(order + 1));
    reference.cell_load = reference.cell;
    reference.recovery = tensor_table(element.lattice(), order, gauss(order));
  }
  reference.facet = tensor_table(on_facet, order, gauss(order + 2));

  // The points of the nodal rule must come in the order of the nodes, not of the tensor product.
  const Rule1d rule = lobatto(order);
  const BasisTable all = tensor_table(on_facet, order, rule);
  const auto value = to_host(all.value);
  const auto gradient = to_host(all.gradient);
  const auto weight = to_host(all.weight);
  const int nodes = all.num_points(), d = element.dim - 1;
  BasisTable &nodal = reference.facet_nodal;
  nodal.value = DeviceView<double **>("rpc::fem::nodal_value", nodes, nodes);
  nodal.gradient = DeviceView<double ***>("rpc::fem::nodal_gradient", nodes, nodes, d);
  nodal.weight = DeviceView<double *>("rpc::fem::nodal_weight", nodes);
  const auto value_to = Kokkos::create_mirror_view(nodal.value);
  const auto gradient_to = Kokkos::create_mirror_view(nodal.gradient);
  const auto weight_to = Kokkos::create_mirror_view(nodal.weight);
  for (int a = 0; a < nodes; ++a) {
    const int q = on_facet[a][0] + (d == 2 ? (order + 1) * on_facet[a][1] : 0);
    weight_to(a) = weight(q);
    for (int b = 0; b < nodes; ++b) {
      value_to(a, b) = value(q, b);
      for (int g = 0; g < d; ++g) gradient_to(a, b, g) = gradient(q, b, g);
    }
  }
  Kokkos::deep_copy(nodal.value, value_to);
  Kokkos::deep_copy(nodal.gradient, gradient_to);
  Kokkos::deep_copy(nodal.weight, weight_to);
  return reference;
}

} // namespace rpc::fem
