"""PMMA under a sphere, step load, in tamaas: prints one JSON line, as `cargo bench --bench pmma_step` does.

    OMP_NUM_THREADS=1 python tamaas_step.py CELLS STEPS

Rigid sphere R = 10 mm, W = 10 N for 200 s, a domain of four radii of the final contact, free space by zero padding
(operator "dcfft"), tolerance 1e-8. Stresses are in units of the long-term shear modulus: MaxwellViscoelastic (2.8.0 to
2.9.0) relaxes correctly only where that modulus is 1. Lengths in mm, forces in N.
"""

import json
import resource
import sys
import time

import numpy as np
import tamaas as tm

RADIUS, LOAD, POISSON, DURATION = 10.0, 10.0, 0.38, 200.0
RELAXED, MODULI, TIMES = 1973.0, (254.776, 263.6628), (8.93, 117.96)


def creep_compliance(times):
    """D(t) (1/MPa) of the relaxation modulus: D = 1/RELAXED - sum c_j exp(-t/lambda_j), from s D(s) = 1/(s Psi(s))."""
    # s Psi(s) = RELAXED + sum g s/(s + 1/tau): its zeros are -1/lambda.
    rates = [1.0 / t for t in TIMES]
    poly = np.polynomial.Polynomial
    factors = [poly([r, 1.0]) for r in rates]
    numerator = RELAXED * factors[0] * factors[1]
    numerator += MODULI[0] * poly([0.0, 1.0]) * factors[1] + MODULI[1] * poly([0.0, 1.0]) * factors[0]
    denominator = factors[0] * factors[1]
    compliance = np.full(len(times), 1.0 / RELAXED)
    for zero in numerator.roots().real:
        residue = denominator(zero) / (zero * numerator.deriv()(zero))
        compliance += residue * np.exp(zero * np.asarray(times))
    return compliance


def main():
    cells, steps = int(sys.argv[1]), int(sys.argv[2])
    tm.set_log_level(tm.LogLevel.error)
    shear = RELAXED / (2 * (1 + POISSON))
    step_s = DURATION / steps
    final = (0.75 * LOAD * RADIUS * (1 - POISSON**2) / RELAXED) ** (1 / 3)
    side = 4 * final
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
    radius = []
    for _ in range(steps):
        solver.solve(LOAD / side**2 / shear)
        radius.append(np.sqrt((model.traction > 0).sum() * (side / cells) ** 2 / np.pi))
    cpu_s = time.process_time() - started
    times = step_s * np.arange(1, steps + 1)
    exact = (0.75 * LOAD * RADIUS * (1 - POISSON**2) * creep_compliance(times)) ** (1 / 3)
    report = {
        "cells": cells,
        "steps": steps,
        "cpu_s": round(cpu_s, 3),
        "largest_relative_radius_error": float(np.abs(np.array(radius) / exact - 1).max()),
        "mean_relative_radius_error": float(np.abs(np.array(radius) / exact - 1).mean()),
        "peak_mib": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1),
    }
    print(json.dumps(report))


main()
