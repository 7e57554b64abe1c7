#include "rpc/algebra/updated_operator.hpp"

#include <cmath>

namespace rpc
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

/// (points, dim) Where each node's own block begins in its rows.
DeviceView<std::size_t **> own_entries(const NodePoints &p, const CrsMatrix &K)
{
  const DeviceView<std::size_t **> entry("rpc::operator::entry", p.size(), p.dim);
  const auto A = K.getLocalMatrixDevice();
  Kokkos::parallel_for(
      "rpc::operator::own_entries", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < p.dim; ++k) {
          std::size_t at = A.graph.row_map(p.dof(i, k));
          while (A.graph.entries(at) != p.dof(i, 0)) ++at; // an owned node's first column has its first row's lid
          entry(i, k) = at;
        }
      });
  Kokkos::fence();
  return entry;
}

/// (points, dim, dim) The own blocks of the points' nodes.
DeviceView<double ***> own_blocks(const NodePoints &p, const RepeatedRows &rows)
{
  const DeviceView<double ***> block("rpc::operator::base_blocks", p.size(), p.dim, p.dim);
  const auto from = rows.blocks();
  Kokkos::parallel_for(
      "rpc::operator::own_blocks", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        const LO own = from.own(p.node(i));
        for (int k = 0; k < p.dim; ++k)
          for (int l = 0; l < p.dim; ++l) block(i, k, l) = from.entry(p.node(i), own, k, l);
      });
  Kokkos::fence();
  return block;
}

/// (points) The first point of the same node.
DeviceView<LO *> leads(const NodePoints &p, const LO num_nodes)
{
  const DeviceView<LO *> lead("rpc::operator::lead", p.size()), of_node("rpc::operator::lead_of_node", num_nodes);
  Kokkos::deep_copy(of_node, -1);
  for_each_point_by_group(
      "rpc::operator::find_leads", p, KOKKOS_LAMBDA(const LO i) {
        if (of_node(p.node(i)) < 0) of_node(p.node(i)) = i;
        lead(i) = of_node(p.node(i));
      });
  Kokkos::fence();
  return lead;
}

DeviceView<double *> own_stiffness_of(const NodePoints &p, const DeviceView<double ***> &block)
{
  DeviceView<double *> stiffness("rpc::operator::own_stiffness", p.size());
  Kokkos::parallel_for(
      "rpc::operator::own_stiffness", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        double along = 0;
        for (int k = 0; k < p.dim; ++k)
          for (int l = 0; l < p.dim; ++l) along += p.direction(i, k) * block(i, k, l) * p.direction(i, l);
        const double length = squared_length(p, i);
        stiffness(i) = length > 0 ? along / (length * p.weight(i)) : 0;
      });
  return stiffness;
}

/// directions += |m_i|/|m_i|, entry by entry, at the node of each point.
void add_directions(const NodePoints &p, Vector &directions)
{
  const auto to = device_write(directions);
  for_each_point_by_group(
      "rpc::operator::directions", p, KOKKOS_LAMBDA(const LO i) {
        const double length = squared_length(p, i);
        if (length > 0)
          for (int k = 0; k < p.dim; ++k) to(p.dof(i, k)) += std::fabs(p.direction(i, k)) / std::sqrt(length);
      });
  Kokkos::fence();
}

/// (points) Sums over the rows of the points' nodes of |K| times the directions at the columns.
/// @param directions  (columns)
DeviceView<double *> coupled_stiffness_of(const NodePoints &p, const RepeatedRows &rows, const Vector &directions)
{
  const auto K = rows.blocks();
  const auto at = device_read(directions);
  const DeviceView<double *> stiffness("rpc::operator::coupled_stiffness", p.size());
  Kokkos::parallel_for(
      "rpc::operator::sum_couplings", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        double sum = 0;
        const LO size = K.size(p.node(i));
        for (int k = 0; k < p.dim; ++k) {
          const double m = p.direction(i, k);
          if (m == 0) continue;
          for (LO n = 0; n < size; ++n)
            for (int l = 0; l < p.dim; ++l)
              sum += std::fabs(m * K.entry(p.node(i), n, k, l)) * at(dof(p.dim, K.column(p.node(i), n), l));
        }
        const double length = squared_length(p, i);
        stiffness(i) = length > 0 ? sum / (length * std::sqrt(length)) : 0;
      });
  Kokkos::fence();
  return stiffness;
}

