"""Sweeps: numbers are the program's, results can be moved, options say what the keys of a file say."""

from __future__ import annotations

import dataclasses
import html
import io
import pickle
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tqdm
from conftest import ROOT, small_sweep

import contact_dma as cd
from contact_dma import _sources
from contact_dma._sources import Source, source_of_values

COARSE = {"solver.springs": 32, "cycle.steps": 32}
TABLES = ["sweep.csv", "summary.json", "resolved.toml", "cases/cycles.npz", "cases/loops/0.csv", "cases/pressures/1.csv", "cases/work/2.csv"]


def run_program(program: str, *arguments: object) -> None:
    subprocess.run([program, *map(str, arguments)], check=True, capture_output=True)


def test_a_file_gives_what_the_program_writes_byte_for_byte(program: str, tmp_path: Path) -> None:
    file = ROOT / "sweeps/pmma.toml"
    changes = [item for key, value in COARSE.items() for item in ("--set", f"{key}={value}")]
    run_program(program, "sweep", file, "--quiet", "--no-figures", "--out", tmp_path / "program", *changes)
    result = cd.sweep(file, overrides=COARSE, threads=2)
    result.save(tmp_path / "python")
    for name in TABLES:
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name
    # The program draws what Python has saved, without solving anything, and peaks are there too.
    run_program(program, "report", tmp_path / "python")
    assert (tmp_path / "python/figures/energy-loss.svg").is_file() and (tmp_path / "python/index.html").is_file()
    for name in TABLES:
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name
    # And Python reads what the program has written.
    assert cd.read(tmp_path / "program") == result
    assert cd.read(tmp_path / "program").peaks == result.peaks  # type: ignore[union-attr]


def test_values_give_what_the_file_of_them_gives(tmp_path: Path) -> None:
    file = tmp_path / "sweep.toml"
    file.write_text(
        'title = "PMMA"\n[material]\nlibrary = "pmma"\n[indenter]\nshape = "sphere"\nradius = "10 mm"\n'
        '[drive]\nmean = "10 N"\namplitude = "5 N"\n[sweep]\nangular_frequency = [0.001, 0.01, 0.1]\n'
        "[solver]\nsprings = 32\n[cycle]\nsteps = 32\n"
    )
    by_values = small_sweep(angular_frequency=np.array([0.1, 0.001, 0.01]))
    assert cd.sweep(file) == by_values
    assert cd.sweep(file).resolved == by_values.resolved


def test_results_do_not_depend_on_the_number_of_threads(result: cd.SweepResult) -> None:
    for threads in (1, 2, 3):
        assert small_sweep(threads=threads) == result


def test_columns_cycles_and_peaks_belong_together(result: cd.SweepResult) -> None:
    assert len(result["energy_loss_j"]) == len(result.cycles) == len(result.status) == 5
    assert result["energy_loss_j"].dtype == np.float64 and result["status"].tolist() == ["converged"] * 5
    assert (result["energy_loss_error_j"] > 0).all()
    for loss, omega, cycle in zip(result["energy_loss_j"], result["angular_frequency_rad_per_s"], result.cycles):
        # The area of the polygon through 32 samples is low by (N / 2 pi) sin(2 pi / N): 0.6 %.
        area = (0.5 * (cycle.load[1:] + cycle.load[:-1]) * np.diff(cycle.approach)).sum()
        assert abs(area) == pytest.approx(loss, rel=0.01)
        assert cycle.angular_frequency == omega
        assert cycle.load.max() == pytest.approx(15.0) and not cycle.load.flags.writeable
        assert [profile.instant for profile in cycle.profiles][0] == "greatest load"
        assert cycle.profiles[0].lines[0].along == "r"
    (peak,) = result.peaks
    assert 1e-3 < peak.angular_frequency < 1e-1
    assert peak.energy_loss >= result["energy_loss_j"].max()
    assert result.summary["peaks"][0]["energy_loss_j"] == peak.energy_loss
    assert result.cycles[-1].angular_frequency == result.cycles[4].angular_frequency
    assert len(result.cycles[1:3]) == 2
    with pytest.raises(IndexError):
        result.cycles[5]


