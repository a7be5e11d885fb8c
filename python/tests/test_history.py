"""Single histories."""

from __future__ import annotations

import json
import pickle
import subprocess
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import contact_dma as cd

PMMA = cd.Material.library("pmma")


def held(**options: object) -> cd.HistoryResult:
    segments = [{"kind": "step", "to": "10 N", "duration": "200 s"}]
    result = cd.simulate(PMMA, cd.Sphere("10 mm"), segments=segments, **{"springs": 64, **options})  # type: ignore[arg-type]
    assert isinstance(result, cd.HistoryResult)
    return result


def test_a_step_of_load_creeps_as_ting_says() -> None:
    result = held()
    # a^3 = 3/8 R W C(t) with C = (1 - nu^2) D(t), T. C. T. Ting, J. Appl. Mech. 33 (1966) 845, a growing contact.
    time = result["time_s"]
    compliance = (1 - 0.38**2) * PMMA.creep_compliance(time)
    radius = np.cbrt(3 / 4 * 0.01 * 10.0 * compliance)
    # 64 springs over the contact: below one per cent.
    assert result["contact_radius_m"][1:] == pytest.approx(radius[1:], rel=0.01)
    assert result["approach_m"][1:] == pytest.approx(radius[1:] ** 2 / 0.01, rel=0.01)
    assert "<title>load W / N" in result._repr_html_() and result.failure is None


def test_a_file_gives_what_the_program_writes(program: str, tmp_path: Path) -> None:
    file = ROOT / "sweeps/table-drive.toml"
    arguments = [program, "simulate", str(file), "--quiet", "--no-figures", "--out", str(tmp_path / "program")]
    subprocess.run(arguments, check=True, capture_output=True)
    result = cd.simulate(file)
    result.save(tmp_path / "python")
    for name in ["history.csv", "summary.json", "resolved.toml"]:
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name
    assert cd.read(tmp_path / "program") == result
    subprocess.run([program, "report", str(tmp_path / "python")], check=True, capture_output=True)
    assert (tmp_path / "python/figures/history.svg").is_file() and (tmp_path / "python/index.html").is_file()


def test_fields_and_profiles_share_the_memory_of_the_result_and_come_back_from_a_folder(tmp_path: Path) -> None:
    result = held(fields_at=["0 s", "200 s"], profiles_at=[100.0], field_cells=64)
    first, last = result.fields
    assert first.pressure.shape == (64, 64) and last.time == 200.0
    assert first.pressure.base is not None and not first.pressure.flags.writeable
    assert np.shares_memory(first.pressure, result.fields[0].pressure)
    force = last.pressure.sum() * last.spacing[0] * last.spacing[1]
    # Cells of a thirtieth of the contact's radius: two per cent of the load.
    assert force == pytest.approx(10.0, rel=0.02)
    (profile,) = result.profiles
    (line,) = profile.lines
    assert line.along == "r" and line.pressure[0] == pytest.approx(line.pressure.max())
    result.save(tmp_path / "a")
    stored = cd.read(tmp_path / "a")
    assert isinstance(stored, cd.HistoryResult) and stored == result and stored.title == result.title
    assert np.array_equal(stored.fields[1].pressure, last.pressure) and stored.fields[1].spacing == last.spacing
    assert np.array_equal(stored.profiles[0].lines[0].displacement, line.displacement)
    stored.save(tmp_path / "b")
    assert pickle.loads(pickle.dumps(cd.read(tmp_path / "b"))) == result
    again = pickle.loads(pickle.dumps(result))
    assert again == result and np.array_equal(again.fields[1].displacement, last.displacement)


def test_a_history_that_was_read_is_saved_whole(tmp_path: Path) -> None:
    sine = {"kind": "sine", "mean": 5.0, "amplitude": 2.0, "frequency": "0.1 Hz", "cycles": 2}
    result = cd.simulate(PMMA, cd.Sphere("10 mm"), springs=32, segments=[sine], profiles_at=[5.0])
    result.save(tmp_path / "a")
    cd.read(tmp_path / "a").save(tmp_path / "b")
    again = cd.read(tmp_path / "b")
    assert isinstance(again, cd.HistoryResult) and again.cycles == result.cycles and len(again.cycles["energy_loss_j"]) == 2
    assert again.profiles == result.profiles and result.cycles.to_pandas().shape[0] == 2


