// SPDX-License-Identifier: BSD-3-Clause
// Preloaded: all ranks make the same collective calls. Before each collective call of MPI the ranks of its communicator compare the function,
// the root, the sizes that have to agree and where the program calls it. Where ranks differ, each prints its call stack, and the run
// ends with the exit code 97 instead of a wait for ever. A run in which no such comparison comes to its end for RPC_COLLECTIVES_WAIT seconds
// (300) prints where each rank waits, and ends with 98; 0: it waits. RPC_COLLECTIVES_COUNT=FILE: rank 0 appends how many calls were compared.
//
// A call stack is that of the program alone, without its libraries: those may call from different places on different ranks.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>
#include <mpi.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <unwind.h>

enum { most_frames = 128, differs = 97, waits_for_ever = 98 };

static uintptr_t program_first, program_last, program_base; // where the program's code lies
static int shadow_key = MPI_KEYVAL_INVALID;                 // of a communicator: its own for comparisons
static volatile double last_compared;                       // [s]
static volatile long compared;
static double longest_wait; // [s]
static int this_rank;
static pthread_t main_thread;
static void *thrown_at[most_frames]; // the call stack of the last exception
static volatile int thrown;          // its size

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int find_program(struct dl_phdr_info *const info, const size_t size, void *const data)
{
  (void)size, (void)data;
  program_base = info->dlpi_addr;
  for (int k = 0; k < info->dlpi_phnum; ++k) {
    if (info->dlpi_phdr[k].p_type != PT_LOAD || !(info->dlpi_phdr[k].p_flags & PF_X)) continue;
    program_first = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr;
    program_last = program_first + info->dlpi_phdr[k].p_memsz;
  }
  return 1; // the first is the program
}

static int is_program(const void *const frame)
{
  return (uintptr_t)frame >= program_first && (uintptr_t)frame < program_last;
}

static const void *own_base(void)
{
  Dl_info info;
  return dladdr(&thrown_at, &info) ? info.dli_fbase : NULL;
}

/// Cuts the arguments off a function's name: " at file:line" follows.
static void shorten(char *const name)
{
  char *const place = strstr(name, " at ");
  for (char *c = name; *c; ++c)
    if (*c == '(' && strncmp(c, "(anonymous", 10) != 0 && strncmp(c, "()", 2) != 0) {
      memmove(c, place ? place : "", place ? strlen(place) + 1 : 1);
      return;
    }
}

/// One line for each of the program's frames, with the names of functions where addr2line is at hand, and for each of its libraries'.
static void print_frames(const char *const title, void *const *const frames, const int count)
{
  static char text[65536], command[16384], program[4096];
  size_t used = snprintf(text, sizeof text, "collectives: rank %d: %s\n", this_rank, title);
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length > 0 ? length : 0] = 0;
  size_t asked = snprintf(command, sizeof command, "LD_PRELOAD= addr2line -Cfpse '%s'", program);
  for (int k = 0; k < count && asked < sizeof command - 64; ++k)
    if (is_program(frames[k]))
      asked += snprintf(command + asked, sizeof command - asked, " %lx",
                        (unsigned long)((uintptr_t)frames[k] - program_base - 1));
  snprintf(command + asked, sizeof command - asked, " 2>/dev/null");
  FILE *const names = popen(command, "r");
  char name[4096];
  for (int k = 0; k < count && used < sizeof text - 1024; ++k) {
    if (is_program(frames[k])) {
      if (!names || !fgets(name, sizeof name, names)) name[0] = 0;
      name[strcspn(name, "\n")] = 0;
      shorten(name);
      used += snprintf(text + used, sizeof text - used, "  +0x%lx %.400s\n",
                       (unsigned long)((uintptr_t)frames[k] - program_base), name);
      continue;
    }
    Dl_info info;
    if (!dladdr(frames[k], &info) || !info.dli_fname || info.dli_fbase == own_base()) continue;
    const char *const slash = strrchr(info.dli_fname, '/');
    used += snprintf(text + used, sizeof text - used, "    %.80s(+0x%lx) %.120s\n", slash ? slash + 1 : info.dli_fname,
                     (unsigned long)((uintptr_t)frames[k] - (uintptr_t)info.dli_fbase),
                     info.dli_sname ? info.dli_sname : "");
  }
  if (names) pclose(names);
  fwrite(text, 1, used, stderr);
  fflush(stderr);
}