def test_the_loss_is_that_of_the_closed_form_for_a_flat_punch() -> None:
    # A punch is linear: Delta W = pi |W1|^2 Im(C*) / (2 a), C* = (1 - nu^2) / E*.
    solid = cd.Material.relaxation("10 MPa", [("30 MPa", "1 s")], poisson_ratio=0.4)
    omega, load, radius = np.array([0.3, 1.0, 3.0]), 0.5, 1e-3
    result = cd.sweep(solid, cd.FlatPunch(radius), mean=1.0, amplitude=load, angular_frequency=omega)
    compliance = (1 - 0.4**2) / solid.complex_modulus(omega)
    expected = np.pi * load**2 * -compliance.imag / (2 * radius)
    # The error bars of the result say how far off it may be; ten of them, since they are estimates.
    assert (abs(result["energy_loss_j"] - expected) <= 10 * result["energy_loss_error_j"] + 1e-9 * expected).all()


def test_bodies_and_cycles_are_what_the_same_keys_of_a_file_give(tmp_path: Path) -> None:
    glass = cd.Material.elastic("70 GPa", poisson_ratio=0.22)
    cases: list[tuple[dict[str, Any], str]] = [
        ({"indenter_material": "steel"}, '[indenter.material]\nlibrary = "steel"\n'),
        ({"indenter_material": glass}, '[indenter.material]\nelastic = { modulus = "70 GPa", poisson_ratio = 0.22 }\n'),
        ({"adhesion": 0.05}, '[adhesion]\nwork = "0.05 J/m^2"\n'),
        ({"adhesion": {"work": 0.05, "range": "0.2 nm"}}, '[adhesion]\nwork = 0.05\nrange = "0.2 nm"\n'),
        ({"layer": {"thickness": "1 mm"}, "cells": 16}, '[layer]\nthickness = "1 mm"\n[solver]\ncells = 16\n'),
        (
            {"layer": {"thickness": "1 mm", "base_modulus_ratio": 4.0, "base_poisson_ratio": 0.3}, "cells": 16},
            '[layer]\nthickness = "1 mm"\nbase_modulus_ratio = 4\nbase_poisson_ratio = 0.3\n[solver]\ncells = 16\n',
        ),
        ({"method": "march", "at_cycle": 2}, '[cycle]\nmethod = "march"\nat_cycle = 2\nsteps = 16\nerror_bars = false\n'),
    ]
    for option, keys in cases:
        result = cd.sweep(
            cd.Material.library("pmma"), cd.Sphere("10 mm"), mean=10.0, amplitude=5.0, angular_frequency=[0.01],
            steps=16, error_bars=False, title="same", **option,
        )
        cycle = "" if "[cycle]" in keys else "[cycle]\nsteps = 16\nerror_bars = false\n"
        file = tmp_path / "same.toml"
        file.write_text(
            'title = "same"\n[material]\nlibrary = "pmma"\n[indenter]\nshape = "sphere"\nradius = "10 mm"\n'
            f'{keys}[drive]\nmean = "10 N"\namplitude = "5 N"\n[sweep]\nangular_frequency = [0.01]\n{cycle}'
        )
        assert cd.sweep(file) == result, option
        assert pickle.loads(pickle.dumps(result)) == result


def test_the_modulus_of_the_indenter_is_an_axis() -> None:
    glass = cd.Material.elastic("70 GPa", poisson_ratio=0.22)
    axes = {"indenter.material.elastic.modulus": ["7 GPa", 70e9]}
    result = small_sweep(axes=axes, indenter_material=glass, angular_frequency=[0.01])
    alone = small_sweep(indenter_material=glass, angular_frequency=[0.01])
    assert result["energy_loss_j"][1] == alone["energy_loss_j"][0] > result["energy_loss_j"][0]


