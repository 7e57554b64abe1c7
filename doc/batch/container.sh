#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The CPU image under Apptainer, with the Open MPI of the cluster outside: sbatch doc/batch/container.sh
#SBATCH --job-name=rpc-sif
#SBATCH --nodes=1
#SBATCH --ntasks=32
#SBATCH --time=01:00:00
set -eu
mpirun -np "$SLURM_NTASKS" apptainer run "${IMAGE:-rpc.sif}" --input="${DECK:-block.xml}" --output="results-$SLURM_JOB_ID"
