"""A wrong argument of each kind, and the message it meets."""

from __future__ import annotations

import errno
import inspect
import re
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, small_sweep

import contact_dma as cd
from contact_dma._sources import THREADS, thread_count

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
    (lambda: small_sweep(axes={"amplitude": [1.0]}), ["drive.amplitude"]),
    (lambda: small_sweep(axes={"material.relaxation.branches.0.time": [1.0]}), ["material.relaxation.branches[0].time"]),
    (lambda: small_sweep(axes={"indenter.radius": None}), ["indenter.radius", "no values"]),
    (lambda: small_sweep(axes=0), ["axes is 0"]),
    (lambda: small_sweep(axes=()), ["axes is ()"]),
    (lambda: small_sweep(axes=[1]), ["axes is [1]"]),
    (lambda: small_sweep(mean=[5.0, 10.0]), ['axes={"drive.mean": [...]}']),
    (lambda: small_sweep(solver_tolerance=np.array([1e-6, 1e-7])), ["solver.tolerance"]),
    # Nothing in it is not the half-space, which is what is computed where it is left out.
    (lambda: small_sweep(layer={}), ["layer", "thickness"]),
    (lambda: small_sweep(layer={"thickness": None}), ["layer", "thickness"]),
    (lambda: small_sweep(layer=3), ["layer is 3"]),
    (lambda: small_sweep(adhesion={}), ["adhesion", "work"]),
    (lambda: small_sweep(adhesion={"work": None}), ["adhesion", "work"]),
    (lambda: small_sweep(title="half \ud800"), ["half of a character"]),
    (lambda: small_sweep(threads=0), ["threads is 0"]),
    (lambda: small_sweep(threads="2"), ["threads is '2'"]),
    (lambda: small_sweep(threads=10**20), ["threads is 1000"]),
    (lambda: cd.sweep("pmma", SPHERE, mean=1.0), ['Material.library("pmma")']),
    (lambda: cd.sweep(SPHERE, PMMA, mean=1.0), ["material comes first"]),  # type: ignore[arg-type]
    (lambda: cd.sweep(None, SPHERE, mean=1.0), ["the first argument is a Material"]),  # type: ignore[arg-type]
    (lambda: cd.simulate("pmma", SPHERE, segments=[]), ['Material.library("pmma")']),
    (lambda: small_sweep(progress=3), ["progress"]),
    (lambda: cd.sweep(PMMA, 3.0, mean=1.0, amplitude=0.5), ["second argument"]),  # type: ignore[arg-type]
    (lambda: cd.sweep(ROOT / "sweeps/pmma.toml", overrides={"cycle.stps": 3}), ["stps", "steps"]),
    (lambda: cd.sweep(ROOT / "sweeps/pmma.toml", steps=3), ["overrides"]),
    (lambda: cd.Sphere("-1 mm"), ["radius"]),
    (lambda: cd.Sphere("1 N"), ["indenter.radius", "force"]),
    (lambda: cd.Cone("100 deg"), ["half_angle"]),
    (map_of([1.0, 2.0]), ["shape (2,)"]),
    (map_of(np.zeros((2, 2)), spacing=1e-6), ["2 x 2"]),
    (map_of(np.zeros((8, 8))), ["spacing"]),
    (lambda: cd.Profile([0.0, 1e-3, 1e-3], [0.0, 1e-6, 2e-6]), ["argument `file`", "row 3", "does not exceed"]),
    (lambda: cd.Profile([1e-3, 2e-3], [0.0, 1e-6]), ["row 1", "not on the axis"]),
    (lambda: cd.Profile([0.0, 1e-3], [0.0]), ["r_m 2, gap_m 1"]),
    (lambda: cd.Profile([0.0, 1e-3]), ["Profile(r, gap)"]),
    (lambda: cd.Profile({"r": [0.0, 1e-3]}), ["no column `gap_m`"]),
    (lambda: cd.Sphere(0.01).gaps, ["no grid"]),
    (lambda: PMMA.export("abacus"), ["abaqus, ansys"]),
    (lambda: cd.schema("sweeps"), ["write one of sweep"]),
    (map_of(np.full((8, 8), np.nan), spacing=1e-6), ["argument `heights`", "row 1, column 1"]),
    (map_of(-np.outer((np.arange(9.0) - 4) ** 2, np.ones(9)), spacing=1e-6), ["steeper", "height_unit"]),
    (map_of(np.outer(np.arange(8.0), np.ones(8)), spacing=1e-6), ["steeper", "level"]),
    (lambda: cd.Asperities([(0, 0)]), ["(center_x, center_y, radius, height)", "(0, 0)"]),
    (lambda: cd.Asperities([1e-3]), ["(center_x, center_y, radius, height)", "0.001"]),  # type: ignore[list-item]
    (lambda: cd.Asperities(3), ["asperities is 3"]),  # type: ignore[arg-type]
    (lambda: cd.sweep({}, SPHERE, mean=1.0, amplitude=0.5, angular_frequency=[1.0]), ["no material in {}"]),
    (lambda: cd.sweep(PMMA, {}, mean=1.0, amplitude=0.5, angular_frequency=[1.0]), ["no indenter in {}"]),
    (lambda: small_sweep(angular_frequency=[1.0, None]), ["angular_frequency: None"]),
    (lambda: cd.Material.relaxation(1e6, [(1e6, 1.0)], bulk_modulus=(1e9,)), ["bulk_modulus is (1000000000.0,)"]),  # type: ignore[arg-type]
    (lambda: cd.Material.relaxation(1e6, [(1e6, 1.0)], bulk_modulus=(1e9, [1.0])), ["(modulus, time)"]),  # type: ignore[list-item]
    (lambda: cd.Material.library("pmna"), ['"pmma"']),
    (lambda: cd.Material.library("no such polymer"), ["the library has", "pvb"]),
    (lambda: cd.Material.relaxation("1 MPa", {"1 MPa": "1 s"}, poisson_ratio=0.3), ["(modulus, time)"]),  # type: ignore[arg-type]
    (lambda: cd.Material.creep(1e-9, [1e-9], poisson_ratio=0.3), ["(compliance, time)"]),  # type: ignore[list-item]
    (lambda: cd.Material.relaxation("1 MPa", [("1 MPa", 0.0)], poisson_ratio=0.3), ["time"]),
    (lambda: cd.Material.relaxation("1 MPa", [], poisson_ratio=0.7), ["poisson_ratio"]),
    (lambda: cd.Material.from_toml("[material]\n"), ["library"]),
    (lambda: cd.Material.zener("1 MPa", "2 MPa", [1.0, 2.0], poisson_ratio=0.3), ["time takes one value"]),  # type: ignore[arg-type]
    (lambda: cd.Material.from_toml("[material"), ["material"]),
    (lambda: cd.Material.from_dynamic(poisson_ratio=0.3), ["a file, or angular_frequency"]),
    (lambda: cd.Material.from_dynamic(storage_modulus=[1.0], loss_modulus=[1.0], poisson_ratio=0.3), ["angular_frequency or frequency"]),
    (
        lambda: cd.Material.from_dynamic(
            angular_frequency=[1, 2], storage_modulus=[1, 2, 3], loss_modulus=[1, 2], poisson_ratio=0.3
        ),
        ["storage_modulus 3"],
    ),
    (lambda: PMMA.complex_modulus(1.0, modulus="bulk"), ["longitudinal", "shear"]),  # type: ignore[call-overload]
    (lambda: cd.simulate(PMMA, SPHERE, segments=[{"kind": "jump"}]), ["jump"]),
    (lambda: cd.simulate(PMMA, SPHERE, segments=[]), ["segments"]),
    (lambda: cd.analyse({"time": [0.0]}), ["no load and no approach"]),
    (lambda: cd.analyse({"time": [0.0, 1.0], "load": [0.0], "approach": [0.0, 1.0]}), ["record 0", "load 1"]),
    (lambda: cd.analyse({"time": [1.0, 0.0], "load": [0.0, 1.0], "approach": [0.0, 1.0]}), ["record 0", "times descend"]),
    # A unit of another quantity is not that of a load, and of two columns of one name neither is chosen.
    (lambda: cd.analyse({"time": [0.0], "load_m": [0.0], "approach_n": [0.0]}), ["no load and no approach"]),
    (lambda: cd.analyse({"time": [0.0], "time_s": [0.0], "load": [0.0], "approach": [0.0]}), ["both time and time_s"]),
    (lambda: cd.analyse({name: [[0.0, 1.0]] * 2 for name in ("time", "load", "approach")}), ["record 0, time has shape (2, 2)"]),
    (lambda: cd.analyse([], frequency=[1.0, 2.0]), ["one number"]),  # type: ignore[arg-type]
    (lambda: cd.analyse([], frequency="3 m"), ["3 m"]),
    (lambda: cd.analyse([], setup={"instrment": {}, "instrument": {"mas": 1.0}}), ["mas"]),
    (lambda: cd.identify(), ["measured cycles and the indenter"]),
    (lambda: cd.identify({"energy_loss_j": [1.0]}, SPHERE, mean=1.0, amplitude=0.5), ["poisson_ratio"]),
]