/// Where this rank is, and where it has thrown last: a rank that throws alone differs only where it has been caught.
static void print_stack(const char *const title)
{
  void *frames[most_frames];
  print_frames(title, frames, backtrace(frames, most_frames));
  if (thrown > 0) print_frames("has thrown its last exception here", thrown_at, thrown);
}

static void print_where(const int signal)
{
  (void)signal;
  print_stack("waits here");
}

/// Looks every second whether the ranks still meet.
static void *watch(void *const data)
{
  (void)data;
  for (;;) {
    sleep(1);
    if (now() - last_compared < longest_wait) continue;
    pthread_kill(main_thread, SIGUSR2);
    sleep(2); // the other ranks print theirs
    PMPI_Abort(MPI_COMM_WORLD, waits_for_ever);
  }
  return NULL;
}

static int free_shadow(const MPI_Comm comm, const int key, void *const value, void *const extra)
{
  (void)comm, (void)key, (void)extra;
  MPI_Comm shadow = PMPI_Comm_f2c((MPI_Fint)(intptr_t)value);
  return PMPI_Comm_free(&shadow);
}

static void start(void)
{
  void *frame;
  backtrace(&frame, 1); // loads what it needs
  dl_iterate_phdr(find_program, NULL);
  PMPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, free_shadow, &shadow_key, NULL);
  PMPI_Comm_rank(MPI_COMM_WORLD, &this_rank);
  const char *const wait = getenv("RPC_COLLECTIVES_WAIT");
  longest_wait = wait ? atof(wait) : 300;
  last_compared = now();
  main_thread = pthread_self();
  int ranks;
  PMPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (longest_wait <= 0 || ranks == 1) return;
  struct sigaction action = {0};
  action.sa_handler = print_where;
  action.sa_flags = SA_RESTART;
  sigaction(SIGUSR2, &action, NULL);
  pthread_t watcher;
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before); // the program's signals are for its own threads
  pthread_create(&watcher, NULL, watch, NULL);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  pthread_detach(watcher);
}

/// A communicator like comm; the ranks of comm make it at their first collective call.
static MPI_Comm shadow_of(const MPI_Comm comm)
{
  void *value;
  int found;
  PMPI_Comm_get_attr(comm, shadow_key, &value, &found);
  if (found) return PMPI_Comm_f2c((MPI_Fint)(intptr_t)value);
  MPI_Comm shadow;
  PMPI_Comm_dup(comm, &shadow);
  PMPI_Comm_set_attr(comm, shadow_key, (void *)(intptr_t)PMPI_Comm_c2f(shadow));
  return shadow;
}

/// Where the function begins that holds an address. Addresses themselves differ where the compiler has doubled a call, once for each branch before it.
static const void *function_of(void *const frame)
{
  const void *const begin = _Unwind_FindEnclosingFunction((char *)frame - 1);
  return begin ? begin : frame;
}

static uint64_t mixed(const uint64_t hash, const uint64_t value)
{
  return (hash ^ value) * 0x9e3779b97f4a7c15u + (hash >> 29);
}

