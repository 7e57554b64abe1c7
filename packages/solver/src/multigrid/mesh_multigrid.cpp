// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/mesh_multigrid.hpp"

#include "multigrid/coarse_contact.hpp"
#include "multigrid/contact_supports.hpp"
#include "multigrid/node_interpolation.hpp"
#include "multigrid/node_smoother.hpp"
#include "rpc/algebra/bounded_update.hpp"
#include "rpc/core/math.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace rpc::solver
{
namespace
{

// Bound of the largest eigenvalue of D^-1 C for contact C alone: it is that of an interpolation's mass on a facet, (3/2)^2 on
// quadrilaterals, 2 on triangles, 3/2 on edges.                                                                  (4.7c)
constexpr double largest_of_contact = 2.25;

constexpr const char *not_definite = "multigrid: the matrix of the coarsest mesh is not positive definite";

/// An updated operator as the cycle takes it, up to single precision; or K alone.
class Rounded : public Operator
{
public:
  Rounded(RCP<const UpdatedOperator> H, const bool with_update) : H_(std::move(H)), with_update_(with_update) {}
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const override
  {
    if (with_update_)
      H_->apply_rounded(x, y);
    else
      H_->apply_base_rounded(x, y);
  }
  RCP<const Map> getDomainMap() const override { return H_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return H_->getRangeMap(); }

private:
  RCP<const UpdatedOperator> H_;
  bool with_update_;
};

/// Sum of the changes over the larger one of the sums, in [0, 2], by the norms of the blocks; collective.
double changed_part(const Comm &comm, const DeviceView<double ***> &before, const DeviceView<double ***> &now)
{
  const int dim = static_cast<int>(now.extent(1));
  double mine[3] = {0, 0, 0}, all[3];
  Kokkos::parallel_reduce(
      "rpc::solver::changed_part", device_range(static_cast<LO>(now.extent(0))),
      KOKKOS_LAMBDA(const LO n, double &difference, double &old, double &present) {
        double squares[3] = {};
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) {
            const double a = before(n, k, l), b = now(n, k, l);
            squares[0] += (b - a) * (b - a);
            squares[1] += a * a;
            squares[2] += b * b;
          }
        difference += math::sqrt(squares[0]);
        old += math::sqrt(squares[1]);
        present += math::sqrt(squares[2]);
      },
      mine[0], mine[1], mine[2]);
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 3, mine, all);
  const double whole = std::max(all[1], all[2]);
  return whole > 0 ? all[0] / whole : 0;
}

/// The largest change of a node's block beside its own stiffness; collective.
/// @param own  (nodes, dim, dim) K's own blocks
double largest_change(const Comm &comm, const DeviceView<double ***> &own, const DeviceView<double ***> &before,
                      const DeviceView<double ***> &now)
{
  const int dim = static_cast<int>(now.extent(1));
  double mine = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::largest_change", device_range(static_cast<LO>(now.extent(0))),
      KOKKOS_LAMBDA(const LO n, double &most) {
        double change = 0, stiffness = 0;
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) {
            change = math::larger(change, math::magnitude(now(n, k, l) - before(n, k, l)));
            stiffness = math::larger(stiffness, math::magnitude(own(n, k, l)));
          }
        most = math::larger(most, change / stiffness);
      },
      Kokkos::Max<double>(mine));
  return max_all(comm, std::max(mine, 0.));
}

/// v <- T v or T^T v at the contact nodes, T = H_ii^-1 K_ii with the own blocks of both: the move that is left of v where contact
/// resists it.                                                                                                    (4.7b)
/// @param v  (owned dofs), at the contact nodes   @param kept  (nodes, dim) what T acts on is v less this; T v is added to it
template <int Dim, class Values>
struct Truncate {
  DeviceView<LO *> node;       // (nodes)            in
  DeviceView<double ***> base; // (nodes, Dim, Dim)  in
  NodeBlocks inverse;          //                    in
  bool transposed;             //
  DeviceView<double **> kept;  // (nodes, Dim)       in
  Values v;                    //                    inout

