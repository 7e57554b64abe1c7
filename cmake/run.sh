#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds, and runs the program: bash cmake/run.sh --input=beam.xml [more options of rpc]
# Environment: NP=2 runs on 2 MPI ranks; see also common.sh.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up rpc
if [ "${NP:-1}" -eq 1 ]; then exec "$root/rpc" "$@"; fi
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
launch=(mpirun -np "$NP")
if mpirun --version 2>/dev/null | grep -qE 'Open ?MPI|OpenRTE'; then launch+=(--oversubscribe); fi # more ranks than cores is the user's business
exec "${launch[@]}" "$root/rpc" "$@"
