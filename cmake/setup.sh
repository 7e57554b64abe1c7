# Sourced by run.sh and test.sh: packages, configuration and build, with a line of progress each; environment: see common.sh.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
source "$root/cmake/common.sh"

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
  building "$build/build.log" cmake --build "$build" --target "${1:-all}" --parallel "$jobs"
  ln -sfn build/rpc "$root/rpc"
}
