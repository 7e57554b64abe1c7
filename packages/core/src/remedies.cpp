// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/remedies.hpp"

#include "other_words.hpp"
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <regex>
#include <sstream>

namespace rpc
{
namespace
{

/// A unit in terms of N and m: N^force m^length times the factor.
struct WrittenUnit {
  const char *name;
  double factor;
  int force, length;
};

constexpr WrittenUnit units_of_others[] = {
    {"Pa", 1, 1, -2},          {"kPa", 1e3, 1, -2},     {"MPa", 1e6, 1, -2},
    {"GPa", 1e9, 1, -2},       {"N/m^2", 1, 1, -2},     {"N/m2", 1, 1, -2},
    {"kN/m^2", 1e3, 1, -2},    {"kN/m2", 1e3, 1, -2},   {"MN/m^2", 1e6, 1, -2},
    {"MN/m2", 1e6, 1, -2},     {"N/mm^2", 1e6, 1, -2},  {"N/mm2", 1e6, 1, -2},
    {"kN/mm^2", 1e9, 1, -2},   {"kN/mm2", 1e9, 1, -2},  {"kN/cm^2", 1e7, 1, -2},
    {"kN/cm2", 1e7, 1, -2},    {"bar", 1e5, 1, -2},     {"psi", 6894.757, 1, -2},
    {"ksi", 6894757, 1, -2},   {"m", 1, 0, 1},          {"km", 1e3, 0, 1},
    {"cm", 1e-2, 0, 1},        {"mm", 1e-3, 0, 1},      {"um", 1e-6, 0, 1},
    {"nm", 1e-9, 0, 1},        {"in", 0.0254, 0, 1},    {"inch", 0.0254, 0, 1},
    {"ft", 0.3048, 0, 1},      {"N", 1, 1, 0},          {"kN", 1e3, 1, 0},
    {"MN", 1e6, 1, 0},         {"lbf", 4.448222, 1, 0}, {"kgf", 9.80665, 1, 0},
    {"N/m", 1, 1, -1},         {"kN/m", 1e3, 1, -1},    {"N/mm", 1e3, 1, -1},
    {"N/m^3", 1, 1, -3},       {"N/m3", 1, 1, -3},      {"kN/m^3", 1e3, 1, -3},
    {"kN/m3", 1e3, 1, -3},     {"MN/m^3", 1e6, 1, -3},  {"MN/m3", 1e6, 1, -3},
    {"N/mm^3", 1e9, 1, -3},    {"N/mm3", 1e9, 1, -3},   {"Pa/m", 1, 1, -3},
    {"kPa/m", 1e3, 1, -3},     {"MPa/m", 1e6, 1, -3},   {"MPa/mm", 1e9, 1, -3},
    {"deg", M_PI / 180, 0, 0}, {"%", 0.01, 0, 0},       {"percent", 0.01, 0, 0},
    {"rad", 1, 0, 0},
};

void replace_all(std::string &text, const std::string &from, const std::string &to)
{
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string without_ends(const std::string &text, const char *const ends)
{
  const auto first = text.find_first_not_of(ends);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(ends) - first + 1);
}

/// Plain characters for those that word processors and web pages put in their place.
std::string plain(std::string text)
{
  for (const char *const minus : {"\u2212", "\u2013", "\u2014"}) replace_all(text, minus, "-");
  for (const char *const blank : {"\u00a0", "\u202f", "\u2009"}) replace_all(text, blank, " ");
  for (const char *const times : {"\u00d7", "\u00b7"}) replace_all(text, times, "*");
  replace_all(text, "\u00b0", "deg");
  replace_all(text, "\u00b5m", "um");
  replace_all(text, "\u00b2", "^2");
  replace_all(text, "\u00b3", "^3");
  return without_ends(text, " \t\r\n\"';");
}

/// Whether all parts but the first have three digits, as between thousands.
bool stand_between_thousands(const std::string &digits, const char mark)
{
  std::size_t at = digits.find(mark);
  if (at == 0 || at > 3) return false;
  while (at != std::string::npos) {
    const std::size_t next = digits.find(mark, at + 1);
    const std::size_t end = std::min(next, digits.find_first_not_of("0123456789", at + 1));
    if (std::min(end, digits.size()) - at != 4) return false;
    at = next;
  }
  return true;
}

void remove(std::string &text, const char mark)
{
  text.erase(std::remove(text.begin(), text.end(), mark), text.end());
}

/// Digits with a point alone, of digits with points, commas, blanks, apostrophes or underscores; none of a list.
std::optional<std::string> digits_of(std::string digits)
{
  for (const char mark : {' ', '\'', '_'}) {
    if (digits.find(mark) == std::string::npos) continue;
    if (!stand_between_thousands(digits, mark)) return std::nullopt;
    remove(digits, mark);
  }
  const auto points = std::count(digits.begin(), digits.end(), '.');
  const auto commas = std::count(digits.begin(), digits.end(), ',');
  if (points > 0 && commas > 0) {
    const char thousands = digits.rfind('.') > digits.rfind(',') ? ',' : '.';
    if (!stand_between_thousands(digits, thousands) || std::min(points, commas) > 1) return std::nullopt;
    remove(digits, thousands);
  } else if (points > 1 || commas > 1) {
    const char thousands = points > 1 ? '.' : ',';
    if (!stand_between_thousands(digits, thousands)) return std::nullopt;
    remove(digits, thousands);
  }
  std::replace(digits.begin(), digits.end(), ',', '.');
  return digits;
}

const WrittenUnit *unit_named(const std::string &name)
{
  const auto unit = std::find_if(std::begin(units_of_others), std::end(units_of_others),
                                 [&](const WrittenUnit &each) { return name == each.name; });
  return unit == std::end(units_of_others) ? nullptr : &*unit;
}

std::string rounded(const double value) // of a product: its last digits are rounding
{
  std::ostringstream out;
  out.precision(10);
  out << value;
  return out.str();
}

/// "a pressure"; empty where there is no word for it.
std::string quantity_of(const WrittenUnit &unit)
{
  const std::string name = unit.name;
  if (unit.force == 1 && unit.length == -2) return "a pressure";
  if (unit.force == 0 && unit.length == 1) return "a length";
  if (unit.force == 1 && unit.length == 0) return "a force";
  if (unit.force == 1 && unit.length == -1) return "a force per length";
  if (unit.force == 1 && unit.length == -3)
    return name.find("Pa") == std::string::npos ? "a force per volume" : "a pressure per length";
  return "";
}

/// Whether two units are of one quantity. A force of a plane body is one per length.
bool agree(const WrittenUnit &given, const WrittenUnit &wanted)
{
  const bool force_in_the_plane = wanted.force == 1 && wanted.length == 0 && given.force == 1 && given.length == -1;
  return force_in_the_plane || (given.force == wanted.force && given.length == wanted.length);
}

/// Where a number has a unit, and its parameter, which is known, has none; empty where that is not so.
std::string of_no_unit(const WrittenNumber &number, const WrittenUnit &unit, const Wanted &wanted)
{
  if (wanted.name.empty() || quantity_of(unit).empty()) return "";
  std::string text = " \"" + wanted.name + "\" is a number without a unit: write " + number_text(number.value) + ".";
  for (const auto &[name, unit_of_other] : wanted.siblings) {
    const WrittenUnit *const other = unit_named(unit_of_other);
    if (other && agree(unit, *other))
      return text + " \"" + number.unit + "\" is a unit of " + quantity_of(unit).substr(2) + ", as of \"" + name +
             "\".";
  }
  return text;
}

/// Where a number has the unit of another quantity than its parameter; empty where it does not.
std::string other_quantity(const WrittenNumber &number, const WrittenUnit &unit, const Wanted &wanted)
{
  const WrittenUnit *const own = unit_named(wanted.unit);
  if (wanted.unit.empty()) return of_no_unit(number, unit, wanted);
  if (!own || agree(unit, *own) || quantity_of(unit).empty()) return "";
  std::string text = " \"" + number.unit + "\" is a unit of " + quantity_of(unit).substr(2) + ", where " +
                     quantity_of(*own) + " is wanted [" + wanted.unit + "].";
  for (const auto &[name, unit_of_other] : wanted.siblings) { // "Force Y" beside "Y"
    const WrittenUnit *const other = unit_named(unit_of_other);
    const std::string shorter =
        std::min(name, wanted.name, [](const auto &a, const auto &b) { return a.size() < b.size(); });
    const std::string longer = shorter == name ? wanted.name : name;
    const std::string ending = " " + shorter;
    const bool of_one_component =
        longer.size() > ending.size() && longer.compare(longer.size() - ending.size(), ending.size(), ending) == 0;
    if (other && of_one_component && agree(unit, *other))
      return text + " For " + quantity_of(unit) + " write \"" + name + "\" instead of \"" + wanted.name +
             "\", and the number alone, in the deck's units (see \"Units\").";
  }
  const bool displacement = own->length == 1 && own->force == 0 && wanted.name.size() == 1;
  if (displacement && number.value != 0) return text + " Forces and pressures belong into \"Traction\".";
  return text + (number.value == 0 ? " Write 0." : " Write the number alone, in the deck's units (see \"Units\").");
}

std::string with_brackets(const std::vector<std::string> &items, const bool were_whole)
{
  return std::string(were_whole ? " Write {" : " Write whole numbers, such as {") + join(items) + "} (in YAML [" +
         join(items) + "]).";
}

} // namespace

std::optional<WrittenNumber> written_number(const std::string &text)
{
  static const std::regex number(
      R"(([-+]?)\s*(\d(?:[\d .,'_]*\d)?[.,]?|[.,]\d+)(?:\s*[eEdD]\s*([-+]?\d+)|\s*[*x]\s*10\s*(?:\^|\*\*)?\s*\(?([-+]?\d+)\)?)?\s*([^\d\s].*)?)");
  std::smatch found;
  const std::string given = plain(text);
  if (!std::regex_match(given, found, number)) return std::nullopt;
  const auto digits = digits_of(found[2]);
  if (!digits) return std::nullopt;
  const std::string exponent = found[3].matched ? found[3].str() : found[4].str();
  const std::string whole = found[1].str() + *digits + (exponent.empty() ? "" : "e" + exponent);
  return WrittenNumber{std::strtod(whole.c_str(), nullptr), found[5].str()};
}

std::string number_text(const double value)
{
  std::ostringstream text;
  for (int digits = 6; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    text.str("");
    text.precision(digits);
    text << value;
    if (std::strtod(text.str().c_str(), nullptr) == value) break;
  }
  return text.str();
}

std::string number_remedy(const std::string &text, const Wanted &wanted)
{
  const auto number = written_number(text);
  const auto value_of_expression = number && number->unit.empty() ? std::nullopt : arithmetic(text);
  if (value_of_expression)
    return " Write its value, " + rounded(*value_of_expression) + ": " +
           (!wanted.expression ? "only parameters of the kind \"number or expression\" take an expression, in XML with "
                                 "type=\"string\"."
            : *wanted.expression ? "or in XML type=\"string\", for it is an expression."
                                 : "this parameter takes a number, not an expression.");
  if (!number) return "";
  static const std::regex hexadecimal(R"(0[xX][0-9a-fA-F]+)");
  if (std::regex_match(text, hexadecimal))
    return " Write " + std::to_string(std::strtoll(text.c_str(), nullptr, 16)) + ": decks have decimal digits.";
  if (!std::isfinite(number->value))
    return " Write a number of at most " + number_text(std::numeric_limits<double>::max()) + ".";
  if (number->unit.empty()) {
    std::string other;
    static const std::regex ambiguous(R"([-+]?[1-9]\d{0,2},\d{3})");
    if (std::regex_match(plain(text), ambiguous))
      other = ", or " + number_text(1000 * number->value) + " if the comma stands between thousands";
    const auto commas = std::count(text.begin(), text.end(), ',');
    return " Write " + number_text(number->value) + other +
           (commas > 1    ? ": decks have no marks between thousands."
            : commas == 1 ? ": decks have a decimal point."
                          : ".");
  }
  const WrittenUnit *const unit = unit_named(number->unit);
  const std::string alone = " Write the number alone, without \"" + number->unit + "\"";
  static const std::regex word(R"([A-Za-z%/^\d\s.]+)");
  if (!std::regex_match(number->unit, word)) return "";
  if (!unit) return alone + ": it counts in the deck's units, see \"Units\".";
  if (const std::string other = other_quantity(*number, *unit, wanted); !other.empty()) return other;
  const double value = number->value * unit->factor;
  if (value == 0) return alone + ": 0.";
  if (unit->force == 0 && unit->length == 0) return alone + ": " + rounded(value) + ".";
  return alone + ", in the deck's units (see \"Units\"): " + rounded(value) + " with m and N, " +
         rounded(value * std::pow(1000., unit->length)) + " with mm and N" +
         (unit->force == 0 ? "" : ", " + rounded(value / 1000) + " with m and kN") + ".";
}

std::string integer_remedy(const std::string &text)
{
  const auto number = written_number(text);
  if (!number || !number->unit.empty()) return number_remedy(text);
  if (std::abs(number->value) > std::numeric_limits<int>::max())
    return " Write at most " + std::to_string(std::numeric_limits<int>::max()) + ".";
  return std::floor(number->value) == number->value
             ? " Write " + std::to_string(std::lround(number->value)) + "."
             : " Write a whole number, such as " + std::to_string(std::lround(number->value)) + ".";
}

std::string array_remedy(const std::string &text, const bool whole)
{
  std::string inside = plain(text);
  inside = without_ends(inside, "{}[]()<> ");
  static const std::regex before_unit(R"((\d)\s+([A-Za-z%]))");
  if (!whole) inside = std::regex_replace(inside, before_unit, "$1$2");
  static const std::regex between_products(R"((\d)\s*x\s*(?=\d))");
  inside = std::regex_replace(inside, between_products, "$1;");
  // Commas are decimal ones where something else stands between the numbers.
  static const std::regex with_comma(R"(\d,\d)"), other_mark(R"([;|]|\d\s+[-+]?\d)");
  const bool commas_within = std::regex_search(inside, with_comma) && std::regex_search(inside, other_mark);
  std::replace_if(
      inside.begin(), inside.end(), [](const char c) { return c == ';' || c == '|' || c == '\t'; }, ' ');
  if (!commas_within) std::replace(inside.begin(), inside.end(), ',', ' ');
  std::istringstream in(inside);
  std::vector<std::string> items;
  bool were_whole = true, has_units = false;
  for (std::string item; in >> item;) {
    while (!item.empty() && item.back() == ',') item.pop_back();
    const auto number = written_number(item);
    const auto product = arithmetic(item);
    if (!product && !number) return number_remedy(text);
    if (!product && !number->unit.empty()) has_units = true;
    const double given = product ? *product : number->value, value = whole ? std::round(given) : given;
    if (whole && std::abs(value) > std::numeric_limits<int>::max())
      return " Write numbers of at most " + std::to_string(std::numeric_limits<int>::max()) + ".";
    were_whole &= value == given;
    items.push_back(number_text(value));
  }
  if (has_units && items.size() < 2) return number_remedy(text);
  const std::string units = has_units ? " Write numbers alone, in the deck's units (see \"Units\")." : "";
  return items.empty() ? "" : units + with_brackets(items, were_whole);
}

std::string bool_remedy(const std::string &text)
{
  std::string word = plain(text);
  std::transform(word.begin(), word.end(), word.begin(), [](const unsigned char c) { return std::tolower(c); });
  for (const char *const yes : {"on", "y", "t", "oui", "ja", ".true.", "enabled", "true", "yes", "1", "1.0"})
    if (word == yes) return " Write true.";
  for (const char *const no :
       {"off", "n", "f", "non", "nein", ".false.", "disabled", "none", "false", "no", "0", "0.0"})
    if (word == no) return " Write false.";
  return "";
}

std::string one_for_each_remedy(const std::string &text, const std::size_t length)
{
  const auto number = written_number(text);
  if (!number || !number->unit.empty() || length < 2) return "";
  const std::string one = number_text(number->value), two = one + ", " + one;
  return " Write one for each direction: {" + two + "} in the plane, {" + two + ", " + one + "} in space (in YAML [" +
         two + "]).";
}

std::string axis_remedy(const std::string &text)
{
  static const std::regex axis(R"(\{?\s*([-+]?)(?:e_?)?([xyzXYZ])\s*\}?)");
  std::smatch found;
  constexpr std::size_t longest = 20;
  const std::string given = plain(text);
  if (given.size() > longest || !std::regex_match(given, found, axis)) return "";
  const int direction = std::tolower(static_cast<unsigned char>(found[2].str()[0])) - 'x';
  const auto unit_vector = [&](const int dim) {
    std::string vector;
    for (int c = 0; c < dim; ++c)
      vector += (c > 0 ? ", " : "") + std::string(c == direction ? (found[1] == "-" ? "-1" : "1") : "0");
    return vector;
  };
  const std::string in_space = unit_vector(3), in_plane = unit_vector(2);
  return " Write {" + in_space + "}" + (direction < 2 ? " in space, {" + in_plane + "} in the plane" : "") +
         " (in YAML [" + in_space + "]).";
}

std::string word_remedy(const std::string &text, const std::vector<std::string> &words)
{
  for (const auto &[other, meant] : words_for_words) // a word may mean several: one of a mesh, another of a tool
    if (other == letters(text) && std::find(words.begin(), words.end(), meant) != words.end())
      return " For \"" + text + "\" write " + meant + ".";
  return did_you_mean(text, words);
}

std::string file_remedy(const std::string &name, const std::vector<std::string> &files)
{
  const auto stem = [](const std::string &file) { return std::filesystem::path(file).stem().string(); };
  if (stem(name).empty()) return "";
  std::vector<std::string> stems;
  for (const std::string &file : files) stems.push_back(stem(file));
  const std::string meant = nearest_name(stem(name), stems);
  if (meant.empty()) return "";
  std::vector<std::string> of_stem;
  for (const std::string &file : files)
    if (stem(file) == meant) of_stem.push_back(file);
  const std::string by_name = nearest_name(name, of_stem);
  return " Did you mean \"" + (by_name.empty() ? of_stem.front() : by_name) + "\"?";
}

std::string did_you_mean(const std::string &name, const std::vector<std::string> &candidates)
{
  const std::string nearest = nearest_name(name, candidates);
  return nearest.empty() ? "" : " Did you mean \"" + nearest + "\"?";
}

} // namespace rpc
