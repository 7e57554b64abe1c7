#!/usr/bin/env bash
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

bash "$root/doc/picture.sh" "$work/16/beam.e" --output="$here/beam.png"
/usr/bin/python3 "$here/beam_contact.py" "$here/beam_contact.png" "${curves[@]}"
/usr/bin/python3 "$here/adapted_meshes.py" "$here/adapted_meshes.png" "$work"/{beam,hertz}_adaptive{.e,.contact.csv}
ls -l "$here"/*.png
