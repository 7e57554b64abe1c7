// SPDX-License-Identifier: BSD-3-Clause
#include "factor/local_correction.hpp"

#include "rpc/algebra/bounded_update.hpp"
#include "rpc/core/math.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/sparse_rows.hpp"
#include "rpc/solver/rules.hpp"

#include <KokkosBlas1_axpby.hpp>
#include <KokkosBlas1_scal.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <utility>
#include <vector>

namespace rpc::solver
{
namespace
{

/// Nodes where two updates differ, and the differences. Of this rank.
struct Changes {
  DeviceView<LO *> node;        // (n) owned nodes, ascending
  DeviceView<double ***> block; // (n, dim, dim)

  LO size() const { return static_cast<LO>(node.extent(0)); }
};

/// (nodes, dim, dim) The symmetric part of H's update less what was written; 0 where no entry is more than a part of the node's own
/// stiffness.
DeviceView<double ***> differences(const UpdatedOperator &H, const DeviceView<double ***> &written, const double slight)
{
  const DeviceView<double ***> rest = bounded_update(H);
  const auto own = H.base_blocks();
  const int dim = H.dofs_per_node();
  Kokkos::parallel_for(
      "rpc::solver::differences", device_range(static_cast<LO>(rest.extent(0))), KOKKOS_LAMBDA(const LO n) {
        double largest = 0, stiffness = 0;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) {
            rest(n, k, l) -= written(n, k, l);
            largest = math::fmax(largest, math::fmax(rest(n, k, l), -rest(n, k, l)));
            stiffness = math::fmax(stiffness, math::fmax(own(n, k, l), -own(n, k, l)));
          }
        if (largest > slight * stiffness) return;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) rest(n, k, l) = 0;
      });
  Kokkos::fence();
  return rest;
}

KOKKOS_INLINE_FUNCTION bool is_zero(const DeviceView<double ***> &block, const LO n)
{
  for (std::size_t k = 0; k < block.extent(1); ++k)
    for (std::size_t l = 0; l < block.extent(2); ++l)
      if (block(n, k, l) != 0) return false;
  return true;
}

LO count_not_zero(const DeviceView<double ***> &block)
{
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::count_changes", device_range(static_cast<LO>(block.extent(0))),
      KOKKOS_LAMBDA(const LO n, LO &part) { part += !is_zero(block, n); }, count);
  return count;
}

Changes changes_of(const UpdatedOperator &H, const DeviceView<double ***> &written, const double slight)
{
  const auto rest = differences(H, written, slight);
  const auto nodes = H.nodes();
  const int dim = H.dofs_per_node();
  const LO n = count_not_zero(rest);
  const Changes list{DeviceView<LO *>("rpc::solver::changed_node", n),
                     DeviceView<double ***>("rpc::solver::changed_block", n, dim, dim)};
  Kokkos::parallel_scan(
      "rpc::solver::list_changes", device_range(static_cast<LO>(rest.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &at, const bool last) {
        if (is_zero(rest, i)) return;
        if (last) {
          list.node(at) = nodes(i);
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l < dim; ++l) list.block(at, k, l) = rest(i, k, l);
        }
        ++at;
      });
  Kokkos::fence();
  return list;
}

/// (owned dofs) 1 at the changed nodes, else 0.
void mark_changed(const Changes &changes, const int dim, Vector &mark)
{
  const auto to = device_write(mark);
  const auto node = changes.node;
  Kokkos::parallel_for(
      "rpc::solver::mark_changed", device_range(changes.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < dim; ++k) to(dof(dim, node(i), k)) = 1;
      });
  Kokkos::fence();
}

/// Marks the rows that share an entry with a marked one.
void add_layer(const CrsMatrix &A, Vector &mark)
{
  const Vector columns = at_columns(A, mark);
  const auto from = device_read(columns);
  const auto to = device_write(mark);
  const auto matrix = A.getLocalMatrixDevice();
  Kokkos::parallel_for(
      "rpc::solver::add_layer", device_range(matrix.numRows()), KOKKOS_LAMBDA(const LO row) {
        if (to(row) != 0) return;
        for (auto at = matrix.graph.row_map(row); at < matrix.graph.row_map(row + 1); ++at)
          if (from(matrix.graph.entries(at)) != 0) {
            to(row) = 2; // apart from 1, for rows read others' columns only
            return;
          }
      });
  Kokkos::fence();
}

