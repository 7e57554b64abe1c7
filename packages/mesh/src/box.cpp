// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box.hpp"

#include "box_divisions.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/gpu_memory.hpp"
#include "rpc/core/memory.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/mesh/box_grid.hpp"
#include "rpc/mesh/box_parts.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace rpc::mesh
{
namespace
{

using Teuchos::Array;

/// What "Mesh->Periodic" may be.
constexpr std::pair<const char *, std::array<bool, 3>> periodic_words[] = {
    {"none", {false, false, false}}, {"X", {true, false, false}},   {"Y", {false, true, false}},
    {"Z", {false, false, true}},     {"X, Y", {true, true, false}}, {"X, Z", {true, false, true}},
    {"Y, Z", {false, true, true}}};

/// A side of a box: its direction, upper or lower end.
struct BoxSide {
  const char *name;
  int direction;
  bool upper;
};
constexpr std::array<BoxSide, 6> box_sides{{{"left", 0, false},
                                            {"right", 0, true},
                                            {"bottom", 1, false},
                                            {"top", 1, true},
                                            {"back", 2, false},
                                            {"front", 2, true}}};

/// A facet of a part of a lattice cell.
struct PartFacet {
  int part, ordinal;
};

/// Those on one side of the lattice cell.
std::vector<PartFacet> facets_on(const Element &element, const BoxParts &parts, const BoxSide &side)
{
  const int end = side.upper ? element.order_along(side.direction) : 0;
  std::vector<PartFacet> found;
  for (int part = 0; part < static_cast<int>(parts.size()); ++part)
    for (int ordinal = 0; ordinal < element.num_facets(); ++ordinal) {
      const auto &facet = element.facets()[ordinal];
      if (std::all_of(facet.begin(), facet.end(), [&](const int a) { return parts[part][a][side.direction] == end; }))
        found.push_back({part, ordinal});
    }
  return found;
}

/// Numbers and places of one rank's nodes and cells, for kernels.
struct Numbering {
  Block owned_nodes, local_nodes, owned_cells;
  Block positions;           // those of nodes and their images
  DeviceView<LO *> node_lid; // (positions) node, or place of an image, at a position
  DeviceView<Index *> ghost; // (ghost nodes, then images) position
  DeviceView<Index *> halo;  // (ghost cells) position
  LO num_owned_cells = 0;

  KOKKOS_INLINE_FUNCTION LO lid_of(const Index &node) const { return node_lid(positions.index_of(node)); }
  KOKKOS_INLINE_FUNCTION Index node_at(const LO lid) const
  {
    const LO owned = static_cast<LO>(owned_nodes.size());
    return lid < owned ? owned_nodes.at(lid) : ghost(lid - owned);
  }
  KOKKOS_INLINE_FUNCTION Index cell_at(const LO cell) const
  {
    return cell < num_owned_cells ? owned_cells.at(cell) : halo(cell - num_owned_cells);
  }
};

DeviceView<Index *> device_positions(const std::vector<Index> &positions, const std::string &label)
{
  HostView<Index *> host(label, positions.size());
  std::copy(positions.begin(), positions.end(), host.data());
  return to_device(host);
}

/// @param num_places  of nodes and images
void number_nodes(Numbering &numbering, const LO num_places)
{
  numbering.node_lid = DeviceView<LO *>("rpc::mesh::node_lid", numbering.positions.size());
  const Numbering n = numbering;
  Kokkos::parallel_for(
      "rpc::mesh::number_box_nodes", device_range(num_places),
      KOKKOS_LAMBDA(const LO lid) { n.node_lid(n.positions.index_of(n.node_at(lid))) = lid; });
}

void fill_coords(const Numbering &n, const BoxOptions &options, const DeviceView<double **> &coords)
{
  Kokkos::Array<DeviceView<double *>, 3> ends{};
  Kokkos::Array<double, 3> lower{}, upper{}, last_cell{}, last_length{}, orders{};
  const int dim = options.element.dim;
  for (int d = 0; d < dim; ++d) {
    orders[d] = options.element.order_along(d);
    lower[d] = options.lower[d];
    upper[d] = options.upper[d];
    last_cell[d] = options.cells[d] - 1;
    last_length[d] = options.last_in(d);
    if (options.graded(d)) ends[d] = device_values(options.ends[d], "rpc::mesh::cell_ends");
  }
  Kokkos::parallel_for(
      "rpc::mesh::box_coords", device_range(static_cast<LO>(coords.extent(0))), KOKKOS_LAMBDA(const LO lid) {
        const Index at = n.node_at(lid);
        for (int d = 0; d < dim; ++d) { // both ends exact
          const double order = orders[d];
          if (ends[d].extent(0) > 0) {
            const GO nodes = static_cast<GO>(order), cell = at[d] / nodes;
            const double within = static_cast<double>(at[d] % nodes) / order;
            coords(lid, d) = within > 0 ? (1 - within) * ends[d](cell) + within * ends[d](cell + 1) : ends[d](cell);
            continue;
          }
          const double beyond = at[d] - order * last_cell[d]; // nodes in the last cell
          const double along = beyond > 0 ? order * last_cell[d] + last_length[d] * beyond : at[d];
          const double t = along / (order * (last_cell[d] + last_length[d]));
          coords(lid, d) = (1 - t) * lower[d] + t * upper[d];
        }
      });
}

/// @param places  where the nodes of cells lie; empty where there are no images
void fill_cells(const Numbering &n, const Grid &grid, const Element &element, const BoxParts &parts,
                const DeviceView<LO **> &cells, const DeviceView<LO **> &places)
{
  const int nodes = element.num_nodes(), dim = element.dim;
  Kokkos::Array<int, 3> order{};
  for (int d = 0; d < dim; ++d) order[d] = element.order_along(d);
  const int num_parts = static_cast<int>(parts.size());
  HostView<int ***> place_host("rpc::mesh::place_in_lattice_cell", num_parts, nodes, dim);
  for (int part = 0; part < num_parts; ++part)
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < dim; ++d) place_host(part, a, d) = parts[part][a][d];
  const auto place = to_device(place_host);
  const bool images = places.extent(0) > 0;
  Kokkos::parallel_for(
      "rpc::mesh::box_cells", device_range(static_cast<LO>(cells.extent(0))), KOKKOS_LAMBDA(const LO cell) {
        const Index corner = n.cell_at(cell / num_parts);
        for (int a = 0; a < nodes; ++a) {
          Index node{};
          for (int d = 0; d < dim; ++d) node[d] = order[d] * corner[d] + place(cell % num_parts, a, d);
          cells(cell, a) = n.lid_of(images ? grid.node_of(node) : node);
          if (images) places(cell, a) = n.lid_of(node);
        }
      });
}

Side side_of_box(const BoxSide &box_side, const BoxParts &parts, const Grid &grid, const Numbering &numbering,
                 const std::vector<Index> &halo, const Block &local_cells, const Mesh &mesh)
{
  // Only this rank's cells along the side are visited.
  Block layer = local_cells;
  const int d = box_side.direction;
  const GO at_end = box_side.upper ? grid.num_cells(d) - 1 : 0;
  const GO plane =
      box_side.upper ? mesh.element.order_along(d) * (at_end + 1) : 0; // of nodes: a halo cell may reach it alone
  const bool present = numbering.owned_nodes.begin[d] <= plane && plane < numbering.owned_nodes.end[d];
  layer.begin[d] = at_end;
  layer.end[d] = present ? at_end + 1 : at_end;

  const auto halo_cell = [&](const GO position) { // the halo is in the order of positions in local_cells
    const auto found = std::lower_bound(halo.begin(), halo.end(), position, [&](const Index &cell, const GO sought) {
      return local_cells.index_of(cell) < sought;
    });
    return numbering.num_owned_cells + static_cast<LO>(found - halo.begin());
  };
  const Element &element = mesh.element;
  const std::vector<PartFacet> in_cell = facets_on(element, parts, box_side);
  std::vector<LO> cells;
  std::vector<int> ordinals;
  for (GO at_layer = 0; at_layer < layer.size(); ++at_layer) {
    const Index at = layer.at(at_layer);
    const bool owned = numbering.owned_cells.contains(at);
    const LO lattice_cell =
        owned ? static_cast<LO>(numbering.owned_cells.index_of(at)) : halo_cell(local_cells.index_of(at));
    for (const auto &[part, facet] : in_cell) {
      const auto owns_node = [&, &place = parts[part]](const int a) {
        Index node{};
        for (int k = 0; k < element.dim; ++k) node[k] = element.order_along(k) * at[k] + place[a][k];
        return numbering.owned_nodes.contains(grid.node_of(node));
      };
      const auto &nodes = element.facets()[facet];
      if (!owned && std::none_of(nodes.begin(), nodes.end(), owns_node)) continue;
      cells.push_back(static_cast<LO>(parts.size()) * lattice_cell + part);
      ordinals.push_back(facet);
    }
  }
  HostView<LO *> cell("rpc::mesh::side_cell", cells.size());
  HostView<int *> ordinal("rpc::mesh::side_ordinal", cells.size());
  std::copy(cells.begin(), cells.end(), cell.data());
  std::copy(ordinals.begin(), ordinals.end(), ordinal.data());
  return make_side(box_side.name, mesh, cell, ordinal);
}

/// The corners of a box, named after the sides that meet there.
/// @param last  node of the lattice in each direction
std::vector<PointSet> corners_of_box(const Numbering &numbering, const Index &last, const int dim)
{
  std::vector<PointSet> corners;
  for (int corner = 0; corner < 1 << dim; ++corner) {
    PointSet set;
    Index at{};
    for (const BoxSide &side : box_sides) {
      const bool upper = (corner >> side.direction) % 2 == 1;
      if (side.direction >= dim || side.upper != upper) continue;
      set.name += (set.name.empty() ? "" : " ") + std::string(side.name);
      at[side.direction] = upper ? last[side.direction] : 0;
    }
    if (numbering.owned_nodes.contains(at)) set.node = {static_cast<LO>(numbering.owned_nodes.index_of(at))};
    corners.push_back(set);
  }
  return corners;
}

/// What a run takes for each of a rank's nodes at least [B]: mesh, fields and coarser meshes. There is no matrix of the finest mesh.
/// Measured on a host: P1, Q1, P2, Q2 in the plane 710, 720, 680, 720, in space 1190, 1300, 1090, 1320. Of an H100 of 80 GB 53
/// million nodes of Q1 in space do not take all, and 67 million do not fit.
double bytes_per_node(const Element &element)
{
  if (element.dim == 2) return 600;
  return on_gpu ? 1300 : 1000;
}

/// Refuses a box that could only run out of memory later; collective.
void require_memory(const BoxOptions &options, const GO nodes_of_rank, const GO nodes_of_all, const Comm &comm)
{
  const double bytes = bytes_per_node(options.element);
  auto refusal = memory_refusal(nodes_of_rank, bytes, memory_limit(), "memory");
  constexpr double surely_enough = 4e9; // of any GPU: the ranks need not be asked who shares one
  if (on_gpu && bytes * static_cast<double>(nodes_of_all) > surely_enough) {
    const double limit = gpu_memory_limit(comm);
    if (!refusal) refusal = memory_refusal(nodes_of_rank, bytes, limit, "the GPU's memory");
  }
  throw_if_any(comm, ExitCode::bad_input, refusal);
}

} // namespace

