// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/triangles.hpp"

#include <string>

namespace rpc::contact
{

/// The triangles of an STL file, text or binary; corners with the same numbers are one point.
/// @param bytes  of the file   @param where  begins messages: `deck: "...->File": "tool.stl" `
/// @throws rpc::Error (bad_input) where it is none
Triangles triangles_of_stl(const std::string &bytes, const std::string &where);

} // namespace rpc::contact
