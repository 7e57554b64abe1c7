// SPDX-License-Identifier: BSD-3-Clause
#include "output/points.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/fem/at_points.hpp"
#include "rpc/fem/stress.hpp"
#include "rpc/io/contact_csv.hpp"
#include "rpc/mesh/geometry.hpp"
#include "scene.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace rpc
{
namespace
{

// Of the body's diameter: meshes miss curved surfaces by less, and results there are those of the nearest point of the mesh.
constexpr double beside = 0.01;

/// "point 2 of "Output->Points->line" at (1, 0.5)"
std::string point_name(const ResultPoints &points, const std::size_t k, const int dim)
{
  std::ostringstream text;
  text << "point " << k + 1 << " of \"Output->Points->" << points.name << "\" at (" << points.place[k][0];
  for (int c = 1; c < dim; ++c) text << ", " << points.place[k][c];
  text << ")";
  return text.str();
}

/// Of "0 0; 1 0.5".
std::vector<Point> places_of(const std::string &text, const int dim, const std::string &path)
{
  std::vector<Point> places;
  std::istringstream points(text);
  for (std::string point; std::getline(points, point, ';');) {
    std::istringstream in(point);
    std::vector<double> numbers;
    bool reads = true;
    for (std::string word; in >> word;) {
      char *end = nullptr;
      numbers.push_back(std::strtod(word.c_str(), &end));
      reads = reads && *end == '\0' && std::isfinite(numbers.back());
    }
    RPC_REQUIRE(reads && static_cast<int>(numbers.size()) == dim,
                "deck: \"" << path << "\" must have " << dim
                           << " numbers for each point, with blanks between them and semicolons between points, got \""
                           << point << "\". Write such as \"" << (dim == 2 ? "0 0; 1 0.5" : "0 0 0; 1 0.5 2") << "\".");
    Point place{};
    std::copy(numbers.begin(), numbers.end(), place.begin());
    places.push_back(place);
  }
  return places;
}

Point end_of_line(const Teuchos::ParameterList &entry, const char *const name, const int dim, const std::string &path)
{
  const auto &numbers = entry.get<Teuchos::Array<double>>(name);
  bool finite = true;
  for (const double number : numbers) finite = finite && std::isfinite(number);
  RPC_REQUIRE(finite && static_cast<int>(numbers.size()) == dim,
              "deck: \"" << path << "->" << name << "\" must be " << dim << " finite numbers [m], got " << numbers
                         << ". A line needs From, To and Count.");
  Point place{};
  std::copy(numbers.begin(), numbers.end(), place.begin());
  return place;
}

std::vector<Point> all_places(const std::vector<ResultPoints> &points)
{
  std::vector<Point> places;
  for (const ResultPoints &entry : points) places.insert(places.end(), entry.place.begin(), entry.place.end());
  return places;
}

/// (owned nodes; 2 for each contact side) the pressure at its nodes, and 1 there, else 0. A cell may have all its nodes on two sides together.
RCP<MultiVector> pressures(const analysis::Solution &s)
{
  const contact::ContactNodes &contact = s.step.contact;
  const auto columns = Teuchos::rcp(new MultiVector(s.discretization.mesh->owned_nodes, 2 * contact.num_sides()));
  const auto to = columns->getLocalViewHost(Tpetra::Access::ReadWrite);
  const auto node = to_host(contact.node);
  const auto pressure = to_host(s.contact.pressure);
  for (int side = 0; side < contact.num_sides(); ++side)
    for (LO i = contact.first(side); i < contact.first(side + 1); ++i) {
      to(node(i), 2 * side) = pressure(i);
      to(node(i), 2 * side + 1) = 1;
    }
  return columns;
}

std::string point_headings(const Scene &scene, const PointValues &values, const int dim)
{
  const UnitNames &units = scene.model.units;
  const std::string length = units.heading(unit::length, false), stress = units.heading(unit::pressure, false);
  std::string text = "time,name,number";
  for (int c = 0; c < dim; ++c) text += std::string(",") + "xyz"[c] + length;
  text += ",s" + length + ",off" + length;
  for (const std::string &name : values.names) text += "," + name + (name.rfind("disp_", 0) == 0 ? length : stress);
  return text + "\n";
}

std::string point_rows(const std::vector<ResultPoints> &points, const PointValues &values, const double time,
                       const int dim)
{
  std::ostringstream text;
  text.precision(17);
  std::size_t row = 0;
  for (const ResultPoints &entry : points) {
    double s = 0;
    for (std::size_t k = 0; k < entry.place.size(); ++k, ++row) {
      const Point &x = entry.place[k], &before = entry.place[k > 0 ? k - 1 : 0];
      s += std::hypot(x[0] - before[0], x[1] - before[1], x[2] - before[2]);
      text << time << ',' << io::csv_quoted(entry.name) << ',' << k + 1;
      for (int c = 0; c < dim; ++c) text << ',' << x[c];
      text << ',' << s << ',' << values.off[row];
      for (const double value : values.rows[row]) text << ',' << value;
      text << '\n';
    }
  }
  return text.str();
}

/// The rows of an earlier run's table at some times; none of a table with other headings.
std::string kept_rows(const std::string &path, const std::string &headings, const std::vector<double> &times)
{
  std::ifstream file(path);
  std::string line, kept;
  if (!std::getline(file, line) || line + "\n" != headings) return "";
  while (std::getline(file, line))
    if (std::find(times.begin(), times.end(), std::strtod(line.c_str(), nullptr)) != times.end()) kept += line + "\n";
  return kept;
}

} // namespace

void add_points_parameters(Teuchos::ParameterList &output)
{
  Teuchos::ParameterList entry;
  entry.set("Points", "", "Places in the undeformed body [m], such as `0 0; 1 0.5`, in space `0 0 0; 1 0.5 2`.");
  entry.set("From", Teuchos::Array<double>(), "Or a line: where it begins [m]; with `To` and `Count`.");
  entry.set("To", Teuchos::Array<double>(), "Where it ends [m].");
  entry.set("Count", 0, "Points on it, >= 2, at equal distances, its ends among them.");
  set_named_entries(output, "Points", entry,
                    "Results at points and along lines, in <deck>.points.csv: any number of entries with names of your "
                    "choice.");
}

std::vector<ResultPoints> points_options(const Teuchos::ParameterList &list, const int dim)
{
  std::vector<ResultPoints> all;
  for (auto it = list.begin(); it != list.end(); ++it) {
    const std::string &name = list.name(it), path = "Output->Points->" + name;
    const Teuchos::ParameterList &entry = list.sublist(name);
    const auto given = [&](const char *const parameter) { return !entry.getEntry(parameter).isDefault(); };
    const bool line = given("From") || given("To") || given("Count");
    RPC_REQUIRE(given("Points") != line, "deck: \"" << path << "\" must have either Points or From, To and Count, got "
                                                    << (line ? "both." : "none of them."));
    ResultPoints points{name, {}};
    if (!line) {
      points.place = places_of(entry.get<std::string>("Points"), dim, path + "->Points");
      RPC_REQUIRE(!points.place.empty(), "deck: \"" << path
                                                    << "->Points\" must have a point, got none. Write such as \""
                                                    << (dim == 2 ? "0 0; 1 0.5" : "0 0 0; 1 0.5 2") << "\".");
    } else {
      const Point from = end_of_line(entry, "From", dim, path), to = end_of_line(entry, "To", dim, path);
      const int count = entry.get<int>("Count");
      constexpr int most = 1000000;
      RPC_REQUIRE(count >= 2 && count <= most, "deck: \"" << path << "->Count\" must be from 2 to " << most
                                                          << ", the ends of the line among them, got " << count << ".");
      for (int k = 0; k < count; ++k) {
        Point place{};
        const double share = static_cast<double>(k) / (count - 1);
        for (int c = 0; c < dim; ++c) place[c] = k + 1 == count ? to[c] : from[c] + share * (to[c] - from[c]);
        points.place.push_back(place);
      }
    }
    all.push_back(points);
  }
  return all;
}

PointValues values_at(const std::vector<ResultPoints> &points, const Scene &scene, const analysis::Solution &s)
{
  const fem::Discretization &d = s.discretization;
  const int dim = d.dim();
  const fem::AtPoints at_points(d, all_places(points));
  PointValues values;
  values.off = at_points.distances();
  const double rounding = 1e-9 * d.diameter;
  for (double &off : values.off)
    if (off <= rounding) off = 0;
  MultiVector displacement(d.mesh->owned_nodes, dim);
  {
    const auto from = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto to = displacement.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t n = 0; n < to.extent(0); ++n)
      for (int c = 0; c < dim; ++c) to(n, c) = from(dim * n + c, 0);
  }
  values.rows = at_points.of(displacement);
  for (int c = 0; c < dim; ++c) values.names.push_back(std::string("disp_") + "xyz"[c]);
  const auto stress = at_points.of(*fem::RecoveredStress(d, scene.model.materials, *s.u).at_nodes());
  for (const std::string &name : fem::stress_names(d)) values.names.push_back(name);
  for (std::size_t k = 0; k < stress.size(); ++k)
    values.rows[k].insert(values.rows[k].end(), stress[k].begin(), stress[k].end());
  if (scene.model.contact.empty()) return values;
  const auto pressure = at_points.of(*pressures(s));
  values.names.emplace_back("contact_pressure");
  constexpr double on_side = 1 - 1e-9; // sums of weights are rounded
  for (std::size_t k = 0; k < pressure.size(); ++k) {
    double highest = std::numeric_limits<double>::quiet_NaN(); // of two sides the higher one, as in the Exodus file
    for (std::size_t column = 0; column < pressure[k].size(); column += 2)
      if (pressure[k][column + 1] >= on_side) highest = std::fmax(highest, pressure[k][column]);
    values.rows[k].push_back(highest);
  }
  return values;
}

