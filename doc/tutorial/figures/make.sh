#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of the lessons: bash doc/tutorial/figures/make.sh [<rpc>]     default: build/rpc
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)
rpc=$(realpath "${1:-$root/build/rpc}")

bash "$root/cmake/install_packages.sh" "$root/doc/packages.txt"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# run <deck> [options of rpc...]: results go to the scratch folder, or where --output says
run() {
  "$rpc" --input="$here/../$1" --output="$work" "${@:2}" >"$work/log" || { cat "$work/log" >&2; exit 1; }
}

for n in 8 16 32 64 128; do
  run press_fit.xml --output="$work/press_fit_$n" --set="Mesh->Cells={$((3 * n)), $n}"
done
run press_fit.xml --set="Mesh->Cells={96, 32}"
run roller.yaml
run pin.xml
run dents.yaml
run dents.yaml --output="$work/dents_first" --set="Steps->To=1"
run sheared.yaml
run sheared.yaml --output="$work/sheared_part" --set="Steps->To=1.6"

bash "$root/doc/picture.sh" "$work/press_fit.e" --output="$here/press_fit.png"
bash "$root/doc/picture.sh" "$work/pin.e" --window=0,-1.5,-0.2,1.5,1.5,1.5 --output="$here/pin.png"
bash "$root/doc/picture.sh" "$work/dents.history.csv" --output="$here/dents_force.png"
bash "$root/doc/picture.sh" "$work/sheared.history.csv" --output="$here/sheared_force.png"
/usr/bin/python3 -B "$here/curves.py" "$work" "$here"
/usr/bin/python3 -B "$here/smaller.py" "$here"/*.png
ls -l "$here"/*.png
