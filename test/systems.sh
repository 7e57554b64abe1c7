#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# README's two commands on another Debian, from its smallest installation:
#
#   bash test/systems.sh SYSTEM [--short] [--sudo] [--keep]
#
#   SYSTEM    12, 13 or unstable, or a suite of Debian's: bookworm, trixie, sid
#   --short   builds the program and the unit tests of core, mesh and solver, and runs these, one deck on two ranks, and the program
#             against the installed package, in less than 20 minutes on two cores
#   --sudo    as a user who may use sudo, not as root
#   --keep    leaves the system in build-systems/SUITE, 4 GB, where the next call finds it and goes on; else it is removed
#
# What runs there is this working tree: the files that git tracks, with their changes. The system comes from the mirror in this
# machine's own apt sources. Needs root, and installs mmdebstrap. Where a machine cannot make such a system, it says NOT RUN with the reason
# and exits with 3. Logs: build-systems/SUITE.*.log
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/common.sh

not_run() {
  echo "systems: $suite NOT RUN: $*"
  exit 3
}
misused() {
  say "$*; the head of test/systems.sh tells how to call it"
  exit 2
}

suite='' short='' keep='' as_user=root
for argument in "$@"; do
  case $argument in
    12 | bookworm) suite=bookworm ;;
    13 | trixie) suite=trixie ;;
    unstable | sid) suite=sid ;;
    --short) short=1 ;;
    --sudo) as_user=newcomer ;;
    --keep) keep=1 ;;
    *) misused "unknown argument \"$argument\"" ;;
  esac
done
[ -n "$suite" ] || misused "which system?"

[ "$(id -u)" -eq 0 ] || not_run "to make a system takes root"
command -v apt-get >/dev/null || not_run "this is no Debian, and knows no mirror"
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -m 1 '/debian/$' || true)
[ -n "$mirror" ] || not_run "this machine's apt sources name no mirror of Debian"
if ! command -v mmdebstrap >/dev/null; then
  bash cmake/install_packages.sh <(echo mmdebstrap) || not_run "there is no mmdebstrap, and it could not be installed"
fi
unshare --mount true 2>/dev/null || not_run "this machine lets nobody mount"

folder=$PWD/build-systems
fs=$folder/$suite
mkdir -p "$folder"

# inside <command...>: in the system, with mounts that end with the command
inside() {
  unshare --mount --propagation private bash -c '
    mount -t proc proc "$1/proc" && mount --rbind /sys "$1/sys" && mount --rbind /dev "$1/dev" && mount -t tmpfs tmpfs "$1/dev/shm" &&
    exec chroot "$@"' \
    - "$fs" env -i HOME=/root LC_ALL=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    "${settings[@]}" "$@"
}
# The machine's own way to the mirror, and how many jobs may run.
settings=()
for name in http_proxy https_proxy no_proxy CMAKE_BUILD_PARALLEL_LEVEL; do
  if [ -n "${!name:-}" ]; then settings+=("$name=${!name}"); fi
done

# as_newcomer <command line>: in the checkout there
as_newcomer() {
  if [ "$as_user" = root ]; then
    inside bash -c "cd /opt/rpc && $1"
  else
    inside su "$as_user" -c "cd /opt/rpc && $1"
  fi
}

# step <name> <command...>: with a line that tells its time; the log, whose end is shown if the command fails
step() {
  local name=$1 start=$SECONDS log=$folder/$suite.$1.log
  if ! "${@:2}" >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    if grep -qE 'Failed to fetch|Unable to fetch|Could not resolve' "$log"; then not_run "the mirror did not give its packages"; fi
    say "$suite: $name failed after $((SECONDS - start)) s; the end of $log stands above"
    exit 1
  fi
  echo "systems: $suite: $name took $((SECONDS - start)) s"
}

remove() { if [ -z "$keep" ]; then rm -rf --one-file-system "$fs"; fi; }

make_system() {
  # A mirror may stand still for a while: what it has is dated, and counts all the same.
  local old='Acquire::Check-Valid-Until "false"'
  mmdebstrap --variant=minbase --aptopt="$old" --include=ca-certificates${1:+,$1} "$suite" "$fs.part" "deb [trusted=yes] $mirror $suite main" &&
    mv "$fs.part" "$fs"
}

trap remove EXIT
rm -rf "$fs.part"
if [ ! -e "$fs" ] && ! make_system "$([ "$as_user" = root ] || echo sudo)" >"$folder/$suite.system.log" 2>&1; then
  tail -n 20 "$folder/$suite.system.log" >&2
  not_run "it could not be made; the end of $folder/$suite.system.log stands above"
fi
if [ "$as_user" != root ] && ! inside id "$as_user" >/dev/null 2>&1; then
  inside useradd -m "$as_user"
  echo "$as_user ALL=(ALL) NOPASSWD: ALL" >"$fs/etc/sudoers.d/$as_user"
fi
mkdir -p "$fs/opt/rpc"
git ls-files -z | tar --null --ignore-failed-read -T - -cf - 2>/dev/null | tar -C "$fs/opt/rpc" -xf -
inside chown -R "$as_user" /opt/rpc

if [ -n "$short" ]; then
  step packages as_newcomer 'bash cmake/install_packages.sh'
  step configure as_newcomer 'cmake --preset serial "-DRPC_TEST_PACKAGES=core;mesh;solver;install"'
  step build as_newcomer "cmake --build build --parallel $(build_jobs)"
  step beam as_newcomer 'bash cmake/run.sh --input=beam.xml && NP=2 bash cmake/run.sh --input=hertz.xml'
  step tests as_newcomer "cd build && ctest --output-on-failure --no-tests=error --parallel $(nproc)"
else
  step first_result as_newcomer 'bash cmake/run.sh --input=beam.xml'
  step tests as_newcomer 'bash cmake/test.sh'
fi
grep -hE 'energy J|tests passed|Total Test time' "$folder/$suite".{first_result,beam,tests}.log 2>/dev/null | sed "s/^ */systems: $suite: /" || true
