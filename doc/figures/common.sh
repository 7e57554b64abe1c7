# SPDX-License-Identifier: BSD-3-Clause
# What the makers of pictures share, figures/make.sh and tutorial/figures/make.sh, which source it: $root of the source tree, $rpc, $here, the
# folder of the maker, a scratch folder $work, and run.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[1]}")" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
rpc=$(realpath "${1:-$root/build/rpc}")

bash "$root/cmake/install_packages.sh" "$root/doc/packages.txt"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# run <deck> [options of rpc...]: results go to the scratch folder, or where --output says
run() {
  "$rpc" --input="$1" --output="$work" "${@:2}" >"$work/log" || { cat "$work/log" >&2; exit 1; }
}
