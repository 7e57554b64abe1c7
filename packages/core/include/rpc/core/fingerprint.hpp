// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <cstdint>

/// Numbers of 64 bits that stand for data spread over ranks: a sum of scrambled items, which does not depend on their order.
namespace rpc
{

/// A number in which all bits of the argument take part.
KOKKOS_INLINE_FUNCTION std::uint64_t scrambled(std::uint64_t x)
{
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}
/// The same, by S. Vigna's splitmix64: numbers that follow each other, 0 among them, become unrelated ones.
KOKKOS_INLINE_FUNCTION std::uint64_t splitmix64(const std::uint64_t x)
{
  return scrambled(x + 0x9e3779b97f4a7c15ULL);
}
/// The same of two, whose order counts.
KOKKOS_INLINE_FUNCTION std::uint64_t scrambled(const std::uint64_t a, const std::uint64_t b)
{
  return scrambled(splitmix64(a) ^ b);
}

/// Sum over all ranks modulo 2^64; collective.
inline std::uint64_t sum_of_bits(const Comm &comm, const std::uint64_t mine)
{
  // As halves, for sums of 64 bits would overflow a signed GO.
  const GO halves[2] = {static_cast<GO>(mine & 0xffffffffULL), static_cast<GO>(mine >> 32)};
  GO all[2];
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 2, halves, all);
  return static_cast<std::uint64_t>(all[0]) + (static_cast<std::uint64_t>(all[1]) << 32);
}

} // namespace rpc
