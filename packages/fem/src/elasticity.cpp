#include "rpc/fem/elasticity.hpp"

#include "component_name.hpp"
#include "elastic_kernels.hpp"
#include "fill_entries.hpp"
#include "rpc/core/evaluate.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc::fem
{
namespace
{

using MatrixValues = CrsMatrix::local_matrix_device_type::values_type::non_const_type; // in Tpetra's memory

/// Names the first owned cell whose Jacobian determinant is not positive at a quadrature point; nothing if there is none
/// on this rank.
template <int Dim, int Nodes>
struct FirstBadCell {
  DeviceView<double **> coords;    // (overlap nodes, Dim)   [m]      in
  DeviceView<LO **> cells;         // (cells, Nodes)                  in
  DeviceView<double ***> gradient; // (points, Nodes, Dim)            in

  KOKKOS_FUNCTION void operator()(const LO cell, LO &first) const
  {
    const CellCoords<Dim, Nodes> x(coords, cells, cell);
    double dN[Nodes][Dim];
    for (int q = 0; q < static_cast<int>(gradient.extent(0)); ++q)
      if (!(physical_gradients(x, gradient, q, dN) > 0) && cell < first) first = cell;
  }
};

std::optional<std::string> describe_bad_cell(const Discretization &d)
{
  const mesh::Mesh &mesh = *d.mesh;
  LO first = 0;
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const FirstBadCell<dim, nodes> kernel{mesh.coords, mesh.cells, d.reference.cell.gradient};
    Kokkos::parallel_reduce("rpc::fem::first_bad_cell", device_range(mesh.num_owned_cells), kernel,
                            Kokkos::Min<LO>(first));
  });
  if (first >= mesh.num_owned_cells) return std::nullopt;
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  const auto block = to_host(mesh.block);
  std::ostringstream message;
  message << "mesh: cell " << mesh.cell_id(first) + 1 << " of block \"" << mesh.blocks[block(first)]
          << "\" is degenerate or inverted (Jacobian determinant <= 0), with vertices at";
  for (int a = 0; a < mesh.element.num_vertices(); ++a)
    for (int c = 0; c < mesh.dim(); ++c)
      message << (c == 0 ? " (" : ", ") << coords(cells(first, a), c) << (c + 1 == mesh.dim() ? ")" : "");
  return message.str();
}

VectorField vector_field(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                         const FieldParser &parse)
{
  VectorField field;
  for (int c = 0; c < 3; ++c) {
    const std::string parameter = path + "->" + component_name[c];
    field[c] = parse(field_text(list, component_name[c]), parameter);
    RPC_REQUIRE(c < dim || field[c].is_zero(),
                "deck: \"" << parameter << "\" must be 0 in " << dim << "D, got " << field[c].text);
  }
  return field;
}

/// Values of a vector field at points (n, dim), as (n, dim) on the device.
DeviceView<double **> evaluate_vector(const VectorField &field, const DeviceView<double **> &points,
                                      const std::string &parameter, const Comm &comm)
{
  const int dim = static_cast<int>(points.extent(1));
  const auto host_points = to_host(points);
  DeviceView<double **> result("rpc::fem::load_at_points", points.extent(0), dim);
  const auto host = Kokkos::create_mirror_view(result);
  for (int c = 0; c < dim; ++c) {
    const auto values = evaluate(field[c], host_points, parameter + "->" + component_name[c], comm);
    for (std::size_t p = 0; p < values.extent(0); ++p) host(p, c) = values(p);
  }
  Kokkos::deep_copy(result, host);
  return result;
}

Dilatation parse_dilatation(const std::string &text, const std::string &path)
{
  if (text == "auto") return Dilatation::automatic;
  if (text == "full") return Dilatation::full;
  if (text == "projected") return Dilatation::projected;
  throw Error(ExitCode::bad_input,
              "deck: \"" + path + "->Dilatation\" must be auto, full or projected, got \"" + text + "\"");
}

