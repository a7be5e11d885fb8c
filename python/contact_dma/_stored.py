"""A history that the program has written, read from its tables in place of computed."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _contact_dma as _core
from ._contact_dma import Field, SurfaceLine, SurfaceProfile, Warning
from ._result import Floats, arrays

Instant = tuple[float, float, float, float]


def table(content: str) -> dict[str, npt.NDArray[Any]]:
    """A CSV file as columns: numbers with NaN for empty cells, or texts."""
    head, *rows = csv.reader(io.StringIO(content))

    def column(cells: Sequence[str]) -> npt.NDArray[Any]:
        try:
            return np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError:
            return np.array(cells)

    return arrays([(name, column([row[k] for row in rows])) for k, name in enumerate(head)])


class StoredHistory:
    """What `_contact_dma.History` knows, from a folder; fields are mapped into memory where they are asked for."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        self._profiles, self._fields = self._index("profiles"), self._index("fields")

    def _read(self, name: str) -> dict[str, npt.NDArray[Any]]:
        return table((self._folder / name).read_text(encoding="utf-8"))

    def _index(self, kind: str) -> dict[str, npt.NDArray[Any]]:
        name = f"{kind}/index.csv"
        return self._read(name) if (self._folder / name).is_file() else {"index": np.empty(0)}

    def columns(self) -> list[tuple[str, Any]]:
        return list(self._read("history.csv").items())

    def cycles(self) -> list[tuple[str, Any]]:
        has_cycles = (self._folder / "cycles.csv").is_file()
        return list(self._read("cycles.csv").items()) if has_cycles else []

    @property
    def title(self) -> str:
        return str(self._summary["title"])

    @property
    def resolved(self) -> str:
        return (self._folder / "resolved.toml").read_text(encoding="utf-8")

    @property
    def failure(self) -> str | None:
        message: str | None = self._summary["message"]
        return "interrupted" if self._summary["status"] == "interrupted" else message

    @property
    def errors_missing(self) -> str | None:
        why: str | None = self._summary["errors_missing"]
        return why

    @property
    def warnings(self) -> tuple[Warning, ...]:
        return tuple(Warning(warning["code"], warning["message"]) for warning in self._summary["warnings"])

    @property
    def profiles(self) -> tuple[SurfaceProfile, ...]:
        return tuple(self._profile(k) for k in range(len(self._profiles["index"])))

    def _profile(self, index: int) -> SurfaceProfile:
        read = self._read(f"profiles/{index}.csv")
        along = read.get("line", np.full(len(read["pressure_pa"]), "r"))
        place = "radius_m" if "radius_m" in read else "position_m"
        names = (place, "pressure_pa", "displacement_m", "gap_m")
        lines = (SurfaceLine(str(name), *(read[column][along == name] for column in names)) for name in dict.fromkeys(along.tolist()))
        return SurfaceProfile(*_instant(self._profiles, index), tuple(lines))

    @property
    def fields(self) -> tuple[Field, ...]:
        return tuple(self._field(k) for k in range(len(self._fields["index"])))

    def _field(self, index: int) -> Field:
        def load(name: str) -> Floats:
            values: Floats = np.load(self._folder / f"fields/{index}-{name}.npy", mmap_mode="r")
            return values

        has_gap = (self._folder / f"fields/{index}-gap_m.npy").is_file()
        spacing = (float(self._fields["spacing_x_m"][index]), float(self._fields["spacing_y_m"][index]))
        gap = load("gap_m") if has_gap else None
        return Field(*_instant(self._fields, index), spacing, load("pressure_pa"), load("displacement_m"), gap)

    def save(self, folder: str, force: bool) -> None:
        existing = Path(folder) / "resolved.toml"
        if existing.is_file() and existing.read_text(encoding="utf-8") != self.resolved and not force:
            raise ValueError(f"{folder} holds another result: choose another folder, or overwrite=True")
        names = ("resolved.toml", "history.csv", "cycles.csv", "summary.json")
        tables = [path for name in names if (path := self._folder / name).is_file()]
        surfaces = sorted(path for kind in ("profiles", "fields") for path in self._folder.glob(f"{kind}/*"))
        files = [(path.relative_to(self._folder).as_posix(), path.read_bytes()) for path in tables + surfaces]
        _core.write_files(folder, "scenario", files, force)


def _instant(index: dict[str, npt.NDArray[Any]], k: int) -> Instant:
    time, load, approach, radius = (float(index[name][k]) for name in ("time_s", "load_n", "approach_m", "contact_radius_m"))
    return (time, load, approach, radius)
