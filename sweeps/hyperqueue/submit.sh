#!/usr/bin/env bash
# Submits a sweep to HyperQueue: a task for each shard, and the merge that waits for them.
#
#   sweeps/hyperqueue/submit.sh FILE OUT SHARDS [HQ OPTION]...
#
# `contact-dma plan FILE` tells a sensible number of shards. The parts are kept in OUT.parts, beside the job file.
set -euo pipefail
if [ $# -lt 3 ]; then
    echo "usage: $0 FILE OUT SHARDS [HQ OPTION]..." >&2
    exit 2
fi
sweep=$(realpath "$1") out=$(realpath -m "$2") shards=$3
shift 3
program=${CONTACT_DMA:-contact-dma}
parts=$out.parts
mkdir -p "$parts"
# A command for the job file, which is TOML. With exit code 3 some cases have no result, which the merge names.
command_of() {
    python3 -c 'import json, shlex, sys
print(json.dumps(["sh", "-c", shlex.join(sys.argv[1:]) + " || [ $? = 3 ]"], ensure_ascii=False))' "$@"
}
{
    echo 'name = "contact-dma"'
    folders=()
    for k in $(seq "$shards"); do
        folders+=("$parts/$k-of-$shards")
        # Killed with its worker, a shard goes on where it was.
        printf '[[task]]\nid = %s\ncrash_limit = 5\ncommand = %s\n[[task.request]]\nresources = { "cpus" = 1 }\n' "$k" \
            "$(command_of "$program" sweep "$sweep" --shard "$k/$shards" --threads 1 --quiet --out "${folders[-1]}")"
    done
    printf '[[task]]\nid = 0\ndeps = [%s]\ncommand = %s\n' "$(seq --separator=, "$shards")" \
        "$(command_of "$program" merge "${folders[@]}" --quiet --out "$out")"
} > "$parts/job.toml"
hq job submit-file "$parts/job.toml" "$@"
