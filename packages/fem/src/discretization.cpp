// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/discretization.hpp"

#include "around_nodes.hpp"
#include "congruent_cells.hpp"
#include "fill_entries.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/sparse_rows.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <array>
#include <optional>
#include <sstream>
#include <utility>

namespace rpc::fem
{
namespace
{

NodeGraph node_graph(const mesh::Mesh &mesh, const NodeToCells &node_to_cells)
{
  const auto cells = mesh.cells;
  const auto row = node_to_cells.row;
  const auto list = node_to_cells.cell;
  const LO num_owned = mesh.num_owned_nodes();
  const int nodes = mesh.element.num_nodes();
  DeviceView<LO *> candidates(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::graph_candidates"),
                              nodes * list.extent(0));
  DeviceView<LO *> length("rpc::fem::graph_row_length", num_owned);
  Kokkos::parallel_for(
      "rpc::fem::graph_rows", device_range(num_owned), KOKKOS_LAMBDA(const LO node) {
        LO *const found = &candidates(nodes * row(node)); // sorted, without repetition
        LO size = 0;
        for (std::size_t k = row(node); k < row(node + 1); ++k) {
          for (int a = 0; a < nodes; ++a) {
            const LO other = cells(list(k), a);
            LO at = size;
            while (at > 0 && found[at - 1] > other) --at;
            if (at > 0 && found[at - 1] == other) continue;
            for (LO move = size; move > at; --move) found[move] = found[move - 1];
            found[at] = other;
            ++size;
          }
        }
        length(node) = size;
      });
  NodeGraph graph;
  graph.row = offsets_of(length, "rpc::fem::node_graph_row");
  graph.col = DeviceView<LO *>(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::node_graph_col"), last_of(graph.row));
  const auto graph_row = graph.row;
  const auto graph_col = graph.col;
  Kokkos::parallel_for(
      "rpc::fem::graph_compress", device_range(num_owned), KOKKOS_LAMBDA(const LO node) {
        for (LO k = 0; k < length(node); ++k) graph_col(graph_row(node) + k) = candidates(nodes * row(node) + k);
      });
  return graph;
}

/// `dim` unknowns for each index of a node map.
RCP<const Map> dof_map(const Map &nodes, const int dim)
{
  const GO total = static_cast<GO>(nodes.getGlobalNumElements());
  if (nodes.isContiguous())
    return rcp(new Map(num_dofs(dim, total), num_dofs(dim, num_local(nodes)), 0, nodes.getComm()));
  const auto gids = nodes.getMyGlobalIndices();
  Teuchos::Array<GO> dofs(num_dofs(dim, gids.size()));
  for (std::size_t n = 0; n < gids.size(); ++n)
    for (int c = 0; c < dim; ++c) dofs[dof(dim, n, c)] = dof(dim, gids(n), c);
  return rcp(new Map(Teuchos::OrdinalTraits<GO>::invalid(), dofs(), 0, nodes.getComm()));
}

/// The rows of a node's unknowns.
template <int Dim>
struct FillDofGraph {
  using LocalGraph = CrsGraph::local_graph_device_type;

  NodeGraph nodes;                                  //                               in
  LocalGraph::row_map_type::non_const_type row;     // (owned dofs + 1), row(0) = 0  out
  LocalGraph::entries_type::non_const_type entries; // (matrix entries)              out, not on GPUs

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const std::size_t begin = nodes.row(node), length = nodes.row(node + 1) - begin;
    for (int i = 0; i < Dim; ++i) {
      const std::size_t start = Dim * (Dim * begin + i * length);
      row(dof(Dim, node, i) + 1) = start + Dim * length;
      if constexpr (!on_gpu)
        for (std::size_t k = 0; k < length; ++k)
          for (int j = 0; j < Dim; ++j) entries(start + dof(Dim, k, j)) = dof(Dim, nodes.col(begin + k), j);
    }
  }
};

/// The columns of these rows.                                                  for fill_entries()
template <int Dim>
struct DofColumns {
  NodeGraph nodes; // in

