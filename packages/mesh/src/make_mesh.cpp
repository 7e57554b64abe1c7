// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/make_mesh.hpp"

#include "division.hpp"
#include "gmsh_contents.hpp"
#include "mesh_formats.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"
#include "rpc/mesh/contracted.hpp"
#include "rpc/mesh/distribute.hpp"
#include "rpc/mesh/refinement.hpp"
#include "rpc/mesh/structured.hpp"
#include "whole_mesh.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>
#include <utility>

namespace rpc::mesh
{
namespace
{

void add_gmsh_parameters(Teuchos::ParameterList &valid)
{
  valid.set(
      "File", "",
      "gmsh: a geometry to be meshed (.geo, .step, .iges, .brep, .stl) or a mesh (.msh, .e, .exo, .g, .unv, .vtk, "
      ".vtu, .med, .inp), looked for in the deck's folder, then in the current one. Of gmsh's files physical surfaces "
      "become blocks, physical curves sides, by their names or numbers; with volumes in it, which makes a mesh in "
      "space, physical volumes and surfaces.");
  valid.set("Size Factor", 1., "gmsh: factor on all cell sizes that a geometry asks for, > 0.");
  valid.set("Size", 0., "gmsh: size of the cells of a STEP, IGES, BREP or STL file [m], > 0; 0: a tenth of the body.");
  valid.set(
      "Order", 0,
      "gmsh: order of the elements that a geometry is meshed with, 1 or 2 (curved); 0: 2 for a geometry, for a mesh "
      "what it has.");
  valid.set("Refinements", 0,
            "gmsh: how often each cell of gmsh's mesh is halved in all directions, >= 0. The meshes on the way are "
            "those of multigrid and nested iteration.");
  Teuchos::ParameterList side;
  side.set("Surfaces", Teuchos::Array<int>(),
           "Numbers of surfaces of a geometry, in the plane of curves; `rpc --mesh-info=FILE` lists them.");
  side.set("Near", Teuchos::Array<double>(), "A point [m]: the surface of a geometry that is nearest to it.");
  side.set("Plane", "", "`x = 1`, `y = 0` or `z = -2.5` [m]: all facets of the boundary in that plane.");
  side.set("Box", Teuchos::Array<double>(),
           "Lower and upper corner [m]: all facets of the boundary within; 4 numbers, in space 6.");
  set_named_entries(valid, "Sides", side,
                    "gmsh: sides besides those that the file has, by number or place. Each has a name of your choice "
                    "and one of `Surfaces`, `Near`, `Plane`, `Box`.");
}

/// Whether a file looks like a result of rpc: an Exodus file with a summary or a table of the same name beside it.
bool looks_like_result(const std::filesystem::path &file)
{
  std::error_code ignored;
  const auto beside = [&](const char *const ending) {
    return std::filesystem::exists(file.parent_path() / (file.stem().string() + ending), ignored);
  };
  return file.extension() == ".e" && (beside(".json") || beside(".contact.csv") || beside(".history.csv"));
}

/// Names of files with a body in some folders, but for results of runs.
std::vector<std::string> mesh_files(const std::vector<std::string> &folders)
{
  std::vector<std::string> names;
  for (const std::string &place : folders) {
    std::error_code failed;
    for (std::filesystem::directory_iterator at(place.empty() ? "." : place, failed), end; !failed && at != end;
         at.increment(failed)) {
      const std::string name = at->path().filename().string();
      const bool known = format_of(name) != MeshFormat::unknown && !looks_like_result(at->path());
      if (known && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The file beside the deck, or in the current folder.
std::string found_file(const std::string &name, const std::string &folder)
{
  const auto beside_deck = std::filesystem::path(folder) / name;
  std::error_code ignored;
  if (std::filesystem::exists(beside_deck, ignored)) return beside_deck.string();
  if (std::filesystem::exists(name, ignored)) return name;
  const std::filesystem::path own_folder = std::filesystem::path(name).parent_path();
  std::vector<std::string> folders = {own_folder.string()};
  std::string where;
  if (std::filesystem::path(name).is_relative()) {
    folders = {(std::filesystem::path(folder) / own_folder).string(), own_folder.string()};
    where = std::string(" in ") + (folder.empty() ? "" : "\"" + folder + "\" or in ") + "the current folder";
  }
  std::string text = "deck: \"Mesh->File\": there is no file \"" + name + "\"" + where + ".";
  bool has_folder = false;
  for (const std::string &each : folders) has_folder |= each.empty() || std::filesystem::is_directory(each, ignored);
  if (!has_folder) text += " There is no folder \"" + own_folder.string() + "\".";
  if (name.find('\\') != std::string::npos) {
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    static const std::regex drive(R"(([A-Za-z]):(/.*))");
    std::smatch part;
    text += " Write / for \\";
    if (std::regex_match(slashes, part, drive)) {
      text += ", and the drive as this system has it: below WSL /mnt/";
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(part[1].str()[0])));
      slashes = part[2];
    } else {
      text += ": ";
    }
    throw Error(ExitCode::bad_input, text + slashes);
  }
  const std::string meant = file_remedy(std::filesystem::path(name).filename().string(), mesh_files(folders));
  throw Error(ExitCode::bad_input,
              text + (meant.empty() ? " Write its path as seen from the deck, or in full." : meant));
}

/// Each makes four or eight times as many cells.
constexpr int most_refinements = 12;

/// "z = -2.5".
SidePlace::Plane plane_of(const std::string &where, const std::string &text)
{
  static const std::regex form(R"(\s*([xyzXYZ])\s*=\s*(\S+)\s*)");
  std::smatch part;
  double at = 0;
  bool good = std::regex_match(text, part, form);
  if (good) {
    std::istringstream number(part[2]);
    good = (number >> at) && number.peek() == std::char_traits<char>::eof() && std::isfinite(at);
  }
  RPC_REQUIRE(good, where << "->Plane\" must be an axis and a number, such as \"z = 0\", got \"" << text << "\"");
  return {std::tolower(static_cast<unsigned char>(part[1].str()[0])) - 'x', at};
}

std::vector<SidePlace> side_places(const Teuchos::ParameterList &list)
{
  std::vector<SidePlace> places;
  for (const std::string &name : names_of(list)) {
    const Teuchos::ParameterList &entry = list.sublist(name);
    const std::string where = "deck: \"Mesh->Sides->" + name;
    SidePlace place;
    place.name = name;
    place.surfaces = entry.get<Teuchos::Array<int>>("Surfaces").toVector();
    place.near = entry.get<Teuchos::Array<double>>("Near").toVector();
    place.box = entry.get<Teuchos::Array<double>>("Box").toVector();
    const auto &plane = entry.get<std::string>("Plane");
    if (!plane.empty()) place.plane = plane_of(where, plane);
    const int given = !place.surfaces.empty() + !place.near.empty() + !place.box.empty() + !plane.empty();
    RPC_REQUIRE(given == 1, where << "\" must have one of \"Surfaces\", \"Near\", \"Plane\" and \"Box\", got "
                                  << (given == 0 ? "none" : std::to_string(given)));
    RPC_REQUIRE(name.size() <= longest_name, where << "\" must have at most " << longest_name << " characters");
    places.push_back(place);
  }
  return places;
}

GmshOptions gmsh_options(const Teuchos::ParameterList &list, const std::string &folder, const Comm &comm)
{
  GmshOptions options;
  options.file = list.get<std::string>("File");
  options.size_factor = list.get<double>("Size Factor");
  options.order = list.get<int>("Order");
  options.size = list.get<double>("Size");
  options.sides = side_places(list.sublist("Sides"));
  RPC_REQUIRE(
      !options.file.empty(),
      "deck: \"Mesh->File\" must name a geometry or a mesh for a mesh of type gmsh, such as a .geo or .msh, got none");
  const MeshFormat format = format_of(options.file);
  RPC_REQUIRE(format != MeshFormat::unknown, "deck: \"Mesh->File\" must end in one of "
                                                 << join(known_endings()) << ", which tells the format, got \""
                                                 << options.file << "\". meshio converts many others: meshio convert \""
                                                 << options.file << "\" body.vtu");
  RPC_REQUIRE(options.size >= 0 && std::isfinite(options.size),
              "deck: \"Mesh->Size\" must be > 0 and finite, or 0 for the default, got " << options.size);
  RPC_REQUIRE(options.size == 0 || format == MeshFormat::shapes,
              "deck: \"Mesh->Size\" goes with a STEP, IGES, BREP or STL file, got \""
                  << options.file << "\"; "
                  << (format == MeshFormat::geo ? "a .geo has sizes of its own: \"Size Factor\" scales them"
                                                : "a mesh has its cells already"));
  RPC_REQUIRE(options.size_factor > 0 && std::isfinite(options.size_factor),
              "deck: \"Mesh->Size Factor\" must be > 0 and finite, got " << options.size_factor);
  RPC_REQUIRE(options.order >= 0 && options.order <= 2,
              "deck: \"Mesh->Order\" must be 1 or 2, or 0 for the default, got " << options.order);
  options.contents = std::make_shared<GmshContents>();
  options.refinements = list.get<int>("Refinements");
  RPC_REQUIRE(options.refinements >= 0 && options.refinements <= most_refinements,
              "deck: \"Mesh->Refinements\" must be 0 to " << most_refinements << ", got " << options.refinements);
  options.file = text_of_root(comm, ExitCode::bad_input, [&] { return found_file(options.file, folder); });
  return options;
}

/// By gmsh, as often as one likes.
bool can_be_meshed(const GmshOptions &options)
{
  return options.box || keeps_geometry(options.file);
}

std::shared_ptr<const Mesh> halved_in_all_directions(std::shared_ptr<const Mesh> mesh, const int times)
{
  for (int k = 0; k < times; ++k) mesh = std::make_shared<Mesh>(refined(mesh));
  return mesh;
}

/// A mesh of fewer cells than ranks, on as many as it has enough cells for. Collective.
std::shared_ptr<const Mesh> on_some_ranks(const MeshData &whole, const RCP<const Comm> &comm)
{
  Division division;
  on_root(*comm, ExitCode::internal_error, [&] {
    division = divide_by(whole, comm->getSize(), ranks_of_cells(whole, ranks_for(whole, comm->getSize())));
  });
  return std::make_shared<Mesh>(distribute(whole, comm, division));
}

/// What gmsh makes or a file has, dealt out.
std::shared_ptr<const Mesh> dealt(const GmshOptions &options, const RCP<const Comm> &comm)
{
  MeshData whole;
  on_root(*comm, ExitCode::bad_mesh, [&] { whole = read_gmsh(options); });
  const bool contracts = !can_be_meshed(options) && whole.element.shape == Shape::simplex;
  const bool is_root = comm->getRank() == 0;
  if (!options.needs_all_ranks && sum_all(*comm, GO(is_root && whole.num_cells() < comm->getSize() ? 1 : 0)) > 0)
    return on_some_ranks(whole, comm);
  return sum_all(*comm, GO(is_root && contracts ? 1 : 0)) > 0 ? distribute_with_contracted(std::move(whole), comm)
                                                              : distribute_with_parents(std::move(whole), comm);
}

/// A field of rank 0 on all ranks; collective.
SizeField on_all_ranks(const Comm &comm, const SizeField *const field)
{
  const bool here = comm.getRank() == 0;
  SizeField all;
  all.coords = gathered_by_all(comm, here ? field->coords : std::vector<double>{});
  all.simplices = gathered_by_all(comm, here ? field->simplices : std::vector<int>{});
  all.size = gathered_by_all(comm, here ? field->size : std::vector<double>{});
  all.dim = here ? field->dim : 0;
  Teuchos::broadcast(comm, 0, Teuchos::outArg(all.dim));
  return all;
}

/// The base, dealt out so that ranks have about as many of the cells that are to come, then refined.
Mesh make_nested(const GmshOptions &options, const RCP<const Comm> &comm)
{
  std::shared_ptr<const MeshData> base = options.base;
  if (sum_all(*comm, GO(base ? 1 : 0)) == 0) base = base_mesh(options, *comm);
  const SizeField sizes = on_all_ranks(*comm, options.sizes.get());
  std::vector<double> weights;
  on_root(*comm, ExitCode::bad_mesh, [&] {
    check_sizes("mesh: ", sizes);
    RPC_REQUIRE_CODE(base->element.shape == Shape::simplex && base->element.dim == sizes.dim, ExitCode::bad_mesh,
                     "mesh: sizes of cells in " << sizes.dim << "D do not fit a mesh of " << base->element.name()
                                                << " cells in " << base->element.dim << "D");
    if (comm->getSize() > 1) weights = cells_to_come(*base, sizes, options.refinements);
  });
  if (!base) base = std::make_shared<MeshData>(); // another rank
  auto mesh = std::make_shared<const Mesh>(distribute(*base, comm, weights));
  return *refined_to(halved_in_all_directions(std::move(mesh), options.refinements), sizes);
}

} // namespace

Teuchos::ParameterList valid_parameters()
{
  Teuchos::ParameterList valid("Mesh");
  set_words(valid, "Type", {"box", "gmsh"}, "Kind of mesh: `box`, or `gmsh` for a geometry or mesh file.");
  add_box_parameters(valid);
  add_gmsh_parameters(valid);
  return valid;
}

MeshOptions mesh_options(const Teuchos::ParameterList &list, const std::string &folder, const Comm &comm)
{
  const auto &type = list.get<std::string>("Type");
  RPC_REQUIRE(type == "box" || type == "gmsh", "deck: \"Mesh->Type\" must be one of box, gmsh, got \"" << type << "\"");
  const bool box = type == "box";
  const Teuchos::ParameterList others = [&] {
    Teuchos::ParameterList valid;
    if (box)
      add_gmsh_parameters(valid);
    else
      add_box_parameters(valid);
    return valid;
  }();
  for (auto it = others.begin(); it != others.end(); ++it)
    RPC_REQUIRE(list.getEntry(others.name(it)).isDefault(),
                "deck: \"Mesh->" << others.name(it) << "\" does not go with \"Mesh->Type\" = " << type
                                 << (box ? ": with a file of gmsh write \"Mesh->Type\" = gmsh"
                                         : ": the file gives it. Remove it, or write \"Mesh->Type\" = box"));
  if (box) return box_options(list);
  return gmsh_options(list, folder, comm);
}

int dimension(const MeshOptions &options, const Comm &comm)
{
  if (const auto *box = std::get_if<BoxOptions>(&options)) return box->element.dim;
  return std::stoi(text_of_root(comm, ExitCode::bad_mesh,
                                [&] { return std::to_string(gmsh_dimension(std::get<GmshOptions>(options))); }));
}

std::optional<MeshOptions> coarser(const MeshOptions &options, const double factor)
{
  RPC_REQUIRE(factor >= 1 && std::isfinite(factor),
              "mesh: the factor on the size of cells must be >= 1 and finite for a coarser mesh, got " << factor);
  MeshOptions result = options;
  if (auto *const box = std::get_if<BoxOptions>(&result)) {
    for (std::size_t d = 0; d < box->cells.size(); ++d)
      box->cells[d] = std::max(box->periodic[d] ? 2 : 1, static_cast<int>(std::lround(box->cells[d] / factor)));
    grade(*box);
    return result;
  }
  auto &gmsh = std::get<GmshOptions>(result);
  if (!can_be_meshed(gmsh) || gmsh.refinements > 0 || gmsh.nested) return std::nullopt;
  gmsh.size_factor *= factor;
  gmsh.straight_where_bent = true;
  gmsh.needs_all_ranks = false;
  return result;
}

std::optional<MeshOptions> with_sizes(const MeshOptions &options, std::shared_ptr<const SizeField> sizes,
                                      const int refinements)
{
  GmshOptions result;
  if (const auto *const box = std::get_if<BoxOptions>(&options)) {
    result.box = *box;
    if (box->element.dim == 3) result.box->element.shape = Shape::simplex;
  } else {
    result = std::get<GmshOptions>(options);
    if (!can_be_meshed(result)) return std::nullopt;
  }
  result.size_factor = std::ldexp(1., refinements);
  result.refinements = refinements;
  result.sizes = std::move(sizes);
  return result;
}

MeshOptions refined_to_sizes(const MeshOptions &options, std::shared_ptr<const SizeField> sizes)
{
  GmshOptions result;
  if (const auto *const box = std::get_if<BoxOptions>(&options)) {
    result.box = *box;
    result.box->element.shape = Shape::simplex;
  } else {
    result = std::get<GmshOptions>(options);
  }
  result.nested = true;
  result.sizes = std::move(sizes);
  return result;
}

std::shared_ptr<const MeshData> base_mesh(const MeshOptions &options, const Comm &comm)
{
  std::shared_ptr<const MeshData> base;
  on_root(comm, ExitCode::bad_mesh, [&] {
    const auto gmsh = std::get<GmshOptions>(refined_to_sizes(options, nullptr));
    base = std::make_shared<MeshData>(gmsh.box ? whole_mesh(make_box(*gmsh.box, rcp(new Teuchos::SerialComm<int>)))
                                               : read_gmsh(gmsh));
  });
  return base;
}

Mesh make_mesh(const MeshOptions &options, const RCP<const Comm> &comm)
{
  if (const auto *box = std::get_if<BoxOptions>(&options)) return make_box(*box, comm);
  const auto &gmsh = std::get<GmshOptions>(options);
  if (gmsh.nested) return make_nested(gmsh, comm);
  const bool by_sizes = sum_all(*comm, GO(gmsh.sizes ? 1 : 0)) > 0; // which rank 0 alone need have
  const auto mesh = dealt(gmsh, comm);
  if (!by_sizes) return *halved_in_all_directions(mesh, gmsh.refinements);
  try {
    return *halved_in_all_directions(mesh, gmsh.refinements);
  } catch (const Error &error) { // on all ranks: cells too large for a curved boundary
    if (error.code() != ExitCode::bad_mesh) throw;
  }
  GmshOptions fine = gmsh;
  fine.size_factor = std::ldexp(gmsh.size_factor, -gmsh.refinements);
  fine.refinements = 0;
  return *dealt(fine, comm);
}

} // namespace rpc::mesh
