#!/usr/bin/env bash
# Writes the stubs of the compiled module, contact_dma/_contact_dma.pyi, from what PyO3 knows of it; with --check only compares them.
# python/stubs.sh [--check] [OPTIONS OF maturin generate-stubs]. Wants maturin on the path.
set -euo pipefail
cd "$(dirname "$0")"
check=false
if [ "${1:-}" = --check ]; then
    check=true
    shift
fi
written=contact_dma/_contact_dma.pyi
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
maturin generate-stubs --quiet --features stubs --out "$made" "$@"
# Arrays of NumPy are the only types that PyO3 does not know; the class of a constructor that it makes of fields it calls self. What is a
# number of a number is an array of an array.
{
    echo "# Written by python/stubs.sh from the compiled module."
    echo "from numpy import complex128, float64"
    echo "from numpy.typing import ArrayLike, NDArray"
    echo "from typing import overload"
    echo "from ._toml import Quantity"
    echo "from .materials import ModulusKind"
    sed 's/^from _typeshed import Incomplete, /from _typeshed import /; s/\bIncomplete\b/NDArray[float64]/g; s/__new__(self/__new__(cls/' "$made/$written" |
        sed -E 's/^( *)(def .*: )"ArrayLike"(, .*) -> "(complex|float)":/\1@overload\n\1\2Quantity\3 -> \4: ...  # type: ignore[overload-overlap]\n\1@overload\n\1\2ArrayLike\3 -> NDArray[\4128]:/; s/\[float128\]/[float64]/'
} > "$made/stubs.pyi"
if $check; then
    diff -u "$written" "$made/stubs.pyi" || { echo "$written is not what the module has: run python/stubs.sh"; exit 1; }
else
    cp "$made/stubs.pyi" "$written"
fi