/// @param sizes  bytes, roots and so on: of all ranks the same
static void compare(const MPI_Comm comm, const char *const function, const int count, const long long *const sizes)
{
  int ranks, is_inter, rank;
  if (comm == MPI_COMM_NULL || shadow_key == MPI_KEYVAL_INVALID) return;
  PMPI_Comm_test_inter(comm, &is_inter);
  PMPI_Comm_size(comm, &ranks);
  if (is_inter || ranks == 1) return;
  void *frames[most_frames];
  const int depth = backtrace(frames, most_frames);
  uint64_t hash = 1;
  for (const char *c = function; *c; ++c) hash = mixed(hash, (unsigned char)*c);
  for (int k = 0; k < count; ++k) hash = mixed(hash, (uint64_t)sizes[k]);
  for (int k = 0; k < depth; ++k)
    if (is_program(frames[k])) hash = mixed(hash, (uintptr_t)function_of(frames[k]) - program_base);
  uint64_t mine[2] = {hash, ~hash}, most[2];
  const MPI_Comm shadow = shadow_of(comm);
  PMPI_Allreduce(mine, most, 2, MPI_UINT64_T, MPI_MAX, shadow);
  last_compared = now();
  ++compared;
  if (most[0] == ~most[1]) return;
  PMPI_Comm_rank(comm, &rank);
  char title[512];
  int used = snprintf(title, sizeof title, "differs from other ranks: %s", function);
  for (int k = 0; k < count; ++k) used += snprintf(title + used, sizeof title - used, " %lld", sizes[k]);
  for (int turn = 0; turn < ranks; ++turn) {
    if (turn == rank) print_stack(title);
    usleep(20000); // the launcher brings the outputs together
    PMPI_Barrier(shadow);
  }
  PMPI_Abort(MPI_COMM_WORLD, differs);
  _exit(differs);
}

static long long bytes(const int count, const MPI_Datatype type)
{
  int size = 0;
  if (count != 0) PMPI_Type_size(type, &size);
  return (long long)count * size;
}

static long long sum_of_counts(const MPI_Comm comm, const int *const counts, const MPI_Datatype type)
{
  int ranks;
  PMPI_Comm_size(comm, &ranks);
  uint64_t hash = 1;
  for (int k = 0; k < ranks; ++k) hash = mixed(hash, (uint64_t)bytes(counts[k], type));
  return (long long)hash;
}

/// C++ calls this for each exception.
void __attribute__((noreturn)) __cxa_throw(void *exception, void *type, void (*destructor)(void *))
{
  static void (*of_library)(void *, void *, void (*)(void *)) __attribute__((noreturn));
  if (!of_library) *(void **)&of_library = dlsym(RTLD_NEXT, "__cxa_throw");
  if (shadow_key != MPI_KEYVAL_INVALID) thrown = backtrace(thrown_at, most_frames);
  of_library(exception, type, destructor);
}

#define COMPARE(comm, ...)                                                                                             \
  do {                                                                                                                 \
    const long long sizes[] = {__VA_ARGS__};                                                                           \
    compare(comm, __func__, sizeof sizes / sizeof sizes[0], sizes);                                                    \
  } while (0)

int MPI_Init(int *argc, char ***argv)
{
  const int error = PMPI_Init(argc, argv);
  start();
  return error;
}

int MPI_Init_thread(int *argc, char ***argv, int required, int *provided)
{
  const int error = PMPI_Init_thread(argc, argv, required, provided);
  start();
  return error;
}

int MPI_Finalize(void)
{
  COMPARE(MPI_COMM_WORLD, 0);
  longest_wait = 1e30;
  const char *const path = getenv("RPC_COLLECTIVES_COUNT");
  FILE *const file = path && this_rank == 0 ? fopen(path, "a") : NULL;
  if (file) {
    fprintf(file, "%ld\n", compared);
    fclose(file);
  }
  return PMPI_Finalize();
}

int MPI_Barrier(MPI_Comm comm)
{
  COMPARE(comm, 0);
  return PMPI_Barrier(comm);
}

int MPI_Bcast(void *buffer, int count, MPI_Datatype type, int root, MPI_Comm comm)
{
  COMPARE(comm, bytes(count, type), root);
  return PMPI_Bcast(buffer, count, type, root, comm);
}

int MPI_Allreduce(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  COMPARE(comm, bytes(count, type));
  return PMPI_Allreduce(from, to, count, type, op, comm);
}

int MPI_Iallreduce(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm,
                   MPI_Request *request)
{
  COMPARE(comm, bytes(count, type));
  return PMPI_Iallreduce(from, to, count, type, op, comm, request);
}

int MPI_Reduce(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm)
{
  COMPARE(comm, bytes(count, type), root);
  return PMPI_Reduce(from, to, count, type, op, root, comm);
}

int MPI_Reduce_scatter(const void *from, void *to, const int counts[], MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  COMPARE(comm, sum_of_counts(comm, counts, type));
  return PMPI_Reduce_scatter(from, to, counts, type, op, comm);
}

