// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/updated_operator.hpp"

#include "rpc/core/error.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <utility>

namespace rpc
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

// Asymmetry by rounding of a w m m^T, over the block's largest entry.
constexpr double rounding_of_symmetry = 1e-14;

/// The place of a node in an ascending list, or -1.
KOKKOS_INLINE_FUNCTION LO place_of(const LO node, const DeviceView<LO *> &nodes)
{
  LO low = 0, high = static_cast<LO>(nodes.extent(0));
  while (low < high) {
    const LO middle = low + (high - low) / 2;
    if (nodes(middle) < node)
      low = middle + 1;
    else
      high = middle;
  }
  return low < static_cast<LO>(nodes.extent(0)) && nodes(low) == node ? low : -1;
}

/// (nodes, dim, dim) The sums of the points' blocks at their nodes.
DeviceView<double ***> summed_at_nodes(const NodePoints &p, const DeviceView<double ***> &block,
                                       const DeviceView<LO *> &nodes)
{
  const DeviceView<double ***> sum("rpc::algebra::update", nodes.extent(0), p.dim, p.dim);
  for_each_point_by_group(
      "rpc::algebra::sum_blocks", p, KOKKOS_LAMBDA(const LO i) {
        const LO at = place_of(p.node(i), nodes);
        if (at < 0) return;
        for (int k = 0; k < p.dim; ++k)
          for (int l = 0; l < p.dim; ++l) sum(at, k, l) += block(i, k, l);
      });
  Kokkos::fence();
  return sum;
}

/// This rank's number of points at other nodes.
LO count_elsewhere(const NodePoints &p, const DeviceView<LO *> &nodes)
{
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::algebra::count_elsewhere", device_range(p.size()),
      KOKKOS_LAMBDA(const LO i, LO &part) { part += place_of(p.node(i), nodes) < 0; }, count);
  return count;
}

/// This rank's number of nodes where two updates differ.
LO count_differences(const DeviceView<double ***> &a, const DeviceView<double ***> &b)
{
  const int dim = static_cast<int>(a.extent(1));
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::algebra::count_differences", device_range(static_cast<LO>(a.extent(0))),
      KOKKOS_LAMBDA(const LO n, LO &part) {
        bool differs = false;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) differs = differs || a(n, k, l) != b(n, k, l);
        part += differs;
      },
      count);
  return count;
}

/// The same of blocks that may be empty, which stands for 0.
LO count_changes(const DeviceView<double ***> &a, const DeviceView<double ***> &b)
{
  if (a.extent(0) == 0 && b.extent(0) == 0) return 0;
  const auto &some = a.extent(0) > 0 ? a : b;
  const DeviceView<double ***> zero("rpc::algebra::no_coupling", some.extent(0), some.extent(1), some.extent(2));
  return count_differences(a.extent(0) > 0 ? a : zero, b.extent(0) > 0 ? b : zero);
}

/// This rank's number of blocks that are not symmetric.
LO count_unsymmetric(const DeviceView<double ***> &block)
{
  const int dim = static_cast<int>(block.extent(1));
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::algebra::count_unsymmetric", device_range(static_cast<LO>(block.extent(0))),
      KOKKOS_LAMBDA(const LO n, LO &part) {
        double largest = 0, difference = 0;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) {
            const double size = block(n, k, l) < 0 ? -block(n, k, l) : block(n, k, l);
            const double twist = block(n, k, l) - block(n, l, k);
            if (size > largest) largest = size;
            if (twist > difference) difference = twist;
          }
        part += difference > rounding_of_symmetry * largest;
      },
      count);
  return count;
}

/// y += alpha U x at the nodes. @param compact  y has the nodes' rows alone, side by side
void add_update(const DeviceView<LO *> &nodes, const DeviceView<double ***> &update, const double alpha,
                const Vector &x, Vector &y, const bool compact = false)
{
  const int dim = static_cast<int>(update.extent(1));
  const auto from = device_read(x);
  const auto to = device_write(y);
  Kokkos::parallel_for(
      "rpc::algebra::add_update", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int k = 0; k < dim; ++k) {
          double sum = 0;
          for (int l = 0; l < dim; ++l) sum += update(n, k, l) * from(dof(dim, nodes(n), l));
          to(dof(dim, compact ? n : nodes(n), k)) += alpha * sum;
        }
      });
  if (compact) Kokkos::fence();
}
void add_update(const DeviceView<LO *> &nodes, const DeviceView<double ***> &update, const double alpha,
                const MultiVector &x, MultiVector &y)
{
  for (std::size_t v = 0; v < x.getNumVectors(); ++v)
    add_update(nodes, update, alpha, *x.getVector(v), *y.getVectorNonConst(v));
}

