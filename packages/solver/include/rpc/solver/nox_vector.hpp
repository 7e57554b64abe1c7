// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <NOX_Abstract_Vector.H>

namespace rpc::solver
{

/// A Tpetra vector as NOX wants to see it. Assignment and clones copy values; all norms are collective.
class NoxVector : public NOX::Abstract::Vector
{
public:
  explicit NoxVector(RCP<rpc::Vector> data) : data_(std::move(data)) {}
  NoxVector(const NoxVector &source, NOX::CopyType type);
  NoxVector(const NoxVector &) = delete; // whether data are shared or copied is to be said
  NoxVector &operator=(const NoxVector &y);

  rpc::Vector &data() { return *data_; }
  const rpc::Vector &data() const { return *data_; }

  NOX::Abstract::Vector &init(double gamma) override;
  NOX::Abstract::Vector &random(bool use_seed, int seed) override;
  NOX::Abstract::Vector &abs(const NOX::Abstract::Vector &y) override;
  NOX::Abstract::Vector &operator=(const NOX::Abstract::Vector &y) override;
  NOX::Abstract::Vector &reciprocal(const NOX::Abstract::Vector &y) override;
  NOX::Abstract::Vector &scale(double gamma) override;
  NOX::Abstract::Vector &scale(const NOX::Abstract::Vector &a) override;
  NOX::Abstract::Vector &update(double alpha, const NOX::Abstract::Vector &a, double gamma) override;
  NOX::Abstract::Vector &update(double alpha, const NOX::Abstract::Vector &a, double beta,
                                const NOX::Abstract::Vector &b, double gamma) override;
  RCP<NOX::Abstract::Vector> clone(NOX::CopyType type) const override;
  double norm(NOX::Abstract::Vector::NormType type) const override;
  double norm(const NOX::Abstract::Vector &weights) const override;
  double innerProduct(const NOX::Abstract::Vector &y) const override;
  NOX::size_type length() const override { return static_cast<NOX::size_type>(data_->getGlobalLength()); }

private:
  RCP<rpc::Vector> data_;
};

/// The Tpetra vector behind a NOX vector, which must be a NoxVector.
const rpc::Vector &tpetra(const NOX::Abstract::Vector &v);

} // namespace rpc::solver
