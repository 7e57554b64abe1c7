// SPDX-License-Identifier: BSD-3-Clause
#include "deck_notes.hpp"

#include "rpc/core/pascals.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rpc
{
namespace
{

// Young's moduli of the stiffest and of the softest solids that are known [Pa]: diamond along its stiffest direction has 1.21e12 (Field, Rep. Prog.
// Phys. 75 (2012) 126505), brain tissue 100 to 1000 (Discher, Janmey and Wang, Science 310 (2005) 1139).
constexpr double stiffest_known = 1.3e12, softest_known = 100;
// Of Young's modulus: the stress at which a perfect crystal comes apart (Kelly and Macmillan, Strong Solids, 1986); a pressure of that size strains
// the body by a tenth.
constexpr double strongest = 0.1;

std::string with_unit(const double value, const UnitNames &units)
{
  std::ostringstream text;
  text << value << " [" << units.stress() << "]";
  return text.str();
}

/// @param path  of the material
std::string modulus_note(const double modulus, const std::string &path, const UnitNames &units)
{
  const auto unit = pascals(units);
  if (!unit) return "";
  const double in_pascals = modulus * *unit;
  const bool too_stiff = in_pascals > stiffest_known, too_soft = in_pascals < softest_known && !units.is_default();
  if (!too_stiff && !too_soft) return "";
  std::ostringstream note;
  note << '"' << path << "->Young's Modulus\" = " << with_unit(modulus, units) << " is ";
  if (*unit != 1) note << in_pascals << " Pa, ";
  note << (too_stiff ? "more" : "less") << " than any known material has ("
       << (too_stiff ? "diamond 1.2e+12 Pa" : "brain tissue 100 Pa") << "): is it in the deck's units? Steel has "
       << with_unit(2.1e11 / *unit, units);
  return note.str();
}

/// What the user should know of moduli that no known material has, which unit slips make; empty if there are none. Decks that do not name their
/// units may have numbers without a dimension: of these those that are too large alone are told.
std::string modulus_note(const fem::Materials &materials, const UnitNames &units)
{
  if (!materials.only_blocks)
    if (const auto note = modulus_note(materials.common.youngs_modulus, "Material", units); !note.empty()) return note;
  for (const auto &[name, material] : materials.block)
    if (const auto note = modulus_note(material.youngs_modulus, "Material->Blocks->" + name, units); !note.empty())
      return note;
  return "";
}

double largest_modulus(const fem::Materials &materials)
{
  double largest = materials.only_blocks ? 0 : materials.common.youngs_modulus;
  for (const auto &[name, material] : materials.block) largest = std::max(largest, material.youngs_modulus);
  return largest;
}

/// Of a foundation that yields where the body's strains are not small any more.
std::string yield_note(const contact::ContactOptions &side, const double modulus, const UnitNames &units)
{
  const ScalarField &yield = side.yield_stress;
  if (!yield.is_constant() || !std::isfinite(yield.constant) || yield.constant <= strongest * modulus) return "";
  std::ostringstream note;
  note << '"' << side.path << "->Yield Stress\" = " << with_unit(yield.constant, units) << " is "
       << yield.constant / modulus << " of the body's Young's modulus, " << with_unit(modulus, units)
       << ": a pressure of a tenth of that strains the body by a tenth. Is it in the deck's units? A foundation that "
          "does not yield needs no Yield Stress";
  return note.str();
}

/// The path of the first load that is a number per area and larger than a bound, with its value; empty if there is none.
std::string force_per_area(const Scene &scene, const double bound)
{
  for (const auto &load : scene.model.tractions)
    for (int c = 0; c < 3; ++c) {
      const ScalarField &field = load.traction[c];
      if (!field.is_constant() || !(std::abs(field.constant) > bound)) continue;
      return "\"Traction->" + load.name + "->" + "XYZ"[c] + "\" = " + with_unit(field.constant, scene.model.units) +
             " is a force per area (a force on the whole side is \"Force " + "XYZ"[c] + "\")";
    }
  return "";
}

} // namespace

std::string force_per_area_hint(const Scene &scene)
{
  return force_per_area(scene, 0);
}

std::vector<std::string> notes_on_deck(const Teuchos::ParameterList &deck, const Scene &scene)
{
  std::vector<std::string> notes;
  for (const char *const part : {"Dirichlet", "Rigid", "Traction"})
    if (!deck.getEntry(part).isDefault() && deck.sublist(part).numParams() == 0)
      notes.push_back("\"" + std::string(part) + "\" of the deck has no entries: nothing is " +
                      (part == std::string("Traction") ? "loaded" : "held") + " by it");
  if (scene.model.contact.empty() && deck.sublist("Contact").getEntry("Side").isDefault())
    notes.emplace_back("the deck has no \"Contact\": the body meets no foundation. \"Contact->Side\" names the side "
                       "that may touch one");
  const UnitNames &units = scene.model.units;
  if (const auto note = modulus_note(scene.model.materials, units); !note.empty()) {
    notes.push_back(note);
    return notes; // what is compared with it would be told for its sake
  }
  const double modulus = largest_modulus(scene.model.materials);
  for (const auto &side : scene.model.contact)
    if (const auto note = yield_note(side, modulus, units); !note.empty()) notes.push_back(note);
  if (const auto load = force_per_area(scene, strongest * modulus); !load.empty())
    notes.push_back(load + ", more than a tenth of the body's Young's modulus, " + with_unit(modulus, units) +
                    ": strains will not be small");
  return notes;
}

} // namespace rpc
