#!/usr/bin/env bash
# Drives the pages in a real browser. Where the browser or the packages cannot be had it says so and ends with 77: the tests in
# Rust hold the pages to everything that takes no browser.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$PWD/target/browser
here=$PWD/tests/browser
mkdir -p "$work"

skip() {
    echo "browser tests not run: $1"
    exit 77
}

command -v node >/dev/null && command -v npm >/dev/null || skip "no node and npm here"
chromium=$(command -v chromium || command -v chromium-browser || true)
if [ -z "$chromium" ]; then
    { apt-get update && apt-get install -y --no-install-recommends chromium; } >"$work/apt.log" 2>&1 || skip "no chromium, and apt-get gives none (target/browser/apt.log)"
    chromium=$(command -v chromium) || skip "no chromium"
fi
cp "$here/package.json" "$here/package-lock.json" "$here"/*.mjs "$here/htmlvalidate.json" "$work/"
(cd "$work" && npm ci --no-audit --no-fund) >"$work/npm.log" 2>&1 || skip "npm gives no packages (target/browser/npm.log)"

# The program to try, or else one built here.
program=$PWD/${1:-target/debug/contact-dma}
[ $# -gt 0 ] || cargo build --quiet
pages=()
for input in "$here"/*.toml; do
    name=$(basename "$input" .toml)
    rm -rf "${work:?}/$name"
    command=sweep
    grep -q '^\[sweep\]' "$input" || command=simulate
    # Code 3: some cases have no result, which is what one of the inputs is for.
    "$program" "$command" "$input" --quiet --out "$work/$name" || [ $? = 3 ]
    pages+=("$name")
done
rm -rf "$work"/{material,fit,compare,compare-other,coarse}
"$program" material show pmma --out "$work/material" >/dev/null
"$program" material fit sweeps/tabulated-creep.csv --quantity creep --modulus shear --poisson-ratio 0.4 --out "$work/fit" >/dev/null
"$program" sweep "$here/sixty.toml" --quiet --set cycle.steps=100 --out "$work/coarse"
"$program" compare "$work/sixty" "$work/coarse" --quiet --out "$work/compare"
# Code 4: these differ, in their cases and in their drives.
"$program" compare "$work/two-axes" "$work/missing" --quiet --out "$work/compare-other" || [ $? = 4 ]
# What `reproduce` writes takes minutes; a test in Rust holds the committed page to it, byte for byte.
mkdir -p "$work/reproduce"
cp reports/spinu-2018/index.html reports/spinu-2018/claims.csv "$work/reproduce/"
pages+=(material fit compare compare-other reproduce)

cd "$work"
for name in "${pages[@]}"; do
    npx --no-install html-validate --config htmlvalidate.json "$name/index.html"
    echo "html-validate: $name/index.html passes"
done
CHROMIUM=$chromium PROGRAM=$program PAGES="${pages[*]}" node --test --test-reporter=spec drive.mjs
