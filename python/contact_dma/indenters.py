"""What all indenters have; their classes are made of the keys of each shape, in ``_calls``."""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _contact_dma as _core
from . import _toml
from ._result import Floats
from .fits import table_text


class Indenter:
    """A rigid indenter. Lengths are numbers in metres or strings with units; indenters cannot be changed, compare by value, and pickle.
    What they were given is theirs by the names of the arguments, in SI units.

    Example:
        >>> from contact_dma import *
        >>> ball = Sphere("10 mm")
        >>> ball, ball.radius
        (Sphere(radius='10 mm'), 0.01)
        >>> round(float(Cone("45 deg").gap(1e-3)), 12), float(FlatPunch("1 mm").gap(0.5e-3))
        (0.001, 0.0)
        >>> float(Ellipsoid("10 mm", "20 mm").gap(1e-4)), float(PowerLaw(4.0, radius="1 mm", height="10 um").gap(1e-3))
        (5e-07, 1e-05)
        >>> Asperities([(0.0, 0.0, 1e-3), (2e-3, 0.0, 1e-3, -1e-6)])
        Asperities(asperities=<2>)
        >>> rough = Rough(64, spacing="1 um", hurst_exponent=0.8, rms_height="50 nm", cut_off_wavelength="8 um", seed=1)
        >>> bool(rough.gap(0.0) >= 0.0), rough.gaps.shape
        (True, (64, 64))

        A measured or computed profile of revolution, and a surface, one value per cell of a grid that is centred on the origin:

        >>> import numpy as np
        >>> r = np.linspace(0.0, 1e-3, 65)
        >>> round(float(Profile(r, r**2 / 0.02).gap(1e-3)), 12)
        5e-05
        >>> x = np.linspace(-1e-3, 1e-3, 65)
        >>> map = HeightMap(-(x**2 + x[:, None]**2) / 0.02, spacing=x[1] - x[0])
        >>> map.gaps.shape, float(map.gaps.min())
        ((65, 65), 0.0)
    """

    __slots__ = ("_core", "_text", "_call", "_tables")

    _core: _core.Shape
    _text: str
    _call: str
    _tables: list[tuple[str, bytes]]  # What the text names as files.

    def _make(self, shape: str, keys: Mapping[str, Any], **data: Any) -> None:
        """Of keys by their dotted names, and of data: a file, a table, or arrays."""
        shown, tables, file = [], [], {}
        keys = dict(keys)
        for argument, given in list(data.items())[:1]:
            if argument == "heights" and _is_topography(given):
                given = _of_topography(given, keys)
            if isinstance(given, (str, os.PathLike)):
                file["indenter.file"] = _toml.path(given)
                shown.append(f"file={file['indenter.file']!r}")
                continue
            content = _map(given, keys) if argument == "heights" else _profile(given, data.get("gap"))
            # By its content, so that several of one call differ.
            file["indenter.file"] = name = f"argument `{argument}` [{hashlib.sha256(content).hexdigest()[:16]}]"
            tables.append((name, content))
            shown.append("<table>" if _toml.is_table(given) else f"<{' x '.join(map(str, np.shape(given)))} numbers>")
        shown += (f"{name.removeprefix('indenter.')}={_brief(given)}" for name, given in keys.items())
        text = _toml.document(_toml.tables({"indenter.shape": shape, **file, **keys}))
        self._set(text, f"{type(self).__name__}({', '.join(shown)})", tables)

    def _set(self, text: str, call: str, tables: list[tuple[str, bytes]]) -> None:
        self._text, self._call, self._tables = text, call, tables
        self._core = _core.Shape(f"{type(self).__name__}(...)", text, tables)

    def gap(self, x: npt.ArrayLike, y: npt.ArrayLike = 0.0) -> Any:
        """Gap (m) between the undeformed indenter and the half-space at points x, y (m), which broadcast; inf where it ends.

        Example:
            >>> from contact_dma import Sphere
            >>> round(float(Sphere("10 mm").gap(3e-4, 4e-4)), 12)
            1.25e-05
        """
        first, second = np.broadcast_arrays(_toml.si(x, "m", "x"), _toml.si(y, "m", "y"))
        return self._core.gap(first.ravel(), second.ravel()).reshape(first.shape)[()]

    @property
    def gaps(self) -> Floats:
        """Gap (m) at every point of a height map or a rough surface, shape (cells along y, cells along x)."""
        return self._core.gaps()

    def __eq__(self, other: object) -> bool:
        """Whether shape and settings are the same, and what files and arrays hold."""
        return self._core.key() == other._core.key() if isinstance(other, Indenter) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._core.key())

    def __repr__(self) -> str:
        return self._call

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), self._text, self._call, self._tables))


def _restored(cls: type[Indenter], *made: Any) -> Indenter:
    indenter = cls.__new__(cls)
    indenter._set(*made)
    return indenter


def _brief(given: Any) -> str:
    """What was given, of tables how many."""
    is_long = isinstance(given, list) and given and isinstance(given[0], Mapping)
    return f"<{len(given)}>" if is_long else repr(given)


def _is_topography(given: Any) -> bool:
    """Whether it is a topography of the package SurfaceTopography."""
    return callable(getattr(given, "heights", None)) and hasattr(given, "pixel_size") and hasattr(given, "unit")


_METRES = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "\u00b5m": 1e-6, "\u03bcm": 1e-6, "nm": 1e-9, "pm": 1e-12, "\u00c5": 1e-10}


def _of_topography(given: Any, keys: dict[str, Any]) -> Floats:
    """Heights (m) of a topography, rows along y, and its spacing among the keys."""
    unit = _METRES.get(str(given.unit))
    if unit is None:
        raise ValueError(f"the topography has the unit {given.unit!r}: give it one of {', '.join(_METRES)}")
    if len(given.pixel_size) != 2:
        raise ValueError("the topography is a line: give a map, or its points to Profile")
    keys["indenter.spacing"] = [f"{unit * float(step)!r} m" for step in given.pixel_size]
    return np.ascontiguousarray(unit * np.asarray(given.heights(), dtype=np.float64).T)


def _map(heights: Any, keys: Mapping[str, Any]) -> bytes:
    """A matrix as a file of NumPy."""
    values = _toml.si(heights, "m", "heights") if _toml.has_unit(heights) else np.asarray(heights, dtype=np.float64)
    if _toml.has_unit(heights) and "indenter.height_unit" in keys:
        raise ValueError("heights have a unit already: leave out height_unit")
    if values.ndim != 2:
        raise ValueError(f"heights have shape {values.shape}: give an array of rows along y and columns along x")
    file = io.BytesIO()
    np.save(file, np.ascontiguousarray(values))
    return file.getvalue()


def _profile(radii: Any, gap: Any) -> bytes:
    """The points of a profile as a CSV file."""
    columns = {str(name): radii[name] for name in radii.keys()} if _toml.is_table(radii) else {"r": radii, "gap": gap}
    if any(column is None for column in columns.values()):
        raise ValueError("a profile is a file, a table of radii and gaps, or both as arrays: Profile(r, gap)")
    return table_text({f"{name}_m" if name in ("r", "gap") else name: column for name, column in columns.items()}).encode()
