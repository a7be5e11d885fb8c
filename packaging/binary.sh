#!/usr/bin/env bash
# The program with completions, manual pages and licences as an archive, and its checksum: packaging/binary.sh FOLDER [TARGET]
# On Linux it needs glibc from 2.17 on, and nothing else. The same sources give the same bytes in any folder.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(realpath -m "${1:?the folder for the archive}")
host=$(rustc -vV | sed -n 's/^host: //p')
target=${2:-$host}
. packaging/tools.sh
. packaging/flags.sh
folder=${CARGO_TARGET_DIR:-target}/$target/dist
case "$target" in
    *-linux-gnu) cargo zigbuild --quiet --locked --profile dist --target "$target.2.17" ;;
    *-linux-*) cargo zigbuild --quiet --locked --profile dist --target "$target" ;;
    *) cargo build --quiet --locked --profile dist --target "$target" ;;
esac
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
name=contact-dma-$version-$target
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/$name/completions" "$out"
suffix=$(case "$target" in *windows*) echo .exe ;; esac)
program=$work/$name/contact-dma$suffix
cp "$folder/contact-dma$suffix" "$program"
cp README.md CHANGELOG.md CITATION.cff LICENSE-MIT LICENSE-APACHE THIRD-PARTY-NOTICES.txt src/report/fonts/LICENSE-*.txt "$work/$name"
# Made by the program itself, where this machine can run it.
if [ "$target" = "$host" ]; then
    "$program" man "$work/$name/man/man1" > /dev/null
    for shell in bash zsh fish powershell elvish; do
        "$program" completions "$shell" > "$work/$name/completions/contact-dma.$shell"
    done
fi
# In the order of names, of one date and of nobody.
(cd "$work" && find "$name" -type f | LC_ALL=C sort > files
    tar --create --format=ustar --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" --mode=u+rw,go+r,go-w --files-from=files |
        gzip --no-name --best > "$out/$name.tar.gz")
cd "$out"
sha256sum "$name.tar.gz" > "$name.tar.gz.sha256"
cat "$name.tar.gz.sha256"
