#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs those Debian packages of some lists that are missing, as root or through sudo:
#   bash cmake/install_packages.sh [list ...]     default: cmake/packages.txt
# Silent, and without network, if none is.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

if [ $# -eq 0 ]; then set -- "$here/packages.txt"; fi
wanted=$(sed 's/#.*//' "$@")
if ! command -v dpkg-query >/dev/null; then
  echo "rpc: not a Debian system, so nothing is installed; what is needed: $*" >&2
  exit 0
fi
present=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p')
missing=()
for package in $wanted; do
  grep -qxF -- "$package" <<<"$present" || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

run_as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "rpc: packages are missing, and installing them takes root or sudo. As root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  run_as_root=(sudo)
fi

echo "rpc: installing packages: ${missing[*]}" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() { "${run_as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y "$@" >"$log" 2>&1; }
# A broken third-party source fails the update but not what we need: the installation decides.
apt update || true
if ! apt install --no-install-recommends "${missing[@]}"; then
  cat "$log" >&2
  echo "rpc: apt-get install ${missing[*]} failed, see above" >&2
  exit 1
fi
