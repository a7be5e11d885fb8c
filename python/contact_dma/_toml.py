"""Arguments as the text of an input file, so that keys, ranges, units and messages are those of the program."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import Any, Protocol, TypeAlias, TypeGuard, Union

import numpy as np
import numpy.typing as npt

from . import _contact_dma as _core


Quantity: TypeAlias = Union[float, str]
"""A number in SI units, or a string with a unit: ``0.01`` or ``"10 mm"``."""


class TableLike(Protocol):
    """Columns by name: a dictionary of arrays, a data frame, a result."""

    def keys(self) -> Iterable[Any]: ...
    def __getitem__(self, name: Any, /) -> Any: ...


class ForceCurveLike(Protocol):
    """A force curve of afmformats: columns by name, and settings."""

    columns: Any
    metadata: Any

    def __getitem__(self, name: str, /) -> Any: ...


class TopographyLike(Protocol):
    """A map of SurfaceTopography: heights with the first axis along x, and the size of a pixel, in a unit."""

    @property
    def unit(self) -> Any: ...

    @property
    def pixel_size(self) -> Any: ...

    def heights(self) -> Any: ...


def is_table(given: object) -> TypeGuard[TableLike]:
    """Whether this has columns by name."""
    return hasattr(given, "keys") and hasattr(given, "__getitem__")


_UNITS = {"kilogram": "kg", "gram": "g", "meter": "m", "centimeter": "cm", "second": "s", "radian": "rad", "kelvin": "K", "deg_C": "degC"}
"""Base units by the names that pint and astropy have for them."""


def _magnitude_and_unit(given: Any) -> tuple[Any, str] | None:
    """A quantity of pint or astropy in base units: its number or numbers, and the unit as the program reads it; None of what is none."""
    if hasattr(given, "to_base_units"):
        base = given.to_base_units()
        magnitude, powers = base.magnitude, list(base.unit_items())
        is_hertz = any("hertz" in name for name, _ in given.unit_items())
    elif hasattr(given, "decompose") and hasattr(given, "unit"):
        base = given.decompose()
        magnitude, powers = base.value, [(unit.name, power) for unit, power in zip(base.unit.bases, base.unit.powers)]
        is_hertz = any(unit.name.endswith("Hz") for unit in given.unit.bases)
    else:
        # A labelled array of xarray around one of pint.
        inner = getattr(given, "data", None)
        return _magnitude_and_unit(inner) if hasattr(inner, "to_base_units") else None
    powers = [(_UNITS.get(name, name), float(power)) for name, power in powers]
    # Both libraries take Hz for 1/s, which may be rad/s as well.
    if is_hertz and powers == [("s", -1.0)]:
        return magnitude, "Hz"
    return magnitude, " ".join(name if power == 1 else f"{name}^{power:g}" for name, power in powers)


def rows(name: str, given: Any, keys: Sequence[tuple[str, int, bool]]) -> list[Any]:
    """Rows as tables of these keys, of which each has so many values and may be left out at the end; tables as they are."""
    labels = [f"{key}_{axis}" if count > 1 else key for key, count, _ in keys for axis in "xyz"[:count]]
    least = sum(count for _, count, needed in keys if needed)
    form = f"write a list of rows such as ({', '.join(labels)})"
    if isinstance(given, (str, Mapping)) or not hasattr(given, "__iter__"):
        raise ValueError(f"{name} is {given!r}: {form}")
    made: list[Any] = []
    for row in given:
        if isinstance(row, Mapping):
            made.append(row)
            continue
        if isinstance(row, str) or not hasattr(row, "__len__") or not least <= len(row) <= len(labels):
            raise ValueError(f"{name} has the row {row!r}: {form}")
        values = iter(row)
        made.append({key: next(values, None) if count == 1 else list(islice(values, count)) for key, count, _ in keys})
    return made


def has_unit(given: Any) -> bool:
    """Whether this is a quantity of pint or astropy."""
    return _magnitude_and_unit(given) is not None


def value(given: Any) -> str:
    """A value as TOML: numbers without losing a bit, strings, quantities, lists, tables, arrays."""
    if isinstance(given, (bool, np.bool_)):
        return "true" if given else "false"
    if isinstance(given, (int, np.integer)):
        return str(int(given))
    if isinstance(given, (float, np.floating)):
        return repr(float(given))
    if isinstance(given, str):
        try:
            given.encode()
        except UnicodeEncodeError as error:
            raise ValueError(f"{given!r} is no text: it has half of a character") from error
        return json.dumps(given, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(given, os.PathLike):
        return value(os.fspath(given))
    quantity = _magnitude_and_unit(given)
    if quantity is not None:
        magnitude, unit = quantity
        numbers = np.asarray(magnitude, dtype=np.float64)
        with_unit = [f"{number!r} {unit}" if unit else number for number in numbers.reshape(-1).tolist()]
        return value(with_unit if numbers.ndim else with_unit[0])
    if isinstance(given, Mapping):
        pairs = (f"{key(name)} = {value(item)}" for name, item in given.items() if item is not None)
        return "{ " + ", ".join(pairs) + " }"
    if hasattr(given, "__array__"):
        return value(np.asarray(given).tolist())
    if isinstance(given, Iterable) and not isinstance(given, (bytes, bytearray)):
        return "[" + ", ".join(value(item) for item in given) + "]"
    raise ValueError(f"{given!r} is a {type(given).__name__}: write a number, a string with a unit, or a list of them")


def is_list(given: Any) -> bool:
    """Whether these are several values."""
    return isinstance(given, (list, tuple, range)) or getattr(given, "ndim", 0) > 0


def si(given: Any, unit: str, name: str) -> npt.NDArray[np.float64]:
    """Numbers in an SI unit: of numbers as they are, strings with units, quantities; NaN of None.

    Raises:
        ValueError: names the entry that is neither, or has another dimension.
    """
    quantity = _magnitude_and_unit(given)
    if quantity is not None:
        magnitude, own = quantity
        try:
            # The numbers are in base units: of these the factor is one.
            factor = _core.quantity(f"1 {own}", unit) if own else 1.0
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error
        return np.asarray(magnitude, dtype=np.float64) * factor
    array = np.asarray(given)
    if array.dtype.kind in "iuf":
        return array.astype(np.float64)
    entries = np.asarray(given, dtype=object)
    numbers = [_number(entry, unit, f"{name}, entry {k}") for k, entry in enumerate(entries.reshape(-1).tolist())]
    return np.array(numbers, dtype=np.float64).reshape(entries.shape)


def _number(entry: Any, unit: str, place: str) -> float:
    if entry is None or type(entry).__name__ == "NAType":
        return float("nan")
    if isinstance(entry, (int, float, np.integer, np.floating)) and not isinstance(entry, bool):
        return float(entry)
    if isinstance(entry, str):
        try:
            return _core.quantity(entry, unit) if unit else float(entry)
        except ValueError as error:
            raise ValueError(f"{place}: {error}") from error
    if _magnitude_and_unit(entry) is not None:
        return float(si(entry, unit, place))
    raise ValueError(f"{place} is {entry!r}, a {type(entry).__name__}: write a number, a string with a unit, or None where there is none")


_SUFFIXES = {"_rad_per_s": "rad/s", "_hz": "Hz", "_pa": "Pa", "_j": "J", "_rad": "rad", "_n": "N", "_m": "m", "_s": "s", "_k": "K"}


def split_unit(column: str) -> tuple[str, str]:
    """The name of a column without its unit, and what it has of it."""
    suffix = next((suffix for suffix in _SUFFIXES if column.endswith(suffix)), "")
    return column.removesuffix(suffix), suffix


def unit_of(column: str) -> str:
    """The SI unit that the name of a column ends with; empty where it ends with none."""
    return _SUFFIXES.get(split_unit(column)[1], "")


def key(name: str) -> str:
    """A key, in quotes where it has other characters than letters, digits, `_` and `-`."""
    bare = name.replace("_", "").replace("-", "")
    return name if bare.isascii() and bare.isalnum() else value(name)


def document(tables: Mapping[str, Mapping[str, Any]]) -> str:
    """A file of these tables, "" for what stands before all, without entries that are None; a table without entries stays."""
    text = ""
    for header in sorted(tables, key=lambda header: (header != "", header.count("."))):
        lines = (f"{key(name)} = {_named(name, item)}\n" for name, item in tables[header].items() if item is not None)
        text += (f"[{header}]\n" if header else "") + "".join(lines) + "\n"
    return text


def tables(keys: Mapping[str, Any], *headers: str) -> dict[str, dict[str, Any]]:
    """Dotted keys in the tables that they stand in, beside tables of these headers."""
    made: dict[str, dict[str, Any]] = {header: {} for header in headers}
    for name, item in keys.items():
        header, _, last = name.rpartition(".")
        made.setdefault(header, {})[last] = item
    return made


def _named(name: str, item: Any) -> str:
    """A value as TOML; what is none is refused by its name."""
    try:
        return value(item)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from error


def existing(file: str | os.PathLike[str]) -> str:
    """The path of a file or folder that is there.

    Raises:
        FileNotFoundError: where it is not.
    """
    name = os.fspath(file)
    if not os.path.exists(name):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), name)
    return name


def path(file: str | os.PathLike[str]) -> str:
    """The absolute path of a file that is there, which stays right where it is read from another folder."""
    return os.path.abspath(existing(file))


def overrides(changes: Mapping[str, Any] | None) -> list[str]:
    """Changes of a file as the arguments of `--set`; None removes a key."""
    if changes is not None and not isinstance(changes, Mapping):
        raise ValueError(f"overrides is {changes!r}: write keys and values, such as {{\"cycle.steps\": 48}}")
    return [f"{name}={'' if item is None else value(item)}" for name, item in (changes or {}).items()]
