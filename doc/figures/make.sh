#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of this folder: bash doc/figures/make.sh [<rpc>]     default: build/rpc
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
input="$root/input"

curves=()
for xi in 12 16 18 20; do
  run "$input/beam.xml" --output="$work/$xi" --set="Contact->Yield Stress=$xi"
  curves+=("$xi=$work/$xi/beam.contact.csv")
done
for deck in beam_adaptive hertz_adaptive; do
  run "$input/$deck.xml" --set="Adapt->Target Relative Error=0.002"
done
for xi in inf 100; do
  run "$input/ball.xml" --output="$work/ball_$xi" --set="Contact->Yield Stress=$xi"
done
for law in "Yield Stress=20" Hardening=200 Stiffness=1000; do
  run "$input/indent.xml" --output="$work/${law%%[ =]*}" --set="Contact->$law"
done
for deck in block track block_adaptive shear ball_friction rough; do
  run "$input/$deck.xml"
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
/usr/bin/python3 "$here/track.py" "$here/track.png" "$work/track.e"
bash "$root/doc/picture.sh" "$work/block_adaptive.e" --output="$here/block_adaptive.png"
/usr/bin/python3 "$here/space_accuracy.py" "$here/space_accuracy.png" "$rpc"
/usr/bin/python3 -B "$root/test/benchmark/friction_cost.py" draw "$root/doc/friction_cost.csv"
bash "$root/doc/picture.sh" "$work/shear.e" --time=1.5 --output="$here/shear.png"
bash "$root/doc/picture.sh" "$work/shear.history.csv" --output="$here/shear_force.png"
bash "$root/doc/picture.sh" "$work/ball_friction.e" --window=-0.25,0,-0.01,0.25,0.25,0.15 --output="$here/ball_friction.png"

# doc/pictures.md, by its own commands.
page="$work/page"
for deck in beam hertz block shear indent ball_friction hertz_adaptive beam_adaptive; do
  more=()
  [ $deck = ball_friction ] && more=(--set="Mesh->Size Factor=1.5")
  run "$input/$deck.xml" --output="$page" "${more[@]}"
done
run "$input/beam.xml" --output="$page/rigid" --set="Contact->Yield Stress=inf"
/usr/bin/python3 -B "$here/pictures.py" "$page"
ls -l "$here"/*.png "$here"/pictures/*.png