void add_box_parameters(Teuchos::ParameterList &valid)
{
  valid.set("Lower", Array<double>(Teuchos::tuple(0., 0.)), "Lower corner of the box, 2 or 3 numbers [m].");
  valid.set("Upper", Array<double>(Teuchos::tuple(1., 1.)),
            "Upper corner of the box, above the lower one in each direction [m].");
  valid.set("Cells", Array<int>(Teuchos::tuple(8, 8)), "Number of cells in each direction, > 0.");
  valid.set("Expansion Ratio", Array<double>(Teuchos::tuple(1., 1.)),
            "Length of the last cell over that of the first in each direction, from 1e-4 to 1e4: lengths of the cells "
            "are in geometric progression from the lower to the upper end. 1: equal cells.");
  set_words(
      valid, "Element", {"Q1", "Q2", "P1", "P2"},
      "Element of the box: `Q1`, `Q2` (quadrilaterals, in 3D hexahedra), `P1`, `P2` (two triangles to a cell, in 3D "
      "six tetrahedra).");
  std::vector<std::string> words;
  for (const auto &[word, directions] : periodic_words) words.emplace_back(word);
  set_words(valid, "Periodic", words,
            "Directions in which the box repeats itself: `X` makes the nodes of the right side those of the left one, "
            "`Y` joins bottom and top, `Z` back and front. `none`: it ends at its sides.");
}