void require_inside(const std::vector<ResultPoints> &points, const fem::Discretization &d, const UnitNames &units)
{
  if (points.empty()) return;
  const auto distance = fem::AtPoints(d, all_places(points)).distances();
  const double most = beside * d.diameter;
  on_root(d.mesh->comm(), ExitCode::bad_input, [&] {
    std::size_t row = 0;
    for (const ResultPoints &entry : points)
      for (std::size_t k = 0; k < entry.place.size(); ++k, ++row)
        RPC_REQUIRE(distance[row] <= most, "deck: " << point_name(entry, k, d.dim())
                                                    << " must lie in the undeformed body, which is " << distance[row]
                                                    << " [" << units.of(unit::length, false)
                                                    << "] away. \"--check\" tells where the sides of the body are.");
  });
}

void PointsFile::update(const std::string &path, const Scene &scene, const analysis::Solution &s)
{
  const auto &points = scene.output.points;
  if (path.empty() || !s.has_results() || (begun_ && last_ == s.time)) return;
  const PointValues values = values_at(points, scene, s);
  const int dim = s.discretization.dim();
  std::vector<double> before;
  for (const auto &step : s.history)
    if (step.converged && step.time < s.time) before.push_back(step.time);
  on_root(s.discretization.mesh->comm(), ExitCode::internal_error, [&] {
    const std::string rows = point_rows(points, values, s.time, dim);
    if (file_) return file_->append(rows);
    const std::string headings = point_headings(scene, values, dim);
    file_ = std::make_unique<io::GrowingFile>(
        path, headings + (before.empty() ? "" : kept_rows(path, headings, before)) + rows);
  });
  begun_ = true;
  last_ = s.time;
}

} // namespace rpc
