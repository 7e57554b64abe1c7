// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#ifdef RPC_ABLATION
#include "rpc/core/rule_registry.hpp"
#endif

namespace rpc
{

/// A number that steers a decision: which states, step, path, solver, mesh or factor comes next. It changes what a run costs and where it
/// gives up, never what an answer is held to: tolerances and bounds of rounding are no rules.
///
/// A package keeps its rules in structs in `rules.hpp`, each with one constant instance:
///
///     struct ChoiceRules {
///       Rule<int> most_idle{6, "choice.most_idle", "updates in a row without progress [-]", "measurements.md: Limits on active-set updates"};
///     };
///     inline constexpr_rules ChoiceRules choice_rules;
///
/// With `-D RPC_ABLATION=ON` the environment variable RPC_RULES = "choice.most_idle=3;path.error=0.3" replaces values, and
/// RPC_RULES = list prints a line for each rule: name, value, meaning, source, with tabs between them. test/families/ablation.py uses both.
/// Device code takes the value, as a copy that the host has made.
template <class T>
class Rule
{
public:
#ifdef RPC_ABLATION
  Rule(const T value, const char *name, const char *meaning, const char *source)
      : value_(static_cast<T>(ablation::registered(static_cast<double>(value), name, meaning, source)))
  {
  }
#else
  /// @param name     group and name as RPC_RULES takes them
  /// @param meaning  what is counted or compared, with its unit in brackets; then "; off: NUMBER" where the rule is off neither by 0 nor, for names
  ///                 such as most_..., by 1e9 (test/families/ablation.py)
  /// @param source   where the value was measured, or that it was not
  constexpr Rule(const T value, const char * /*name*/, const char * /*meaning*/, const char * /*source*/)
      : value_(value)
  {
  }
#endif

  constexpr operator T() const
  {
    return value_;
  }

private:
  T value_;
};

/// How an instance of rules is declared: a constant of the compiler, but for builds that replace values.
#ifdef RPC_ABLATION
#define constexpr_rules const
#else
#define constexpr_rules constexpr
#endif

} // namespace rpc