Material one_material(const Teuchos::ParameterList &list, const std::string &path)
{
  Material material;
  material.youngs_modulus = list.get<double>("Young's Modulus");
  material.poissons_ratio = list.get<double>("Poisson's Ratio");
  RPC_REQUIRE(material.youngs_modulus > 0 && std::isfinite(material.youngs_modulus),
              "deck: \"" << path << "->Young's Modulus\" must be > 0 and finite [Pa], got " << material.youngs_modulus);
  RPC_REQUIRE(material.poissons_ratio > -1 && material.poissons_ratio < 0.5,
              "deck: \"" << path << "->Poisson's Ratio\" must be in (-1, 0.5), got " << material.poissons_ratio);
  material.dilatation = parse_dilatation(list.get<std::string>("Dilatation"), path);
  return material;
}

bool is_zero(const VectorField &field, const int dim)
{
  for (int c = 0; c < dim; ++c)
    if (!field[c].is_zero()) return false;
  return true;
}

/// x = sum_a N_a x_a at the quadrature points of cells or facets: (entities * points, dim).
DeviceView<double **> quadrature_points(const DeviceView<double **> &coords, const DeviceView<LO **> &nodes,
                                        const DeviceView<double **> &value)
{
  const int dim = static_cast<int>(coords.extent(1)), points = static_cast<int>(value.extent(0));
  DeviceView<double **> x("rpc::fem::quadrature_points", nodes.extent(0) * points, dim);
  Kokkos::parallel_for(
      "rpc::fem::quadrature_points", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO entity) {
        for (int q = 0; q < points; ++q)
          for (int d = 0; d < dim; ++d)
            for (std::size_t a = 0; a < nodes.extent(1); ++a)
              x(entity * points + q, d) += value(q, a) * coords(nodes(entity, a), d);
      });
  return x;
}

/// measure(cell * points + q) = weight * Jacobian determinant: what a quadrature point stands for [m^Dim].
template <int Dim, int Nodes>
struct CellMeasure {
  DeviceView<double **> coords;    // (overlap nodes, Dim)   [m]      in
  DeviceView<LO **> cells;         // (cells, Nodes)                  in
  DeviceView<double ***> gradient; // (points, Nodes, Dim)            in
  DeviceView<double *> weight;     // (points)                        in
  DeviceView<double *> measure;    // (cells * points)       [m^Dim]  out

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    const CellCoords<Dim, Nodes> x(coords, cells, cell);
    const int points = static_cast<int>(weight.extent(0));
    double dN[Nodes][Dim];
    for (int q = 0; q < points; ++q) measure(cell * points + q) = weight(q) * physical_gradients(x, gradient, q, dN);
  }
};

DeviceView<double *> cell_measure(const mesh::Mesh &mesh, const BasisTable &table)
{
  DeviceView<double *> measure("rpc::fem::cell_measure", std::size_t(mesh.num_cells()) * table.num_points());
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const CellMeasure<dim, nodes> kernel{mesh.coords, mesh.cells, table.gradient, table.weight, measure};
    Kokkos::parallel_for("rpc::fem::cell_measure", device_range(mesh.num_cells()), kernel);
  });
  return measure;
}

/// load(ai) += sum over entities (cells or facets) and their points q, measure_q N_a(q) f_i(q).
/// @param node_to_entities  those around the owned nodes
/// @param f  (entities * points, dim)
void add_load(const DeviceView<LO **> &entities, const NodeToCells &node_to_entities,
              const DeviceView<double **> &value, const DeviceView<double *> &measure, const DeviceView<double **> &f,
              Vector &load)
{
  const auto b = device_write(load);
  const int dim = static_cast<int>(f.extent(1)), points = static_cast<int>(value.extent(0));
  const LO num_nodes = static_cast<LO>(node_to_entities.row.extent(0)) - 1;
  Kokkos::parallel_for(
      "rpc::fem::add_load", device_range(num_nodes), KOKKOS_LAMBDA(const LO node) {
        for (std::size_t k = node_to_entities.row(node); k < node_to_entities.row(node + 1); ++k) {
          const LO entity = node_to_entities.cell(k);
          const int a = place_in(entities, entity, node);
          for (int i = 0; i < dim; ++i) {
            double sum = 0;
            for (int q = 0; q < points; ++q)
              sum += measure(entity * points + q) * value(q, a) * f(entity * points + q, i);
            b(dof(dim, node, i)) += sum;
          }
        }
      });
  Kokkos::fence();
}

