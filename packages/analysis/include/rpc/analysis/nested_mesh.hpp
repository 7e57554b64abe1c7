// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"
#include "rpc/mesh/box.hpp"

#include <memory>
#include <optional>
#include <utility>

namespace rpc::analysis
{

/// A mesh of a body that leads to coarser ones: of order 1 on the same cells, then of half as many cells in each direction. Those are
/// boxes, or the parents of a refined mesh, a structured grid or simplices from a file (Mesh::parents). Boxes of stretched cells take both steps in the directions
/// first in which nodes are closest, see mesh::coarsened(). Other bodies of a .geo that were not refined have none but the first.
///
/// A refined mesh of order 2 also has parents of order 2, for nested iteration. What they have made is shared: their meshes of order 1 are
/// multigrid's.
///
/// Coarser meshes are made on demand, and kept until they are forgotten: multigrid and nested iteration share them. They follow from
/// this mesh alone, so that making or forgetting them changes nothing of it: both are const. One thread of a rank at a time.
class NestedMesh
{
public:
  /// The finest mesh.
  explicit NestedMesh(fem::Discretization d);

  const fem::Discretization &discretization() const { return discretization_; }
  /// Whether there are to be coarser meshes; those of few cells may be too small for the ranks.
  bool may_have_coarser() const;
  /// The next coarser mesh; null where there is none. Collective.
  std::shared_ptr<const NestedMesh> coarser() const;
  /// The same, as long as it is kept; null if it was not made.
  const std::shared_ptr<const NestedMesh> &made_coarser() const { return coarser_; }
  /// The mesh that this one was refined from, of the same order; null if it was not. Collective.
  std::shared_ptr<const NestedMesh> parent() const;
  /// The same, as long as it is kept; null if it was not made.
  std::shared_ptr<const NestedMesh> made_parent() const { return family_ ? family_->made : nullptr; }
  /// Drops the coarser meshes: those that nobody else holds are freed. They are made again on demand.
  void forget_coarser() const;

  bool is_finest() const { return to_finer_.is_null(); }
  /// (owned nodes of the finer mesh x owned nodes) Null for the finest mesh.
  const RCP<const CrsMatrix> &to_finer() const { return to_finer_; }
  /// (overlap nodes) The node of the finer mesh at the same place; none unless this is the mesh of order 1 on the same cells. A rank
  /// without a cell has an empty view.
  const std::optional<DeviceView<LO *>> &node_of_finer() const { return node_of_finer_; }

private:
  /// The parents of a refined mesh, which the mesh of order 1 on its cells shares.
  struct Family {
    std::shared_ptr<const mesh::Parents> parents;
    std::shared_ptr<NestedMesh> made; // null until it is asked for
  };
  std::shared_ptr<NestedMesh> make_coarser() const;
  std::shared_ptr<NestedMesh> order_one_of_parent() const;

  fem::Discretization discretization_;
  RCP<const CrsMatrix> to_finer_;
  std::optional<DeviceView<LO *>> node_of_finer_;
  std::shared_ptr<Family> family_; // null if the mesh was not refined
  mutable bool asked_ = false;     // for a coarser one
  mutable std::shared_ptr<const NestedMesh> coarser_;
};

/// A coarser box of the same body, on fewer ranks where it is small. Collective.
fem::Discretization coarser_box(const fem::Discretization &d, const mesh::BoxOptions &options);

/// Interpolation of the values at the owned nodes of a coarse mesh to those of a finer one: step by step where the one leads to the
/// other, else found by a search, see fem::interpolation(). Collective.
RCP<const Operator> interpolation(const NestedMesh &coarse, const NestedMesh &fine);

} // namespace rpc::analysis
