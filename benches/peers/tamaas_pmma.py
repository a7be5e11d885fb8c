"""What the tamaas scripts share: the sphere on PMMA, and the solver of its contact. Lengths in mm, forces in N, moduli in MPa.

Stresses are in units of the long-term shear modulus: MaxwellViscoelastic (2.8.0 to 2.9.0) relaxes correctly only where that
modulus is 1.
"""

import json
import resource

import numpy as np
import tamaas as tm

RADIUS, POISSON = 10.0, 0.38
RELAXED, MODULI, TIMES = 1973.0, (254.776, 263.6628), (8.93, 117.96)
SHEAR = RELAXED / (2 * (1 + POISSON))
TOLERANCE = 1e-8


def hertz_radius(load):
    """Contact radius under this load when all has relaxed."""
    return (0.75 * load * RADIUS * (1 - POISSON**2) / RELAXED) ** (1 / 3)


def sphere(cells, side, modulus):
    """Model and surface of the sphere on a body of this modulus, in free space by zero padding."""
    tm.set_log_level(tm.LogLevel.error)
    model = tm.Model(tm.model_type.basic_2d, [side, side], [cells, cells])
    model.nu, model.E = POISSON, modulus
    x = (np.arange(cells) - cells // 2) * side / cells
    surface = np.ascontiguousarray(-(x[:, None] ** 2 + x[None, :] ** 2) / (2 * RADIUS))
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    return model, surface


def in_free_space(solver):
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 5000
    return solver


def pmma(cells, side, step_s):
    """Model and solver of steps of this length."""
    model, surface = sphere(cells, side, RELAXED / SHEAR)
    moduli = [modulus / (2 * (1 + POISSON)) / SHEAR for modulus in MODULI]
    solver = tm.MaxwellViscoelastic(
        model, surface, TOLERANCE, time_step=step_s, shear_moduli=moduli, characteristic_times=TIMES
    )
    return model, in_free_space(solver)


def creep_branches():
    """Relaxed compliance 1/RELAXED (1/MPa) and pairs of branch compliance and retardation time (s) of the creep compliance
    D(t) = 1/RELAXED - sum c exp(-t/t_c), from s D(s) = 1/(s Psi(s))."""
    # s Psi(s) = RELAXED + sum g s/(s + 1/tau): its zeros are -1/t_c.
    poly = np.polynomial.Polynomial
    factors = [poly([1.0 / t, 1.0]) for t in TIMES]
    denominator = factors[0] * factors[1]
    numerator = RELAXED * denominator
    numerator += MODULI[0] * poly([0.0, 1.0]) * factors[1] + MODULI[1] * poly([0.0, 1.0]) * factors[0]
    zeros = numerator.roots().real
    return 1.0 / RELAXED, [(-denominator(z) / (z * numerator.deriv()(z)), -1.0 / z) for z in zeros]


def contact_radius(model, side, cells):
    return float(np.sqrt((model.traction > 0).sum() * (side / cells) ** 2 / np.pi))


def report(cpu_s, **found):
    """Prints the JSON line."""
    peak_mib = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1)
    print(json.dumps({"cpu_s": round(cpu_s, 3), **found, "peak_mib": peak_mib}))