/// The matrix's values where cells are alike: few cells are integrated, and each entry is written once.
/// @param[out] bad  number of kinds with a Jacobian <= 0
template <int Dim, int Nodes>
MatrixValues gather_stiffness(const Discretization &d, const CellStiffness<Dim, Nodes> &stiffness,
                              const std::size_t num_entries, LO &bad)
{
  constexpr int dofs = Dim * Nodes;
  const mesh::Mesh &mesh = *d.mesh;
  const int num_blocks = static_cast<int>(mesh.blocks.size()), num_matrices = d.congruent.size() * num_blocks;
  const DeviceView<double *[dofs][dofs]> matrix("rpc::fem::shape_stiffness", num_matrices);
  const TabulateStiffness<Dim, Nodes> tabulate{stiffness, d.congruent.example, num_blocks, matrix};
  Kokkos::parallel_reduce("rpc::fem::tabulate_stiffness", device_range(num_matrices), tabulate, bad);
  const MatrixValues values(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::stiffness"), num_entries);
  const LO num_owned = mesh.num_owned_nodes(), example = mesh.num_cells() / 2;
  const NodeStiffness<Dim, Nodes> rows{
      mesh.cells, mesh.block, d.congruent.of_cell, matrix, num_blocks, num_owned, d.node_to_cells, d.nodes, values};
  Kokkos::parallel_for("rpc::fem::gather_examples", device_range(Nodes), GatherExamples<Dim, Nodes>{rows, example});
  if constexpr (on_gpu) {
    const DeviceView<LO *> source(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::source_of_rows"), num_owned);
    Kokkos::parallel_for("rpc::fem::gather_stiffness", device_range(num_owned),
                         GatherOrFindSource<Dim, Nodes>{rows, example, source});
    fill_entries<Dim>("rpc::fem::copy_stiffness", d.nodes, CopiedRows<Dim>{d.nodes, source, values}, values);
  } else {
    Kokkos::parallel_for("rpc::fem::gather_stiffness", device_range(num_owned),
                         GatherStiffness<Dim, Nodes>{rows, example});
  }
  return values;
}

/// The matrix's values where each cell is integrated by itself.
/// @param[out] bad  number of cells with a Jacobian <= 0
template <int Dim, int Nodes>
MatrixValues add_stiffness(const Discretization &d, const CellStiffness<Dim, Nodes> &stiffness,
                           const std::size_t num_entries, LO &bad)
{
  const MatrixValues values("rpc::fem::stiffness", num_entries);
  const LO num_cells = d.mesh->num_cells(), num_owned = d.mesh->num_owned_nodes();
  if constexpr (one_thread) {
    const AddStiffness<Dim, Nodes> add{stiffness, d.nodes, num_owned, values};
    Kokkos::parallel_reduce("rpc::fem::add_stiffness", device_range(num_cells), add, bad);
  } else {
    constexpr int dofs = Dim * Nodes;
    constexpr LO most = (1 << 28) / static_cast<LO>(sizeof(double[dofs][dofs])); // cells in 256 MB
    const DeviceView<double *[dofs][dofs]> matrix(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::cell_stiffness"),
                                                  std::min(most, num_cells));
    for (LO first = 0; first < num_cells; first += most) {
      const LO last = first + std::min(most, num_cells - first);
      LO bad_here = 0;
      Kokkos::parallel_reduce("rpc::fem::tabulate_cells", device_range(last - first),
                              TabulateCells<Dim, Nodes>{stiffness, first, matrix}, bad_here);
      bad += bad_here;
      const AddTabulated<Dim, Nodes> add{d.mesh->cells, first, last, matrix, d.node_to_cells, d.nodes, values};
      Kokkos::parallel_for("rpc::fem::add_tabulated", device_range(num_owned), add);
      Kokkos::fence();
    }
  }
  return values;
}

/// @param[in,out] force  0
template <int Dim, int Nodes>
void add_internal_work(const Discretization &d, const ElasticCells<Dim, Nodes> &body, const Vector &u_overlap,
                       Vector &force, double &squares, double &energy)
{
  const mesh::Mesh &mesh = *d.mesh;
  const DeviceView<double *[Nodes][Dim]> share("rpc::fem::force_share", one_thread ? 0 : mesh.num_cells());
  const InternalWorkOfCell<Dim, Nodes> kernel{
      body, device_read(u_overlap), mesh.num_owned_nodes(), mesh.num_owned_cells, device_write(force), share};
  Kokkos::parallel_reduce("rpc::fem::internal_work", device_range(mesh.num_cells()), kernel, squares, energy);
  if constexpr (!one_thread)
    Kokkos::parallel_for("rpc::fem::sum_shares", device_range(mesh.num_owned_nodes()),
                         SumShares<Dim, Nodes>{mesh.cells, share, d.node_to_cells, device_write(force)});
}

bool is_p2(const mesh::Element &element)
{
  return element.shape == mesh::Shape::simplex && element.order == 2;
}

/// Whether the projection stands for the dilatation.
bool projects(const mesh::Element &element, const Material &material)
{
  // P2 with one constant per cell loses its order: up to 0.48 it does better without.
  const double bound = is_p2(element) ? 0.48 : 0.4;
  const bool automatic = material.dilatation == Dilatation::automatic && material.poissons_ratio > bound;
  return automatic || material.dilatation == Dilatation::projected;
}

} // namespace

Teuchos::ParameterList valid_material_parameters()
{
  Teuchos::ParameterList valid("Material");
  valid.set("Young's Modulus", 1., "E > 0 [Pa].");
  valid.set("Poisson's Ratio", 0.3, "nu, in (-1, 0.5).");
  valid.set(
      "Dilatation", "auto",
      "What counts as div u in a cell: `full`, itself; `projected`, its L2 projection on constants (Q1, P2) or linear "
      "functions (Q2), which does not lock as nu nears 0.5; `auto`: projected where nu > 0.4 (P2: 0.48). All the same "
      "for P1.");
  Teuchos::ParameterList entry = valid;
  set_named_entries(valid, "Blocks", entry,
                    "Materials of single blocks of the mesh, each entry named after its block; other blocks have the "
                    "material above.");
  return valid;
}

Materials material_options(const Teuchos::ParameterList &list)
{
  Materials materials(one_material(list, "Material"));
  const Teuchos::ParameterList &blocks = list.sublist("Blocks");
  for (auto it = blocks.begin(); it != blocks.end(); ++it)
    materials.block[blocks.name(it)] =
        one_material(blocks.sublist(blocks.name(it)), "Material->Blocks->" + blocks.name(it));
  return materials;
}

const Material &Materials::of(const std::string &name) const
{
  const auto own = block.find(name);
  return own == block.end() ? common : own->second;
}

DeviceView<double **> lame_table(const mesh::Mesh &mesh, const Materials &materials)
{
  for (const auto &[name, material] : materials.block)
    RPC_REQUIRE(std::find(mesh.blocks.begin(), mesh.blocks.end(), name) != mesh.blocks.end(),
                "deck: \"Material->Blocks->" << name << "\" names a block that the mesh does not have. Its blocks: "
                                             << join(mesh.blocks) << ".");
  DeviceView<double **> table("rpc::fem::lame", mesh.blocks.size(), 2);
  const auto host = Kokkos::create_mirror_view(table);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const Material &material = materials.of(mesh.blocks[b]);
    host(b, 0) = material.lambda();
    host(b, 1) = material.mu();
  }
  Kokkos::deep_copy(table, host);
  return table;
}