BoxOptions box_options(const Teuchos::ParameterList &list)
{
  BoxOptions options;
  const auto &lower = list.get<Array<double>>("Lower");
  const auto &upper = list.get<Array<double>>("Upper");
  const auto &cells = list.get<Array<int>>("Cells");
  options.lower.assign(lower.begin(), lower.end());
  options.upper.assign(upper.begin(), upper.end());
  options.cells.assign(cells.begin(), cells.end());
  const std::size_t dim = options.lower.size();
  RPC_REQUIRE(dim == 2 || dim == 3, "deck: \"Mesh->Lower\" must hold 2 or 3 numbers, got " << dim);
  const auto require_length = [&](const char *const name, const std::size_t given, const char *const others,
                                  const std::size_t wanted) {
    RPC_REQUIRE(given == wanted, "deck: \"Mesh->" << name << "\" must hold as many numbers as " << others << ", "
                                                  << wanted << ", got " << given
                                                  << ". Write 2 numbers for each, in space 3, with decimal points and "
                                                     "commas between them");
  };
  if (options.upper.size() == options.cells.size())
    require_length("Lower", dim, "\"Upper\" and \"Cells\"", options.upper.size());
  require_length("Upper", options.upper.size(), "\"Lower\"", dim);
  require_length("Cells", options.cells.size(), "\"Lower\" and \"Upper\"", dim);
  if (!list.getEntry("Expansion Ratio").isDefault()) {
    options.expansion = list.get<Array<double>>("Expansion Ratio").toVector();
    require_length("Expansion Ratio", options.expansion.size(), "\"Lower\" and \"Upper\"", dim);
  }
  double nodes = 1;
  options.element = parse_element(list.get<std::string>("Element"), static_cast<int>(dim));
  for (std::size_t d = 0; d < dim; ++d) {
    RPC_REQUIRE(std::isfinite(options.lower[d]) && std::isfinite(options.upper[d]) &&
                    options.lower[d] < options.upper[d],
                "deck: \"Mesh->Upper\" must be above \"Mesh->Lower\" in each direction [m], got "
                    << options.lower[d] << " and " << options.upper[d] << " in direction " << d + 1);
    RPC_REQUIRE(options.cells[d] > 0, "deck: \"Mesh->Cells\" must be > 0 in each direction, got "
                                          << options.cells[d] << " in direction " << d + 1);
    const double size = options.upper[d] - options.lower[d];
    RPC_REQUIRE(size >= least_size && size <= greatest_size, "deck: \"Mesh->Upper\" must be above \"Mesh->Lower\" by "
                                                                 << least_size << " to " << greatest_size
                                                                 << " [m] in each direction, got " << size
                                                                 << " in direction " << d + 1);
    const double spacing = size / (double(options.cells[d]) * options.element.order);
    const double farthest = std::max(std::abs(options.lower[d]), std::abs(options.upper[d]));
    RPC_REQUIRE(spacing >= 1e-12 * farthest,
                "deck: \"Mesh->Cells\": nodes must be at least 1e-12 times as far apart as "
                "from the origin, got "
                    << spacing << " and " << farthest << " [m] in direction " << d + 1);
    nodes *= double(options.cells[d]) * options.element.order + 1;
  }
  const auto &repeats = list.get<std::string>("Periodic");
  for (const auto &[word, directions] : periodic_words)
    if (repeats == word) options.periodic = directions;
  RPC_REQUIRE(repeats == "none" || periodic(options),
              "deck: \"Mesh->Periodic\" must be one of none, X, Y, Z, \"X, Y\", \"X, Z\", \"Y, Z\", got \"" << repeats
                                                                                                            << "\"");
  constexpr int fewest = 3; // a node must not be the neighbour of another one on both sides
  for (std::size_t d = 0; d < 3; ++d) {
    if (!options.periodic[d]) continue;
    const char name = "XYZ"[d];
    RPC_REQUIRE(d < dim, "deck: \"Mesh->Periodic\" names " << name << ", which a box in the plane does not have, got \""
                                                           << repeats << "\"");
    RPC_REQUIRE(options.cells[d] >= fewest,
                "deck: \"Mesh->Cells\" must be >= " << fewest << " in direction " << d + 1
                                                    << ", in which the box is periodic, got " << options.cells[d]);
  }
  require_expansion(options);
  grade(options);
  RPC_REQUIRE(dim == 3 || !(options.periodic[0] && options.periodic[1]),
              "deck: \"Mesh->Periodic\" must leave the box sides, got \""
                  << repeats << "\" in the plane. Write the direction along the contact side alone");
  const double most = std::numeric_limits<LO>::max() / 3.;
  RPC_REQUIRE(nodes <= most, "deck: \"Mesh->Cells\" make " << nodes << " nodes; at most " << most << " are supported");
  return options;
}