  KOKKOS_FUNCTION void operator()(const LO i) const
  {
    const LO n = node(i), place = inverse.of(n);
    double x[Dim], y[Dim];
    for (int k = 0; k < Dim; ++k) x[k] = v(dof(Dim, n, k)) - kept(i, k);
    for (int pass = 0; pass < 2; ++pass) {
      const bool by_base = (pass == 0) != transposed;
      for (int k = 0; k < Dim; ++k) {
        y[k] = 0;
        for (int l = 0; l < Dim; ++l) y[k] += (by_base ? base(i, k, l) : inverse.block(place, k, l)) * x[l];
      }
      for (int k = 0; k < Dim; ++k) x[k] = y[k];
    }
    for (int k = 0; k < Dim; ++k) v(dof(Dim, n, k)) = kept(i, k) + x[k];
  }
};

void truncate(const DeviceView<LO *> &node, const DeviceView<double ***> &base, const NodeBlocks &inverse,
              const bool transposed, const DeviceView<double **> &kept, Vector &v)
{
  const auto values = device_write(v);
  using Values = std::decay_t<decltype(values)>;
  const auto range = device_range(static_cast<LO>(node.extent(0)));
  if (base.extent(1) == 2)
    Kokkos::parallel_for("rpc::solver::truncate", range,
                         Truncate<2, Values>{node, base, inverse, transposed, kept, values});
  else
    Kokkos::parallel_for("rpc::solver::truncate", range,
                         Truncate<3, Values>{node, base, inverse, transposed, kept, values});
}

/// (nodes, dim) What v is at the contact nodes.
void take_values(const DeviceView<LO *> &node, const Vector &v, const DeviceView<double **> &kept)
{
  const auto from = device_read(v);
  const int dim = static_cast<int>(kept.extent(1));
  Kokkos::parallel_for(
      "rpc::solver::take_values", device_range(static_cast<LO>(node.extent(0))), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < dim; ++k) kept(i, k) = from(dof(dim, node(i), k));
      });
}

} // namespace

/// A mesh, its smoother and its transfer to the next coarser one.
struct MeshMultigrid::Level {
  RCP<const Operator> A;
  std::unique_ptr<NodeSmoother> smoother;
  std::unique_ptr<NodeInterpolation> interpolation; // from the next coarser mesh
  RCP<CoarseContact> coarse;                        // the matrix of the next coarser mesh
  /// This mesh's blocks of contact, of which the coarser one's are made; null: these are made of contact nodes' own.
  RCP<const Map> blocks;
  RCP<Vector> coarse_residual, correction;

  /// @param fine_prescribed  (owned dofs, at least) of this mesh
  void add_transfers(const MeshLevel &coarse, const int dim, const DeviceView<char *> &fine_prescribed)
  {
    const auto coarse_dofs = coarse.dofs();
    interpolation = std::make_unique<NodeInterpolation>(coarse.interpolation, dim, fine_prescribed, coarse.prescribed);
    coarse_residual = rcp(new Vector(coarse_dofs));
    correction = rcp(new Vector(coarse_dofs));
  }
};

MeshMultigrid::MeshMultigrid(RCP<const UpdatedOperator> H, const MeshLevels &levels,
                             const MakeCoarsestSolver &make_coarsest)
    : H_(std::move(H)), contact_node_(H_->nodes()), contact_base_(H_->base_blocks()),
      at_rest_("rpc::solver::at_rest", contact_node_.extent(0), H_->dofs_per_node()),
      kept_("rpc::solver::kept", contact_node_.extent(0), H_->dofs_per_node())
{
  const int dim = H_->dofs_per_node();
  ContactSupports supports = contact_supports(contact_node_, levels.level[0].interpolation->getRangeMap());
  std::size_t direct_to = 0; // the level that they are on, 0 for this mesh
  contact_ = supports.contact;
  for (std::size_t l = 0; l < levels.level.size(); ++l) {
    const MeshLevel &coarse = levels.level[l];
    auto level = std::make_unique<Level>();
    if (l == 0)
      level->A = rcp(new Rounded(H_, true));
    else
      level->A = levels_.back()->coarse;
    level->add_transfers(coarse, dim, l == 0 ? levels.prescribed : levels.level[l - 1].prescribed);
    const auto contact_of = [&](const ContactSupports &of) {
      return rcp(new CoarseContact(of, *coarse.interpolation->getDomainMap(), dim, coarse));
    };
    if (l > 0 && !levels_.back()->coarse->is_bounded()) {
      const ContactSupports of_blocks = levels_.back()->coarse->coarser_supports(*coarse.interpolation);
      level->blocks = of_blocks.contact;
      level->coarse = contact_of(of_blocks);
    }
    if (l == 0 || level->coarse.is_null() || level->coarse->is_bounded()) { // bounds are of contact nodes' own blocks
      for (; direct_to <= l; ++direct_to) supports = coarser(supports, *levels.level[direct_to].interpolation);
      level->blocks = Teuchos::null;
      level->coarse = contact_of(supports);
    }
    if (H_->is_rounded()) level->coarse->allow_rounding(); // where the finest rows repeat, most of the coarse ones do
    levels_.push_back(std::move(level));
  }
  for (std::size_t l = 0; l < levels_.size(); ++l) add_smoother(levels, l); // contact is not in the coarse matrices yet
  contact_of_coarsest_ = write_contact();
  coarsest_ = make_coarsest(levels.level.back());
  if (!coarsest_) throw std::runtime_error(not_definite);
}

