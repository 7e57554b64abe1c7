#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Solves the problems of the gallery and makes doc/gallery/README.md and its pictures: bash doc/gallery.sh [--program=RPC] [options of gallery.py]
#   --program=RPC   the program; default: build/rpc, then rpc in the source tree's root
# Exit codes: 0; 1 a value lies outside its error bar, or a run has failed; 2 bad command line. --help names all options.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/.." && pwd)

program=() options=()
for argument in "$@"; do
  case $argument in
    --program=*) program=("$argument") ;;
    *) options+=("$argument") ;;
  esac
done
for candidate in "$root/build/rpc" "$root/rpc"; do
  if [ ${#program[@]} -eq 0 ] && [ -x "$candidate" ]; then program=("--program=$candidate"); fi
done
if [ ${#program[@]} -eq 0 ]; then
  echo "gallery: no program in build/; name it (--program=RPC) or build it: cmake -S . -B build -G Ninja && cmake --build build" >&2
  exit 2
fi

bash "$root/cmake/install_packages.sh" "$here/packages.txt"
exec /usr/bin/python3 -B "$here/gallery/gallery.py" "${program[@]}" "${options[@]}" # Debian's Python, which sees Debian's modules
