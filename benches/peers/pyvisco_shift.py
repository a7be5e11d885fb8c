#!/usr/bin/env python3
"""Shift factors of pyvisco beside those of this program, for the same file, with wall times.

    python3 -m venv target/peers/pyvisco
    target/peers/pyvisco/bin/pip install pyvisco
    target/peers/pyvisco/bin/python benches/peers/pyvisco_shift.py [PROGRAM]

Both shift the isotherms of sweeps/pyvisco-freq-user-raw.csv, which comes from pyvisco, to 25 °C. pyvisco names an isotherm by its rounded
temperature, this program by the mean of its points. PROGRAM is by default what `cargo build --release` makes. Its time is that of the
whole command, with series, files and figures; that of pyvisco counts after its imports, for the reading of the file and the shift
factors alone.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile
import time

from pyvisco import load, master

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "sweeps" / "pyvisco-freq-user-raw.csv"
REFERENCE_C = 25


def of_pyvisco():
    """Temperatures (°C) and log10 a_T, and the seconds they took."""
    started = time.perf_counter()
    raw, _, _ = load.user_raw(DATA.read_bytes(), "freq", "E")
    shifts, _ = master.get_aT(raw, REFERENCE_C)
    return list(zip(shifts["T"], shifts["log_aT"])), time.perf_counter() - started


def of_program(program):
    """The rows of shift.csv, and the seconds of the command."""
    command = [program, "material", "fit", DATA, "--quantity", "dynamic", "--modulus", "longitudinal"]
    command += ["--reference-temperature", f"{REFERENCE_C} °C", "--out"]
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        subprocess.run([*command, folder], check=True, stdout=subprocess.DEVNULL)
        seconds = time.perf_counter() - started
        with open(pathlib.Path(folder) / "shift.csv", newline="", encoding="utf-8") as table:
            return list(csv.DictReader(table)), seconds


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "target" / "release" / "contact-dma"
    theirs, their_s = of_pyvisco()
    ours, our_s = of_program(program)
    print(f"{'T / °C':>8}  {'pyvisco':>9}  {'here':>9}  {'error':>8}  {'difference':>10}")
    for row in ours:
        celsius, own = float(row["temperature_c"]), float(row["log10_a_t"])
        _, other = min(theirs, key=lambda pair: abs(pair[0] - celsius))
        print(f"{celsius:8.2f}  {other:9.4f}  {own:9.4f}  {row['log10_a_t_error'][:8]:>8}  {own - other:10.4f}")
    print(f"pyvisco: {their_s:.2f} s for file and shift factors; here: {our_s:.2f} s for the whole command")


if __name__ == "__main__":
    main()
