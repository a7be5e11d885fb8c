#!/usr/bin/env bash
# Submits a sweep as a job array and the merge that waits for it:
#
#   sweeps/slurm/submit.sh FILE OUT SHARDS [SBATCH OPTION]...
#
# `contact-dma plan FILE` tells a sensible number of shards. The parts are kept in OUT.parts.
set -euo pipefail
if [ $# -lt 3 ]; then
    echo "usage: $0 FILE OUT SHARDS [SBATCH OPTION]..." >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
export SWEEP=$1 OUT=$2 PARTS=$2.parts
shards=$3
shift 3
array=$(sbatch --parsable --array="1-$shards" "$@" "$here/array.sh")
# `afterany`: a shard with a case that did not converge (exit code 3) is merged all the same.
merge=$(sbatch --parsable --dependency="afterany:$array" "$@" "$here/merge.sh")
echo "array $array, merge $merge"