DeviceView<double *> youngs_modulus_at_nodes(const Discretization &d, const Materials &materials,
                                             const DeviceView<LO *> &nodes)
{
  const auto lame = lame_table(*d.mesh, materials);
  const auto node_to_cells = d.node_to_cells;
  const auto block = d.mesh->block;
  DeviceView<double *> modulus("rpc::fem::youngs_modulus", nodes.extent(0));
  Kokkos::parallel_for(
      "rpc::fem::youngs_modulus", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO i) {
        for (std::size_t k = node_to_cells.row(nodes(i)); k < node_to_cells.row(nodes(i) + 1); ++k) {
          const double lambda = lame(block(node_to_cells.cell(k)), 0), mu = lame(block(node_to_cells.cell(k)), 1);
          const double own = mu * (3 * lambda + 2 * mu) / (lambda + mu);
          if (own > modulus(i)) modulus(i) = own;
        }
      });
  Kokkos::fence();
  return modulus;
}

DeviceView<int *> projected_dilatation_table(const mesh::Mesh &mesh, const Materials &materials)
{
  DeviceView<int *> table("rpc::fem::projected_dilatation", mesh.blocks.size());
  const auto host = Kokkos::create_mirror_view(table);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    host(b) = projects(mesh.element, materials.of(mesh.blocks[b])) ? 1 : 0;
  Kokkos::deep_copy(table, host);
  return table;
}

