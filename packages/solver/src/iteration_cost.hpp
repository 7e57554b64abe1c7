#pragma once

#include "rpc/algebra/stiffness_operator.hpp"
#include "rpc/solver/body.hpp"

namespace rpc::solver
{

/// As what a CG iteration with multigrid counts [s], by constants of one machine: a choice by them is the same in every run. Collective.
double seconds_of_iteration(const StiffnessOperator &K);

/// Whether a factor of K, numbered along a box, takes no more time than a few CG iterations with multigrid. Collective.   (4.10e)
bool is_narrow(const Body &body, const StiffnessOperator &K);

} // namespace rpc::solver