LO count_marked(const Vector &mark)
{
  const auto from = device_read(mark);
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::count_marked", device_range(static_cast<LO>(mark.getLocalLength())),
      KOKKOS_LAMBDA(const LO row, LO &part) { part += from(row) != 0; }, count);
  return count;
}

/// Turns marks into places in the patch, from 1, and lists this rank's.
void number_members(Vector &mark, const int first, const DeviceView<LO *> &row, const DeviceView<int *> &member)
{
  const auto to = device_write(mark);
  Kokkos::parallel_scan(
      "rpc::solver::number_members", device_range(static_cast<LO>(mark.getLocalLength())),
      KOKKOS_LAMBDA(const LO i, LO &at, const bool last) {
        if (to(i) == 0) return;
        if (last) {
          row(at) = i;
          member(at) = first + at;
        }
        ++at;
      });
  Kokkos::fence();
  Kokkos::parallel_for(
      "rpc::solver::place_members", device_range(static_cast<LO>(row.extent(0))),
      KOKKOS_LAMBDA(const LO i) { to(row(i)) = member(i) + 1; });
  Kokkos::fence();
}

/// @param place  (owned dofs) from 1, 0 outside the patch; collective
PatchColumns patch_columns(const CrsMatrix &A, const Vector &place)
{
  const Vector columns = at_columns(A, place);
  const auto at = device_read(columns);
  const auto matrix = A.getLocalMatrixDevice();
  const LO n = matrix.numRows();
  const DeviceView<LO *> entries("rpc::solver::entries_in_patch", n);
  Kokkos::parallel_for(
      "rpc::solver::count_patch_columns", device_range(n), KOKKOS_LAMBDA(const LO row) {
        LO count = 0;
        for (auto e = matrix.graph.row_map(row); e < matrix.graph.row_map(row + 1); ++e)
          count += at(matrix.graph.entries(e)) != 0;
        entries(row) = count;
      });
  const SparseRows found = sparse_rows(entries, "rpc::solver::patch");
  const auto rows = found.row;
  const auto begin = found.begin;
  const DeviceView<int *> column("rpc::solver::patch_column", found.num_entries);
  const DeviceView<double *> value("rpc::solver::patch_value", found.num_entries);
  Kokkos::parallel_for(
      "rpc::solver::patch_entries", device_range(static_cast<LO>(rows.extent(0))), KOKKOS_LAMBDA(const LO i) {
        std::size_t next = begin(i);
        for (auto e = matrix.graph.row_map(rows(i)); e < matrix.graph.row_map(rows(i) + 1); ++e) {
          const double place_of_column = at(matrix.graph.entries(e));
          if (place_of_column == 0) continue;
          column(next) = static_cast<int>(place_of_column) - 1;
          value(next++) = matrix.values(e);
        }
      });
  Kokkos::fence();
  return {rows, begin, column, value};
}

/// Adds the changes, which lie in the diagonal blocks of patch nodes, to the entries of their rows.
void add_changes(const Changes &changes, const int dim, const Vector &place, const PatchColumns &list)
{
  const auto at = device_read(place);
  const LO num_rows = static_cast<LO>(list.row.extent(0));
  Kokkos::parallel_for(
      "rpc::solver::add_changes", device_range(changes.size()), KOKKOS_LAMBDA(const LO i) {
        const LO first = dof(dim, changes.node(i), 0);
        LO low = 0, high = num_rows; // rows ascend
        while (low < high) {
          const LO middle = (low + high) / 2;
          if (list.row(middle) < first)
            low = middle + 1;
          else
            high = middle;
        }
        for (int k = 0; k < dim; ++k)
          for (std::size_t e = list.begin(low + k); e < list.begin(low + k + 1); ++e)
            for (int l = 0; l < dim; ++l)
              if (list.column(e) == static_cast<int>(at(first + l)) - 1) list.value(e) += changes.block(i, k, l);
      });
  Kokkos::fence();
}

