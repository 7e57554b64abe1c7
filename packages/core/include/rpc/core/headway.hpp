// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>

namespace rpc
{

/// Decides whether an iteration makes progress, from a measure of each of its points: the smaller, the nearer is the end. Iterations ask this
/// class alone whether to go on; their limits are rules (core/rule.hpp).
class Headway
{
public:
  enum class Answer {
    progress, ///< the measure has fallen, the point is new
    slow,     ///< it has not; the limits allow this
    stuck,    ///< a limit is exceeded
    cycle     ///< the point has been visited as often as it may be
  };
  static constexpr int unlimited = std::numeric_limits<int>::max();
  struct Limits {
    double ratio = 1;              ///< progress: a measure below this part of what it is compared with
    int idle_in_a_row = unlimited; ///< measures without progress, one after the other
    int idle = unlimited;          ///< measures without progress
    int in_all = unlimited;        ///< measures, with progress or not
  };
  explicit Headway(const Limits &limits) : limits_(limits) {}

  /// Compares a measure with the least one before. The first one is progress unless it is infinite or not a number.
  Answer add(const double measure)
  {
    const double reference = least_;
    least_ = std::min(least_, measure);
    return add(measure, reference);
  }
  /// Compares it with a given one.
  Answer add(const double measure, const double reference) { return take(measure < limits_.ratio * reference); }
  /// For an iteration that judges progress by itself. @param weight  of a point without progress
  Answer take(const bool progress, const int weight = 1)
  {
    ++count_;
    if (!progress) idle_ += weight;
    idle_in_a_row_ = progress ? 0 : idle_in_a_row_ + weight;
    if (count_ > limits_.in_all || idle_ > limits_.idle || idle_in_a_row_ > limits_.idle_in_a_row) return Answer::stuck;
    return progress ? Answer::progress : Answer::slow;
  }
  /// For an iteration through finitely many points. @param most  visits of one point
  Answer visit(const std::uint64_t fingerprint, const int most = 1)
  {
    const int before = visits_[fingerprint]++;
    return before == 0 ? Answer::progress : before < most ? Answer::slow : Answer::cycle;
  }

  int count() const { return count_; }
  /// Forgets measures, but not what was visited.
  void start_over()
  {
    least_ = std::numeric_limits<double>::infinity();
    count_ = idle_ = idle_in_a_row_ = 0;
  }
  void forget_visits() { visits_.clear(); }

private:
  Limits limits_;
  double least_ = std::numeric_limits<double>::infinity();
  int count_ = 0, idle_ = 0, idle_in_a_row_ = 0;
  std::map<std::uint64_t, int> visits_;
};

} // namespace rpc
