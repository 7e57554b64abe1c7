// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/nested_mesh.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/fem/order_one.hpp"
#include "rpc/fem/parent_interpolation.hpp"
#include "rpc/mesh/box.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace rpc::analysis
{
namespace
{

/// The next coarser box.
std::optional<fem::Discretization> next_coarser_box(const fem::Discretization &d)
{
  if (!d.mesh->box) return std::nullopt;
  const auto options = mesh::coarsened(*d.mesh->box);
  if (!options) return std::nullopt;
  return coarser_box(d, *options);
}

/// Of nodal values to those of the mesh that has a coarse one as its parents.
RCP<const CrsMatrix> from_parents(const fem::Discretization &coarse, const fem::Discretization &fine,
                                  const mesh::Parents &parents)
{
  if (!parents.nested) return fem::interpolation(coarse, fine);
  return fem::interpolation_from_parents(*coarse.mesh, *fine.mesh, parents);
}

/// Interpolations one after the other.
class Steps : public Operator
{
public:
  /// @param steps  from the coarsest mesh, at least one
  explicit Steps(std::vector<RCP<const CrsMatrix>> steps) : steps_(std::move(steps)) {}
  RCP<const Map> getDomainMap() const override { return steps_.front()->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return steps_.back()->getRangeMap(); }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double alpha, double beta) const override
  {
    RCP<const MultiVector> values = Teuchos::rcpFromRef(x);
    for (std::size_t k = 0; k + 1 < steps_.size(); ++k) {
      const auto next = rcp(new MultiVector(steps_[k]->getRangeMap(), x.getNumVectors()));
      steps_[k]->apply(*values, *next);
      values = next;
    }
    steps_.back()->apply(*values, y, Teuchos::NO_TRANS, alpha, beta);
  }

private:
  std::vector<RCP<const CrsMatrix>> steps_;
};

/// Whether the next coarser mesh is that of order 1 on the same cells.
bool goes_to_order_one(const mesh::Mesh &mesh)
{
  if (mesh.element.order == 1 || mesh.element.mixed()) return false;
  if (!mesh.box) return true;
  const mesh::Element coarser = mesh::coarsened(*mesh.box)->element;
  return coarser.order == 1 && coarser.shape == mesh.element.shape;
}

} // namespace

fem::Discretization coarser_box(const fem::Discretization &d, const mesh::BoxOptions &options)
{
  const auto comm = d.mesh->owned_nodes->getComm();
  return fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(
                             mesh::divided(options, comm->getSize(), linear_rules.least_nodes_of_rank), comm)),
                         d.kinematics);
}

NestedMesh::NestedMesh(fem::Discretization d) : discretization_(std::move(d))
{
  if (const auto &parents = discretization_.mesh->parents) family_ = std::make_shared<Family>(Family{parents, nullptr});
}

bool NestedMesh::may_have_coarser() const
{
  const mesh::Mesh &mesh = *discretization_.mesh;
  return mesh.element.order == 2 || family_ || (mesh.box && mesh::coarsened(*mesh.box));
}

std::shared_ptr<const NestedMesh> NestedMesh::parent() const
{
  if (!family_) return nullptr;
  auto &made = family_->made;
  const mesh::Parents &parents = *family_->parents;
  if (!made) made = std::make_shared<NestedMesh>(fem::discretize(parents.mesh, discretization_.kinematics));
  if (made->to_finer_.is_null() && discretization_.mesh->parents)
    made->to_finer_ = from_parents(made->discretization(), discretization_, parents);
  return made;
}

/// For a mesh of order 1 on the cells of a refined one of order 2: the same of the parents.
std::shared_ptr<NestedMesh> NestedMesh::order_one_of_parent() const
{
  const auto lower = parent()->coarser();
  auto made = std::make_shared<NestedMesh>(lower->discretization());
  made->to_finer_ = from_parents(lower->discretization(), discretization_, *family_->parents);
  made->family_ = lower->family_;
  return made;
}

std::shared_ptr<NestedMesh> NestedMesh::make_coarser() const
{
  const fem::Discretization &d = discretization_;
  if (goes_to_order_one(*d.mesh)) {
    fem::OrderOne lower = fem::order_one(d);
    auto made = std::make_shared<NestedMesh>(fem::discretize(std::move(lower.mesh), d.kinematics));
    made->to_finer_ = lower.interpolation;
    made->node_of_finer_ = lower.node;
    made->family_ = family_;
    return made;
  }
  if (family_ && !d.mesh->parents) return order_one_of_parent();
  auto box = next_coarser_box(d);
  if (!box) return nullptr;
  auto made = std::make_shared<NestedMesh>(std::move(*box));
  made->to_finer_ = fem::interpolation(made->discretization(), d);
  return made;
}

std::shared_ptr<const NestedMesh> NestedMesh::coarser() const
{
  if (std::exchange(asked_, true)) return coarser_;
  if (discretization_.mesh->element.order == 1 && discretization_.mesh->parents)
    coarser_ = parent();
  else
    coarser_ = make_coarser();
  return coarser_;
}

void NestedMesh::forget_coarser() const
{
  coarser_.reset();
  asked_ = false;
  if (family_) family_->made.reset();
}

RCP<const Operator> interpolation(const NestedMesh &coarse, const NestedMesh &fine)
{
  std::vector<RCP<const CrsMatrix>> steps;
  for (const NestedMesh *mesh = fine.made_coarser().get(); mesh; mesh = mesh->made_coarser().get()) {
    steps.insert(steps.begin(), mesh->to_finer());
    if (mesh == &coarse) return rcp(new Steps(std::move(steps)));
  }
  steps.clear();
  for (auto finer = &fine, mesh = fine.made_parent().get(); mesh; finer = mesh, mesh = finer->made_parent().get()) {
    steps.insert(steps.begin(), mesh->to_finer());
    if (mesh == &coarse) return rcp(new Steps(std::move(steps)));
  }
  return fem::interpolation(coarse.discretization(), fine.discretization());
}

} // namespace rpc::analysis