/// block = base + sum over the node's points of added w m m^T, for the leads.
void update_blocks(const NodePoints &p, const DeviceView<LO *> &lead, const DeviceView<double *> &added,
                   const DeviceView<double ***> &base, const DeviceView<double ***> &block)
{
  Kokkos::deep_copy(block, base);
  for_each_point_by_group(
      "rpc::operator::update_blocks", p, KOKKOS_LAMBDA(const LO i) {
        if (added(i) == 0) return;
        for (int k = 0; k < p.dim; ++k)
          for (int l = 0; l < p.dim; ++l)
            block(lead(i), k, l) += added(i) * p.weight(i) * p.direction(i, k) * p.direction(i, l);
      });
  Kokkos::fence();
}

/// Puts the leads' blocks into the matrix.
void write_blocks(const NodePoints &p, const DeviceView<LO *> &lead, const DeviceView<std::size_t **> &entry,
                  const DeviceView<double ***> &block, CrsMatrix &A)
{
  const auto values = A.getLocalMatrixDevice().values;
  Kokkos::parallel_for(
      "rpc::operator::write_blocks", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        if (lead(i) != i) return;
        for (int k = 0; k < p.dim; ++k)
          for (int l = 0; l < p.dim; ++l) values(entry(i, k) + l) = block(i, k, l);
      });
  Kokkos::fence();
}

/// y at the rows of the points' nodes <- these rows of A times x, with other blocks in the place of the nodes' own.
/// @param x  (columns)  @param y  (rows)
void multiply_rows(const NodePoints &p, const DeviceView<LO *> &lead, const DeviceView<std::size_t **> &entry,
                   const DeviceView<double ***> &block, const CrsMatrix &A, const Vector &x, Vector &y)
{
  const auto matrix = A.getLocalMatrixDevice();
  const auto from = device_read(x);
  const auto to = device_write(y);
  Kokkos::parallel_for(
      "rpc::operator::multiply_rows", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        if (lead(i) != i) return;
        for (int k = 0; k < p.dim; ++k) {
          const LO row = p.dof(i, k);
          const std::size_t own = entry(i, k);
          double sum = 0;
          for (std::size_t e = matrix.graph.row_map(row); e < own; ++e)
            sum += matrix.values(e) * from(matrix.graph.entries(e));
          for (int l = 0; l < p.dim; ++l) sum += block(i, k, l) * from(matrix.graph.entries(own + l));
          for (std::size_t e = own + p.dim; e < matrix.graph.row_map(row + 1); ++e)
            sum += matrix.values(e) * from(matrix.graph.entries(e));
          to(row) = sum;
        }
      });
  Kokkos::fence();
}

/// (points) The points' nodes, each once.
DeviceView<LO *> nodes_of_leads(const NodePoints &p, const DeviceView<LO *> &lead)
{
  const DeviceView<LO *> node("rpc::operator::changing_nodes", p.size());
  Kokkos::parallel_for(
      "rpc::operator::changing_nodes", device_range(p.size()),
      KOKKOS_LAMBDA(const LO i) { node(i) = lead(i) == i ? p.node(i) : -1; });
  Kokkos::fence();
  return node;
}

/// Copies the points' blocks to where their nodes' are.
void scatter_blocks(const DeviceView<LO *> &node, const DeviceView<double ***> &from, const DeviceView<double ***> &to)
{
  const int dim = static_cast<int>(from.extent(1));
  Kokkos::parallel_for(
      "rpc::operator::scatter_blocks", device_range(static_cast<LO>(node.extent(0))), KOKKOS_LAMBDA(const LO i) {
        if (node(i) < 0) return;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) to(node(i), k, l) = from(i, k, l);
      });
  Kokkos::fence();
}

/// y at the points' nodes += (block - base) x.
void add_update(const NodePoints &p, const DeviceView<LO *> &lead, const DeviceView<double ***> &block,
                const DeviceView<double ***> &base, const Vector &x, Vector &y)
{
  const auto from = device_read(x); // an owned node's columns have its rows' lids
  const auto to = device_write(y);
  Kokkos::parallel_for(
      "rpc::operator::add_update", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        if (lead(i) != i) return;
        for (int k = 0; k < p.dim; ++k) {
          double sum = 0;
          for (int l = 0; l < p.dim; ++l) sum += (block(i, k, l) - base(i, k, l)) * from(p.dof(i, l));
          to(p.dof(i, k)) += sum;
        }
      });
  Kokkos::fence();
}

