// SPDX-License-Identifier: BSD-3-Clause
#include "checkpoint.hpp"
#include "command_line.hpp"
#include "gpu.hpp"
#include "host_program.hpp"
#include "make_surface.hpp"
#include "mesh_info.hpp"
#include "new_deck.hpp"
#include "notes.hpp"
#include "output/paths.hpp"
#include "output/results.hpp"
#include "report.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/message.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/schema.hpp"
#include "rpc/io/atomic_file.hpp"
#include "rpc/io/deck.hpp"
#include "rpc/io/run_lock.hpp"
#include "scene.hpp"
#include "solve.hpp"

#include <Teuchos_StackedTimer.hpp>
#include <Teuchos_Time.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <malloc.h>
#include <memory>

#ifdef HAVE_TPETRACORE_MPI
#include <mpi.h>
#endif

namespace
{

using rpc::ExitCode;

/// Keeps freed memory with the process. By default glibc hands each big vector back to the kernel, and MueLu and Belos
/// make new ones in every cycle: the page faults cost a second rank all that it gains.
void keep_freed_memory()
{
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 2000 << 20);
  mallopt(M_TOP_PAD, 256 << 20);
#endif
}

/// Whether a launcher, such as mpirun, has started this process: there may be more ranks.
bool is_launched()
{
  constexpr std::array marks{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"};
  return std::any_of(marks.begin(), marks.end(), [](const char *const mark) { return std::getenv(mark) != nullptr; });
}

/// One process without mpirun has no partners: Open MPI need not start a daemon for it and look for network cards, which
/// takes Open MPI 4 0.35 s, and 6 1.1 s; nor make a folder, which processes without a daemon would share and remove under each
/// other. The user's own settings win; other MPIs know nothing of these.
void start_mpi_alone()
{
  setenv("OMPI_MCA_btl", "self", 0);
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

/// Ranks of one host that copy straight from each other's memory do not see what of managed memory is on a GPU.
void keep_mpi_from_managed_memory()
{
#ifdef KOKKOS_ENABLE_CUDA
  setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0); // Open MPI's; the user's own setting wins
#endif
}

/// MPI, where there is one, for several threads: a factor is made on one of its own while this one looks for signals.
class MpiSession
{
public:
#ifdef HAVE_TPETRACORE_MPI
  MpiSession(int *const argc, char ***const argv)
  {
    int level = 0;
    MPI_Init_thread(argc, argv, MPI_THREAD_MULTIPLE, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &num_ranks_);
  }
  ~MpiSession()
  {
    MPI_Finalize();
  }
  void abort() const
  {
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
#else
  MpiSession(int *, char ***) {}
  void abort() const {}
#endif
  MpiSession(const MpiSession &) = delete;
  MpiSession &operator=(const MpiSession &) = delete;

  int rank() const
  {
    return rank_;
  }
  int num_ranks() const
  {
    return num_ranks_;
  }

private:
  int rank_ = 0, num_ranks_ = 1;
};

/// The process' exit status. Work that an interrupt has left behind must find all that it uses, and its MPI, to the end.
int leave(const ExitCode code)
{
  if (rpc::work_goes_on()) {
    std::cout.flush();
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(code));
  }
  return static_cast<int>(code);
}

ExitCode run_deck(const rpc::CommandLine &line, const std::string &deck, const rpc::RCP<const rpc::Comm> &comm,
                  std::ostream &out)
{
  const double start = Teuchos::Time::wallTime();
  rpc::Scene scene = rpc::read_scene(deck, line.assignments, *comm);
  scene.output.verbose = line.verbose;
  RPC_REQUIRE(!line.restarts || scene.has_steps(),
              "command line: --restart goes with load steps; the deck has none, see \"Steps->Times\"");
  rpc::Checkpoints checkpoints(scene, line.restarts, line.restart, line.output);
  if (line.check) {
    rpc::require_place_for_results(scene, line.output, *comm);
    const std::string found = rpc::check(scene, comm, out, checkpoints);
    out << deck << ": " << found << '\n';
    return ExitCode::converged;
  }
  rpc::require_writable_results(scene, line.output, *comm);
  std::unique_ptr<rpc::io::RunLock> lock; // rank 0 only
  rpc::on_root(*comm, ExitCode::bad_input, [&] {
    lock = std::make_unique<rpc::io::RunLock>(line.output, scene.name);
    if (lock->held())
      rpc::io::remove_abandoned(line.output, [&](const std::string &file) { return rpc::is_result(scene, file); });
  });

  if (const std::string report = rpc::hand_over_report(); !report.empty()) out << "host: " << report << '\n';
  if (const std::string gpus = rpc::gpu_report(*comm); !gpus.empty()) out << "GPU: " << gpus << '\n';
  const auto timers = Teuchos::rcp(new Teuchos::StackedTimer("rpc"));
  if (scene.output.timers) Teuchos::TimeMonitor::setStackedTimer(timers);
  int cycle = 0;
  rpc::StepFiles steps;
  const auto keep = [&](const rpc::Scene &of, rpc::Solution &solution) {
    rpc::Scene named = of;
    named.name = rpc::cycle_name(of, ++cycle);
    rpc::StepFiles of_mesh;
    if (scene.adapt.write_all) rpc::write_results(named, solution, line.output, start, of_mesh);
  };
  const auto keep_step = [&](const rpc::Scene &of, const rpc::analysis::Solution &solution) {
    steps.add(of, solution, line.output);
  };
  rpc::Solution solution = rpc::solve(scene, comm, out, keep, keep_step, &checkpoints);
  const std::vector<std::string> notes = rpc::notes_on_results(scene, solution);
  solution.notes.insert(solution.notes.end(), notes.begin(), notes.end());
  std::vector<std::string> files;
  try {
    files = rpc::write_results(scene, solution, line.output, start, steps);
  } catch (const rpc::Error &) { // after a failure, such as a full disk, that is what the user must hear of
    if (!solution.failure) throw;
  }
  if (!steps.film.note().empty()) out << "note: " << steps.film.note() << '\n';
  rpc::print_summary(out, scene, solution, notes, files);
  if (scene.output.timers) {
    timers->stopBaseTimer();
    Teuchos::StackedTimer::OutputOptions options;
    options.output_fraction = options.output_minmax = true;
    timers->report(out, comm, options);
  }
  if (solution.failure && solution.failure->code != ExitCode::not_converged) throw rpc::failure_of(solution);
  return rpc::adapt::succeeded(solution) ? ExitCode::converged : ExitCode::not_converged;
}

ExitCode run(const rpc::CommandLine &line, const rpc::RCP<const rpc::Comm> &comm, std::ostream &out)
{
  if (line.help) {
    out << rpc::help_text();
    return ExitCode::converged;
  }
  if (line.version) {
    out << "rpc " RPC_VERSION " (Kokkos " << rpc::ExecutionSpace::name() << ")\n";
    return ExitCode::converged;
  }
  if (line.print_parameters) {
    rpc::print_parameters(out, rpc::valid_deck());
    return ExitCode::converged;
  }
  if (line.prints_schema) {
    out << (line.schema == "json" ? rpc::json_schema(rpc::valid_deck()) : rpc::relax_ng_schema(rpc::valid_deck()));
    return ExitCode::converged;
  }
  if (line.writes_template) {
    rpc::on_root(*comm, ExitCode::bad_input, [&] { out << rpc::new_deck(line.new_deck, line.output); });
    return ExitCode::converged;
  }
  if (!line.surface.empty()) {
    rpc::on_root(*comm, ExitCode::bad_input, [&] { out << rpc::make_surface(line.surface, line.assignments); });
    return ExitCode::converged;
  }
  if (!line.mesh.empty()) {
    rpc::on_root(*comm, ExitCode::bad_mesh, [&] { out << rpc::mesh_info(line.mesh, line.output); });
    return ExitCode::converged;
  }
  RPC_REQUIRE(!line.input.empty(),
              "command line: --input=DECK is missing. See rpc --help; rpc --new lists decks to start from.");
  const std::string deck = rpc::io::find_deck(line.input, *comm);
  try {
    return run_deck(line, deck, comm, out);
  } catch (const rpc::Error &error) { // on all ranks; one of them prints it
    if (comm->getRank() != 0) throw;
    throw rpc::Error(error.code(), rpc::io::with_place(error.what(), deck, line.assignments));
  }
}

/// In one piece, or the launcher's lines and other ranks' could come between; without memory of its own, which may have run out.
void say_error(const char *kind, const char *what)
{
  std::fprintf(stderr, "rpc: %s: %s\n", kind, what);
}

} // namespace

