// SPDX-License-Identifier: BSD-3-Clause
#include "host_program.hpp"

#include "command_line.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/io/deck.hpp"
#include "rpc/mesh/box_grid.hpp"
#include "rpc/solver/rules.hpp"
#include "rules.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <exception>
#include <optional>
#include <sched.h>
#include <string>
#include <thread>
#include <unistd.h>
#include <variant>
#include <vector>

namespace rpc
{
namespace
{

constexpr const char *program_variable = "RPC_HOST_PROGRAM", *report_variable = "RPC_HAND_OVER_REPORT";

/// A function of OpenMP's, where a library has brought OpenMP into this process; else null.
template <typename Function>
Function *openmp(const char *const name)
{
  return reinterpret_cast<Function *>(dlsym(RTLD_DEFAULT, name));
}

int threads_of_host()
{
  const auto threads = openmp<int()>("omp_get_max_threads");
  return threads ? threads() : static_cast<int>(std::thread::hardware_concurrency());
}

/// Where the environment asks for places (OMP_PROC_BIND), OpenMP has bound this thread to the first of them as it was loaded. The next
/// program is to find them all.
void leave_place()
{
  const auto places = openmp<int()>("omp_get_num_places");
  const auto size = openmp<int(int)>("omp_get_place_num_procs");
  const auto list = openmp<void(int, int *)>("omp_get_place_proc_ids");
  if (!places || !size || !list) return;
  cpu_set_t all;
  CPU_ZERO(&all);
  for (int place = 0; place < places(); ++place) {
    std::vector<int> ids(size(place));
    list(place, ids.data());
    for (const int id : ids) CPU_SET(id, &all);
  }
  if (CPU_COUNT(&all) > 0) sched_setaffinity(0, sizeof all, &all);
}

/// The deck that a command line asks to solve; none where it asks for other things.
std::optional<Teuchos::ParameterList> deck_of(const int argc, char *argv[])
{
  const Arguments arguments = split_arguments(argc, argv);
  const CommandLine line = parse_command_line(arguments.own);
  if (arguments.kokkos.size() > 1 || !line.solves() || line.input.empty()) return {};
  return read_parameters(io::find_deck(line.input, Teuchos::SerialComm<int>()), line.assignments);
}

/// As far as a deck tells before there is a mesh: of any order, and in plane stress too.
bool may_be_nearly_incompressible(const fem::Materials &materials)
{
  const auto is = [](const fem::Material &material) {
    return material.poissons_ratio > analysis::linear_rules.mixed_above;
  };
  return is(materials.common) || std::any_of(materials.block.begin(), materials.block.end(),
                                             [&is](const auto &block) { return is(block.second); });
}

} // namespace

std::string host_program()
{
  const char *const given = std::getenv(program_variable);
  return given ? given : RPC_HOST_PROGRAM;
}

GO foreseen_unknowns(const Teuchos::ParameterList &deck)
{
  if (deck.sublist("Mesh").get<std::string>("Type") != "box") return -1;
  const auto box = std::get<mesh::BoxOptions>(mesh::mesh_options(deck.sublist("Mesh"), "", Teuchos::SerialComm<int>()));
  const GO unknowns = box.element.dim * mesh::Grid(box, 1).num_nodes_total();
  const adapt::AdaptOptions adapt = adapt::adapt_options(deck.sublist("Adapt"));
  return adapt.adapts() ? std::max<GO>(unknowns, adapt.max_dofs) : unknowns;
}

GO most_unknowns_of_host(const int threads, const bool nearly_incompressible)
{
  const HandOverRules &rules = hand_over_rules;
  const double unknowns = rules.of_one_thread *
                          std::pow(std::clamp<double>(threads, 1, rules.most_threads), double(solver::cost_model.gain));
  return static_cast<GO>(nearly_incompressible ? unknowns / rules.work : unknowns);
}

void hand_over_small_scene(const int argc, char *argv[])
{
  const std::string program = host_program();
  if (program.empty()) return;
  try {
    const std::optional<Teuchos::ParameterList> deck = deck_of(argc, argv);
    if (!deck) return;
    const bool nearly_incompressible = may_be_nearly_incompressible(fem::material_options(deck->sublist("Material")));
    const GO unknowns = foreseen_unknowns(*deck);
    const GO most = most_unknowns_of_host(threads_of_host(), nearly_incompressible);
    if (unknowns < 0 || unknowns > most) return;
    const std::string reason = std::to_string(unknowns) + " unknowns, at most " + std::to_string(most);
    setenv(report_variable, ("taken over from " + std::string(argv[0]) + ": " + reason).c_str(), 1);
  } catch (const std::exception &) {
    return;
  }
  setenv(program_variable, "", 1); // the next one keeps what it gets
  leave_place();
  execvp(program.c_str(), argv);
  const std::string reason = std::strerror(errno);
  setenv(report_variable, ("cannot start RPC_HOST_PROGRAM = \"" + program + "\": " + reason).c_str(), 1);
}

std::string hand_over_report()
{
  const char *const report = std::getenv(report_variable);
  return report ? report : "";
}

} // namespace rpc
