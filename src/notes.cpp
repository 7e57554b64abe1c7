// SPDX-License-Identifier: BSD-3-Clause
#include "notes.hpp"

#include "deck_notes.hpp"
#include "rpc/contact/between_nodes.hpp"
#include "rpc/contact/clearance.hpp"
#include "rpc/contact/joined_sides.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/fem/measure.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace rpc
{
namespace
{

// Of a step's energies.
constexpr double notable_imbalance = 0.01;
// Beyond it the terms that small strains leave out are a fifth of those that count.
constexpr double notable_strain = 0.2;
// Beyond it the length of an arm that turns by theta, sqrt(1 + theta^2), is off by half a percent [rad].
constexpr double notable_rotation = 0.1;
// Of the mean unit normal of a side, less than 1: the normals of a side that is as good as flat are within 5 degrees of each other.
constexpr double notable_bend = 1e-3;

/// Steps whose work does not fit their energies, where the deck does not say how well it is to.
std::string balance_note(const Solution &s)
{
  if (s.out_of_balance) return "";
  const analysis::OutOfBalance off = analysis::out_of_balance(s.history, notable_imbalance);
  if (off.steps == 0) return "";
  std::ostringstream note;
  note << "in " << off.steps << " of " << s.history.size() << " steps work and energies differ by more than 1 % ("
       << std::setprecision(2) << 100 * off.share << std::setprecision(6) << " % at t = " << off.at
       << "): contact opens or closes within a step; \"Steps->Energy Tolerance\" divides such steps";
  return note.str();
}

/// Strains that are not small, of all steps.
std::string strain_note(const Scene &scene, const analysis::Solution &s)
{
  double most = s.body.strain;
  std::ostringstream when;
  for (const auto &step : s.history) {
    if (!(step.body.strain >= most && step.body.strain > notable_strain)) continue;
    most = step.body.strain;
    when.str("");
    when << " at t = " << step.time;
  }
  if (!(most > notable_strain)) return "";
  std::ostringstream note;
  note << "strains reach " << std::setprecision(2) << most << when.str()
       << ": small strains are assumed, and results where strains exceed " << notable_strain << " are rough";
  if (const std::string load = force_per_area_hint(scene); !load.empty()) note << ". " << load;
  return note.str();
}

/// Rigid sides that turn by what small rotations do not describe, of all steps.                                     (2.9b)
std::string rotation_note(const Scene &scene, const analysis::Solution &s)
{
  double most = notable_rotation;
  std::ostringstream where;
  const auto look = [&](const std::vector<fem::SixNumbers> &motions, const std::string &when) {
    std::size_t j = 0;
    for (const auto &condition : scene.model.dirichlet) {
      if (!condition.rigid || j >= motions.size()) continue;
      const double angle = std::hypot(motions[j][3], motions[j][4], motions[j][5]);
      ++j;
      if (!(angle > most)) continue;
      most = angle;
      where.str("");
      where << "the rigid side \"" << condition.name << "\" turns by " << std::setprecision(3) << angle << " rad"
            << when;
    }
  };
  look(s.rigid_motions, "");
  for (const auto &step : s.history) {
    std::ostringstream when;
    when << " at t = " << step.time;
    look(step.rigid_motions, when.str());
  }
  if (where.str().empty()) return "";
  where << ": rotations are assumed to be small, and above " << notable_rotation << " rad results are rough";
  return where.str();
}

/// Penalties of the deck that were raised for friction.                                                            (12.12b)
std::string penalty_note(const analysis::Solution &s)
{
  if (s.raised_penalties == 0) return "";
  return "\"Contact->Penalty\" is too weak for friction at " + std::to_string(s.raised_penalties) +
         " contact points, where it counts as auto";
}

/// Steps that friction did not let go on from where the last one had ended.
std::string jump_note(const analysis::Solution &s)
{
  const auto jumped = [](const analysis::StepRecord &step) { return step.from_rest; };
  const auto first = std::find_if(s.history.begin(), s.history.end(), jumped);
  if (first == s.history.end()) return "";
  std::ostringstream note;
  note << "in " << std::count_if(first, s.history.end(), jumped) << " of " << s.history.size()
       << " steps, first at t = " << first->time
       << ", the friction states settled from rest alone, not from the step before: with much friction there may be "
          "several solutions, and the body may have jumped to another one. More \"Steps->Times\" before it tell";
  return note.str();
}

/// Contact that the mesh did not see in steps before a restart, whose notes are those of the run before.
std::string contact_missed_before(const Scene &scene, const analysis::Solution &s)
{
  const auto first = std::find_if(s.history.begin(), s.history.end(), [](const analysis::StepRecord &step) {
    return step.converged && contact::misses_contact(step.contact, 2 * step.energies.strain);
  });
  if (first == s.history.end()) return "";
  std::ostringstream note;
  note
      << analysis::at_time(first->time) << "unseen contact: a contact side lay " << std::setprecision(2)
      << first->contact.unseen_penetration << " [" << scene.model.units.of(unit::length, false)
      << "] inside the foundation, between contact points that were open, so that the contact force lacked it; the run "
         "before the restart says where";
  return note.str();
}

/// At the end of a step, one before a restart too.
bool touched_before(const analysis::Solution &s)
{
  return std::any_of(s.history.begin(), s.history.end(),
                     [](const analysis::StepRecord &step) { return step.contact.contact_length > 0; });
}

} // namespace

bool Notes::is_new(const std::string &note)
{
  if (note.empty() || std::find(all_.begin(), all_.end(), note) != all_.end()) return false;
  all_.push_back(note);
  console_ << "note: " << note << std::endl;
  return true;
}

void Notes::add(const std::string &note)
{
  if (is_new(note)) ++num_telling_;
}

void Notes::add_harmless(const std::string &note)
{
  is_new(note);
}

SeldomMeant::SeldomMeant(const Scene &scene, const bool goes_on, Notes &notes)
    : scene_(scene), notes_(notes), loaded_(goes_on), overlaps_(scene.model.contact.size(), 0)
{
}

void SeldomMeant::before(const analysis::Problem &problem, const analysis::Step &step)
{
  const Comm &comm = problem.discretization().mesh->comm();
  loaded_ = loaded_ || contact::is_loaded(comm, step.elastic, step.contact);
  note_overlaps(problem, step);
  note_held_loads(problem, step);
  if (scene_.has_steps()) return;
  if (step.contact.friction.anywhere)
    notes_.add(
        "friction depends on the path of the load, of which one step knows the end alone: \"Steps->Times\" follow it");
}

/// A body that no displacement holds may have given way to an obstacle that has moved since the first step.
void SeldomMeant::note_overlaps(const analysis::Problem &problem, const analysis::Step &step)
{
  const bool first = !scene_.has_steps() || step.time <= scene_.steps.times.front();
  for (std::size_t k = 0; k < overlaps_.size(); ++k) {
    if (overlaps_[k]) continue;
    const auto found =
        contact::overlap(problem.discretization(), step.contact, static_cast<int>(k), step.elastic.dirichlet);
    if (!(found.depth > found.thickness && (found.held || first))) continue;
    overlaps_[k] = 1;
    const contact::ContactOptions &side = scene_.model.contact[k];
    const std::string unit = " [" + scene_.model.units.of(unit::length, false) + "]";
    std::ostringstream note;
    note << (scene_.has_steps() ? analysis::at_time(step.time) : "") << "the "
         << (side.obstacle.exists() ? "obstacle" : "foundation") << " of \"" << side.path << "\" overlaps the body by "
         << found.depth << unit << ", more than the body is thick along the contact normal (" << found.thickness << unit
         << "): does it lie where it should?";
    notes_.add(note.str());
  }
}

/// Loads that go into supports alone.
void SeldomMeant::note_held_loads(const analysis::Problem &problem, const analysis::Step &step)
{
  const mesh::Mesh &mesh = *problem.discretization().mesh;
  const fem::DirichletDofs &dirichlet = step.elastic.dirichlet;
  const auto &loads = scene_.model.tractions;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    const auto nodes =
        device_values(mesh.nodes_of(loads[k].side, "Traction->" + loads[k].name + "->Side"), "rpc::loaded_nodes");
    for (int c = 0; c < mesh.dim(); ++c) {
      if (loads[k].traction[c].is_zero() && loads[k].force[c].is_zero()) continue;
      if (sum_all(mesh.comm(), fem::num_not_held(dirichlet, nodes, mesh.dim(), c)) > 0) continue;
      notes_.add("the load of \"Traction->" + loads[k].name + "\" along " + "XYZ"[c] +
                 " goes into supports: \"Dirichlet\" prescribes the displacement along " + "XYZ"[c] +
                 " of all nodes that it acts on, and the body feels nothing of it");
    }
  }
}

