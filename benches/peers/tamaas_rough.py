"""The work of `rough.py` in tamaas: prints one JSON line.

    OMP_NUM_THREADS=1 python tamaas_rough.py CELLS periodic|free

The approach is made from what tamaas tells: of a period the highest point less the mean displacement; in free space, where tamaas moves
its displacement to where the gap closes, as in `tamaas_cycle.py`, at the highest point.
"""

import sys
import time

import numpy as np
import tamaas as tm

from rough_surface import POISSON, RELAXED, SIDE, STEPS, PERIOD_S, TOLERANCE, heights, loads, loss_j
from tamaas_cycle import hereditary, influence_at
from tamaas_pmma import MODULI, SHEAR, TIMES, in_free_space, report


def main():
    cells, kind = int(sys.argv[1]), sys.argv[2]
    surface, load = np.ascontiguousarray(heights(cells, kind)), loads(cells, kind)
    tm.set_log_level(tm.LogLevel.error)
    model = tm.Model(tm.model_type.basic_2d, [SIDE, SIDE], [cells, cells])
    model.nu, model.E = POISSON, RELAXED / SHEAR
    step_s = PERIOD_S / STEPS
    moduli = [modulus / (2 * (1 + POISSON)) / SHEAR for modulus in MODULI]
    if kind == "free":
        tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.MaxwellViscoelastic(
        model, surface, TOLERANCE, time_step=step_s, shear_moduli=moduli, characteristic_times=TIMES
    )
    solver.max_iter = 20000
    if kind == "free":
        in_free_space(solver)
        solver.max_iter = 20000
    apex = np.unravel_index(surface.argmax(), surface.shape)
    influence = influence_at(cells, SIDE, apex)
    displaced, residuals, touching = [], [], 0.0
    started, clock = time.process_time(), time.perf_counter()
    for k, value in enumerate(load):
        residuals.append(solver.solve(value / SIDE**2 / SHEAR))
        if kind == "periodic":
            displaced.append(float(surface.max() - model.displacement.mean()))
        else:
            displaced.append(float((influence * model.traction).sum()) * SHEAR)
        if k == STEPS // 4:
            touching = float((model.traction > 0).mean())
    cpu_s, wall_s = time.process_time() - started, time.perf_counter() - clock
    approach = np.array(displaced)
    if kind == "free":
        approach = (1 - POISSON**2) * hereditary(approach, step_s)
    converged = max(residuals) <= TOLERANCE
    report(
        cpu_s, wall_s=round(wall_s, 3), converged=converged, contact_part=touching, energy_loss_j=loss_j(load, approach)
    )


main()
