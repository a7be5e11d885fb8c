"""Folders of the program, read."""

from __future__ import annotations

import os
from pathlib import Path

from . import _contact_dma as _core
from .measurements import AnalysisResult, IdentifiedMaterial
from .sweeps import SweepResult


def read(folder: str | os.PathLike[str]) -> SweepResult | AnalysisResult | IdentifiedMaterial:
    """The result in a folder that the program or `save` has written: of a sweep, of measured loops, or an identified material.

    Nothing is solved, and nothing is written. Cycles of a large sweep stay in the folder until they are asked for. A history is in
    its tables: ``numpy.genfromtxt(folder / "history.csv", delimiter=",", names=True)``.

    Args:
        folder: such as ``reports/pmma``.

    Raises:
        ValueError: where the folder holds no such result.
    """
    path = Path(folder)
    analysis, block = path / "analysis.json", path / "material.toml"
    if analysis.is_file() and not (path / "resolved.toml").exists():
        return AnalysisResult(_core.restore_analysis(analysis.read_bytes()))
    if block.is_file() and (path / "fit.csv").is_file():
        names = ["material.toml", "resolved.toml", "prony.csv", "fit.csv", "moduli.csv", "summary.json"]
        files = [(name, (path / name).read_bytes()) for name in names if (path / name).is_file()]
        text = block.read_text(encoding="utf-8")
        report = [line.removeprefix("# ") for line in text.splitlines() if line.startswith("# ")]
        return IdentifiedMaterial(text, report, files)
    if (path / "history.csv").is_file():
        raise ValueError(f"{path} holds a history: its columns are in history.csv, its fields in fields/*.npy")
    return SweepResult(_core.read_sweep(os.fspath(path)))
