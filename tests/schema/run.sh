#!/usr/bin/env bash
# Holds every example against the printed schemas, and CITATION.cff against its own, with check-jsonschema: tests/schema/run.sh PROGRAM.
# Ends with 77 where that validator cannot be had.
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
validator=$(command -v check-jsonschema || true)
if [ -z "$validator" ]; then
    # TOML is read by the library of Python from 3.11 on, and by tomli before.
    python3 -m venv "$folder/venv" >/dev/null 2>&1 || exit 77
    timeout 300 "$folder/venv/bin/pip" install --quiet check-jsonschema tomli >/dev/null 2>&1 || exit 77
    validator=$folder/venv/bin/check-jsonschema
fi
for kind in sweep scenario identify; do
    "$program" schema --kind "$kind" >"$folder/$kind.json"
    mapfile -t files < <(grep -rl --include='*.toml' "^#:schema .*schema/$kind.json" sweeps)
    [ "${#files[@]}" -gt 0 ]
    "$validator" --schemafile "$folder/$kind.json" "${files[@]}"
done
"$validator" --builtin-schema vendor.citation-file-format CITATION.cff
# And it refuses what is wrong.
sed 's/^radius = .*/radius = "10 N"/' sweeps/pmma.toml >"$folder/wrong.toml"
if "$validator" --schemafile "$folder/sweep.json" "$folder/wrong.toml" >/dev/null; then
    echo "A radius of 10 N validates." >&2
    exit 1
fi
