// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/coarse_contact.hpp"

#include "multigrid/contact_blocks.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"

#include <utility>

namespace rpc::solver
{
namespace
{

using LocalMatrix = CrsMatrix::local_matrix_device_type;

/// added <- sum over parts of coefficient times the contact node's update, 0 at prescribed unknowns; where there is a matrix, its
/// block <- base + added.
template <class Update>
struct WriteBlocks {
  int dim;
  DeviceView<LO *> row, column, place; // (blocks)
  DeviceView<double ***> base;         // (blocks, dim, dim)
  DeviceView<std::size_t *> begin;     // (blocks + 1)
  DeviceView<int *> contact;           // (parts)
  DeviceView<double *> coefficient;    // (parts)
  DeviceView<char *> prescribed;       // (columns)
  Update update;                       // (near contact nodes, dim * dim)
  DeviceView<double ***> sum, added;   // (blocks, dim, dim)  out
  bool in_place;                       // there is a matrix
  LocalMatrix A;                       //                   out

  KOKKOS_FUNCTION void operator()(const LO b) const
  {
    double block[3][3] = {};
    for (std::size_t k = begin(b); k < begin(b + 1); ++k) {
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) block[i][j] += coefficient(k) * update(contact(k), dim * i + j);
    }
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) {
        const bool held = prescribed(dof(dim, row(b), i)) || prescribed(dof(dim, column(b), j));
        sum(b, i, j) = block[i][j];
        added(b, i, j) = held ? 0 : block[i][j];
        if (in_place)
          A.values(A.graph.row_map(dof(dim, row(b), i)) + dim * place(b) + j) = base(b, i, j) + added(b, i, j);
      }
  }
};

/// (nodes + 1) Where each node's blocks begin; every node has some.
/// @param row  (blocks) of the nodes, in their order
std::vector<std::size_t> first_blocks(const std::vector<LO> &row)
{
  std::vector<std::size_t> first;
  for (std::size_t b = 0; b < row.size(); ++b)
    if (b == 0 || row[b] != row[b - 1]) first.push_back(b);
  first.push_back(row.size());
  return first;
}

} // namespace

MultiVector packed_blocks(const RCP<const Map> &contact, const DeviceView<double ***> &block)
{
  const int dim = static_cast<int>(block.extent(1));
  MultiVector packed(contact, static_cast<std::size_t>(dim) * dim);
  const auto to = packed.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "rpc::solver::pack_blocks", device_range(static_cast<LO>(block.extent(0))), KOKKOS_LAMBDA(const LO c) {
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) to(c, dim * k + l) = block(c, k, l);
      });
  Kokkos::fence();
  return packed;
}

CoarseContact::CoarseContact(const ContactSupports &supports, const Map &nodes, const int dim, const MeshLevel &mesh)
    : dim_(dim), dofs_(mesh.dofs()), A_(mesh.stiffness),
      rows_(mesh.unassembled ? mesh.unassembled->rows : RepeatedRows::of(A_, dim_)),
      halo_(mesh.unassembled ? mesh.unassembled->halo : std::make_shared<const Halo>(A_->getGraph()->getImporter())),
      prescribed_(mesh.prescribed)
{
  const Map &columns = mesh.unassembled ? *mesh.columns : *A_->getColMap();
  const NearSupports near = near_supports(supports, nodes);
  near_ = near.importer;
  const ContactBlocks blocks = contact_blocks(near, rows_, *dofs_, columns);
  const std::size_t n = blocks.row.size();
  base_ = DeviceView<double ***>("rpc::solver::coarse_base", n, dim_, dim_);
  const auto base = Kokkos::create_mirror_view(base_);
  for (std::size_t b = 0; b < n; ++b) {
    for (int i = 0; i < dim_; ++i)
      for (int j = 0; j < dim_; ++j) base(b, i, j) = blocks.base[dim_ * (dim_ * b + i) + j];
    row_gid_.push_back(node_of<GO>(dim_, dofs_->getGlobalElement(dof(dim_, blocks.row[b], 0))));
    column_gid_.push_back(node_of<GO>(dim_, columns.getGlobalElement(dof(dim_, blocks.column[b], 0))));
  }
  row_ = device_values(blocks.row, "rpc::solver::coarse_row");
  column_ = device_values(blocks.column, "rpc::solver::coarse_column");
  place_ = device_values(blocks.place, "rpc::solver::coarse_place");
  own_ = device_values(blocks.own, "rpc::solver::coarse_own");
  nodes_ = device_values(blocks.nodes, "rpc::solver::coarse_nodes");
  first_ = device_values(first_blocks(blocks.row), "rpc::solver::coarse_first");
  sum_ = DeviceView<double ***>("rpc::solver::coarse_sum", n, dim_, dim_);
  added_ = DeviceView<double ***>("rpc::solver::coarse_added", n, dim_, dim_);
  bounded_ = max_all(*dofs_->getComm(), blocks.bounded > 0 ? 1 : 0) == 1;
  begin_ = device_values(blocks.begin, "rpc::solver::coarse_begin");
  contact_ = device_values(blocks.contact, "rpc::solver::coarse_contact");
  coefficient_ = device_values(blocks.coefficient, "rpc::solver::coarse_coefficient");
  Kokkos::deep_copy(base_, base);
}

