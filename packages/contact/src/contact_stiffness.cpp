#include "rpc/contact/contact_stiffness.hpp"

#include <cmath>
#include <utility>

namespace rpc::contact
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

/// Where each contact node's own block of K lies, and what it holds.
void find_diagonal_blocks(const ContactNodes &c, const CrsMatrix &K, const DeviceView<std::size_t **> &block,
                          const DeviceView<double ***> &elastic)
{
  const auto A = K.getLocalMatrixDevice();
  Kokkos::parallel_for(
      "rpc::contact::find_blocks", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) {
          const LO row = c.dim * c.node(i) + k;
          std::size_t at = A.graph.row_map(row);
          while (A.graph.entries(at) != c.dim * c.node(i)) ++at; // an owned node's first column has its first row's lid
          block(i, k) = at;
          for (int l = 0; l < c.dim; ++l) elastic(i, k, l) = A.values(at + l);
        }
      });
  Kokkos::fence();
}

/// (contact nodes) m . K_ii m / (w m . m) of the node's own block; 0 where the direction is.
DeviceView<double *> own_stiffness_of(const ContactNodes &c, const DeviceView<double ***> &elastic)
{
  DeviceView<double *> stiffness("rpc::contact::own_stiffness", c.size());
  Kokkos::parallel_for(
      "rpc::contact::own_stiffness", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        double along = 0, length = 0;
        for (int k = 0; k < c.dim; ++k) {
          length += c.direction(i, k) * c.direction(i, k);
          for (int l = 0; l < c.dim; ++l) along += c.direction(i, k) * elastic(i, k, l) * c.direction(i, l);
        }
        stiffness(i) = length > 0 ? along / (length * c.weight(i)) : 0;
      });
  return stiffness;
}

/// (owned dofs) sum of |m_i|/|m_i|, entry by entry, over the points of each node.
void add_directions(const ContactNodes &c, Vector &directions)
{
  const auto to = device_write(directions);
  for_each_point_by_side(
      "rpc::contact::directions", c, KOKKOS_LAMBDA(const LO i) {
        double length = 0;
        for (int k = 0; k < c.dim; ++k) length += c.direction(i, k) * c.direction(i, k);
        if (length > 0)
          for (int k = 0; k < c.dim; ++k) to(c.dim * c.node(i) + k) += std::fabs(c.direction(i, k)) / std::sqrt(length);
      });
  Kokkos::fence();
}

/// (contact nodes) Sums over the rows of contact nodes of |K| times the directions at the matrix's columns.
void sum_couplings(const ContactNodes &c, const CrsMatrix &K, const Vector &directions,
                   const DeviceView<double *> &stiffness)
{
  const auto A = K.getLocalMatrixDevice();
  const auto at = device_read(directions);
  Kokkos::parallel_for(
      "rpc::contact::sum_couplings", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        double sum = 0, length = 0;
        for (int k = 0; k < c.dim; ++k) {
          const double m = c.direction(i, k);
          const LO row = c.dim * c.node(i) + k;
          length += m * m;
          if (m == 0) continue;
          for (auto e = A.graph.row_map(row); e < A.graph.row_map(row + 1); ++e)
            sum += std::fabs(m * A.values(e)) * at(A.graph.entries(e));
        }
        stiffness(i) = length > 0 ? sum / (length * std::sqrt(length)) : 0;
      });
  Kokkos::fence();
}

/// Brings the contact nodes' own blocks to those of K + sum over points, added w m m^T. All of them, for a node of two
/// sides is two points with one block.
void write_diagonal_blocks(const ContactNodes &c, const DeviceView<double *> &added,
                           const DeviceView<std::size_t **> &block, const DeviceView<double ***> &elastic, CrsMatrix &H)
{
  const auto values = H.getLocalMatrixDevice().values;
  Kokkos::parallel_for(
      "rpc::contact::elastic_blocks", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k)
          for (int l = 0; l < c.dim; ++l) values(block(i, k) + l) = elastic(i, k, l);
      });
  for_each_point_by_side(
      "rpc::contact::stuck_blocks", c, KOKKOS_LAMBDA(const LO i) {
        if (added(i) == 0) return;
        for (int k = 0; k < c.dim; ++k)
          for (int l = 0; l < c.dim; ++l)
            values(block(i, k) + l) += added(i) * c.weight(i) * c.direction(i, k) * c.direction(i, l);
      });
  Kokkos::fence();
}

/// Takes over what is to be added. @return number of nodes where it changed, on this rank
LO take_over(const DeviceView<double *> &from, const DeviceView<double *> &to)
{
  LO changed = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::take_over", device_range(static_cast<LO>(to.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        count += from(i) != to(i);
        to(i) = from(i);
      },
      changed);
  return changed;
}

