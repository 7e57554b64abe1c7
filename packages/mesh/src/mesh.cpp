#include "rpc/mesh/mesh.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <cmath>

namespace rpc::mesh
{

const Side &Mesh::side(const std::string &name, const std::string &user) const
{
  std::vector<std::string> names;
  for (const auto &candidate : sides) {
    if (candidate.name == name) return candidate;
    names.push_back(candidate.name);
  }
  throw Error(ExitCode::bad_input, "deck: \"" + user + "\" names the side \"" + name +
                                       "\", which the mesh does not have. Its sides: " + join(names) + ".");
}

Side make_side(const std::string &name, const Mesh &mesh, const HostView<LO *> &cell, const HostView<int *> &ordinal)
{
  const Element &element = mesh.element;
  const int num_nodes = element.num_facet_nodes();
  HostView<int **> host("rpc::mesh::facet_nodes", element.num_facets(), num_nodes);
  for (int f = 0; f < element.num_facets(); ++f)
    for (int a = 0; a < num_nodes; ++a) host(f, a) = element.facets()[f][a];
  Side side{name, DeviceView<LO **>("rpc::mesh::side_facets", cell.extent(0), num_nodes), to_device(cell),
            to_device(ordinal)};
  const auto local = to_device(host);
  const auto cells = mesh.cells;
  const auto nodes = side.facets;
  const auto of_cell = side.cell;
  const auto of_ordinal = side.ordinal;
  Kokkos::parallel_for(
      "rpc::mesh::side_facets", device_range(static_cast<LO>(cell.extent(0))), KOKKOS_LAMBDA(const LO f) {
        for (int a = 0; a < num_nodes; ++a) nodes(f, a) = cells(of_cell(f), local(of_ordinal(f), a));
      });
  Kokkos::fence();
  return side;
}

double diameter(const Mesh &mesh)
{
  const auto coords = mesh.coords;
  double squares = 0;
  for (int d = 0; d < mesh.dim(); ++d) {
    double low = 0, high = 0;
    Kokkos::parallel_reduce(
        "rpc::mesh::extent", device_range(mesh.num_local_nodes()),
        KOKKOS_LAMBDA(const LO n, double &least, double &most) {
          if (coords(n, d) < least) least = coords(n, d);
          if (coords(n, d) > most) most = coords(n, d);
        },
        Kokkos::Min<double>(low), Kokkos::Max<double>(high));
    const double extent = max_all(mesh.comm(), high) - min_all(mesh.comm(), low);
    squares += extent * extent;
  }
  return std::sqrt(squares);
}

} // namespace rpc::mesh
