// SPDX-License-Identifier: BSD-3-Clause
#include "around_nodes.hpp"
#include "component_name.hpp"
#include "kernels.hpp"
#include "of_time_alone.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/evaluate.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/measure.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace rpc::fem
{
namespace
{

/// Begins the names of the components of a force on a whole side.
const std::string force_prefix = "Force ";

/// @param prefix  of the names X, Y, Z
VectorField vector_field(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                         const FieldParser &parse, const std::string &prefix = "")
{
  VectorField field;
  for (int c = 0; c < 3; ++c) {
    const std::string name = prefix + component_name[c], parameter = path + "->" + name;
    field[c] = parse(field_text(list, name), parameter);
    RPC_REQUIRE(c < dim || field[c].is_zero(),
                "deck: \"" << parameter << "\" must be 0 in " << dim << "D, got " << field[c].text
                           << ". A plane mesh has X and Y; of a body of revolution Y runs along the axis.");
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

/// Whether a deck gives a component.
bool is_given(const Teuchos::ParameterList &list, const std::string &prefix)
{
  return std::any_of(std::begin(component_name), std::end(component_name),
                     [&](const char *const c) { return !list.getEntry(prefix + c).isDefault(); });
}

/// Refuses forces that depend on the place.
void require_all_of_time_alone(const VectorField &force, const std::string &path)
{
  for (int c = 0; c < 3; ++c)
    require_of_time_alone(force[c], path + "->" + force_prefix + component_name[c],
                          std::string("Write a force per area as ") + component_name[c] + ".");
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

/// measure(cell * points + q) = weight * Jacobian determinant (* 2 pi r): integration weight [m^Dim, axisymmetric:
/// m^3].
template <int Dim, int Nodes>
struct CellMeasure {
  DeviceView<double **> coords;    // (overlap nodes, Dim)   [m]      in
  DeviceView<LO **> cells;         // (cells, Nodes)                  in
  DeviceView<double **> value;     // (points, Nodes)                 in
  DeviceView<double ***> gradient; // (points, Nodes, Dim)            in
  DeviceView<double *> weight;     // (points)                        in
  bool axisymmetric;               //                                 in
  DeviceView<double *> measure;    // (cells * points)       [m^Dim]  out

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    const CellCoords<Dim, Nodes> x(coords, cells, cell);
    const int points = static_cast<int>(weight.extent(0));
    double dN[Nodes][Dim], at[Dim];
    for (int q = 0; q < points; ++q) {
      double &share = measure(cell * points + q) = weight(q) * physical_gradients(x, gradient, q, dN);
      if (!axisymmetric) continue;
      position(x, value, q, at);
      share *= circle(at[0]);
    }
  }
};

DeviceView<double *> cell_measure(const Discretization &d, const BasisTable &table)
{
  const mesh::Mesh &mesh = *d.mesh;
  DeviceView<double *> measure("rpc::fem::cell_measure", std::size_t(mesh.num_cells()) * table.num_points());
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const CellMeasure<dim, nodes> kernel{mesh.coords,  mesh.places(),    table.value, table.gradient,
                                         table.weight, d.axisymmetric(), measure};
    Kokkos::parallel_for("rpc::fem::cell_measure", device_range(mesh.num_cells()), kernel);
  });
  return measure;
}

/// @param area  of the side, or of a part of it
void require_area(const double area, const mesh::Side &side, const std::string &parameter)
{
  RPC_REQUIRE(area > 0, "deck: \"" << parameter << "\" acts nowhere: the side \"" << side.name
                                   << "\" lies on the axis, where it has no area. Name another side");
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

} // namespace

Teuchos::ParameterList valid_traction_parameters()
{
  Teuchos::ParameterList entry, parent;
  entry.set("Side", "", "Side of the mesh; by default the side that the entry is named after.");
  for (const char *name : component_name)
    set_field(entry, name, "0", std::string("Force per area in ") + name + " [Pa], a number or an expression.");
  for (const char *name : component_name)
    set_field(entry, force_prefix + name, "0",
              std::string("Force in ") + name +
                  " on the whole side [N], in the plane per m, axisymmetric on the whole circumference; spread evenly "
                  "over the side. A number or an expression of t. Instead of X, Y, Z.");
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
    const std::string &name = list.name(it);
    const Teuchos::ParameterList &entry = list.sublist(name);
    const std::string side = entry.get<std::string>("Side").empty() ? name : entry.get<std::string>("Side");
    const std::string path = "Traction->" + name;
    const bool per_area = is_given(entry, ""), in_all = is_given(entry, force_prefix);
    RPC_REQUIRE(per_area || in_all, "deck: \"" << path
                                               << "\" has no force. Give X, Y or Z [Pa], or a force on the whole side, "
                                                  "Force X, Force Y or Force Z [N].");
    RPC_REQUIRE(!per_area || !in_all,
                "deck: \"" << path
                           << "\" must have X, Y, Z [Pa] or Force X, Force Y, Force Z [N], got some of both. Write two "
                              "entries with one \"Side\": they add up.");
    loads.push_back(
        {name, side, vector_field(entry, dim, path, parse), vector_field(entry, dim, path, parse, force_prefix)});
    require_all_of_time_alone(loads.back().force, path);
  }
  return loads;
}

VectorField body_force_options(const Teuchos::ParameterList &list, const int dim, const FieldParser &parse)
{
  return vector_field(list, dim, "Body Force", parse);
}

void add_body_force(const Discretization &d, const VectorField &force, const std::string &parameter, Vector &load)
{
  if (is_zero(force, d.dim())) return;
  const mesh::Mesh &mesh = *d.mesh;
  const BasisTable &table = d.reference.cell_load;
  const auto points = quadrature_points(mesh.coords, mesh.places(), table.value);
  const auto f = evaluate_vector(force, points, parameter, mesh.comm());
  add_load(mesh.cells, d.node_to_cells, table.value, cell_measure(d, table), f, load); // paper (1), (2.5)
}

VectorField force_per_area(const Discretization &d, const mesh::Side &side, const TractionLoad &load)
{
  VectorField sum = load.traction;
  if (is_zero(load.force, d.dim())) return sum;
  const std::string path = "Traction->" + load.name;
  const double area = side_measure(d, side).area;
  require_area(area, side, path);
  for (int c = 0; c < d.dim(); ++c) {
    const double force = load.force[c]({});
    RPC_REQUIRE(std::isfinite(force), "deck: \"" << path << "->" << force_prefix << component_name[c]
                                                 << "\" must be finite, got " << force << " from " << load.force[c].text
                                                 << " at t = " << load.force[c].time);
    const ScalarField own = sum[c];
    if (own.is_constant())
      sum[c] = ScalarField(own.constant + force / area);
    else if (force != 0)
      sum[c] = ScalarField(own.text, [own, force, area](const Point &x, double) { return own(x) + force / area; });
  }
  return sum;
}

DeviceView<double ***> tractions_on(const Discretization &d, const mesh::Side &side,
                                    const std::vector<TractionLoad> &loads)
{
  const mesh::Mesh &mesh = *d.mesh;
  const BasisTable &table = d.reference.facet;
  const int points = table.num_points(), dim = d.dim();
  const DeviceView<double ***> sum("rpc::fem::tractions_on", side.facets.extent(0), points, dim);
  for (const auto &load : loads) {
    if (load.side != side.name) continue;
    const VectorField traction = force_per_area(d, side, load);
    if (is_zero(traction, dim)) continue;
    const auto t = evaluate_vector(traction, quadrature_points(mesh.coords, side.places(), table.value),
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

namespace
{

double largest_of(const DeviceView<double *> &values)
{
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::largest_of", device_range(static_cast<LO>(values.extent(0))),
      KOKKOS_LAMBDA(const LO i, double &most) {
        if (values(i) > most) most = values(i);
      },
      Kokkos::Max<double>(largest));
  return std::max(largest, 0.);
}

/// @param measure  (facets * points), see facet_measure()   @param t  (facets * points, dim) traction [Pa]
void add_load_of_side(const Discretization &d, const mesh::Side &side, const DeviceView<double *> &measure,
                      const DeviceView<double **> &t, Vector &load)
{
  const NodeToCells node_to_facets = around_nodes(side.facets, d.mesh->num_owned_nodes());
  add_load(side.facets, node_to_facets, d.reference.facet.value, measure, t, load); // paper (3), (2.5)
}

} // namespace

void add_traction(const Discretization &d, const mesh::Side &side, const VectorField &traction,
                  const std::string &parameter, Vector &load)
{
  if (is_zero(traction, d.dim())) return;
  const mesh::Mesh &mesh = *d.mesh;
  const BasisTable &table = d.reference.facet;
  const auto points = quadrature_points(mesh.coords, side.places(), table.value);
  const auto t = evaluate_vector(traction, points, parameter, mesh.comm());
  const auto measure = facet_measure(d, side);
  require_area(max_all(mesh.comm(), largest_of(measure)), side, parameter);
  add_load_of_side(d, side, measure, t, load);
}

void add_node_areas(const Discretization &d, const mesh::Side &side, Vector &areas)
{
  const auto measure = facet_measure(d, side);
  const DeviceView<double **> unit("rpc::fem::unit_traction", measure.extent(0), d.dim());
  Kokkos::deep_copy(unit, 1.);
  add_load_of_side(d, side, measure, unit, areas);
}

} // namespace rpc::fem
