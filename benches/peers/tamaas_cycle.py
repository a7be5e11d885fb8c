"""PMMA under a sphere, W = 10 N + 5 N sin(0.01 rad/s t), in tamaas: prints one JSON line, as `cargo bench --bench pmma_cycle` does.

    OMP_NUM_THREADS=1 python tamaas_cycle.py CELLS STEPS [CYCLES]

Rigid sphere R = 10 mm, a domain of four radii of the largest contact, free space by zero padding (operator "dcfft"), tolerance
1e-8. There is no loop area here: tamaas moves its displacement to where the gap closes, so that the approach of a
viscoelastic contact under load control is not to be had from it. Stresses are in units of the long-term shear modulus:
MaxwellViscoelastic (2.8.0 to 2.9.0) relaxes correctly only where that modulus is 1. Lengths in mm, forces in N.
"""

import json
import resource
import sys
import time

import numpy as np
import tamaas as tm

RADIUS, LOAD, AMPLITUDE, OMEGA, POISSON = 10.0, 10.0, 5.0, 0.01, 0.38
RELAXED, MODULI, TIMES = 1973.0, (254.776, 263.6628), (8.93, 117.96)


def main():
    numbers = [int(a) for a in sys.argv[1:]]
    cells, steps, cycles = (numbers + [4])[:3]
    tm.set_log_level(tm.LogLevel.error)
    shear = RELAXED / (2 * (1 + POISSON))
    step_s = 2 * np.pi / OMEGA / steps
    load = LOAD + AMPLITUDE * np.sin(OMEGA * step_s * np.arange(1, steps * cycles + 1))
    largest = (0.75 * load.max() * RADIUS * (1 - POISSON**2) / RELAXED) ** (1 / 3)
    side = 4 * largest
    started = time.process_time()
    model = tm.Model(tm.model_type.basic_2d, [side, side], [cells, cells])
    model.nu, model.E = POISSON, RELAXED / shear
    x = (np.arange(cells) - cells // 2) * side / cells
    surface = np.ascontiguousarray(-(x[:, None] ** 2 + x[None, :] ** 2) / (2 * RADIUS))
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    moduli = [modulus / (2 * (1 + POISSON)) / shear for modulus in MODULI]
    solver = tm.MaxwellViscoelastic(
        model, surface, 1e-8, time_step=step_s, shear_moduli=moduli, characteristic_times=TIMES
    )
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 5000
    for value in load:
        solver.solve(value / side**2 / shear)
    cpu_s = time.process_time() - started
    report = {
        "cells": cells,
        "steps": steps,
        "cycles": cycles,
        "cpu_s": round(cpu_s, 3),
        "peak_mib": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1),
    }
    print(json.dumps(report))


main()
