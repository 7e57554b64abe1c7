// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/obstacle.hpp"
#include "rpc/core/parameters.hpp"

#include <string>

namespace rpc::test
{

/// What a deck's list makes of an obstacle: a text with a t in it stands for 2 t, another one for its number.
/// @param bytes  of the file that the list names
inline contact::Obstacle read_obstacle(Teuchos::ParameterList list, const int dim, const std::string &bytes = "")
{
  validate(list, contact::valid_obstacle_parameters());
  const auto parse = [](const std::string &text, const std::string &) {
    return text.find('t') == std::string::npos ? ScalarField(std::stod(text))
                                               : ScalarField(text, [](const Point &, double t) { return 2 * t; });
  };
  return contact::obstacle_options(list, dim, "Contact->Obstacle", parse,
                                   [&](const std::string &, const std::string &) { return bytes; });
}

} // namespace rpc::test
