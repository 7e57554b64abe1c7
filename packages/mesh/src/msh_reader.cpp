// SPDX-License-Identifier: BSD-3-Clause
#include "msh_reader.hpp"

#include "gmsh_types.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace rpc::mesh
{
namespace
{

constexpr const char *blanks = " \t\r\n";
/// A piece of the file for a message.
std::string in_quotes(const std::string_view piece)
{
  std::string text = "\"" + std::string(piece.substr(0, 40)) + "\"";
  for (char &c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

bool is_blank(const char c)
{
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// The file from front to back.
class Reader
{
public:
  Reader(const std::string &where, const std::string &text) : where_(where), text_(text) {}

  bool binary = false;

  [[noreturn]] void refuse(const std::string &what) const
  {
    throw Error(ExitCode::bad_mesh, where_ + (section_.empty() ? "" : "in $" + section_ + ", ") + what);
  }

  /// The rest of the line.
  std::string_view line()
  {
    const std::size_t begin = at_, end = std::min(text_.find('\n', at_), text_.size());
    at_ = std::min(end + 1, text_.size());
    const std::string_view all = text_.substr(begin, end - begin);
    return all.substr(0, all.find_last_not_of(blanks) + 1);
  }

  /// Goes to the next section and returns its name without $; empty at the end of the file.
  std::string next_section()
  {
    section_.clear();
    skip_blanks();
    if (at_ == text_.size()) return "";
    const std::string_view name = line();
    const bool good =
        name.size() > 1 && name[0] == '$' &&
        std::all_of(name.begin() + 1, name.end(), [](const unsigned char c) { return std::isalpha(c) != 0; });
    const char *const remedy = name[0] == '*' ? "; give a file of Abaqus or CalculiX the ending .inp" : "";
    if (!good) refuse("a section must begin with its name, as $Nodes does, got " + in_quotes(name) + remedy);
    section_ = name.substr(1);
    return section_;
  }

  void end_section()
  {
    skip_blanks();
    const std::size_t here = at_;
    const std::string_view name = line();
    if (name == "$End" + section_) return;
    if (here == text_.size()) refuse("the file ends early: it is truncated");
    refuse("its contents must be followed by $End" + section_ + ", got " + in_quotes(name) + ": counts do not fit");
  }

  /// Passes over a section that does not matter.
  void skip_section()
  {
    const std::size_t end = text_.find("$End" + section_, at_);
    if (end == text_.npos) refuse("there is no $End" + section_ + ": the file is truncated");
    at_ = end;
    line();
  }

  double real() { return binary ? bytes<double>() : word<double>(); }
  int small_integer() { return binary ? bytes<std::int32_t>() : word<int>(); }
  std::int64_t large_integer() { return binary ? bytes<std::int64_t>() : word<std::int64_t>(); }

  /// An integer that is text even in a binary file, with the end of its line.
  std::int64_t text_integer()
  {
    const auto value = word<std::int64_t>();
    line();
    return value;
  }

  std::size_t node(const std::int64_t tag) const
  {
    if (tag < 1) refuse("a node's number must be > 0, got " + std::to_string(tag));
    return static_cast<std::size_t>(tag);
  }

private:
  void skip_blanks()
  {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  template <class T>
  T bytes()
  {
    T value;
    if (text_.size() - at_ < sizeof value) refuse("the file ends early: it is truncated");
    std::memcpy(&value, text_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  template <class T>
  T word()
  {
    skip_blanks();
    if (at_ == text_.size()) refuse("the file ends early: it is truncated");
    T value{};
    const char *const last = text_.data() + text_.size();
    const auto [end, error] = std::from_chars(text_.data() + at_, last, value);
    if (error != std::errc() || (end != last && !is_blank(*end)))
      refuse(std::string(std::is_integral_v<T> ? "a whole number" : "a number") + " was expected, got " +
             in_quotes(text_.substr(at_, std::min(text_.find_first_of(blanks, at_), text_.size()) - at_)));
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  std::string where_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::string section_;
};

using Key = std::tuple<int, int, int, int>; // dimension, physical tag, entity, type

struct Draft {
  GmshContents contents;
  std::map<std::pair<int, int>, std::string> groups;                // dimension and tag -> name
  std::map<std::pair<int, int>, std::vector<int>> groups_of_entity; // dimension and entity -> tags; 4.1
  std::map<Key, GmshElements> elements;                             // the tag 0 stands for no group
  std::set<std::pair<int, int>> between_parts; // dimension and entity, where a mesh is divided among processors
};

/// Whether it is version 4.1.
bool read_format(Reader &reader)
{
  if (reader.next_section() != "MeshFormat") reader.refuse("a .msh must begin with $MeshFormat");
  const std::string line(reader.line());
  std::smatch part;
  if (!std::regex_match(line, part, std::regex(R"((\S+)\s+([01])\s+(\d+))")))
    reader.refuse("there must be version, file type (0 or 1) and data size, got " + in_quotes(line));
  const bool known = part[1] == "2.2" || part[1] == "4.1";
  if (!known)
    reader.refuse("the version must be 2.2 or 4.1, got " + in_quotes(part[1].str()) +
                  "; convert it: gmsh old.msh -save -format msh41 -o new.msh");
  if (part[3] != "8") reader.refuse("the data size must be 8, got " + part[3].str());
  reader.binary = part[2] == "1";
  if (reader.binary && reader.small_integer() != 1) reader.refuse("the file was written on another kind of machine");
  reader.end_section();
  return part[1] == "4.1";
}

void read_names(Reader &reader, Draft &draft)
{
  static const std::regex form(R"re(\s*([0-3])\s+([1-9]\d{0,8})\s+"([^"]*)"(?:\s+(.*))?)re");
  for (auto count = reader.text_integer(); count > 0; --count) {
    const std::string line(reader.line());
    std::smatch part;
    if (!std::regex_match(line, part, form))
      reader.refuse("a line must be dimension (0 to 3), number and name in quotes, got " + in_quotes(line));
    draft.groups[{std::stoi(part[1]), std::stoi(part[2])}] = part[3];
    if (part[4].length() > 0) draft.contents.notes.push_back("words after a name are left out: " + in_quotes(line));
  }
}

/// A negative number in the file says that the entity is turned around.
int group_tag(const std::int64_t number)
{
  return static_cast<int>(std::abs(number));
}

/// Which physical groups the entities of a 4.1 belong to.
/// @param parts  of a mesh that is divided among processors: those that an entity is divided into
void read_entities(Reader &reader, Draft &draft, const bool parts)
{
  if (parts) {
    draft.groups_of_entity.clear();
    reader.large_integer(); // number of parts, before the list of ghosts
    for (auto numbers = 2 * reader.large_integer(); numbers > 0; --numbers) reader.small_integer();
  }
  std::int64_t count[4];
  for (auto &c : count) c = reader.large_integer();
  for (int dim = 0; dim < 4; ++dim)
    for (; count[dim] > 0; --count[dim]) {
      const int entity = reader.small_integer();
      if (parts) {
        if (reader.small_integer() != dim)
          draft.between_parts.insert({dim, entity}); // the dimension of what is divided
        reader.small_integer();
        for (auto owners = reader.large_integer(); owners > 0; --owners) reader.small_integer();
      }
      for (int x = 0; x < (dim == 0 ? 3 : 6); ++x) reader.real(); // the box around it
      for (auto groups = reader.large_integer(); groups > 0; --groups) {
        const int tag = group_tag(reader.small_integer());
        if (draft.between_parts.count({dim, entity})) continue;
        draft.groups[{dim, tag}];
        draft.groups_of_entity[{dim, entity}].push_back(tag);
      }
      if (dim > 0)
        for (auto bounds = reader.large_integer(); bounds > 0; --bounds) reader.small_integer();
    }
}

void read_nodes_22(Reader &reader, GmshContents &contents)
{
  for (auto count = reader.text_integer(); count > 0; --count) {
    contents.node_tags.push_back(reader.node(reader.small_integer()));
    for (int d = 0; d < 3; ++d) contents.coords.push_back(reader.real());
  }
}

void read_nodes_41(Reader &reader, GmshContents &contents)
{
  auto blocks = reader.large_integer();
  for (int unused = 0; unused < 3; ++unused) reader.large_integer(); // number of nodes, least and greatest tag
  for (; blocks > 0; --blocks) {
    const auto dim = reader.small_integer();
    reader.small_integer(); // entity
    const bool parametric = reader.small_integer() != 0;
    if (dim < 0 || dim > 3) reader.refuse("a dimension must be 0 to 3, got " + std::to_string(dim));
    const auto count = reader.large_integer();
    for (auto n = count; n > 0; --n) contents.node_tags.push_back(reader.node(reader.large_integer()));
    for (auto n = count; n > 0; --n) {
      for (int d = 0; d < 3; ++d) contents.coords.push_back(reader.real());
      for (int d = 0; parametric && d < dim; ++d) reader.real();
    }
  }
}

const GmshType &known_type(const Reader &reader, const int number)
{
  const GmshType *const type = gmsh_type(number);
  if (!type) reader.refuse("elements of type " + std::to_string(number) + " are unknown");
  return *type;
}

/// Where elements of one type, entity and set of groups go.
class Destination
{
public:
  Destination(Draft &draft, const int type, const int entity, const std::vector<int> &groups)
  {
    const int dim = gmsh_type(type)->dim;
    draft.contents.dim = std::max(draft.contents.dim, dim);
    for (const int group : groups.empty() ? std::vector<int>{0} : groups) {
      GmshElements &elements = draft.elements[{dim, group, entity, type}];
      elements.type = type;
      lists_.push_back(&elements);
    }
  }

  void add(const std::size_t tag, const std::vector<std::size_t> &nodes)
  {
    for (GmshElements *const list : lists_) {
      list->tags.push_back(tag);
      list->nodes.insert(list->nodes.end(), nodes.begin(), nodes.end());
    }
  }

private:
  std::vector<GmshElements *> lists_;
};

void read_elements_22(Reader &reader, Draft &draft)
{
  auto count = reader.text_integer();
  std::vector<std::size_t> nodes;
  std::optional<Destination> destination;
  std::tuple<int, int, int> before; // type, group and entity
  while (count > 0) {
    // ASCII: number, type, number of tags, then the tags and nodes; binary: type, length of a run, number of tags,
    // then for each element of the run its number, tags and nodes.
    const auto first = reader.small_integer(), second = reader.small_integer(), num_tags = reader.small_integer();
    const auto number = reader.binary ? first : second;
    const GmshType &type = known_type(reader, number);
    const auto run = reader.binary ? second : 1;
    if (run < 1 || run > count) reader.refuse("a run of " + std::to_string(run) + " elements does not fit the count");
    for (auto e = run; e > 0; --e, --count) {
      const auto tag = reader.binary ? reader.small_integer() : first;
      int group = 0, entity = 0;
      for (std::int64_t t = 0; t < num_tags; ++t) {
        const int value = reader.small_integer();
        if (t == 0) group = group_tag(value);
        if (t == 1) entity = value;
      }
      nodes.clear();
      for (int a = 0; a < type.num_nodes; ++a) nodes.push_back(reader.node(reader.small_integer()));
      if (const std::tuple now(number, group, entity); !destination || now != before) {
        before = now;
        if (group != 0) draft.groups[{type.dim, group}];
        destination.emplace(draft, number, entity, group == 0 ? std::vector<int>() : std::vector<int>{group});
      }
      destination->add(static_cast<std::size_t>(tag), nodes);
    }
  }
}

void read_elements_41(Reader &reader, Draft &draft)
{
  auto blocks = reader.large_integer();
  std::vector<std::size_t> nodes;
  for (int unused = 0; unused < 3; ++unused) reader.large_integer(); // number of elements, least and greatest tag
  for (; blocks > 0; --blocks) {
    const auto dim = reader.small_integer();
    const int entity = reader.small_integer();
    const auto number = reader.small_integer();
    const GmshType &type = known_type(reader, number);
    if (dim != type.dim)
      reader.refuse("elements of type \"" + type.name() + "\" cannot be of dimension " + std::to_string(dim));
    auto count = reader.large_integer();
    if (count <= 0) continue;
    static const std::vector<int> none; // what lies between parts is no element of the mesh
    Destination destination(draft, number, entity,
                            draft.between_parts.count({dim, entity}) ? none : draft.groups_of_entity[{dim, entity}]);
    for (; count > 0; --count) {
      const auto tag = reader.large_integer();
      nodes.clear();
      for (int a = 0; a < type.num_nodes; ++a) nodes.push_back(reader.node(reader.large_integer()));
      destination.add(static_cast<std::size_t>(tag), nodes);
    }
  }
}

/// Without groups of the body's dimension all cells of that dimension are the body.
GmshContents finished(Draft draft)
{
  const auto matters = [&draft](const std::pair<int, int> &group, const int of_body) {
    if (group.first == 0) return !draft.groups.at(group).empty(); // a point without a name serves nobody
    return group.first == of_body || group.first == of_body - 1;
  };
  for (const auto &[key, name] : draft.groups) draft.contents.dim = std::max(draft.contents.dim, key.first);
  const int dim = draft.contents.dim;
  auto &groups = draft.contents.groups;
  for (const auto &[key, name] : draft.groups)
    if (matters(key, dim)) groups.push_back({key.first, key.second, name});
  const bool grouped = !groups.empty() && groups.back().dim == dim;
  if (!grouped) groups.push_back({dim, 0, whole_body});
  for (auto &[key, elements] : draft.elements) {
    const auto [of_group, tag, entity, type] = key;
    if (tag == 0 && of_group == dim && grouped)
      draft.contents.ungrouped_nodes.insert(draft.contents.ungrouped_nodes.end(), elements.nodes.begin(),
                                            elements.nodes.end());
    const auto group = std::find_if(groups.begin(), groups.end(), [dim = of_group, tag = tag](const GmshGroup &g) {
      return g.dim == dim && g.tag == tag;
    });
    if (group == groups.end()) continue;
    elements.group = static_cast<int>(group - groups.begin());
    draft.contents.elements.push_back(std::move(elements));
  }
  return std::move(draft.contents);
}

/// Whether there is a volume among the names, which come first: the rest need not be read to know.
bool names_volume(const std::string &where, const std::string &text)
{
  Reader reader(where, text);
  read_format(reader);
  Draft draft;
  if (reader.next_section() == "PhysicalNames") read_names(reader, draft);
  return !draft.groups.empty() && draft.groups.rbegin()->first.first == 3;
}

/// Surfaces in space are no body.
void check_plane(const std::string &where, const GmshContents &contents)
{
  std::set<std::size_t> used;
  for (const auto &elements : contents.elements)
    if (contents.groups[elements.group].dim == 2) used.insert(elements.nodes.begin(), elements.nodes.end());
  double size = 0, height = std::nan("");
  for (const double x : contents.coords) size = std::max(size, std::abs(x));
  for (std::size_t n = 0; n < contents.node_tags.size(); ++n) {
    if (!used.count(contents.node_tags[n])) continue;
    const double *const x = &contents.coords[3 * n];
    if (std::isnan(height)) height = x[2];
    RPC_REQUIRE_CODE(!(std::abs(x[2] - height) > 1e-10 * size), ExitCode::bad_mesh,
                     where << "has no volumes, and node " << contents.node_tags[n] << " at (" << x[0] << ", " << x[1]
                           << ", " << x[2] << ") is off the plane. Of a body in space gmsh writes the volumes "
                           << "if there are no groups, or if one names them: Physical Volume(\"body\") = {...};");
  }
}

} // namespace

GmshContents read_msh(const std::string &where, const std::string &text)
{
  Reader reader(where, text);
  const bool version_41 = read_format(reader);
  Draft draft;
  std::set<std::string> seen;
  for (std::string name = reader.next_section(); !name.empty(); name = reader.next_section()) {
    if (!seen.insert(name).second) reader.refuse("which comes twice");
    if (name == "PhysicalNames")
      read_names(reader, draft);
    else if ((name == "Entities" || name == "PartitionedEntities") && version_41)
      read_entities(reader, draft, name == "PartitionedEntities");
    else if (name == "Nodes")
      version_41 ? read_nodes_41(reader, draft.contents) : read_nodes_22(reader, draft.contents);
    else if (name == "Elements")
      version_41 ? read_elements_41(reader, draft) : read_elements_22(reader, draft);
    else {
      reader.skip_section();
      continue;
    }
    reader.end_section();
  }
  for (const char *const name : {"Nodes", "Elements"})
    if (!seen.count(name)) reader.refuse("there is no $" + std::string(name));
  return finished(std::move(draft));
}

int dimension_of_msh(const std::string &where, const std::string &text)
{
  if (names_volume(where, text)) return 3;
  const GmshContents contents = read_msh(where, text);
  if (contents.dim == 2) check_plane(where, contents);
  return contents.dim;
}

} // namespace rpc::mesh
