"""PMMA under a sphere, W = 10 N + 5 N sin(0.01 rad/s t), in tamaas: prints one JSON line, as `cargo bench --bench pmma_cycle` does.

    OMP_NUM_THREADS=1 python tamaas_cycle.py CELLS STEPS [CYCLES]

Rigid sphere R = 10 mm, a domain of four radii of the largest contact, free space by zero padding (operator "dcfft"), tolerance
1e-8. There is no loop area here: tamaas moves its displacement to where the gap closes, so that the approach of a
viscoelastic contact under load control is not to be had from it. Stresses are in units of the long-term shear modulus:
MaxwellViscoelastic (2.8.0 to 2.9.0) relaxes correctly only where that modulus is 1. Lengths in mm, forces in N.
"""

import sys
import time

import numpy as np

from tamaas_pmma import SHEAR, hertz_radius, pmma, report

LOAD, AMPLITUDE, OMEGA = 10.0, 5.0, 0.01


def main():
    numbers = [int(a) for a in sys.argv[1:]]
    cells, steps, cycles = (numbers + [4])[:3]
    step_s = 2 * np.pi / OMEGA / steps
    load = LOAD + AMPLITUDE * np.sin(OMEGA * step_s * np.arange(1, steps * cycles + 1))
    side = 4 * hertz_radius(load.max())
    started = time.process_time()
    _, solver = pmma(cells, side, step_s)
    for value in load:
        solver.solve(value / side**2 / SHEAR)
    report(time.process_time() - started, cells=cells, steps=steps, cycles=cycles)


main()
