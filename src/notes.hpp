// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solve.hpp"

#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace rpc
{

/// What the user should know of results besides their numbers. A note goes to the console as soon as it is known, and into the summary, once
/// however often it is given.
class Notes
{
public:
  explicit Notes(std::ostream &console) : console_(console) {}
  /// @param note  empty: none
  void add(const std::string &note);
  /// A note on a deck that most likely means what it says: --check does not call such a deck wrong.
  void add_harmless(const std::string &note);
  const std::vector<std::string> &all() const { return all_; }
  /// Those that a user is to read before a run.
  std::size_t num_telling() const { return num_telling_; }

private:
  bool is_new(const std::string &note);

  std::ostream &console_;
  std::vector<std::string> all_;
  std::size_t num_telling_ = 0;
};

/// Notes on scenes that are right and seldom meant: nothing loads the body, nothing touches, a foundation reaches through the body, friction
/// gets the whole load in one step, supports take a load, a foundation has not the period of its box; and on contact that the mesh does not see.
class SeldomMeant
{
public:
  /// @param goes_on  the run goes on after a checkpoint: what went before it is not known
  SeldomMeant(const Scene &scene, bool goes_on, Notes &notes);

  /// A step is about to be solved. Collective.
  void before(const analysis::Problem &problem, const analysis::Step &step);
  /// What parts of the step have shown on another mesh does not count.
  void on_new_mesh() { unseen_in_parts_.clear(); }
  /// A part of a step is solved that another one follows. Collective.
  void after_part(const fem::Discretization &d, const analysis::StepSolution &s);
  /// One of several steps, or the only one, is solved. Collective.
  void after(const analysis::Solution &s);
  /// @param s  the result of the run
  void at_end(const analysis::Solution &s);

private:
  void note_overlaps(const analysis::Problem &problem, const analysis::Step &step);
  void note_held_loads(const analysis::Problem &problem, const analysis::Step &step);
  std::string look(const fem::Discretization &d, const analysis::StepSolution &s);
  void note_uneven_gap(const analysis::Solution &s);

  const Scene &scene_;
  Notes &notes_;
  bool loaded_;                                                   // at any step
  std::vector<char> overlaps_;                                    // sides whose foundations have been said to
  bool touches_ = false;                                          // at any step, or part of one
  std::string unseen_in_parts_;                                   // of the present step: the first note
  bool has_unseen_contact_ = false;                               // at any step, or part of one
  bool has_uneven_gap_ = false;                                   // at any step
  double smallest_gap_ = std::numeric_limits<double>::infinity(); // of all steps [m]
};

/// Of contact nodes that supports hold as well.
struct HeldContact {
  std::string note; ///< empty: there are none
  bool harmless;    ///< contact is left at others, as where a support ends at a contact side
};
HeldContact held_contact(const Scene &scene, const contact::ContactNodes &contact);

/// What the user should know of a body on its mesh, but for held_contact().
std::vector<std::string> notes_on_mesh(const Scene &scene, const fem::Discretization &d,
                                       const contact::ContactNodes &contact);

/// What the user should know of results: steps whose work does not fit their energies, and strains that are not small.
std::vector<std::string> notes_on_results(const Scene &scene, const Solution &s);

} // namespace rpc
