// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <Teuchos_ParameterList.hpp>
#include <string>

namespace rpc
{

/// The program for the host that takes small scenes over from one for a GPU: the environment's RPC_HOST_PROGRAM, else CMake's. Empty: none.
std::string host_program();

/// Unknowns of the largest mesh of a scene, where its deck tells before there is a mesh: for a box. -1: not known.
/// @param deck  of read_parameters()
/// @throws rpc::Error (bad_input) on a box or an adaptation with a value out of range
GO foreseen_unknowns(const Teuchos::ParameterList &deck);

/// Largest number of unknowns for which a host with this many threads is faster than a GPU, start and end of the process included.
/// @param nearly_incompressible  the body is, which takes several times the work
GO most_unknowns_of_host(int threads, bool nearly_incompressible);

/// Puts host_program() in the place of this process where the scene is small enough for it: CUDA's start and end alone take longer than
/// such a scene. Before MPI starts, for one process without partners. Returns where this program is to go on: there is no other or it
/// cannot be started, options for Kokkos are given, the scene is too large, of unknown size or its deck faulty (which the run will say).
void hand_over_small_scene(int argc, char *argv[]);

/// A line of the log, on why this program has the scene: another has handed it over, or has not been able to. Else empty.
std::string hand_over_report();

} // namespace rpc