/// Counts where the body touches and how near it comes; the note on contact that the mesh does not see, or nothing. Collective.
std::string SeldomMeant::look(const fem::Discretization &d, const analysis::StepSolution &s)
{
  touches_ |= s.contact.total.contact_length > 0;
  smallest_gap_ = std::min(smallest_gap_, contact::smallest_gap(d.mesh->comm(), s.step.contact, s.contact));
  const std::string unseen = contact::unseen_contact_note(
      s.contact, scene_.model.contact, d.dim(), s.energy_norm_squared, scene_.model.units, scene_.adapt.adapts());
  return unseen.empty() || !scene_.has_steps() ? unseen : analysis::at_time(s.step.time) + unseen;
}

void SeldomMeant::after_part(const fem::Discretization &d, const analysis::StepSolution &s)
{
  const std::string unseen = look(d, s);
  if (unseen_in_parts_.empty()) unseen_in_parts_ = unseen;
}

void SeldomMeant::after(const analysis::Solution &s)
{
  const std::string at_end = look(s.discretization, s), in_parts = std::exchange(unseen_in_parts_, "");
  const std::string &first = in_parts.empty() ? at_end : in_parts;
  if (!first.empty() && !has_unseen_contact_) notes_.add(first);
  has_unseen_contact_ |= !first.empty();
  note_uneven_gap(s);
}

