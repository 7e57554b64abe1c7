// SPDX-License-Identifier: BSD-3-Clause
#include "understood.hpp"

#include "rpc/fem/measure.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace rpc
{
namespace
{

constexpr const char *component_names[] = {"X", "Y", "Z"};

std::string plain_number(const double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/// A vector in its components; what is rounding against `size` is 0.
std::string components(const Point &v, const int dim, const double size)
{
  std::string text;
  for (int c = 0; c < dim; ++c) text += (c > 0 ? ", " : "(") + plain_number(std::abs(v[c]) <= 1e-9 * size ? 0 : v[c]);
  return text + ")";
}

std::string joined_by(const std::vector<std::string> &parts, const std::string &mark)
{
  std::string text;
  for (const std::string &part : parts) text += (text.empty() ? "" : mark) + part;
  return text;
}

bool is_infinite_number(const ScalarField &field)
{
  return field.is_constant() && std::isinf(field.constant);
}

/// A field as a user may write it.
std::string field_words(const ScalarField &field)
{
  return field.is_constant() ? plain_number(field.constant) : "\"" + field.text + "\"";
}

/// Lines of a heading and a text; the heading of the lines that follow one another stands once.
class Block
{
public:
  explicit Block(std::ostream &out) : out_(out) {}
  void line(const std::string &heading, const std::string &text)
  {
    const std::string shown = heading == last_ ? "" : heading;
    out_ << "  " << shown << std::string(12 - std::min<std::size_t>(11, shown.size()), ' ') << text << '\n';
    last_ = heading;
  }

private:
  std::ostream &out_;
  std::string last_;
};

std::string material_text(const fem::Material &material, const std::string &stress)
{
  return "E = " + plain_number(material.youngs_modulus) + " " + stress +
         ", nu = " + plain_number(material.poissons_ratio);
}

/// "as one rigid piece; Y by Force Y = -20; Rotation Z = 0; X free of force".
std::string rigid_text(const fem::RigidMotions &rigid)
{
  std::vector<std::string> parts{"as one rigid piece"};
  for (const int k : rigid.motions) {
    const std::string motion = fem::name_of_motion(k);
    std::vector<std::string> by;
    if (rigid.force[k]) by.push_back(fem::name_of_force(k) + " = " + field_words(*rigid.force[k]));
    if (rigid.stiffness[k] > 0) by.push_back(fem::name_of_stiffness(k) + " = " + plain_number(rigid.stiffness[k]));
    if (rigid.displacement[k])
      parts.push_back(motion + " = " + field_words(*rigid.displacement[k]));
    else
      parts.push_back(by.empty() ? motion + " free of force" : motion + " by " + joined_by(by, " and "));
  }
  return joined_by(parts, ", ");
}

/// What a condition prescribes: "X = 0, Y = -0.1*t".
std::string prescribed_text(const fem::DirichletCondition &condition)
{
  std::vector<std::string> parts;
  if (condition.rigid) return rigid_text(*condition.rigid);
  for (int c = 0; c < 3; ++c)
    if (condition.displacement[c])
      parts.push_back(std::string(component_names[c]) + " = " + field_words(*condition.displacement[c]));
    else if (condition.force[c])
      parts.push_back("moved as one by Force " + std::string(component_names[c]) + " = " +
                      field_words(*condition.force[c]));
  return joined_by(parts, ", ");
}

/// What the divisions of a box have of their own along a coordinate.
std::string grading_text(const mesh::BoxOptions &box, const int c)
{
  if (box.periodic[c]) return " (periodic)";
  if (!box.graded(c)) return "";
  const std::vector<double> &ends = box.ends[c];
  return " (graded: cells of " + plain_number(ends[1] - ends[0]) + " at the lower end to " +
         plain_number(ends.back() - ends[ends.size() - 2]) + " at the upper end)";
}

void print_body(Block &block, const Scene &scene, const fem::Discretization &d)
{
  const UnitNames &units = scene.model.units;
  const mesh::Mesh &mesh = *d.mesh;
  const fem::BodyMeasure body = fem::body_measure(d);
  GO cells = 0;
  Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, GO(mesh.num_owned_cells), Teuchos::outArg(cells));
  std::string box;
  for (int c = 0; c < d.dim(); ++c)
    box += std::string(c > 0 ? ", " : "") + "xyz"[c] + " from " + plain_number(body.lower[c]) + " to " +
           plain_number(body.upper[c]) + (mesh.box ? grading_text(*mesh.box, c) : "");
  block.line("body", std::to_string(cells) + " cells of " + mesh.element.name() +
                         (d.dim() == 2 ? ", " + fem::name_of(d.kinematics) : "") + "; " + box + " " + units.length);
  const std::string name = d.per_length() ? "area" : "volume";
  block.line("body", name + " " + plain_number(body.volume) + " " + units.of(unit::volume, d.per_length()) +
                         (d.axisymmetric() ? " of the whole body of revolution" : ""));
  const fem::Materials &materials = scene.model.materials;
  for (const std::string &name_of_block : mesh.blocks) {
    const bool named = mesh.blocks.size() > 1 || materials.block.count(name_of_block) > 0;
    block.line("material", (named ? "block \"" + name_of_block + "\": " : "") +
                               material_text(materials.of(name_of_block), units.stress()));
  }
}

/// What the deck has of a side, in a few words.
std::string role(const Scene &scene, const std::string &side)
{
  std::vector<std::string> parts;
  for (const auto &condition : scene.model.dirichlet)
    if (condition.side == side) parts.push_back("held: " + prescribed_text(condition));
  for (const auto &load : scene.model.tractions)
    if (load.side == side) parts.push_back("loaded");
  for (const auto &contact : scene.model.contact)
    if (contact.side == side) parts.push_back("contact");
  return parts.empty() ? "free" : joined_by(parts, "; ");
}

void print_sides(Block &block, const Scene &scene, const fem::Discretization &d)
{
  const std::string unit = scene.model.units.of(unit::extent, d.per_length());
  for (const mesh::Side &side : d.mesh->sides) {
    const fem::SideMeasure measure = fem::side_measure(d, side);
    const double length_of_normal = length(measure.normal);
    const std::string bent = length_of_normal < 1e-3 ? ", normals in all directions"
                                                     : ", normal " + components(measure.normal, d.dim(), 1) +
                                                           (length_of_normal < 1 - 1e-6 ? " in the mean" : "");
    block.line("sides", "\"" + side.name + "\": " + (d.per_length() ? "length " : "area ") +
                            plain_number(measure.area) + " " + unit + bent + "; " + role(scene, side.name));
  }
  for (const auto &condition : scene.model.dirichlet) {
    const auto &points = d.mesh->points;
    if (std::any_of(points.begin(), points.end(), [&](const auto &each) { return each.name == condition.side; }))
      block.line("points", "\"" + condition.side + "\": held: " + prescribed_text(condition));
  }
}

/// The times at which loads are told: the first and the last.
std::vector<double> told_times(const Scene &scene)
{
  if (!scene.has_steps()) return {scene.time};
  const auto &times = scene.steps.times;
  if (times.size() == 1) return {times.front()};
  return {times.front(), times.back()};
}

void print_loads(Block &block, const Scene &scene, const fem::Discretization &d)
{
  const std::string unit = scene.model.units.of(unit::force, d.per_length());
  const auto text = [&](const Point &force) { return components(force, d.dim(), length(force)) + " " + unit; };
  const auto changes = [](const fem::VectorField &field) {
    return std::any_of(field.begin(), field.end(), [](const ScalarField &each) { return !each.is_constant(); });
  };
  const auto tell = [&](const std::string &name, const bool varies, const auto &resultant_at) {
    std::vector<std::string> parts;
    for (const double t : told_times(scene)) {
      const std::string at = scene.has_steps() && varies ? " at t = " + plain_number(t) : "";
      parts.push_back(text(resultant_at(scene.model.seen_at(t))) + at);
      if (at.empty()) break; // the same at all times
    }
    block.line("loads", name + ": in all " + joined_by(parts, ", "));
  };
  for (std::size_t k = 0; k < scene.model.tractions.size(); ++k) {
    const auto &load = scene.model.tractions[k];
    tell("\"" + load.side + "\"", changes(load.traction) || changes(load.force),
         [&](const analysis::Model &model) { return fem::resultant(d, model.tractions[k]); });
  }
  const auto &force = scene.model.body_force;
  if (std::any_of(force.begin(), force.end(), [](const ScalarField &each) { return !each.is_zero(); }))
    tell("body force", changes(force),
         [&](const analysis::Model &model) { return fem::resultant(d, model.body_force); });
  else if (scene.model.tractions.empty()) {
    const auto &held = scene.model.dirichlet;
    const auto &sides = scene.model.contact;
    std::vector<std::string> others{"what \"Dirichlet\" prescribes"};
    if (std::any_of(held.begin(), held.end(), [](const auto &each) { return each.rigid.has_value(); }))
      others = {"what \"Dirichlet\" and \"Rigid\" give"};
    const auto any = [&](const auto &test) { return std::any_of(sides.begin(), sides.end(), test); };
    if (any([](const auto &side) {
          return side.obstacle.force[0] || side.obstacle.force[1] || side.obstacle.force[2];
        }))
      others.emplace_back("the force on the obstacle");
    else if (any([](const auto &side) { return side.obstacle.has_springs(); }))
      others.emplace_back("the spring of the obstacle");
    block.line("loads", "none but " + joined_by(others, " and "));
  }
}

std::string law_text(const contact::ContactOptions &side, const UnitNames &units)
{
  const auto law = [&](const std::string &name) -> const ScalarField & { // of the deck
    const auto found = std::find_if(contact::law_parameters.begin(), contact::law_parameters.end(),
                                    [&](const contact::LawParameter &each) { return each.name == name; });
    return side.*found->field;
  };
  const std::string stress = " " + units.stress(), per_length = stress + "/" + units.length;
  const bool yields = !is_infinite_number(law("Yield Stress")), springs = !is_infinite_number(law("Stiffness"));
  std::string text = springs ? "springs of " + field_words(law("Stiffness")) + per_length : "rigid";
  if (yields) text += " until it yields at " + field_words(law("Yield Stress")) + stress;
  if (!law("Hardening").is_zero()) text += ", harder by " + field_words(law("Hardening")) + per_length + " of dent";
  std::vector<std::string> friction;
  if (!law("Friction Coefficient").is_zero())
    friction.push_back("coefficient " + field_words(law("Friction Coefficient")));
  if (!law("Friction Bound").is_zero()) friction.push_back("bound " + field_words(law("Friction Bound")) + stress);
  text += friction.empty() ? "; no friction" : "; friction: " + joined_by(friction, ", ");
  if (!side.obstacle.exists())
    text += side.gap.is_zero() ? "; gap 0: it has the shape of the side"
                               : "; gap " + field_words(side.gap) + " " + units.length;
  return text;
}

void print_foundations(Block &block, const Scene &scene)
{
  for (const auto &side : scene.model.contact) {
    const std::string unit = scene.model.units.length;
    const auto &surface = side.obstacle.surface;
    const std::string detail = surface && surface->detail ? ", " + surface->detail->told(unit) : "";
    std::string moves;
    for (int c = 0; c < 3; ++c)
      if (side.obstacle.force[c])
        moves += std::string(", moved by Force ") + component_names[c] + " = " + field_words(*side.obstacle.force[c]);
    for (int c = 0; c < 3; ++c)
      if (side.obstacle.stiffness[c] > 0)
        moves += std::string(", on a spring along ") + component_names[c] + " of " +
                 plain_number(side.obstacle.stiffness[c]) + " " + scene.model.units.force + "/" +
                 scene.model.units.length;
    if (moves.empty() && side.obstacle.moves()) moves = ", which moves";
    const std::string obstacle =
        side.obstacle.exists() ? "; the gap follows from the obstacle" + moves + detail : std::string();
    block.line("foundation", "\"" + side.name_in_results() + "\": " + law_text(side, scene.model.units) + obstacle);
  }
  if (scene.model.contact.empty()) block.line("foundation", "none: nothing touches");
}

void print_steps(Block &block, const Scene &scene)
{
  if (!scene.has_steps()) {
    block.line("steps", "one, t = " + plain_number(scene.time));
    return;
  }
  const auto &times = scene.steps.times;
  block.line("steps", std::to_string(times.size()) + ", t = " + plain_number(times.front()) +
                          (times.size() > 1 ? " to " + plain_number(times.back()) : ""));
}

/// What an unknown took of time on one core and of memory, in whole runs of decks that come with rpc: beam, block, hertz, and templates
/// hertz-3d, own-mesh, springs of 87 000 to 300 000 unknowns (a core of an AMD EPYC).
struct Cost {
  double microseconds, kilobytes;
};

Cost measured_cost(const Scene &scene, const fem::Discretization &d)
{
  const bool box = std::holds_alternative<mesh::BoxOptions>(scene.mesh), space = d.dim() == 3;
  if (!box) return space ? Cost{28, 2.2} : Cost{17, 1};
  if (d.mesh->element.order == 2) return {10, 1.2};
  return {space ? 4. : 2., 0.3};
}

void print_size(Block &block, const Scene &scene, const fem::Discretization &d, const GO contact_points)
{
  const double dofs = static_cast<double>(d.owned_dofs->getGlobalNumElements());
  const std::string of_first = scene.adapt.adapts() ? " on the first mesh" : "";
  block.line("unknowns", plain_number(dofs) + of_first + ", " + std::to_string(contact_points) + " contact points");
  if (scene.adapt.adapts()) {
    block.line("unknowns", "then meshes are refined until the relative error is below " +
                               plain_number(scene.adapt.target) + ", to at most " +
                               std::to_string(scene.adapt.max_dofs) + " unknowns");
    return;
  }
  const Cost cost = measured_cost(scene, d);
  const double steps = std::max<double>(1, static_cast<double>(scene.steps.times.size()));
  const double seconds = 0.2 + 1e-6 * cost.microseconds * dofs * steps, gigabytes = 0.08 + 1e-6 * cost.kilobytes * dofs;
  const double rounded = seconds < 10 ? std::round(seconds) : 10 * std::round(seconds / 10);
  block.line("a run takes", (seconds < 1 ? "less than 1" : "about " + plain_number(rounded)) +
                                " s of one core and about " + plain_number(std::ceil(10 * gigabytes) / 10) +
                                " GB; thin and nearly incompressible bodies take several times as long");
}

} // namespace

void print_understood(std::ostream &out, const Scene &scene, const analysis::Problem &problem,
                      const analysis::Step &step)
{
  const fem::Discretization &d = problem.discretization();
  Block block(out);
  print_body(block, scene, d);
  print_sides(block, scene, d);
  print_loads(block, scene, d);
  print_foundations(block, scene);
  print_steps(block, scene);
  print_size(block, scene, d, step.contact.num_total);
  out << std::flush;
}

} // namespace rpc