ContactSupports CoarseContact::coarser_supports(const CrsMatrix &interpolation) const
{
  return supports_of_blocks(row_gid_, column_gid_, interpolation);
}

void CoarseContact::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) {
    const auto from = x.getVector(k);
    const auto to = y.getVectorNonConst(k);
    const Vector &columns = halo_->at_columns(*from);
    if (!rounded_ && !A_.is_null() && !rows_.pays()) { // contact is in all of A's entries
      A_->localApply(columns, *to);
      continue;
    }
    if (rounded_)
      rounded_->apply(columns, *to);
    else
      rows_.apply(columns, *to);
    add_product(columns, *to);
  }
}

void CoarseContact::add_product(const Vector &x, Vector &y) const
{
  const auto from = device_read(x);
  const auto to = device_write(y);
  const auto nodes = nodes_, column = column_;
  const auto first = first_;
  const auto added = added_;
  const auto kind = rows_.blocks().kind;
  const bool in_place = !A_.is_null() && !rounded_; // single precision has no entries with contact
  const int dim = dim_;
  Kokkos::parallel_for(
      "rpc::solver::add_contact", device_range(num_dofs(dim, static_cast<LO>(nodes.extent(0)))),
      KOKKOS_LAMBDA(const LO r) {
        const LO n = node_of(dim, r);
        const int i = component_of(dim, r);
        if (in_place && kind(nodes(n)) < 0) return; // of the rows that do not repeat the matrix itself has been read
        double sum = 0;
        for (std::size_t b = first(n); b < first(n + 1); ++b)
          for (int j = 0; j < dim; ++j) sum += added(b, i, j) * from(dof(dim, column(b), j));
        to(dof(dim, nodes(n), i)) += sum;
      });
}

void CoarseContact::write(const MultiVector &update)
{
  MultiVector near(near_->getTargetMap(), update.getNumVectors());
  near.doImport(update, *near_, Tpetra::INSERT);
  const auto from = near.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const bool in_place = !A_.is_null();
  Kokkos::parallel_for("rpc::solver::write_contact", device_range(static_cast<LO>(row_.extent(0))),
                       WriteBlocks<std::decay_t<decltype(from)>>{
                           dim_, row_, column_, place_, base_, begin_, contact_, coefficient_, prescribed_, from, sum_,
                           added_, in_place, in_place ? A_->getLocalMatrixDevice() : LocalMatrix()});
  Kokkos::fence();
}

DeviceView<double ***> CoarseContact::blocks() const
{
  const DeviceView<double ***> block("rpc::solver::contact_blocks", nodes_.extent(0), dim_, dim_);
  const auto base = base_, added = added_;
  const auto own = own_;
  const int dim = dim_;
  Kokkos::parallel_for(
      "rpc::solver::contact_blocks", device_range(static_cast<LO>(block.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) block(n, i, j) = base(own(n), i, j) + added(own(n), i, j);
      });
  Kokkos::fence();
  return block;
}

} // namespace rpc::solver
