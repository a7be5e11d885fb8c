#!/usr/bin/env bash
# The Python package: its wheel into a virtual environment of its own, and the tests against that.
# python/tests/run.sh PROGRAM [WHEEL]. Without a wheel one is built as the tests are, which users' are the same as but for speed.
# Exits with 77, and says why, where there is no Python of 3.10 or later, or no PyPI.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${1:-target/debug/contact-dma}")
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export TMPDIR="$work"
. .ci/venv.sh
python_from 10
environment "$work/venv" maturin numpy pandas pandas-stubs pytest mypy matplotlib joblib distributed tqdm types-tqdm joblib-stubs pint \
    astropy xarray nbclient nbformat ipykernel
python="$work/venv/bin/python"
for name in LICENSE-MIT LICENSE-APACHE src/report/fonts/LICENSE-*.txt; do
    cmp "$name" "python/licenses/$(basename "$name")"
done
export CARGO_TARGET_DIR="$target" PATH="$work/venv/bin:$PATH"
# The profile of the tests of the crate, whose dependencies are built already.
python/stubs.sh --check --profile dev --interpreter "$python"
if [ $# -lt 2 ]; then
    # With what the stubs are written from, so that one build does for both.
    maturin build --quiet --strip --profile dev --features stubs --manifest-path python/Cargo.toml --interpreter "$python" --out "$work/wheels"
    set -- "$program" "$work"/wheels/*.whl
else
    # A wheel of a release has the program of that release, whose folders name its commit.
    program=$work/venv/bin/contact-dma
fi
"$python" -m pip install --quiet --disable-pip-version-check --no-deps "$2"
# Away from the sources, so that what is tested is what was installed.
cp -r python/tests "$work/tests"
export CONTACT_DMA_PROGRAM="$program" CONTACT_DMA_ROOT="$PWD"
cd "$work"
"$python" -m pytest -q -p no:cacheprovider "$work/tests"
"$python" -m pytest -q -p no:cacheprovider --doctest-modules --pyargs contact_dma
