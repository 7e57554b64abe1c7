// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"

#include <Teuchos_ParameterList.hpp>
#include <string>

namespace rpc
{

// Names in lists of valid parameters that stand for something else; see set_named_entries() and set_pass_through().
constexpr const char *any_entry = "*";     // template of user-named sublists
constexpr const char *pass_through = "**"; // content is read by a library

/// Of a name that a list of the deck does not have: what is meant, or in which list it belongs, and what is valid there.
/// @param path   of the list that has it
/// @param valid  that list's valid parameters
/// @param root   those of the whole deck
/// @param is_list  it is the name of a list
Error unknown_name(const std::string &path, const std::string &name, const Teuchos::ParameterList &valid,
                   const Teuchos::ParameterList &root, bool is_list = false);

} // namespace rpc
