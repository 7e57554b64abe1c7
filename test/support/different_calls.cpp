// SPDX-License-Identifier: BSD-3-Clause
// What collectives.c is to find: the last rank makes another collective call than the others ("call"), one of another
// size ("size"), from another function ("place"), on another communicator ("wait"), none since it throws ("throw"), or
// the same ("none").
#include <cstdio>
#include <mpi.h>
#include <stdexcept>
#include <string>

namespace
{

int meet_here()
{
  int mine = 1, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

int meet_there()
{
  int mine = 1, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return all + 1;
}

void throw_here()
{
  throw std::runtime_error("on one rank");
}

// Volatile: the compiler must not make one function of them.
int (*volatile const here)() = meet_here;
int (*volatile const there)() = meet_there;
void (*volatile const thrower)() = throw_here;

} // namespace

int main(int argc, char **argv)
{
  int rank = 0, ranks = 0, numbers[2] = {0, 0};
  MPI_Comm other;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_dup(MPI_COMM_WORLD, &other);
  const std::string fault = argc > 1 ? argv[1] : "none";
  const bool last = rank == ranks - 1;
  try {
    if (fault == "call" && last) MPI_Barrier(MPI_COMM_WORLD);
    if (fault == "size") MPI_Bcast(numbers, last ? 1 : 2, MPI_INT, 0, MPI_COMM_WORLD);
    if (fault == "place" && last) there();
    if (fault == "wait" && last) MPI_Barrier(other);
    if (fault == "throw" && last) thrower();
    const int met = here();
    if (rank == 0) std::printf("%d ranks met\n", met);
  } catch (const std::exception &) {
  }
  MPI_Comm_free(&other);
  MPI_Finalize();
  return 0;
}
