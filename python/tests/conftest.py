"""What tests share: a small sweep, and the program to compare with."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import contact_dma as cd

ROOT = Path(os.environ.get("CONTACT_DMA_ROOT", Path(__file__).resolve().parents[2]))


def small_sweep(**changes: object) -> cd.SweepResult:
    """PMMA under a sphere at five frequencies around the peak, coarse."""
    options = {
        "mean": 10.0,
        "amplitude": 5.0,
        "angular_frequency": np.logspace(-3, -1, 5),
        "springs": 32,
        "steps": 32,
        "title": "PMMA",
    }
    result = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), **{**options, **changes})  # type: ignore[arg-type]
    assert isinstance(result, cd.SweepResult)
    return result


@pytest.fixture(scope="session")
def result() -> cd.SweepResult:
    return small_sweep()


@pytest.fixture(scope="session")
def program() -> str:
    """The program of the same sources."""
    path = os.environ.get("CONTACT_DMA_PROGRAM", str(ROOT / "target/debug/contact-dma"))
    if not os.path.exists(path):
        pytest.fail(f"there is no program at {path}: run `cargo build`, or set CONTACT_DMA_PROGRAM")
    return path
