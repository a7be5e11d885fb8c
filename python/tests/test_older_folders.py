"""Folders of the layout before ``figures/`` and ``cases/`` are read as those of today."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from conftest import small_sweep

import contact_dma as cd


def older(folder: Path) -> Path:
    """Moves the files of a folder to where earlier versions had them."""
    run = json.loads((folder / "run.json").read_text())
    names = []
    for name in run["files"]:
        first, _, below = name.partition("/")
        is_moved = first in ("figures", "cases") or name in ("records/figures.json", "records/analysis.json")
        names.append(below if is_moved else name)
        if is_moved:
            (folder / below).parent.mkdir(exist_ok=True)
            (folder / name).rename(folder / below)
    (folder / "run.json").write_text(json.dumps({**run, "files": names}))
    return folder


def test_every_result_comes_back_from_an_older_folder(tmp_path: Path) -> None:
    t = np.linspace(0.0, 20.0, 2001)
    loop = {"time": t, "load": 1 + 0.5 * np.sin(3 * t), "approach": 1e-5 + 2e-6 * np.sin(3 * t - 0.2)}
    solid, sphere = cd.Material.relaxation("10 MPa", [("30 MPa", "1 s")], poisson_ratio=0.45), cd.Sphere("2 mm")
    drive: dict[str, Any] = {"mean": "0.2 N", "amplitude": "0.1 N"}
    cycles = cd.sweep(solid, sphere, angular_frequency=[0.1, 1.0, 10.0], **drive)
    data = {name: cycles[name] for name in ["angular_frequency_rad_per_s", "energy_loss_j", "approach_max_m"]}
    segments = [{"kind": "ramp", "to": "5 N", "duration": "10 s"}]
    history = cd.simulate(cd.Material.library("pmma"), cd.Sphere("10 mm"), springs=32, segments=segments, profiles_at=["5 s"])
    found = cd.identify(data, sphere, poisson_ratio=0.45, branches=1, **drive)
    results: dict[str, cd.SweepResult | cd.HistoryResult | cd.AnalysisResult | cd.IdentifiedMaterial]
    results = {"sweep": small_sweep(), "history": history, "analysis": cd.analyse(loop), "solid": found}
    for name, result in results.items():
        result.save(tmp_path / name)
        again = cd.read(older(tmp_path / name))
        if isinstance(again, cd.IdentifiedMaterial):
            assert again.material == found.material and again.moduli == found.moduli and set(again.figures) == set(found.figures)
        else:
            assert again == result
        if isinstance(again, cd.HistoryResult):
            assert np.array_equal(again.profiles[0].lines[0].pressure, history.profiles[0].lines[0].pressure)
