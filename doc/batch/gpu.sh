#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Two nodes of four GPUs, a rank a GPU: sbatch doc/batch/gpu.sh
#SBATCH --job-name=rpc-gpu
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=4
#SBATCH --gpus-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --time=00:30:00
#SBATCH --signal=TERM@120
set -eu
# Each rank sees all GPUs of its node and takes the one of its number there; --gpus-per-task=1 does as well.
srun --mpi=pmix --cpu-bind=cores rpc --input="${DECK:-block.xml}" --output="results-$SLURM_JOB_ID"
