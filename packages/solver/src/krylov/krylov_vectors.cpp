// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/krylov_vectors.hpp"

#include "rpc/algebra/several_vectors.hpp"

#include <numeric>
#include <utility>

namespace rpc::solver
{
namespace
{

const KrylovVectors &own(const Belos::MultiVec<double> &vectors)
{
  return dynamic_cast<const KrylovVectors &>(vectors);
}

std::vector<RCP<const Vector>> all_of(const KrylovVectors &vectors)
{
  std::vector<RCP<const Vector>> all;
  for (int j = 0; j < vectors.GetNumberVecs(); ++j) all.push_back(vectors.vector(j));
  return all;
}

} // namespace

const RCP<Vector> &KrylovVectors::vector(const int j) const
{
  RCP<Vector> &place = vectors_[j];
  if (place.is_null()) place = rcp(new Vector(map_, false));
  return place;
}

KrylovVectors *KrylovVectors::Clone(const int count) const
{
  return new KrylovVectors(map_, std::vector<RCP<Vector>>(count));
}

KrylovVectors *KrylovVectors::CloneCopy() const
{
  std::vector<int> all(vectors_.size());
  std::iota(all.begin(), all.end(), 0);
  return CloneCopy(all);
}

KrylovVectors *KrylovVectors::CloneCopy(const std::vector<int> &index) const
{
  std::vector<RCP<Vector>> copies;
  for (const int j : index) copies.push_back(rcp(new Vector(*vector(j), Teuchos::Copy)));
  return new KrylovVectors(map_, std::move(copies));
}

KrylovVectors *KrylovVectors::CloneViewNonConst(const std::vector<int> &index)
{
  std::vector<RCP<Vector>> shared;
  for (const int j : index) shared.push_back(vector(j));
  return new KrylovVectors(map_, std::move(shared));
}

const KrylovVectors *KrylovVectors::CloneView(const std::vector<int> &index) const
{
  return const_cast<KrylovVectors *>(this)->CloneViewNonConst(index);
}

void KrylovVectors::MvTimesMatAddMv(const double alpha, const Base &A, const Matrix &B, const double beta)
{
  const auto from = all_of(own(A));
  for (int j = 0; j < GetNumberVecs(); ++j) {
    std::vector<double> factors;
    for (int i = 0; i < B.numRows(); ++i) factors.push_back(alpha * B(i, j));
    add_combination(factors, from, beta, *vector(j));
  }
}

void KrylovVectors::MvAddMv(const double alpha, const Base &A, const double beta, const Base &B)
{
  for (int j = 0; j < GetNumberVecs(); ++j) vector(j)->update(alpha, *own(A).vector(j), beta, *own(B).vector(j), 0.);
}

void KrylovVectors::MvScale(const double alpha)
{
  for (int j = 0; j < GetNumberVecs(); ++j) vector(j)->scale(alpha);
}

void KrylovVectors::MvScale(const std::vector<double> &alpha)
{
  for (int j = 0; j < GetNumberVecs(); ++j) vector(j)->scale(alpha[j]);
}

void KrylovVectors::MvTransMv(const double alpha, const Base &A, Matrix &B) const
{
  const auto with = all_of(own(A));
  for (int j = 0; j < GetNumberVecs(); ++j) {
    const auto products = dots(with, *vector(j));
    for (int i = 0; i < B.numRows(); ++i) B(i, j) = alpha * products[i];
  }
}

void KrylovVectors::MvDot(const Base &A, std::vector<double> &b) const
{
  for (int j = 0; j < GetNumberVecs(); ++j) b[j] = vector(j)->dot(*own(A).vector(j));
}

void KrylovVectors::MvNorm(std::vector<double> &norm, const Belos::NormType type) const
{
  for (int j = 0; j < GetNumberVecs(); ++j)
    norm[j] = type == Belos::OneNorm   ? vector(j)->norm1()
              : type == Belos::InfNorm ? vector(j)->normInf()
                                       : vector(j)->norm2();
}

void KrylovVectors::SetBlock(const Base &A, const std::vector<int> &index)
{
  for (std::size_t k = 0; k < index.size(); ++k) vector(index[k])->assign(*own(A).vector(static_cast<int>(k)));
}

void KrylovVectors::MvRandom()
{
  for (int j = 0; j < GetNumberVecs(); ++j) vector(j)->randomize();
}

void KrylovVectors::MvInit(const double alpha)
{
  for (int j = 0; j < GetNumberVecs(); ++j) vector(j)->putScalar(alpha);
}

void KrylovVectors::MvPrint(std::ostream &out) const
{
  for (int j = 0; j < GetNumberVecs(); ++j) vector(j)->print(out);
}

void OnKrylovVectors::Apply(const Belos::MultiVec<double> &x, Belos::MultiVec<double> &y, Belos::ETrans) const
{
  for (int j = 0; j < x.GetNumberVecs(); ++j) of_->apply(*own(x).vector(j), *own(y).vector(j));
}

} // namespace rpc::solver
