#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds everything and runs the tests: bash cmake/test.sh [more options of ctest]
# Environment: RPC_TEST_THREADS=2 gives each rank two OpenMP threads; see also setup.sh.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up
cmake -DRPC_TEST_THREADS="${RPC_TEST_THREADS:-1}" "$build" >/dev/null
say "testing"
cd "$build"
# Ranks and scripts wait for each other or for files now and then: half as many tests again as there are cores.
exec ctest --output-on-failure --no-tests=error --parallel $((($(nproc) * 3 + 1) / 2)) -LE 'performance|stress' "$@"
