#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of this folder: bash doc/figures/make.sh [<rpc>]     default: build/rpc
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
rpc=$(realpath "${1:-$root/build/rpc}")

bash "$root/cmake/install_packages.sh" "$root/doc/packages.txt"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
curves=()
for xi in 12 16 18 20; do
  mkdir "$work/$xi"
  "$rpc" --input="$root/input/beam.xml" --output="$work/$xi" --set="Contact->Yield Stress=$xi" >"$work/$xi/log" ||
    { cat "$work/$xi/log" >&2; exit 1; }
  curves+=("$xi=$work/$xi/beam.contact.csv")
done

for deck in beam_adaptive hertz_adaptive; do
  "$rpc" --input="$root/input/$deck.xml" --output="$work" --set="Adapt->Target Relative Error=0.002" >"$work/log" ||
    { cat "$work/log" >&2; exit 1; }
done

for xi in inf 100; do
  mkdir "$work/ball_$xi"
  "$rpc" --input="$root/input/ball.xml" --output="$work/ball_$xi" --set="Contact->Yield Stress=$xi" >"$work/log" ||
    { cat "$work/log" >&2; exit 1; }
done
"$rpc" --input="$root/input/block.xml" --output="$work" >"$work/log" || { cat "$work/log" >&2; exit 1; }

for law in "Yield Stress=20" Hardening=200 Stiffness=1000; do
  "$rpc" --input="$root/input/indent.xml" --output="$work/${law%%[ =]*}" --set="Contact->$law" >"$work/log" ||
    { cat "$work/log" >&2; exit 1; }
done

bash "$root/doc/picture.sh" "$work/16/beam.e" --output="$here/beam.png"
bash "$root/doc/picture.sh" "$work/ball_inf/ball.e" --output="$here/ball.png"
bash "$root/doc/picture.sh" "$work/block.e" --output="$here/block.png"
/usr/bin/python3 "$here/ball_pressure.py" "$here/ball_pressure.png" "$work/ball_inf" "$work/ball_100"
/usr/bin/python3 "$here/beam_contact.py" "$here/beam_contact.png" "${curves[@]}"
/usr/bin/python3 "$here/adapted_meshes.py" "$here/adapted_meshes.png" "$work"/{beam,hertz}_adaptive{.e,.contact.csv}
bash "$root/doc/picture.sh" --output="$here/indent_force.png" "perfectly plastic=$work/Yield/indent.history.csv" \
  "hardening, H = 200 Pa/m=$work/Hardening/indent.history.csv" "on springs, k = 1000 Pa/m=$work/Stiffness/indent.history.csv"
/usr/bin/python3 "$here/indent.py" "$here/indent.png" "$work"/{Yield,Hardening,Stiffness}/indent.e
"$rpc" --input="$root/input/track.xml" --output="$work" >"$work/log" || { cat "$work/log" >&2; exit 1; }
/usr/bin/python3 "$here/track.py" "$here/track.png" "$work/track.e"
"$rpc" --input="$root/input/block_adaptive.xml" --output="$work" >"$work/log" || { cat "$work/log" >&2; exit 1; }
bash "$root/doc/picture.sh" "$work/block_adaptive.e" --output="$here/block_adaptive.png"
/usr/bin/python3 "$here/space_accuracy.py" "$here/space_accuracy.png" "$rpc"
for deck in shear ball_friction; do
  "$rpc" --input="$root/input/$deck.xml" --output="$work" >"$work/log" || { cat "$work/log" >&2; exit 1; }
done
bash "$root/doc/picture.sh" "$work/shear.e" --time=1.5 --output="$here/shear.png"
bash "$root/doc/picture.sh" "$work/shear.history.csv" --output="$here/shear_force.png"
bash "$root/doc/picture.sh" "$work/ball_friction.e" --window=-0.25,0,-0.01,0.25,0.25,0.15 --output="$here/ball_friction.png"

# doc/pictures.md, by its own commands.
page="$work/page"
for deck in beam hertz block shear indent ball_friction hertz_adaptive beam_adaptive; do
  more=()
  [ $deck = ball_friction ] && more=(--set="Mesh->Size Factor=1.5")
  "$rpc" --input="$root/input/$deck.xml" --output="$page" "${more[@]}" >"$work/log" || { cat "$work/log" >&2; exit 1; }
done
"$rpc" --input="$root/input/beam.xml" --output="$page/rigid" --set="Contact->Yield Stress=inf" >"$work/log" || { cat "$work/log" >&2; exit 1; }
/usr/bin/python3 -B "$here/pictures.py" "$page"
ls -l "$here"/*.png "$here"/pictures/*.png
