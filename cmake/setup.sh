# SPDX-License-Identifier: BSD-3-Clause
# Sourced by run.sh, test.sh and test/gpu.sh: packages, configuration and build, with a line of progress each.
# Environment: RPC_PRESET=openmp | cuda | ... takes a preset of CMakePresets.json and its folder build-<preset> instead of build; for
# more see common.sh.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=${RPC_PRESET:-serial}
build=$root/build
if [ "$preset" != serial ]; then build=$root/build-$preset; fi
source "$root/cmake/common.sh"

# set_up [<target>]: leaves <target> (default: all) built in $build, and ./rpc pointing to the program
set_up() {
  bash "$root/cmake/install_packages.sh"
  mkdir -p "$build"
  if [ ! -e "$build/build.ninja" ] && [ ! -e "$build/Makefile" ]; then
    say "configuring"
    local options=()
    if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
    (cd "$root" && quietly "$build/configure.log" cmake --preset "$preset" "${options[@]}")
  fi
  local jobs note=
  jobs=$(build_jobs)
  if [ ! -e "$build/rpc" ]; then note=", which takes minutes the first time"; fi
  say "building with $jobs job(s)$note"
  building "$build/build.log" cmake --build "$build" --target "${1:-all}" --parallel "$jobs"
  ln -sfn "${build##*/}/rpc" "$root/rpc"
}
