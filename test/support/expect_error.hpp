// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"

#include <gtest/gtest.h>
#include <initializer_list>
#include <string>

namespace rpc::test
{

/// The rpc::Error that the work must throw.
template <class Work>
Error error_of(const Work &work)
{
  try {
    work();
  } catch (const Error &error) {
    return error;
  }
  ADD_FAILURE() << "no rpc::Error was thrown";
  return Error(ExitCode::converged, "");
}

/// The work must throw this code, and a message that contains all parts.
template <class Work>
void expect_error(const ExitCode code, const std::initializer_list<std::string> &parts, const Work &work)
{
  const Error error = error_of(work);
  EXPECT_EQ(error.code(), code) << error.what();
  for (const std::string &part : parts)
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what() << "\nlacks: " << part;
}

template <class Work>
void expect_error(const ExitCode code, const std::string &part, const Work &work)
{
  expect_error(code, {part}, work);
}

} // namespace rpc::test
