// SPDX-License-Identifier: BSD-3-Clause
#include "other_words.hpp"

#include <algorithm>
#include <cctype>

namespace rpc
{
namespace
{

constexpr const char *density_sentence =
    "A density does not enter by itself: the weight is \"Body Force\", the density times gravity, such as Y = "
    "-7850*9.81 in m and N.";
constexpr const char *shear_sentence =
    "The material is given by \"Young's Modulus\" E and \"Poisson's Ratio\" nu: G = E/(2 (1 + nu)), K = E/(3 (1 - 2 "
    "nu)).";
constexpr const char *size_sentence =
    "The cells of a box are given by their number in each direction, \"Mesh->Cells\", those of a STEP file by their "
    "\"Mesh->Size\"; of a .geo, which has sizes, \"Mesh->Size Factor\" scales them.";
constexpr const char *viewer_sentence = "ParaView opens <deck>.e, which \"Output->Exodus\" writes by default.";
constexpr const char *name_sentence = "A deck is named by its file, and by the name of its outermost list. Remove it.";
constexpr const char *elastic_sentence = "The body is linear elastic and at rest. Remove it.";

} // namespace

const std::vector<std::pair<std::string, std::string>> words_of_others = {
    {"e", "Material->Young's Modulus"},
    {"emodul", "Material->Young's Modulus"},
    {"modulus", "Material->Young's Modulus"},
    {"elasticmodulus", "Material->Young's Modulus"},
    {"elasticity", "Material->Young's Modulus"},
    {"nu", "Material->Poisson's Ratio"},
    {"prxy", "Material->Poisson's Ratio"},
    {"ex", "Material->Young's Modulus"},
    {"neumann", "Traction"},
    {"load", "Traction"},
    {"loads", "Traction"},
    {"force", "Traction"},
    {"forces", "Traction"},
    {"pressure", "Traction"},
    {"dload", "Traction"},
    {"bc", "Dirichlet"},
    {"bcs", "Dirichlet"},
    {"boundary", "Dirichlet"},
    {"boundaryconditions", "Dirichlet"},
    {"constraints", "Dirichlet"},
    {"support", "Dirichlet"},
    {"supports", "Dirichlet"},
    {"displacement", "Dirichlet"},
    {"displacements", "Dirichlet"},
    {"fixed", "Dirichlet"},
    {"geometry", "Mesh"},
    {"domain", "Mesh"},
    {"foundation", "Contact"},
    {"ground", "Contact"},
    {"indenter", "Contact->Obstacle"},
    {"punch", "Contact->Obstacle"},
    {"friction", "Contact->Friction Coefficient"},
    {"mu", "Contact->Friction Coefficient"},
    {"xi", "Contact->Yield Stress"},
    {"yield", "Contact->Yield Stress"},
    {"yieldlimit", "Contact->Yield Stress"},
    {"bearingcapacity", "Contact->Yield Stress"},
    {"winkler", "Contact->Stiffness"},
    {"springstiffness", "Contact->Stiffness"},
    {"subgrademodulus", "Contact->Stiffness"},
    {"size", "Mesh->Upper"},
    {"dimensions", "Mesh->Upper"},
    {"length", "Mesh->Upper"},
    {"height", "Mesh->Upper"},
    {"width", "Mesh->Upper"},
    {"nx", "Mesh->Cells"},
    {"ny", "Mesh->Cells"},
    {"nz", "Mesh->Cells"},
    {"elements", "Mesh->Cells"},
    {"divisions", "Mesh->Cells"},
    {"elementtype", "Mesh->Element"},
    {"step", "Steps"},
    {"loadsteps", "Steps"},
    {"timesteps", "Steps"},
    {"increments", "Steps"},
    {"solver", "Linear Solver"},
    {"newton", "NOX"},
    {"planestrain", "Kinematics"},
    {"planestress", "Kinematics"},
    {"axisymmetric", "Kinematics"},
    {"winklermodulus", "Contact->Stiffness"},
    {"penaltyparameter", "Contact->Penalty"},
    {"limit", "Contact->Yield Stress"},
    {"yieldstrength", "Contact->Yield Stress"},
    {"cohesion", "Contact->Friction Bound"},
    {"adhesion", "Contact->Friction Bound"},
    {"shearstrength", "Contact->Friction Limit"},
    {"path", "Mesh->File"},
    {"meshfile", "Mesh->File"},
    {"geometryfile", "Mesh->File"},
    {"refine", "Mesh->Refinements"},
    {"refinement", "Mesh->Refinements"},
    {"origin", "Mesh->Lower"},
    {"resolution", "Mesh->Cells"},
    {"timestep", "Steps"},
    {"loading", "Traction"},
    {"results", "Output"},
    {"outputs", "Output"},
    {"print", "Output"},
    {"plot", "Output"},
    {"accuracy", "Adapt->Target Relative Error"},
    {"refinementlevel", "Mesh->Refinements"},
};

constexpr const char *processes_sentence = "How many processes run is no matter of the deck: several are started by "
                                           "mpirun -n 4 rpc ..., and threads of a build for OpenMP by OMP_NUM_THREADS.";

const std::vector<std::pair<std::string, std::string>> sentences_for_words = {
    {"density", density_sentence},
    {"massdensity", density_sentence},
    {"rho", density_sentence},
    {"gravity", density_sentence},
    {"g", density_sentence},
    {"weight", density_sentence},
    {"selfweight", density_sentence},
    {"shearmodulus", shear_sentence},
    {"bulkmodulus", shear_sentence},
    {"lame", shear_sentence},
    {"frictionangle", "Coulomb's friction is \"Contact->Friction Coefficient\", the tangent of the angle of friction."},
    {"threads", processes_sentence},
    {"cores", processes_sentence},
    {"processors", processes_sentence},
    {"ranks", processes_sentence},
    {"symmetry", "A plane of symmetry is a side that does not move along its normal: an entry of \"Dirichlet\" with "
                 "that component, such as X = 0."},
    {"thickness", "A plane body has no thickness: forces are per length of its depth, in N/m with m and N."},
    {"cellsize", size_sentence},
    {"elementsize", size_sentence},
    {"meshsize", size_sentence},
    {"h", size_sentence},
    {"name", name_sentence},
    {"title", name_sentence},
    {"job", name_sentence},
    {"description", name_sentence},
    {"plasticity", elastic_sentence},
    {"thermalexpansion", elastic_sentence},
    {"temperature", elastic_sentence},
    {"damping", elastic_sentence},
    {"vtk", viewer_sentence},
    {"vtu", viewer_sentence},
    {"paraview", viewer_sentence},
};

const std::vector<std::pair<std::string, std::string>> words_for_words = {
    {"step", "gmsh"},
    {"stp", "gmsh"},
    {"iges", "gmsh"},
    {"igs", "gmsh"},
    {"brep", "gmsh"},
    {"stl", "gmsh"},
    {"inp", "gmsh"},
    {"abaqus", "gmsh"},
    {"vtk", "gmsh"},
    {"unv", "gmsh"},
    {"med", "gmsh"},
    {"bdf", "gmsh"},
    {"nas", "gmsh"},
    {"cdb", "gmsh"},
    {"geo", "gmsh"},
    {"msh", "gmsh"},
    {"file", "gmsh"},
    {"cad", "gmsh"},
    {"import", "gmsh"},
    {"mesh", "gmsh"},
    {"rectangle", "box"},
    {"rect", "box"},
    {"square", "box"},
    {"cube", "box"},
    {"cuboid", "box"},
    {"brick", "box"},
    {"block", "box"},
    {"structured", "box"},
    {"cartesian", "box"},
    {"ball", "sphere"},
    {"disc", "circle"},
    {"disk", "circle"},
    {"flat", "plane"},
    {"wall", "plane"},
    {"floor", "plane"},
    {"halfspace", "plane"},
    {"stl", "surface mesh"},
    {"cad", "surface mesh"},
    {"mesh", "surface mesh"},
    {"triangles", "surface mesh"},
    {"rough", "height map"},
    {"roughness", "height map"},
    {"heights", "height map"},
    {"rod", "cylinder"},
    {"roller", "cylinder"},
    {"axial", "axisymmetric"},
    {"axisymmetry", "axisymmetric"},
    {"rotational", "axisymmetric"},
    {"2d", "plane strain"},
    {"plane", "plane strain"},
    {"linear", "Q1"},
    {"quadratic", "Q2"},
    {"quadrilateral", "Q1"},
    {"quads", "Q1"},
    {"hex", "Q1"},
    {"hexahedron", "Q1"},
    {"tri", "P1"},
    {"triangle", "P1"},
    {"tet", "P1"},
    {"tetrahedron", "P1"},
    {"quad", "Q1"},
    {"quad4", "Q1"},
    {"cpe4", "Q1"},
    {"cps4", "Q1"},
    {"cax4", "Q1"},
    {"hex8", "Q1"},
    {"hexa8", "Q1"},
    {"c3d8", "Q1"},
    {"quad8", "Q2"},
    {"quad9", "Q2"},
    {"cpe8", "Q2"},
    {"hex20", "Q2"},
    {"hex27", "Q2"},
    {"c3d20", "Q2"},
    {"tri3", "P1"},
    {"tria3", "P1"},
    {"cpe3", "P1"},
    {"tet4", "P1"},
    {"tetra4", "P1"},
    {"c3d4", "P1"},
    {"tri6", "P2"},
    {"tria6", "P2"},
    {"cpe6", "P2"},
    {"tet10", "P2"},
    {"tetra10", "P2"},
    {"c3d10", "P2"},
};

std::string letters(const std::string &name)
{
  std::string text;
  for (const unsigned char c : name)
    if (std::isalnum(c)) text += static_cast<char>(std::tolower(c));
  return text;
}

std::string found_word(const std::vector<std::pair<std::string, std::string>> &table, const std::string &word)
{
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto &each) { return each.first == word; });
  return found == table.end() ? "" : found->second;
}

} // namespace rpc
