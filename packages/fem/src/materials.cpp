// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace rpc::fem
{
namespace
{

Dilatation parse_dilatation(const std::string &text, const std::string &path)
{
  if (text == "auto") return Dilatation::automatic;
  if (text == "full") return Dilatation::full;
  if (text == "projected") return Dilatation::projected;
  throw Error(ExitCode::bad_input,
              "deck: \"" + path + "->Dilatation\" must be auto, full or projected, got \"" + text + "\"");
}

constexpr const char *modulus_name = "Young's Modulus", *ratio_name = "Poisson's Ratio";
constexpr double no_default = std::numeric_limits<double>::quiet_NaN();

bool is_given(const Teuchos::ParameterList &list, const char *const name)
{
  return !list.getEntry(name).isDefault();
}

/// What to write in place of a Poisson's ratio that no elastic body has.
const char *ratio_remedy(const double ratio)
{
  if (ratio >= 0.5 && ratio < 0.51)
    return ". For a body that keeps its volume write 0.4999, and take elements that do not lock: \"Mesh->Element\" = "
           "Q2 or Q1, of gmsh those of order 2";
  if (ratio > 1 && ratio < 50) return ". It is a ratio, not a percentage: 0.3 for steel";
  return "";
}

Material one_material(const Teuchos::ParameterList &list, const std::string &path)
{
  const auto require_given = [&](const char *const name, const char *const rule) {
    RPC_REQUIRE(is_given(list, name), "deck: \"" << path << "->" << name << "\" must be given, " << rule
                                                 << "; it has no default. Add it to \"" << path << "\"");
  };
  require_given(modulus_name, "> 0 and finite [Pa]");
  require_given(ratio_name, "in (-1, 0.5)");
  Material material;
  material.youngs_modulus = list.get<double>(modulus_name);
  material.poissons_ratio = list.get<double>(ratio_name);
  RPC_REQUIRE(material.youngs_modulus > 0 && std::isfinite(material.youngs_modulus),
              "deck: \"" << path << "->Young's Modulus\" must be > 0 and finite [Pa], got " << material.youngs_modulus);
  RPC_REQUIRE(material.poissons_ratio > -1 && material.poissons_ratio < 0.5,
              "deck: \"" << path << "->Poisson's Ratio\" must be in (-1, 0.5), got " << material.poissons_ratio
                         << ratio_remedy(material.poissons_ratio));
  material.dilatation = parse_dilatation(list.get<std::string>("Dilatation"), path);
  return material;
}

bool is_p2(const mesh::Element &element)
{
  return element.shape == mesh::Shape::simplex && element.order == 2;
}

/// Whether the dilatation is replaced by its projection.
bool projects(const Discretization &d, const Material &material)
{
  if (d.kinematics == Kinematics::plane_stress) return false; // lambda stays finite as nu nears 0.5
  // P2 with one constant per cell loses its order: up to 0.48 it does better without.
  const double bound = is_p2(d.mesh->element) ? 0.48 : 0.4;
  const bool automatic = material.dilatation == Dilatation::automatic && material.poissons_ratio > bound;
  return automatic || material.dilatation == Dilatation::projected;
}

/// @throws rpc::Error (bad_input) if a material is given for a block that the mesh does not have, or none for one that it has
void require_blocks(const mesh::Mesh &mesh, const Materials &materials)
{
  for (const auto &[name, material] : materials.block)
    RPC_REQUIRE(std::find(mesh.blocks.begin(), mesh.blocks.end(), name) != mesh.blocks.end(),
                "deck: \"Material->Blocks->" << name << "\" names a block that the mesh does not have. Its blocks: "
                                             << join(mesh.blocks) << "." << did_you_mean(name, mesh.blocks));
  for (const std::string &name : mesh.blocks)
    RPC_REQUIRE(!materials.only_blocks || materials.block.count(name) > 0,
                "deck: \"Material->" << modulus_name << "\" must be given, > 0 and finite [Pa], and \"Material->"
                                     << ratio_name << "\", in (-1, 0.5): block \"" << name
                                     << "\" of the mesh has no material of its own. Add them to \"Material\" or to "
                                        "\"Material->Blocks->"
                                     << name << "\"");
}

/// (blocks) [Pa]
DeviceView<double *> youngs_moduli(const mesh::Mesh &mesh, const Materials &materials)
{
  require_blocks(mesh, materials);
  std::vector<double> moduli;
  for (const std::string &block : mesh.blocks) moduli.push_back(materials.of(block).youngs_modulus);
  return device_values(moduli, "rpc::fem::youngs_moduli");
}

} // namespace

Teuchos::ParameterList valid_material_parameters()
{
  Teuchos::ParameterList valid("Material");
  valid.set(modulus_name, no_default, "E > 0 [Pa]; must be given.");
  valid.set(ratio_name, no_default, "nu, in (-1, 0.5); must be given.");
  set_words(
      valid, "Dilatation", {"auto", "full", "projected"},
      "What counts as div u in a cell: `full`, itself; `projected`, its L2 projection on constants (Q1, P2) or linear "
      "functions (Q2), which does not lock as nu nears 0.5; `auto`: projected where nu > 0.4 (P2: 0.48). All the same "
      "for P1. Plane stress does not lock: `full` there.");
  Teuchos::ParameterList entry = valid;
  set_named_entries(valid, "Blocks", entry,
                    "Materials of single blocks of the mesh, each entry named after its block; other blocks have the "
                    "material above, which may be left out if there are none.");
  return valid;
}

Materials material_options(const Teuchos::ParameterList &list)
{
  const Teuchos::ParameterList &blocks = list.sublist("Blocks");
  Materials materials;
  materials.only_blocks = blocks.numParams() > 0 && !is_given(list, modulus_name) && !is_given(list, ratio_name);
  if (!materials.only_blocks) materials.common = one_material(list, "Material");
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

DeviceView<double **> lame_table(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  require_blocks(mesh, materials);
  DeviceView<double **> table("rpc::fem::lame", mesh.blocks.size(), 2);
  const auto host = Kokkos::create_mirror_view(table);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const Material &material = materials.of(mesh.blocks[b]);
    const double lambda = material.lambda(), mu = material.mu();
    // (2.3), (2.3a)
    host(b, 0) = d.kinematics == Kinematics::plane_stress ? 2 * lambda * mu / (lambda + 2 * mu) : lambda;
    host(b, 1) = mu;
  }
  Kokkos::deep_copy(table, host);
  return table;
}

DeviceView<double *> youngs_modulus_at_nodes(const Discretization &d, const Materials &materials,
                                             const DeviceView<LO *> &nodes)
{
  const auto of_block = youngs_moduli(*d.mesh, materials);
  const auto node_to_cells = d.node_to_cells;
  const auto block = d.mesh->block;
  DeviceView<double *> modulus("rpc::fem::youngs_modulus", nodes.extent(0));
  Kokkos::parallel_for(
      "rpc::fem::youngs_modulus", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO i) {
        for (std::size_t k = node_to_cells.row(nodes(i)); k < node_to_cells.row(nodes(i) + 1); ++k) {
          const double own = of_block(block(node_to_cells.cell(k)));
          if (own > modulus(i)) modulus(i) = own;
        }
      });
  Kokkos::fence();
  return modulus;
}

