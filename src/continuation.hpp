// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"

#include <string>
#include <utility>
#include <vector>

namespace rpc
{

/// Proves that a deck goes on with a run that a checkpoint has left: bodies, conditions and laws are the same parameter by parameter, and
/// fields have the same values at the steps that are done, whatever their text and whatever they become later. Conditions are compared in
/// their order, whatever their names. Collective.
/// @param before   the parts of the deck that the run had, see Scene::identity
/// @param records  of the steps that are done
/// @param path     of the checkpoint, for the message
/// @throws rpc::Error (bad_input) on every rank, with the parameter and where it differs
void require_continuation(const Scene &scene, const fem::Discretization &d,
                          const std::vector<std::pair<std::string, std::string>> &before,
                          const std::vector<analysis::StepRecord> &records, const std::string &path);

} // namespace rpc
