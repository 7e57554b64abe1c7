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
RPC_BOUND_CLONES double cloned_of_cell_36(const float *A, const double *const *t, const float *sign, const double *b,
                                          float *y)
{
  return PlainProducts::of_cell<36>(A, t, sign, b, y);
}
RPC_BOUND_CLONES double cloned_of_cell_72(const float *A, const double *const *t, const float *sign, const double *b,
                                          float *y)
{
  return PlainProducts::of_cell<72>(A, t, sign, b, y);
}
RPC_BOUND_CLONES double cloned_square_36(const double *A, const double *x)
{
  return PlainProducts::square<36>(A, x);
}

} // namespace

double HostProducts::of_ring(const float *A, const float *x, const int n, float *y)
{
  return cloned_of_ring(A, x, n, y);
}
template <>
double HostProducts::of_cell<36>(const float *A, const double *const *t, const float *sign, const double *b, float *y)
{
  return cloned_of_cell_36(A, t, sign, b, y);
}
template <>
double HostProducts::of_cell<72>(const float *A, const double *const *t, const float *sign, const double *b, float *y)
{
  return cloned_of_cell_72(A, t, sign, b, y);
}
template <>
double HostProducts::square<36>(const double *A, const double *x)
{
  return cloned_square_36(A, x);
}

} // namespace rpc::bound
#undef RPC_BOUND_CLONES
