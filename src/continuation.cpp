// SPDX-License-Identifier: BSD-3-Clause
#include "continuation.hpp"

#include "rpc/core/error.hpp"
#include "rpc/io/expression.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

namespace rpc
{
namespace
{

/// A parameter with its name in the deck.
struct Parameter {
  std::string name, value;
};
/// By places: names, but numbers for the entries of lists whose names are the user's choice.
using Parameters = std::map<std::string, Parameter>;

// Nodes of a rank at which fields are compared.
constexpr LO most_nodes = 2000;
// Values that differ by less are one number, written in two ways.
constexpr double rounding = 1e-12;

/// Whether entries of a list are the same in their order, whatever their names: conditions, each with a `Side` that is its name by
/// default.
bool has_free_names(const std::string &place)
{
  return place == "Dirichlet" || place == "Rigid" || place == "Traction" || place == "Contact->Sides";
}

/// "name=value;" and "name{...}" of a part of a deck.
void read_list(const std::string &text, std::size_t &at, const std::string &place, const std::string &path,
               Parameters &found)
{
  int entry = 0;
  while (at < text.size() && text[at] != '}') {
    const std::size_t mark = text.find_first_of("={", at);
    if (mark == std::string::npos) return;
    const std::string name = text.substr(at, mark - at);
    at = mark + 1;
    if (text[mark] == '{') {
      const bool free = has_free_names(place);
      const std::string of_entry = place + "->" + (free ? std::to_string(++entry) : name);
      read_list(text, at, of_entry, path + "->" + name, found);
      ++at; // the closing brace
      if (free && found[of_entry + "->Side"].value.empty())
        found[of_entry + "->Side"] = {path + "->" + name + "->Side", name};
      continue;
    }
    const std::size_t end = std::min(text.find(';', at), text.size());
    found[place + "->" + name] = {path + "->" + name, text.substr(at, end - at)};
    at = end + 1;
  }
}

Parameters parameters_of(const std::vector<std::pair<std::string, std::string>> &parts)
{
  Parameters found;
  for (const auto &[name, content] : parts) {
    std::size_t at = 0;
    if (content.find_first_of("={") == std::string::npos)
      found[name] = {name, content};
    else
      read_list(content, at, name, name, found);
  }
  return found;
}

/// The entries of an array "{a, b}"; of anything else that alone.
std::vector<std::string> entries_of(const std::string &text)
{
  if (text.size() < 2 || text.front() != '{' || text.back() != '}') return {text};
  std::vector<std::string> entries(1);
  int depth = 0;
  for (const char c : text.substr(1, text.size() - 2)) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0)
      entries.emplace_back();
    else
      entries.back() += c;
  }
  return entries;
}

/// Some nodes of this rank, as evenly spread as their numbers.
std::vector<Point> sample(const mesh::Mesh &mesh)
{
  const auto coords = to_host(mesh.coords);
  const LO nodes = mesh.num_owned_nodes(), step = std::max<LO>(1, nodes / most_nodes);
  std::vector<Point> points;
  for (LO n = 0; n < nodes; n += step) {
    Point point{};
    for (int k = 0; k < mesh.dim(); ++k) point[k] = coords(n, k);
    points.push_back(point);
  }
  return points;
}

/// Where and when two fields differ, in words; empty if they do not.
std::string difference(const ScalarField &now, const ScalarField &before, const std::vector<Point> &points,
                       const std::vector<double> &times)
{
  for (const double t : times)
    for (const Point &x : points) {
      const double a = now.seen_at(t)(x), b = before.seen_at(t)(x);
      if (a == b || std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b))) continue;
      if (std::isnan(a) && std::isnan(b)) continue;
      std::ostringstream text;
      text << "at t = " << t << " and (" << x[0] << ", " << x[1] << ", " << x[2] << ") it is " << a << " and was " << b;
      return text.str();
    }
  return "";
}

/// The same of two texts; one that is no field differs.
std::string difference(const std::string &name, const std::string &now, const std::string &before,
                       const std::vector<Point> &points, const std::vector<double> &times)
{
  const auto these = entries_of(now), those = entries_of(before);
  const std::string plainly = "it is \"" + now + "\" and was \"" + before + "\"";
  if (these.size() != those.size()) return plainly;
  for (std::size_t k = 0; k < these.size(); ++k) {
    if (these[k] == those[k]) continue;
    try {
      const std::string found =
          difference(io::parse_field(these[k], name), io::parse_field(those[k], name), points, times);
      if (!found.empty()) return found;
    } catch (const Error &) { // a name or a choice
      return plainly;
    }
  }
  return "";
}

/// The times of the deck up to there must be those of the steps that are done; a deck may list later ones only.
void require_times(const Scene &scene, const std::vector<double> &done, const std::string &path)
{
  std::vector<double> wanted;
  for (const double t : scene.steps.times)
    if (t <= done.back()) wanted.push_back(t);
  if (wanted == done || wanted.empty()) return;
  std::ostringstream text;
  for (const double t : done) text << (text.tellp() > 0 ? ", " : "") << t;
  throw Error(ExitCode::bad_input, "restart: \"" + path + "\" has done the steps at t = " + text.str() +
                                       ", and \"Steps->Times\" has others up to there. Only later times may change.");
}

} // namespace

void require_continuation(const Scene &scene, const fem::Discretization &d,
                          const std::vector<std::pair<std::string, std::string>> &before,
                          const std::vector<analysis::StepRecord> &records, const std::string &path)
{
  std::vector<double> times;
  for (const auto &record : records) times.push_back(record.time);
  if (!times.empty()) require_times(scene, times, path);
  const Parameters now = parameters_of(scene.identity), then = parameters_of(before);
  const auto points = sample(*d.mesh);
  std::optional<std::string> message;
  const auto refuse = [&](const std::string &name, const std::string &why) {
    if (!message)
      message = "restart: \"" + path + "\" was written for another deck: \"" + name + "\", " + why +
                ". Bodies, conditions and laws must stay; fields may change after the steps that are done.";
  };
  for (const auto &[place, parameter] : now) {
    const auto &[name, value] = parameter;
    const auto found = then.find(place);
    if (found == then.end())
      refuse(name, "which it did not have");
    else if (value != found->second.value)
      if (const std::string why = difference(name, value, found->second.value, points, times); !why.empty())
        refuse(name, why);
  }
  for (const auto &[place, parameter] : then)
    if (now.find(place) == now.end()) refuse(parameter.name, "which is gone");
  throw_if_any(d.mesh->comm(), ExitCode::bad_input, message);
}

} // namespace rpc
