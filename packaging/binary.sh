#!/usr/bin/env bash
# The program with completions, manual pages and licences as an archive, and its checksum: packaging/binary.sh FOLDER [TARGET]
# On Linux it needs glibc from 2.17 on, and nothing else. The same sources give the same bytes in any folder.
set -euo pipefail
mkdir -p "${1:?the folder for the archive}"
out=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
target=${2:-$(rustc -vV | sed -n 's/^host: //p')}
. packaging/tools.sh
. packaging/flags.sh
built=${CARGO_TARGET_DIR:-target}
case "$target" in
    *-linux-gnu) cargo zigbuild --quiet --locked --profile dist --target "$target.2.17" ;;
    *-linux-*) cargo zigbuild --quiet --locked --profile dist --target "$target" ;;
    *) cargo build --quiet --locked --profile dist --target "$target" ;;
esac
name=contact-dma-$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)-$target
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/$name/completions"
suffix=$(case "$target" in *windows*) echo .exe ;; esac)
program=$work/$name/contact-dma$suffix
cp "$built/$target/dist/contact-dma$suffix" "$program"
cp README.md CHANGELOG.md CITATION.cff LICENSE-MIT LICENSE-APACHE THIRD-PARTY-NOTICES.txt src/report/fonts/LICENSE-*.txt "$work/$name"
# What a program for another machine would print is printed by one for this machine.
if ! "$program" --version > /dev/null 2>&1; then
    cargo build --quiet --locked
    program=$built/debug/contact-dma
fi
"$program" man "$work/$name/man/man1" > /dev/null
for shell in bash zsh fish powershell elvish; do
    "$program" completions "$shell" > "$work/$name/completions/contact-dma.$shell"
done
python3 packaging/archive.py "$work/$name" "$out/$name.tar.gz" "$SOURCE_DATE_EPOCH"