DeviceView<int *> projected_dilatation_table(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  DeviceView<int *> table("rpc::fem::projected_dilatation", mesh.blocks.size());
  const auto host = Kokkos::create_mirror_view(table);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const Material &material = materials.of(mesh.blocks[b]);
    RPC_REQUIRE(
        d.kinematics != Kinematics::plane_stress || material.dilatation != Dilatation::projected,
        "deck: \"Material->Dilatation\" = projected does not go with \"Kinematics\" = plane stress, in which nothing "
        "locks: the sheet grows thinner instead. Take auto or full.");
    host(b) = projects(d, material) ? 1 : 0;
  }
  Kokkos::deep_copy(table, host);
  return table;
}

std::string locking_note(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  if (d.kinematics == Kinematics::plane_stress) return "";
  if (mesh.element.shape != mesh::Shape::simplex || mesh.element.order != 1) return "";
  for (const std::string &block : mesh.blocks) {
    if (!(materials.of(block).poissons_ratio > 0.4)) continue;
    std::ostringstream note;
    note << "P1 " << (mesh.dim() == 2 ? "triangles" : "tetrahedra") << " lock in block \"" << block
         << "\" with nu = " << materials.of(block).poissons_ratio
         << ": displacements and stresses are wrong there; take Q2, P2 or Q1";
    return note.str();
  }
  return "";
}

std::string incompressibility_note(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  if (d.kinematics == Kinematics::plane_stress || mesh.element.name() != "Q1") return "";
  constexpr double alternating = 0.498;
  for (const std::string &block : mesh.blocks) {
    const double nu = materials.of(block).poissons_ratio;
    if (!(nu > alternating)) continue;
    std::ostringstream note;
    note << "Q1 cells with nu = " << nu << " in block \"" << block
         << "\": pressures in the body may alternate from cell to cell; take Q2";
    return note.str();
  }
  return "";
}

std::string bending_note(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  if (!mesh.box || mesh.element.order != 1) return "";
  const mesh::BoxOptions &box = *mesh.box;
  const auto thickness = [&box](const int k) { return box.upper[k] - box.lower[k]; };
  int across = 0;
  for (int k = 1; k < mesh.dim(); ++k)
    if (thickness(k) < thickness(across)) across = k;
  double length = 0;
  for (int k = 0; k < mesh.dim(); ++k)
    if (k != across) length = std::max(length, box.cell_length(k));
  const double slenderness = length / thickness(across), layer = box.cell_length(across) / thickness(across);
  double shear = 0, excess = 0; // (2.6a)
  for (const std::string &block : mesh.blocks) {
    const Material &material = materials.of(block);
    const double nu = material.poissons_ratio;
    const bool stress = d.kinematics == Kinematics::plane_stress;
    shear = std::max(shear, (stress ? 0.5 / (1 + nu) : 0.5 * (1 - nu)) * slenderness * slenderness);
    const double lateral = projects(d, material) ? 0 : nu * nu / (stress ? 1 - nu * nu : 1 - 2 * nu);
    excess = std::max(excess, shear + lateral * layer * layer);
  }
  constexpr double notable = 0.25, fair = 0.05;
  if (shear < notable) return "";
  std::ostringstream note;
  note << std::setprecision(2) << mesh.element.name() << " cells " << slenderness
       << " times as long as the body is thick make it "
       << (mesh.element.shape == mesh::Shape::simplex ? "more than " : "up to ") << 1 + excess
       << " times too stiff where it bends; take order 2, or cells at most " << slenderness * std::sqrt(fair / shear)
       << " times its thickness long for 5 %";
  return note.str();
}

std::string order_note(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  if (!is_p2(mesh.element)) return "";
  for (const std::string &block : mesh.blocks) {
    const Material &material = materials.of(block);
    if (!projects(d, material)) continue;
    std::ostringstream note;
    note << "P2 loses an order in block \"" << block << "\" with nu = " << material.poissons_ratio
         << ", where its dilatation is projected, and needs many more cells for the same error; take Q2"
         << (mesh.dim() == 2 ? " (of a .geo: \"Recombine Surface\")" : "");
    return note.str();
  }
  return "";
}

} // namespace rpc::fem