/// to <- from, at most `most` times a point's own stiffness. @return number of points that it bounds, on this rank
LO bound(const DeviceView<double *> &from, const DeviceView<double *> &own, const double most,
         const DeviceView<double *> &to)
{
  LO bounded = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::bound", device_range(static_cast<LO>(to.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        const bool beyond = from(i) > most * own(i);
        to(i) = beyond ? most * own(i) : from(i);
        count += beyond;
      },
      bounded);
  return bounded;
}

/// (contact nodes) added - written.
DeviceView<double *> difference(const DeviceView<double *> &added, const DeviceView<double *> &written)
{
  const LO n = static_cast<LO>(added.extent(0));
  DeviceView<double *> rest("rpc::contact::unwritten", n);
  Kokkos::parallel_for(
      "rpc::contact::difference", device_range(n), KOKKOS_LAMBDA(const LO i) { rest(i) = added(i) - written(i); });
  Kokkos::fence();
  return rest;
}

LO count_not_zero(const DeviceView<double *> &values)
{
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::count_changes", device_range(static_cast<LO>(values.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &part) { part += values(i) != 0; }, count);
  return count;
}

void list_changes(const ContactNodes &c, const DeviceView<double *> &rest, const ContactStiffness::Changes &list)
{
  Kokkos::parallel_scan(
      "rpc::contact::list_changes", device_range(c.size()), KOKKOS_LAMBDA(const LO i, LO &at, const bool last) {
        if (rest(i) == 0) return;
        if (last) {
          list.node(at) = c.node(i);
          list.coefficient(at) = rest(i) * c.weight(i);
          for (int k = 0; k < c.dim; ++k) list.direction(at, k) = c.direction(i, k);
        }
        ++at;
      });
  Kokkos::fence();
}

} // namespace

ContactStiffness::ContactStiffness(RCP<CrsMatrix> K, const ContactNodes &contact)
    : matrix_(std::move(K)), contact_(contact), added_("rpc::contact::added", contact.size()),
      written_("rpc::contact::written", contact.size()), nothing_("rpc::contact::nothing_added", contact.size()),
      block_("rpc::contact::block", contact.size(), contact.dim),
      elastic_("rpc::contact::elastic", contact.size(), contact.dim, contact.dim)
{
  find_diagonal_blocks(contact_, *matrix_, block_, elastic_);
  own_stiffness_ = own_stiffness_of(contact_, elastic_);
}

void ContactStiffness::apply(const MultiVector &x, MultiVector &y, const Teuchos::ETransp, const double alpha,
                             const double beta) const
{
  if (has_changes_) write_diagonal_blocks(contact_, added_, block_, elastic_, *matrix_);
  matrix_->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
  if (has_changes_) write_diagonal_blocks(contact_, written_, block_, elastic_, *matrix_);
}

void ContactStiffness::apply_elastic(const Vector &u, Vector &Ku) const
{
  write_diagonal_blocks(contact_, nothing_, block_, elastic_, *matrix_);
  matrix_->apply(u, Ku);
  write_diagonal_blocks(contact_, written_, block_, elastic_, *matrix_);
}

const DeviceView<double *> &ContactStiffness::sweep_stiffness() const
{
  if (std::exchange(has_sweep_stiffness_, true)) return sweep_stiffness_;
  Vector directions(getDomainMap());
  add_directions(contact_, directions);
  sweep_stiffness_ = DeviceView<double *>("rpc::contact::sweep_stiffness", contact_.size());
  write_diagonal_blocks(contact_, nothing_, block_, elastic_, *matrix_);
  sum_couplings(contact_, *matrix_, at_columns(*matrix_, directions), sweep_stiffness_);
  write_diagonal_blocks(contact_, written_, block_, elastic_, *matrix_);
  return sweep_stiffness_;
}

GO ContactStiffness::set(const DeviceView<double *> &added)
{
  const GO changed = sum_all(*getDomainMap()->getComm(), GO(take_over(added, added_)));
  if (changed == 0) return 0;
  has_changes_ = true;
  ++revision_;
  return changed;
}

void ContactStiffness::write(const double most)
{
  has_changes_ = sum_all(*getDomainMap()->getComm(), GO(bound(added_, own_stiffness_, most, written_))) > 0;
  write_diagonal_blocks(contact_, written_, block_, elastic_, *matrix_);
}

ContactStiffness::Changes ContactStiffness::changes() const
{
  const auto unwritten = difference(added_, written_);
  const LO n = count_not_zero(unwritten);
  const Changes list{DeviceView<LO *>("rpc::contact::changed_node", n),
                     DeviceView<double **>("rpc::contact::changed_direction", n, contact_.dim),
                     DeviceView<double *>("rpc::contact::changed_stiffness", n)};
  if (n > 0) list_changes(contact_, unwritten, list);
  return list;
}

} // namespace rpc::contact
