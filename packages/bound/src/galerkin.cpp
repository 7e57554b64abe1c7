// SPDX-License-Identifier: BSD-3-Clause
#include "galerkin.hpp"

#include "boundary.hpp"
#include "hexahedra.hpp"
#include "rpc/fem/rounding.hpp"

#include <algorithm>
#include <memory>

namespace rpc::bound
{
namespace
{

/// How the nodes of a facet are told, and how many a facet has at most.
KOKKOS_INLINE_FUNCTION LO node_of(const Facets &facets, const LO f, const int a)
{
  return a < 2 ? facets.node(f, a) : facets.middle(f);
}
KOKKOS_INLINE_FUNCTION LO node_of(const SpaceFacets &facets, const LO f, const int a)
{
  return facets.node(f, a);
}
/// Facets among which are all on the boundary: the first ones.
LO outer_facets(const CellInput &in)
{
  return in.facets.size();
}
LO outer_facets(const SpaceInput &in)
{
  return in.facets.num_outer;
}
/// The cells of the input at the nodes.
const fem::NodeToCells &around_of(const CellInput &, const fem::Discretization &d)
{
  return d.node_to_cells;
}
const fem::NodeToCells &around_of(const SpaceInput &, const fem::Discretization &d)
{
  return d.node_to_cells;
}
const fem::NodeToCells &around_of(const HexahedraInput &in, const fem::Discretization &)
{
  return in.around;
}
int nodes_of_facets(const CellInput &)
{
  return 3;
}
int nodes_of_facets(const SpaceInput &in)
{
  return static_cast<int>(in.facets.node.extent(1));
}

/// The forces of the known moments minus those in the cells: what a displacement leaves of equilibrium (owned dofs) [N].
/// @param moments, Q  empty: there are none
template <class Input>
RCP<Vector> out_of_balance(const Input &in, const fem::Discretization &d, const DeviceView<double ***> &moments,
                           const DeviceView<double ***> &Q)
{
  constexpr int dim = Input::dim;
  const RCP<Vector> r = rcp(new Vector(d.owned_dofs));
  const auto to = device_write(*r);
  const int nodes = static_cast<int>(in.cells.extent(1)), of_facet = nodes_of_facets(in);
  const fem::NodeToCells around = around_of(in, d);
  const auto facets = in.facets;
  const LO owned = d.mesh->num_owned_nodes(), outer = moments.extent(0) > 0 ? outer_facets(in) : 0;
  const bool in_cells = Q.extent(0) > 0;
  Kokkos::parallel_for(
      "rpc::bound::forces_of_cells", device_range(owned), KOKKOS_LAMBDA(const LO node) {
        for (int i = 0; i < dim; ++i) to(dof(dim, node, i)) = 0;
        for (std::size_t k = around.row(node); in_cells && k < around.row(node + 1); ++k)
          for (int a = 0; a < nodes; ++a)
            if (in.cells(around.cell(k), a) == node)
              for (int i = 0; i < dim; ++i) to(dof(dim, node, i)) -= Q(around.cell(k), a, i);
      });
  Kokkos::parallel_for(
      "rpc::bound::forces_of_facets", device_range(outer), KOKKOS_LAMBDA(const LO f) {
        if (!facets.on_boundary(f)) return;
        for (int a = 0; a < of_facet; ++a) {
          const LO node = node_of(facets, f, a);
          for (int i = 0; i < dim && node >= 0 && node < owned; ++i)
            add_shared(to(dof(dim, node, i)), moments(f, a, i));
        }
      });
  Kokkos::fence();
  return r;
}

} // namespace

RCP<Vector> vector_of(const HostView<double *> &u, const RCP<const Map> &map)
{
  const RCP<Vector> x = rcp(new Vector(map));
  const auto from = to_device(u);
  const auto to = device_write(*x);
  Kokkos::parallel_for(
      "rpc::bound::vector_of", device_range(static_cast<LO>(u.extent(0))),
      KOKKOS_LAMBDA(const LO i) { to(i) = from(i); });
  Kokkos::fence();
  return x;
}

HostView<double *> host_copy(const Vector &u)
{
  const auto x = device_read(u);
  DeviceView<double *> copy("rpc::bound::copy", x.extent(0));
  Kokkos::parallel_for(
      "rpc::bound::copy", device_range(static_cast<LO>(x.extent(0))), KOKKOS_LAMBDA(const LO i) { copy(i) = x(i); });
  Kokkos::fence();
  HostView<double *> host("rpc::bound::copy", x.extent(0));
  Kokkos::deep_copy(host, copy);
  return host;
}

template <class Input>
Solved galerkin_solution(const analysis::Problem &problem, const analysis::StepSolution &s,
                         const solver::LinearSolverOptions &options, const Input &in,
                         const BoundaryTractions &tractions)
{
  constexpr double wanted = 1e-12, enough = 1e-9; // of the forces inside the body
  const fem::Discretization &d = problem.discretization();
  const auto moments = known_moments(in, tractions);
  Solved found;
  const RCP<Vector> u = rcp(new Vector(*s.u, Teuchos::Copy));
  std::unique_ptr<analysis::SolverState> state;
  double before = 0;
  for (int pass = 0;; ++pass) {
    found.Q = nodal_forces(in, d, *fem::on_overlap(d, *u));
    const RCP<Vector> r = out_of_balance(in, d, moments, found.Q);
    fem::clear_prescribed(s.step.elastic.dirichlet, *r);
    const double left = r->norm2() / std::max(fem::internal_work(d, problem.model().materials, *u).force_norm, 1e-300);
    if (left <= wanted || pass == 4 || (pass > 0 && left > before / 2)) {
      const fem::Materials &materials = problem.model().materials;
      if (!(left <= enough))
        found.failure =
            fem::internal_work(d, materials, *u).energy_norm_squared / 2 <= fem::rounding_energy(d, materials, *u)
                ? "nothing is strained but by rounding"
                : "the elastic solve leaves " + shown(left) + " of the forces out of balance";
      break;
    }
    before = left;
    found.Q = {}; // memory
    if (!state) state = std::make_unique<analysis::SolverState>(problem, options);
    Vector x(d.owned_dofs);
    const auto result = state->linear().solve(*r, x, 0.1 * wanted / left + 1e-12);
    found.iterations += result.iterations;
    if (!result.converged && result.broken) {
      found.failure = "the elastic solve failed: " + result.reason;
      break;
    }
    u->update(1, x, 1);
  }
  found.u = u;
  return found;
}

template <class Input>
double work_of(const fem::Discretization &d, const DeviceView<double ***> &moments, const Input &in, const Vector &u)
{
  const RCP<Vector> forces = out_of_balance(in, d, moments, {});
  double work = forces->dot(u);
  bool loaded = false;
  for (const double f : in.force) loaded = loaded || f != 0;
  if (!loaded) return work;
  const Vector rest(d.owned_dofs);
  const auto body = nodal_forces(in, d, *fem::on_overlap(d, rest));
  return work + out_of_balance(in, d, {}, body)->dot(u);
}

template Solved galerkin_solution(const analysis::Problem &, const analysis::StepSolution &,
                                  const solver::LinearSolverOptions &, const CellInput &, const BoundaryTractions &);
template Solved galerkin_solution(const analysis::Problem &, const analysis::StepSolution &,
                                  const solver::LinearSolverOptions &, const SpaceInput &, const BoundaryTractions &);
template Solved galerkin_solution(const analysis::Problem &, const analysis::StepSolution &,
                                  const solver::LinearSolverOptions &, const HexahedraInput &,
                                  const BoundaryTractions &);
template double work_of(const fem::Discretization &, const DeviceView<double ***> &, const CellInput &, const Vector &);
template double work_of(const fem::Discretization &, const DeviceView<double ***> &, const SpaceInput &,
                        const Vector &);

} // namespace rpc::bound
