// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/nox_vector.hpp"

#include <cmath>

namespace rpc::solver
{

const rpc::Vector &tpetra(const NOX::Abstract::Vector &v)
{
  return dynamic_cast<const NoxVector &>(v).data();
}

NoxVector::NoxVector(const NoxVector &source, const NOX::CopyType type)
    : data_(rcp(new rpc::Vector(source.data_->getMap(), type == NOX::ShapeCopy)))
{
  if (type == NOX::DeepCopy) data_->assign(*source.data_);
}

NOX::Abstract::Vector &NoxVector::init(const double gamma)
{
  data_->putScalar(gamma);
  return *this;
}
NOX::Abstract::Vector &NoxVector::random(bool, int)
{
  data_->randomize();
  return *this;
}
NOX::Abstract::Vector &NoxVector::abs(const NOX::Abstract::Vector &y)
{
  data_->abs(tpetra(y));
  return *this;
}
NoxVector &NoxVector::operator=(const NoxVector &y)
{
  if (data_ != y.data_) data_->assign(*y.data_);
  return *this;
}
NOX::Abstract::Vector &NoxVector::operator=(const NOX::Abstract::Vector &y)
{
  return *this = dynamic_cast<const NoxVector &>(y);
}
NOX::Abstract::Vector &NoxVector::reciprocal(const NOX::Abstract::Vector &y)
{
  data_->reciprocal(tpetra(y));
  return *this;
}
NOX::Abstract::Vector &NoxVector::scale(const double gamma)
{
  data_->scale(gamma);
  return *this;
}
NOX::Abstract::Vector &NoxVector::scale(const NOX::Abstract::Vector &a)
{
  data_->elementWiseMultiply(1., tpetra(a), *data_, 0.);
  return *this;
}
NOX::Abstract::Vector &NoxVector::update(const double alpha, const NOX::Abstract::Vector &a, const double gamma)
{
  data_->update(alpha, tpetra(a), gamma);
  return *this;
}
NOX::Abstract::Vector &NoxVector::update(const double alpha, const NOX::Abstract::Vector &a, const double beta,
                                         const NOX::Abstract::Vector &b, const double gamma)
{
  data_->update(alpha, tpetra(a), beta, tpetra(b), gamma);
  return *this;
}
RCP<NOX::Abstract::Vector> NoxVector::clone(const NOX::CopyType type) const
{
  return rcp(new NoxVector(*this, type));
}

double NoxVector::norm(const NOX::Abstract::Vector::NormType type) const
{
  switch (type) {
  case NOX::Abstract::Vector::MaxNorm:
    return data_->normInf();
  case NOX::Abstract::Vector::OneNorm:
    return data_->norm1();
  default:
    return data_->norm2();
  }
}
double NoxVector::norm(const NOX::Abstract::Vector &weights) const
{
  rpc::Vector weighted(data_->getMap());
  weighted.elementWiseMultiply(1., tpetra(weights), *data_, 0.);
  return std::sqrt(data_->dot(weighted));
}
double NoxVector::innerProduct(const NOX::Abstract::Vector &y) const
{
  return data_->dot(tpetra(y));
}

} // namespace rpc::solver
