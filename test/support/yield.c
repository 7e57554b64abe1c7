// SPDX-License-Identifier: BSD-3-Clause
// Preloaded in tests on several ranks: MPI's ranks call sched_yield() while they wait for each other, which on a busy machine leaves
// them running all the same, while the rank that they wait for does not run. Here they sleep once a wait is long or once another
// program was seen on their core. Short waits on an idle machine cost no more than before.
#define _GNU_SOURCE
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static const double work = 5e-6;       // [s] between two calls: more than that is work, so that a new wait begins
static const double long_wait = 1e-4;  // [s]
static const double preempted = 1e-3;  // [s] in one call: another program ran meanwhile
static const double busy_for = 0.1;    // [s] that the core then counts as busy
static const struct timespec nap = {0, 20000};

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

int sched_yield(void)
{
  static __thread double wait_start, last_end, busy_until;
  const double start = now();
  if (start - last_end > work) wait_start = start;
  if (start - wait_start > long_wait || start < busy_until) {
    nanosleep(&nap, 0);
  } else {
    syscall(SYS_sched_yield);
    if (now() - start > preempted) busy_until = start + busy_for;
  }
  last_end = now();
  return 0;
}
