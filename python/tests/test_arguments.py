"""A wrong argument of each kind, and the message it meets."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, small_sweep

import contact_dma as cd

PMMA = cd.Material.library("pmma")
SPHERE = cd.Sphere("10 mm")


def map_of(heights: object, **options: object) -> Callable[[], object]:
    return lambda: cd.HeightMap(heights, **options)  # type: ignore[arg-type]


WRONG: list[tuple[Callable[[], object], list[str]]] = [
    (lambda: small_sweep(mean="10 mm"), ["drive.mean", "10 mm", "length"]),
    (lambda: small_sweep(mean=-100.0), ["mean"]),
    (lambda: small_sweep(amplitude=float("nan")), ["drive.amplitude"]),
    (lambda: small_sweep(amplitude=-1.0), ["amplitude"]),
    (lambda: small_sweep(angular_frequency=[]), ["angular_frequency"]),
    (lambda: small_sweep(angular_frequency=None), ["angular_frequency"]),
    (lambda: small_sweep(angular_frequency=[0.0]), ["angular_frequency"]),
    (lambda: small_sweep(frequency=[1.0]), ["frequency"]),
    (lambda: small_sweep(control="lod"), ['"load"']),
    (lambda: small_sweep(steps=1), ["cycle.steps"]),
    (lambda: small_sweep(steps=32.5), ["cycle.steps"]),
    (lambda: small_sweep(method=object()), ["object"]),
    (lambda: small_sweep(axes={"indenter.radios": [1.0]}), ["radios", "radius"]),
    (lambda: small_sweep(threads=0), ["threads is 0"]),
    (lambda: small_sweep(progress=3), ["progress"]),
    (lambda: cd.sweep(PMMA, 3.0, mean=1.0, amplitude=0.5), ["second argument"]),  # type: ignore[call-overload]
    (lambda: cd.sweep("nowhere.toml"), ["nowhere.toml"]),
    (lambda: cd.sweep(ROOT / "sweeps/pmma.toml", overrides={"cycle.stps": 3}), ["stps", "steps"]),
    (lambda: cd.sweep(ROOT / "sweeps/pmma.toml", steps=3), ["overrides"]),  # type: ignore[call-overload]
    (lambda: cd.Sphere("-1 mm"), ["radius"]),
    (lambda: cd.Sphere("1 N"), ["indenter.radius", "force"]),
    (lambda: cd.Cone("100 deg"), ["half_angle"]),
    (map_of([1.0, 2.0]), ["shape (2,)"]),
    (map_of(np.zeros((2, 2)), spacing=1e-6), ["2 x 2"]),
    (map_of(np.zeros((8, 8))), ["spacing"]),
    (map_of(np.full((8, 8), np.nan), spacing=1e-6), ["row 0, column 0"]),
    (map_of(-np.outer((np.arange(9.0) - 4) ** 2, np.ones(9)), spacing=1e-6), ["steeper", "height_unit"]),
    (map_of(np.outer(np.arange(8.0), np.ones(8)), spacing=1e-6), ["steeper", "level"]),
    (lambda: cd.Profile("nowhere.csv"), ["nowhere.csv"]),
    (lambda: cd.Material.library("pmna"), ['"pmma"']),
    (lambda: cd.Material.relaxation("1 MPa", [("1 MPa", 0.0)], poisson_ratio=0.3), ["time"]),
    (lambda: cd.Material.relaxation("1 MPa", [], poisson_ratio=0.7), ["poisson_ratio"]),
    (lambda: cd.Material.from_toml("[material]\n"), ["library"]),
    (lambda: cd.Material.from_toml("[material"), ["material"]),
    (lambda: cd.Material.from_dynamic(poisson_ratio=0.3), ["a file, or angular_frequency"]),
    (
        lambda: cd.Material.from_dynamic(
            angular_frequency=[1, 2], storage_modulus=[1, 2, 3], loss_modulus=[1, 2], poisson_ratio=0.3
        ),
        ["storage_modulus_pa 3"],
    ),
    (lambda: PMMA.complex_modulus(1.0, modulus="bulk"), ["longitudinal", "shear"]),  # type: ignore[arg-type]
    (lambda: cd.simulate(PMMA, SPHERE, segments=[{"kind": "jump"}]), ["jump"]),
    (lambda: cd.simulate(PMMA, SPHERE, segments=[]), ["segments"]),
    (lambda: cd.analyse({"time": [0.0]}), ["no load and no approach"]),
    (lambda: cd.analyse("nowhere.csv"), ["nowhere.csv"]),
    (lambda: cd.analyse([], frequency="3 m"), ["3 m"]),
    (lambda: cd.analyse([], setup={"instrment": {}, "instrument": {"mas": 1.0}}), ["mas"]),
    (lambda: cd.identify(), ["measured cycles and the indenter"]),
    (lambda: cd.identify({"energy_loss_j": [1.0]}, SPHERE, mean=1.0, amplitude=0.5), ["poisson_ratio"]),
    (lambda: cd.read("/nowhere"), ["/nowhere"]),
]


@pytest.mark.parametrize(("wrong", "words"), WRONG, ids=[" ".join(words) for _, words in WRONG])
def test_a_mistake_raises_a_value_error_that_names_it(wrong: Callable[[], object], words: list[str]) -> None:
    with pytest.raises(ValueError) as refused:
        wrong()
    for word in words:
        assert word in str(refused.value)


def test_an_argument_that_does_not_exist_is_a_type_error() -> None:
    for call in (small_sweep, lambda **given: cd.simulate(PMMA, SPHERE, segments=[], **given)):
        with pytest.raises(TypeError, match="stepps"):
            call(stepps=3)


def test_a_folder_of_another_sweep_is_kept(tmp_path: Path, result: cd.SweepResult) -> None:
    other = small_sweep(mean=11.0)
    result.save(tmp_path)
    with pytest.raises(ValueError, match="mean"):
        other.save(tmp_path)
    other.save(tmp_path, overwrite=True)
    assert cd.read(tmp_path) == other