/// The factor of the patch's own block of H, from this rank's rows and all others'.
std::unique_ptr<SparseFactor> factor_of_patch(const Comm &comm, const int size, const PatchColumns &list,
                                              const Vector &place, const double most_work)
{
  const auto rows = to_host(list.row);
  const auto begin = to_host(list.begin);
  const auto column = to_host(list.column);
  const auto value = to_host(list.value);
  const auto at = place.getLocalViewHost(Tpetra::Access::ReadOnly);
  SymmetricEntries mine;
  for (std::size_t i = 0; i < rows.extent(0); ++i) {
    const int member = static_cast<int>(at(rows(i), 0)) - 1;
    for (std::size_t e = begin(i); e < begin(i + 1); ++e) {
      if (column(e) > member) continue; // the other half, or outside the patch
      mine.row.push_back(member);
      mine.column.push_back(column(e));
      mine.value.push_back(value(e));
    }
  }
  return factor_of(size, entries_of_all(comm, mine), most_work);
}

/// This rank's part of x, R x.
DeviceView<double *> restricted(const DeviceView<LO *> &row, const DeviceView<int *> &member, const int size,
                                const Vector &x)
{
  const DeviceView<double *> part("rpc::solver::restricted", size);
  const auto from = device_read(x);
  Kokkos::parallel_for(
      "rpc::solver::restrict", device_range(static_cast<LO>(row.extent(0))),
      KOKKOS_LAMBDA(const LO i) { part(member(i)) = from(row(i)); });
  Kokkos::fence();
  return part;
}

/// y += R^T q on this rank.
void prolong(const DeviceView<LO *> &row, const DeviceView<int *> &member, const DeviceView<double *> &q, Vector &y)
{
  const auto to = device_write(y);
  Kokkos::parallel_for(
      "rpc::solver::prolong", device_range(static_cast<LO>(row.extent(0))),
      KOKKOS_LAMBDA(const LO i) { to(row(i)) += q(member(i)); });
  Kokkos::fence();
}

/// y -= H R^T q on this rank.
void subtract_columns(const PatchColumns &list, const DeviceView<double *> &q, Vector &y)
{
  const auto to = device_write(y);
  Kokkos::parallel_for(
      "rpc::solver::subtract_columns", device_range(static_cast<LO>(list.row.extent(0))), KOKKOS_LAMBDA(const LO i) {
        double sum = 0;
        for (std::size_t e = list.begin(i); e < list.begin(i + 1); ++e) sum += list.value(e) * q(list.column(e));
        to(list.row(i)) -= sum;
      });
  Kokkos::fence();
}

PatchEntries column_after_column(const PatchColumns &list, const int size)
{
  const auto rows = to_host(list.row);
  const auto begin = to_host(list.begin);
  const auto column = to_host(list.column);
  const auto value = to_host(list.value);
  const HostView<std::size_t *> next("rpc::solver::patch_next", size + 1), first("rpc::solver::patch_first", size + 1);
  const HostView<LO *> row("rpc::solver::patch_row", column.extent(0));
  const HostView<double *> sorted("rpc::solver::patch_value", column.extent(0));
  for (std::size_t e = 0; e < column.extent(0); ++e) ++first(column(e) + 1);
  for (int c = 0; c < size; ++c) next(c + 1) = first(c + 1) += first(c);
  for (std::size_t i = 0; i < rows.extent(0); ++i)
    for (std::size_t e = begin(i); e < begin(i + 1); ++e) {
      const std::size_t to = next(column(e))++;
      row(to) = rows(i);
      sorted(to) = value(e);
    }
  return {to_device(first), to_device(row), to_device(sorted)};
}

