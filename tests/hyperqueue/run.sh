#!/usr/bin/env bash
# A sweep in tasks of HyperQueue is the sweep of one process, byte for byte: tests/hyperqueue/run.sh PROGRAM
# Ends with 77 where HyperQueue cannot be had from PyPI.
set -euo pipefail
program=$(realpath "${1:?the program to test}")
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$root/.ci/venv.sh"
python_from 11
environment "$work/venv" hyperqueue
mkdir "$work/bin" "$work/a folder"
ln -s "$program" "$work/bin/contact-dma"
ln -s "$root/tests/hyperqueue/hq" "$work/bin/hq"
export PATH="$work/bin:$work/venv/bin:$PATH"
cd "$work/a folder"
cp "$root/tests/inputs/three.toml" .
# More shards than cases: one of them has none.
"$root/sweeps/hyperqueue/submit.sh" three.toml whole 4
contact-dma sweep three.toml --quiet --out alone
diff --recursive --exclude=run.json --exclude=records --exclude=.contact-dma.lock alone whole
# A case without a result does not keep the others from being merged.
sed 's/^\[cycle\]/&\nmax_cycles = 1\nmethod = "march"/' three.toml > short.toml
status=0
contact-dma sweep short.toml --quiet --out alone-short || status=$?
[ "$status" = 3 ]
"$root/sweeps/hyperqueue/submit.sh" short.toml whole-short 2
diff --recursive --exclude=run.json --exclude=records --exclude=.contact-dma.lock alone-short whole-short
echo "HyperQueue: as one process, byte for byte."