  KOKKOS_FUNCTION bool has(LO) const { return true; }
  KOKKOS_FUNCTION LO value(const LO node, const std::size_t entry) const
  {
    const std::size_t begin = nodes.row(node);
    const unsigned length = Dim * static_cast<unsigned>(nodes.row(node + 1) - begin),
                   k = static_cast<unsigned>(entry) % length;
    return dof(Dim, nodes.col(begin + node_of(Dim, k)), component_of(Dim, k));
  }
};

template <int Dim>
void fill_dof_graph(const FillDofGraph<Dim> &fill)
{
  const LO num_nodes = static_cast<LO>(fill.nodes.row.extent(0)) - 1;
  Kokkos::parallel_for("rpc::fem::dof_graph", device_range(num_nodes), fill);
  if constexpr (on_gpu)
    fill_entries<Dim>("rpc::fem::dof_columns", fill.nodes, DofColumns<Dim>{fill.nodes}, fill.entries);
  Kokkos::fence();
}

/// What is rounding of a mesh's coordinates, relative to its size.
constexpr double axis_rounding = 1e-10;

/// Refuses nodes on the other side of the axis; collective.
void require_radii(const mesh::Mesh &mesh, const double rounding)
{
  using Location = Kokkos::MinLoc<double, LO>;
  const auto coords = mesh.coords;
  Location::value_type farthest;
  Kokkos::parallel_reduce(
      "rpc::fem::least_radius", device_range(mesh.num_local_nodes()),
      KOKKOS_LAMBDA(const LO n, Location::value_type &least) {
        if (!(coords(n, 0) < least.val)) return;
        least.val = coords(n, 0);
        least.loc = n;
      },
      Location(farthest));
  const double r = min_all(mesh.comm(), farthest.val);
  std::optional<std::string> bad;
  if (r < -rounding && farthest.val == r) {
    const auto x = to_host(coords);
    std::ostringstream message;
    message << "mesh: the node at (" << r << ", " << x(farthest.loc, 1)
            << ") lies beyond the axis: with \"Kinematics\" = axisymmetric x is the radius, >= 0 [m]. Mesh one half of "
               "the section, at x >= 0.";
    bad = message.str();
  }
  throw_if_any(mesh.comm(), ExitCode::bad_mesh, bad);
}

} // namespace

Discretization discretize(std::shared_ptr<const mesh::Mesh> mesh, const Kinematics kinematics)
{
  require_dimension(kinematics, mesh->dim());
  Discretization d;
  d.mesh = std::move(mesh);
  d.kinematics = kinematics;
  d.diameter = mesh::diameter(*d.mesh);
  if (d.axisymmetric()) {
    d.on_axis = axis_rounding * d.diameter;
    require_radii(*d.mesh, d.on_axis);
  }
  if (!d.mesh->element.mixed()) d.reference = tabulate(d.mesh->element, kinematics);
  d.owned_dofs = dof_map(*d.mesh->owned_nodes, d.dim());
  d.node_halo = std::make_shared<const Halo>(d.mesh->owned_nodes, d.mesh->ghosts);
  d.halo = std::make_shared<const Halo>(*d.node_halo, d.dim());
  if (!d.axisymmetric()) d.congruent = congruent_cells(*d.mesh); // where cells are alike, radii are not
  d.node_to_cells = around_nodes(d.mesh->cells, d.mesh->num_owned_nodes());
  return d;
}

DeviceView<LO *> nodes_on_axis(const Discretization &d)
{
  const DeviceView<LO *> is_on_axis("rpc::fem::is_on_axis", d.mesh->num_owned_nodes());
  const auto coords = d.mesh->coords;
  const double axis = d.on_axis;
  Kokkos::parallel_for(
      "rpc::fem::is_on_axis", device_range(d.mesh->num_owned_nodes()),
      KOKKOS_LAMBDA(const LO n) { is_on_axis(n) = coords(n, 0) <= axis; });
  return sparse_rows(is_on_axis, "rpc::fem::on_axis").row;
}

NodeGraph Discretization::nodes() const
{
  if (kept_nodes->row.extent(0) == 0) *kept_nodes = node_graph(*mesh, node_to_cells);
  return *kept_nodes;
}

RCP<const CrsGraph> dof_graph(const Discretization &d)
{
  const NodeGraph nodes = d.nodes();
  using LocalGraph = CrsGraph::local_graph_device_type;
  const LO num_nodes = d.mesh->num_owned_nodes();
  const int dim = d.dim();
  LocalGraph::row_map_type::non_const_type row("rpc::fem::graph_row", num_dofs(dim, num_nodes) + 1);
  LocalGraph::entries_type::non_const_type col(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::graph_col"),
                                               std::size_t(dim) * dim * nodes.col.extent(0));
  if (dim == 2)
    fill_dof_graph(FillDofGraph<2>{nodes, row, col});
  else
    fill_dof_graph(FillDofGraph<3>{nodes, row, col});
  const RCP<const Map> columns = overlap_dofs(d);
  const RCP<const Import> ghosts = columns == d.owned_dofs ? Teuchos::null : rcp(new Import(d.owned_dofs, columns));
  const RCP<CrsGraph> graph = rcp(new CrsGraph(d.owned_dofs, columns, row, col));
  graph->expertStaticFillComplete(d.owned_dofs, d.owned_dofs, ghosts);
  return graph;
}

RCP<const Map> overlap_dofs(const Discretization &d)
{
  return d.mesh->comm().getSize() == 1 ? d.owned_dofs : dof_map(*d.mesh->overlap_nodes(), d.dim());
}

RCP<const Vector> on_overlap(const Discretization &d, const Vector &owned)
{
  if (d.halo->is_empty()) return Teuchos::rcpFromRef(owned);
  const Vector &columns = d.halo->at_columns(owned);
  const auto overlap = rcp(new Vector(columns.getMap(), false));
  Kokkos::deep_copy(device_write(*overlap), device_read(columns)); // Tpetra's copy goes by way of the host
  return overlap;
}

RCP<const MultiVector> nodes_on_overlap(const Discretization &d, const RCP<const MultiVector> &owned)
{
  if (d.node_halo->is_empty()) return owned;
  const auto overlap = rcp(new MultiVector(overlap_rows(d), owned->getNumVectors()));
  for (std::size_t v = 0; v < owned->getNumVectors(); ++v) {
    const auto column = owned->getVector(v);
    const auto to = overlap->getVectorNonConst(v);
    Kokkos::deep_copy(device_write(*to), device_read(d.node_halo->at_columns(*column)));
  }
  return overlap;
}

RCP<const Map> overlap_rows(const Discretization &d)
{
  return rcp(new Map(d.mesh->num_local_nodes(), 0, rcp(new Teuchos::SerialComm<int>)));
}

void fill_ghost_rows(const Discretization &d, MultiVector &table)
{
  if (d.node_halo->is_empty()) return;
  Vector owned(d.mesh->owned_nodes, false);
  const std::pair<LO, LO> own_rows(0, d.mesh->num_owned_nodes());
  for (std::size_t v = 0; v < table.getNumVectors(); ++v) {
    const auto column = table.getVectorNonConst(v);
    Kokkos::deep_copy(device_write(owned), Kokkos::subview(device_read(*column), own_rows));
    Kokkos::deep_copy(device_write(*column), device_read(d.node_halo->at_columns(owned)));
  }
}

RCP<MultiVector> node_coordinates(const Discretization &d)
{
  const auto result = rcp(new MultiVector(d.mesh->owned_nodes, d.dim()));
  const auto to = result->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto from = d.mesh->coords;
  const int dim = d.dim();
  Kokkos::parallel_for(
      "rpc::fem::node_coordinates", device_range(d.mesh->num_owned_nodes()), KOKKOS_LAMBDA(const LO node) {
        for (int c = 0; c < dim; ++c) to(node, c) = from(node, c);
      });
  return result;
}

namespace
{

/// Whether a rotation about a point leaves a node of any rank at rest; collective.
/// @param coords  (owned nodes; dim) [m]
bool rests_at_a_node(const MultiVector &coords, const Kokkos::Array<double, 3> &centre)
{
  const int dim = static_cast<int>(coords.getNumVectors());
  const auto x = coords.getLocalViewDevice(Tpetra::Access::ReadOnly);
  int any = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::rests_at_a_node", device_range(static_cast<LO>(x.extent(0))),
      KOKKOS_LAMBDA(const LO node, int &rests) {
        for (int i = 0; i < dim; ++i)
          for (int j = i + 1; j < dim; ++j)
            if (x(node, i) == centre[i] && x(node, j) == centre[j]) rests = 1;
      },
      Kokkos::Max<int>(any));
  return max_all(*coords.getMap()->getComm(), any) > 0;
}

} // namespace