@pytest.mark.parametrize(("wrong", "words"), WRONG, ids=[" ".join(words) for _, words in WRONG])
def test_a_mistake_raises_a_value_error_that_names_it(wrong: Callable[[], object], words: list[str]) -> None:
    with pytest.raises(ValueError) as refused:
        wrong()
    for word in words:
        assert word in str(refused.value)


MISSING: list[Callable[[str], object]] = [
    lambda name: cd.sweep(name),
    lambda name: cd.simulate(name),
    lambda name: cd.Profile(name),
    lambda name: cd.HeightMap(name),
    lambda name: cd.analyse(name),
    lambda name: cd.analyse([], setup=name),
    lambda name: cd.identify(file=name),
    lambda name: cd.identify(name, SPHERE, poisson_ratio=0.3, mean=1.0, amplitude=0.5),
    lambda name: cd.Material.from_dynamic(name, poisson_ratio=0.3),
    lambda name: cd.read(name),
]


@pytest.mark.parametrize("call", MISSING)
def test_a_file_that_is_not_there_is_one_that_python_knows_as_missing(call: Callable[[str], object]) -> None:
    with pytest.raises(FileNotFoundError) as refused:
        call("nowhere.toml")
    assert refused.value.errno == errno.ENOENT and refused.value.filename == "nowhere.toml"


