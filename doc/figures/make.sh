#!/usr/bin/env bash
# Makes the pictures of this folder: bash doc/figures/make.sh [<rpc>]     default: build/rpc
# Installs ParaView, Xvfb and Matplotlib from Debian where they are missing, as root or through sudo.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
rpc=$(realpath "${1:-$root/build/rpc}")

missing=()
for package in paraview python3-paraview xvfb xauth python3-matplotlib python3-scipy; do
  dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  sudo=()
  if [ "$(id -u)" -ne 0 ]; then sudo=(sudo); fi
  "${sudo[@]}" apt-get -q update
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends "${missing[@]}"
fi

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

# Debian's ParaView draws through X only; Xvfb is an X server without a screen.
xvfb-run -a pvbatch --force-offscreen-rendering "$here/beam_von_mises.py" "$work/16/beam.e" "$here/beam_von_mises.png"
/usr/bin/python3 "$here/beam_contact.py" "$here/beam_contact.png" "${curves[@]}"
/usr/bin/python3 "$here/adapted_meshes.py" "$here/adapted_meshes.png" "$work"/{beam,hertz}_adaptive{.e,.contact.csv}
ls -l "$here"/*.png