RCP<MultiVector> rigid_body_modes(const Discretization &d)
{
  const int dim = d.dim();
  const auto coords = node_coordinates(d);
  std::array<double, 3> mean{};
  coords->meanValue(Teuchos::ArrayView<double>(mean.data(), dim));
  Kokkos::Array<double, 3> centre{{mean[0], mean[1], mean[2]}};
  // MueLu throws where a mode is 0 on an aggregate, which may be one node, and on that node's rank alone.
  const double step = d.diameter / 1024;
  while (rests_at_a_node(*coords, centre))
    for (int c = 0; c < dim; ++c) centre[c] += step / (1 + c);
  const auto result = rcp(new MultiVector(d.owned_dofs, dim == 2 ? 3 : 6)); // zero
  const auto modes = result->getLocalViewDevice(Tpetra::Access::ReadWrite);
  const auto x = coords->getLocalViewDevice(Tpetra::Access::ReadOnly);
  Kokkos::parallel_for(
      "rpc::fem::rigid_body_modes", device_range(d.mesh->num_owned_nodes()), KOKKOS_LAMBDA(const LO node) {
        for (int c = 0; c < dim; ++c) modes(dof(dim, node, c), c) = 1;
        int mode = dim;
        for (int i = 0; i < dim; ++i) {
          for (int j = i + 1; j < dim; ++j, ++mode) { // rotation in the plane of x_i and x_j
            modes(dof(dim, node, i), mode) = -(x(node, j) - centre[j]);
            modes(dof(dim, node, j), mode) = x(node, i) - centre[i];
          }
        }
      });
  return result;
}

} // namespace rpc::fem
