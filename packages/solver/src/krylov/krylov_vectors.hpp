// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <BelosMultiVec.hpp>
#include <BelosOperator.hpp>
#include <vector>

namespace rpc::solver
{

/// Vectors for those methods of Belos that keep many of them, as GMRES does, and orthogonalize each against all others: products of one
/// with the others are fused, see rpc/algebra/several_vectors.hpp. Each vector is made when it is needed first: GMRES asks for as many as
/// it may ever take. Copies and views as Belos wants them: a view shares its vectors. All products are collective.
class KrylovVectors : public Belos::MultiVec<double>
{
public:
  using Base = Belos::MultiVec<double>;
  using Matrix = Teuchos::SerialDenseMatrix<int, double>;

  /// Shares those of `vectors` that are not null; the others are to come.
  KrylovVectors(RCP<const Map> map, std::vector<RCP<Vector>> vectors)
      : map_(std::move(map)), vectors_(std::move(vectors))
  {
  }
  /// Number j, made where there is none, without values.
  const RCP<Vector> &vector(int j) const;

  KrylovVectors *Clone(int count) const override;
  KrylovVectors *CloneCopy() const override;
  KrylovVectors *CloneCopy(const std::vector<int> &index) const override;
  KrylovVectors *CloneViewNonConst(const std::vector<int> &index) override;
  const KrylovVectors *CloneView(const std::vector<int> &index) const override;
  ptrdiff_t GetGlobalLength() const override { return static_cast<ptrdiff_t>(map_->getGlobalNumElements()); }
  int GetNumberVecs() const override { return static_cast<int>(vectors_.size()); }
  void MvTimesMatAddMv(double alpha, const Base &A, const Matrix &B, double beta) override;
  void MvAddMv(double alpha, const Base &A, double beta, const Base &B) override;
  void MvScale(double alpha) override;
  void MvScale(const std::vector<double> &alpha) override;
  void MvTransMv(double alpha, const Base &A, Matrix &B) const override;
  void MvDot(const Base &A, std::vector<double> &b) const override;
  void MvNorm(std::vector<double> &norm, Belos::NormType type) const override;
  void SetBlock(const Base &A, const std::vector<int> &index) override;
  void MvRandom() override;
  void MvInit(double alpha) override;
  void MvPrint(std::ostream &out) const override;

private:
  RCP<const Map> map_;
  mutable std::vector<RCP<Vector>> vectors_; // null: not needed yet
};

/// An operator of Tpetra for these vectors.
class OnKrylovVectors : public Belos::Operator<double>
{
public:
  explicit OnKrylovVectors(RCP<const rpc::Operator> of) : of_(std::move(of)) {}
  void Apply(const Belos::MultiVec<double> &x, Belos::MultiVec<double> &y, Belos::ETrans) const override;

private:
  RCP<const rpc::Operator> of_;
};

} // namespace rpc::solver
