#!/usr/bin/env bash
# The source distribution of the Python package, and whether a wheel can be built of it: packaging/sdist.sh FOLDER
set -euo pipefail
mkdir -p "${1:?the folder for the archive}"
out=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
. packaging/tools.sh
maturin sdist --manifest-path python/Cargo.toml --out "$out"
archive=("$out"/contact_dma-*.tar.gz)
# Everything that a build asks for is in it: no crate of the workspace is looked for outside.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tar --extract --gzip --file "${archive[0]}" --directory "$work"
(cd "$work"/contact_dma-*/ && cargo metadata --locked --format-version 1 > /dev/null)
echo "${archive[0]}"
