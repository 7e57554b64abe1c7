// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"
#include "rpc/core/remedies.hpp"

#include <string>

namespace rpc::io
{

/// A field of the deck: a number, `inf`, or a muParser expression of x, y, z [m] and the time t with the constants pi, e and inf.
///
/// A text without variables becomes a constant. The function is not thread safe: copies share one parser.
/// @param parameter  deck path for messages, "Contact->Yield Stress"
/// @param wanted     what the parameter is to hold, for messages
/// @throws rpc::Error (bad_input) if the text does not parse, assigns to a variable, has several values, or is a
/// constant NaN
ScalarField parse_field(const std::string &text, const std::string &parameter, const Wanted &wanted = {});

/// parse_field() for the parameters of a deck.
FieldParser field_parser(const Teuchos::ParameterList &valid);

} // namespace rpc::io
