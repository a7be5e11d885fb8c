#!/usr/bin/env bash
# The Python package: its wheel into a virtual environment of its own, and the tests against that.
# python/tests/run.sh PROGRAM. Exits with 77, and says why, where there is no Python of 3.10 or later, or no PyPI.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${1:-target/debug/contact-dma}")
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export TMPDIR="$work"
if ! python3 -c 'import sys, venv; sys.exit(sys.version_info < (3, 10))' 2> /dev/null; then
    echo "There is no Python of version 3.10 or later with venv."
    exit 77
fi
python3 -m venv "$work/venv" || { echo "No virtual environment can be made."; exit 77; }
python="$work/venv/bin/python"
if ! "$python" -m pip install --quiet --disable-pip-version-check --retries 1 \
    maturin numpy pandas pandas-stubs pytest mypy matplotlib joblib distributed tqdm types-tqdm joblib-stubs pint astropy xarray; then
    echo "Packages cannot be installed from PyPI."
    exit 77
fi
cmp LICENSE-MIT python/licenses/LICENSE-MIT
cmp LICENSE-APACHE python/licenses/LICENSE-APACHE
cmp src/report/fonts/LICENSE-DejaVu.txt python/licenses/LICENSE-DejaVu.txt
# The profile of the tests of the crate, whose dependencies are built already; the wheel that users build is the same but for speed.
(
    export CARGO_TARGET_DIR="$target" PATH="$work/venv/bin:$PATH"
    # With what the stubs are written from, so that one build does for both.
    maturin build --quiet --strip --profile dev --features stubs --manifest-path python/Cargo.toml \
        --interpreter "$python" --out "$work/wheels"
    python/stubs.sh --check --profile dev --interpreter "$python"
)
wheel=("$work"/wheels/*.whl)
"$python" -m pip install --quiet --disable-pip-version-check --no-deps "${wheel[0]}"
"$python" - "${wheel[0]}" << 'EOF'
import os, sys, zipfile
size = os.path.getsize(sys.argv[1]) / 1e6
names = zipfile.ZipFile(sys.argv[1]).namelist()
print(f"{os.path.basename(sys.argv[1])}: {size:.1f} MB")
assert size < 12, "the wheel is larger than 12 MB"
assert any(n.endswith("py.typed") for n in names) and any(n.endswith(".pyi") for n in names), names
assert {os.path.basename(n) for n in names if "licenses/" in n} >= {"LICENSE-MIT", "LICENSE-APACHE", "LICENSE-DejaVu.txt"}, names
assert not any(n.endswith((".ttf", ".otf")) for n in names), names
EOF
# Away from the sources, so that what is tested is what was installed.
cp -r python/tests "$work/tests"
export CONTACT_DMA_PROGRAM="$program" CONTACT_DMA_ROOT="$PWD"
cd "$work"
"$python" -m pytest -q -p no:cacheprovider "$work/tests"
"$python" -m pytest -q -p no:cacheprovider --doctest-modules --pyargs contact_dma
