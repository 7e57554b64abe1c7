// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/mesh.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <regex>

namespace rpc::mesh
{

namespace
{

/// The part of a mesh that has a name; null if there is none.
template <class Part>
const Part *find(const std::vector<Part> &parts, const std::string &name)
{
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const Part &part) { return part.name == name; });
  return found == parts.end() ? nullptr : &*found;
}

template <class Part>
std::vector<std::string> names_of(const std::vector<Part> &parts)
{
  std::vector<std::string> names;
  for (const Part &part : parts) names.push_back(part.name);
  return names;
}

/// @param user  path of the parameter: of an entry "Traction->top->Side" that may have its side by its name
std::string no_such_side(const std::string &user, const std::string &name)
{
  const std::string own_name = "->" + name + "->Side";
  const bool by_its_name =
      user.size() > own_name.size() && user.compare(user.size() - own_name.size(), own_name.size(), own_name) == 0;
  const std::string which = "\" names the side \"" + name + "\", which the mesh does not have. ";
  if (!by_its_name) return "deck: \"" + user + which;
  const std::string entry = user.substr(0, user.rfind("->"));
  return "deck: \"" + entry + which + "Name the entry after a side, or write the side into it as \"Side\". ";
}

/// What is meant, or where there are several names in one.
std::string side_remedy(const std::string &user, const std::string &name, const std::vector<std::string> &known)
{
  static const std::regex mark(R"([,;|+&{}\[\]]|\sand\s)"), blank(R"(\s)");
  for (const std::regex *const between : {&mark, &blank}) {
    std::vector<std::string> found;
    std::size_t parts = 0;
    for (auto at = std::sregex_token_iterator(name.begin(), name.end(), *between, -1);
         at != std::sregex_token_iterator(); ++at) {
      const auto first = at->str().find_first_not_of(" \""), last = at->str().find_last_not_of(" \"");
      if (first == std::string::npos) continue;
      ++parts;
      const std::string part = at->str().substr(first, last - first + 1);
      const std::string nearest = nearest_name(part, known);
      if (!nearest.empty()) found.push_back("\"" + nearest + "\"");
    }
    if (parts < 2 || found.empty() || (between == &blank && found.size() < parts)) continue;
    return " One entry has one side: write an entry each for " + join(found) +
           (user.rfind("Contact", 0) == 0 ? ", in \"Contact->Sides\"." : ".");
  }
  return did_you_mean(name, known);
}

/// What to do where a file has no such side: a box has its own.
std::string remedy_for_sides(const Mesh &mesh)
{
  if (mesh.box && periodic(*mesh.box)) return "; \"Mesh->Periodic\" joins the others, which are no sides then";
  return mesh.box ? "" : "; \"Mesh->Sides\" chooses others by place or number";
}

} // namespace

const Side &Mesh::side(const std::string &name, const std::string &user) const
{
  if (const Side *const found = find(sides, name)) return *found;
  const std::string others =
      sides.empty() ? "It has no sides; name them, in gmsh by Physical Curve, of bodies in space by Physical Surface"
                    : "Its sides: " + join(names_of(sides));
  throw Error(ExitCode::bad_input, no_such_side(user, name) + others + remedy_for_sides(*this) + "." +
                                       side_remedy(user, name, names_of(sides)));
}

RCP<const Map> Mesh::overlap_nodes() const
{
  if (comm().getSize() == 1) return owned_nodes;
  std::vector<GO> gids(num_owned_nodes());
  if (!gids.empty()) std::iota(gids.begin(), gids.end(), owned_nodes->getMinGlobalIndex());
  gids.insert(gids.end(), ghosts.begin(), ghosts.end());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), Teuchos::ArrayView<const GO>(gids), 0,
                     owned_nodes->getComm()));
}

std::vector<LO> Mesh::nodes_of(const std::string &name, const std::string &user) const
{
  if (!find(sides, name)) {
    std::vector<std::string> both = names_of(sides);
    const std::vector<std::string> of_points = names_of(points);
    both.insert(both.end(), of_points.begin(), of_points.end());
    if (const PointSet *const set = find(points, name)) return set->node;
    if (!points.empty())
      throw Error(ExitCode::bad_input, no_such_side(user, name) + "Its sides: " + join(names_of(sides)) +
                                           "; its points: " + join(of_points) + remedy_for_sides(*this) + "." +
                                           side_remedy(user, name, both));
  }
  const auto facets = to_host(side(name, user).facets);
  std::vector<LO> nodes;
  for (std::size_t f = 0; f < facets.extent(0); ++f)
    for (std::size_t a = 0; a < facets.extent(1); ++a)
      if (facets(f, a) < num_owned_nodes()) nodes.push_back(facets(f, a));
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

Side make_side(const std::string &name, const Mesh &mesh, const HostView<LO *> &cell, const HostView<int *> &ordinal)
{
  const Element &element = mesh.element;
  // Facets of a mixed element differ: the side of a box has facets of one kind.
  const std::size_t kind = cell.extent(0) > 0 ? ordinal(0) : 0;
  const int num_nodes = static_cast<int>(element.facets()[kind].size());
  HostView<int **> host("rpc::mesh::facet_nodes", element.num_facets(), num_nodes);
  for (int f = 0; f < element.num_facets(); ++f)
    for (int a = 0; a < num_nodes; ++a)
      host(f, a) = a < static_cast<int>(element.facets()[f].size()) ? element.facets()[f][a] : -1;
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
  if (mesh.place.extent(0) > 0) {
    side.place = DeviceView<LO **>("rpc::mesh::side_places", cell.extent(0), num_nodes);
    const auto place_in_cell = mesh.place, place = side.place;
    Kokkos::parallel_for(
        "rpc::mesh::side_places", device_range(static_cast<LO>(cell.extent(0))), KOKKOS_LAMBDA(const LO f) {
          for (int a = 0; a < num_nodes; ++a) place(f, a) = place_in_cell(of_cell(f), local(of_ordinal(f), a));
        });
  }
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
        "rpc::mesh::extent", device_range(static_cast<LO>(coords.extent(0))), // images, too
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
