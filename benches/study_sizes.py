"""Time, memory and disk of a case in studies of 10 to 100,000 of them, as a table and, where matplotlib is, drawn.

    python3 benches/study_sizes.py PROGRAM OUT [LARGEST]

writes OUT.csv and OUT.svg. PROGRAM is a release build; nothing else may run on the machine.
"""

import csv
import json
import os
import resource
import subprocess
import sys
import tempfile
import time

FILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "sweeps", "pmma.toml")
COLUMNS = ["cases", "seconds", "ms_per_case", "foretold_seconds", "peak_memory_mb", "kb_per_case"]


def measured(program, folder, cases):
    frequencies = 10 if cases < 1000 else 100
    amplitudes = cases // frequencies
    study = [FILE, "--set", f'sweep.angular_frequency={{ from = "1e-3 rad/s", to = "1 rad/s", points = {frequencies}, spacing = "log" }}']
    if amplitudes > 1:
        study += ["--set", f'sweep.drive.amplitude={{ from = "0.05 N", to = "9.95 N", points = {amplitudes} }}']
    out = os.path.join(folder, str(cases))
    plan = json.loads(subprocess.run([program, "plan", *study, "--format", "json"], check=True, capture_output=True).stdout)
    threads = os.cpu_count()
    foretold = (plan["time_on_one_thread_s"] + plan["time_of_peaks_s"]) / threads + plan["time_of_figures_s"]
    seconds = timed([program, "sweep", *study, "--quiet", "--out", out])
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3
    sizes = [os.path.getsize(os.path.join(f, name)) for f, _, names in os.walk(out) for name in names]
    return [cases, seconds, 1e3 * seconds / cases, foretold, memory, sum(sizes) / cases / 1e3]


def timed(command):
    begin = time.perf_counter()
    subprocess.run(command, check=True)
    return time.perf_counter() - begin


def draw(rows, path):
    try:
        import matplotlib
    except ImportError:
        print("matplotlib is not here: not drawn")
        return
    matplotlib.use("svg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.0, 3.6), layout="constrained")
    cases = [row[0] for row in rows]
    axes.loglog(cases, [row[2] for row in rows], "o-", label="measured")
    axes.loglog(cases, [1e3 * row[3] / row[0] for row in rows], "s--", label="foretold by plan")
    axes.set_xlabel("cases in the study")
    axes.set_ylabel("time per case / ms")
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(path, metadata={"Date": None})


def main():
    program, out = os.path.abspath(sys.argv[1]), sys.argv[2]
    largest = int(sys.argv[3]) if len(sys.argv) > 3 else 100_000
    rows = []
    with open(out + ".csv", "w", newline="") as table:
        writer = csv.writer(table)
        writer.writerow(COLUMNS)
        for cases in [10, 100, 1_000, 10_000, 100_000]:
            if cases > largest:
                break
            with tempfile.TemporaryDirectory() as folder:
                rows.append(measured(program, folder, cases))
            row = [rows[-1][0], *(f"{value:.4g}" for value in rows[-1][1:])]
            writer.writerow(row)
            print(*row, sep=",", flush=True)
    draw(rows, out + ".svg")


if __name__ == "__main__":
    main()