void MeshMultigrid::add_smoother(const MeshLevels &levels, const std::size_t l)
{
  const bool is_finest = l == 0;
  Level &level = *levels_[l];
  const CoarseContact *const contact = is_finest ? nullptr : levels_[l - 1]->coarse.get();
  const int order = is_finest ? levels.order : levels.level[l - 1].order;
  const auto block = is_finest ? H_->base().diagonal_blocks() : contact->base_blocks();
  const auto changing = is_finest ? contact_node_ : contact->nodes();
  const Rounded without_contact(H_, false);
  const double largest =
      largest_eigenvalue(is_finest ? static_cast<const Operator &>(without_contact) : *level.A, block);
  level.smoother = std::make_unique<NodeSmoother>(
      level.A, block, changing, std::max(largest, largest_of_contact),
      NodeSmoother::Options{linear_rules.smoother_degree,
                            order == 2 ? linear_rules.smoother_ratio_order_two : linear_rules.smoother_ratio});
}

MeshMultigrid::~MeshMultigrid() = default;

/// @return (contact nodes, dim, dim) what contact adds on coarse meshes                                          (4.7b)
DeviceView<double ***> MeshMultigrid::write_contact()
{
  const auto update = bounded_update(*H_, linear_rules.most_on_coarse_meshes);
  const MultiVector packed = packed_blocks(contact_, update);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const auto &blocks = levels_[l]->blocks;
    levels_[l]->coarse->write(blocks.is_null() ? packed : levels_[l - 1]->coarse->packed_sums(blocks));
  }
  levels_[0]->smoother->set_blocks(contact_node_, H_->blocks());
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    const CoarseContact &contact = *levels_[l - 1]->coarse;
    levels_[l]->smoother->set_blocks(contact.nodes(), contact.blocks());
  }
  return update;
}

bool MeshMultigrid::update(const bool slight_changes_too)
{
  const auto update = write_contact();
  const Comm &comm = *H_->getDomainMap()->getComm();
  const bool changes = changed_part(comm, contact_of_coarsest_, update) > coarsest_->most_change();
  if (!changes && coarsest_is_exact_) return true;
  if (!slight_changes_too &&
      largest_change(comm, contact_base_, contact_of_coarsest_, update) <= linear_rules.slight_change)
    return false;
  contact_of_coarsest_ = update;
  coarsest_is_exact_ =
      coarsest_->update(slight_changes_too ? 0. : linear_rules.slight_change) != CoarsestSolver::Update::rough;
  return coarsest_is_exact_;
}

void MeshMultigrid::cycle(const std::size_t l, const Vector &b, Vector &x) const
{
  if (l == levels_.size()) return coarsest_->apply(b, x);
  const Level &level = *levels_[l];
  const bool finest =
      l == 0; // where coarse functions are truncated at contact points                             (4.7b)
  level.smoother->start(b, x);
  Vector &residual = level.smoother->work();
  level.A->apply(x, residual);
  residual.update(1., b, -1.);
  if (finest) truncate(contact_node_, contact_base_, level.smoother->inverse_blocks(), true, at_rest_, residual);
  level.interpolation->restrict_to(residual, *level.coarse_residual);
  cycle(l + 1, *level.coarse_residual, *level.correction);
  if (finest) take_values(contact_node_, x, kept_);
  level.interpolation->prolong(*level.correction, x, NodeInterpolation::Write::add);
  if (finest) truncate(contact_node_, contact_base_, level.smoother->inverse_blocks(), false, kept_, x);
  level.smoother->improve(b, x);
}

void MeshMultigrid::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) cycle(0, *x.getVector(k), *y.getVectorNonConst(k));
  Kokkos::fence();
}

} // namespace rpc::solver