def test_a_mean_pressure_is_the_load_over_the_area_of_a_period() -> None:
    x = np.arange(16) * 1e-6
    wave = cd.HeightMap(1e-7 * np.cos(x[:, None] * np.pi / 8e-6) * np.cos(x * np.pi / 8e-6), 1e-6, edge="periodic")
    options: dict[str, Any] = {"angular_frequency": [0.01], "steps": 16, "error_bars": False}
    pmma, area = cd.Material.library("pmma"), (16e-6) ** 2
    pressed = cd.sweep(pmma, wave, control="pressure", mean="20 MPa", amplitude="5 MPa", **options)
    loaded = cd.sweep(pmma, wave, mean=20e6 * area, amplitude=5e6 * area, **options)
    assert pressed["energy_loss_j"] == pytest.approx(loaded["energy_loss_j"], rel=1e-9)
    segments = [{"kind": "ramp", "to": "20 MPa", "duration": "1 s"}]
    crept = cd.simulate(pmma, wave, control="pressure", segments=segments)
    assert crept["load_n"][-1] == pytest.approx(20e6 * area)


def test_axes_vary_indenter_and_drive() -> None:
    axes = {"indenter.radius": ["5 mm", 0.01], "drive.amplitude": [1.0, "5 N"]}
    result = small_sweep(axes=axes, angular_frequency=[0.01, 0.1], amplitude=None)
    assert len(result["energy_loss_j"]) == 8
    assert set(result["indenter_radius_m"]) == {0.005, 0.01}
    plain = small_sweep(angular_frequency=[0.01, 0.1])
    same = (result["indenter_radius_m"] == 0.01) & (result["drive_amplitude"] == 5.0)
    assert result["energy_loss_j"][same].tolist() == plain["energy_loss_j"].tolist()


def test_a_case_without_result_is_nan_and_says_why() -> None:
    with pytest.warns(cd.ContactDmaWarning, match="1 of 1 cases have no result") as seen:
        result = small_sweep(method="march", max_cycles=2, tolerance=1e-9, angular_frequency=[1e-2], error_bars=False)
    assert "not-converged" in str(seen[0].message) and seen[0].filename == small_sweep.__code__.co_filename
    with pytest.raises(RuntimeError, match="case 0 is not-converged"):
        result.raise_for_status()
    assert np.isnan(result["energy_loss_j"]).all() and result["energy_loss_j"].dtype == np.float64
    (status,) = result.status
    assert not status.converged and status.reason and str(status).startswith("not-converged: ")
    assert len(result.cycles[0].load) == 0 and result.peaks == ()
    assert "no case has a result" in result._repr_html_()


def test_columns_cannot_be_changed(result: cd.SweepResult) -> None:
    for column in result:
        with pytest.raises(ValueError, match="read-only"):
            result[column][0] = result[column][0]
    frame = result.to_pandas()
    frame.loc[0, "energy_loss_j"] = 99.0
    assert result["energy_loss_j"][0] < 99.0


def test_a_result_is_no_array(result: cd.SweepResult) -> None:
    with pytest.raises(TypeError, match="to_pandas"):
        np.asarray(result)


def test_peaks_say_which_columns_vary() -> None:
    study = small_sweep(axes={"indenter.radius": ["5 mm", "10 mm"]}, error_bars=False)
    peak = study.peaks[0]
    assert peak.varied_columns == ("indenter_radius_m",) and peak.varied[0] in study["indenter_radius_m"]
    assert small_sweep(error_bars=False).peaks[0].varied_columns == ()


def test_records_are_values_that_dataclasses_and_pandas_take(result: cd.SweepResult) -> None:
    (peak,) = result.peaks
    assert peak == pickle.loads(pickle.dumps(peak)) and hash(peak) == hash(result.peaks[0])
    assert peak.frequency == pytest.approx(peak.angular_frequency / (2 * np.pi), rel=1e-15)
    assert dataclasses.asdict(peak)["energy_loss"] == peak.energy_loss  # type: ignore[call-overload]
    frame = pd.DataFrame([peak])
    assert frame["energy_loss"][0] == peak.energy_loss and list(frame)[0] == "angular_frequency"
    assert cd.Status("failed", "why") != cd.Status("failed") and str(cd.Status("failed", "why")) == "failed: why"
    assert repr(cd.Status("failed")) == "Status(name='failed', reason=None)"
    cycle = result.cycles[0]
    again = pickle.loads(pickle.dumps(cycle))
    assert again == cycle and again.profiles[0].lines[0] == cycle.profiles[0].lines[0]
    with pytest.raises(TypeError, match="unhashable"):
        hash(cycle)
    with pytest.raises(AttributeError):
        peak.energy_loss = 0.0  # type: ignore[misc]