int MPI_Scan(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  COMPARE(comm, bytes(count, type));
  return PMPI_Scan(from, to, count, type, op, comm);
}

int MPI_Exscan(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  COMPARE(comm, bytes(count, type));
  return PMPI_Exscan(from, to, count, type, op, comm);
}

int MPI_Allgather(const void *from, int sent, MPI_Datatype from_type, void *to, int got, MPI_Datatype type,
                  MPI_Comm comm)
{
  COMPARE(comm, bytes(got, type));
  return PMPI_Allgather(from, sent, from_type, to, got, type, comm);
}

int MPI_Allgatherv(const void *from, int sent, MPI_Datatype from_type, void *to, const int got[], const int places[],
                   MPI_Datatype type, MPI_Comm comm)
{
  COMPARE(comm, sum_of_counts(comm, got, type));
  return PMPI_Allgatherv(from, sent, from_type, to, got, places, type, comm);
}

int MPI_Gather(const void *from, int sent, MPI_Datatype from_type, void *to, int got, MPI_Datatype type, int root,
               MPI_Comm comm)
{
  COMPARE(comm, from == MPI_IN_PLACE ? bytes(got, type) : bytes(sent, from_type), root);
  return PMPI_Gather(from, sent, from_type, to, got, type, root, comm);
}

int MPI_Gatherv(const void *from, int sent, MPI_Datatype from_type, void *to, const int got[], const int places[],
                MPI_Datatype type, int root, MPI_Comm comm)
{
  COMPARE(comm, root);
  return PMPI_Gatherv(from, sent, from_type, to, got, places, type, root, comm);
}

int MPI_Scatter(const void *from, int sent, MPI_Datatype from_type, void *to, int got, MPI_Datatype type, int root,
                MPI_Comm comm)
{
  COMPARE(comm, to == MPI_IN_PLACE ? bytes(sent, from_type) : bytes(got, type), root);
  return PMPI_Scatter(from, sent, from_type, to, got, type, root, comm);
}

int MPI_Scatterv(const void *from, const int sent[], const int places[], MPI_Datatype from_type, void *to, int got,
                 MPI_Datatype type, int root, MPI_Comm comm)
{
  COMPARE(comm, root);
  return PMPI_Scatterv(from, sent, places, from_type, to, got, type, root, comm);
}

int MPI_Alltoall(const void *from, int sent, MPI_Datatype from_type, void *to, int got, MPI_Datatype type,
                 MPI_Comm comm)
{
  COMPARE(comm, bytes(got, type));
  return PMPI_Alltoall(from, sent, from_type, to, got, type, comm);
}

int MPI_Alltoallv(const void *from, const int sent[], const int from_places[], MPI_Datatype from_type, void *to,
                  const int got[], const int places[], MPI_Datatype type, MPI_Comm comm)
{
  COMPARE(comm, 0);
  return PMPI_Alltoallv(from, sent, from_places, from_type, to, got, places, type, comm);
}

int MPI_Comm_split(MPI_Comm comm, int color, int key, MPI_Comm *made)
{
  COMPARE(comm, 0);
  return PMPI_Comm_split(comm, color, key, made);
}

int MPI_Comm_dup(MPI_Comm comm, MPI_Comm *made)
{
  COMPARE(comm, 0);
  return PMPI_Comm_dup(comm, made);
}

int MPI_Comm_create(MPI_Comm comm, MPI_Group group, MPI_Comm *made)
{
  COMPARE(comm, 0);
  return PMPI_Comm_create(comm, group, made);
}

/// MUMPS calls MPI from Fortran, past the functions above. Its structure begins with sym, par, job and the communicator.
void dmumps_c(int *mumps)
{
  static void (*of_library)(int *);
  if (!of_library) of_library = (void (*)(int *))dlsym(RTLD_NEXT, "dmumps_c");
  if (pthread_equal(pthread_self(), main_thread))
    COMPARE(PMPI_Comm_f2c(mumps[3]), mumps[2]); // else that one calls MPI meanwhile
  of_library(mumps);
}
