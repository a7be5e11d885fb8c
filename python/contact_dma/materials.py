"""Materials: what the half-space is made of."""

from __future__ import annotations

import html
import os
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, TypeAlias, Union

from . import _contact_dma as _core
from . import _toml
from ._calls import MaterialForms
from ._result import Floats, warn
from ._toml import Quantity
from .fits import POOR_FIT, MaterialFit, dynamic_columns, table_text, warn_of_celsius, warn_of_unread

ModulusKind: TypeAlias = Union[Literal["longitudinal"], Literal["shear"]]
"""Whether a modulus is Young's (E) or the shear modulus (G)."""

BulkModulus: TypeAlias = Union[Quantity, tuple[Quantity, Sequence[tuple[Quantity, Quantity]]]]
"""A bulk modulus (Pa) that is constant in time, or that at rest with the modulus (Pa) and relaxation time (s) of each branch."""


def _bulk(given: BulkModulus | None) -> Quantity | dict[str, object] | None:
    if not isinstance(given, tuple):
        return given
    if len(given) != 2:
        raise ValueError(f"bulk_modulus is {given!r}: give a modulus, or a pair of that at rest and a list of branches")
    equilibrium, branches = given
    return {"equilibrium": equilibrium, "branches": _toml.rows("bulk_modulus", branches, [("modulus", 1, True), ("time", 1, True)])}


class Prony(NamedTuple):
    """A generalised Maxwell solid, M(t) = equilibrium + sum of moduli exp(-t / times).

    Attributes:
        equilibrium: modulus after all time (Pa).
        moduli: modulus of each branch (Pa), shape (branches,).
        times: relaxation time of each branch (s), shape (branches,).
    """

    equilibrium: float
    moduli: Floats
    times: Floats


