// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/result.hpp"

/// What a user may have overlooked: foundations that a body does not reach, or that reach through it.
namespace rpc::contact
{

/// How far a foundation, with its dents, reaches into the body before that is strained, at the point that lies deepest in it.
struct Overlap {
  double depth = 0;     ///< [m], less what prescribed displacements move the body out of it; not > 0: it does not
  double thickness = 0; ///< of the body along the normal there [m]
  bool held =
      false; ///< displacements along the normal, its largest component, are prescribed somewhere: else the body may give way whole
};

/// @param side  its number; collective
Overlap overlap(const fem::Discretization &d, const ContactNodes &points, int side,
                const fem::DirichletDofs &dirichlet);

/// Whether anything moves or strains a body at rest: a load, a prescribed displacement but 0, a foundation that reaches into it, or one that
/// drags it along. Collective.
bool is_loaded(const Comm &comm, const fem::ElasticProblem &elastic, const ContactNodes &points);

/// The smallest distance of the body from its foundations, with their dents, after a solve [m]: at points, and at samples between them where
/// look_between_nodes() has been called; < 0 where a sample lies in a foundation; infinite where there are no points. Collective.
double smallest_gap(const Comm &comm, const ContactNodes &points, const ContactResult &result);

} // namespace rpc::contact
