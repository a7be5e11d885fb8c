#!/usr/bin/env bash
# Time, memory and disk of a case in studies of 10 to 100,000 of them, as a table: benches/study_sizes.sh PROGRAM [LARGEST].
# Nothing else may run on the machine. PROGRAM is a release build.
set -euo pipefail
program=$(realpath "${1:?the program to time}")
largest=${2:-100000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "cases,seconds,milliseconds_per_case,peak_memory_mb,disk_kb_per_case,foretold_seconds"
for cases in 10 100 1000 10000 100000; do
    [ "$cases" -le "$largest" ] || break
    # As many amplitudes as frequencies, or ten times as many.
    frequencies=$((cases < 1000 ? 10 : 100))
    amplitudes=$((cases / frequencies))
    axis=""
    [ "$amplitudes" = 1 ] || axis="drive.amplitude = { from = \"0.05 N\", to = \"9.95 N\", points = $amplitudes }"
    cat > "$work/study.toml" << TOML
title = "$cases cases"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
mean = "10 N"
amplitude = "5 N"
[sweep]
angular_frequency = { from = "1e-3 rad/s", to = "1 rad/s", points = $frequencies, spacing = "log" }
$axis
TOML
    foretold=$("$program" plan "$work/study.toml" --format json | python3 -c 'import json, sys; print(json.load(sys.stdin)["wall_s"])')
    python3 - "$program" "$work" "$cases" "$foretold" << 'PYTHON'
import os, resource, subprocess, sys, time
program, work, cases, foretold = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4]
out = f"{work}/{cases}"
begin = time.perf_counter()
subprocess.run([program, "sweep", f"{work}/study.toml", "--quiet", "--out", out], check=True)
seconds = time.perf_counter() - begin
memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3
disk = sum(os.path.getsize(os.path.join(f, n)) for f, _, names in os.walk(out) for n in names)
print(f"{cases},{seconds:.2f},{1e3 * seconds / cases:.2f},{memory:.0f},{disk / cases / 1e3:.1f},{float(foretold):.1f}", flush=True)
PYTHON
    rm -rf "${work:?}/$cases"
done
