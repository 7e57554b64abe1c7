// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/rounded_rows.hpp"

#include "rpc/core/dofs.hpp"
#include "rpc/core/vectors.hpp"

#include <algorithm>
#include <cstddef>

#ifdef RPC_HAS_VECTORS
#include <immintrin.h>
#endif

namespace rpc
{
namespace
{

using LocalMatrix = CrsMatrix::local_matrix_device_type;

/// Entries of a block: row after row in the plane, column after column in space.
template <int Dim>
KOKKOS_INLINE_FUNCTION constexpr int place_in_block(const int row, const int column)
{
  return Dim == 2 ? 2 * row + column : 3 * column + row;
}

/// The blocks of a node's rows.
template <int Dim>
struct RoundRows {
  LocalMatrix A;                   // in
  DeviceView<std::size_t *> begin; // (owned nodes + 1)      in
  DeviceView<LO *> column;         // (blocks)               out
  DeviceView<float *> value;       // (blocks * Dim * Dim)   out
  DeviceView<double *> sum;        // (owned nodes * Dim * Dim), 0  inout

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const std::size_t first = A.graph.row_map(dof(Dim, node, 0)), length = A.graph.row_map(dof(Dim, node, 1)) - first;
    std::size_t block = begin(node);
    for (std::size_t e = 0; e < length; e += Dim) {
      const LO other = node_of(Dim, A.graph.entries(first + e));
      for (int j = 0; j < Dim; ++j)
        for (int i = 0; i < Dim; ++i) {
          const double entry = A.values(first + i * length + e + j);
          sum(Dim * Dim * node + Dim * i + j) += entry;
          if (other != node) value(Dim * Dim * block + place_in_block<Dim>(i, j)) = static_cast<float>(entry);
        }
      if (other != node) column(block++) = other;
    }
  }
};

/// What a product reads.
struct Blocks {
  const std::size_t *begin;
  const LO *column;
  const float *value;
  const double *sum;
};

template <int Dim>
void multiply_nodes(const Blocks &A, const LO begin, const LO end, const double *const x, double *const y)
{
  for (LO node = begin; node < end; ++node) {
    const double *const own = x + dof(Dim, static_cast<std::ptrdiff_t>(node), 0);
    const double *const s = A.sum + Dim * Dim * static_cast<std::ptrdiff_t>(node);
    double sum[Dim] = {};
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) sum[i] += s[Dim * i + j] * own[j];
    for (std::size_t b = A.begin[node]; b < A.begin[node + 1]; ++b) {
      const double *const from = x + dof(Dim, static_cast<std::ptrdiff_t>(A.column[b]), 0);
      for (int j = 0; j < Dim; ++j)
        for (int i = 0; i < Dim; ++i) sum[i] += A.value[Dim * Dim * b + place_in_block<Dim>(i, j)] * (from[j] - own[j]);
    }
    for (int i = 0; i < Dim; ++i) y[dof(Dim, static_cast<std::ptrdiff_t>(node), i)] = sum[i];
  }
}

#ifdef RPC_HAS_VECTORS

// Compilers do not find these: that four numbers are one load, and a conversion.

__attribute__((target("avx2,fma"))) void multiply_nodes_2d(const Blocks &A, const LO begin, const LO end,
                                                           const double *const x, double *const y)
{
  for (LO node = begin; node < end; ++node) {
    const double *const own = x + dof(2, static_cast<std::ptrdiff_t>(node), 0);
    const __m256d here = _mm256_broadcast_pd(reinterpret_cast<const __m128d *>(own));
    __m256d sum = _mm256_mul_pd(_mm256_loadu_pd(A.sum + 4 * static_cast<std::ptrdiff_t>(node)), here);
    __m256d other = _mm256_setzero_pd();
    const auto term = [&](const std::size_t b, const __m256d to) __attribute__((target("avx2,fma"), always_inline))
    {
      const double *const from = x + dof(2, static_cast<std::ptrdiff_t>(A.column[b]), 0);
      const __m256d apart = _mm256_sub_pd(_mm256_broadcast_pd(reinterpret_cast<const __m128d *>(from)), here);
      return _mm256_fmadd_pd(_mm256_cvtps_pd(_mm_loadu_ps(A.value + 4 * b)), apart, to);
    };
    const std::size_t last = A.begin[node + 1];
    std::size_t b = A.begin[node];
    for (; b + 2 <= last; b += 2) {
      sum = term(b, sum);
      other = term(b + 1, other);
    }
    if (b < last) sum = term(b, sum);
    sum = _mm256_add_pd(sum, other); // parts of rows: 0, 0, 1, 1
    sum = _mm256_hadd_pd(sum, sum);
    double *const to = y + dof(2, static_cast<std::ptrdiff_t>(node), 0);
    _mm_storel_pd(to, _mm256_castpd256_pd128(sum));
    _mm_storel_pd(to + 1, _mm256_extractf128_pd(sum, 1));
  }
}