def test_warnings_of_cases_are_seen_where_a_result_is_shown(result: cd.SweepResult) -> None:
    steep = small_sweep(mean="100 kN", amplitude="1 kN", angular_frequency=[0.01], error_bars=False)
    (warning,) = (each for each in steep.warnings[0] if each.code == "steep-slope")
    assert "1 with warnings" in repr(steep) and html.escape(warning.message) in steep._repr_html_()
    assert "warning" not in repr(result).lower()


def test_cycles_compare_and_are_shown_without_their_numbers(result: cd.SweepResult) -> None:
    again = pickle.loads(pickle.dumps(result))
    assert again.cycles[0] == result.cycles[0] != result.cycles[1]
    assert len(repr(result.cycles[0])) < 400 and "5 cases" in repr(result.cycles)
    result.raise_for_status()


def test_keys_of_a_map_of_an_array_are_axes_as_of_one_of_a_file() -> None:
    x = np.linspace(-1e-4, 1e-4, 17)
    heights = -np.add.outer(x**2, x**2) / 2e-3
    tip = cd.HeightMap(heights, spacing=x[1] - x[0])
    varied = small_sweep_of(tip, axes={"indenter.spacing": [1.25e-5, 2.5e-5]})
    for loss, spacing in zip(varied["energy_loss_j"], [1.25e-5, 2.5e-5]):
        assert loss == small_sweep_of(cd.HeightMap(heights, spacing=spacing))["energy_loss_j"][0]
    with pytest.raises(ValueError, match="radius"):
        small_sweep_of(tip, axes={"indenter.radius": [1e-3]})
    both = small_sweep_of(tip, axes={"drive.amplitude": [0.01, 0.02]}, amplitude=None)
    assert both["energy_loss_j"][1] > both["energy_loss_j"][0]


def small_sweep_of(indenter: cd.Indenter, **changes: Any) -> cd.SweepResult:
    options = {"mean": 0.05, "amplitude": 0.02, "angular_frequency": [0.01], "steps": 16, "error_bars": False}
    return cd.sweep(cd.Material.library("pmma"), indenter, **{**options, **changes})


LOOKS = [
    'material.library = "pmma"\n',
    'material = { library = "pmma" }\n',
    '[ material ]\nlibrary = "pmma"\n',
    '["material"]\n"library" = "pmma" # [material]\n',
    '[material]\nname = """of two lines\n[material]\n[indenter]\n"""\nlibrary = "pmma"\n',
]


@pytest.mark.parametrize("text", LOOKS)
def test_a_material_of_any_toml_is_one_of_several_an_axis_and_an_indenter(text: str) -> None:
    pmma, material = cd.Material.library("pmma"), cd.Material.from_toml(text)
    options: dict[str, Any] = {"mean": 10.0, "amplitude": 5.0, "angular_frequency": [0.01], "springs": 16, "steps": 16, "error_bars": False}
    sphere = cd.Sphere("10 mm")
    several = cd.sweep({"a": material, "b": pmma}, sphere, **options)
    assert several["energy_loss_j"][0] == several["energy_loss_j"][1]
    axis = {"material.poisson_ratio": [0.3, 0.38]}
    losses = cd.sweep(material, sphere, axes=axis, **options)["energy_loss_j"]
    assert losses.tolist() == cd.sweep(pmma, sphere, axes=axis, **options)["energy_loss_j"].tolist()
    made_of = cd.sweep(pmma, sphere, indenter_material=material, **options)["energy_loss_j"]
    assert made_of.tolist() == cd.sweep(pmma, sphere, indenter_material=pmma, **options)["energy_loss_j"].tolist()


