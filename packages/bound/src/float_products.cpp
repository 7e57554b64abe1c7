// SPDX-License-Identifier: BSD-3-Clause
#include "float_products.hpp"

#include "rpc/core/vectors.hpp"

#ifdef RPC_HAS_VECTORS
#define RPC_BOUND_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define RPC_BOUND_CLONES
#endif

namespace rpc::bound
{
namespace
{

RPC_BOUND_CLONES double cloned_of_ring(const float *A, const float *x, const int n, float *y)
{
  return PlainProducts::of_ring(A, x, n, y);
}
RPC_BOUND_CLONES double cloned_of_lower(const float *A, const float *x, const int n, float *y)
{
  return PlainProducts::of_lower(A, x, n, y);
}
RPC_BOUND_CLONES double cloned_of_cell_36(const float *A, const bool lower, const double *const *t, const float *sign,
                                          const double *b, float *y)
{
  return PlainProducts::of_cell<36>(A, lower, t, sign, b, y);
}
RPC_BOUND_CLONES double cloned_of_cell_72(const float *A, const bool lower, const double *const *t, const float *sign,
                                          const double *b, float *y)
{
  return PlainProducts::of_cell<72>(A, lower, t, sign, b, y);
}
RPC_BOUND_CLONES double cloned_square_36(const double *A, const double *x)
{
  return PlainProducts::square<36>(A, x);
}
RPC_BOUND_CLONES void cloned_invert(const int n, double *H)
{
  PlainProducts::invert(n, H);
}
RPC_BOUND_CLONES void cloned_sum_tables(const double *table, const std::size_t apart, const int size,
                                        const double *factor, double *sum)
{
  PlainProducts::sum_tables(table, apart, size, factor, sum);
}
RPC_BOUND_CLONES void cloned_factor_inner(const int nt, const int n, double *rows)
{
  PlainProducts::factor_inner(nt, n, rows);
}
RPC_BOUND_CLONES void cloned_eliminate_inner(const int nt, const int n, double *A)
{
  PlainProducts::eliminate_inner(nt, n, A);
}

} // namespace

double HostProducts::of_ring(const float *A, const float *x, const int n, float *y)
{
  return cloned_of_ring(A, x, n, y);
}
double HostProducts::of_lower(const float *A, const float *x, const int n, float *y)
{
  return cloned_of_lower(A, x, n, y);
}
template <>
double HostProducts::of_cell<36>(const float *A, const bool lower, const double *const *t, const float *sign,
                                 const double *b, float *y)
{
  return cloned_of_cell_36(A, lower, t, sign, b, y);
}
template <>
double HostProducts::of_cell<72>(const float *A, const bool lower, const double *const *t, const float *sign,
                                 const double *b, float *y)
{
  return cloned_of_cell_72(A, lower, t, sign, b, y);
}
template <>
double HostProducts::square<36>(const double *A, const double *x)
{
  return cloned_square_36(A, x);
}
void HostProducts::invert(const int n, double *H)
{
  cloned_invert(n, H);
}
void HostProducts::sum_tables(const double *table, const std::size_t apart, const int size, const double *factor,
                              double *sum)
{
  cloned_sum_tables(table, apart, size, factor, sum);
}
void HostProducts::factor_inner(const int nt, const int n, double *rows)
{
  cloned_factor_inner(nt, n, rows);
}
void HostProducts::eliminate_inner(const int nt, const int n, double *A)
{
  cloned_eliminate_inner(nt, n, A);
}

} // namespace rpc::bound
#undef RPC_BOUND_CLONES