std::string locking_note(const mesh::Mesh &mesh, const Materials &materials)
{
  if (mesh.element.shape != mesh::Shape::simplex || mesh.element.order != 1) return "";
  for (const std::string &block : mesh.blocks) {
    if (!(materials.of(block).poissons_ratio > 0.4)) continue;
    std::ostringstream note;
    note << "P1 triangles lock in block \"" << block << "\" with nu = " << materials.of(block).poissons_ratio
         << ": displacements and stresses are wrong there; take Q2, P2 or Q1";
    return note.str();
  }
  return "";
}

std::string order_note(const mesh::Mesh &mesh, const Materials &materials)
{
  if (!is_p2(mesh.element)) return "";
  for (const std::string &block : mesh.blocks) {
    const Material &material = materials.of(block);
    if (!projects(mesh.element, material)) continue;
    std::ostringstream note;
    note << "P2 loses an order in block \"" << block << "\" with nu = " << material.poissons_ratio
         << ", where its dilatation is projected, and needs many more cells for the same error; take Q2 (of a .geo: "
            "\"Recombine Surface\")";
    return note.str();
  }
  return "";
}

Teuchos::ParameterList valid_traction_parameters()
{
  Teuchos::ParameterList entry, parent;
  entry.set("Side", "", "Side of the mesh; by default the side that the entry is named after.");
  for (const char *name : component_name)
    set_field(entry, name, "0", std::string("Force per area in ") + name + " [Pa], a number or an expression.");
  set_named_entries(parent, "Traction", entry, "Surface loads, any number of entries with names of your choice.");
  return parent.sublist("Traction");
}

Teuchos::ParameterList valid_body_force_parameters()
{
  Teuchos::ParameterList valid("Body Force");
  for (const char *name : component_name)
    set_field(valid, name, "0", std::string("Force per volume in ") + name + " [N/m^3], a number or an expression.");
  return valid;
}

std::vector<TractionLoad> traction_options(const Teuchos::ParameterList &list, const int dim, const FieldParser &parse)
{
  std::vector<TractionLoad> loads;
  for (auto it = list.begin(); it != list.end(); ++it) {
    const std::string name = list.name(it);
    const Teuchos::ParameterList &entry = list.sublist(name);
    const std::string side = entry.get<std::string>("Side").empty() ? name : entry.get<std::string>("Side");
    loads.push_back({name, side, vector_field(entry, dim, "Traction->" + name, parse)});
  }
  return loads;
}