void SeldomMeant::note_uneven_gap(const analysis::Solution &s)
{
  if (has_uneven_gap_) return;
  const auto options = scene_.model.seen_at(s.step.time, s.step.obstacle).contact;
  const auto sides = contact::contact_sides(*s.discretization.mesh, options);
  const contact::UnevenGap uneven = contact::uneven_gap(s.discretization, sides, options, s.step.contact, s.contact);
  const std::string note = contact::uneven_gap_note(uneven, options, s.discretization.dim(), scene_.model.units);
  has_uneven_gap_ = !note.empty();
  if (has_uneven_gap_) notes_.add((scene_.has_steps() ? analysis::at_time(s.time) : "") + note);
}

void SeldomMeant::at_end(const analysis::Solution &s)
{
  if (!unseen_in_parts_.empty() && !has_unseen_contact_) notes_.add(unseen_in_parts_); // a later part has failed
  if (!has_unseen_contact_) notes_.add(contact_missed_before(scene_, s));
  if (!s.uzawa.converged || s.failure) return;
  if (has_unseen_contact_) return; // something would happen, or touch
  if (!loaded_)
    notes_.add(
        scene_.has_steps()
            ? "no step has a load, a prescribed displacement but 0 or a contact point in a foundation: nothing happens"
            : "no load, no prescribed displacement but 0 and no contact point in a foundation: nothing happens");
  if (!loaded_ || s.step.contact.num_total == 0 || touches_ || touched_before(s)) return;
  std::ostringstream note;
  note << (smallest_gap_ > 0 ? "no point touches" : "no point is pressed on the foundation")
       << (scene_.has_steps() ? " at any step" : "") << ": the smallest gap that is left is " << smallest_gap_ << " ["
       << scene_.model.units.of(unit::length, false) << "]";
  notes_.add(note.str());
}

HeldContact held_contact(const Scene &scene, const contact::ContactNodes &contact)
{
  if (contact.num_fixed == 0) return {"", true};
  const auto &conditions = scene.model.dirichlet;
  const auto num_rigid =
      std::count_if(conditions.begin(), conditions.end(), [](const auto &each) { return each.rigid.has_value(); });
  const std::string held_by = num_rigid == 0                                      ? "\"Dirichlet\""
                              : num_rigid == static_cast<long>(conditions.size()) ? "\"Rigid\""
                                                                                  : "\"Dirichlet\" or \"Rigid\"";
  if (contact.num_fixed == contact.num_total)
    return {held_by + " prescribes the normal displacement of all " + std::to_string(contact.num_total) +
                " contact nodes and wins over contact there: the foundation holds nothing",
            false};
  return {"the normal displacement of " + std::to_string(contact.num_fixed) + " of " +
              std::to_string(contact.num_total) + " contact nodes is prescribed by " + held_by +
              ", which wins over contact there",
          true};
}

std::vector<std::string> notes_on_mesh(const Scene &scene, const fem::Discretization &d,
                                       const contact::ContactNodes &contact)
{
  std::vector<std::string> notes;
  if (contact.num_missing > 0)
    notes.push_back("from " + std::to_string(contact.num_missing) +
                    " nodes of the contact sides the normal misses the obstacle: they never touch");
  for (const contact::ContactOptions &side : scene.model.contact) {
    if (side.obstacle.exists() || !side.gap.is_zero()) continue;
    if (length(fem::side_measure(d, d.mesh->side(side.side, side.path)).normal) > 1 - notable_bend) continue;
    notes.push_back(
        "side \"" + side.side + "\" is bent, and \"" + side.path +
        "\" has neither an \"Obstacle\" nor a \"Gap\": the foundation has the shape of the side, and all of it "
        "touches from the beginning. A flat one is \"Obstacle\" with Type = plane");
  }
  const fem::Materials &materials = scene.model.materials;
  if (scene.adapt.adapts()) notes.push_back(fem::order_note(d, materials));
  for (const std::string &note :
       {fem::locking_note(d, materials), fem::incompressibility_note(d, materials), fem::bending_note(d, materials)})
    if (!note.empty()) notes.push_back(note);
  return notes;
}

std::vector<std::string> notes_on_results(const Scene &scene, const Solution &s)
{
  std::vector<std::string> notes;
  for (const std::string &note :
       {balance_note(s), strain_note(scene, s), rotation_note(scene, s), penalty_note(s), jump_note(s)})
    if (!note.empty()) notes.push_back(note);
  return notes;
}

} // namespace rpc
