#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Two nodes of 64 cores, a rank a core: sbatch doc/batch/cpu.sh
# --mpi=pmix: without it, and where the cluster's MpiDefault is none, Open MPI of Debian ends in MPI_Init.
#SBATCH --job-name=rpc
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=64
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
#SBATCH --signal=TERM@120
set -eu
export OMP_NUM_THREADS=1
# TERM, two minutes before the end: rpc writes what it has found, a checkpoint too, and exits with 4.
srun --mpi=pmix --cpu-bind=cores rpc --input="${DECK:-block.xml}" --output="results-$SLURM_JOB_ID"
