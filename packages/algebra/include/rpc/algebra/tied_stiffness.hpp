// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/stiffness_operator.hpp"

#include <vector>

namespace rpc
{

/// Unknowns that move as one: each group, such as one component of the displacement of a side that a force moves, has one value, which a
/// shape times the value makes of its members. Groups may have members in common, as the motions of a rigid side do: then they have
/// the same members, and their shapes are orthogonal.
///
/// Vectors have the sum of values times shapes at the members; forces have there the part of all forces that is of this form: where the shape
/// is 1, the mean of the forces. So products of the two are those of the values and the forces along the shapes.   doc/theory.md (2.9a)
struct TiedUnknowns {
  std::vector<DeviceView<LO *>> members;   ///< (groups) this rank's owned unknowns
  std::vector<DeviceView<double *>> shape; ///< (groups) of each member; empty: 1
  std::vector<double> square; ///< (groups) of the shape, over all ranks: the number of members where it is 1
  std::vector<char> adds;     ///< (groups) 1: the members are those of the group before
  DeviceView<int *> group;    ///< (owned unknowns) the first of the groups that it is a member of, or -1

  int size() const { return static_cast<int>(members.size()); }
};

/// (groups) The force along each shape over the shape's square, such as the mean of f over a group, or the values that f has; the same on all
/// ranks; collective.
std::vector<double> means(const TiedUnknowns &tied, const Vector &f);
/// f <- values times shapes at all members. @param value  (groups)
void set_members(const TiedUnknowns &tied, const std::vector<double> &value, Vector &f);

/// The stiffness of a body with groups of tied unknowns z, whose members K takes as prescribed.                    (2.9a)
///
///     A (u, z) = (K u + C z, C^T u + D z),    C = K_FZ, D = K_ZZ of the whole stiffness, rows and columns of a group summed
///
/// All members are collective.
class TiedStiffness : public Operator
{
public:
  /// @param K  the members' unknowns eliminated
  /// @param force  (groups) forces [N/m] on all owned unknowns where a group moves by 1 and nothing else does, at prescribed ones that are
  ///               no members 0; becomes C
  /// @param springs  (groups, groups) stiffness between the values and the ground, a part of D; empty: none
  TiedStiffness(RCP<const StiffnessOperator> K, TiedUnknowns tied, std::vector<RCP<Vector>> force,
                const std::vector<double> &springs = {});

  /// y <- alpha A x + beta y, of one vector; what it has at members beside values times shapes does not count.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return K_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return K_->getRangeMap(); }
  bool hasTransposeApply() const override { return false; }

  /// y becomes A x from K x, or, with an update of K that is 0 at members, the product with the sum of A and the update.
  void couple(const Vector &x, Vector &y) const;

  const TiedUnknowns &tied() const { return tied_; }
  /// A group's column of C, 0 at members.
  const Vector &force(const int group) const { return *force_[group]; }
  /// D of two groups [N/m].
  double stiffness(const int a, const int b) const { return stiffness_[a * tied_.size() + b]; }
  /// (groups) C^T x; collective.
  std::vector<double> forces_of(const Vector &x) const;

private:
  RCP<const StiffnessOperator> K_;
  TiedUnknowns tied_;
  std::vector<RCP<Vector>> force_;
  std::vector<double> stiffness_;
};

} // namespace rpc
