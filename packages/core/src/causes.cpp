// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/causes.hpp"

namespace rpc
{

std::string because(const Cause &cause, const std::string &figures)
{
  std::string text = cause.said;
  if (!figures.empty()) text += " (" + figures + ")";
  return text + "; " + cause.remedy;
}

} // namespace rpc
