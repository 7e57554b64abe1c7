#!/usr/bin/env bash
# Installs what is missing, builds everything and runs the tests: bash cmake/test.sh [more options of ctest]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up
say "testing"
cd "$build"
exec ctest --output-on-failure --no-tests=error --parallel "$(nproc)" -LE 'performance|stress' "$@"
