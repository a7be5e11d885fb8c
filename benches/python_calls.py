"""What a call from Python costs beyond its solution, in cases that could be solved meanwhile: python benches/python_calls.py."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import contact_dma as cd

PMMA, SPHERE = cd.Material.library("pmma"), cd.Sphere("10 mm")


def shortest_s(omega: list[float], calls: int) -> float:
    options: dict[str, Any] = {"mean": 10.0, "amplitude": 5.0, "angular_frequency": omega, "springs": 16, "steps": 16}
    times = []
    for _ in range(calls):
        started = time.perf_counter()
        cd.sweep(PMMA, SPHERE, threads=1, error_bars=False, **options)
        times.append(time.perf_counter() - started)
    return min(times)


# Cases that differ by a hundredth of a per cent cost the same, and their curve has no peak.
one, many = shortest_s([1e-2], 1000), shortest_s(np.linspace(1e-2, 1.0001e-2, 101).tolist(), 20)
case = (many - one) / 100
print(f"one call {1e3 * one:.3f} ms, a case of 16 springs and 16 steps {1e3 * case:.3f} ms: beyond its solution a call costs {one / case - 1:.1f} cases")
