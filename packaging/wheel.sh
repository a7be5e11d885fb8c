#!/usr/bin/env bash
# A wheel of the Python package with the program in it: packaging/wheel.sh FOLDER [OPTIONS OF maturin build]
# On Linux it is for every glibc from 2.17 on; packaging/wheel.sh FOLDER --target aarch64-unknown-linux-musl --zig \
#     --compatibility musllinux_1_2 is for musl on another processor, whose target rustup has to have.
set -euo pipefail
mkdir -p "${1:?the folder for the wheel}"
out=$(cd "$1" && pwd)
shift
cd "$(dirname "$0")/.."
. packaging/tools.sh
. packaging/flags.sh
if [ $# = 0 ] && [ "$(uname -s)" = Linux ]; then
    set -- --target "$(uname -m)-unknown-linux-gnu" --zig --compatibility manylinux2014
fi
maturin build --quiet --profile dist --strip --locked --manifest-path python/Cargo.toml --out "$out" "$@"
