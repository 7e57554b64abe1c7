// SPDX-License-Identifier: BSD-3-Clause
#include "unknown_name.hpp"

#include "other_words.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"

#include <algorithm>
#include <regex>
#include <vector>

namespace rpc
{
namespace
{

constexpr const char *steps_sentence = " Steps are given by their times, Times, or by From, To and Step: ten of them "
                                       "to t = 1 are From 0.1, To 1, Step 0.1.";
constexpr const char *units_sentence =
    " Units of stress and energy follow from those of length and force, such as MPa from mm and N: write Length and "
    "Force alone.";

/// Paths of the lists that have a parameter or a list of this name, but for case and marks.
void find_lists(const Teuchos::ParameterList &list, const std::string &path, const std::string &name,
                std::vector<std::string> &found)
{
  for (const std::string &each : names_of(list)) {
    if (each == pass_through) continue;
    const std::string shown = each == any_entry ? "<any name>" : each;
    const std::string full = path.empty() ? shown : path + "->" + shown;
    if (letters(each) == name) found.push_back(full);
    if (list.isSublist(each)) find_lists(list.sublist(each), full, name, found);
  }
}

/// Of a name in a list of components X, Y, Z: which component is meant, or where its quantity belongs; empty if it is no component.
/// @param valid  what the list may have
std::string component_remedy(const std::string &name, const Teuchos::ParameterList &valid)
{
  static const std::regex component(
      "(|u|d|disp|displacement|f|force|cf|rf|load|totalforce|p|t|q|s|pressure|traction)([xyz123])");
  std::smatch found;
  const std::string word = letters(name), unit = wanted_of(valid, "X").unit;
  if (!std::regex_match(word, found, component)) return "";
  const std::string quantity = found[1];
  const char last = found[2].str()[0];
  const std::string axis(1, static_cast<char>('X' + (last < 'x' ? last - '1' : last - 'x')));
  const auto is_one_of_these = [&](const std::vector<std::string> &words) {
    return std::find(words.begin(), words.end(), quantity) != words.end();
  };
  const bool force = is_one_of_these({"f", "force", "cf", "rf", "load", "totalforce"}),
             displacement = is_one_of_these({"u", "d", "disp", "displacement"});
  if (force && valid.isParameter("Force " + axis))
    return " Did you mean \"Force " + axis + "\", the force on the whole side, or \"" + axis +
           (unit == "m" ? "\", its displacement?" : "\", the force per area?");
  if (displacement && unit != "m") return " A displacement is prescribed in \"Dirichlet\".";
  if (!displacement && !quantity.empty() && unit == "m") return " A load belongs into \"Traction\".";
  return " Did you mean \"" + axis + "\"?";
}

/// Of another name there: how the quantity is given.
std::string components_remedy(const std::string &name, const Teuchos::ParameterList &valid)
{
  const std::string word = letters(name), unit = wanted_of(valid, "X").unit;
  const bool load = word.find("force") != word.npos || word.find("load") != word.npos || word == "f";
  const auto means_one_of = [&](const std::vector<std::string> &words) {
    return std::any_of(words.begin(), words.end(), [&](const auto &each) { return word.find(each) != word.npos; });
  };
  if (valid.isParameter("Moment X")) { // of a rigid side
    const std::string in_plane = "; in the plane Z alone.";
    if (means_one_of({"moment", "torque"}))
      return " Write the components of the moment about the reference point: Moment X, Moment Y, Moment Z" + in_plane;
    if (means_one_of({"spring", "stiffness"}))
      return " Write the stiffness of the motion: Stiffness X, Y or Z, or Rotation Stiffness X, Y or Z" + in_plane;
    if (means_one_of({"rotation", "angle", "tilt", "turn"}))
      return " Write the components of the rotation [rad]: Rotation X, Rotation Y, Rotation Z" + in_plane;
  }
  const bool pressure = word.find("pressure") != word.npos || word.find("traction") != word.npos || word == "p";
  if (unit == "m" && load && valid.isParameter("Force X"))
    return " Write the components of the force that moves the side as one rigid piece, Force X, Force Y, Force Z; a "
           "load "
           "that leaves the side soft belongs into \"Traction\".";
  if (unit == "m")
    return load || pressure ? " A load belongs into \"Traction\"." : " Write the displacement's components: X, Y, Z.";
  if (load && valid.isParameter("Force X"))
    return " Write the components of the force on the whole side, Force X, Force Y, Force Z, or those of the force per "
           "area, X, Y, Z.";
  return pressure ? " Write the components of the force per area, X, Y, Z: a pressure p on a side with the outward "
                    "normal n is -p n."
                  : " Write its components: X, Y, Z.";
}

/// "Contact.Yield Stress", "Contact/Yield Stress": the list and the name in it; empty if the name is no path.
/// @param valid  what the list may have
std::string path_remedy(const std::string &path, const std::string &name, const Teuchos::ParameterList &valid,
                        const Teuchos::ParameterList &root)
{
  static const std::regex mark(R"(->|::|\.|/|:|\\|>)");
  std::vector<std::string> parts(std::sregex_token_iterator(name.begin(), name.end(), mark, -1), {});
  for (std::string &part : parts) {
    const auto first = part.find_first_not_of(' ');
    part = first == part.npos ? "" : part.substr(first, part.find_last_not_of(' ') - first + 1);
  }
  if (parts.size() < 2) return "";
  const Teuchos::ParameterList *list = &valid;
  std::string place = path;
  const std::string own = path.substr(path.rfind("->") == path.npos ? 0 : path.rfind("->") + 2);
  if (nearest_name(parts[0], {own}) == own && !own.empty()) { // "Contact.Gap" in "Contact"
    parts.erase(parts.begin());
  } else if (nearest_name(parts[0], names_of(*list)).empty()) { // in a list, by the whole path
    list = &root;
    place = "";
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const bool free = list->isSublist(any_entry);
    const std::string known = free ? parts[k] : nearest_name(parts[k], names_of(*list));
    if (known.empty()) return "";
    const bool last = k + 1 == parts.size();
    if (last)
      return " Lists lie within lists: write \"" + known + "\"" +
             (place.empty() ? " into the outermost list" : " into the list \"" + place + "\"") +
             (place.empty() ? "." : ", in --set as \"" + place + "->" + known + "\".");
    const std::string key = free ? any_entry : known;
    if (!list->isSublist(key)) return "";
    list = &list->sublist(key);
    place += (place.empty() ? "" : "->") + known;
  }
  return "";
}

/// Of a list that stands in another one, such as "Contact" in "Mesh" or in "Traction", which takes it for an entry of its own.
std::string nesting_remedy(const std::string &path, const std::string &name, const Teuchos::ParameterList &root)
{
  const std::string around = path.substr(0, path.rfind("->")),
                    own = path.substr(path.rfind("->") == path.npos ? 0 : path.rfind("->") + 2);
  const auto close = [](const std::string &list, const std::string &outer) {
    return " \"" + list + "\" is a list of the outermost level: close \"" + outer +
           "\" before it, in XML by </ParameterList>, in YAML by less indentation.";
  };
  if (root.isSublist(name) && !path.empty()) return close(name, path);
  const bool as_entry = around != path && root.isSublist(own) &&
                        (root.sublist(own).isParameter(name) || root.sublist(own).isSublist(any_entry));
  if (as_entry && own == around) return " \"" + own + "\" stands within \"" + own + "\": take one of the two away.";
  return as_entry ? close(own, around) : "";
}

/// Where a list with a name of its own may stand.
std::string entries_place(const std::string &path, const Teuchos::ParameterList &valid)
{
  for (const std::string &name : names_of(valid))
    if (valid.isSublist(name) && valid.sublist(name).isSublist(any_entry))
      return " Lists with names of your choice stand in \"" + (path.empty() ? "" : path + "->") + name + "\".";
  return "";
}

/// Another place for the name, as a sentence; empty if there is none.
std::string other_place(const std::string &path, const std::string &name, const Teuchos::ParameterList &valid,
                        const Teuchos::ParameterList &root)
{
  const std::string word = letters(name);
  if (path == "Units" && nearest_name(name, names_of(valid)).empty()) return units_sentence;
  if (const std::string nested = nesting_remedy(path, name, root); !nested.empty()) return nested;
  if (const std::string of_path = path_remedy(path, name, valid, root); !of_path.empty()) return of_path;
  if (valid.isParameter("X") && valid.isParameter("Z")) {
    const std::string component = component_remedy(name, valid);
    return component.empty() ? components_remedy(name, valid) : component;
  }
  for (const auto &[other, place] : words_of_others) {
    if (other != word || path == place || path.rfind(place + "->", 0) == 0) continue;
    if (valid.isParameter(place)) return " Did you mean \"" + place + "\"?";
    const auto arrow = place.rfind("->");
    if (arrow != std::string::npos && place.substr(0, arrow) == path)
      return " Did you mean \"" + place.substr(arrow + 2) + "\"?";
    if (place.size() > 1 && root.isParameter(place.substr(0, place.find("->"))))
      return " In a deck that is \"" + place + "\".";
  }
  if (const std::string sentence = found_word(sentences_for_words, word); !sentence.empty()) return " " + sentence;
  std::vector<std::string> places;
  if (!word.empty()) find_lists(root, "", word, places);
  if (places.empty() || places.size() > 3) return "";
  if (places.front().find("->") == std::string::npos)
    return " It belongs to the outermost list, as \"" + places.front() + "\".";
  std::string text;
  for (const std::string &place : places) text += (text.empty() ? "\"" : " or \"") + place + "\"";
  return " It is a parameter of another list: " + text + ".";
}

} // namespace

Error unknown_name(const std::string &path, const std::string &name, const Teuchos::ParameterList &valid,
                   const Teuchos::ParameterList &root, const bool is_list)
{
  const std::vector<std::string> names = names_of(valid);
  const std::string nearest = nearest_name(name, names);
  const bool slip = valid.isParameter("X") && nearest.size() > 1 && nearest.size() <= name.size() + 1;
  const bool near = !nearest.empty() && (letters(nearest) == letters(name) || slip);
  std::string place = near ? "" : other_place(path, name, valid, root);
  if (place.empty() && nearest.empty() && is_list) place = entries_place(path, valid);
  if (place.empty() && nearest.empty() && path == "Steps") place = steps_sentence;
  const std::string full = path.empty() ? name : path + "->" + name;
  return {ExitCode::bad_input, "deck: unknown parameter \"" + full + "\"." +
                                   (place.empty() ? did_you_mean(name, names) : place) + " Valid here: " + join(names) +
                                   "."};
}

} // namespace rpc