class Material(MaterialForms, _core.Body):
    """A linear viscoelastic solid, as one of the constructors below makes it.

    Quantities are numbers in SI units or strings with units. Materials cannot be changed, compare by value, and pickle.

    Example:
        >>> import contact_dma as cd
        >>> pmma = cd.Material.library("pmma")
        >>> pmma
        Material('PMMA', instantaneous=2.49e+09, equilibrium=1.97e+09, poisson_ratio=0.38)
        >>> bool(abs(pmma.complex_modulus(1.0)) > pmma.prony.equilibrium), pmma.complex_modulus([0.01, 0.1]).shape
        (True, (2,))
        >>> e, d = pmma.relaxation_modulus([0.0, 1000.0]), pmma.creep_compliance([0.0, 1000.0])
        >>> bool(e[1] < e[0]), bool(d[1] > d[0])
        (True, True)
        >>> cd.Material.library("pvb", temperature="30 °C").temperature  # cd.library_materials() lists all
        303.15
        >>> rubber = cd.Material.relaxation("2 MPa", [("8 MPa", "1 ms"), (5e6, 0.1)], poisson_ratio=0.5)
        >>> rubber.prony.moduli.tolist()
        [8000000.0, 5000000.0]
        >>> float(cd.Material.creep(1e-9, [("0.5 1/GPa", "10 s")], poisson_ratio=0.4).creep_compliance(0.0))
        1e-09
        >>> cd.Material.zener("1 MPa", "2 MPa", "1 s", bulk_modulus="1 GPa").bulk_modulus
        1000000000.0
        >>> cd.Material.maxwell("1 MPa", "1 s", poisson_ratio=0.5).prony.equilibrium
        0.0
        >>> glass = cd.Material.fractional("zener", stiffness="1 GPa", time="1 s", exponent=0.5, equilibrium="100 MPa",
        ...                                band=("1e-2 rad/s", "1e2 rad/s"), poisson_ratio=0.4)
        >>> bool(glass.complex_modulus(1.0).imag > 0)
        True
        >>> float(cd.Material.elastic("210 GPa", poisson_ratio=0.3).complex_modulus(1.0).real)
        210000000000.0
        >>> import numpy as np
        >>> t, omega = np.logspace(-1, 3, 60), np.logspace(-2, 2, 25)
        >>> solid = cd.Material.table(t, 1e9 + 2e9 * np.exp(-t / 10), quantity="relaxation", poisson_ratio=0.4)
        >>> round(solid.prony.equilibrium / 1e9, 3)
        1.0
        >>> measured = solid.complex_modulus(omega)
        >>> again = cd.Material.from_dynamic(angular_frequency=omega, storage_modulus=measured.real, loss_modulus=measured.imag,
        ...                                  poisson_ratio=0.4)
        >>> bool(np.allclose(again.complex_modulus(omega), measured, rtol=0.01)), again.fit.misfit < 1e-3
        (True, True)
    """

    __slots__ = ("_fit", "_source")

    _fit: MaterialFit | None
    _source: str

    def __new__(cls, *_: Any) -> Material:
        raise TypeError(f"write {', '.join('Material.' + name for name in _CONSTRUCTORS)}")

    @classmethod
    def _of(cls, name: str, text: str, *, keep: bool = True, tables: Sequence[tuple[str, bytes]] = ()) -> Material:
        material: Any = _core.Body.__new__(cls, name, text, tables)
        fit = material._fitted()
        material._fit = None if fit is None else MaterialFit._of(*fit)
        # Where a key of the block becomes an axis of a sweep, the block is read again.
        material._source = text if keep else material.text
        return material  # type: ignore[no-any-return]

    @classmethod
    def _of_form(cls, form: str, keys: dict[str, Any], **data: Any) -> Material:
        """The material of the keys of a form, by their dotted names, and of data."""
        call, bulk = f"Material.{form}(...)", "material.bulk_modulus"
        options: dict[str, Any] = {}
        columns: dict[str, Any] = {}
        warn_of_celsius(call, **{name.rpartition(".")[2]: key for name, key in keys.items() if name.endswith("temperature")})
        if bulk in keys:
            keys[bulk] = _bulk(keys[bulk])
        if form == "table":
            is_creep = keys["material.table.quantity"] == "creep"
            keys["material.table.times"] = _toml.si(data["time"], "s", "time").reshape(-1)
            keys["material.table.values"] = _toml.si(data["values"], "1/Pa" if is_creep else "Pa", "values").reshape(-1)
        if form == "from_dynamic":
            file = data.pop("file", None)
            arrays = {column: values for column, values in data.items() if values is not None}
            if file is not None and arrays:
                raise ValueError("from_dynamic takes a file, a data frame or arrays, not two of them")
            if isinstance(file, (str, os.PathLike)):
                keys["material.dynamic.file"] = _toml.path(file)
            elif _toml.is_table(file) or file is None:
                columns, name = dynamic_columns(arrays if file is None else file), "arguments" if file is None else "argument `file`"
                keys["material.dynamic.file"] = name
                options = {"keep": False, "tables": [(name, table_text(columns).encode())]}
            else:
                keys["material.dynamic.files"] = [_toml.path(each) for each in file]
        made = cls._of(call, _toml.document(_toml.tables(keys, "material")), **options)
        warn_of_unread(call, columns, made._fit)
        return made._with_warnings(call)

    def _with_warnings(self, call: str) -> Material:
        """The material, after a warning of everything that limits the use of its fit."""
        if self._fit is not None:
            for warning in self._fit.warnings:
                warn(f"{call}: {warning}")
            if self._fit.misfit > POOR_FIT:
                warn(f"{call}: the series misses the data by {100 * self._fit.misfit:.2g} % (root mean square): see the material's fit")
        return self

    @classmethod
    def from_toml(cls, text: str) -> Material:
        """The material of a ``[material]`` block of a sweep file, such as `text` or a ``material.toml`` of the program.

        Example:
            >>> pmma = Material.library("pmma")
            >>> Material.from_toml(pmma.text) == pmma
            True
        """
        material = cls._of("Material.from_toml(...)", text)
        # Whatever the text looks like, [material] as a table of its own.
        material._source = _core.placed(text, "material", "material", None)
        return material

    @property
    def fit(self) -> MaterialFit | None:
        """How its series was fitted to data; None where it was not.

        Example:
            >>> Material.library("pmma").fit is None
            True
        """
        return self._fit

    @property
    def prony(self) -> Prony:
        """The relaxation modulus E(t) as a Prony series: equilibrium modulus (Pa), moduli (Pa) and times (s).

        Example:
            >>> Material.library("pmma").prony.times.tolist()
            [8.93, 117.96]
        """
        return Prony(*self._prony())

    def __repr__(self) -> str:
        parts = [repr(self.name)] if self.name else []
        if self._is_series:
            series = self.prony
            at_once = series.equilibrium + series.moduli.sum()
            parts += [f"instantaneous={at_once:.3g}", f"equilibrium={series.equilibrium:.3g}"]
        if self.poisson_ratio is not None:
            parts.append(f"poisson_ratio={self.poisson_ratio}")
        else:
            parts.append(f"bulk_modulus={'relaxing' if self.bulk_modulus is None else self.bulk_modulus}")
        if self._fit is not None:
            parts.append(f"misfit={self._fit.misfit:.2g}")
        return f"Material({', '.join(parts)})"

    def _repr_html_(self) -> str:
        fit = "" if self._fit is None else self._fit._repr_html_()
        return f"<p><code>{html.escape(repr(self))}</code></p>{fit}"

    def __eq__(self, other: object) -> bool:
        return self.text == other.text if isinstance(other, Material) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.text)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (self.text, self._source, self._fit))


_CONSTRUCTORS = [name for name in vars(MaterialForms) if not name.startswith("_")] + ["from_toml"]


def _restored(text: str, source: str, fit: MaterialFit | None) -> Material:
    material = Material._of("the pickled material", text)
    material._source, material._fit = source, fit
    return material


def library_materials() -> dict[str, str]:
    """Names of the materials of the library, and where their constants come from.

    Example:
        >>> "pmma" in library_materials()
        True
    """
    return {name: source for name, _, source in _core.library_materials()}
