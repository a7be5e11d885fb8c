#!/usr/bin/env bash
# One shard of a sweep per task of a Slurm job array. Submit with submit.sh, or by hand:
#
#   SWEEP=sweeps/pmma.toml PARTS=/scratch/pmma-parts sbatch --array=1-8 sweeps/slurm/array.sh
#
# A task that is killed, preempted or requeued goes on where it was: finished cases are read, a long one goes on from its
# checkpoint. On SIGTERM the program writes its checkpoints and ends within two seconds.
#SBATCH --job-name=contact-dma
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --cpus-per-task=1
set -euo pipefail
count=$SLURM_ARRAY_TASK_COUNT
shard=$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN + 1))
# `exec`: the signals of Slurm reach the program itself.
exec "${CONTACT_DMA:-contact-dma}" sweep "$SWEEP" --shard "$shard/$count" --out "$PARTS/part-$shard" \
    --threads "${SLURM_CPUS_PER_TASK:-1}"
