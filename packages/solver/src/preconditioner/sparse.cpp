#include "preconditioner/sparse.hpp"

#include "rpc/algebra/bounded_update.hpp"
#include "rpc/algebra/jacobi.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace rpc::solver
{
namespace
{

// The factor takes closed nodes for at most so many times their own stiffness: all of it would cost digits where they open again. CG
// takes the difference in an iteration.
constexpr double most_closed_stiffness = 1e4;
// New terms are solved for while they take worth_a_factor times a new factor's time at most. Where none of left_out keeps to that, they may
// take worth_factors times the time of all factors made so far, of most_factors_worth at most: later changes are at the same places.
constexpr double worth_a_factor = 0.7, worth_factors = 1.4;
constexpr int most_factors_worth = 3;
constexpr double negligible = 1e-13; // of a block, beside the node's own one
// Where all terms would take longer, those of changes up to such a part of the node's own stiffness are left to CG.       (4.12)
constexpr double left_out[] = {negligible, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

/// A change of a contact node's block, and how large it is beside the node's own stiffness.
struct Change {
  RankOneTerm term;
  double part;
};

/// The differences of two updates as terms of rank one, of this rank.
template <int Dim>
std::vector<Change> changes_of(const UpdatedOperator &H, const DeviceView<double ***> &now,
                               const DeviceView<double ***> &before)
{
  const auto a = to_host(now), b = to_host(before), own = to_host(H.base_blocks());
  const auto node = to_host(H.nodes());
  const Map &dofs = *H.getDomainMap();
  std::vector<Change> changes;
  for (std::size_t n = 0; n < node.extent(0); ++n) {
    double difference[Dim][Dim], largest = 0, stiffness = 0;
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) {
        difference[k][l] = a(n, k, l) - b(n, k, l);
        largest = std::max(largest, std::abs(difference[k][l]));
        stiffness = std::max(stiffness, std::abs(own(n, k, l)));
      }
    if (!(largest > negligible * stiffness)) continue;
    const EigenPairs<Dim> pairs = eigen_pairs(difference);
    for (int k = 0; k < Dim; ++k) {
      if (!(std::abs(pairs.value[k]) > negligible * (largest + stiffness))) continue;
      RankOneTerm term;
      term.first_row = dofs.getGlobalElement(dof(Dim, node(n), 0));
      std::copy(pairs.vector[k], pairs.vector[k] + Dim, term.v);
      term.scale = pairs.value[k];
      changes.push_back({term, largest / stiffness});
    }
  }
  return changes;
}

std::vector<Change> changes_of(const UpdatedOperator &H, const DeviceView<double ***> &now,
                               const DeviceView<double ***> &before)
{
  if (H.dofs_per_node() == 1) return changes_of<1>(H, now, before);
  return H.dofs_per_node() == 2 ? changes_of<2>(H, now, before) : changes_of<3>(H, now, before);
}

} // namespace

const Sparse::Prospect &Sparse::prospect()
{
  if (solver_) return prospect_;
  A_ = H_->base().copy();
  solver_ = std::make_unique<DirectSolver>(A_, H_->dofs_per_node());
  prospect_ = {solver_->cost(), solver_->lacks_memory()};
  return prospect_;
}

/// By terms of rank one, by all of them or by the larger ones, if that takes less time than a new factor, else if it takes not much more
/// than the factors that were made before.
bool Sparse::follow(const DeviceView<double ***> &update)
{
  const std::vector<Change> changes = changes_of(*H_, update, written_);
  for (const double worth : {worth_a_factor, worth_factors * std::min(factors_, most_factors_worth)})
    for (const double least : left_out) {
      std::vector<RankOneTerm> terms;
      for (const Change &change : changes)
        if (change.part > least) terms.push_back(change.term);
      const double seconds = prospect_.cost.seconds_of_column * solver_->num_new(terms);
      if (seconds > worth * prospect_.cost.seconds) continue;
      solver_->add(terms);
      is_fresh_ = false;
      is_exact_ = least == negligible;
      return true;
    }
  return false;
}

Preconditioner::Prepared Sparse::prepare(double)
{
  const int revision = H_->revision();
  if (made_ && revision == revision_) return Prepared::unchanged;
  const auto update = bounded_update(*H_, most_closed_stiffness);
  if (made_ && follow(update)) {
    revision_ = revision;
    return Prepared::updated;
  }
  if (!prospect().obstacle.empty()) throw std::runtime_error(prospect_.obstacle);
  made_ = false;
  written_ = update;
  write_update(*A_, *H_, written_);
  solver_->update();
  ++factors_;
  made_ = is_fresh_ = is_exact_ = true;
  revision_ = revision;
  return Prepared::made;
}

std::string Sparse::description() const
{
  std::ostringstream text;
  text.precision(1);
  text << std::fixed << name() << " of " << H_->getDomainMap()->getGlobalNumElements() << " unknowns, "
       << prospect_.cost.entries / 1e6 << " million entries";
  return text.str();
}

void Sparse::forget()
{
  made_ = false;
  factors_ = 0;
  solver_.reset();
  A_ = Teuchos::null;
}

void Sparse::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) solver_->apply(*x.getVector(k), *y.getVectorNonConst(k));
}

} // namespace rpc::solver
