#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Puts what rpc --print-parameters says into doc/input/parameters.md: bash doc/update_input.sh [--check] [<rpc>]    default: build/rpc
# --check changes nothing and fails, with the differences, if doc/input/parameters.md says something else.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
check=
if [ "${1:-}" = --check ]; then
  check=1
  shift
fi
rpc=${1:-$here/../build/rpc}

new=$(mktemp)
trap 'rm -f "$new" "$new.parameters"' EXIT
"$rpc" --print-parameters >"$new.parameters"
awk -v parameters="$new.parameters" '
  /^<!-- end of parameters -->$/ { inside = 0; ends++ }
  !inside { print }
  /^<!-- parameters: / { inside = 1; begins++; while ((getline line < parameters) > 0) print line; print "" }
  END { if (begins != 1 || ends != 1) exit 1 }
' "$here/input/parameters.md" >"$new" || { echo "doc/input/parameters.md: the two marks around the parameters are missing" >&2; exit 1; }

if [ -z "$check" ]; then
  cat "$new" >"$here/input/parameters.md"
elif ! diff -u "$here/input/parameters.md" "$new"; then
  echo "doc/input/parameters.md is out of date; remedy: bash doc/update_input.sh" >&2
  exit 1
fi
