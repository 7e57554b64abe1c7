# SPDX-License-Identifier: BSD-3-Clause
# Sourced by setup.sh and trilinos.sh: messages, logs and the number of jobs.
# Environment: RPC_VERBOSE=1 shows all output; CMAKE_BUILD_PARALLEL_LEVEL sets the number of jobs.

say() { echo "rpc: $*" >&2; } # standard output belongs to the program

# quietly <log> <command...>: the output goes to the log, and to the screen if the command fails
quietly() {
  local log=$1 status=0
  shift
  if [ -n "${RPC_VERBOSE:-}" ]; then
    "$@" >&2
    return
  fi
  "$@" >"$log" 2>&1 || status=$?
  if [ $status -ne 0 ]; then
    cat "$log" >&2
    say "failed: $* (output above and in $log)"
  fi
  return $status
}

# building <log> <command...>: quietly, but on a terminal, where Ninja's one line of progress is worth seeing
building() {
  if [ -t 2 ] && [ "${TERM:-dumb}" != dumb ]; then
    "${@:2}" >&2
  else
    quietly "$@"
  fi
}

# As many jobs as there are cores, but 1.5 GB of memory for each: a file that includes MueLu takes that much.
build_jobs() {
  local cores free limit
  cores=$(nproc)
  free=$(awk '/^MemAvailable:/ {print int($2 / 1024)}' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max) # a container's share
  if [ "$limit" != max ] && [ $((limit / 1048576)) -lt "$free" ]; then free=$((limit / 1048576)); fi
  local jobs=$((free / 1500))
  if [ $jobs -gt "$cores" ]; then jobs=$cores; fi
  if [ $jobs -lt 1 ]; then jobs=1; fi
  echo "${CMAKE_BUILD_PARALLEL_LEVEL:-$jobs}"
}
