// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/stiffness_operator.hpp"

namespace rpc
{
namespace
{

/// y <- A x for rows of any kind, vector by vector.
template <class Rows>
void multiply_vectors(const Rows &rows, const StiffnessOperator &K, const MultiVector &x, MultiVector &y)
{
  for (std::size_t v = 0; v < y.getNumVectors(); ++v)
    rows.apply(K.at_columns(*x.getVector(v)), *y.getVectorNonConst(v));
}

} // namespace

StiffnessOperator::StiffnessOperator(RCP<const CrsMatrix> K, const int dim)
    : rows_(RepeatedRows::of(K, dim)), dofs_(K->getDomainMap()),
      halo_(std::make_shared<const Halo>(K->getGraph()->getImporter())), matrix_(std::move(K)), assemblies_(1)
{
}

StiffnessOperator::StiffnessOperator(UnassembledMatrix K)
    : rows_(std::move(K.rows)), dofs_(std::move(K.dofs)), halo_(std::move(K.halo)), assemble_(std::move(K.assemble))
{
}

void StiffnessOperator::apply(const MultiVector &x, MultiVector &y, const Teuchos::ETransp, const double alpha,
                              const double beta) const
{
  if (!rows_.pays()) {
    matrix()->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
  } else if (alpha == 1 && beta == 0) {
    multiply_vectors(rows_, *this, x, y);
  } else {
    MultiVector product(y.getMap(), y.getNumVectors(), false);
    multiply_vectors(rows_, *this, x, product);
    y.update(alpha, product, beta);
  }
}

void StiffnessOperator::apply_rounded(const RoundedRows &rounded, const MultiVector &x, MultiVector &y) const
{
  multiply_vectors(rounded, *this, x, y);
}

DeviceView<double ***> StiffnessOperator::diagonal_blocks(const DeviceView<LO *> &nodes) const
{
  const int dim = rows_.dim();
  const DeviceView<double ***> block("rpc::algebra::diagonal_blocks", nodes.extent(0), dim, dim);
  const auto from = rows_.blocks();
  Kokkos::parallel_for(
      "rpc::algebra::diagonal_blocks", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO i) {
        const LO own = from.own(nodes(i));
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) block(i, k, l) = from.entry(nodes(i), own, k, l);
      });
  Kokkos::fence();
  return block;
}

const RCP<const CrsMatrix> &StiffnessOperator::matrix() const
{
  if (matrix_.is_null()) {
    matrix_ = assemble_();
    ++assemblies_;
  }
  return matrix_;
}

RCP<CrsMatrix> StiffnessOperator::copy() const
{
  if (!matrix_.is_null()) return rcp(new CrsMatrix(*matrix_, Teuchos::Copy));
  ++assemblies_;
  return assemble_();
}

} // namespace rpc
