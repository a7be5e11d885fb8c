"""One elastic contact from no guess in ContactMechanics: prints one JSON line, as `cargo bench --bench elastic_sphere` does.

    OMP_NUM_THREADS=1 python contactmechanics_sphere.py CELLS

Rigid sphere R = 10 mm, W = 10 N, E = 1973 MPa, Poisson ratio 0.38, a domain of four contact radii, free space by zero
padding, the penetration tolerance 1e-8 of the approach. SI units.
"""

import json
import resource
import sys
import time

import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace
from ContactMechanics.Systems import NonSmoothContactSystem
from SurfaceTopography import make_sphere

RADIUS, LOAD, MODULUS = 0.01, 10.0, 1.973e9 / (1 - 0.38**2)


def main():
    cells = int(sys.argv[1])
    exact = (0.75 * LOAD * RADIUS / MODULUS) ** (1 / 3)
    side = 4 * exact
    started = time.process_time()
    substrate = FreeFFTElasticHalfSpace((cells, cells), MODULUS, (side, side))
    surface = make_sphere(RADIUS, (cells, cells), (side, side))
    system = NonSmoothContactSystem(substrate=substrate, surface=surface)
    approach = exact**2 / RADIUS
    result = system.minimize_proxy(external_force=LOAD, pentol=1e-8 * approach)
    cpu_s = time.process_time() - started
    radius = np.sqrt((result.jac > 0).sum() * (side / cells) ** 2 / np.pi)
    report = {
        "cells": cells,
        "cpu_s": round(cpu_s, 3),
        "converged": bool(result.success),
        "iterations": int(result.nit),
        # The offset is counted from the sphere's highest sample, half a cell from its summit where their number is even.
        "relative_radius_error": abs(float(radius) / exact - 1),
        "peak_mib": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1),
    }
    print(json.dumps(report))


main()
