// SPDX-License-Identifier: BSD-3-Clause
// What collectives.c is to find: the last rank makes another collective call than the others ("call"), one of another size ("size"), from another
// function ("place"), on another communicator ("wait"), or the same ("none").
#include <mpi.h>
#include <stdio.h>
#include <string.h>

static int meet_here(void)
{
  int mine = 1, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

static int meet_there(void)
{
  int mine = 1, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return all + 1;
}

int main(int argc, char **argv)
{
  // Volatile: or the compiler would make one function of two.
  int (*volatile const here)(void) = meet_here, (*volatile const there)(void) = meet_there;
  int rank, ranks, numbers[2] = {0, 0};
  MPI_Comm other;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_dup(MPI_COMM_WORLD, &other);
  const char *const fault = argc > 1 ? argv[1] : "none";
  const int last = rank == ranks - 1;
  if (strcmp(fault, "call") == 0 && last) MPI_Barrier(MPI_COMM_WORLD);
  if (strcmp(fault, "size") == 0) MPI_Bcast(numbers, last ? 1 : 2, MPI_INT, 0, MPI_COMM_WORLD);
  if (strcmp(fault, "place") == 0 && last) there();
  if (strcmp(fault, "wait") == 0 && last) MPI_Barrier(other);
  const int met = here();
  MPI_Comm_free(&other);
  MPI_Finalize();
  if (rank == 0) printf("%d ranks met\n", met);
  return 0;
}