__attribute__((target("avx2,fma"))) void multiply_nodes_3d(const Blocks &A, const LO begin, const LO end,
                                                           const double *const x, double *const y)
{
  for (LO node = begin; node < end; ++node) {
    const double *const own = x + dof(3, static_cast<std::ptrdiff_t>(node), 0);
    const __m256d here[3] = {_mm256_broadcast_sd(own), _mm256_broadcast_sd(own + 1), _mm256_broadcast_sd(own + 2)};
    __m256d sum[3] = {_mm256_setzero_pd(), _mm256_setzero_pd(),
                      _mm256_setzero_pd()}; // the last number of each is not used
    for (std::size_t b = A.begin[node]; b < A.begin[node + 1]; ++b) {
      const double *const from = x + dof(3, static_cast<std::ptrdiff_t>(A.column[b]), 0);
      for (int j = 0; j < 3; ++j)
        sum[j] = _mm256_fmadd_pd(_mm256_cvtps_pd(_mm_loadu_ps(A.value + 9 * b + 3 * j)),
                                 _mm256_sub_pd(_mm256_broadcast_sd(from + j), here[j]), sum[j]);
    }
    double all[4];
    _mm256_storeu_pd(all, _mm256_add_pd(_mm256_add_pd(sum[0], sum[1]), sum[2]));
    const double *const s = A.sum + 9 * static_cast<std::ptrdiff_t>(node);
    for (int i = 0; i < 3; ++i)
      y[dof(3, static_cast<std::ptrdiff_t>(node), i)] =
          all[i] + s[3 * i] * own[0] + s[3 * i + 1] * own[1] + s[3 * i + 2] * own[2];
  }
}

#endif

using Multiply = void (*)(const Blocks &, LO, LO, const double *, double *);

Multiply multiply_in(const int dim)
{
#ifdef RPC_HAS_VECTORS
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return dim == 2 ? multiply_nodes_2d : multiply_nodes_3d;
#endif
  return dim == 2 ? multiply_nodes<2> : multiply_nodes<3>;
}

/// Where the blocks of each node begin, its own left out. @return number of all
std::size_t find_begins(const LocalMatrix &A, const int dim, const DeviceView<std::size_t *> &begin)
{
  std::size_t num_blocks = 0;
  Kokkos::parallel_scan(
      "rpc::rounded_rows::begin", device_range(static_cast<LO>(begin.extent(0)) - 1),
      KOKKOS_LAMBDA(const LO node, std::size_t &sum, const bool last) {
        sum += (A.graph.row_map(dof(dim, node, 1)) - A.graph.row_map(dof(dim, node, 0))) / dim - 1;
        if (last) begin(node + 1) = sum;
      },
      num_blocks);
  return num_blocks;
}

} // namespace

RoundedRows::RoundedRows(const CrsMatrix &A, const int dim) : dim_(dim)
{
  const LocalMatrix matrix = A.getLocalMatrixDevice();
  const LO num_nodes = node_of(dim, matrix.numRows());
  begin_ = DeviceView<std::size_t *>("rpc::rounded_rows::begin", num_nodes + 1);
  const std::size_t num_blocks = find_begins(matrix, dim, begin_);
  column_ = DeviceView<LO *>(Kokkos::ViewAllocateWithoutInitializing("rpc::rounded_rows::column"), num_blocks);
  value_ = DeviceView<float *>("rpc::rounded_rows::value", dim * dim * num_blocks + 4); // read by fours
  sum_ = DeviceView<double *>("rpc::rounded_rows::sum", dim * dim * num_nodes);
  if (dim == 2)
    Kokkos::parallel_for("rpc::rounded_rows::round", device_range(num_nodes),
                         RoundRows<2>{matrix, begin_, column_, value_, sum_});
  else
    Kokkos::parallel_for("rpc::rounded_rows::round", device_range(num_nodes),
                         RoundRows<3>{matrix, begin_, column_, value_, sum_});
  Kokkos::fence();
}

std::shared_ptr<const RoundedRows> rounded_where_it_pays(const RepeatedRows &rows)
{
  if (on_gpu || rows.matrix().is_null() || rows.num_kinds() > 0 || rows.dim() == 1) return nullptr;
  return std::make_shared<RoundedRows>(*rows.matrix(), rows.dim());
}

void RoundedRows::apply(const Vector &x, Vector &y) const
{
  constexpr LO at_once = 512;
  const auto from = x.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto to = y.getLocalViewHost(Tpetra::Access::OverwriteAll);
  const Blocks blocks{begin_.data(), column_.data(), value_.data(), sum_.data()};
  const double *const source = from.data();
  double *const product = to.data();
  const LO num_nodes = static_cast<LO>(begin_.extent(0)) - 1;
  const Multiply multiply = multiply_in(dim_);
  Kokkos::parallel_for(
      "rpc::rounded_rows::multiply",
      Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, LO>(0, (num_nodes + at_once - 1) / at_once),
      [=](const LO chunk) {
        multiply(blocks, chunk * at_once, std::min((chunk + 1) * at_once, num_nodes), source, product);
      });
  Kokkos::fence();
}

} // namespace rpc
