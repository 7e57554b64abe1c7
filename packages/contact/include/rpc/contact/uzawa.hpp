#pragma once

#include "rpc/contact/optimality_residuals.hpp"

#include <Teuchos_ParameterList.hpp>
#include <functional>
#include <string>
#include <vector>

namespace rpc::contact
{

/// What ends the Uzawa iteration.
enum class UzawaTest {
  certificate,      ///< contact law and equilibrium hold: no solve is spent on confirming it
  multiplier_change ///< the paper's: relative change of the multipliers
};

struct UzawaOptions {
  double tolerance = 1e-8; ///< of the test, and of the certificate, dimensionless, > 0
  int max_iterations = 50; ///< > 0
  UzawaTest test = UzawaTest::optimality;
};

/// Parameters of the deck's `Uzawa` sublist.
Teuchos::ParameterList valid_uzawa_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
UzawaOptions uzawa_options(const Teuchos::ParameterList &list);

/// What came out of one minimization of the smoothed functional.
struct MinimizeResult {
  bool converged = false;
  int newton_iterations = 0;
  std::string reason;            ///< why not, if not
  bool states_confirmed = false; ///< u is the minimum of the functional's present piece, whose pressures obey the law
};

struct UzawaResult {
  bool converged = false; ///< the certificate holds
  std::string reason;
  int iterations = 0;
  std::vector<int> newton_iterations; ///< per Uzawa iteration
  double multiplier_change = 0;       ///< of the last one, relative
  OptimalityResiduals residuals;
};

/// Alternates minimization over u and multiplier update until the certificate holds.            doc/theory.md (5.1)
///
/// Without a contact node there is nothing to alternate with: one minimization.
/// @param[in,out] u  start, then solution: displacement from 0
/// @param minimize   (iteration, from 1) brings u, as seen from the functional's origin, to the minimum for its present
/// multipliers; collective
/// @param optimality_residuals    judges a displacement from 0, with the functional's multipliers
/// @param report     called after each iteration, for the console
UzawaResult uzawa(SmoothedFunctional &functional, Vector &u, const std::function<MinimizeResult(int)> &minimize,
                  const std::function<OptimalityResiduals(const Vector &)> &optimality_residuals,
                  const UzawaOptions &options, const std::function<void(const UzawaResult &)> &report);

} // namespace rpc::contact
