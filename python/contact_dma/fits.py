"""Fits of materials to data: what is known of them, and the columns that they are made of."""

from __future__ import annotations

import csv
import html
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _toml
from ._result import Columns, Floats, table, warn

_COLD_K = 120.0
"""Instruments cooled with liquid nitrogen reach -150 °C: a smaller number without unit is a temperature in °C, most likely."""


def warn_of_celsius(call: str, **temperatures: Any) -> None:
    """Warns of temperatures without unit that are degrees Celsius, most likely."""
    for name, given in temperatures.items():
        if given is None or isinstance(given, str) or _toml.has_unit(given):
            continue
        array = np.asarray(given)
        if array.dtype.kind in "iuf" and array.size > 0:
            lowest, highest = float(np.min(array)), float(np.max(array))
            if lowest < _COLD_K:
                warn(f"{call}: {name} is {lowest:g} to {highest:g} K: numbers are in kelvin; degrees Celsius are strings, '{lowest:g} °C'")


@dataclass(frozen=True, repr=False)
class MaterialFit:
    """How a series was fitted to data.

    Attributes:
        misfit: root mean square of the difference to the data, relative to these; of storage and loss modulus the larger.
        notes: what the reader assumed or left out.
        warnings: what to know before the series is used.
        report: what the program prints, one fact a line.
        summary: numbers by name: of dynamic data what the program writes to ``summary.json``, with the constants of the laws, ``wlf``
            and ``arrhenius``.
        shift_factors: of isotherms the columns ``temperature_c``, ``log10_a_t``, ``log10_a_t_error``; None without.
        master_curve: of dynamic data the columns ``angular_frequency_rad_per_s`` (reduced), ``storage_modulus_pa``,
            ``loss_modulus_pa``, ``temperature_c``, and of the series ``storage_fit_pa``, ``loss_fit_pa``; None of a table over time.
    """

    misfit: float
    notes: tuple[str, ...]
    warnings: tuple[str, ...]
    report: tuple[str, ...]
    summary: Mapping[str, Any]
    shift_factors: Columns | None
    master_curve: Columns | None

    @classmethod
    def _of(cls, report: Sequence[str], notes: Sequence[str], warnings: Sequence[str], files: Sequence[tuple[str, bytes]]) -> MaterialFit:
        contents = dict(files)
        summary: dict[str, Any] = json.loads(contents["summary.json"])
        rms = ("storage_relative_rms", "loss_relative_rms", "relative_rms")
        misfit = max(float(summary[name]) for name in rms if name in summary)
        columns = [table(contents[name]) if name in contents else None for name in ("shift.csv", "master.csv")]
        return cls(misfit, tuple(notes), tuple(warnings), tuple(report), summary, *columns)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<MaterialFit: misfit {100 * self.misfit:.2g} %, {len(self.warnings)} warnings, {len(self.notes)} notes>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(chr(10).join(self.report))}</pre>"


def warn_of_unread(call: str, columns: Mapping[str, Any], fit: MaterialFit | None) -> None:
    """Warns of columns that the reader passed over, such as one whose name is misspelt."""
    read = next((note for note in fit.notes if note.startswith("columns read: ")), "") if fit is not None else ""
    unread = [name for name in columns if f"`{name}`" not in read]
    if read and unread:
        warn(f"{call}: columns that are not read: {', '.join(unread)}")


POOR_FIT = 0.2
"""Relative misfit above which a fit warns."""


def dynamic_columns(given: _toml.TableLike) -> dict[str, Any]:
    """Dynamic data as the columns of a file: those with the names of arguments in SI units, others as they are."""
    columns = {str(name): given[name] for name in given.keys()}
    units = {"angular_frequency": "rad/s", "frequency": "Hz", "storage_modulus": "Pa", "loss_modulus": "Pa"}
    units |= {"tan_delta": "", "temperature": "K"}
    names = {"rad/s": "_rad_per_s", "Hz": "_hz", "Pa": "_pa", "K": "_k"}
    own = {name: columns.pop(name) for name in units if columns.get(name) is not None}
    if not own and columns:
        return columns
    warn_of_celsius("Material.from_dynamic(...)", temperature=own.get("temperature"))
    numbers = {name: _toml.si(values, units[name], name).reshape(-1) for name, values in own.items()}
    lacks_loss = "loss_modulus" not in own and "tan_delta" not in own
    if ("angular_frequency" in own) == ("frequency" in own) or "storage_modulus" not in own or lacks_loss:
        raise ValueError("from_dynamic needs a file, or angular_frequency or frequency, storage_modulus, and loss_modulus or tan_delta")
    refuse_lengths(numbers)
    tan_delta = numbers.pop("tan_delta", None)
    if tan_delta is not None:
        of_tangent = numbers["storage_modulus"] * tan_delta
        if not np.allclose(numbers.get("loss_modulus", of_tangent), of_tangent, rtol=0.05, atol=0.0, equal_nan=True):
            warn("Material.from_dynamic(...): tan_delta is not loss_modulus / storage_modulus: the loss modulus is taken")
        numbers.setdefault("loss_modulus", of_tangent)
    omega = numbers.get("angular_frequency", numbers.get("frequency", np.empty(0)))
    if "temperature" not in numbers and len(np.unique(omega)) < len(omega):
        warn(
            "Material.from_dynamic(...): frequencies are given more than once and no temperature: all are fitted by one series; "
            "for isotherms give the temperature of every point"
        )
    return {name + names[units[name]]: values for name, values in numbers.items()} | columns


def refuse_lengths(columns: Mapping[str, Floats], of: str = "") -> None:
    """Refuses columns of which one has more rows than another."""
    if len({len(array) for array in columns.values()}) > 1:
        counts = ", ".join(f"{name} {len(array)}" for name, array in columns.items())
        raise ValueError(f"{of}columns must have as many rows as one another: {counts}")


def table_text(columns: Mapping[str, Any]) -> str:
    """Columns as the text of a table: numbers without losing a bit, those of names with an SI unit in it, cells empty where one is NaN."""
    arrays = {name: _toml.si(values, _toml.unit_of(name), name).reshape(-1) for name, values in columns.items()}
    refuse_lengths(arrays)
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(arrays)
    writer.writerows(["" if cell != cell else repr(cell) for cell in row] for row in zip(*(array.tolist() for array in arrays.values())))
    return text.getvalue()
