// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/node_smoother.hpp"

#include "multigrid/chebyshev.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/math.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_LAPACK.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace rpc::solver
{
namespace
{

/// Inverts the symmetric parts of some blocks by their Cholesky factors: blocks of stiff contact have eigenvalues of very different
/// size, and cofactors would lose the small ones.
template <int Dim>
struct InvertBlocks {
  DeviceView<LO *> place;         // (n) in `inverse`; empty: the first n   in
  DeviceView<double ***> block;   // (n, Dim, Dim)                          in
  DeviceView<double ***> inverse; // (blocks, Dim, Dim)                     out

  /// @param bad  counts blocks that are not positive definite
  KOKKOS_FUNCTION void operator()(const LO i, LO &bad) const
  {
    const LO n = place.extent(0) == 0 ? i : place(i);
    double a[Dim][Dim];
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) a[k][l] = 0.5 * (block(i, k, l) + block(i, l, k));
    double factor[Dim][Dim] = {}, back[Dim][Dim] = {};
    for (int k = 0; k < Dim; ++k) {
      double pivot = a[k][k];
      for (int m = 0; m < k; ++m) pivot -= factor[k][m] * factor[k][m];
      if (!(pivot > 0)) {
        ++bad;
        return;
      }
      factor[k][k] = math::sqrt(pivot);
      for (int l = k + 1; l < Dim; ++l) {
        double rest = a[l][k];
        for (int m = 0; m < k; ++m) rest -= factor[l][m] * factor[k][m];
        factor[l][k] = rest / factor[k][k];
      }
    }
    for (int k = 0; k < Dim; ++k) {
      back[k][k] = 1 / factor[k][k];
      for (int l = k + 1; l < Dim; ++l) {
        double sum = 0;
        for (int m = k; m < l; ++m) sum -= factor[l][m] * back[m][k];
        back[l][k] = sum / factor[l][l];
      }
    }
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) {
        double sum = 0;
        for (int m = k > l ? k : l; m < Dim; ++m) sum += back[m][k] * back[m][l];
        inverse(n, k, l) = sum;
      }
  }
};

/// move <- keep move + add D^-1 (b - product), x <- x + move; without a product, x <- move.
template <int Dim, class In, class Out>
struct ChebyshevStep {
  NodeBlocks inverse; //             in
  In b, product;      // (owned dofs) in
  double keep, add;   //
  bool at_zero;       // x = 0, and so is the product
  Out move, x;        // (owned dofs) inout

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const LO place = inverse.of(node);
    double r[Dim];
    for (int k = 0; k < Dim; ++k) {
      const LO i = dof(Dim, node, k);
      r[k] = at_zero ? b(i) : b(i) - product(i);
    }
    for (int k = 0; k < Dim; ++k) {
      const LO i = dof(Dim, node, k);
      double z = 0;
      for (int l = 0; l < Dim; ++l) z += inverse.block(place, k, l) * r[l];
      const double d = keep == 0 ? add * z : keep * move(i) + add * z;
      move(i) = d;
      x(i) = at_zero ? d : x(i) + d;
    }
  }
};

/// z <- D^-1 r, for the eigenvalue.
template <int Dim, class In, class Out>
struct ApplyInverse {
  NodeBlocks inverse; //             in
  In r;               // (owned dofs) in
  Out z;              // (owned dofs) out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const LO place = inverse.of(node);
    for (int k = 0; k < Dim; ++k) {
      double sum = 0;
      for (int l = 0; l < Dim; ++l) sum += inverse.block(place, k, l) * r(dof(Dim, node, l));
      z(dof(Dim, node, k)) = sum;
    }
  }
};

