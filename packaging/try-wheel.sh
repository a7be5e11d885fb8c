#!/usr/bin/env bash
# Whether a wheel is what a user needs: packaging/try-wheel.sh WHEEL. It is audited, installed into an environment that has neither Rust
# nor this repository, and draws the energy loss of PMMA from Python and by the program, all in less than a minute.
set -euo pipefail
wheel=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
cd "$(dirname "$0")/.."
. packaging/tools.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
case "$wheel" in
    *manylinux*) auditwheel show "$wheel" | tee "$work/audit"; grep --quiet 'manylinux_2_17_x86_64\|manylinux2014' "$work/audit" ;;
esac
python3 - "$wheel" "$HOME" "$PWD" << 'EOF'
import os, sys, zipfile
wheel, *paths = sys.argv[1:]
size, archive = os.path.getsize(wheel) / 1e6, zipfile.ZipFile(wheel)
names = archive.namelist()
print(f"{os.path.basename(wheel)}: {size:.1f} MB")
assert size < 12, "the wheel is larger than 12 MB"
assert any(n.endswith("py.typed") for n in names) and any(n.endswith(".pyi") for n in names), names
licences = {os.path.basename(n) for n in names if "licenses/" in n}
assert licences >= {"LICENSE-MIT", "LICENSE-APACHE", "LICENSE-DejaVu.txt", "THIRD-PARTY-NOTICES.txt"}, names
assert not any(n.endswith((".ttf", ".otf")) for n in names), names
# Where it was built is nobody's business.
for name in names:
    content = archive.read(name)
    for path in paths:
        assert path == "/" or os.fsencode(path + "/") not in content, f"{name} names {path}"
EOF
python3 -m venv "$work/venv"
begin=$(date +%s)
clean=(env -u CARGO_HOME -u RUSTUP_HOME "HOME=$work" "PATH=$work/venv/bin:/usr/bin:/bin" MPLBACKEND=Agg)
cp sweeps/pmma.toml "$work"
cd "$work"
! "${clean[@]}" sh -c 'command -v cargo' || { echo "The environment is not clean."; exit 1; }
"${clean[@]}" pip install --quiet --disable-pip-version-check "$wheel" matplotlib
"${clean[@]}" contact-dma sweep pmma.toml --quiet --out pmma
"${clean[@]}" python - << 'EOF'
import numpy as np
import contact_dma as cd

w = np.logspace(-4, 0, 41)
result = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), mean="10 N", amplitude="5 N", angular_frequency=w)
result.plot().figure.savefig("matplotlib.png")
result.figure("energy-loss").save("figure.png")
assert abs(result.peaks[0].angular_frequency / 0.00844 - 1) < 1e-3
# The program and the module are one, and the folder of the one is read by the other.
assert np.allclose(cd.read("pmma")["energy_loss_j"], result["energy_loss_j"], rtol=1e-9, atol=0)
EOF
"${clean[@]}" python -m contact_dma cite pmma > cited
grep --quiet Spinu cited
for picture in matplotlib.png figure.png pmma/figures/energy-loss.png; do
    [ "$(head -c 4 "$picture" | tail -c 3)" = PNG ] || { echo "$picture is no picture."; exit 1; }
done
seconds=$(($(date +%s) - begin))
echo "Installed and drawn from Python and by the program in $seconds s."
[ "$seconds" -lt 60 ]
