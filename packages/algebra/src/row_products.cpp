// SPDX-License-Identifier: BSD-3-Clause
#include "row_products.hpp"

#include "rpc/core/dofs.hpp"

#include <cstddef>

#ifdef RPC_HAS_VECTORS

namespace rpc::row_products
{
namespace
{

/// The rows of `Count` nodes of one kind that follow each other: they share the loads of the kind's blocks, and each has a sum for each
/// column of a block, so that no addition waits for another one.
template <int Count>
__attribute__((always_inline)) inline void multiply_some_3d(const Stencil &stencil, const double *const x,
                                                            double *const y)
{
  Four first[Count] = {}, second[Count] = {}, third[Count] = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + 3 * static_cast<std::ptrdiff_t>(stencil.offset[n]);
    const double *const value = stencil.value + RepeatedRows::block_size(3) * static_cast<std::ptrdiff_t>(n);
    Four p, q, r; // columns of the block; an array of them would go through memory
    __builtin_memcpy(&p, value, sizeof(p));
    __builtin_memcpy(&q, value + 4, sizeof(q));
    __builtin_memcpy(&r, value + 8, sizeof(r));
    for (int c = 0; c < Count; ++c) {
      const double a = from[3 * c], b = from[3 * c + 1], d = from[3 * c + 2];
      first[c] += p * Four{a, a, a, a};
      second[c] += q * Four{b, b, b, b};
      third[c] += r * Four{d, d, d, d};
    }
  }
  for (int c = 0; c < Count; ++c) {
    const Four sum = first[c] + second[c] + third[c];
    for (int i = 0; i < 3; ++i) y[3 * c + i] = sum[i];
  }
}

/// The same in the plane, for `Pairs` pairs of nodes: a vector holds the unknowns of a pair. Entries off the blocks' diagonals have
/// sums of their own, in which the rows of a node are swapped.
template <int Pairs>
__attribute__((always_inline)) inline void multiply_pairs_2d(const Stencil &stencil, const double *const x,
                                                             double *const y)
{
  Four same[Pairs] = {}, swapped[Pairs] = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + 2 * static_cast<std::ptrdiff_t>(stencil.offset[n]);
    const double *const v = stencil.value + RepeatedRows::block_size(2) * static_cast<std::ptrdiff_t>(n);
    const Four diagonal{v[0], v[3], v[0], v[3]}, off{v[1], v[2], v[1], v[2]};
    for (int c = 0; c < Pairs; ++c) {
      Four pair;
      __builtin_memcpy(&pair, from + 4 * c, sizeof(pair));
      same[c] += diagonal * pair;
      swapped[c] += off * pair;
    }
  }
  for (int c = 0; c < Pairs; ++c) {
    const Four other = swapped[c], sum = same[c] + Four{other[1], other[0], other[3], other[2]};
    __builtin_memcpy(y + 4 * c, &sum, sizeof(sum));
  }
}

/// The rows of one node in the plane.
__attribute__((always_inline)) inline void multiply_one_2d(const Stencil &stencil, const double *const x,
                                                           double *const y)
{
  Four sum = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + 2 * static_cast<std::ptrdiff_t>(stencil.offset[n]);
    Four block;
    __builtin_memcpy(&block, stencil.value + RepeatedRows::block_size(2) * static_cast<std::ptrdiff_t>(n),
                     sizeof(block));
    sum += block * Four{from[0], from[0], from[1], from[1]};
  }
  y[0] = sum[0] + sum[2];
  y[1] = sum[1] + sum[3];
}

/// The rows of `Vectors` vectors of nodes with one unknown each.
template <int Vectors>
__attribute__((always_inline)) inline void multiply_some_1d(const Stencil &stencil, const double *const x,
                                                            double *const y)
{
  Four sum[Vectors] = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + stencil.offset[n];
    const double value = stencil.value[n];
    for (int v = 0; v < Vectors; ++v) {
      Four next;
      __builtin_memcpy(&next, from + 4 * v, sizeof(next));
      sum[v] += Four{value, value, value, value} * next;
    }
  }
  for (int v = 0; v < Vectors; ++v) __builtin_memcpy(y + 4 * v, &sum[v], sizeof(Four));
}