VectorField body_force_options(const Teuchos::ParameterList &list, const int dim, const FieldParser &parse)
{
  return vector_field(list, dim, "Body Force", parse);
}

RCP<CrsMatrix> assemble_stiffness(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  const std::size_t num_entries = d.graph->getLocalGraphDevice().entries.extent(0);
  MatrixValues values;
  LO bad = 0;
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const CellStiffness<dim, nodes> stiffness{elastic_cells<dim, nodes>(d, materials)};
    values = d.congruent.size() > 0 ? gather_stiffness(d, stiffness, num_entries, bad)
                                    : add_stiffness(d, stiffness, num_entries, bad);
  });
  Kokkos::fence();
  if (sum_all(mesh.comm(), GO(bad)) > 0) throw_if_any(mesh.comm(), ExitCode::bad_mesh, describe_bad_cell(d));
  const auto matrix = rcp(new CrsMatrix(d.graph, values));
  matrix->fillComplete(d.owned_dofs, d.owned_dofs);
  return matrix;
}

InternalWork internal_work(const Discretization &d, const Materials &materials, const Vector &u)
{
  const mesh::Mesh &mesh = *d.mesh;
  const auto forces = rcp(new Vector(d.owned_dofs));
  double squares = 0, energy = 0;
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    add_internal_work(d, elastic_cells<dim, nodes>(d, materials), *on_overlap(d, u), *forces, squares, energy);
  });
  Kokkos::fence();
  return {forces, std::sqrt(sum_all(mesh.comm(), squares)), sum_all(mesh.comm(), energy)};
}

void add_body_force(const Discretization &d, const VectorField &force, const std::string &parameter, Vector &load)
{
  if (is_zero(force, d.dim())) return;
  const mesh::Mesh &mesh = *d.mesh;
  const BasisTable &table = d.reference.cell_load;
  const auto points = quadrature_points(mesh.coords, mesh.cells, table.value);
  const auto f = evaluate_vector(force, points, parameter, mesh.comm());
  add_load(mesh.cells, d.node_to_cells, table.value, cell_measure(mesh, table), f, load);
}

DeviceView<double ***> tractions_on(const Discretization &d, const mesh::Side &side,
                                    const std::vector<TractionLoad> &loads)
{
  const mesh::Mesh &mesh = *d.mesh;
  const BasisTable &table = d.reference.facet;
  const int points = table.num_points(), dim = d.dim();
  const DeviceView<double ***> sum("rpc::fem::tractions_on", side.facets.extent(0), points, dim);
  for (const auto &load : loads) {
    if (load.side != side.name || is_zero(load.traction, dim)) continue;
    const auto t = evaluate_vector(load.traction, quadrature_points(mesh.coords, side.facets, table.value),
                                   "Traction->" + load.name, mesh.comm());
    Kokkos::parallel_for(
        "rpc::fem::add_tractions", device_range(static_cast<LO>(side.facets.extent(0))), KOKKOS_LAMBDA(const LO f) {
          for (int q = 0; q < points; ++q)
            for (int i = 0; i < dim; ++i) sum(f, q, i) += t(f * points + q, i);
        });
    Kokkos::fence();
  }
  return sum;
}

void add_traction(const Discretization &d, const mesh::Side &side, const VectorField &traction,
                  const std::string &parameter, Vector &load)
{
  if (is_zero(traction, d.dim())) return;
  const mesh::Mesh &mesh = *d.mesh;
  const BasisTable &table = d.reference.facet;
  const auto points = quadrature_points(mesh.coords, side.facets, table.value);
  const auto t = evaluate_vector(traction, points, parameter, mesh.comm());
  const NodeToCells node_to_facets = around_nodes(side.facets, mesh.num_owned_nodes());
  add_load(side.facets, node_to_facets, table.value, facet_measure(d, side), t, load);
}

} // namespace rpc::fem
