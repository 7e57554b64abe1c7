#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The paper's tables and figures with rpc: bash doc/paper/reproduce.sh [--build=DIR] [--long]
#   --build=DIR  folder with the program; default: build, then the source tree's root
#   --long       also meshes 1/256 and 1/512 of the beam, and a mesh of the half cylinder as fine as the paper's
# Writes README.md and the pictures next to this file.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)

rpc= long=()
for argument in "$@"; do
  case $argument in
    --build=*) rpc=${argument#--build=}/rpc ;;
    --long) long=(--long) ;;
    *) sed -n '3,6s/^# //p' "$0"; [ "$argument" = --help ] && exit 0; exit 2 ;;
  esac
done
for candidate in "$root/build/rpc" "$root/rpc"; do
  if [ -z "$rpc" ] && [ -x "$candidate" ]; then rpc=$candidate; fi
done
if [ ! -x "$rpc" ]; then
  echo "no program ${rpc:-in build/}; name its folder (--build=DIR) or build it:" >&2
  echo "  cmake -S . -B build -G Ninja && cmake --build build" >&2
  exit 2
fi

bash "$root/cmake/install_packages.sh" "$root/doc/packages.txt"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
/usr/bin/python3 "$here/reproduce.py" --rpc="$rpc" --work="$work" "${long[@]}"