void apply_inverse(const NodeBlocks &inverse, const Vector &r, Vector &z)
{
  const auto from = device_read(r);
  const auto to = device_write(z);
  const auto range = device_range(inverse.num_nodes());
  if (inverse.dim() == 2)
    Kokkos::parallel_for("rpc::solver::apply_inverse", range,
                         ApplyInverse<2, decltype(from), decltype(to)>{inverse, from, to});
  else
    Kokkos::parallel_for("rpc::solver::apply_inverse", range,
                         ApplyInverse<3, decltype(from), decltype(to)>{inverse, from, to});
}

/// Values in [-1, 1] without order that depend on the unknowns' gids alone: the same on any number of ranks.
void fill_without_order(Vector &x)
{
  const auto to = device_write(x);
  const auto map = x.getMap()->getLocalMap();
  Kokkos::parallel_for(
      "rpc::solver::fill_without_order", device_range(static_cast<LO>(x.getLocalLength())), KOKKOS_LAMBDA(const LO i) {
        const std::uint64_t hash = splitmix64(static_cast<std::uint64_t>(map.getGlobalElement(i)));
        to(i) = static_cast<double>(hash >> 11) * (2. / 9007199254740992.) - 1;
      });
  Kokkos::fence();
}

/// Inverts blocks, to some places of the inverses; collective.
void invert(const Comm &comm, const DeviceView<LO *> &place, const DeviceView<double ***> &block,
            const DeviceView<double ***> &inverse)
{
  LO bad = 0;
  const auto range = device_range(static_cast<LO>(block.extent(0)));
  if (inverse.extent(1) == 2)
    Kokkos::parallel_reduce("rpc::solver::invert_blocks", range, InvertBlocks<2>{place, block, inverse}, bad);
  else
    Kokkos::parallel_reduce("rpc::solver::invert_blocks", range, InvertBlocks<3>{place, block, inverse}, bad);
  if (sum_all(comm, GO(bad)) > 0)
    throw std::runtime_error("multigrid: a node's block of the matrix is not positive definite");
}

DeviceView<double ***> unset_blocks(const LO n, const int dim)
{
  return DeviceView<double ***>(Kokkos::ViewAllocateWithoutInitializing("rpc::solver::inverse_blocks"), n, dim, dim);
}

/// The inverses, which `changing` nodes do not share. Collective.
NodeBlocks inverses(const Comm &comm, const NodeBlocks &D, const DeviceView<LO *> &changing)
{
  const LO shared = D.num_blocks(), own = D.place.extent(0) > 0 ? static_cast<LO>(changing.extent(0)) : 0;
  const int dim = D.dim();
  const NodeBlocks inverse{own > 0 ? DeviceView<LO *>("rpc::solver::place_of_inverse", D.num_nodes()) : D.place,
                           unset_blocks(shared + own, dim)};
  invert(comm, {}, D.block, inverse.block);
  if (own == 0) return inverse;
  Kokkos::deep_copy(inverse.place, D.place);
  Kokkos::parallel_for(
      "rpc::solver::own_inverses", device_range(own), KOKKOS_LAMBDA(const LO i) {
        const LO from = inverse.place(changing(i)), to = shared + i;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) inverse.block(to, k, l) = inverse.block(from, k, l);
        inverse.place(changing(i)) = to;
      });
  Kokkos::fence();
  return inverse;
}

} // namespace

double largest_eigenvalue(const Operator &A, const NodeBlocks &D)
{
  const NodeBlocks inverse = inverses(*A.getDomainMap()->getComm(), D, {});
  return largest_eigenvalue(A, [&inverse](const Vector &r, Vector &z) { apply_inverse(inverse, r, z); });
}