def test_the_damaged_folder_of_a_history_is_refused_with_file_and_line(tmp_path: Path) -> None:
    held().save(tmp_path)
    table = tmp_path / "history.csv"
    head, first, *rows = table.read_text().splitlines()
    table.write_text("\n".join([head, first, "abc" + rows[0][rows[0].index(",") :], *rows[1:]]) + "\n")
    with pytest.raises(ValueError, match=r"history\.csv:3"):
        cd.read(tmp_path)
    table.write_text("\n".join([head, first]) + "\n")
    (tmp_path / "summary.json").write_text("{}")
    with pytest.raises(ValueError, match=r"summary\.json"):
        cd.read(tmp_path)


def test_a_history_that_ends_early_warns_and_can_raise() -> None:
    far = [{"kind": "ramp", "to": "1 mm", "duration": "1 s"}]
    x = np.linspace(-1e-4, 1e-4, 17)
    tip = cd.HeightMap(-np.add.outer(x**2, x**2) / 2e-3, spacing=x[1] - x[0])
    with pytest.warns(cd.ContactDmaWarning, match="before its time"):
        result = cd.simulate(PMMA, tip, segments=far, control="approach", step=0.1)
    with pytest.raises(RuntimeError, match="before its time"):
        result.raise_for_status()
    held().raise_for_status()


def test_arrays_drive_and_samples_as_they_are() -> None:
    time = np.linspace(0.0, 10.0, 21)
    table = {"kind": "table", "times": time, "values": np.sin(np.pi * time / 10.0) + 0.1 * time}
    samples = np.logspace(-2, 2, 40)
    solid = cd.Material.table(
        samples, 1e-9 * (2 - np.exp(-samples)), quantity="creep", poisson_ratio=0.4, evaluation="direct"
    )
    result = cd.simulate(solid, cd.Sphere(0.01), segments=[table], springs=32, step=0.5)
    assert result["load_n"][-1] == pytest.approx(1.0) and (result["approach_m"][1:] > 0).all()
    assert pickle.loads(pickle.dumps(solid)) == solid and pickle.loads(pickle.dumps(result)) == result
    with pytest.raises(ValueError, match="samples"):
        solid.complex_modulus(1.0)


def test_a_history_has_its_summary_and_the_figures_that_the_program_draws(tmp_path: Path, program: str) -> None:
    result = held(fields_at=[100.0, 200.0], field_cells=16, error_bars=False)
    result.save(tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text()) == result.summary
    subprocess.run([program, "report", str(tmp_path)], check=True, capture_output=True)
    assert set(result.figures) == {path.stem for path in (tmp_path / "figures").glob("*.svg")}
    assert {"load-approach", "pressure-map", "pressure-map-1"} <= set(result.figures)
    assert "history" in result.figures and "<svg" in str(result.figures["history"]._repr_html_())


def test_large_arrays_are_not_copied_by_python() -> None:
    heights = -np.add.outer(np.linspace(-1, 1, 1024) ** 2, np.linspace(-1, 1, 1024) ** 2) * 1e-6
    tracemalloc.start()
    map = cd.HeightMap(heights, spacing="1 um")
    held_bytes, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # The file of the array, once, by which it is pickled and saved.
    assert map.gaps.shape == (1024, 1024) and held_bytes < 8 * 1024**2 + 100_000

    result = held(fields_at=[200.0], field_cells=1024, error_bars=False, step=100.0)
    tracemalloc.start()
    (field,) = result.fields
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # The three arrays are 25 MB; their headers are a few kilobytes.
    assert field.pressure.nbytes == 8 * 1024**2 and most < 100_000
