#pragma once

#include <optional>
#include <vector>

namespace rpc::solver
{

/// Some entries of a symmetric matrix, in any order; equal places add up. Each pair of places is given once or twice, as
/// (i, j) and (j, i): entries above the diagonal do not count.
struct SymmetricEntries {
  std::vector<int> row, column;
  std::vector<double> value;
};

/// Cholesky factor of a sparse symmetric positive definite matrix on the host, by LAPACK's band factorization in the reverse
/// Cuthill-McKee order.
class BandCholesky
{
public:
  /// @param size       of the matrix
  /// @param most_work  multiplications that the factor may take: size x (width of the band)^2
  /// @return nothing where it would take more, or the matrix is not positive definite
  static std::optional<BandCholesky> factor(int size, const SymmetricEntries &entries, double most_work);

  /// x <- A^-1 x.
  /// @param x  (size)
  void solve(double *x) const;

private:
  int size_ = 0, width_ = 0;   ///< of the matrix; of the band below the diagonal
  std::vector<int> place_;     ///< (size) of each row in the factor
  std::vector<double> factor_; ///< (width + 1, size) columns of the lower half
};

} // namespace rpc::solver
