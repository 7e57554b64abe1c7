// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/reference_element.hpp"

namespace rpc::fem
{

ReferenceElement tabulate(const mesh::Element &element, const Kinematics kinematics)
{
  const int p = element.order;
  const int stiffness_degree = mesh::stiffness_degree(element);
  const bool axisymmetric = kinematics == Kinematics::axisymmetric; // a factor r, and N_a N_b instead of their slopes
  const bool simplex = element.shape == mesh::Shape::simplex;
  const mesh::Element facet = element.facet();
  const auto on_cell = [&](const int degree) {
    return tabulate(element, mesh::quadrature(element.dim, element.shape, degree));
  };
  const auto on_facet = [&](const int degree) {
    return tabulate(facet, mesh::quadrature(facet.dim, facet.shape, degree));
  };
  ReferenceElement reference;
  reference.element = element;
  reference.cell = on_cell(stiffness_degree + (axisymmetric && simplex ? 2 : 0));
  reference.cell_load = on_cell(2 * p + (axisymmetric ? 1 : 0));
  reference.recovery = on_cell(simplex ? stiffness_degree : 2 * p - 1);
  reference.facet = on_facet(2 * p + 2);
  reference.facet_nodal = tabulate(facet, mesh::nodal_rule(facet));
  return reference;
}

} // namespace rpc::fem
