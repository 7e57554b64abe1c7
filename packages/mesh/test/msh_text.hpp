// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "expect_error.hpp"
#include "rpc/mesh/gmsh.hpp"
#include "scratch_file.hpp"

#include <gtest/gtest.h>
#include <initializer_list>
#include <string>
#include <vector>

/// .msh files of the folder data, and such as a test writes itself.
namespace rpc::test
{

inline std::string path_of_data(const std::string &name)
{
  return std::string(RPC_TEST_DATA_DIR) + "/" + name;
}

inline mesh::MeshData read_data(const std::string &name)
{
  return mesh::read_gmsh({path_of_data(name), 1, 0});
}

inline mesh::MeshData read_text(const std::string &text)
{
  const ScratchFile file("mesh.msh", text);
  return mesh::read_gmsh({file.path(), 1, 0});
}

inline void expect_refused(const std::string &text, const std::initializer_list<std::string> &parts)
{
  expect_error(ExitCode::bad_mesh, "mesh.msh\": ", [&] { read_text(text); });
  expect_error(ExitCode::bad_mesh, parts, [&] { read_text(text); });
}

/// Whether one of a mesh's notes has all of these parts.
inline void expect_noted(const mesh::MeshData &mesh, const std::initializer_list<std::string> &parts)
{
  std::string all;
  for (const std::string &note : mesh.notes) {
    all += note + "\n";
    bool has = true;
    for (const std::string &part : parts) has = has && note.find(part) != note.npos;
    if (has) return;
  }
  ADD_FAILURE() << "no note says " << *parts.begin() << "; there are:\n" << all;
}

/// A .msh 2.2 from its parts, with the counts that go with them.
struct MshText {
  std::vector<std::string> names, nodes, elements; ///< lines

  std::string text() const
  {
    std::string all = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    const auto add = [&](const std::string &section, const std::vector<std::string> &lines) {
      all += "$" + section + "\n" + std::to_string(lines.size()) + "\n";
      for (const auto &line : lines) all += line + "\n";
      all += "$End" + section + "\n";
    };
    add("PhysicalNames", names);
    add("Nodes", nodes);
    add("Elements", elements);
    return all;
  }
};

} // namespace rpc::test
