"""Indenters."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _calls, _toml
from . import _contact_dma as _core
from ._result import Floats
from .materials import Quantity


class Indenter:
    """A rigid indenter. Lengths are numbers in metres or strings with units; indenters cannot be changed, compare by value, and pickle.

    Example:
        >>> Sphere("10 mm")
        Sphere(radius='10 mm')
        >>> round(float(Cone("45 deg").gap(1e-3)), 12), float(FlatPunch("1 mm").gap(0.5e-3))
        (0.001, 0.0)
        >>> float(Ellipsoid("10 mm", "20 mm").gap(1e-4)), float(PowerLaw(4.0, radius="1 mm", height="10 um").gap(1e-3))
        (5e-07, 1e-05)
        >>> rough = Rough(64, spacing="1 um", hurst_exponent=0.8, rms_height="50 nm", cut_off_wavelength="8 um", seed=1)
        >>> bool(rough.gap(0.0) >= 0.0)
        True
    """

    __slots__ = ("_core", "_text", "_call")

    _core: _core.Shape
    _text: str | None
    _call: str

    def _made(self, shape: str, **entries: Any) -> None:
        shown = (f"{name}={given!r}" for name, given in entries.items() if given is not None)
        self._call = f"{type(self).__name__}({', '.join(shown)})"
        self._text = _toml.table("indenter", {"shape": shape, **entries})
        self._core = _core.Shape(f"{type(self).__name__}(...)", self._text)

    def _made_of(self, shape: str, keys: Mapping[str, Any], file: str | os.PathLike[str] | None = None) -> None:
        """As `_made`, of keys by their dotted names, and of a file."""
        data = {} if file is None else {"file": _toml.path(file)}
        self._made(shape, **data, **{name.removeprefix("indenter."): entry for name, entry in keys.items()})

    def gap(self, x: npt.ArrayLike, y: npt.ArrayLike = 0.0) -> Any:
        """Gap (m) between the undeformed indenter and the half-space at points x, y (m), which broadcast; inf where it ends.

        Example:
            >>> round(float(Sphere("10 mm").gap(3e-4, 4e-4)), 12)
            1.25e-05
        """
        first, second = np.broadcast_arrays(_toml.si(x, "m", "x"), _toml.si(y, "m", "y"))
        return self._core.gap(first.ravel(), second.ravel()).reshape(first.shape)[()]

    def __eq__(self, other: object) -> bool:
        """Whether shape and settings are the same, and of maps of arrays the gaps."""
        if not isinstance(other, Indenter):
            return NotImplemented
        if self._key() != other._key():
            return False
        return self._text is not None or np.array_equal(self._core.gaps(), other._core.gaps())

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> str:
        return self._core.map_keys() if self._text is None else self._core.key()

    def __repr__(self) -> str:
        return self._call

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), self._text, self._call))


def _restored(cls: type[Indenter], text: str, call: str) -> Indenter:
    indenter = cls.__new__(cls)
    indenter._text, indenter._call = text, call
    indenter._core = _core.Shape(call, text)
    return indenter


# What each is, and its arguments, is said in the tables of the program.
class Sphere(_calls.Sphere, Indenter):
    __slots__ = ()


class Cone(_calls.Cone, Indenter):
    __slots__ = ()


class FlatPunch(_calls.FlatPunch, Indenter):
    __slots__ = ()


class Ellipsoid(_calls.Ellipsoid, Indenter):
    __slots__ = ()


class PowerLaw(_calls.PowerLaw, Indenter):
    __slots__ = ()


class Profile(_calls.Profile, Indenter):
    __slots__ = ()


class Rough(_calls.Rough, Indenter):
    __slots__ = ()


class Asperities(Indenter):
    """Several paraboloids on one rigid body.

    Args:
        asperities: for each ``(x, y, radius)`` or ``(x, y, radius, height)`` (m).

    Example:
        >>> Asperities([(0.0, 0.0, 1e-3), (2e-3, 0.0, 1e-3, -1e-6)])
        Asperities of 2
    """

    __slots__ = ()

    def __init__(self, asperities: Sequence[Sequence[Quantity]]) -> None:
        rows = []
        if not hasattr(asperities, "__iter__") or isinstance(asperities, str):
            raise ValueError(f"asperities are {asperities!r}: give a list of (x, y, radius) or (x, y, radius, height)")
        for given in asperities:
            if not _toml.is_list(given) or len(given) not in (3, 4):
                raise ValueError(f"an asperity is (x, y, radius) or (x, y, radius, height), and one is {given!r}")
            x, y, radius, *height = given
            rows.append({"center": [x, y], "radius": radius, "height": height[0] if height else None})
        self._made("asperities", asperities=rows)
        self._call = f"Asperities of {len(rows)}"


class HeightMap(_calls.HeightMap, Indenter):
    """A measured or computed surface, one value per cell of a regular grid that is centred on the origin.

    Example:
        >>> import numpy as np
        >>> x = np.linspace(-1e-3, 1e-3, 65)
        >>> map = HeightMap(-(x**2 + x[:, None]**2) / 0.02, spacing=x[1] - x[0])
        >>> map
        HeightMap of 65 x 65 points
        >>> map.gaps.shape, float(map.gaps.min())
        ((65, 65), 0.0)
    """

    __slots__ = ()

    def _made_of(self, shape: str, keys: Mapping[str, Any], heights: Any = None) -> None:
        if isinstance(heights, (str, os.PathLike)):
            super()._made_of(shape, keys, heights)
            return
        values = _toml.si(heights, "m", "heights") if _toml.has_unit(heights) else np.asarray(heights, dtype=np.float64)
        if _toml.has_unit(heights) and "indenter.height_unit" in keys:
            raise ValueError("heights have a unit already: leave out height_unit")
        if values.ndim != 2:
            raise ValueError(f"heights have shape {values.shape}: give an array of rows along y and columns along x")
        if "indenter.offset" in keys:
            raise ValueError("a map of an array has no offset: its grid is centred on the origin")
        rows, columns = values.shape
        self._text = None
        self._call = f"HeightMap of {columns} x {rows} points"
        text = _toml.document(_toml.tables({"indenter.shape": shape, **keys}))
        self._core = _core.Shape.of_heights("HeightMap(...)", text, values)

    @property
    def gaps(self) -> Floats:
        """Gap (m) at every point of a map of an array, shape (cells along y, cells along x); a view that cannot be written to."""
        return self._core.gaps()

    def __reduce__(self) -> tuple[Any, ...]:
        if self._text is not None:
            return super().__reduce__()
        return (_restored_map, (self._core, self._call))


def _restored_map(core: _core.Shape, call: str) -> HeightMap:
    map = HeightMap.__new__(HeightMap)
    map._text, map._call, map._core = None, call, core
    return map
