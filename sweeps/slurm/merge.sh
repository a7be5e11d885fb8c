#!/usr/bin/env bash
# Joins the shards of array.sh, locates the peaks and writes tables and figures into $OUT. It names what is missing.
#SBATCH --job-name=contact-dma-merge
#SBATCH --cpus-per-task=1
set -euo pipefail
exec "${CONTACT_DMA:-contact-dma}" merge "$PARTS"/part-* --out "$OUT" --threads "${SLURM_CPUS_PER_TASK:-1}"
