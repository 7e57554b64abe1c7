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
