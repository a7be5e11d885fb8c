"""PMMA under a sphere, step load, in tamaas: prints one JSON line, as `cargo bench --bench pmma_step` does.

    OMP_NUM_THREADS=1 python tamaas_step.py CELLS STEPS

Rigid sphere R = 10 mm, W = 10 N for 200 s, a domain of four radii of the final contact, free space by zero padding
(operator "dcfft"), tolerance 1e-8. Stresses are in units of the long-term shear modulus: MaxwellViscoelastic (2.8.0 to
2.9.0) relaxes correctly only where that modulus is 1. Lengths in mm, forces in N.
"""

import sys
import time

import numpy as np

from tamaas_pmma import POISSON, RADIUS, SHEAR, contact_radius, creep_branches, hertz_radius, pmma, report

LOAD, DURATION = 10.0, 200.0


def main():
    cells, steps = int(sys.argv[1]), int(sys.argv[2])
    step_s = DURATION / steps
    side = 4 * hertz_radius(LOAD)
    started = time.process_time()
    model, solver = pmma(cells, side, step_s)
    radius = []
    for _ in range(steps):
        solver.solve(LOAD / side**2 / SHEAR)
        radius.append(contact_radius(model, side, cells))
    cpu_s = time.process_time() - started
    times = step_s * np.arange(1, steps + 1)
    relaxed, branches = creep_branches()
    compliance = relaxed - sum(c * np.exp(-times / t) for c, t in branches)
    exact = (0.75 * LOAD * RADIUS * (1 - POISSON**2) * compliance) ** (1 / 3)
    error = np.abs(np.array(radius) / exact - 1)
    report(
        cpu_s,
        cells=cells,
        steps=steps,
        largest_relative_radius_error=float(error.max()),
        mean_relative_radius_error=float(error.mean()),
    )


main()
