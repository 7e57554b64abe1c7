// SPDX-License-Identifier: BSD-3-Clause
#include "height_formats.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

namespace rpc::contact
{
namespace
{

constexpr std::string_view separators = " \t\r,;";

/// Lines of a text, each with its words, without comments behind # and empty ones.
class Lines
{
public:
  explicit Lines(const std::string &text) : rest_(text)
  {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3); // which tells UTF-8
  }
  bool next()
  {
    while (!rest_.empty()) {
      const auto end = std::min(rest_.find('\n'), rest_.size());
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number;
      line = line.substr(0, std::min(line.find('#'), line.size()));
      words.clear();
      for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;
           at = line.find_first_not_of(separators, at)) {
        const auto to = std::min(line.find_first_of(separators, at), line.size());
        words.push_back(line.substr(at, to - at));
        at = to;
      }
      if (!words.empty()) return true;
    }
    return false;
  }
  int number = 0;
  std::vector<std::string_view> words;

private:
  std::string_view rest_;
};

std::optional<double> number_in(std::string_view word)
{
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error != std::errc())
    return std::strtod(std::string(word).c_str(), nullptr); // too small or too large: 0 or infinite
  return value;
}

/// A word as it may stand in a message.
std::string shown(const std::string_view word)
{
  std::string text(word.substr(0, 40));
  for (char &c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

double text_number(const HeightFile &file, const Lines &lines, const std::size_t k)
{
  const auto value = number_in(lines.words[k]);
  RPC_REQUIRE(value, file.where << "must hold numbers, got \"" << shown(lines.words[k]) << "\" in line " << lines.number
                                << ", column " << k + 1
                                << ". Write numbers with decimal points, separated by commas, semicolons or blanks");
  return *value;
}

std::string lower_case(const std::string_view word)
{
  std::string text;
  for (const unsigned char c : word)
    if (c != '"') text += static_cast<char>(std::tolower(c));
  return text;
}

/// Whether a line is the heading of columns: x, y and heights, in the plane x and heights.
bool is_heading(const std::vector<std::string_view> &words, const int dim)
{
  if (static_cast<int>(words.size()) != dim) return false;
  return lower_case(words[0]) == "x" && (dim == 2 || lower_case(words[1]) == "y") && !number_in(words[dim - 1]);
}

/// Heights at places of a regular grid, in any order.
HeightTable read_places(const HeightFile &file, Lines &lines)
{
  std::array<std::set<double>, 2> at;
  std::map<std::pair<double, double>, double> height; // of y and x
  while (lines.next()) {
    RPC_REQUIRE(static_cast<int>(lines.words.size()) == file.dim,
                file.where << "must have " << file.dim << " numbers in each line, as in its heading, got "
                           << lines.words.size() << " in line " << lines.number << ". Mend that line");
    const double x = text_number(file, lines, 0), y = file.dim == 2 ? 0 : text_number(file, lines, 1);
    RPC_REQUIRE(std::isfinite(x) && std::isfinite(y), file.where
                                                          << "must have finite places, got one that is not in line "
                                                          << lines.number << ". Mend that line");
    at[0].insert(x);
    at[1].insert(y);
    const bool is_new = height.emplace(std::pair{y, x}, text_number(file, lines, file.dim - 1)).second;
    RPC_REQUIRE(is_new, file.where << "must have each place once, got (" << x << ", " << y << ") again in line "
                                   << lines.number << ". Remove one of them");
  }
  HeightTable table;
  table.columns = static_cast<int>(at[0].size());
  table.rows = static_cast<int>(at[1].size());
  for (int c = 0; c < file.dim - 1; ++c)
    table.spacing[c] = even_spacing(file, c == 0 ? "x" : "y", {at[c].begin(), at[c].end()})[0];
  for (const double y : at[1])
    for (const double x : at[0]) {
      const auto found = height.find({y, x});
      RPC_REQUIRE(found != height.end(), file.where
                                             << "must have a height at each place of a regular grid, got none at (" << x
                                             << ", " << y << ") of " << table.columns << " x " << table.rows
                                             << " places. Put the heights onto a regular grid first, as "
                                                "scipy.interpolate.griddata does");
      table.height.push_back(found->second);
    }
  return table;
}

} // namespace

HeightTable read_csv(const HeightFile &file)
{
  Lines lines(file.bytes);
  HeightTable table;
  RPC_REQUIRE(lines.next(), file.where << "holds no heights. Write a row of numbers a line");
  if (is_heading(lines.words, file.dim)) return read_places(file, lines);
  do {
    if (table.rows == 0) table.columns = static_cast<int>(lines.words.size());
    RPC_REQUIRE(static_cast<int>(lines.words.size()) == table.columns,
                file.where << "must have as many numbers in each row as in the first one, " << table.columns << ", got "
                           << lines.words.size() << " in line " << lines.number
                           << ". Fill in what is missing. A list of places begins with the heading "
                           << (file.dim == 2 ? "x,height" : "x,y,height"));
    for (std::size_t k = 0; k < lines.words.size(); ++k) table.height.push_back(text_number(file, lines, k));
    ++table.rows;
  } while (lines.next());
  return table;
}

/// A head of names with numbers, then rows from the north to the south.
HeightTable read_esri_grid(const HeightFile &file)
{
  Lines lines(file.bytes);
  std::map<std::string, double> head;
  bool more = lines.next();
  for (; more && lines.words.size() == 2 && std::isalpha(static_cast<unsigned char>(lines.words[0][0])) != 0 &&
         !number_in(lines.words[0]);
       more = lines.next())
    head[lower_case(lines.words[0])] = text_number(file, lines, 1);
  HeightTable table;
  const auto count = [&](const std::string &name) {
    const double n = head.count(name) > 0 ? head[name] : 0;
    RPC_REQUIRE(n >= 1 && n == std::floor(n) && n < 1e6,
                file.where << "must have a line \"" << name << " N\" with a number from 1 to 999999 in its head, got "
                           << (head.count(name) > 0 ? std::to_string(n) : "none") << ". Write an ESRI ASCII grid");
    return static_cast<int>(n);
  };
  table.columns = count("ncols");
  table.rows = count("nrows");
  for (int c = 0; c < 2; ++c) {
    const std::string own = c == 0 ? "dx" : "dy", name = head.count(own) > 0 ? own : "cellsize";
    table.spacing[c] = head.count(name) > 0 ? head[name] : 0;
    RPC_REQUIRE(table.spacing[c] > 0 && std::isfinite(table.spacing[c]),
                file.where << "must have a line \"cellsize H\" with a number > 0 in its head, got " << table.spacing[c]
                           << ". Write an ESRI ASCII grid");
  }
  const std::size_t wanted = static_cast<std::size_t>(table.columns) * table.rows;
  std::vector<double> read; // rows may be broken into lines
  for (; more; more = lines.next())
    for (std::size_t k = 0; k < lines.words.size(); ++k) {
      const double z = text_number(file, lines, k);
      RPC_REQUIRE(head.count("nodata_value") == 0 || z != head["nodata_value"],
                  file.where << "must have a height at each place, got its NODATA_value " << z << " in line "
                             << lines.number << ". Fill in what was not measured, or cut it off");
      RPC_REQUIRE(read.size() < wanted, file.where << "must hold " << table.columns << " x " << table.rows
                                                   << " heights, got more in line " << lines.number
                                                   << ". Mend \"ncols\" and \"nrows\"");
      read.push_back(z);
    }
  RPC_REQUIRE(read.size() == wanted, file.where << "must hold " << table.columns << " x " << table.rows << " = "
                                                << wanted << " heights, got " << read.size() << ". Write it again");
  for (int j = table.rows - 1; j >= 0; --j)
    table.height.insert(table.height.end(), read.begin() + static_cast<std::ptrdiff_t>(j) * table.columns,
                        read.begin() + static_cast<std::ptrdiff_t>(j + 1) * table.columns);
  return table;
}

} // namespace rpc::contact
