#!/usr/bin/env bash
# A sweep by the rules of Snakemake is the sweep of one process, byte for byte: tests/snakemake/run.sh PROGRAM
# Ends with 77 where Snakemake cannot be had from PyPI.
set -euo pipefail
program=$(realpath "${1:?the program to test}")
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$root/.ci/venv.sh"
python_from 11
environment "$work/venv" snakemake
mkdir "$work/bin" "$work/a folder"
ln -s "$program" "$work/bin/contact-dma"
export PATH="$work/bin:$work/venv/bin:$PATH" XDG_CACHE_HOME="$work/cache"
cd "$work/a folder"
cp "$root/tests/inputs/three.toml" .
run() { snakemake --snakefile "$root/sweeps/snakemake/Snakefile" --cores 2 "$@" > log 2>&1 || { cat log; exit 1; }; }
run --config sweep=three.toml shards=2 out=whole
contact-dma sweep three.toml --quiet --out alone
same=(diff --recursive --exclude=run.json --exclude=records --exclude=.contact-dma.lock)
"${same[@]}" alone whole
# What is there is not made again, and what is lost is.
touch marker
run --config sweep=three.toml shards=2 out=whole
[ ! whole/index.html -nt marker ]
rm -r whole.parts/2-of-2 whole.parts/2-of-2.done whole/summary.json whole/index.html
run --config sweep=three.toml shards=2 out=whole
"${same[@]}" alone whole
# As many shards as the plan names.
run --config sweep=three.toml out=planned
"${same[@]}" alone planned
echo "Snakemake: as one process, byte for byte."
