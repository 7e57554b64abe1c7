// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <gtest/gtest.h>

namespace rpc::test
{

/// Two meshes are the same in every number but the last digits of coordinates, which an ASCII file rounds.
inline void expect_same_mesh(const mesh::MeshData &a, const mesh::MeshData &b, const std::string &what)
{
  SCOPED_TRACE(what);
  EXPECT_EQ(a.element.name(), b.element.name());
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.blocks, b.blocks);
  EXPECT_EQ(a.block, b.block);
  ASSERT_EQ(a.coords.size(), b.coords.size());
  for (std::size_t i = 0; i < a.coords.size(); ++i) EXPECT_NEAR(a.coords[i], b.coords[i], 1e-15) << i;
  ASSERT_EQ(a.sides.size(), b.sides.size());
  for (std::size_t s = 0; s < a.sides.size(); ++s) {
    EXPECT_EQ(a.sides[s].name, b.sides[s].name);
    EXPECT_EQ(a.sides[s].cell, b.sides[s].cell);
    EXPECT_EQ(a.sides[s].ordinal, b.sides[s].ordinal);
  }
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t s = 0; s < a.points.size(); ++s) {
    EXPECT_EQ(a.points[s].name, b.points[s].name);
    EXPECT_EQ(a.points[s].node, b.points[s].node);
  }
}

/// Two meshes of one geometry by two versions of gmsh: they have the same names, and about as many cells and facets.
inline void expect_alike_mesh(const mesh::MeshData &a, const mesh::MeshData &b, const std::string &what)
{
  SCOPED_TRACE(what);
  const auto expect_about_as_many = [](const std::size_t n, const std::size_t m) {
    EXPECT_NEAR(static_cast<double>(n), static_cast<double>(m), 0.1 * static_cast<double>(m));
  };
  EXPECT_EQ(a.element.name(), b.element.name());
  EXPECT_EQ(a.blocks, b.blocks);
  expect_about_as_many(a.cells.size(), b.cells.size());
  ASSERT_EQ(a.sides.size(), b.sides.size());
  for (std::size_t s = 0; s < a.sides.size(); ++s) {
    EXPECT_EQ(a.sides[s].name, b.sides[s].name);
    expect_about_as_many(a.sides[s].cell.size(), b.sides[s].cell.size());
  }
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t s = 0; s < a.points.size(); ++s) EXPECT_EQ(a.points[s].name, b.points[s].name);
}

} // namespace rpc::test
