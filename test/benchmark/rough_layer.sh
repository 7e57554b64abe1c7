#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A layer of 512 x 512 x 64 cells on a rough surface, elastic and with a yield stress of 0.3 E*: bash rough_layer.sh [--ranks=N] RPC [CELLS] [FOLDER] [OPTION ...]
# RPC: the program. N ranks: mpiexec starts them, or what MPIEXEC says. CELLS: 512,512,64 unless given; the surface stays the same. FOLDER: for surface and results; a new one unless given. Further options go to
# rpc. Takes neither Python nor a network. Of each run it prints the lines on counts, area, energy, patches and times.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
launch=()
if [[ ${1:-} == --ranks=* ]]; then
  read -r -a launch <<<"${MPIEXEC:-mpiexec} -n ${1#*=}"
  shift
fi
rpc=$(realpath "${1:?bash rough_layer.sh [--ranks=N] RPC [CELLS] [FOLDER] [OPTION ...]}")
cells=${2:-512,512,64}
folder=${3:-$(mktemp -d)}
shift $(($# < 3 ? $# : 3))
mkdir -p "$folder"
cd "$folder"
if ! [ -e rough_layer.npy ]; then
  "$rpc" --make-surface=rough_layer.npy --set=Points=512 --set="Lowest Wave Number=4" --set="Highest Wave Number=64" --set="RMS Slope=1" --set=Seed=1
fi
for yield in inf 0.3; do
  echo "yield stress $yield"
  "${launch[@]}" "$rpc" --input="$here/rough_layer.yaml" --output="yield_$yield" --set="Mesh->Cells={$cells}" --set="Contact->Yield Stress=$yield" "$@" |
    grep -E '^rough_layer|in contact|yielded|body|energy J|patches|work|linear solver|time  |NOT CONV|note'
done
echo "results: $folder"
