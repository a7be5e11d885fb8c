"""Measured loops, and materials identified from measured cycles."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias, Union

import numpy as np

from . import _calls, _toml
from . import _contact_dma as _core
from ._contact_dma import MeasuredCycle as MeasuredCycle
from ._result import Columns, Figure, Result, Table, failures, table, warn
from ._sources import Source, source_of_values, thread_count, warn_without_effect
from .fits import refuse_lengths, table_text
from .indenters import Indenter
from ._toml import Quantity
from .materials import Material, Prony

Record: TypeAlias = Union[str, "os.PathLike[str]", _toml.TableLike]
"""A record of load and approach: a file, or columns ``{"time": ..., "load": ..., "approach": ...}`` in s, N and m, shape (n,), of a
dictionary or data frame; ``time_s``, ``load_n`` and ``approach_m`` are the same."""


class AnalysisResult(_core.Loops, Result):
    """What measured loops say: the columns of a sweep, one row a record by ascending frequency, with their errors.

    Example:
        >>> import numpy as np
        >>> import contact_dma as cd
        >>> t = np.linspace(0.0, 10.0, 1001)
        >>> record = {"time": t, "load": 10 + 5 * np.sin(6 * t), "approach": 1e-5 + 2e-6 * np.sin(6 * t - 0.1)}
        >>> result = cd.analyse(record)
        >>> round(float(result["phase_lag_rad"][0]), 4)
        0.1
    """

    def _failures(self) -> str | None:
        return failures(self.status, "record")

    def __repr__(self) -> str:
        done = sum(status.converged for status in self.status)
        return f"<AnalysisResult: {done} of {len(self.status)} records have a loss>"


def analyse(
    records: Record | Sequence[Record],
    *,
    frequency: Quantity | None = None,
    setup: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    threads: int | None = None,
) -> AnalysisResult:
    """Reads energy loss, phase lag and moduli from measured loops, with their uncertainties.

    Args:
        records: one or several: files as instruments write them, dictionaries of arrays, data frames.
        frequency: that of all records (Hz), where it is known.
        setup: what is known of instrument and contact: a file, or its tables, ``{"instrument": {"frame_compliance": "0.5 um/N"},
            "contact": {"poisson_ratio": 0.38}, "indenter": cd.Sphere("1 mm")}``.
        threads: how many, as in `sweep`.

    Warns:
        ContactDmaWarning: of records without a result; ``result.raise_for_status()`` makes an exception of them.

    Raises:
        ValueError: with the program's message, for files that cannot be read and bad settings.
        FileNotFoundError: where a file is not there.
        KeyboardInterrupt: within a second of Ctrl-C.

    Example:
        >>> import numpy as np
        >>> import contact_dma as cd
        >>> t = np.linspace(0.0, 10.0, 1001)
        >>> record = {"time": t, "load": 10 + 5 * np.sin(6 * t), "approach": 1e-5 + 2e-6 * np.sin(6 * t - 0.1)}
        >>> loss = cd.analyse(record)["energy_loss_j"][0]
        >>> bool(abs(loss / (np.pi * 5.0 * 2e-6 * np.sin(0.1)) - 1) < 1e-6)
        True
    """
    several = not isinstance(records, (str, os.PathLike)) and not _toml.is_table(records)
    each: list[Record] = list(records) if several else [records]  # type: ignore[arg-type,list-item]
    if _toml.is_list(frequency):
        raise ValueError("frequency is that of all records, one number: analyse records of other frequencies apart")
    hertz = None if frequency is None else float(_toml.si(frequency, "Hz", "frequency"))
    given = [_record(record, k) for k, record in enumerate(each)]
    result = AnalysisResult(given, hertz, _setup(setup), thread_count(threads))
    result._warn_of_failures("analyse")
    return result


def _record(record: Record, index: int) -> Any:
    if not _toml.is_table(record):
        return _toml.existing(record)  # type: ignore[arg-type]
    units = {"time": "s", "load": "N", "approach": "m"}
    names = {name: [own for own in record.keys() if str(own) in (name, f"{name}_{unit.lower()}")] for name, unit in units.items()}
    missing = [name for name, own in names.items() if not own]
    if missing:
        raise ValueError(f"record {index} has no {' and no '.join(missing)}: give time (s), load (N) and approach (m)")
    twice = [own for own in names.values() if len(own) > 1]
    if twice:
        raise ValueError(f"record {index} has both {' and '.join(map(str, twice[0]))}: give one of them")
    columns = {name: _toml.si(record[names[name][0]], unit, f"record {index}, {name}") for name, unit in units.items()}
    for name, column in columns.items():
        if column.ndim != 1:
            raise ValueError(f"record {index}, {name} has shape {column.shape}: give an array of shape (n,), and several records as a list")
    time = columns["time"]
    refuse_lengths(columns, f"record {index}: ")
    if len(time) > 1 and time[-1] < time[0]:
        raise ValueError(f"record {index}: times descend, from {time[0]:g} s to {time[-1]:g} s: turn the columns round")
    return (f"record {index}", list(columns.values()))


def _setup(setup: str | os.PathLike[str] | Mapping[str, Any] | None) -> tuple[str, str | None]:
    if setup is None:
        return ("setup", None)
    if not isinstance(setup, Mapping):
        return (os.fspath(setup), Path(setup).read_text(encoding="utf-8"))
    bodies = [entries for entries in setup.values() if isinstance(entries, Indenter)]
    if any(body._tables for body in bodies):
        raise ValueError("the indenter of a setup is given by its keys or a file, not by arrays")
    others = {name: entries for name, entries in setup.items() if not isinstance(entries, Indenter)}
    tables = {name: entries for name, entries in others.items() if isinstance(entries, Mapping)}
    head = {name: entries for name, entries in others.items() if name not in tables}
    return ("setup", _toml.document({"": head, **tables}) + "".join(body._text for body in bodies))


class IdentifiedMaterial:
    """A material identified from measured cycles, and how certain it is.

    Attributes:
        material: for sweeps.
        report: what was found, one sentence a line.
    """

    _FILES = (
        "material.toml", "resolved.toml", "prony.csv", "fit.csv", "summary.json", "figures/moduli.csv", "records/figures.json",
    )
    """Those of its folder that it is read from."""

    def __init__(self, files: Sequence[tuple[str, bytes]]) -> None:
        self._files = dict(files)
        block = self._files["material.toml"].decode("utf-8")
        self.material = Material._of("the identified material", block)
        comments = [line.removeprefix("# ") for line in block.splitlines() if line.startswith("# ")]
        # Below the title; what goes on in another line begins with blanks.
        self.report = tuple("\n".join(comments[1:]).replace("\n  ", " ").splitlines())

    @property
    def prony(self) -> Prony:
        """Its relaxation modulus E(t): equilibrium modulus (Pa), moduli (Pa) and times (s)."""
        return self.material.prony

    @property
    def summary(self) -> dict[str, Any]:
        """What the program writes to ``summary.json``: unknowns with intervals, candidates, what is not determined."""
        summary: dict[str, Any] = json.loads(self._files["summary.json"])
        return summary

    @property
    def fit(self) -> Columns:
        """Data and model, the columns of ``fit.csv``."""
        return table(self._files["fit.csv"])

    @property
    def moduli(self) -> Columns:
        """E' and E'' with their bands over frequency, the columns of ``figures/moduli.csv``."""
        return table(self._files["figures/moduli.csv"])

    @property
    def figures(self) -> dict[str, Figure]:
        """The figures that the program draws of it, by name, as those of a sweep."""
        return {figure.name: figure for figure in _core.kept_figures(self._files["records/figures.json"])}

    def save(self, folder: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Writes the tables that ``contact-dma identify`` writes: ``material.toml``, ``prony.csv``, ``fit.csv``, ``figures/moduli.csv``,
        ``summary.json``, ``resolved.toml``; ``contact-dma report FOLDER`` draws figures and page.

        Args:
            folder: a new or empty folder, or one of an identification.
            overwrite: whether another result there is replaced; files of others stay.
        """
        _core.write_identification(os.fspath(folder), list(self._files.items()), overwrite)

    def __repr__(self) -> str:
        return f"<IdentifiedMaterial of {len(self.prony.moduli)} branches>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(chr(10).join(self.report))}</pre>"


@_calls.body("identify")
def _identify(
    keys: Mapping[str, Any],
    data: str | os.PathLike[str] | _toml.TableLike | _toml.ForceCurveLike | Sequence[_toml.ForceCurveLike] | None = None,
    indenter: Indenter | None = None,
    *,
    file: str | os.PathLike[str] | None = None,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    **bodies: Any,
) -> IdentifiedMaterial:
    """Finds the solid, a Prony series, whose computed cycles, or whose computed history, have the measured numbers.

    {arguments}

    Warns:
        ContactDmaWarning: of everything that the report warns of, such as a solid that misses the data.

    Raises:
        ValueError: with the program's message, for data that no solid has, and bad input.
        KeyboardInterrupt: within a second of Ctrl-C.

    Example:
        >>> import contact_dma as cd
        >>> solid = cd.Material.relaxation("10 MPa", [("30 MPa", "1 s")], poisson_ratio=0.45)
        >>> drive = {"mean": "0.2 N", "amplitude": "0.1 N"}
        >>> cycles = cd.sweep(solid, cd.Sphere("2 mm"), angular_frequency=[0.1, 0.3, 1.0, 3.0, 10.0], **drive)
        >>> columns = ["angular_frequency_rad_per_s", "energy_loss_j", "approach_max_m"]
        >>> found = cd.identify({name: cycles[name] for name in columns}, cd.Sphere("2 mm"), poisson_ratio=0.45, **drive)
        >>> bool(abs(found.prony.equilibrium / 10e6 - 1) < 0.01)
        True
    """
    keys = dict(keys)
    if file is not None:
        if data is not None or indenter is not None:
            raise ValueError("identify takes a file, or data and indenter, not both")
        source = Source(_toml.existing(file), None, _toml.overrides(overrides))
        return _identified(source, threads)
    curves = keys.pop("identify.curve", None)
    if (data is None) == (curves is None) or not isinstance(indenter, Indenter):
        raise ValueError("identify(data, indenter, ...) needs measured cycles and the indenter, curve=[...] and the indenter, or file=...")
    if overrides is not None:
        raise ValueError("overrides change a file; write options as arguments: branches=3 in place of {'identify.branches': 3}")
    several = data if isinstance(data, (list, tuple)) else [data]
    name, tables, call = "argument `data`", [], "identify"
    if curves is not None or all(map(_is_force_curve, several)):
        call, names = "identify-curve", curves
        if curves is None:
            names = [f"{name} {number}" for number, _ in enumerate(several)]
            tables = [(name, _of_force_curve(curve)) for name, curve in zip(names, several, strict=True)]
        keys = {"identify.curve": names, **{key: given for key, given in keys.items() if not key.startswith(_OF_CYCLES)}}
    else:
        if _toml.is_table(data):
            tables = [(name, table_text(_columns(data)).encode())]
        else:
            name = _toml.path(data)  # type: ignore[arg-type]
        keys = {"identify.data": name, **keys}
    source = source_of_values(call, keys, None, indenter, tables=tables, **bodies)
    found = _identified(source, threads)
    warn_without_effect("identify", source, keys, found._files["resolved.toml"].decode("utf-8"))
    return found


_OF_CYCLES = ("drive.", "cycle.", "solver.")
"""Keys of the model of cycles, of which force curves have none."""


def _is_force_curve(data: Any) -> bool:
    """Whether it is a force curve of the package afmformats."""
    return hasattr(data, "metadata") and hasattr(data, "columns") and not _toml.is_table(data) and "force" in data.columns


def _of_force_curve(data: Any) -> bytes:
    """Its time, force and indentation as a table: the height falls while the probe comes nearer, and bends by the force over its spring constant."""
    heights = [name for name in ("height (measured)", "height (piezo)") if name in data.columns]
    spring = data.metadata.get("spring constant", float("nan"))
    if not heights or "time" not in data.columns or not spring > 0.0:
        raise ValueError("a force curve needs the columns `time` and `height (measured)` and the metadata `spring constant`")
    time, force, height = (np.asarray(data[name], dtype=np.float64) for name in ("time", "force", heights[0]))
    return table_text({"time_s": time, "force_n": force, "indentation_m": -height - force / spring, "piezo_m": -height}).encode()


def _identified(source: Source, threads: int | None) -> IdentifiedMaterial:
    found = IdentifiedMaterial(_core.identify_material(source, thread_count(threads)))
    for line in found.report:
        if line.startswith("Warning: "):
            warn(f"identify: {line.removeprefix('Warning: ')}")
    return found


_TEXTS = ("file", "indenter", "material", "message", "status", "warnings")
"""Columns of results that hold text."""


def _columns(data: _toml.TableLike) -> dict[str, Any]:
    columns = {str(name): data[name] for name in data.keys() if str(name) not in _TEXTS}
    if isinstance(data, Table):
        # Of a result all that is text has no number in any row.
        columns = {name: values for name, values in columns.items() if np.asarray(values).dtype.kind in "iuf"}
    return columns