def test_what_is_no_folder_of_results_is_an_error_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(NotADirectoryError):
        cd.read(tmp_path / "file")
    with pytest.raises(ValueError):
        cd.read(tmp_path)
    with pytest.raises(NotADirectoryError) as refused:
        small_sweep().save(tmp_path / "file" / "below")
    assert refused.value.errno == errno.ENOTDIR


def test_messages_advise_what_can_be_written_in_python(tmp_path: Path, result: cd.SweepResult) -> None:
    result.save(tmp_path)
    samples = cd.Material.table([0.1, 1.0, 10.0, 100.0], [4e9, 3e9, 2e9, 1e9], quantity="relaxation", poisson_ratio=0.3, evaluation="direct")
    bad: list[Callable[[], object]] = [
        lambda: small_sweep(mean=11.0).save(tmp_path),
        lambda: cd.sweep(samples, SPHERE, mean=10.0, amplitude=5.0, angular_frequency=[0.1]),
    ]
    for call, advice in zip(bad, ["overwrite=True", "contact_dma.simulate"]):
        with pytest.raises(ValueError) as refused:
            call()
        said = str(refused.value)
        assert advice in said and "--" not in said.replace("-->", "") and "unknown key" not in said, said


def test_arrays_that_are_refused_are_not_a_file_that_is_gone() -> None:
    with pytest.raises(ValueError) as refused:
        cd.Material.from_dynamic(angular_frequency=[1.0, 2.0, 4.0], storage_modulus=[1e9, -2e9, 3e9], loss_modulus=[1e8] * 3, poisson_ratio=0.3)
    assert "arguments, row 2" in str(refused.value) and ".csv" not in str(refused.value)
    # Of a table under a name of its own the argument is told.
    with pytest.raises(ValueError) as refused:
        cd.Material.from_dynamic(
            {"angular_frequency": [1.0, 2.0, 4.0], "storage_modulus": [1e9, -2e9, 3e9], "loss_modulus": [1e8] * 3}, poisson_ratio=0.3
        )
    assert "argument `file`, row 2" in str(refused.value)
    errors = {"energy_loss_j": [1e-6] * 5, "energy_loss_error_j": [1e-8] * 4 + [-1e-8]}
    with pytest.raises(ValueError) as refused:
        cd.identify({"frequency_hz": [1.0, 2.0, 3.0, 4.0, 5.0], **errors}, SPHERE, poisson_ratio=0.45, mean=0.2, amplitude=0.1)
    assert "argument `data`, row 5" in str(refused.value) and "above zero" in str(refused.value)