/// Takes over what is to be added. @return number of points where it changed, on this rank
LO take_over(const DeviceView<double *> &from, const DeviceView<double *> &to)
{
  LO changed = 0;
  Kokkos::parallel_reduce(
      "rpc::operator::take_over", device_range(static_cast<LO>(to.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        count += from(i) != to(i);
        to(i) = from(i);
      },
      changed);
  return changed;
}

/// to <- from, at most `most` times a point's own stiffness.
/// @return (number of points that it bounds, number of points where anything is added), on this rank
std::pair<LO, LO> bound(const DeviceView<double *> &from, const DeviceView<double *> &own, const double most,
                        const DeviceView<double *> &to)
{
  LO bounded = 0, added = 0;
  Kokkos::parallel_reduce(
      "rpc::operator::bound", device_range(static_cast<LO>(to.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &beyond_bound, LO &not_zero) {
        const bool beyond = from(i) > most * own(i);
        to(i) = beyond ? most * own(i) : from(i);
        beyond_bound += beyond;
        not_zero += to(i) != 0;
      },
      bounded, added);
  return {bounded, added};
}

/// (points) added - written.
DeviceView<double *> difference(const DeviceView<double *> &added, const DeviceView<double *> &written)
{
  const LO n = static_cast<LO>(added.extent(0));
  DeviceView<double *> rest("rpc::operator::unwritten", n);
  Kokkos::parallel_for(
      "rpc::operator::difference", device_range(n), KOKKOS_LAMBDA(const LO i) { rest(i) = added(i) - written(i); });
  Kokkos::fence();
  return rest;
}

LO count_not_zero(const DeviceView<double *> &values)
{
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::operator::count_changes", device_range(static_cast<LO>(values.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &part) { part += values(i) != 0; }, count);
  return count;
}

void list_changes(const NodePoints &p, const DeviceView<double *> &rest, const UpdatedOperator::Changes &list)
{
  Kokkos::parallel_scan(
      "rpc::operator::list_changes", device_range(p.size()), KOKKOS_LAMBDA(const LO i, LO &at, const bool last) {
        if (rest(i) == 0) return;
        if (last) {
          list.node(at) = p.node(i);
          list.coefficient(at) = rest(i) * p.weight(i);
          for (int k = 0; k < p.dim; ++k) list.direction(at, k) = p.direction(i, k);
        }
        ++at;
      });
  Kokkos::fence();
}

} // namespace

UpdatedOperator::UpdatedOperator(const RCP<CrsMatrix> &K, const NodePoints &points)
    : UpdatedOperator({RepeatedRows::of(K, points.dim), K->getDomainMap(), K->getColMap(), K->getGraph()->getImporter(),
                       [K] { return K; }},
                      points)
{
  matrix();
}

UpdatedOperator::UpdatedOperator(UnassembledMatrix K, const NodePoints &points)
    : rows_(std::move(K.rows)), dofs_(std::move(K.dofs)), columns_(std::move(K.columns)),
      importer_(std::move(K.importer)), assemble_(std::move(K.assemble)), points_(points),
      added_("rpc::operator::added", points.size()), written_("rpc::operator::written", points.size()),
      base_blocks_(own_blocks(points_, rows_)), blocks_("rpc::operator::blocks", points.size(), points.dim, points.dim)
{
  Kokkos::deep_copy(blocks_, base_blocks_);
  lead_ = leads(points_, rows_.num_nodes());
  own_stiffness_ = own_stiffness_of(points_, base_blocks_);
  Vector directions(dofs_);
  add_directions(points_, directions);
  coupled_stiffness_ = coupled_stiffness_of(points_, rows_, at_columns(columns_, importer_, directions));
}

const RCP<CrsMatrix> &UpdatedOperator::matrix() const
{
  if (!matrix_.is_null()) return matrix_;
  matrix_ = assemble_();
  entry_ = own_entries(points_, *matrix_);
  return matrix_;
}

void UpdatedOperator::apply_with(const DeviceView<double ***> &blocks, const bool rounded, const MultiVector &x,
                                 MultiVector &y) const
{
  RCP<const MultiVector> columns = Teuchos::rcpFromRef(x);
  if (!importer_.is_null()) {
    const auto imported = rcp(new MultiVector(columns_, x.getNumVectors(), false));
    imported->doImport(x, *importer_, Tpetra::INSERT);
    columns = imported;
  }
  const bool by_rows = rows_.pays();
  if (!by_rows) matrix()->localApply(*columns, y);
  for (std::size_t v = 0; v < x.getNumVectors(); ++v) {
    const auto from = columns->getVector(v);
    const auto to = y.getVectorNonConst(v);
    if (rounded)
      rounded_->apply(*from, *to);
    else if (by_rows)
      rows_.apply(*from, *to);
    if (rounded || (by_rows && !(is_written_ && rows_.reads_matrix())))
      add_update(points_, lead_, blocks, base_blocks_, *from, *to);
    else
      multiply_rows(points_, lead_, entry_, blocks, *matrix(), *from, *to);
  }
}

void UpdatedOperator::apply(const MultiVector &x, MultiVector &y, const Teuchos::ETransp, const double alpha,
                            const double beta) const
{
  if (!has_changes_ && !rows_.pays()) { // the matrix is H
    matrix()->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
  } else if (alpha == 1 && beta == 0) {
    apply_with(blocks_, false, x, y);
  } else {
    MultiVector product(y.getMap(), y.getNumVectors(), false);
    apply_with(blocks_, false, x, product);
    y.update(alpha, product, beta);
  }
}

void UpdatedOperator::apply_base(const Vector &u, Vector &Ku) const
{
  if (is_written_ || rows_.pays())
    apply_with(base_blocks_, false, u, Ku);
  else
    matrix()->apply(u, Ku);
}

void UpdatedOperator::apply_rounded(const MultiVector &x, MultiVector &y) const
{
  if (rounded_)
    apply_with(blocks_, true, x, y);
  else
    apply(x, y);
}

void UpdatedOperator::apply_base_rounded(const MultiVector &x, MultiVector &y) const
{
  apply_with(base_blocks_, rounded_ != nullptr, x, y);
}

void UpdatedOperator::allow_rounding(const bool allowed)
{
  if (!allowed) rounded_.reset();
  constexpr bool on_host = Kokkos::SpaceAccessibility<ExecutionSpace, HostSpace>::accessible;
  if (allowed && on_host && !rounded_ && !is_written_ && rows_.reads_matrix() && rows_.num_kinds() == 0 &&
      rows_.dim() > 1)
    rounded_ = std::make_shared<RoundedRows>(*matrix(), rows_.dim());
}

GO UpdatedOperator::set(const DeviceView<double *> &added)
{
  const GO changed = sum_all(*getDomainMap()->getComm(), GO(take_over(added, added_)));
  if (changed == 0) return 0;
  update_blocks(points_, lead_, added_, base_blocks_, blocks_);
  has_changes_ = true;
  ++revision_;
  return changed;
}

void UpdatedOperator::write(const double most)
{
  const auto [bounded, not_zero] = bound(added_, own_stiffness_, most, written_);
  has_changes_ = sum_all(*getDomainMap()->getComm(), GO(bounded)) > 0;
  is_written_ = sum_all(*getDomainMap()->getComm(), GO(not_zero)) > 0;
  const DeviceView<double ***> blocks("rpc::operator::written_blocks", points_.size(), points_.dim, points_.dim);
  update_blocks(points_, lead_, written_, base_blocks_, blocks);
  const auto A = matrix();
  write_blocks(points_, lead_, entry_, blocks, *A);
}

DeviceView<LO *> UpdatedOperator::changing_nodes() const
{
  return nodes_of_leads(points_, lead_);
}

DeviceView<double ***> UpdatedOperator::base_blocks() const
{
  const auto block = diagonal_blocks(rows_);
  scatter_blocks(changing_nodes(), base_blocks_, block); // where the matrix may be written
  return block;
}

UpdatedOperator::Changes UpdatedOperator::changes() const
{
  const auto unwritten = difference(added_, written_);
  const LO n = count_not_zero(unwritten);
  const Changes list{DeviceView<LO *>("rpc::operator::changed_node", n),
                     DeviceView<double **>("rpc::operator::changed_direction", n, points_.dim),
                     DeviceView<double *>("rpc::operator::changed_stiffness", n)};
  if (n > 0) list_changes(points_, unwritten, list);
  return list;
}

} // namespace rpc
