#!/usr/bin/env python3
"""Rough viscoelastic contact in this program and its peers: a table and a figure anyone can make again.

    python3 benches/peers/rough.py [--cells 256,512,1024,2048] [--peer-cells 256,512] [--kinds periodic,refined,free] [--draw]

What is pressed is told in `rough_surface.py`. Every run is a process of its own, and its row is appended to
reports/performance/rough-surfaces.csv when it ends; rows that are there are not run again. `--draw` draws what there is. Virtual environments
are made under target/peers the first time.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import run
from run import HERE, MATPLOTLIB, PEERS, ROOT, python_of

OUT = ROOT / "reports" / "performance"
TABLE = OUT / "rough-surfaces.csv"
COLUMNS = (
    "program kind cells threads instants wall_s cpu_s microseconds_per_cell_and_instant peak_mib iterations contact_part energy_loss_j"
).split()
OURS = "contact-dma"
TAMAAS, CONTACT_MECHANICS = PEERS
# What `rough_surface.py` knows, and what the figure calls it.
KINDS = {"periodic": "one period", "refined": "one period, the same waves", "free": "free space"}

# Run where NumPy is: the scenario of this program, and what its folder says.
WRITE = """
import sys, json, numpy as np
sys.path.insert(0, sys.argv[1])
from rough_surface import *
cells, kind, folder = int(sys.argv[2]), sys.argv[3], sys.argv[4]
np.save(folder + "/map.npy", heights(cells, kind).astype("<f8"))
mean, omega = float(mean_load(cells, kind)), 2 * np.pi / PERIOD_S
edge = "unknown" if kind == "free" else "periodic"
open(folder + "/rough.toml", "w").write(f'''title = "rough"
[material]
library = "pmma"
[indenter]
shape = "height-map"
file = "map.npy"
spacing = "{SIDE / cells!r} mm"
height_unit = "mm"
edge = "{edge}"
[drive]
segments = [{{ kind = "sine", mean = "{mean!r} N", amplitude = "{mean / 2!r} N", angular_frequency = "{omega!r} rad/s", cycles = 1 }}]
[time]
step = "{PERIOD_S / STEPS} s"
[output]
fields_at = ["{PERIOD_S / 4} s"]
error_bars = false
[solver]
tolerance = {TOLERANCE}
''')
"""


def ours(program, cells, kind, threads):
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        subprocess.run([python_of(PEERS[TAMAAS]), "-c", WRITE, HERE, str(cells), kind, folder], check=True)
        command = [program, "simulate", "rough.toml", "--out", "out", "--quiet", "--no-figures", "--threads", str(threads)]
        clock = time.perf_counter()
        process = subprocess.Popen(command, cwd=folder)
        _, status, usage = os.wait4(process.pid, 0)
        wall_s = time.perf_counter() - clock
        if status:
            sys.exit(f"{command} failed")
        out = Path(folder, "out")
        rows = list(csv.DictReader(open(out / "history.csv")))
        field = next(csv.DictReader(open(out / "cases" / "fields" / "index.csv")))
        number = lambda name: [float(row[name]) for row in rows]
        load, approach = number("load_n"), number("approach_m")
        loss = sum(
            0.5 * (a + b) * (d - c) for a, b, c, d in zip(load, load[1:], approach, approach[1:])
        )
        return {
            "instants": len(rows),
            "wall_s": round(wall_s, 3),
            "cpu_s": round(usage.ru_utime + usage.ru_stime, 3),
            "peak_mib": round(usage.ru_maxrss / 1024, 1),
            "iterations": json.load(open(out / "summary.json"))["iterations"],
            "contact_part": float(field["contact_fraction"]),
            "energy_loss_j": loss,
        }


def peer(name, script, instants):
    def measured(cells, kind):
        found = run.last_line([python_of(PEERS[name]), str(HERE / script), str(cells), kind])
        if not found.pop("converged"):
            print(f"{name}, {kind}, {cells}: not converged", file=sys.stderr)
            return None
        return {"instants": instants, **found}

    return measured


def rows_there():
    return list(csv.DictReader(open(TABLE))) if TABLE.exists() else []


def measure(program, kind, cells, threads, measured):
    key = [program, kind, str(cells), str(threads)]
    if any([row[name] for name in ("program", "kind", "cells", "threads")] == key for row in rows_there()):
        return
    found = measured()
    if found is None:
        return
    each = 1e6 * found["wall_s"] / (cells**2 * found["instants"])
    row = dict(zip(COLUMNS, key)) | found | {"microseconds_per_cell_and_instant": round(each, 3)}
    is_new = not TABLE.exists()
    with open(TABLE, "a", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        if is_new:
            writer.writeheader()
        writer.writerow(row)
    print(row, flush=True)


DRAW = """
import csv, json, sys
import matplotlib; matplotlib.use("agg")
import matplotlib.pyplot as plt
rows = list(csv.DictReader(open(sys.argv[1])))
kinds = json.loads(sys.argv[3])
figure, frames = plt.subplots(1, len(kinds), figsize=(11, 3.6), sharey=True, layout="constrained")
marks = iter("os^v")
styles = {}
for frame, (kind, title) in zip(frames, kinds.items()):
    series = {}
    for row in rows:
        if row["kind"] == kind:
            name = row["program"] + (f", {row['threads']} threads" if row["threads"] != "1" else "")
            series.setdefault(name, []).append((int(row["cells"]), float(row["microseconds_per_cell_and_instant"])))
    for name, points in series.items():
        if name not in styles:
            styles[name] = dict(marker=next(marks), color=f"C{len(styles)}")
        frame.loglog(*zip(*sorted(points)), label=name, **styles[name])
    frame.set(title=title, xlabel="cells per side")
    ticks = sorted({int(row["cells"]) for row in rows})
    frame.set_xticks(ticks, ticks)
    frame.minorticks_off()
    frame.grid(alpha=0.3)
frames[0].set_ylabel("time per cell and instant / \\u00b5s")
frames[0].legend(fontsize=8)
for ending in ("svg", "png"):
    figure.savefig(sys.argv[2] + "." + ending, dpi=200)
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    sizes = lambda text: [int(part) for part in text.split(",") if part]
    parser.add_argument("--cells", type=sizes, default=[256, 512, 1024, 2048])
    parser.add_argument("--peer-cells", type=sizes, default=[256, 512])
    parser.add_argument("--kinds", type=lambda text: text.split(","), default=list(KINDS))
    parser.add_argument("--threads", type=sizes, default=[1, os.cpu_count()])
    parser.add_argument("--program", default=ROOT / "target" / "release" / "contact-dma")
    parser.add_argument("--draw", action="store_true")
    options = parser.parse_args()
    subprocess.run(["cargo", "build", "--release"], cwd=ROOT, check=True)
    for cells in options.cells:
        for kind in options.kinds:
            for threads in options.threads:
                measure(OURS, kind, cells, threads, lambda: ours(options.program, cells, kind, threads))
            if cells in options.peer_cells and kind != "refined":
                for name, script, instants in [
                    (CONTACT_MECHANICS, "contactmechanics_rough.py", 1),
                    (TAMAAS, "tamaas_rough.py", 21),
                ]:
                    measure(name, kind, cells, 1, lambda: peer(name, script, instants)(cells, kind))
    if options.draw:
        subprocess.run([python_of(MATPLOTLIB), "-c", DRAW, TABLE, OUT / "rough-surfaces", json.dumps(KINDS)], check=True)


if __name__ == "__main__":
    main()
