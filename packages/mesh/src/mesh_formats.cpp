// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_formats.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

namespace rpc::mesh
{
namespace
{

const std::vector<std::pair<const char *, MeshFormat>> &formats()
{
  static const std::vector<std::pair<const char *, MeshFormat>> all = {
      {".geo", MeshFormat::geo},     {".step", MeshFormat::shapes},  {".stp", MeshFormat::shapes},
      {".iges", MeshFormat::shapes}, {".igs", MeshFormat::shapes},   {".brep", MeshFormat::shapes},
      {".stl", MeshFormat::shapes},  {".msh", MeshFormat::msh},      {".e", MeshFormat::exodus},
      {".exo", MeshFormat::exodus},  {".exoii", MeshFormat::exodus}, {".ex2", MeshFormat::exodus},
      {".g", MeshFormat::exodus},    {".gen", MeshFormat::exodus},   {".unv", MeshFormat::by_gmsh},
      {".inp", MeshFormat::meshio},  {".med", MeshFormat::meshio},   {".vtk", MeshFormat::meshio},
      {".vtu", MeshFormat::meshio}};
  return all;
}

} // namespace

std::string extension_of(const std::string &file)
{
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

MeshFormat format_of(const std::string &file)
{
  const std::string extension = extension_of(file);
  for (const auto &[ending, format] : formats())
    if (extension == ending) return format;
  return MeshFormat::unknown;
}

bool keeps_geometry(const std::string &file)
{
  return is_geometry(format_of(file)) && extension_of(file) != ".stl";
}

std::vector<std::string> known_endings()
{
  std::vector<std::string> endings;
  for (const auto &[ending, format] : formats()) endings.emplace_back(ending);
  return endings;
}

} // namespace rpc::mesh
