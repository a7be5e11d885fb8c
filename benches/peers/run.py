#!/usr/bin/env python3
"""Runs the same work in this program and in its peers, in turn, and prints a table of ratios.

    python3 benches/peers/run.py [--cells 128] [--pairs 3] [--once 256] [--once-pairs 1] [--steps 200] [--out FILE]

Makes a virtual environment per peer under target/peers the first time (needs the network), and builds the benches. CPU time
is each process's own count; pairs alternate, so that what else the machine does falls on both.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PEERS = {
    "tamaas 2.9.0": ["tamaas==2.9.0", "numpy"],
    "ContactMechanics 1.8.3": ["ContactMechanics==1.8.3"],
}
MATPLOTLIB = ["matplotlib==3.10.7"]


def python_of(packages):
    folder = ROOT / "target" / "peers" / packages[0]
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *packages], check=True)
    return str(python)


def last_line(command):
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{command} failed:\n{done.stderr}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def bench(name):
    build = ["cargo", "bench", "--no-run", "--bench", name, "--message-format", "json"]
    done = subprocess.run(build, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    messages = (json.loads(line) for line in done.stdout.splitlines())
    programs = [m["executable"] for m in messages if m.get("target", {}).get("name") == name and m.get("executable")]
    return programs[-1]


def loss_error(result, exact_j):
    return abs(result["energy_loss_j"] / exact_j - 1)


def error_of(result):
    """The error that a program reports, whichever it can."""
    names = ("mean_relative_radius_error", "relative_radius_error", "relative_loss_error")
    errors = [result[name] for name in names if name in result]
    return f"{errors[0]:.1e}" if errors else "none"


def compare(title, peer, script, ours, arguments, pairs, rows):
    """Runs pairs in turn. `arguments` are those of this program and those of the peer."""
    theirs = [python_of(PEERS[peer]), str(HERE / script)]
    results = []
    for pair in range(pairs):
        both = (last_line([ours, *arguments[0]]), last_line([*theirs, *arguments[-1]]))
        if "exact_loss_j" in both[0] and "energy_loss_j" in both[1]:
            both[1]["relative_loss_error"] = loss_error(both[1], both[0]["exact_loss_j"])
        results.append(both)
        print(f"{title}, pair {pair + 1}: {json.dumps(both)}", file=sys.stderr, flush=True)
    ratios = [theirs["cpu_s"] / ours["cpu_s"] for ours, theirs in results]
    middle = lambda side, key: statistics.median(result[side][key] for result in results)
    rows.append(
        f"| {title} | {peer} | {pairs} | {middle(0, 'cpu_s'):.3g} s | {middle(1, 'cpu_s'):.3g} s "
        f"| {statistics.median(ratios):.0f} ({min(ratios):.0f} to {max(ratios):.0f}) "
        f"| {middle(0, 'peak_mib'):.0f} / {middle(1, 'peak_mib'):.0f} MiB "
        f"| {error_of(results[0][0])} / {error_of(results[0][1])} |"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=128)
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--once", type=int, default=256, help="cells of a single, longer pair; 0 for none")
    parser.add_argument("--once-pairs", type=int, default=1, help="pairs of those")
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    step, cycle, sphere = bench("pmma_step"), bench("pmma_cycle"), bench("elastic_sphere")
    rows = [
        "| work | peer | pairs | this program, CPU | peer, CPU | ratio | peak memory, this / peer | error, this / peer |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for cells, pairs in [(options.cells, options.pairs), (options.once, options.once_pairs)]:
        if cells:
            title = f"PMMA, step load, {options.steps} steps, {cells} x {cells} cells"
            arguments = [[str(cells), str(options.steps)]]
            compare(title, "tamaas 2.9.0", "tamaas_step.py", step, arguments, pairs, rows)
    if options.once:
        title = f"PMMA, loop area at 0.01 rad/s, {options.once} x {options.once} cells"
        arguments = [[str(options.once), "80"], [str(options.once), "100", "4"]]
        compare(title, "tamaas 2.9.0", "tamaas_cycle.py", cycle, arguments, options.once_pairs, rows)
    title = "elastic sphere, 512 x 512 cells"
    for peer, script in [("ContactMechanics 1.8.3", "contactmechanics_sphere.py"), ("tamaas 2.9.0", "tamaas_sphere.py")]:
        compare(title, peer, script, sphere, [["512"]], options.pairs, rows)
    table = "\n".join(rows) + "\n"
    print(table)
    if options.out:
        options.out.write_text(table)


if __name__ == "__main__":
    main()
