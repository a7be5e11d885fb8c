"""Quantities of pint and astropy, and arrays of pandas and xarray: converted, checked, and never stripped of their units."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import astropy.units as ap  # type: ignore[import-untyped]
import numpy as np
import pandas as pd
import pint
import pytest
from conftest import small_sweep

import contact_dma as cd

U: Any = pint.UnitRegistry()
A: Any = ap
PMMA = cd.Material.library("pmma")


@pytest.mark.parametrize(
    ("newton", "mm", "hertz", "radian", "second"),
    [(U.newton, U.mm, U.Hz, U.rad, U.s), (A.N, A.mm, A.Hz, A.rad, A.s)],
    ids=["pint", "astropy"],
)
def test_a_quantity_is_the_string_with_its_unit(newton: Any, mm: Any, hertz: Any, radian: Any, second: Any) -> None:
    omega = np.array([0.004, 0.01, 0.03])
    expected = small_sweep(angular_frequency=omega)
    quantities = {"mean": 0.01 * (1000 * newton), "amplitude": 5 * newton, "title": "PMMA"}
    result = cd.sweep(PMMA, cd.Sphere(10 * mm), angular_frequency=60 * omega * radian / (60 * second), springs=32, steps=32, **quantities)
    assert result["energy_loss_j"] == pytest.approx(expected["energy_loss_j"], rel=1e-12)
    # Hz is not rad/s, although both libraries say that it is 1/s.
    by_hertz = small_sweep(angular_frequency=None, frequency=omega / (2 * np.pi) * hertz)
    assert by_hertz["energy_loss_j"] == pytest.approx(expected["energy_loss_j"], rel=1e-9)
    several = small_sweep(angular_frequency=[0.01], axes={"indenter.radius": np.array([5.0, 10.0]) * mm})
    assert several["indenter_radius_m"].tolist() == [0.005, 0.01]
    one = small_sweep(angular_frequency=0.01 * radian / second)
    assert one["energy_loss_j"][0] == expected["energy_loss_j"][1]


def test_arrays_keep_their_units() -> None:
    t = np.logspace(-1, 3, 60)
    modulus = 1e9 + 2e9 * np.exp(-t / 10)
    plain = cd.Material.table(t, modulus, quantity="relaxation", poisson_ratio=0.4)
    for time in (1e3 * t * U.ms, 1e3 * t * A.ms, [f"{s!r} s" for s in t.tolist()]):
        made = cd.Material.table(time, modulus / 1e6 * U.MPa, quantity="relaxation", poisson_ratio=0.4)
        assert np.allclose(made.prony.times, plain.prony.times, rtol=1e-9)
    assert PMMA.complex_modulus(0.01 * U.rad / U.s) == PMMA.complex_modulus(0.01)
    assert cd.Sphere("10 mm").gap(1 * U.mm) == pytest.approx(5e-5)
    x = np.linspace(-100.0, 100.0, 17)
    heights = -np.add.outer(x**2, x**2) / 2e3
    assert np.allclose(cd.HeightMap(heights * U.um, spacing=12.5 * U.um).gaps, cd.HeightMap(heights, spacing=12.5e-6, height_unit="um").gaps)
    time = np.linspace(0.0, 10.0, 1001)
    record = {"time": 1e3 * time * U.ms, "load": 10 + 5 * np.sin(6 * time), "approach": (1e-2 + 2e-3 * np.sin(6 * time - 0.1)) * U.mm}
    assert cd.analyse(record)["phase_lag_rad"][0] == pytest.approx(0.1, rel=1e-3)


WRONG: list[tuple[Callable[[], object], list[str]]] = [
    (lambda: small_sweep(mean=10 * U.mm), ["drive.mean", "length", "force"]),
    (lambda: small_sweep(mean=10 * A.kg), ["drive.mean", "mass"]),
    (lambda: small_sweep(angular_frequency=[1, 2] * U.m), ["angular_frequency", "length"]),
    (lambda: small_sweep(angular_frequency=1 / U.s), ["angular_frequency"]),
    (lambda: cd.Sphere(1 * U.ampere), ["indenter.radius", "ampere"]),
    (lambda: cd.Material.table([1, 2, 3] * U.m, [3.0, 2.0, 1.0], quantity="relaxation", poisson_ratio=0.4), ["time", "length"]),
    (lambda: PMMA.complex_modulus(1 * U.m), ["length"]),
    (lambda: cd.HeightMap(np.zeros((8, 8)) * U.s, spacing=1e-6), ["heights", "time"]),
]


@pytest.mark.parametrize(("wrong", "words"), WRONG, ids=[" ".join(words) for _, words in WRONG])
def test_a_quantity_of_another_dimension_is_refused(wrong: Callable[[], object], words: list[str]) -> None:
    with pytest.raises(ValueError) as refused:
        wrong()
    for word in words:
        assert word in str(refused.value)


def test_series_and_other_arrays_are_lists_of_numbers() -> None:
    expected = small_sweep(angular_frequency=[0.01, 0.02])

    class Labelled:
        """As xarray's, which is no sequence."""

        ndim = 1

        def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
            return np.array([0.01, 0.02])

    for omega in (pd.Series([0.01, 0.02], index=[5, 7]), (0.01, 0.02), np.array([0.01, 0.02]), Labelled()):
        assert small_sweep(angular_frequency=omega) == expected
    assert small_sweep(angular_frequency=np.float64(0.01))["energy_loss_j"][0] == expected["energy_loss_j"][0]
