// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solve.hpp"

#include <ostream>
#include <string>
#include <vector>

namespace rpc
{

/// The console's view of a run: a line per Newton step and per multiplier update that another one follows.
class ConsoleTable
{
public:
  /// @param verbose  with the residuals of each Uzawa iteration, also of the last one, which are the result's
  ConsoleTable(std::ostream &out, bool verbose);

  /// A line on a mesh.
  void scene(const Scene &scene, const fem::Discretization &d, const contact::ContactNodes &contact);
  /// The heads of the columns, once for each table: before its first line.
  void heads(const Scene &scene);
  /// @param uzawa  number of the Uzawa iteration
  void newton(int uzawa, const solver::NewtonStep &step, const contact::StateCounts &states);
  void uzawa(const analysis::UzawaResult &result);
  /// The last step of the solution's history, and the time that the others will take.
  void load_step(const Scene &scene, const analysis::Solution &solution);

private:
  std::ostream &out_;
  bool verbose_;
  double start_;
  int load_steps_ = 0;     // of this run
  bool heads_due_ = false; // of the table that begins
  std::string residuals_;  // of an Uzawa iteration that may be the last one
};

/// A line on the error that a mesh is estimated to leave.
void print_estimate(std::ostream &out, const Scene &scene, const Solution &solution);

/// How the run ended, its results with their error bars, work and time.
/// @param notes  those of the solution that the console has not told yet
/// @param files  what was written
void print_summary(std::ostream &out, const Scene &scene, const Solution &solution,
                   const std::vector<std::string> &notes, const std::vector<std::string> &files);

} // namespace rpc
