// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "facet_samples.hpp"

#include <optional>

namespace rpc::contact
{

/// A part of a facet that lies in the foundation.
struct HiddenPart {
  double depth = 0;         // e [m], the largest that was found
  Point place{};            // [m]
  double width[2] = {0, 0}; // along the facet's two directions [m]
};

/// Looks for a place of a face in space where the foundation, given as an expression with bounds, reaches into the body, however narrow it is:
/// parts of the face are divided where their bounds on e leave room for one, those first that leave the most (branch and bound). A face all of
/// whose parts are ruled out is clear. doc/theory.md (3.15)
/// @param least       what is no more than rounding [m]
/// @param most_parts  that are looked at
std::optional<HiddenPart> find_hidden_part(const FacetRows &rows, LO f, const EvaluateShape &shape,
                                           const ContactOptions &options, bool triangle, double least, int most_parts);

/// An upper bound on e over a face in space in front of a foundation that is given as an expression with bounds [m].
double bound_on_excess(const FacetRows &rows, LO f, const EvaluateShape &shape, const ContactOptions &options,
                       bool triangle);

} // namespace rpc::contact
