// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/obstacle.hpp"
#include "rpc/core/field.hpp"

#include <Teuchos_ParameterList.hpp>
#include <limits>
#include <string>
#include <vector>

namespace rpc::contact
{

/// The normal nu along which penetration is measured.
enum class Normal {
  surface,    ///< outward normal of the body
  foundation, ///< of the obstacle, into the foundation
  fixed       ///< one direction for all nodes
};

/// What dents stay with when the body slides or the obstacle moves along itself, see moving_dents.hpp.
enum class DentsMoveWith { body, foundation };

/// A side that may touch the foundation, and the foundation's law there. Several foundations may touch one side, as the two flanks of a
/// groove do: each has options of its own, and a node of the side is a contact point of each of them.
struct ContactOptions {
  std::string path = "Contact"; ///< in the deck, for messages
  std::string side;
  std::string name; ///< of several foundations of one side, of its entry in the deck; empty: the side has this one only
  ScalarField yield_stress;                ///< xi > 0 [Pa], may be inf
  ScalarField hardening = ScalarField(0.); ///< H >= 0 [Pa/m], growth of the yield stress with the dent
  ScalarField stiffness = ScalarField(
      std::numeric_limits<double>::infinity());       ///< k > 0 [Pa/m] of the foundation before it yields, inf: rigid
  ScalarField friction_coefficient = ScalarField(0.); ///< mu >= 0
  ScalarField friction_bound = ScalarField(0.);       ///< s_0 >= 0 [Pa], whatever the pressure
  ScalarField friction_limit = ScalarField(
      std::numeric_limits<double>::infinity()); ///< s_max > 0 [Pa], which friction does not exceed; may be inf
  ScalarField gap; ///< g [m], distance to the foundation along the normal; < 0 is initial penetration. Without obstacle
  Obstacle obstacle; ///< the foundation's surface, from which the gap follows
  Normal normal = Normal::surface;
  Point direction{};     ///< unit, of Normal::fixed
  double penalty = 0;    ///< r > 0 [Pa/m]; 0: chosen at each node, see penalties.hpp
  bool remembers = true; ///< dents stay from step to step
  DentsMoveWith dents_move_with = DentsMoveWith::body;

  bool has_friction() const
  {
    const auto is_0 = [](const ScalarField &field) { return field.is_constant() && field.constant == 0; };
    return !is_0(friction_coefficient) || !is_0(friction_bound);
  }
  const std::string &name_in_results() const { return name.empty() ? side : name; }
};

/// Parameters of the deck's `Contact` sublist.
Teuchos::ParameterList valid_contact_parameters();
/// One entry for each side and foundation that touches it; none if nothing touches.
/// @throws rpc::Error (bad_input) on anything out of range that needs no mesh to be seen, and where two foundations of one side are not
///         told apart by an obstacle, or results by a name
std::vector<ContactOptions> contact_options(const Teuchos::ParameterList &list, int dim, const FieldParser &parse,
                                            const FileReader &read_file = bytes_of_file);

/// A number of the foundation's law and the rule for it.
struct LawParameter {
  ScalarField ContactOptions::*field;
  const char *name, *bound;
  bool may_be_zero, may_be_infinite;

  bool allows(double value) const;
  /// "deck: "Contact->Yield Stress" must be > 0 [Pa] ..., got "
  std::string rule(const std::string &path) const;
};
/// Yield stress, hardening, stiffness; friction's coefficient, bound and limit.
extern const std::array<LawParameter, 6> law_parameters;

/// Whether the law of a side has friction.
bool has_friction(const std::vector<ContactOptions> &options);

} // namespace rpc::contact
