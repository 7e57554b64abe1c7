// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ring_solves.hpp"

#include <vector>

namespace rpc::bound
{

/// A Descent on the tractions of tetrahedra. What only steers it, the derivative of the energy, is of single precision; what is added to tractions
/// is not, for cells stay in balance by it.
class SpaceDescent
{
public:
  /// @param in, forms, rings, comm  live longer
  SpaceDescent(const SpaceInput &in, const SpaceForms &forms, const RingSolves &rings, const Comm &comm,
               const Tractions &t);
  /// Collective. @return by how much the energy falls [J]
  double step();

private:
  const SpaceInput &in_;
  const SpaceForms &forms_;
  const RingSolves &rings_;
  const Comm &comm_;
  Tractions t_, d_;
  DeviceView<float *> g_; // what rings need of the derivative
  double rho_ = 0;
};

/// Tractions in balance, from a Galerkin solution by steps of a descent.
struct Descended {
  Tractions t;
  std::vector<double> falls; ///< of the energy [J]
};
/// Collective. @param mesh  of the tetrahedra, whose nodes have the cells `around`   @param[in,out] Q, mean  see equilibrated()
Descended descended(const SpaceInput &in, const mesh::Mesh &mesh, const fem::NodeToCells &around,
                    const BoundaryTractions &boundary, const SpaceForms &forms, DeviceView<double ***> &Q,
                    const Tractions &mean, int steps);

} // namespace rpc::bound
