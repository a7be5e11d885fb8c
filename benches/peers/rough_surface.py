"""The work of `rough.py`: one rough surface at any number of cells, pressed into PMMA through one cycle of its load. Lengths in mm, forces
in N, moduli in MPa.

Self-affine heights of Hurst exponent 0.8, wavelengths from 8 cells to a quarter of the side of 1 mm, root mean square slope 0.05, of random
phases that do not depend on the cells; `free` adds a paraboloid so that the contact stays inside. `refined` has the waves of the period of
256 x 256 cells, the same on all: what grows with them is then the resolution alone, not the roughness. The load is
F (1 + sin(omega t) / 2) from t = 0 on, one period in 20 steps.
"""

import numpy as np

SIDE, SLOPE, STEPS, PERIOD_S = 1.0, 0.05, 20, 60.0
POISSON, RELAXED = 0.38, 1973.0
TOLERANCE = 1e-8
# The mean pressure of a period over E* times the slope, and the contact radius of the smooth paraboloid over the side.
SHARE, RADIUS = 0.1, 0.25


def heights(cells, kind):
    """Heights (mm), one row per y, highest where contact begins."""
    highest = (256 if kind == "refined" else cells) // 8
    k = np.arange(-highest, highest + 1)
    q = np.hypot(*np.meshgrid(k, k))
    inside = (q >= 1) & (q <= highest)
    # Of each wave its own generator would be slow: shells of growing size, each appended to those before.
    phase = np.zeros(q.shape)
    rng, shell = np.random.default_rng(5), np.maximum(*np.abs(np.meshgrid(k, k)))
    for size in range(1, highest + 1):
        at = shell == size
        phase[at] = rng.uniform(0, 2 * np.pi, at.sum())
    spectrum = np.zeros((cells, cells), complex)
    waves = np.where(inside, np.maximum(q, 4.0) ** -1.8, 0.0) * np.exp(1j * phase)
    spectrum[np.ix_(k % cells, k % cells)] = waves
    rough = np.fft.ifft2(spectrum).real
    across = [(np.roll(rough, -1, axis) - rough) * cells / SIDE for axis in (0, 1)]
    rough *= SLOPE / np.sqrt(np.mean(across[0] ** 2 + across[1] ** 2))
    if kind == "free":
        x = (np.arange(cells) + 0.5) * SIDE / cells - SIDE / 2
        rough -= (x[:, None] ** 2 + x[None, :] ** 2) / (2 * curvature_radius(rough))
    return rough


def curvature_radius(rough):
    """Of the paraboloid, which goes down by four times the roughness within the contact."""
    return (RADIUS * SIDE) ** 2 / (4 * rough.std())


def mean_load(cells, kind):
    """F (N)."""
    modulus = RELAXED / (1 - POISSON**2)
    if kind != "free":
        return SHARE * modulus * SLOPE * SIDE**2
    rough = heights(cells, "periodic")
    return 4 / 3 * modulus * (RADIUS * SIDE) ** 3 / curvature_radius(rough)


def loads(cells, kind):
    """At every instant (N)."""
    return mean_load(cells, kind) * (1 + 0.5 * np.sin(2 * np.pi * np.arange(STEPS + 1) / STEPS))


def loss_j(load, approach):
    """The integral of load (N) over approach (mm) along the cycle."""
    return 1e-3 * float(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(approach)))