def test_titles_with_line_ends_and_headers_come_back_from_a_pickle(tmp_path: Path) -> None:
    pmma, name = cd.Material.library("pmma"), "[indenter] [material] 'a' \"b\""
    x = np.linspace(-1.2e-3, 1.2e-3, 17)
    tip = cd.HeightMap(-np.add.outer(x**2, x**2) / 2e-2, spacing=x[1] - x[0])
    options: dict[str, Any] = {"mean": 10.0, "amplitude": 5.0, "angular_frequency": [0.01], "steps": 16, "error_bars": False}
    result = cd.sweep({name: pmma, "dry": pmma}, tip, title="a\n[indenter]\nb", **options)
    assert result["energy_loss_j"][0] == result["energy_loss_j"][1]
    again = pickle.loads(pickle.dumps(result))
    assert again == result and again.title == result.title == "a\n[indenter]\nb"


def test_a_thousand_named_materials_are_one_document_and_their_cycles_are_asked_for_once_each(monkeypatch: pytest.MonkeyPatch) -> None:
    options: dict[str, Any] = {"mean": 10.0, "amplitude": 5.0, "angular_frequency": [0.01], "springs": 10, "steps": 8, "error_bars": False}
    sources: list[Source] = []

    def noted(*given: Any, **named: Any) -> Source:
        sources.append(source_of_values(*given, **named))
        return sources[-1]

    monkeypatch.setattr(_sources, "source_of_values", noted)
    materials = {f"m{k}": cd.Material.zener(1e6 + k, "2 MPa", "1 s", poisson_ratio=0.5) for k in range(1000)}
    result = cd.sweep(materials, cd.Sphere("10 mm"), **options)
    # A change of a document reads it anew: one for each name were quadratic.
    assert [len(source.set) for source in sources] == [0] and len(set(result["material"])) == 1000
    assert len(result.title) < 100 and len(repr(result)) < 200

    asked: Counter[str] = Counter()

    class Watched:
        """The result, which counts what it is asked for."""

        def __getattr__(self, name: str) -> Any:
            asked[name] += 1
            return getattr(result, name)

    watched: Any = Watched()
    assert sum(len(cycle.load) > 0 for cycle in cd.Cycles(watched)) == 1000
    # Anything of all cases, such as their statuses, asked for at every cycle were quadratic too.
    assert set(asked) == {"_cases", "_cycle"} and asked["_cycle"] == 1000


def test_progress_is_told_and_an_exception_of_it_stops_the_sweep() -> None:
    told: list[tuple[int, int]] = []
    small_sweep(progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (5, 5) and sorted(told) == told

    with tqdm.tqdm(file=io.StringIO()) as bar:
        small_sweep(progress=bar)
    assert (bar.n, bar.total) == (5, 5)

    def stop(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        small_sweep(progress=stop)


def test_pandas_and_notebooks_get_a_table_and_a_curve(result: cd.SweepResult) -> None:
    frame = result.to_pandas()
    assert frame.shape == (5, len(result)) and frame["energy_loss_j"].tolist() == result["energy_loss_j"].tolist()
    page = result._repr_html_()
    assert page.count("<svg") == 1 and "<title>energy loss per cycle / µJ against" in page and page.count("<li>peak of") == len(result.peaks)
    assert result._ipython_key_completions_() == list(result)


def test_curves_of_a_notebook_have_colours_of_their_own(result: cd.SweepResult) -> None:
    def colours(shown: cd.SweepResult) -> set[str]:
        return set(re.findall('stroke="(#[0-9a-f]+)"', shown._repr_html_()))

    assert len(colours(small_sweep(axes={"drive.amplitude": [2.0, 5.0]}))) == len(colours(result)) + 1


def test_without_pandas_it_is_said_what_to_install(result: cd.SweepResult, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ModuleNotFoundError, match="pip install pandas"):
        result.to_pandas()


def test_a_map_of_an_array_is_used_saved_read_and_pickled(tmp_path: Path, program: str) -> None:
    x = np.linspace(-1.2e-3, 1.2e-3, 33)
    heights = -(x**2 + x[:, None] ** 2) / (2 * 10e-3)
    map = cd.HeightMap(heights, spacing=x[1] - x[0])
    assert np.allclose(map.gaps, heights.max() - heights, rtol=1e-12, atol=1e-18)
    options: dict[str, Any] = {"mean": 10.0, "amplitude": 5.0, "angular_frequency": [0.01, 0.02], "steps": 16, "error_bars": False}
    result = cd.sweep(cd.Material.library("pmma"), map, **options)
    sphere = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), **options)
    # Seventeen cells across the contact: two per cent of the loss, measured 0.7 %.
    assert result["energy_loss_j"] == pytest.approx(sphere["energy_loss_j"], rel=0.02)
    result.save(tmp_path / "map")
    assert cd.read(tmp_path / "map") == result
    run_program(program, "report", tmp_path / "map")


