"""A periodic rough surface of 512 x 512 points on an elastic body, at five loads: contact area and elastic energy of this program
(`simulate`, edge = "periodic") beside those of tamaas, with the CPU time of each.

    python tamaas_rough.py PROGRAM [CELLS]

Wants numpy and tamaas (pip install tamaas==2.9.0). Both are given the same heights, tolerance 1e-8, and one thread.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np
import tamaas as tm

SIDE, MODULUS, POISSON = 1e-3, 3e9, 0.4
# Nominal pressure over E* times the root mean square slope.
SHARES = (0.005, 0.02, 0.08, 0.3, 0.8)


def surface(cells):
    """Self-affine heights (m): Hurst exponent 0.8 between wavelengths of 4 and 64 to the side, root mean square slope 0.1."""
    rng = np.random.default_rng(5)
    k = np.fft.fftfreq(cells, 1 / cells)
    q = np.hypot(*np.meshgrid(k, k))
    inside = (q >= 4) & (q <= cells / 8)
    amplitude = np.where(inside, np.where(q > 0, q, 1.0) ** -1.8, 0.0)
    heights = np.fft.ifft2(np.fft.fft2(rng.standard_normal((cells, cells))) * amplitude).real
    spectrum = np.fft.fft2(heights)
    wave = 2 * np.pi * q / SIDE
    slope = np.sqrt(np.sum(np.abs(spectrum * wave) ** 2)) / cells**2
    return heights * 0.1 / slope


def in_tamaas(heights, pressure):
    """Contact part, elastic energy (J), CPU time (s)."""
    tm.set_log_level(tm.LogLevel.error)
    cells = len(heights)
    model = tm.Model(tm.model_type.basic_2d, [SIDE, SIDE], [cells, cells])
    model.E, model.nu = MODULUS, POISSON
    solver = tm.PolonskyKeerRey(model, heights, 1e-8)
    solver.max_iter = 20000
    start = time.process_time()
    solver.solve(pressure)
    spent = time.process_time() - start
    traction, displacement = model.traction, model.displacement
    u = displacement - displacement.mean()
    return np.mean(traction > 0), 0.5 * np.sum(traction * u) * (SIDE / cells) ** 2, spent


def here(program, heights, pressures):
    """The same of this program, and the CPU time (s) of all loads together."""
    cells = len(heights)
    with tempfile.TemporaryDirectory() as folder:
        np.save(Path(folder) / "map.npy", heights)
        steps = "\n".join(f'    {{ kind = "step", to = {p * SIDE**2!r}, duration = "1 s" }},' for p in pressures)
        file = Path(folder) / "rough.toml"
        file.write_text(f"""title = "rough"
[material]
elastic = {{ modulus = {MODULUS!r}, poisson_ratio = {POISSON} }}
[indenter]
shape = "height-map"
file = "map.npy"
spacing = {SIDE / cells!r}
height_unit = "m"
edge = "periodic"
[drive]
segments = [
{steps}
]
[time]
step = "1 s"
[output]
fields_at = {[k + 0.5 for k in range(len(pressures))]}
error_bars = false
[solver]
tolerance = 1e-8
""")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        command = [program, "simulate", str(file), "--out", f"{folder}/out", "--quiet", "--no-figures", "--threads", "1"]
        subprocess.run(command, check=True)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        found = []
        for k in range(len(pressures)):
            field = lambda name: np.load(Path(folder, "out", "fields", f"{k}-{name}.npy"))
            p, u = field("pressure_pa"), field("displacement_m")
            found.append((np.mean(p > 0), 0.5 * np.sum(p * u) * (SIDE / cells) ** 2))
        return found, spent


def main():
    program = sys.argv[1]
    heights = surface(int(sys.argv[2]) if len(sys.argv) > 2 else 512)
    stiffness = MODULUS / (1 - POISSON**2)
    pressures = [share * 0.1 * stiffness for share in SHARES]
    ours, spent = here(program, heights, pressures)
    total = 0.0
    print("pressure / (E* h')   area here   area tamaas   energy here / J   energy tamaas / J")
    for share, pressure, (area, energy) in zip(SHARES, pressures, ours):
        their_area, their_energy, their_time = in_tamaas(heights, pressure)
        total += their_time
        print(f"{share:18g} {area:11.5f} {their_area:13.5f} {energy:17.6e} {their_energy:19.6e}")
    print(f"CPU time of all five: {spent:.2f} s here, files included; {total:.2f} s in tamaas")


if __name__ == "__main__":
    main()
