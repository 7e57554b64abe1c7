#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of the lessons: bash doc/tutorial/figures/make.sh [<rpc>]     default: build/rpc
source "$(dirname "${BASH_SOURCE[0]}")/../../figures/common.sh"
lessons="$here/.."

for n in 8 16 32 64 128; do
  run "$lessons/press_fit.xml" --output="$work/press_fit_$n" --set="Mesh->Cells={$((3 * n)), $n}"
done
run "$lessons/press_fit.xml" --set="Mesh->Cells={96, 32}"
run "$lessons/roller.yaml"
run "$lessons/pin.xml"
run "$lessons/dents.yaml"
run "$lessons/dents.yaml" --output="$work/dents_first" --set="Steps->To=1"
run "$lessons/sheared.yaml"
run "$lessons/sheared.yaml" --output="$work/sheared_part" --set="Steps->To=1.6"

bash "$root/doc/picture.sh" "$work/press_fit.e" --output="$here/press_fit.png"
bash "$root/doc/picture.sh" "$work/pin.e" --window=0,-1.5,-0.2,1.5,1.5,1.5 --output="$here/pin.png"
bash "$root/doc/picture.sh" "$work/dents.history.csv" --output="$here/dents_force.png"
bash "$root/doc/picture.sh" "$work/sheared.history.csv" --output="$here/sheared_force.png"
/usr/bin/python3 -B "$here/curves.py" "$work" "$here"
/usr/bin/python3 -B "$here/smaller.py" "$here"/*.png
ls -l "$here"/*.png
