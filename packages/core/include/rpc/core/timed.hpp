// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_Time.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <string>

namespace rpc
{

/// Adds the time of its scope to a sum of seconds, and to the timer "rpc::<name>" of the timer tree.
class Timed
{
public:
  Timed(const std::string &name, double &seconds)
      : monitor_(*Teuchos::TimeMonitor::getNewTimer("rpc::" + name)), seconds_(seconds),
        start_(Teuchos::Time::wallTime())
  {
  }
  ~Timed() { seconds_ += Teuchos::Time::wallTime() - start_; }

private:
  Teuchos::TimeMonitor monitor_;
  double &seconds_;
  double start_;
};

} // namespace rpc