/// From the coefficients of the conjugate gradients for some right side.
double largest_eigenvalue(const Operator &A, const std::function<void(const Vector &r, Vector &z)> &apply_inverse)
{
  const auto map = A.getDomainMap();
  Vector r(map), z(map), p(map), q(map);
  fill_without_order(r);
  apply_inverse(r, z);
  p.update(1., z, 0.);
  double rho = r.dot(z);
  const double enough =
      rounding.sum * rounding.sum * rho; // nothing is left where there are fewer eigenvalues than steps
  std::vector<double> diagonal, beside;
  double last_alpha = 1, last_beta = 0;
  for (int k = 0; k < linear_rules.lanczos_steps && rho > enough; ++k) {
    A.apply(p, q);
    const double energy = p.dot(q);
    if (!(energy > 0)) throw std::runtime_error("multigrid: the matrix of a level is not positive definite");
    const double alpha = rho / energy;
    r.update(-alpha, q, 1.);
    apply_inverse(r, z);
    const double next = r.dot(z), beta = next / rho;
    diagonal.push_back(1 / alpha + last_beta / last_alpha);
    beside.push_back(std::sqrt(beta) / alpha);
    p.update(1., z, beta);
    rho = next;
    last_alpha = alpha;
    last_beta = beta;
  }
  if (diagonal.empty()) throw std::runtime_error("multigrid: the matrix of a level is not finite");
  int info = 0;
  double none = 0, work = 0;
  Teuchos::LAPACK<int, double>().STEQR('N', static_cast<int>(diagonal.size()), diagonal.data(), beside.data(), &none, 1,
                                       &work, &info);
  const double largest = linear_rules.lanczos_margin * diagonal.back();
  if (info != 0 || !std::isfinite(largest))
    throw std::runtime_error("multigrid: no largest eigenvalue of a level was found");
  return largest;
}

NodeSmoother::NodeSmoother(RCP<const Operator> A, const NodeBlocks &D, const DeviceView<LO *> &changing,
                           const double largest, const Options &options)
    : A_(std::move(A)), options_(options), inverse_(inverses(*A_->getDomainMap()->getComm(), D, changing)),
      largest_(largest), move_(rcp(new Vector(A_->getDomainMap()))), product_(rcp(new Vector(A_->getDomainMap())))
{
}

void NodeSmoother::set_blocks(const DeviceView<LO *> &node, const DeviceView<double ***> &block)
{
  const NodeBlocks inverse = inverse_;
  const DeviceView<LO *> place(Kokkos::ViewAllocateWithoutInitializing("rpc::solver::place_of_changed"),
                               node.extent(0));
  Kokkos::parallel_for(
      "rpc::solver::places_of_changed", device_range(static_cast<LO>(node.extent(0))),
      KOKKOS_LAMBDA(const LO i) { place(i) = inverse.of(node(i)); });
  Kokkos::fence();
  invert(*A_->getDomainMap()->getComm(), place, block, inverse.block);
}

void NodeSmoother::step(const Vector &b, const double keep, const double add, const bool at_zero, Vector &x) const
{
  const auto from = device_read(b);
  const auto product = device_read(*product_);
  const auto move = device_write(*move_);
  const auto to = device_write(x);
  const auto range = device_range(inverse_.num_nodes());
  using In = std::decay_t<decltype(from)>;
  using Out = std::decay_t<decltype(to)>;
  if (inverse_.dim() == 2)
    Kokkos::parallel_for("rpc::solver::chebyshev_step", range,
                         ChebyshevStep<2, In, Out>{inverse_, from, product, keep, add, at_zero, move, to});
  else
    Kokkos::parallel_for("rpc::solver::chebyshev_step", range,
                         ChebyshevStep<3, In, Out>{inverse_, from, product, keep, add, at_zero, move, to});
}

void NodeSmoother::polynomial(const Vector &b, const bool at_zero, Vector &x) const
{
  chebyshev(largest_, largest_ / options_.ratio, options_.degree,
            [&](const int k, const double keep, const double add) {
              const bool zero = at_zero && k == 0;
              if (!zero) A_->apply(x, *product_);
              step(b, keep, add, zero, x);
            });
}

void NodeSmoother::start(const Vector &b, Vector &x) const
{
  polynomial(b, true, x);
}

void NodeSmoother::improve(const Vector &b, Vector &x) const
{
  polynomial(b, false, x);
}

} // namespace rpc::solver
