# Sourced by what packs a release: a build whose bytes do not depend on where it is made. No path of this machine goes into it.
root=$(pwd)
cargo_home=${CARGO_HOME:-$HOME/.cargo}
flags=("--remap-path-prefix=$root=/contact-dma" "--remap-path-prefix=$cargo_home=/cargo" "--remap-path-prefix=$HOME=/home")
CARGO_ENCODED_RUSTFLAGS=$(IFS=$'\x1f'; echo "${flags[*]}")
export CARGO_ENCODED_RUSTFLAGS CARGO_INCREMENTAL=0
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2> /dev/null || echo 315532800)}
export SOURCE_DATE_EPOCH