/// The rows of some nodes, each entry of a block with a sum of its own: no addition waits for another one.
/// @param x  (columns)   @param y  at the first of the nodes
template <int Dim>
__attribute__((always_inline)) inline void multiply_alone_inline(const NodeRows &rows, const LO first_node,
                                                                 const LO count, const double *const x, double *y)
{
  for (LO node = first_node; node < first_node + count; ++node, y += Dim) {
    const auto first = rows.begin[dof(Dim, node, 0)], length = rows.begin[dof(Dim, node, 0) + 1] - first;
    const double *const value = rows.value + first;
    const LO *const column = rows.column + first;
    double sum[Dim][Dim] = {};
    for (std::size_t e = 0; e < length; e += Dim) {
      const double *const from = x + column[e];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) sum[i][j] += value[i * length + e + j] * from[j];
    }
    for (int i = 0; i < Dim; ++i) {
      double all = sum[i][0];
      for (int j = 1; j < Dim; ++j) all += sum[i][j];
      y[i] = all;
    }
  }
}

} // namespace

// With the widest vectors that the processor has, of four numbers: eight at a time gain nothing in the plane, and a quarter in space
// where they do not slow down the processor.

__attribute__((target_clones("arch=x86-64-v3", "default"))) void
multiply_run(Dimension<1>, const Stencil &stencil, const LO count, const double *x, double *y)
{
  constexpr int vectors = 4;
  LO done = 0;
  for (; done + 4 * vectors <= count; done += 4 * vectors, x += 4 * vectors, y += 4 * vectors)
    multiply_some_1d<vectors>(stencil, x, y);
  for (; done + 4 <= count; done += 4, x += 4, y += 4) multiply_some_1d<1>(stencil, x, y);
  for (; done < count; ++done, ++x, ++y) {
    double sum = 0;
    for (LO n = 0; n < stencil.size; ++n) sum += stencil.value[n] * x[stencil.offset[n]];
    *y = sum;
  }
}
__attribute__((target_clones("arch=x86-64-v3", "default"))) void
multiply_run(Dimension<2>, const Stencil &stencil, const LO count, const double *x, double *y)
{
  constexpr int pairs = 4;
  LO done = 0;
  for (; done + 2 * pairs <= count; done += 2 * pairs, x += 4 * pairs, y += 4 * pairs)
    multiply_pairs_2d<pairs>(stencil, x, y);
  for (; done + 2 <= count; done += 2, x += 4, y += 4) multiply_pairs_2d<1>(stencil, x, y);
  if (done < count) multiply_one_2d(stencil, x, y);
}
__attribute__((target_clones("arch=x86-64-v3", "default"))) void
multiply_run(Dimension<3>, const Stencil &stencil, const LO count, const double *x, double *y)
{
  constexpr int at_once = 4;
  LO done = 0;
  for (; done + at_once <= count; done += at_once, x += 3 * at_once, y += 3 * at_once)
    multiply_some_3d<at_once>(stencil, x, y);
  for (; done < count; ++done, x += 3, y += 3) multiply_some_3d<1>(stencil, x, y);
}

__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"))) void
multiply_alone(Dimension<1>, const NodeRows &rows, const LO first_node, const LO count, const double *const x,
               double *const y)
{
  multiply_alone_inline<1>(rows, first_node, count, x, y);
}
__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"))) void
multiply_alone(Dimension<2>, const NodeRows &rows, const LO first_node, const LO count, const double *const x,
               double *const y)
{
  multiply_alone_inline<2>(rows, first_node, count, x, y);
}
__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"))) void
multiply_alone(Dimension<3>, const NodeRows &rows, const LO first_node, const LO count, const double *const x,
               double *const y)
{
  multiply_alone_inline<3>(rows, first_node, count, x, y);
}

} // namespace rpc::row_products

#endif
