"""PMMA under a sphere, W = 10 N + 5 N sin(0.01 rad/s t), in tamaas: prints one JSON line, as `cargo bench --bench pmma_cycle` does.

    OMP_NUM_THREADS=1 python tamaas_cycle.py CELLS STEPS [CYCLES]

Rigid sphere R = 10 mm, a domain of four radii of the largest contact, free space by zero padding (operator "dcfft"), tolerance
1e-8. tamaas moves its displacement to where the gap closes, so that it tells no approach of a viscoelastic contact under
load control. Here the approach is the displacement of the point under the apex, made from tamaas' pressures afterwards: by
Love's influence coefficients in space, and in time by the hereditary integral of a pressure that is linear between the
instants. Lengths in mm, forces in N.
"""

import sys
import time

import numpy as np

from tamaas_pmma import POISSON, SHEAR, creep_branches, hertz_radius, pmma, report

LOAD, AMPLITUDE, OMEGA = 10.0, 5.0, 0.01


def influence_at(cells, side, cell):
    """Displacement of the centre of a cell under a unit pressure on each cell, times the plane-strain modulus
    (A. E. H. Love, Philosophical Transactions A 228 (1929) 377)."""
    x, y = ((np.arange(cells + 1) - at - 0.5) * side / cells for at in cell)
    x, y = x[:, None], y[None, :]
    potential = x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))
    return (potential[1:, 1:] - potential[:-1, 1:] - potential[1:, :-1] + potential[:-1, :-1]) / np.pi


def hereditary(values, step_s):
    """The creep compliance's hereditary integral at each instant: put on at once, then linear between instants."""
    relaxed, branches = creep_branches()
    result = relaxed * values
    for compliance, time_s in branches:
        decay = np.exp(-step_s / time_s)
        # The part of the value that has not been forgotten, driven by its changes.
        lag = np.empty_like(values)
        lag[0] = values[0]
        for k in range(1, len(values)):
            lag[k] = decay * lag[k - 1] + (values[k] - values[k - 1]) * (1 - decay) * time_s / step_s
        result = result - compliance * lag
    return result


def loop_area(load, approach):
    """The integral of load over approach around one cycle, from their Fourier series."""
    w, d = np.fft.rfft(load), np.fft.rfft(approach)
    n = np.arange(len(w))
    return float(4 * np.pi / len(load) ** 2 * np.sum(n * np.imag(np.conj(d) * w)))


def main():
    numbers = [int(a) for a in sys.argv[1:]]
    cells, steps, cycles = (numbers + [4])[:3]
    step_s = 2 * np.pi / OMEGA / steps
    load = LOAD + AMPLITUDE * np.sin(OMEGA * step_s * np.arange(1, steps * cycles + 1))
    side = 4 * hertz_radius(load.max())
    influence = influence_at(cells, side, (cells // 2, cells // 2))
    started = time.process_time()
    model, solver = pmma(cells, side, step_s)
    under_apex = []
    for value in load:
        solver.solve(value / side**2 / SHEAR)
        under_apex.append(float((influence * model.traction).sum()) * SHEAR)
    cpu_s = time.process_time() - started
    approach = (1 - POISSON**2) * hereditary(np.array(under_apex), step_s)
    loss_j = 1e-3 * loop_area(load[-steps:], approach[-steps:])
    report(cpu_s, cells=cells, steps=steps, cycles=cycles, energy_loss_j=loss_j)


if __name__ == "__main__":
    main()
