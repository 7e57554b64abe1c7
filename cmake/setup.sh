# Sourced by run.sh and test.sh: packages, configuration and build, with a line of progress each.
# Environment: RPC_VERBOSE=1 shows all output; CMAKE_BUILD_PARALLEL_LEVEL sets the number of jobs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build

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

# set_up [<target>]: leaves <target> (default: all) built in build/, and ./rpc pointing to the program
set_up() {
  bash "$root/cmake/install_packages.sh"
  mkdir -p "$build"
  if [ ! -e "$build/build.ninja" ] && [ ! -e "$build/Makefile" ]; then
    say "configuring"
    local options=(-G Ninja)
    if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
    quietly "$build/configure.log" cmake -S "$root" -B "$build" "${options[@]}"
  fi
  local jobs note=
  jobs=$(build_jobs)
  if [ ! -e "$build/rpc" ]; then note=", which takes minutes the first time"; fi
  say "building with $jobs job(s)$note"
  # On a terminal Ninja's one line of progress is worth seeing.
  if [ -t 2 ] && [ "${TERM:-dumb}" != dumb ]; then
    cmake --build "$build" --target "${1:-all}" --parallel "$jobs" >&2
  else
    quietly "$build/build.log" cmake --build "$build" --target "${1:-all}" --parallel "$jobs"
  fi
  ln -sfn build/rpc "$root/rpc"
}
