#!/usr/bin/env python3
"""Measures this program's half-space engine against cells, steps and error, and draws what reports/performance shows.

    python3 benches/peers/measure.py

One thread, CPU time. Writes tables (CSV) and figures (SVG, PNG) into reports/performance; matplotlib goes into a virtual
environment under target/peers the first time.
"""

import argparse
import csv
import functools
import json
import math
import subprocess
import sys

import run
from run import HERE, MATPLOTLIB, PEERS, ROOT, last_line, loss_error, python_of

OUT = ROOT / "reports" / "performance"


def least(rounds, name, runs):
    """Of every one of these runs the one that took the least time. They take turns: what else the machine does, and how fast it
    is at the time, falls on all of them."""
    found = [[bench(name, *arguments) for arguments in runs] for _ in range(rounds)]
    return [min(column, key=lambda result: result["cpu_s"]) for column in zip(*found)]


def told(command):
    """What a program prints last, shown on the way."""
    found = last_line(list(map(str, command)))
    print(json.dumps(found), file=sys.stderr, flush=True)
    return found


built = functools.cache(run.bench)


def bench(name, *arguments):
    return told([built(name), *arguments])


def tamaas(script, cells, steps):
    return told([python_of(PEERS["tamaas 2.9.0"]), HERE / script, cells, steps])


def table(name, rows):
    with open(OUT / name, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def cells():
    rows = least(7, "pmma_step", [(n, 200) for n in (64, 128, 256, 512, 1024)])
    cost = lambda row: row["cpu_s"] / (row["cells"] ** 2 * math.log2(row["cells"]))
    for row in rows:
        row["growth_over_n2_log_n"] = round(cost(row) / cost(rows[0]), 2)
    table("against-cells.csv", rows)


def steps():
    table("against-steps.csv", least(5, "pmma_step", [(256, n) for n in (50, 100, 200, 500, 1000, 2000)]))


def loop_area():
    counts = {"linear": (16, 32, 48, 64, 80, 100, 200), "constant": (50, 100, 200, 400)}
    runs = [(256, n, rule) for rule in counts for n in counts[rule]]
    found = least(2, "pmma_cycle", runs)
    rows = [{"rule": rule, **result} for (_, _, rule), result in zip(runs, found)]
    exact_j = rows[0]["exact_loss_j"]
    theirs = tamaas("tamaas_cycle.py", 256, 100)
    error = float(f"{loss_error(theirs, exact_j):.3g}")
    rows.append({"rule": "tamaas 2.9.0", **theirs, "exact_loss_j": exact_j, "relative_loss_error": error})
    table("error-against-time.csv", rows)


def radius():
    programs = {
        "this program": least(3, "pmma_step", [(n, 200) for n in (64, 128, 256)]),
        "the paper's rule": least(3, "pmma_step", [(n, 200, "constant") for n in (64, 128, 256)]),
        "tamaas 2.9.0": [tamaas("tamaas_step.py", n, 200) for n in (64, 128, 256)],
    }
    keys = ("cells", "steps", "cpu_s", "mean_relative_radius_error")
    rows = [{"program": name, **{key: found[key] for key in keys}} for name in programs for found in programs[name]]
    table("radius-against-time.csv", rows)


def late():
    table("late-steps.csv", [bench("long_history", n) for n in (64, 128, 256)])


MEASUREMENTS = {measure.__name__: measure for measure in (cells, steps, loop_area, radius, late)}


def read(name):
    with open(OUT / name, newline="") as file:
        return list(csv.DictReader(file))


def draw():
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "contact-dma", "svg.fonttype": "none", "font.size": 9, "axes.grid": True,
                                "grid.alpha": 0.3, "figure.constrained_layout.use": True})
    from matplotlib import pyplot

    def figure(name, x, y):
        picture, axes = pyplot.subplots(figsize=(4.6, 3.2))
        axes.set(xlabel=x, ylabel=y, xscale="log", yscale="log")
        return picture, axes

    def save(picture, name):
        picture.savefig(OUT / f"{name}.svg", metadata={"Date": None})
        picture.savefig(OUT / f"{name}.png", dpi=150, metadata={"Software": None})

    rows = read("against-cells.csv")
    n = [int(row["cells"]) for row in rows]
    step_ms = [1e3 * float(row["cpu_s"]) / int(row["steps"]) for row in rows]
    picture, axes = figure("against-cells", "cells per side $N$", "CPU time per step / ms")
    axes.plot(n, step_ms, "o-", label="step load, 200 steps")
    scale = step_ms[1] / (n[1] ** 2 * math.log2(n[1]))
    axes.plot(n, [scale * k**2 * math.log2(k) for k in n], "--", color="0.5", label="$N^2 \\log N$")
    axes.set_xticks(n, [str(k) for k in n])
    axes.minorticks_off()
    axes.legend()
    save(picture, "against-cells")

    rows = read("against-steps.csv")
    picture, axes = figure("against-steps", "steps", "CPU time / s")
    axes.plot([int(r["steps"]) for r in rows], [float(r["cpu_s"]) for r in rows], "o-", label="step load, 256 × 256 cells")
    axes.legend()
    save(picture, "against-steps")

    rows = read("error-against-time.csv")
    picture, axes = figure("error-against-time", "CPU time / s", "relative error of the loop area")
    for rule, mark, label in (
        ("linear", "o-", "this program"),
        ("constant", "s--", "the paper's rule, marching"),
        ("tamaas 2.9.0", "^", "tamaas 2.9.0, four cycles of 100 steps"),
    ):
        own = [row for row in rows if row["rule"] == rule]
        axes.plot([float(r["cpu_s"]) for r in own], [float(r["relative_loss_error"]) for r in own], mark, label=label)
    axes.legend()
    save(picture, "error-against-time")

    rows = read("radius-against-time.csv")
    picture, axes = figure("radius-against-time", "CPU time / s", "mean relative error of the contact radius")
    for program, mark in (("this program", "o-"), ("the paper's rule", "s--"), ("tamaas 2.9.0", "^:")):
        own = [row for row in rows if row["program"] == program]
        errors = [float(row["mean_relative_radius_error"]) for row in own]
        axes.plot([float(row["cpu_s"]) for row in own], errors, mark, label=program)
        # The two rules of this program lie side by side: one set of numbers is enough.
        for row, error in zip(own if program != "the paper's rule" else [], errors):
            axes.annotate(row["cells"], (float(row["cpu_s"]), error), textcoords="offset points", xytext=(-4, -9), ha="right", fontsize=7)
    axes.legend()
    save(picture, "radius-against-time")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draw", action="store_true", help="only draw again what was measured")
    parser.add_argument("--only", choices=MEASUREMENTS, action="append", help="measure this alone; may be repeated")
    options = parser.parse_args()
    if options.draw:
        return draw()
    for name in options.only or MEASUREMENTS:
        MEASUREMENTS[name]()
    subprocess.run([python_of(MATPLOTLIB), __file__, "--draw"], check=True)


if __name__ == "__main__":
    main()