def test_arrays_are_written_to_no_file(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("TemporaryDirectory", "mkdtemp", "mkstemp", "NamedTemporaryFile", "TemporaryFile"):
        monkeypatch.setattr(tempfile, name, lambda *_, **__: pytest.fail("a temporary file"))
    omega = np.logspace(-2, 2, 25)
    solid = cd.Material.relaxation("10 MPa", [("90 MPa", "1 s")], poisson_ratio=0.45)
    measured = solid.complex_modulus(omega)
    cd.Material.from_dynamic(angular_frequency=omega, storage_modulus=measured.real, loss_modulus=measured.imag, poisson_ratio=0.45)
    drive: dict[str, object] = {"mean": 0.2, "amplitude": 0.1, "springs": 64, "steps": 64, "error_bars": False}
    cycles = cd.sweep(solid, SPHERE, angular_frequency=[0.1, 0.3, 1.0, 3.0, 10.0], **drive)  # type: ignore[arg-type]
    data = {name: cycles[name] for name in ("angular_frequency_rad_per_s", "energy_loss_j", "approach_max_m")}
    found = cd.identify(data, SPHERE, poisson_ratio=0.45, branches=1, mean=0.2, amplitude=0.1)
    assert "argument `data`" in dict(found._files)["resolved.toml"].decode()


def test_options_without_effect_warn() -> None:
    given: dict[str, object] = {"hold": "1 s", "cells": 32, "solver_tolerance": 1e-6}
    for word, value in given.items():
        with pytest.warns(cd.ContactDmaWarning, match=f"{word} has no effect"):
            small_sweep(angular_frequency=[0.01], steps=16, **{word: value})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        small_sweep(angular_frequency=[0.01], steps=16, hold="1 s", method="march")


def test_an_identification_warns_of_options_without_effect() -> None:
    solid = cd.Material.relaxation("10 MPa", [("30 MPa", "1 s")], poisson_ratio=0.45)
    cycles = cd.sweep(
        solid, SPHERE, mean=0.2, amplitude=0.1, angular_frequency=[0.1, 0.3, 1.0, 3.0, 10.0], springs=64, steps=64, error_bars=False
    )
    data = {name: cycles[name] for name in ("angular_frequency_rad_per_s", "energy_loss_j", "approach_max_m")}
    with pytest.warns(cd.ContactDmaWarning, match="identify: cells has no effect"):
        cd.identify(data, SPHERE, poisson_ratio=0.45, mean=0.2, amplitude=0.1, cells=32)


def test_options_are_in_the_signatures_that_notebooks_complete() -> None:
    for call, overloaded in ((cd.sweep, small_sweep), (cd.simulate, lambda **given: cd.simulate(PMMA, SPHERE, segments=[], **given))):
        named = [name for name, each in inspect.signature(call).parameters.items() if each.kind is each.KEYWORD_ONLY]
        assert {"overrides", "cells", "layer", "title", "progress"} <= set(named)
        with pytest.raises(ValueError):  # and not the TypeError of an argument that does not exist
            overloaded(**{name: object() for name in named if name not in ("overrides", "segments", "threads", "progress")})


def test_signatures_and_help_have_every_key_with_its_default() -> None:
    def defaults(call: Callable[..., object]) -> dict[str, object]:
        return {name: each.default for name, each in inspect.signature(call).parameters.items()}

    swept, found = defaults(cd.sweep), defaults(cd.identify)
    keys = {"control", "mean", "amplitude", "phase", "hold", "angular_frequency", "frequency", "pairs", "refine", "steps", "method"}
    keys |= {"tolerance", "max_cycles", "at_cycle", "error_bars", "accuracy", "engine", "cells", "springs", "solver_tolerance", "time_rule"}
    assert keys | {"indenter_material", "layer", "adhesion", "axes", "title", "threads", "progress", "overrides"} < set(swept)
    assert (swept["control"], swept["steps"], swept["tolerance"], swept["springs"], swept["method"]) == ("load", 200, 1e-4, 400, "direct")
    # The model of an identification is coarser.
    assert (found["steps"], found["springs"], found["cells"], found["error_bars"]) == (64, 64, 32, False)
    assert {"segments", "step", "profiles_at", "fields_at", "field_cells", "springs"} < set(defaults(cd.simulate))
    for call in (cd.sweep, cd.simulate, cd.identify):
        for name in inspect.signature(call).parameters:
            assert re.search(rf"\n    {name}: \S", str(call.__doc__)), name
    assert "poisson_ratio: Poisson ratio" in str(cd.Material.zener.__doc__) and "radius: Radius" in str(cd.Sphere.__init__.__doc__)
    assert list(defaults(cd.Sphere)) == ["radius", "offset"] and defaults(cd.Material.maxwell)["bulk_modulus"] is None


def test_a_default_that_is_given_is_the_default() -> None:
    given = small_sweep(method="direct", tolerance=1e-4, control="load", engine="axisymmetric", pairs=None)
    assert given.resolved == small_sweep().resolved


def test_a_star_leaves_the_warning_of_python_where_it_is() -> None:
    shared: dict[str, object] = {}
    exec("from contact_dma import *", shared)
    assert "Warning" not in shared and "ContactDmaWarning" in shared


def test_material_and_indenter_may_be_given_by_name() -> None:
    named = cd.sweep(material=PMMA, indenter=SPHERE, mean=10.0, amplitude=5.0, angular_frequency=[0.01], steps=16, springs=16)
    assert named == cd.sweep(PMMA, SPHERE, mean=10.0, amplitude=5.0, angular_frequency=[0.01], steps=16, springs=16)


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


def test_threads_follow_the_environment_where_no_number_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in THREADS:
        monkeypatch.delenv(name, raising=False)
    assert thread_count(None) is None
    monkeypatch.setenv("OMP_NUM_THREADS", "3,2")
    assert thread_count(None) is None
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    assert thread_count(None) == 3
    monkeypatch.setenv("CONTACT_DMA_THREADS", "2")
    assert thread_count(None) == 2 and thread_count(5) == 5