def test_a_saved_result_can_be_saved_elsewhere(tmp_path: Path, result: cd.SweepResult) -> None:
    result.save(tmp_path / "a")
    cd.read(tmp_path / "a").save(tmp_path / "b")
    for name in TABLES:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name


def test_materials_and_indenters_by_name_are_the_cases_of_sweeps_of_their_own(tmp_path: Path) -> None:
    materials = {
        "pmma": cd.Material.library("pmma"),
        "wet, 40 %": cd.Material.zener(spring="20 MPa", kelvin_spring="5 MPa", time="1 s", poisson_ratio=0.45),
    }
    indenters: dict[str, cd.Indenter] = {"ball": cd.Sphere("10 mm"), "cone": cd.Cone("80 deg")}
    options: dict[str, Any] = {"mean": 1.0, "amplitude": 0.5, "steps": 16, "springs": 24, "error_bars": False}
    frequencies, made_of = [0.1, 1.0, 10.0], "glass"
    several = cd.sweep(materials, indenters, angular_frequency=frequencies, indenter_material=made_of, **options)
    assert list(several["material"]) == [name for name in materials for _ in range(6)]
    assert list(several["indenter"]) == ["ball"] * 3 + ["cone"] * 3 + ["ball"] * 3 + ["cone"] * 3
    alone = [
        cd.sweep(material, indenter, angular_frequency=frequencies, indenter_material=made_of, **options)
        for material in materials.values()
        for indenter in indenters.values()
    ]
    losses = np.concatenate([result["energy_loss_j"] for result in alone])
    assert (several["energy_loss_j"] == losses).all()
    assert {peak.varied for peak in several.peaks} <= {(m, i) for m in materials for i in indenters}
    assert len(several.peaks) > 0
    assert pickle.loads(pickle.dumps(several)) == several
    several.save(tmp_path / "several")
    assert cd.read(tmp_path / "several") == several
    with pytest.raises(ValueError, match="is no material"):
        cd.sweep({"pmma": "pmma"}, cd.Sphere("10 mm"), angular_frequency=[1.0], **options)  # type: ignore[dict-item]
    with pytest.raises(ValueError, match="write an Indenter"):
        cd.sweep(materials, {"ball": 0.01}, angular_frequency=[1.0], **options)  # type: ignore[dict-item]


def test_indenters_of_arrays_are_several_by_their_names_and_saved_as_files(tmp_path: Path, program: str) -> None:
    x, r = np.linspace(-1.2e-3, 1.2e-3, 33), np.linspace(0.0, 3e-3, 61)
    heights, spacing = -(x**2 + x[:, None] ** 2) / (2 * 10e-3), x[1] - x[0]
    options: dict[str, Any] = {"mean": 10.0, "amplitude": 5.0, "angular_frequency": [0.01], "steps": 16, "error_bars": False}
    pmma = cd.Material.library("pmma")
    maps: dict[str, cd.Indenter] = {name: cd.HeightMap(k * heights, spacing=spacing) for k, name in [(1, "blunt"), (2, "sharp")]}
    bodies: dict[str, cd.Indenter] = {"profile": cd.Profile(r, r**2 / (2 * 10e-3)), "ball": cd.Sphere("10 mm")}
    for number, (tips, files) in enumerate([(maps, ["height-map-2.npy", "height-map.npy"]), (bodies, ["profile.csv"])]):
        several = cd.sweep(pmma, tips, **options)
        alone = [cd.sweep(pmma, tip, **options)["energy_loss_j"][0] for tip in tips.values()]
        assert several["energy_loss_j"].tolist() == alone and alone[0] != alone[1]
        assert pickle.loads(pickle.dumps(several)) == several
        folder = tmp_path / str(number)
        several.save(folder)
        assert sorted(p.name for p in (folder / "records").iterdir() if p.name.startswith(("height", "profile."))) == files
        run_program(program, "report", folder)
        read = cd.read(folder, cd.SweepResult)
        assert read == several and all((folder / "records" / file).is_file() for file in files)
        several.save(folder, overwrite=True)
        assert cd.read(folder) == several
    assert alone[0] == pytest.approx(alone[1], rel=1e-6)


