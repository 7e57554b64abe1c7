// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/result.hpp"

#include <vector>

namespace rpc::contact
{

/// Slip and work of friction of a load step that is solved in parts: slips add up at each point, and so does the work.
class WholeStep
{
public:
  /// @param part  a part of the step, after those that have been added
  void add(const ContactNodes &points, const ContactResult &part, const RCP<const Map> &owned_nodes);
  /// Gives friction_work and max_slip of the last part those of the whole step; collective. @param points  of the last part
  void take(const Comm &comm, const ContactNodes &points, ContactResult &last) const;

private:
  RCP<const MultiVector> slip_; // (owned nodes; sides x dim) [m]; null without friction
  std::vector<double> work_;    // (sides) [J], in 2D per m
};

} // namespace rpc::contact
