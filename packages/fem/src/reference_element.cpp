#include "rpc/fem/reference_element.hpp"

namespace rpc::fem
{

ReferenceElement tabulate(const mesh::Element &element)
{
  const int p = element.order;
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
  reference.cell = on_cell(mesh::stiffness_degree(element));
  reference.cell_load = on_cell(2 * p);
  reference.recovery = simplex ? reference.cell : on_cell(2 * p - 1);
  reference.facet = on_facet(2 * p + 2);
  reference.facet_nodal = tabulate(facet, mesh::nodal_rule(facet));
  return reference;
}

} // namespace rpc::fem
