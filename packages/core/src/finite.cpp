// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/finite.hpp"

#include "rpc/core/math.hpp"
#include "rpc/core/on_root.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace rpc
{
namespace
{

constexpr double largest_double = std::numeric_limits<double>::max(); // kernels must not call the function

/// |x|, infinite for a NaN too.
KOKKOS_INLINE_FUNCTION double size_of(const double x)
{
  const double size = x < 0 ? -x : x;
  return size <= largest_double ? size : math::infinity<double>;
}

/// This rank's largest entry; value < 0 if it has none.
Kokkos::ValLocScalar<double, LO> largest_entry(const Vector &v)
{
  using Largest = Kokkos::MaxLoc<double, LO>;
  Largest::value_type result{-1, 0};
  const auto x = device_read(v);
  Kokkos::parallel_reduce(
      "rpc::core::largest_entry", device_range(static_cast<LO>(v.getLocalLength())),
      KOKKOS_LAMBDA(const LO i, Largest::value_type &largest) {
        if (size_of(x(i)) > largest.val) largest = {size_of(x(i)), i};
      },
      Largest(result));
  return result;
}

/// row(i) = the entry of the matrix's row with the largest size.
Vector largest_in_rows(const CrsMatrix &A)
{
  Vector result(A.getRowMap());
  const auto row = device_write(result);
  const auto local = A.getLocalMatrixDevice();
  Kokkos::parallel_for(
      "rpc::core::largest_in_rows", device_range(local.numRows()), KOKKOS_LAMBDA(const LO i) {
        for (auto k = local.graph.row_map(i); k < local.graph.row_map(i + 1); ++k)
          if (size_of(local.values(k)) > size_of(row(i))) row(i) = local.values(k);
      });
  Kokkos::fence();
  return result;
}

/// "nan in direction Y of the node at (0.5, 1)"
std::string describe(const Vector &v, const MultiVector &coordinates, const LO lid)
{
  const int dim = static_cast<int>(coordinates.getNumVectors());
  const auto x = coordinates.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::ostringstream text;
  const double value = v.getLocalViewHost(Tpetra::Access::ReadOnly)(lid, 0);
  text << (std::isnan(value) ? std::abs(value) : value) << " in direction "
       << "XYZ"[lid % dim] << " of the node at (";
  for (int c = 0; c < dim; ++c) text << (c == 0 ? "" : ", ") << x(lid / dim, c);
  text << ")";
  return text.str();
}

[[noreturn]] void refuse(const std::string &what, const Vector &v, const MultiVector &coordinates)
{
  throw Error(ExitCode::bad_input, "deck: " + describe_not_finite(what, v, coordinates) +
                                       "; choose units in which the scene's numbers are closer to 1");
}

} // namespace

std::string find_not_finite(const Vector &v, const MultiVector &coordinates)
{
  const Comm &comm = *v.getMap()->getComm();
  const auto mine = largest_entry(v);
  const double largest = max_all(comm, mine.val);
  const bool here = mine.val >= 0 && mine.val == largest;
  const int rank = min_all(comm, here ? comm.getRank() : comm.getSize() - 1);
  return text_of_rank(comm, rank, here ? describe(v, coordinates, mine.loc) : "");
}

std::string describe_not_finite(const std::string &what, const Vector &v, const MultiVector &coordinates)
{
  const bool overflow = std::isfinite(max_all(*v.getMap()->getComm(), largest_entry(v).val)); // normInf() loses a NaN
  return std::string(overflow ? "numbers whose squares overflow" : "a number that is not finite") +
         " appeared first in " + what + ": " + find_not_finite(v, coordinates);
}

void require_finite(const Vector &v, const std::string &what, const std::function<RCP<MultiVector>()> &coordinates)
{
  if (!std::isfinite(v.norm2())) refuse(what, v, *coordinates());
}

void require_finite(const CrsMatrix &A, const std::string &what, const std::function<RCP<MultiVector>()> &coordinates)
{
  const bool here = squares_are_finite(A.getLocalMatrixDevice(), static_cast<double>(A.getGlobalNumEntries()));
  if (min_all(*A.getComm(), here ? 1 : 0) == 0) refuse(what, largest_in_rows(A), *coordinates());
}

bool squares_are_finite(const CrsMatrix::local_matrix_device_type &rows, const double num_entries)
{
  const double share = std::numeric_limits<double>::max() / num_entries;
  LO bad = 0;
  Kokkos::parallel_reduce(
      "rpc::core::large_entries", device_range(rows.numRows()),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        LO of_row = 0;
        for (auto k = rows.graph.row_map(i); k < rows.graph.row_map(i + 1); ++k)
          of_row += !(rows.values(k) * rows.values(k) <= share);
        count += of_row;
      },
      bad);
  return bad == 0;
}

} // namespace rpc