def test_a_map_of_an_array_has_an_offset_and_may_be_deformable(tmp_path: Path) -> None:
    x = np.linspace(-1.2e-3, 1.2e-3, 33)
    heights, spacing = -(x**2 + x[:, None] ** 2) / (2 * 10e-3), x[1] - x[0]
    centred, moved = cd.HeightMap(heights, spacing=spacing), cd.HeightMap(heights, spacing=spacing, offset=(4 * spacing, 0.0))
    assert np.array_equal(centred.gaps, moved.gaps) and moved.gap(4 * spacing) == pytest.approx(0.0, abs=1e-15)
    still, shifted = (small_sweep_of(tip, mean=10.0, amplitude=5.0) for tip in (centred, moved))
    assert shifted["energy_loss_j"] == pytest.approx(still["energy_loss_j"], rel=1e-6)
    soft = small_sweep_of(moved, mean=10.0, amplitude=5.0, indenter_material=cd.Material.elastic("2 GPa", 0.3))
    assert soft["energy_loss_j"][0] != pytest.approx(shifted["energy_loss_j"][0], rel=1e-2)
    soft.save(tmp_path)
    assert cd.read(tmp_path) == soft


def test_figures_are_those_of_the_program_and_written_as_their_ending_says(result: cd.SweepResult, tmp_path: Path, program: str) -> None:
    result.save(tmp_path / "out")
    run_program(program, "report", tmp_path / "out")
    drawn = {path.stem for path in (tmp_path / "out/figures").glob("*.svg")}
    read = cd.read(tmp_path / "out", cd.SweepResult)
    assert set(result.figures) == set(read.figures) == drawn and "energy-loss" in drawn
    figure = result.figures["energy-loss"]
    assert repr(figure) == "<Figure energy-loss>" and str(figure._repr_html_()) in result._repr_html_()
    for name, begin in [("loss.svg", b"<svg"), ("loss.pdf", b"%PDF"), ("loss.eps", b"%!PS"), ("loss.png", b"\x89PNG")]:
        figure.save(tmp_path / name)
        assert (tmp_path / name).read_bytes().startswith(begin)
    curve = re.findall(r'<poly(?:line|gon)[^>]* points="[^"]*"', (tmp_path / "loss.svg").read_text())
    assert curve == re.findall(r'<poly(?:line|gon)[^>]* points="[^"]*"', (tmp_path / "out/figures/energy-loss.svg").read_text())
    with pytest.raises(ValueError, match="end it with .svg"):
        figure.save(tmp_path / "loss.gif")


def test_a_dataset_of_xarray_has_the_axes_as_dimensions() -> None:
    study = small_sweep(axes={"indenter.radius": ["5 mm", "10 mm"]}, angular_frequency=[0.01, 0.1], error_bars=False)
    data = study.to_xarray()
    assert dict(data.sizes) == {"indenter_radius_m": 2, "angular_frequency_rad_per_s": 2}
    at = (study["indenter_radius_m"] == 0.01) & (study["angular_frequency_rad_per_s"] == 0.1)
    assert data["energy_loss_j"].sel(indenter_radius_m=0.01, angular_frequency_rad_per_s=0.1) == study["energy_loss_j"][at][0]
    assert data["energy_loss_j"].attrs["units"] == "J" and data["indenter_radius_m"].attrs["units"] == "m"


def test_a_result_is_read_as_the_class_that_is_expected(result: cd.SweepResult, tmp_path: Path) -> None:
    result.save(tmp_path)
    assert cd.read(tmp_path, cd.SweepResult)["energy_loss_j"].tolist() == result["energy_loss_j"].tolist()
    with pytest.raises(ValueError, match="holds a SweepResult, not a HistoryResult"):
        cd.read(tmp_path, cd.HistoryResult)