/// This rank's part of R H x, by the columns of the symmetric H: needs no halo of x.
DeviceView<double *> times_columns(const PatchEntries &list, const int size, const Vector &x)
{
  const DeviceView<double *> sum("rpc::solver::times_columns", size);
  const auto from = device_read(x);
  Kokkos::parallel_for(
      "rpc::solver::times_columns", device_range(size), KOKKOS_LAMBDA(const int c) {
        double own = 0;
        for (std::size_t e = list.begin(c); e < list.begin(c + 1); ++e) own += list.value(e) * from(list.row(e));
        sum(c) = own;
      });
  Kokkos::fence();
  return sum;
}

} // namespace

GO num_changes(const UpdatedOperator &H, const DeviceView<double ***> &written, const double slight)
{
  return sum_all(*H.getDomainMap()->getComm(), GO(count_not_zero(differences(H, written, slight))));
}

std::optional<LocalCorrection> LocalCorrection::around(const UpdatedOperator &H, const CrsMatrix &A,
                                                       const DeviceView<double ***> &written, const double slight)
{
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::local_correction"));
  const Comm &comm = *A.getComm();
  const Changes changes = changes_of(H, written, slight);
  if (sum_all(comm, GO(changes.size())) == 0) return std::nullopt;
  Vector place(A.getRowMap());
  mark_changed(changes, H.dofs_per_node(), place);
  for (int layer = 0; layer < (H.dofs_per_node() == 2 ? linear_rules.layers : 0); ++layer) add_layer(A, place);
  const LO members = count_marked(place);
  const GO size = sum_all(comm, GO(members));
  const double most_work = linear_rules.patch_work * static_cast<double>(A.getGlobalNumRows());
  int through = 0;
  Teuchos::scan(comm, Teuchos::REDUCE_SUM, static_cast<int>(members), Teuchos::outArg(through));

  LocalCorrection correction;
  correction.comm_ = A.getComm();
  correction.size_ = static_cast<int>(size);
  correction.member_row_ = DeviceView<LO *>("rpc::solver::member_row", members);
  correction.member_ = DeviceView<int *>("rpc::solver::member", members);
  number_members(place, through - members, correction.member_row_, correction.member_);
  const PatchColumns list = patch_columns(A, place);
  add_changes(changes, H.dofs_per_node(), place, list);
  correction.factor_ = factor_of_patch(comm, correction.size_, list, place, most_work);
  if (!correction.factor_) return std::nullopt;
  correction.columns_ = list;
  correction.entries_ = column_after_column(list, correction.size_);
  return correction;
}

/// (size) The patch's solution for the sum of all ranks' parts of the right side.
DeviceView<double *> LocalCorrection::solve(const DeviceView<double *> &mine) const
{
  const auto part = to_host(mine);
  const HostView<double *> x("rpc::solver::patch_solution", mine.extent(0));
  if (comm_->getSize() == 1)
    Kokkos::deep_copy(x, part);
  else
    Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, size_, part.data(), x.data());
  factor_->solve(x.data());
  return to_device(x);
}

void LocalCorrection::solve_on_patch(const Vector &b, Vector &q, Vector &rest) const
{
  const auto solved = solve(restricted(member_row_, member_, size_, b));
  q.putScalar(0);
  prolong(member_row_, member_, solved, q);
  rest.update(1., b, 0.);
  subtract_columns(columns_, solved, rest);
}

void LocalCorrection::apply_off_patch(const Operator &M, const Vector &r, Vector &y) const
{
  M.apply(r, y);
  const auto p = solve(times_columns(entries_, size_, y));
  KokkosBlas::scal(p, -1., p);
  prolong(member_row_, member_, p, y);
}

void LocalCorrection::apply(const Operator &M, const Vector &x, Vector &y) const
{
  const auto q = solve(restricted(member_row_, member_, size_, x));
  Vector rest(x, Teuchos::Copy);
  subtract_columns(columns_, q, rest);
  M.apply(rest, y);
  const auto p = solve(times_columns(entries_, size_, y));
  const DeviceView<double *> correction("rpc::solver::correction", size_);
  Kokkos::deep_copy(correction, q);
  KokkosBlas::axpy(-1., p, correction);
  prolong(member_row_, member_, correction, y);
}

} // namespace rpc::solver
