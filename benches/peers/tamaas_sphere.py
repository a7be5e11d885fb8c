"""One elastic contact of a rigid sphere in tamaas: prints one JSON line, as `cargo bench --bench elastic_sphere` does.

    OMP_NUM_THREADS=1 python tamaas_sphere.py CELLS

E = 1973 MPa, Poisson ratio 0.38, R = 10 mm, W = 10 N, a domain of four contact radii, free space by zero padding (operator
"dcfft"), tolerance 1e-8, no guess. Lengths in mm, forces in N.
"""

import sys
import time

import tamaas as tm

from tamaas_pmma import RELAXED, TOLERANCE, contact_radius, hertz_radius, in_free_space, report, sphere

LOAD = 10.0


def main():
    cells = int(sys.argv[1])
    exact = hertz_radius(LOAD)
    side = 4 * exact
    started = time.process_time()
    model, surface = sphere(cells, side, RELAXED)
    pressure = tm.PolonskyKeerRey.pressure
    solver = in_free_space(tm.PolonskyKeerRey(model, surface, TOLERANCE, pressure, pressure))
    solver.solve(LOAD / side**2)
    cpu_s = time.process_time() - started
    radius = contact_radius(model, side, cells)
    report(cpu_s, cells=cells, relative_radius_error=abs(radius / exact - 1))


main()
