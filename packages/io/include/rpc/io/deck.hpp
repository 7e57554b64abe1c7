// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_Comm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

namespace rpc::io
{

/// Folders in which decks are looked for that are not where they are named: see find_deck().
std::vector<std::string> deck_folders();

/// Path of a deck: `name` as given, else in the folder that the environment variable RPC_INPUT_DIR names, in the
/// share/rpc/input next to the running program's bin/ (so that an install tree can be moved), or in the source tree's
/// input/. Rank 0 looks for it on its disk; collective.
/// @throws rpc::Error (bad_input) on every rank, listing the places searched
std::string find_deck(const std::string &name, const Teuchos::Comm<int> &comm);

/// Reads a deck: YAML if the name ends in .yaml or .yml, Teuchos XML otherwise. The root list may have a name or not.
///
/// A value must read as the type that the deck gives it (Teuchos alone takes "abc" for the double 0), and a name may be
/// given once. A deck that is no well-formed XML or YAML is refused with the line, what is open there and what to write. A double inf or nan arrives as a string, as YAML has it: only fields know what to do with one. Rank 0
/// reads the file and hands its text to all; collective.
/// @param valid  what the deck may have, from which refusals of values take what is wanted; empty: that is not known
/// @throws rpc::Error (bad_input) on every rank with path, line where known, and reason
Teuchos::ParameterList read_deck(const std::string &path, const Teuchos::Comm<int> &comm,
                                 const Teuchos::ParameterList &valid = {});

/// A refusal of a parameter, `deck: "A->B" must ...`, with the file and the line of the parameter, or of the list that should have it:
/// `deck: "beam.xml", line 12: "A->B" must ...`. Other messages, and those on parameters that --set has given, stay as they are.
/// Reads the file again, for the rank alone that calls it.
/// @param path         of the deck
/// @param assignments  "A->B=VALUE", of the command line
std::string with_place(const std::string &message, const std::string &path,
                       const std::vector<std::string> &assignments);

} // namespace rpc::io
