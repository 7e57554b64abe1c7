// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/support.hpp"

#include "held_part.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/point.hpp"
#include "rpc/fem/hinges.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc::contact
{
namespace
{

using fem::dot;
using fem::RigidMotion;
using Motions = std::vector<RigidMotion>;
using Numbers = std::vector<double>;

/// The scene, for messages.
struct Context {
  const fem::Discretization &d;
  const fem::Parts &parts;
  const ContactNodes &contact;
  const std::vector<ContactOptions> &options;
  const UnitNames &units;

  std::string name(const int part) const { return fem::name_of(*d.mesh, parts, part); }
  fem::MotionInWords words(const RigidMotion &r, const int part) const
  {
    return fem::in_words(r, parts.part[part], d.dim());
  }
  /// "20 [N/m]", a force along a translation or a moment about a rotation's axis.
  std::string amount(const double value, const fem::MotionInWords &words) const
  {
    std::ostringstream text;
    text << value << " [" << (words.rotates ? units.moment() : units.force)
         << (d.per_length() ? "/" + units.length : "") << "]";
    return text.str();
  }
};

/// "side "bottom"", "sides "bottom", "left"".
std::string sides_text(const std::vector<std::string> &sides)
{
  std::ostringstream text;
  text << (sides.size() > 1 ? "sides" : "side");
  for (std::size_t k = 0; k < sides.size(); ++k) text << (k > 0 ? ", \"" : " \"") << sides[k] << "\"";
  return text.str();
}

/// The contact sides that carry something against a motion; collective.
std::vector<int> carrying_sides(const Context &context, const HeldPart &held, const RigidMotion &motion)
{
  std::vector<int> sides;
  const double all = dot(held.carried(motion), motion);
  for (int k = 0; k < context.contact.num_sides(); ++k)
    if (dot(held.carried(motion, context.contact.first(k), context.contact.first(k + 1)), motion) > 1e-9 * all)
      sides.push_back(k);
  return sides;
}

[[noreturn]] void refuse(const std::string &message)
{
  throw Error(ExitCode::no_solution, "support: " + message);
}

/// The end of a remedy that begins with "prescribe ". @param motion  "it", "them" or "this motion"
std::string support_against(const std::string &motion)
{
  return "a displacement in \"Dirichlet\" that stops " + motion +
         ", or give a side in \"Rigid\" a motion or a spring that does.";
}

[[noreturn]] void refuse_free(const Context &context, const int part, const Motions &free, const fem::Resultant &load)
{
  std::ostringstream message;
  message << "nothing holds " << context.name(part) << " against";
  bool first = true;
  for (const RigidMotion &r : fem::readable_basis(free, context.d.dim())) {
    const auto words = context.words(r, part);
    const double along = dot(load.force, r);
    message << (first ? " " : "; ") << words.text();
    if (std::abs(along) > 1e-9 * load.magnitude * std::sqrt(dot(r, r)))
      message << ", along which the load is " << context.amount(along / words.size, words);
    first = false;
  }
  message << ". Prescribe " << support_against(free.size() > 1 ? "them" : "it");
  refuse(message.str());
}

/// "the resultant of the load, 10 [N/m] along (0, -1), passes through (3.5, 0.5)" of a load that presses a part on the foundation: that it
/// turns the part is a matter of where it acts. Empty for others. Collective.
std::string where_it_presses(const Context &context, const HeldPart &held, const fem::Resultant &load)
{
  const int dim = context.d.dim();
  RigidMotion along{};
  std::copy_n(load.force.begin(), dim, along.begin());
  const double size = std::sqrt(dot(along, along));
  if (!(size > 1e-6 * load.magnitude)) return "";
  for (double &entry : along) entry /= size;
  const std::vector<double> q = held.coordinates(along);
  const RigidMotion left = held.motion(q); // less than all of it where displacements are prescribed against it
  const Furthest against = held.furthest(q);
  double resisted = 0;
  for (std::size_t j = 0; j < q.size(); ++j) resisted += against.at[j] * q[j];
  if (!(dot(left, along) > 1 - 1e-9) || !(resisted > 0)) return "";
  const fem::Part &part = context.parts.part[held.part()];
  const RigidMotion &f = load.force;
  const Point force{f[0], f[1], dim == 3 ? f[2] : 0.};
  const Point moment{dim == 3 ? part.radius * f[5] : 0., dim == 3 ? -part.radius * f[4] : 0.,
                     part.radius * f[dim == 3 ? 3 : 2]}; // about the centre
  const Point arm = scaled(1 / (size * size), cross(force, moment));
  const auto words = context.words(along, held.part());
  return "the resultant of the load, " + context.amount(size, words) + ' ' + words.where + ", passes through " +
         fem::place_in_words({part.centre[0] + arm[0], part.centre[1] + arm[1], part.centre[2] + arm[2]}, part, dim);
}

/// The load along `motion` is more than the foundation does against it; collective.
[[noreturn]] void refuse_load(const Context &context, const HeldPart &held, const RigidMotion &motion,
                              const fem::Resultant &load)
{
  const auto words = context.words(motion, held.part());
  const double pushed = dot(load.force, motion), carried = dot(held.carried(motion), motion);
  const std::string name = context.name(held.part());
  const std::string resultant = context.amount(pushed / words.size, words);
  const std::string presses = words.rotates ? where_it_presses(context, held, load) : "";
  std::ostringstream message;
  if (carried > 1e-6 * pushed) {
    std::vector<std::string> names;
    const auto sides = carrying_sides(context, held, motion);
    for (const int k : sides) names.push_back(context.options[k].name_in_results());
    if (words.rotates)
      message << "the load turns " << name << " " << words.where << ", with a moment of " << resultant
              << "; against it ";
    else
      message << "the load pushes " << name << " against " << sides_text(names) << " with a resultant of " << resultant
              << " " << words.where << "; ";
    message << "the foundation " << (words.rotates ? "of " + sides_text(names) + " " : "") << "carries at most "
            << context.amount(carried / words.size, words) << ", where all of it yields. "
            << (presses.empty()
                    ? std::string("Lower the load, or raise")
                    : "T" + presses.substr(1) + ". Lower the load, move it to where more is carried, or raise");
    for (std::size_t k = 0; k < sides.size(); ++k)
      message << (k > 0 ? ", \"" : " \"") << context.options[sides[k]].path << "->Yield Stress\"";
    message << ".";
  } else {
    if (words.rotates)
      message << "the load turns " << name << " away from the foundation: " << words.where << ", its moment is "
              << resultant;
    else
      message << "the load pulls " << name << " away from the foundation: its resultant is " << resultant << " "
              << words.where;
    message << ", and nothing holds against it";
    if (presses.empty())
      message << ". Change the load";
    else
      message << "; " << presses << ". Move the load to where the foundation holds it";
    message << ", or prescribe " << support_against("this motion");
  }
  refuse(message.str());
}

/// The load is the largest that the foundation can bear: a part that moves along `motion` changes no energy; collective.
[[noreturn]] void refuse_edge(const Context &context, const HeldPart &held, const RigidMotion &motion,
                              const double scale)
{
  const auto words = context.words(motion, held.part());
  const double carried = dot(held.carried(motion), motion);
  const std::string name = context.name(held.part());
  std::ostringstream message;
  if (carried > 1e-3 * scale * std::sqrt(dot(motion, motion)))
    message << "the load is all that the foundation carries, " << context.amount(carried / words.size, words)
            << ", against a " << words.text() << " of " << name
            << ", whose position is then not determined. Lower the load, or raise the yield stress.";
  else
    message << "nothing presses " << name << " on the foundation against a " << words.text()
            << ": its position is not determined. Apply a load that does, or prescribe "
            << support_against("this motion");
  refuse(message.str());
}

/// A rotation about an axis a thousand times the part's radius away is a translation to whoever reads of it.
void drop_slight_turn(RigidMotion &motion, const int dim)
{
  double moved = 0, turned = 0;
  for (int k = 0; k < 6; ++k) (k < dim ? moved : turned) += motion[k] * motion[k];
  if (turned < 1e-6 * moved) std::fill(motion.begin() + dim, motion.end(), 0.);
}

/// Refuses a load that friction does not hold, with the most that it holds along the same motion; collective. Returns where the load
/// does not push that way.                                                                                       (12.10)
void refuse_slide(const Context &context, const HeldPart &held, const ConvexSet &set, const Numbers &b,
                  const RigidMotion &away, const Motions &slides)
{
  RigidMotion slide{};
  for (const RigidMotion &along : slides)
    for (int k = 0; k < 6; ++k) slide[k] += dot(away, along) * along[k];
  drop_slight_turn(slide, context.d.dim());
  const Numbers d = held.coordinates(slide);
  double pushed = 0, square = 0;
  for (std::size_t j = 0; j < b.size(); ++j) {
    pushed += b[j] * d[j];
    square += d[j] * d[j];
  }
  if (!(pushed > 0) || !(square > 1e-12 * dot(away, away))) return;
  double low = 0, high = 1; // of the load along the slide, what the foundation bears
  const auto borne = [&](const double part) {
    Numbers less = b;
    double size = 0;
    for (std::size_t j = 0; j < b.size(); ++j) {
      less[j] -= (1 - part) * pushed / square * d[j];
      size += b[j] * b[j];
    }
    return !(nearest_point(set, less, 1e-9 * std::sqrt(size)).distance > 0);
  };
  if (!borne(0)) return; // something else is wrong
  for (int halving = 0; halving < 40; ++halving) (borne((low + high) / 2) ? low : high) = (low + high) / 2;
  const auto words = context.words(slide, held.part());
  const std::string load = context.amount(pushed / words.size, words), name = context.name(held.part());
  std::ostringstream message;
  if (borne(1))
    message << "the load along a " << words.text() << " of " << name << " is all that friction holds, " << load
            << ": the position is not determined";
  else
    message << "the load pushes " << name << " over the foundation with a resultant of " << load << ' ' << words.where
            << "; friction holds at most " << context.amount(low * pushed / words.size, words);
  message << ". Lower the load, raise the friction, or prescribe " << support_against("this motion");
  refuse(message.str());
}

double size_of(const Numbers &q)
{
  double squares = 0;
  for (const double entry : q) squares += entry * entry;
  return std::sqrt(squares);
}

/// The load in the coordinates of a part.
Numbers pushes(const HeldPart &held, const fem::Resultant &load)
{
  Numbers b = held.coordinates(load.force);
  if (size_of(b) <= 1e-11 * load.magnitude) std::fill(b.begin(), b.end(), 0.); // rounding of loads that cancel
  return b;
}

/// The nearest point of the set to b moved a little, whichever way leads furthest out of it; of distance 0: b is inside. Collective.
Nearest furthest_nearby(const ConvexSet &set, const Numbers &b, const double shift)
{
  Nearest worst;
  for (std::size_t j = 0; j < b.size(); ++j) {
    for (const double sign : {1., -1.}) {
      Numbers near = b;
      near[j] += sign * shift;
      const Nearest outside = nearest_point(set, near, 1e-3 * shift);
      if (outside.distance > worst.distance * (1 + 1e-6)) worst = outside;
    }
  }
  return worst;
}

/// Whether the load lies inside of Z, by more than a millionth of it; collective.
bool holds(const HeldPart &held, const fem::Resultant &load)
{
  const ConvexSet set = [&](const Numbers &q) { return held.furthest(q); };
  const Numbers b = pushes(held, load);
  const double size = size_of(b);
  return size > 0 && !(nearest_point(set, b, 1e-9 * size).distance > 0) &&
         !(furthest_nearby(set, b, 1e-6 * size).distance > 0);
}

/// Whether the load lies inside of Z; collective.                                                          (9.4)
/// @param slides  motions that friction alone holds
void check_part(const Context &context, const HeldPart &held, const fem::Resultant &load, const double strength,
                const Motions &slides)
{
  const ConvexSet set = [&](const Numbers &q) { return held.furthest(q); };
  const Numbers b = pushes(held, load);
  const double size = size_of(b);
  const double scale = size > 0 ? size : strength > 0 ? strength : 1;
  const Nearest nearest = nearest_point(set, b, 1e-9 * scale);
  if (nearest.distance > 0) {
    if (!slides.empty()) refuse_slide(context, held, set, b, held.motion(nearest.away), slides);
    refuse_load(context, held, held.motion(nearest.away), load);
  }

  // With friction b has the weight too, beside a push that may be small: the limit of the push is to be met to a millionth.
  const Nearest worst = furthest_nearby(set, b, (slides.empty() ? 1e-6 : 1e-7) * scale);
  if (!(worst.distance > 0)) return;
  if (!slides.empty()) refuse_slide(context, held, set, b, held.motion(worst.away), slides);
  refuse_edge(context, held, held.motion(worst.away), scale);
}

/// What the foundation can do without friction that follows the pressure.
Reactions without_coefficient(Reactions reactions)
{
  reactions.friction.coefficient =
      DeviceView<double *>("rpc::contact::no_coefficient", reactions.friction.coefficient.extent(0)); // 0
  return reactions;
}

/// Whether any point's friction follows the pressure; collective.
bool follows_pressure(const Comm &comm, const FrictionPoints &friction)
{
  const auto mu = friction.coefficient;
  double most = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::follows_pressure", device_range(static_cast<LO>(mu.extent(0))),
      KOKKOS_LAMBDA(const LO i, double &largest) { largest = math::larger(largest, mu(i)); },
      Kokkos::Max<double>(most));
  return max_all(comm, std::max(0., most)) > 0;
}

/// Motions that change no gap: neither prescribed displacements nor contact stop them; collective.            (9.2)
/// @param friction  whether those that slide over friction are stopped too
std::vector<Motions> sliding_motions(const Comm &comm, const Reactions &reactions, const std::vector<Motions> &motions,
                                     const bool friction)
{
  const auto along = to_host(reactions.along);
  const auto slide = to_host(reactions.slide);
  const auto part = to_host(reactions.part);
  std::vector<Motions> rows(motions.size());
  for (std::size_t i = 0; i < part.extent(0); ++i) {
    if (part(i) < 0 || motions[part(i)].empty()) continue;
    RigidMotion row;
    for (int k = 0; k < 6; ++k) row[k] = along(i, k);
    rows[part(i)].push_back(row);
    for (int c = 0; c < 3 && friction && slide.extent(0) > 0; ++c) {
      for (int k = 0; k < 6; ++k) row[k] = slide(i, c, k);
      if (dot(row, row) > 0) rows[part(i)].push_back(row);
    }
  }
  rows = fem::independent_rows_of_all(comm, rows, fem::rigid_tolerance);
  std::vector<Motions> sliding;
  for (std::size_t p = 0; p < motions.size(); ++p)
    sliding.push_back(fem::null_space(rows[p], motions[p], fem::rigid_tolerance));
  return sliding;
}

} // namespace

