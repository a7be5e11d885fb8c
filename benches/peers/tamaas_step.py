"""PMMA under a sphere, step load, in tamaas: prints one JSON line, as `cargo bench --bench pmma_step` does.

    OMP_NUM_THREADS=1 python tamaas_step.py CELLS STEPS

Rigid sphere R = 10 mm, W = 10 N for 200 s, a domain of four radii of the final contact, free space by zero padding
(operator "dcfft"), tolerance 1e-8. Stresses are in units of the long-term shear modulus: MaxwellViscoelastic (2.8.0 to
2.9.0) relaxes correctly only where that modulus is 1. Lengths in mm, forces in N.
"""

import sys
import time

import numpy as np

from tamaas_pmma import MODULI, POISSON, RADIUS, RELAXED, SHEAR, TIMES, contact_radius, hertz_radius, pmma, report

LOAD, DURATION = 10.0, 200.0


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
    exact = (0.75 * LOAD * RADIUS * (1 - POISSON**2) * creep_compliance(times)) ** (1 / 3)
    error = np.abs(np.array(radius) / exact - 1)
    report(
        cpu_s,
        cells=cells,
        steps=steps,
        largest_relative_radius_error=float(error.max()),
        mean_relative_radius_error=float(error.mean()),
    )


main()