DeviceView<double ***> sum_of(const DeviceView<double ***> &a, const DeviceView<double ***> &b)
{
  const int dim = static_cast<int>(a.extent(1));
  const DeviceView<double ***> sum("rpc::algebra::updated_blocks", a.extent(0), dim, dim);
  Kokkos::parallel_for(
      "rpc::algebra::updated_blocks", device_range(static_cast<LO>(a.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) sum(n, k, l) = a(n, k, l) + b(n, k, l);
      });
  Kokkos::fence();
  return sum;
}

} // namespace

UpdatedOperator::UpdatedOperator(RCP<const StiffnessOperator> K, DeviceView<LO *> nodes)
    : K_(std::move(K)), nodes_(std::move(nodes)), base_blocks_(K_->diagonal_blocks(nodes_)),
      update_("rpc::algebra::update", nodes_.extent(0), K_->dofs_per_node(), K_->dofs_per_node())
{
}

void UpdatedOperator::apply(const MultiVector &x, MultiVector &y, const Teuchos::ETransp, const double alpha,
                            const double beta) const
{
  K_->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
  add_update(nodes_, update_, alpha, x, y);
  if (coupling_.extent(0) > 0) add_update(nodes_, coupling_, alpha, x, y);
}

void UpdatedOperator::apply_rounded(const MultiVector &x, MultiVector &y) const
{
  apply_base_rounded(x, y);
  add_update(nodes_, update_, 1, x, y);
}

void UpdatedOperator::apply_base_rounded(const MultiVector &x, MultiVector &y) const
{
  if (rounded_)
    K_->apply_rounded(*rounded_, x, y);
  else
    K_->apply(x, y);
}

void UpdatedOperator::allow_rounding(const bool allowed)
{
  if (!allowed)
    rounded_.reset();
  else if (!rounded_)
    rounded_ = rounded_where_it_pays(K_->rows());
}

GO UpdatedOperator::set(const NodePoints &points, const DeviceView<double ***> &block,
                        const DeviceView<double ***> &coupling)
{
  const auto next = summed_at_nodes(points, block, nodes_);
  GO mine[3] = {count_differences(next, update_), count_unsymmetric(next), count_elsewhere(points, nodes_)};
  DeviceView<double ***> next_coupling;
  if (coupling.extent(0) > 0) {
    next_coupling = summed_at_nodes(points, coupling, nodes_);
    mine[1] += count_unsymmetric(next_coupling);
  }
  mine[0] += count_changes(next_coupling, coupling_);
  GO all[3];
  Teuchos::reduceAll(*getDomainMap()->getComm(), Teuchos::REDUCE_SUM, 3, mine, all);
  RPC_REQUIRE_CODE(all[2] == 0, ExitCode::internal_error,
                   "operator: " << all[2] << " points lie at nodes without an update");
  if (all[0] == 0) return 0;
  update_ = next;
  coupling_ = next_coupling;
  symmetric_ = all[1] == 0;
  ++revision_;
  return all[0];
}

void UpdatedOperator::follow(const UpdatedOperator &other)
{
  RPC_REQUIRE_CODE(nodes_.data() == other.nodes_.data(), ExitCode::internal_error,
                   "operator: the one that is followed has other nodes");
  if (revision_ == other.revision_) return;
  update_ = other.update_; // a change of either makes other blocks
  coupling_ = other.coupling_;
  symmetric_ = other.symmetric_;
  revision_ = other.revision_;
}

void UpdatedOperator::add_update_at_nodes(const Vector &x, Vector &y) const
{
  add_update(nodes_, update_, 1, x, y, true);
  if (coupling_.extent(0) > 0) add_update(nodes_, coupling_, 1, x, y, true);
}

DeviceView<double ***> UpdatedOperator::blocks() const
{
  return sum_of(base_blocks_, update_);
}

} // namespace rpc
