// SPDX-License-Identifier: BSD-3-Clause
#include "unknown_name.hpp"

#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"

#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

namespace rpc
{
namespace
{

/// Letters and digits alone, small.
std::string letters(const std::string &name)
{
  std::string text;
  for (const unsigned char c : name)
    if (std::isalnum(c)) text += static_cast<char>(std::tolower(c));
  return text;
}

/// Words of books and of other programs, as letters() has them, and where a deck has what they mean.
const std::vector<std::pair<std::string, std::string>> words_of_others = {
    {"e", "Material->Young's Modulus"},
    {"emodul", "Material->Young's Modulus"},
    {"modulus", "Material->Young's Modulus"},
    {"elasticmodulus", "Material->Young's Modulus"},
    {"elasticity", "Material->Young's Modulus"},
    {"nu", "Material->Poisson's Ratio"},
    {"prxy", "Material->Poisson's Ratio"},
    {"ex", "Material->Young's Modulus"},
    {"density", "Body Force"},
    {"rho", "Body Force"},
    {"gravity", "Body Force"},
    {"weight", "Body Force"},
    {"selfweight", "Body Force"},
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
    {"ux", "X"},
    {"uy", "Y"},
    {"uz", "Z"},
    {"u1", "X"},
    {"u2", "Y"},
    {"u3", "Z"},
    {"fx", "X"},
    {"fy", "Y"},
    {"fz", "Z"},
};

/// Paths of the lists that have a parameter or a list of this name, but for case and marks.
void find_lists(const Teuchos::ParameterList &list, const std::string &path, const std::string &name,
                std::vector<std::string> &found)
{
  for (const std::string &each : names_of(list)) {
    if (each == pass_through) continue;
    const std::string shown = each == any_entry ? "<any name>" : each;
    const std::string full = path.empty() ? shown : path + "->" + shown;
    if (letters(each) == name) found.push_back(full);
    if (list.isSublist(each)) find_lists(list.sublist(each), full, name, found);
  }
}

/// Another place for the name, as a sentence; empty if there is none.
std::string other_place(const std::string &path, const std::string &name, const Teuchos::ParameterList &valid,
                        const Teuchos::ParameterList &root)
{
  const std::string word = letters(name);
  for (const auto &[other, place] : words_of_others) {
    if (other != word || path == place || path.rfind(place + "->", 0) == 0) continue;
    if (valid.isParameter(place)) return " Did you mean \"" + place + "\"?";
    const auto arrow = place.rfind("->");
    if (arrow != std::string::npos && place.substr(0, arrow) == path)
      return " Did you mean \"" + place.substr(arrow + 2) + "\"?";
    if (place.size() > 1 && root.isParameter(place.substr(0, place.find("->"))))
      return " In a deck that is \"" + place + "\".";
  }
  if (valid.isParameter("X") && valid.isParameter("Z")) return " Write its components: X, Y, Z.";
  std::vector<std::string> places;
  if (!word.empty()) find_lists(root, "", word, places);
  if (places.empty() || places.size() > 3) return "";
  if (places.front().find("->") == std::string::npos)
    return " It belongs to the outermost list, as \"" + places.front() + "\".";
  std::string text;
  for (const std::string &place : places) text += (text.empty() ? "\"" : " or \"") + place + "\"";
  return " It is a parameter of another list: " + text + ".";
}

} // namespace

Error unknown_name(const std::string &path, const std::string &name, const Teuchos::ParameterList &valid,
                   const Teuchos::ParameterList &root)
{
  const std::vector<std::string> names = names_of(valid);
  const std::string nearest = nearest_name(name, names);
  const bool near = !nearest.empty() && (letters(nearest) == letters(name) || valid.isParameter("X"));
  const std::string place = near ? "" : other_place(path, name, valid, root);
  const std::string full = path.empty() ? name : path + "->" + name;
  return {ExitCode::bad_input, "deck: unknown parameter \"" + full + "\"." +
                                   (place.empty() ? did_you_mean(name, names) : place) + " Valid here: " + join(names) +
                                   "."};
}

} // namespace rpc
