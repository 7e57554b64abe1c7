// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/coarse_choice.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/interpolation.hpp"

#include <algorithm>
#include <new>
#include <numeric>
#include <utility>

namespace rpc::analysis
{
namespace
{

/// What each rank gives of its points, or all of it on rank 0.
struct PointRows {
  std::vector<int> length, dof; // of each point, and the unknowns one point after the other
  std::vector<double> value;    // with them
  std::vector<double> weight, stiffness, law;
};

PointRows gathered(const Comm &comm, const PointRows &mine)
{
  const auto all = [&comm](const auto &values) { return gathered_by_root(comm, values); };
  return {all(mine.length), all(mine.dof), all(mine.value), all(mine.weight), all(mine.stiffness), all(mine.law)};
}

/// (unknowns of all ranks) 1 where prescribed, on every rank.
std::vector<char> prescribed_of_all(const Comm &comm, const Map &dofs, const fem::DirichletDofs &dirichlet)
{
  const auto fixed = to_host(dirichlet.fixed);
  std::vector<int> mine;
  for (LO i = 0; i < num_local(dofs); ++i)
    if (fixed(i)) mine.push_back(static_cast<int>(dofs.getGlobalElement(i)));
  std::vector<char> prescribed(dofs.getGlobalNumElements(), 0);
  for (const int dof : gathered_by_all(comm, mine)) prescribed[dof] = 1;
  return prescribed;
}

/// On rank 0.
solver::SymmetricEntries lower_half(const Comm &comm, const CrsMatrix &K)
{
  const Map &rows = *K.getRowMap(), &columns = *K.getColMap();
  const auto local = K.getLocalMatrixHost();
  solver::SymmetricEntries mine;
  for (LO i = 0; i < num_local(rows); ++i) {
    const auto row = static_cast<int>(rows.getGlobalElement(i));
    for (auto k = local.graph.row_map(i); k < local.graph.row_map(i + 1); ++k) {
      const auto column = static_cast<int>(columns.getGlobalElement(local.graph.entries(k)));
      if (column > row) continue;
      mine.row.push_back(row);
      mine.column.push_back(column);
      mine.value.push_back(local.values(k));
    }
  }
  return {gathered_by_root(comm, mine.row), gathered_by_root(comm, mine.column), gathered_by_root(comm, mine.value)};
}

/// (points of this rank)
DeviceView<contact::Foundation *> laws(const contact::ContactNodes &points)
{
  const contact::ContactNodes c = points;
  const DeviceView<contact::Foundation *> law("rpc::analysis::law", c.size());
  Kokkos::parallel_for(
      "rpc::analysis::law", device_range(c.size()), KOKKOS_LAMBDA(const LO i) { law(i) = c.law(i); });
  Kokkos::fence();
  return law;
}

/// The displacements of this rank's points along their directions, by the coarse unknowns that are not prescribed.
PointRows rows_of(const std::vector<LO> &points, const CrsMatrix &interpolation, const std::vector<char> &prescribed,
                  const contact::Iterate &iterate)
{
  const contact::ContactNodes &c = iterate.points();
  const auto local = interpolation.getLocalMatrixHost();
  const Map &coarse_nodes = *interpolation.getColMap();
  const auto node = to_host(c.node);
  const auto direction = to_host(c.direction);
  const auto weight = to_host(c.weight), stiffness = to_host(iterate.own_stiffness());
  const auto law = to_host(laws(c));
  PointRows rows;
  for (const LO i : points) {
    const std::size_t before = rows.dof.size();
    for (auto k = local.graph.row_map(node(i)); k < local.graph.row_map(node(i) + 1); ++k)
      for (int component = 0; component < c.dim; ++component) {
        const auto dof =
            static_cast<int>(rpc::dof(c.dim, coarse_nodes.getGlobalElement(local.graph.entries(k)), component));
        if (prescribed[dof] || direction(i, component) == 0) continue;
        rows.dof.push_back(dof);
        rows.value.push_back(direction(i, component) * local.values(k));
      }
    rows.length.push_back(static_cast<int>(rows.dof.size() - before));
    rows.weight.push_back(weight(i));
    rows.stiffness.push_back(stiffness(i));
    append(law(i), rows.law);
  }
  return rows;
}

CoarseModel model_of(const int size, const solver::SymmetricEntries &K, PointRows rows)
{
  solver::SparseColumns columns;
  std::vector<ModelPoint> points;
  for (std::size_t i = 0; i < rows.length.size(); ++i) {
    columns.begin.push_back(columns.begin.back() + rows.length[i]);
    points.push_back({rows.weight[i], rows.stiffness[i], contact::foundation_of(rows.law, i)});
  }
  columns.row = std::move(rows.dof);
  columns.value = std::move(rows.value);
  return {size, K, std::move(columns), std::move(points)};
}

/// Where it does, states are found without the model.
template <class Work>
void unless_memory_runs_out(const Work &work)
{
  try {
    work();
  } catch (const std::bad_alloc &) { // work has left its result empty
  }
}

/// What rank 0 finds, on all ranks.
bool told_by_root(const Comm &comm, const bool found)
{
  int told = found ? 1 : 0;
  Teuchos::broadcast(comm, 0, &told);
  return told != 0;
}

} // namespace

CoarseChoice::CoarseChoice(RCP<const Comm> comm, std::vector<LO> points, std::optional<CoarseModel> model)
    : comm_(std::move(comm)), points_(std::move(points)), model_(std::move(model))
{
}

bool CoarseChoice::is_small(const Problem &coarse)
{
  return coarse.discretization().owned_dofs->getGlobalNumElements() <=
         static_cast<Tpetra::global_size_t>(choice_rules.most_coarse_unknowns);
}

std::unique_ptr<CoarseChoice> CoarseChoice::make(const Problem &coarse, const fem::DirichletDofs &dirichlet,
                                                 const fem::Discretization &fine, const contact::Iterate &iterate,
                                                 const double solve_seconds)
{
  const fem::Discretization &d = coarse.discretization();
  const Map &dofs = *d.owned_dofs;
  const auto size = static_cast<int>(dofs.getGlobalNumElements());
  const RCP<const Comm> comm = dofs.getComm();
  const auto fixed = to_host(iterate.points().fixed);
  std::vector<LO> points;
  for (LO i = 0; i < iterate.points().size(); ++i)
    if (!fixed(i)) points.push_back(i);
  const auto prescribed = prescribed_of_all(*comm, dofs, dirichlet);
  const auto rows = gathered(*comm, rows_of(points, *fem::interpolation(d, fine), prescribed, iterate));
  const auto K = lower_half(*comm, *coarse.stiffness()->copy());
  std::optional<CoarseModel> model;
  on_root(*comm, ExitCode::internal_error, [&] {
    unless_memory_runs_out([&] { model.emplace(model_of(size, K, rows)); });
    if (model && !model->is_cheap(solve_seconds)) model.reset();
  });
  if (!told_by_root(*comm, model.has_value())) return nullptr;
  return std::unique_ptr<CoarseChoice>(new CoarseChoice(comm, std::move(points), std::move(model)));
}

std::optional<contact::ActiveSetChoice> CoarseChoice::choose(const contact::Iterate &iterate,
                                                             const contact::ActiveSetChoice &present, const Vector &u)
{
  // What pressures would change before the first choice does not tell.
  const auto answer = headway_.count() == 0 ? headway_.take(true) : headway_.add(static_cast<double>(present.changes));
  if (answer == Headway::Answer::stuck) return {};
  const auto v = to_host(contact::penetrations(iterate.functional().points().points, u)), p = to_host(present.pressure);
  const auto picked = [&](const auto &values) {
    std::vector<double> mine;
    for (const LO i : points_) mine.push_back(values(i));
    return gathered_by_root(*comm_, mine);
  };
  auto all_v = picked(v), all_p = picked(p);
  std::optional<ModelStates> found;
  on_root(*comm_, ExitCode::internal_error, [&] {
    unless_memory_runs_out([&] {
      model_->learn(std::move(all_v), std::move(all_p));
      found = model_->choose();
    });
  });
  if (!told_by_root(*comm_, found.has_value())) return {};
  std::vector<int> all_states; // for messages, which know no State
  std::vector<double> all_pressures;
  if (found) {
    for (const contact::State state : found->state) all_states.push_back(static_cast<int>(state));
    all_pressures = std::move(found->pressure);
  }
  std::vector<GO> wanted(points_.size());
  std::iota(wanted.begin(), wanted.end(), sum_before(*comm_, static_cast<GO>(points_.size())));
  const auto states = scattered_from_root(*comm_, all_states, wanted);
  const auto pressures = scattered_from_root(*comm_, all_pressures, wanted);
  const auto unchanged = to_host(present.state);
  std::vector<contact::State> state(unchanged.data(), unchanged.data() + unchanged.size());
  std::vector<double> pressure(p.data(), p.data() + p.size());
  for (std::size_t k = 0; k < points_.size(); ++k) {
    state[points_[k]] = static_cast<contact::State>(states[k]);
    pressure[points_[k]] = pressures[k];
  }
  return contact::ActiveSetChoice{device_values(state, "rpc::analysis::coarse_state"),
                                  device_values(pressure, "rpc::analysis::coarse_pressure")};
}

} // namespace rpc::analysis
