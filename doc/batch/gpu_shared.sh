#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Four ranks on one GPU, under CUDA's multi-process service: without it they take turns. sbatch doc/batch/gpu_shared.sh
#SBATCH --job-name=rpc-mps
#SBATCH --nodes=1
#SBATCH --ntasks=4
#SBATCH --gpus=1
#SBATCH --time=00:30:00
set -eu
export CUDA_MPS_PIPE_DIRECTORY=$TMPDIR/mps CUDA_MPS_LOG_DIRECTORY=$TMPDIR/mps-log
mkdir -p "$CUDA_MPS_PIPE_DIRECTORY" "$CUDA_MPS_LOG_DIRECTORY"
nvidia-cuda-mps-control -d
trap 'echo quit | nvidia-cuda-mps-control' EXIT
srun --mpi=pmix --cpu-bind=cores rpc --input="${DECK:-block.xml}" --output="results-$SLURM_JOB_ID"
