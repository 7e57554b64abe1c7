// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>

namespace rpc
{

/// Of a value in a list whose entries are to be lists.
/// @param path   of that list
/// @param valid  what that list may have
std::string entry_remedy(const std::string &path, const std::string &name, const Teuchos::ParameterList &valid);

/// Of a value where a list is to be: the parameter beside it that takes it, or how the list is written.
/// @param value  as a text
/// @param valid  of the list that the value stands in
std::string list_remedy(const std::string &name, const std::string &value, const Teuchos::ParameterList &valid);

} // namespace rpc