std::optional<std::string> memory_refusal(const GO nodes, const double bytes, const double limit,
                                          const std::string &what)
{
  constexpr double gib = 1 << 30;
  const double need = bytes * static_cast<double>(nodes);
  if (!(need > limit)) return std::nullopt;
  std::ostringstream text;
  text << std::setprecision(3) << "deck: \"Mesh->Cells\" give a rank " << nodes << " nodes, which take at least "
       << need / gib << " GiB of " << what << "; a rank can have at most " << limit / gib
       << " GiB here, which is enough for " << static_cast<GO>(limit / bytes)
       << " nodes. Use fewer cells, or more ranks on more machines" << (what == "memory" ? "" : " or GPUs") << ".";
  return text.str();
}

Mesh make_box(const BoxOptions &options, const RCP<const Comm> &comm)
{
  const std::size_t dim = options.element.dim;
  RPC_REQUIRE(
      options.lower.size() == dim && options.upper.size() == dim && options.cells.size() == dim,
      "mesh: a box of " << dim << "D elements needs " << dim
                        << " lower and upper coordinates and numbers of cells, got " << options.lower.size() << ", "
                        << options.upper.size() << " and " << options.cells.size()
                        << ". Write 2 numbers for each, in space 3, with decimal points and commas between them");
  for (std::size_t d = 0; d < dim; ++d)
    RPC_REQUIRE(!options.wraps(static_cast<int>(d)) || options.cells[d] >= 2,
                "mesh: a periodic box needs two cells at least in the directions in which it repeats itself, got "
                    << options.cells[d] << " in direction " << d + 1);
  const Grid grid(options, comm->getSize());
  const int rank = comm->getRank();
  Numbering numbering;
  numbering.owned_nodes = grid.owned_nodes(rank);
  require_memory(options, numbering.owned_nodes.size(), grid.num_nodes_total(), *comm);
  numbering.local_nodes = grid.local_nodes(rank);
  numbering.positions = grid.nodes_of(grid.local_cells(rank));
  numbering.owned_cells = grid.owned_cells(rank);
  numbering.num_owned_cells = static_cast<LO>(numbering.owned_cells.size());
  const Block local_cells = grid.local_cells(rank);
  const std::vector<Index> halo = shell(local_cells, numbering.owned_cells);

  struct Ghost {
    GO gid;
    Index at;
  };
  std::vector<Ghost> ghosts; // in the order of their gids, which is by owner: what Tpetra's Import packs best
  for (const Index &at : shell(numbering.local_nodes, numbering.owned_nodes)) ghosts.push_back({grid.node_gid(at), at});
  std::sort(ghosts.begin(), ghosts.end(), [](const Ghost &a, const Ghost &b) { return a.gid < b.gid; });

  const LO num_owned = static_cast<LO>(numbering.owned_nodes.size());
  const LO num_nodes = num_owned + static_cast<LO>(ghosts.size());
  const std::vector<Index> images = shell(numbering.positions, numbering.local_nodes);
  const LO num_places = num_nodes + static_cast<LO>(images.size());
  Mesh mesh;
  std::vector<Index> ghost_positions;
  for (const Ghost &ghost : ghosts) {
    mesh.ghosts.push_back(ghost.gid);
    ghost_positions.push_back(ghost.at);
  }
  ghost_positions.insert(ghost_positions.end(), images.begin(), images.end());
  numbering.ghost = device_positions(ghost_positions, "rpc::mesh::ghost_nodes");
  numbering.halo = device_positions(halo, "rpc::mesh::halo_cells");
  number_nodes(numbering, num_places);

  mesh.element = options.element;
  mesh.box = std::make_shared<const BoxOptions>(options);
  const GO total = grid.num_nodes_total();
  mesh.owned_nodes = rcp(new Map(total, num_owned, 0, comm));
  const BoxParts parts = box_parts(options.element);
  const LO num_parts = static_cast<LO>(parts.size());
  mesh.num_owned_cells = num_parts * numbering.num_owned_cells;
  mesh.coords = DeviceView<double **>("rpc::mesh::coords", num_places, mesh.dim());
  const std::size_t num_cells = num_parts * (numbering.num_owned_cells + halo.size());
  mesh.cells = DeviceView<LO **>("rpc::mesh::cells", num_cells, mesh.element.num_nodes());
  if (!images.empty()) mesh.place = DeviceView<LO **>("rpc::mesh::places", num_cells, mesh.element.num_nodes());
  mesh.blocks = {"body"};
  mesh.block = DeviceView<int *>("rpc::mesh::block", num_cells);
  fill_coords(numbering, options, mesh.coords);
  fill_cells(numbering, grid, mesh.element, parts, mesh.cells, mesh.place);

  Index nodes{1, 1, 1}, cells{1, 1, 1};
  for (int d = 0; d < mesh.dim(); ++d) {
    cells[d] = options.cells[d];
    nodes[d] = GO(options.cells[d]) * options.element.order_along(d) + (options.wraps(d) ? 0 : 1);
  }
  mesh.node_id = Ids(numbering.owned_nodes, nodes, 1);
  mesh.cell_id = Ids(numbering.owned_cells, cells, num_parts);

  for (const BoxSide &box_side : box_sides)
    if (box_side.direction < mesh.dim() && !options.wraps(box_side.direction))
      mesh.sides.push_back(side_of_box(box_side, parts, grid, numbering, halo, local_cells, mesh));
  if (options.unrolled || !periodic(options))
    mesh.points = corners_of_box(numbering, {nodes[0] - 1, nodes[1] - 1, nodes[2] - 1}, mesh.dim());
  Kokkos::fence();
  return mesh;
}

} // namespace rpc::mesh
