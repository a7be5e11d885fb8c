"""The highest load of `rough.py` on an elastic body, relaxed PMMA, in ContactMechanics: prints one JSON line.

    OMP_NUM_THREADS=1 python contactmechanics_rough.py CELLS periodic|free
"""

import json
import resource
import sys
import time

import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace, PeriodicFFTElasticHalfSpace
from ContactMechanics.Systems import NonSmoothContactSystem
from SurfaceTopography import Topography

from rough_surface import POISSON, RELAXED, SIDE, TOLERANCE, heights, loads


def main():
    cells, kind = int(sys.argv[1]), sys.argv[2]
    surface, load = heights(cells, kind), loads(cells, kind).max()
    halfspace = PeriodicFFTElasticHalfSpace if kind == "periodic" else FreeFFTElasticHalfSpace
    started, clock = time.process_time(), time.perf_counter()
    substrate = halfspace((cells, cells), RELAXED / (1 - POISSON**2), (SIDE, SIDE))
    topography = Topography(surface, (SIDE, SIDE), periodic=kind == "periodic")
    system = NonSmoothContactSystem(substrate=substrate, surface=topography)
    result = system.minimize_proxy(external_force=load, pentol=TOLERANCE * np.ptp(surface), maxiter=20000)
    report = {
        "cpu_s": round(time.process_time() - started, 3),
        "wall_s": round(time.perf_counter() - clock, 3),
        "converged": bool(result.success),
        "iterations": int(result.nit),
        "contact_part": float((result.jac[:cells, :cells] > 0).mean()),
        "peak_mib": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1),
    }
    print(json.dumps(report))


main()
