// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>

namespace rpc::solver
{

/// Refuses what MueLu would refuse when it is set up, and say on every rank; a number of levels that crashes it; and names
/// that MueLu and Ifpack2 pass over without a word: in the lists of the smoothers CHEBYSHEV, RELAXATION, ILUT, RILUK, in that
/// of a direct coarse solver, and in the lists of single levels ("level 1"). Lists in MueLu's other languages ("Hierarchy",
/// "parameterlist: syntax") are not looked into.
/// @param path  of the list, for messages
/// @throws rpc::Error (bad_input) with path and, for a misspelt name, the nearest valid one
void check_muelu_parameters(const Teuchos::ParameterList &user, const std::string &path);

} // namespace rpc::solver
