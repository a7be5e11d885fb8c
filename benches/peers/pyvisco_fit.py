#!/usr/bin/env python3
"""From a file of isotherms to a Prony series, by pyvisco and by this program: shift factors, the fit, WLF constants, wall times.

    python3 -m venv target/peers/pyvisco
    target/peers/pyvisco/bin/pip install pyvisco
    target/peers/pyvisco/bin/python benches/peers/pyvisco_fit.py [PROGRAM]

Both shift the isotherms of sweeps/pyvisco-freq-user-raw.csv, which comes from pyvisco, to 25 °C and fit a series to the master curve.
pyvisco names an isotherm by its rounded temperature, this program by the mean of its points. PROGRAM is by default what
`cargo build --release` makes. Its time is that of the whole command, with files, figures and page; that of pyvisco counts after its
imports, for numbers alone. Either fit is held to the points of its own master curve: the root mean square of (fit / point - 1).
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from pyvisco import load, master, opt, prony, shift

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "sweeps" / "pyvisco-freq-user-raw.csv"
REFERENCE_C = 25


def misfit(points, fit):
    """Root mean square of the relative difference, in percent."""
    return 100 * np.sqrt(np.mean((np.asarray(fit) / np.asarray(points) - 1) ** 2))


def of_series(omega, equilibrium, moduli, times):
    """E' and E'' of a Prony series at angular frequencies (rad/s)."""
    x = np.multiply.outer(omega, times)
    return equilibrium + (moduli * x**2 / (1 + x**2)).sum(axis=1), (moduli * x / (1 + x**2)).sum(axis=1)


def of_pyvisco():
    """Shift factors, what is to be printed of each series, and of WLF."""
    started = time.perf_counter()
    raw, _, _ = load.user_raw(DATA.read_bytes(), "freq", "E")
    shifts, _ = master.get_aT(raw, REFERENCE_C)
    shifted_s = time.perf_counter() - started
    curve = master.smooth(master.get_curve(raw, shifts, REFERENCE_C), 1)
    wlf = shift.fit_WLF(REFERENCE_C, shifts)
    series, _ = prony.fit(prony.discretize(curve), curve)
    fitted_s = time.perf_counter() - started
    fewer, best, _ = opt.nprony(curve, series)
    reduced_s = time.perf_counter() - started

    def told(name, one, seconds):
        terms = one["df_terms"]
        moduli = terms["E_i"].to_numpy()
        fit = of_series(curve["omega"].to_numpy(), one["E_0"] - moduli.sum(), moduli, terms["tau_i"].to_numpy())
        misfits = [misfit(curve[column], values) for column, values in zip(("E_stor", "E_loss"), fit)]
        return name, len(terms), *misfits, seconds

    rows = [told("pyvisco, a branch a decade", series, fitted_s), told("pyvisco, fewer branches", fewer[best], reduced_s)]
    return list(zip(shifts["T"], shifts["log_aT"])), shifted_s, rows, (wlf["C1"].iloc[0], wlf["C2"].iloc[0])


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def of_program(program):
    """The rows of shift.csv, what is to be printed of the series, and of WLF."""
    command = [program, "material", "fit", DATA, "--quantity", "dynamic", "--modulus", "longitudinal"]
    command += ["--reference-temperature", f"{REFERENCE_C} °C", "--out"]
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        subprocess.run([*command, folder], check=True, stdout=subprocess.DEVNULL)
        seconds = time.perf_counter() - started
        folder = pathlib.Path(folder)
        points = rows_of(folder / "master.csv")
        branches = len(rows_of(folder / "prony.csv")) - 1
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        shifts = rows_of(folder / "shift.csv")
    column = {name: [float(point[name]) for point in points] for name in points[0] if points[0][name]}
    misfits = [misfit(column[f"{part}_modulus_pa"], column[f"{part}_fit_pa"]) for part in ("storage", "loss")]
    return shifts, ("this program", branches, *misfits, seconds), summary


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "target" / "release" / "contact-dma"
    theirs, shifted_s, rows, (c1, c2) = of_pyvisco()
    ours, row, summary = of_program(program)
    print(f"{'T / °C':>8}  {'pyvisco':>9}  {'here':>9}  {'error':>8}  {'difference':>10}")
    for own in ours:
        celsius, shifted, error = (float(own[name]) for name in ("temperature_c", "log10_a_t", "log10_a_t_error"))
        _, other = min(theirs, key=lambda pair: abs(pair[0] - celsius))
        print(f"{celsius:8.2f}  {other:9.4f}  {shifted:9.4f}  {error:8.3f}  {shifted - other:10.4f}")
    print(f"\npyvisco takes {shifted_s:.2f} s for file and shift factors")
    print(f"{'':<28}{'branches':>8}{'misfit E′ / %':>15}{'misfit E″ / %':>15}{'time / s':>10}")
    for name, branches, storage, loss, seconds in [*rows, row]:
        print(f"{name:<28}{branches:>8}{storage:>15.2f}{loss:>15.2f}{seconds:>10.2f}")
    own = summary["wlf"]
    print(f"WLF at {REFERENCE_C} °C: pyvisco C1 = {c1:.0f}, C2 = {c2:.0f} K, C1/C2 = {c1 / c2:.4f} / K;")
    print(f"  here {own['c1']:.0f} ± {own['c1_error']:.0f}, {own['c2_k']:.0f} ± {own['c2_error_k']:.0f} K, {own['c1'] / own['c2_k']:.4f} / K")


if __name__ == "__main__":
    main()
