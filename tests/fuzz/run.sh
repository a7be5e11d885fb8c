#!/usr/bin/env bash
# Fuzzes one target: tests/fuzz/run.sh TARGET [SECONDS] [FLAGS OF LIBFUZZER...]
set -euo pipefail
cd "$(dirname "$0")/../.."
target=$1
seconds=${2:-600}
shift "$(($# < 2 ? $# : 2))"
mkdir -p "tests/fuzz/corpus/$target" "tests/fuzz/seeds/$target"
# Instrumentation takes a flag that the stable toolchain hides.
RUSTC_BOOTSTRAP=1 exec cargo fuzz run --fuzz-dir tests/fuzz --sanitizer "${SANITIZER:-none}" "$target" \
    "tests/fuzz/corpus/$target" "tests/fuzz/seeds/$target" -- \
    -max_total_time="$seconds" -rss_limit_mb=4096 -timeout=20 -dict=tests/fuzz/words.txt -print_final_stats=1 "$@"
