"""PMMA under a sphere, W = 10 N + 5 N sin(0.01 rad/s t), in tamaas: prints one JSON line, as `cargo bench --bench pmma_cycle` does.

    OMP_NUM_THREADS=1 python tamaas_cycle.py CELLS STEPS [CYCLES] [EXACT_LOSS_J]

Rigid sphere R = 10 mm, a domain of four radii of the largest contact, free space by zero padding (operator "dcfft"), tolerance
1e-8. tamaas gives no approach under load control; here it is the mean of gap and displacement over the contact, and the loop
area is that of the polygon through the last cycle, corrected for its chords. Stresses are in units of the long-term shear
modulus: MaxwellViscoelastic (2.8.0 to 2.9.0) relaxes correctly only where that modulus is 1. Lengths in mm, forces in N.
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
    numbers = [float(a) for a in sys.argv[1:]] + [None] * 4
    cells, steps, cycles = int(numbers[0]), int(numbers[1]), int(numbers[2] or 4)
    exact = numbers[3]
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
    approach = []
    for value in load:
        solver.solve(value / side**2 / shear)
        contact = model.traction > 0
        approach.append((model.displacement[contact] - surface[contact]).mean())
    cpu_s = time.process_time() - started
    # The last cycle, closed; N/2pi sin(2pi/N) is what the chords of a polygon leave of an ellipse.
    delta, force = np.array(approach[-steps - 1 :]), load[-steps - 1 :]
    area = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(delta))
    loss = area / (steps / (2 * np.pi) * np.sin(2 * np.pi / steps)) * 1e-3
    report = {
        "cells": cells,
        "steps": steps,
        "cycles": cycles,
        "cpu_s": round(cpu_s, 3),
        "energy_loss_j": float(loss),
        "relative_loss_error": abs(loss / exact - 1) if exact else None,
        "peak_mib": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1),
    }
    print(json.dumps(report))


main()
