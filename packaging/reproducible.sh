#!/usr/bin/env bash
# Whether the archive of packaging/binary.sh is the same, byte for byte, when it is built in two clones in folders of different names.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/tools.sh
export TOOLS=$tools
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Both of one commit, whatever is committed meanwhile.
for folder in one another/folder; do
    git clone --quiet . "$work/$folder"
done
for folder in one another/folder; do
    (unset CARGO_TARGET_DIR; "$work/$folder/packaging/binary.sh" "$work/$folder/made")
done
cmp "$work"/one/made/*.tar.gz "$work"/another/folder/made/*.tar.gz
echo "Both builds gave the same bytes."