FreeParts free_parts(const fem::Discretization &d, const fem::DirichletDofs &dirichlet)
{
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::support"));
  fem::require_stiff_joints(d, dirichlet);
  FreeParts body{fem::connected_parts(d), {}};
  body.motions = fem::free_motions(d, body.parts, dirichlet);
  return body;
}

Support check_support(const fem::Discretization &d, const FreeParts &body, const Vector &applied_load,
                      const ContactNodes &contact, const std::vector<ContactOptions> &options, const UnitNames &units)
{
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::support"));
  const Comm &comm = d.mesh->comm();
  const auto &[parts, motions] = body;
  Support support;
  support.num_parts = parts.size();
  for (const Motions &free : motions) support.by_contact_only = support.by_contact_only || !free.empty();
  if (!support.by_contact_only) return support;

  const Context context{d, parts, contact, options, units};
  const Reactions reactions = reactions_of(d, parts, contact);
  const auto loads = fem::resultants(d, parts, applied_load);
  const std::vector<Motions> sliding = sliding_motions(comm, reactions, motions, true);
  const std::vector<Motions> slides = // what friction alone holds
      contact.friction.anywhere ? sliding_motions(comm, reactions, motions, false) : sliding;
  for (int p = 0; p < parts.size(); ++p) {
    if (!sliding[p].empty()) refuse_free(context, p, sliding[p], loads[p]);
    if (!motions[p].empty())
      check_part(context, HeldPart(comm, reactions, p, motions[p]), loads[p], reactions.strength[p], slides[p]);
  }
  if (!contact.friction.anywhere || !follows_pressure(comm, contact.friction)) return support;
  const Reactions others = without_coefficient(reactions);
  for (int p = 0; p < parts.size(); ++p)
    if (!motions[p].empty() && !holds(HeldPart(comm, others, p, motions[p]), loads[p])) support.by_coulomb_only = true;
  return support;
}

} // namespace rpc::contact
