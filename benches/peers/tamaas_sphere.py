"""One elastic contact of a rigid sphere in tamaas: prints one JSON line, as `cargo bench --bench elastic_sphere` does.

    OMP_NUM_THREADS=1 python tamaas_sphere.py CELLS

E = 1973 MPa, Poisson ratio 0.38, R = 10 mm, W = 10 N, a domain of four contact radii, free space by zero padding (operator
"dcfft"), tolerance 1e-8, no guess. Lengths in mm, forces in N.
"""

import json
import resource
import sys
import time

import numpy as np
import tamaas as tm

RADIUS, LOAD, POISSON, MODULUS = 10.0, 10.0, 0.38, 1973.0


def main():
    cells = int(sys.argv[1])
    tm.set_log_level(tm.LogLevel.error)
    exact = (0.75 * LOAD * RADIUS * (1 - POISSON**2) / MODULUS) ** (1 / 3)
    side = 4 * exact
    started = time.process_time()
    model = tm.Model(tm.model_type.basic_2d, [side, side], [cells, cells])
    model.nu, model.E = POISSON, MODULUS
    x = (np.arange(cells) - cells // 2) * side / cells
    surface = np.ascontiguousarray(-(x[:, None] ** 2 + x[None, :] ** 2) / (2 * RADIUS))
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(model, surface, 1e-8, tm.PolonskyKeerRey.pressure, tm.PolonskyKeerRey.pressure)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 5000
    solver.solve(LOAD / side**2)
    cpu_s = time.process_time() - started
    radius = np.sqrt((model.traction > 0).sum() * (side / cells) ** 2 / np.pi)
    report = {
        "cells": cells,
        "cpu_s": round(cpu_s, 3),
        "relative_radius_error": abs(float(radius) / exact - 1),
        "peak_mib": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1),
    }
    print(json.dumps(report))


main()