int main(int argc, char *argv[])
{
  keep_freed_memory();
  if (!is_launched()) {
    rpc::hand_over_small_scene(argc, argv);
    start_mpi_alone();
  }
  keep_mpi_from_managed_memory();
  rpc::install_interrupt_handlers();
  std::signal(SIGXFSZ, SIG_IGN); // a file beyond the shell's limit is a write that fails, not the end
  const MpiSession mpi(&argc, &argv);
  const bool root = mpi.rank() == 0;
  std::ostream out(root ? std::cout.rdbuf() : nullptr);
  const auto stop = [&mpi](const char *what) { // maybe on this rank alone: nobody must wait for it
    say_error("internal error", what);
    if (mpi.num_ranks() > 1) mpi.abort();
    return leave(ExitCode::internal_error);
  };
  try {
    const rpc::Arguments arguments = rpc::split_arguments(argc, argv);
    const rpc::CommandLine line = rpc::parse_command_line(arguments.own);
    std::unique_ptr<Tpetra::ScopeGuard> kokkos;
    if (line.solves() || arguments.kokkos.size() > 1) kokkos = rpc::start_kokkos(arguments.kokkos, root);
    if (arguments.kokkos_help) return 0;
    const auto comm = Tpetra::getDefaultComm();
    const ExitCode code = run(line, comm, out);
    rpc::on_root(*comm, ExitCode::internal_error, [] {
      RPC_REQUIRE_CODE(std::fflush(stdout) == 0 && !std::ferror(stdout), ExitCode::internal_error,
                       "output: cannot write to standard output");
    });
    return leave(code);
  } catch (const rpc::Error &error) { // on all ranks
    if (root) say_error("error", rpc::for_terminal(error.what()).c_str());
    return leave(error.code());
  } catch (const std::exception &error) {
    return stop(rpc::is_out_of_memory(error) ? "out of memory; more ranks on more machines, or fewer cells, help"
                                             : rpc::for_terminal(rpc::one_line(error.what())).c_str());
  } catch (const char *message) { // NOX throws these
    return stop(message);
  }
}
