"""Materials: what the half-space is made of."""

from __future__ import annotations

import html
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias, Union

import numpy as np
import numpy.typing as npt

from . import _contact_dma as _core
from . import _toml
from ._result import Floats, warn
from .fits import POOR_FIT, MaterialFit, dynamic_columns, warn_of_celsius, warn_of_unread, write_columns

Quantity: TypeAlias = Union[float, str]
"""A number in SI units, or a string with a unit: ``0.01`` or ``"10 mm"``."""

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
    return {"equilibrium": equilibrium, "branches": [{"modulus": m, "time": t} for m, t in _pairs(branches, "modulus")]}


def _pairs(branches: Any, what: str) -> list[tuple[Any, Any]]:
    """Branches as pairs of modulus or compliance, and time."""
    if isinstance(branches, Mapping) or not isinstance(branches, (Sequence, np.ndarray)) or isinstance(branches, str):
        branches = [None]
    if not all(isinstance(pair, (Sequence, np.ndarray)) and not isinstance(pair, str) and len(pair) == 2 for pair in branches):
        raise ValueError(f"branches are pairs of {what} and time: write a list such as [(8e6, 1e-3), (5e6, 0.1)]")
    return [(a, b) for a, b in branches]


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


class Material:
    """A linear viscoelastic solid, as one of the constructors below makes it.

    Quantities are numbers in SI units or strings with units. Materials cannot be changed, compare by value, and pickle.

    Example:
        >>> import contact_dma as cd
        >>> pmma = cd.Material.library("pmma")
        >>> pmma
        Material('PMMA', instantaneous=2.49e+09, equilibrium=1.97e+09, poisson_ratio=0.38)
        >>> bool(abs(pmma.complex_modulus(1.0)) > pmma.prony.equilibrium)
        True
    """

    __slots__ = ("_core", "_fit", "_source")

    _core: _core.Body
    _fit: MaterialFit | None
    _source: str

    def __init__(self) -> None:
        raise TypeError("write Material.library, .relaxation, .creep, .zener, .maxwell, .table, .fractional or .from_dynamic")

    @classmethod
    def _of(cls, name: str, text: str, *, keep: bool = True) -> Material:
        material = object.__new__(cls)
        material._core = _core.Body(name, text)
        fit = material._core.fit()
        material._fit = None if fit is None else MaterialFit._of(*fit)
        # Where a key of the block becomes an axis of a sweep, the block is read again.
        material._source = text if keep else material._core.text
        return material

    def _with_warnings(self, call: str) -> Material:
        """The material, after a warning of everything that limits the use of its fit."""
        if self._fit is not None:
            for warning in self._fit.warnings:
                warn(f"{call}: {warning}")
            if self._fit.misfit > POOR_FIT:
                warn(f"{call}: the series misses the data by {100 * self._fit.misfit:.2g} % (root mean square): see the material's fit")
        return self

    @classmethod
    def _block(cls, call: str, entries: Mapping[str, Any], *, keep: bool = True, **inner: Any) -> Material:
        (kind, table), *_ = inner.items()
        text = _toml.table("material", entries) or "[material]\n"
        return cls._of(f"Material.{call}(...)", text + _toml.table(f"material.{kind}", table), keep=keep)

    @classmethod
    def library(
        cls, name: str, *, poisson_ratio: float | None = None, temperature: Quantity | None = None
    ) -> Material:
        """A material with published constants.

        Args:
            name: its name, such as ``"pmma"``; `contact_dma.library_materials()` lists all with their sources.
            poisson_ratio: another Poisson ratio than the published one.
            temperature: another temperature (K) than that of the published series, for materials that have a published shift.

        Example:
            >>> Material.library("pmma").poisson_ratio
            0.38
            >>> Material.library("pvb", temperature="30 °C").temperature
            303.15
        """
        warn_of_celsius("Material.library(...)", temperature=temperature)
        entries = {"library": name, "poisson_ratio": poisson_ratio, "temperature": temperature}
        return cls._of("Material.library(...)", _toml.table("material", entries))

    @classmethod
    def elastic(cls, modulus: Quantity, *, poisson_ratio: float, name: str | None = None) -> Material:
        """An elastic solid, such as what an indenter is made of.

        Args:
            modulus: Young's modulus (Pa).
            poisson_ratio: its Poisson ratio.
            name: a name for tables.

        Example:
            >>> float(Material.elastic("210 GPa", poisson_ratio=0.3).complex_modulus(1.0).real)
            210000000000.0
        """
        table = {"modulus": modulus, "poisson_ratio": poisson_ratio}
        return cls._of("Material.elastic(...)", _toml.table("material", {"name": name, "elastic": table}))

    @classmethod
    def relaxation(
        cls,
        equilibrium: Quantity,
        branches: Sequence[tuple[Quantity, Quantity]],
        *,
        poisson_ratio: float | None = None,
        bulk_modulus: BulkModulus | None = None,
        modulus: ModulusKind = "longitudinal",
        name: str | None = None,
        measured: tuple[Quantity, Quantity] | None = None,
    ) -> Material:
        """A generalised Maxwell solid from its relaxation modulus, equilibrium + sum of modulus exp(-t / time).

        Args:
            equilibrium: modulus after all time (Pa).
            branches: modulus (Pa) and relaxation time (s) of each branch.
            poisson_ratio: Poisson ratio, constant in time.
            bulk_modulus: in its place the bulk modulus: a constant (Pa), or (that at rest, branches), with shear moduli alone.
            modulus: whether the moduli are Young's or shear moduli.
            name: a name for tables.
            measured: first and last time (s) of the test, outside of which the series is an extrapolation.

        Example:
            >>> rubber = Material.relaxation("2 MPa", [("8 MPa", "1 ms"), (5e6, 0.1)], poisson_ratio=0.5)
            >>> rubber.prony.moduli.tolist()
            [8000000.0, 5000000.0]
        """
        table = {
            "modulus": modulus,
            "equilibrium": equilibrium,
            "branches": [{"modulus": m, "time": t} for m, t in _pairs(branches, "modulus")],
        }
        entries = {"name": name, "poisson_ratio": poisson_ratio, "bulk_modulus": _bulk(bulk_modulus), "measured": measured}
        return cls._block("relaxation", entries, relaxation=table)

    @classmethod
    def creep(
        cls,
        instantaneous: Quantity,
        branches: Sequence[tuple[Quantity, Quantity]],
        *,
        poisson_ratio: float | None = None,
        bulk_modulus: BulkModulus | None = None,
        viscosity: Quantity | None = None,
        compliance: ModulusKind = "longitudinal",
        name: str | None = None,
        measured: tuple[Quantity, Quantity] | None = None,
    ) -> Material:
        """A generalised Kelvin solid from its creep compliance, instantaneous + sum of compliance (1 - exp(-t / time)) + t / viscosity.

        Args:
            instantaneous: compliance at once (1/Pa).
            branches: compliance (1/Pa) and retardation time (s) of each branch.
            poisson_ratio: Poisson ratio, constant in time.
            bulk_modulus: in its place the bulk modulus: a constant (Pa), or (that at rest, branches), with shear moduli alone.
            viscosity: of a fluid (Pa s); sweeps need a solid.
            compliance: whether the compliances are longitudinal (D) or of shear (J).
            name: a name for tables.
            measured: first and last time (s) of the test.

        Example:
            >>> solid = Material.creep(1e-9, [("0.5 1/GPa", "10 s")], poisson_ratio=0.4)
            >>> float(solid.creep_compliance(0.0))
            1e-09
        """
        table = {
            "compliance": compliance,
            "instantaneous": instantaneous,
            "viscosity": viscosity,
            "branches": [{"compliance": c, "time": t} for c, t in _pairs(branches, "compliance")],
        }
        entries = {"name": name, "poisson_ratio": poisson_ratio, "bulk_modulus": _bulk(bulk_modulus), "measured": measured}
        return cls._block("creep", entries, creep=table)

    @classmethod
    def zener(
        cls,
        spring: Quantity,
        kelvin_spring: Quantity,
        time: Quantity,
        *,
        poisson_ratio: float | None = None,
        bulk_modulus: BulkModulus | None = None,
        name: str | None = None,
    ) -> Material:
        """A spring in series with a Kelvin unit: shear moduli of both springs (Pa), and the time of the unit (s).

        Example:
            >>> Material.zener("1 MPa", "2 MPa", "1 s", poisson_ratio=0.5).poisson_ratio
            0.5
        """
        table = {"spring": spring, "kelvin_spring": kelvin_spring, "time": time}
        return cls._block("zener", {"name": name, "poisson_ratio": poisson_ratio, "bulk_modulus": _bulk(bulk_modulus)}, zener=table)

    @classmethod
    def maxwell(cls, modulus: Quantity, time: Quantity, *, poisson_ratio: float, name: str | None = None) -> Material:
        """A spring and a dashpot in series: shear modulus (Pa) and relaxation time (s). A fluid, for `simulate` alone.

        Example:
            >>> Material.maxwell("1 MPa", "1 s", poisson_ratio=0.5).prony.equilibrium
            0.0
        """
        table = {"modulus": modulus, "time": time}
        return cls._block("maxwell", {"name": name, "poisson_ratio": poisson_ratio}, maxwell=table)

    @classmethod
    def fractional(
        cls,
        model: Literal["springpot", "zener", "maxwell"],
        *,
        stiffness: Quantity,
        time: Quantity,
        exponent: float,
        band: tuple[Quantity, Quantity],
        poisson_ratio: float | None = None,
        bulk_modulus: BulkModulus | None = None,
        modulus: ModulusKind = "longitudinal",
        equilibrium: Quantity | None = None,
        second_exponent: float | None = None,
        accuracy: float | None = None,
        name: str | None = None,
    ) -> Material:
        """A model with derivatives of fractional order, as a series that follows it over a band of angular frequencies (rad/s).

        Args:
            model: which model.
            stiffness: modulus of the springpot at its time (Pa).
            time: its time (s).
            exponent: order of the derivative, above 0 and at most 1.
            band: lowest and highest angular frequency (rad/s).
            poisson_ratio: Poisson ratio, constant in time.
            bulk_modulus: in its place the bulk modulus: a constant (Pa), or (that at rest, branches), with shear moduli alone.
            modulus: whether moduli are Young's or shear moduli.
            equilibrium: of the Zener model (Pa).
            second_exponent: of the Maxwell model.
            accuracy: largest relative error of the series in the band.
            name: a name for tables.

        Example:
            >>> glass = Material.fractional("zener", stiffness="1 GPa", time="1 s", exponent=0.5, equilibrium="100 MPa",
            ...                             band=("1e-2 rad/s", "1e2 rad/s"), poisson_ratio=0.4)
            >>> bool(glass.complex_modulus(1.0).imag > 0)
            True
        """
        table = {
            "model": model,
            "modulus": modulus,
            "stiffness": stiffness,
            "time": time,
            "exponent": exponent,
            "second_exponent": second_exponent,
            "equilibrium": equilibrium,
            "band": band,
            "accuracy": accuracy,
        }
        return cls._block("fractional", {"name": name, "poisson_ratio": poisson_ratio, "bulk_modulus": _bulk(bulk_modulus)}, fractional=table)

    @classmethod
    def table(
        cls,
        time: npt.ArrayLike,
        values: npt.ArrayLike,
        *,
        quantity: Literal["creep", "relaxation"],
        poisson_ratio: float,
        modulus: ModulusKind = "longitudinal",
        evaluation: Literal["fit", "direct"] | None = None,
        flow: bool | None = None,
        name: str | None = None,
    ) -> Material:
        """A material from samples of its creep compliance or relaxation modulus, by a fitted series or as they are.

        Args:
            time: times (s), shape (n,), ascending.
            values: compliances (1/Pa) or moduli (Pa), shape (n,).
            quantity: what the values are.
            poisson_ratio: Poisson ratio.
            modulus: whether they are longitudinal or of shear.
            evaluation: ``"fit"`` for a series, ``"direct"`` for the samples as they are, in `simulate` alone.
            flow: whether the material flows in the end; left out, the data say.
            name: a name for tables.

        Example:
            >>> import numpy as np
            >>> t = np.logspace(-1, 3, 60)
            >>> solid = Material.table(t, 1e9 + 2e9 * np.exp(-t / 10), quantity="relaxation", poisson_ratio=0.4)
            >>> round(solid.prony.equilibrium / 1e9, 3)
            1.0
        """
        table = {
            "quantity": quantity,
            "modulus": modulus,
            "evaluation": evaluation,
            "flow": flow,
            "times": _toml.si(time, "s", "time").reshape(-1),
            "values": _toml.si(values, "1/Pa" if quantity == "creep" else "Pa", "values").reshape(-1),
        }
        made = cls._block("table", {"name": name, "poisson_ratio": poisson_ratio}, table=table)
        return made._with_warnings("Material.table(...)")

    @classmethod
    def from_dynamic(
        cls,
        file: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | _toml.TableLike | None = None,
        *,
        poisson_ratio: float,
        modulus: ModulusKind = "longitudinal",
        angular_frequency: npt.ArrayLike | None = None,
        frequency: npt.ArrayLike | None = None,
        storage_modulus: npt.ArrayLike | None = None,
        loss_modulus: npt.ArrayLike | None = None,
        tan_delta: npt.ArrayLike | None = None,
        temperature: npt.ArrayLike | None = None,
        temperature_of_sweep: Quantity | None = None,
        reference_temperature: Quantity | None = None,
        shift: Literal["free", "wlf", "arrhenius", "none"] | None = None,
        vertical_shift: bool | None = None,
        branches: int | Literal["auto"] | None = None,
        replicas: int | None = None,
        seed: int | None = None,
        format: str | None = None,
        name: str | None = None,
    ) -> Material:
        """A material from measured storage and loss moduli: of a file of an instrument, or of arrays.

        Isotherms are shifted to a master curve, and a Prony series is fitted with as many branches as the data ask for.

        Args:
            file: a file, or several, in any of the program's formats; or a data frame or dictionary whose columns have the names of the
                arguments below (SI units), or names with units that a file may have, such as ``"Frequency (Hz)"``.
            poisson_ratio: Poisson ratio.
            modulus: whether the moduli are E' and E'' or G' and G''.
            angular_frequency: in place of a file: angular frequencies (rad/s), shape (n,).
            frequency: frequencies (Hz) in place of these.
            storage_modulus: storage moduli (Pa), shape (n,).
            loss_modulus: loss moduli (Pa), shape (n,).
            tan_delta: loss factors in place of the loss moduli.
            temperature: temperatures (K, or strings such as ``"20 °C"``), shape (n,), of several isotherms.
            temperature_of_sweep: the temperature of the contact (K).
            reference_temperature: that of the master curve (K).
            shift: how isotherms are shifted.
            vertical_shift: whether moduli are shifted too.
            branches: how many branches; ``"auto"`` lets the data choose.
            replicas: how many series are fitted to the data with other noise, for the error that comes from the data.
            seed: of that noise.
            format: that of the file, where its content does not say.
            name: a name for tables.

        Returns:
            the material; its `fit` has misfit, master curve, shift factors and notes. A poor fit, and temperatures that are degrees
            Celsius most likely, warn.

        Example:
            >>> import numpy as np
            >>> omega = np.logspace(-2, 2, 25)
            >>> solid = Material.relaxation("10 MPa", [("90 MPa", "1 s")], poisson_ratio=0.45)
            >>> measured = solid.complex_modulus(omega)
            >>> again = Material.from_dynamic(angular_frequency=omega, storage_modulus=measured.real,
            ...                               loss_modulus=measured.imag, poisson_ratio=0.45)
            >>> bool(np.allclose(again.complex_modulus(omega), measured, rtol=0.01)), again.fit.misfit < 1e-3
            (True, True)
        """
        call = "Material.from_dynamic(...)"
        warn_of_celsius(call, temperature_of_sweep=temperature_of_sweep, reference_temperature=reference_temperature)
        entries = {"name": name, "poisson_ratio": poisson_ratio, "temperature": temperature_of_sweep}
        table: dict[str, Any] = {
            "modulus": modulus,
            "format": format,
            "reference_temperature": reference_temperature,
            "shift": shift,
            "vertical_shift": vertical_shift,
            "branches": branches,
            "replicas": replicas,
            "seed": seed,
        }
        arrays = {
            "angular_frequency": angular_frequency,
            "frequency": frequency,
            "storage_modulus": storage_modulus,
            "loss_modulus": loss_modulus,
            "tan_delta": tan_delta,
            "temperature": temperature,
        }
        given = {column: values for column, values in arrays.items() if values is not None}
        if file is not None and given:
            raise ValueError("from_dynamic takes a file, a data frame or arrays, not two of them")
        if isinstance(file, (str, os.PathLike)):
            made = cls._block("from_dynamic", entries, dynamic={**table, "file": _toml.path(file)})
        elif _toml.is_table(file) or file is None:
            made = cls._of_columns(given if file is None else file, entries, table)
        else:
            files = [_toml.path(each) for each in file]  # type: ignore[union-attr]
            made = cls._block("from_dynamic", entries, dynamic={**table, "files": files})
        return made._with_warnings(call)

    @classmethod
    def _of_columns(cls, given: _toml.TableLike, entries: Mapping[str, Any], table: Mapping[str, Any]) -> Material:
        columns = dynamic_columns(given)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "arrays.csv"
            write_columns(path, columns)
            try:
                made = cls._block("from_dynamic", entries, keep=False, dynamic={**table, "file": _toml.path(path)})
            except ValueError as error:
                # The file is gone when this is read; its line 1 has the names of the columns.
                raise ValueError(str(error).replace(_toml.path(path), "the arrays")) from None
        warn_of_unread("Material.from_dynamic(...)", columns, made._fit)
        return made

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
    def text(self) -> str:
        """The material as a ``[material]`` block of a sweep file that gives the same material again, bit for bit."""
        return self._core.text

    @property
    def fit(self) -> MaterialFit | None:
        """How its series was fitted to data; None where it was not.

        Example:
            >>> Material.library("pmma").fit is None
            True
        """
        return self._fit

    @property
    def name(self) -> str | None:
        """Its name, where it has one."""
        return self._core.name

    @property
    def poisson_ratio(self) -> float | None:
        """Poisson ratio, where it is constant in time."""
        return self._core.poisson_ratio

    @property
    def bulk_modulus(self) -> float | None:
        """Bulk modulus (Pa), where it is constant in time in place of the Poisson ratio.

        Example:
            >>> Material.zener("1 MPa", "2 MPa", "1 s", bulk_modulus="1 GPa").bulk_modulus
            1000000000.0
        """
        return self._core.bulk_modulus_pa

    @property
    def temperature(self) -> float | None:
        """The temperature (K) that it is for, where the data know temperatures."""
        return self._core.temperature_k

    @property
    def prony(self) -> Prony:
        """The relaxation modulus E(t) as a Prony series: equilibrium modulus (Pa), moduli (Pa) and times (s).

        Example:
            >>> Material.library("pmma").prony.times.tolist()
            [8.93, 117.96]
        """
        return Prony(*self._core.prony("longitudinal"))

    def complex_modulus(
        self, angular_frequency: npt.ArrayLike, *, modulus: ModulusKind = "longitudinal"
    ) -> Any:
        """Complex modulus E' + i E'' (Pa), or G' + i G''.

        Args:
            angular_frequency: angular frequencies (rad/s), of any shape.
            modulus: Young's or shear modulus.

        Returns:
            complex numbers of the same shape.

        Example:
            >>> Material.library("pmma").complex_modulus([0.01, 0.1]).shape
            (2,)
        """
        return _mapped(lambda omega: self._core.complex_modulus(omega, modulus), angular_frequency, "rad/s")

    def creep_compliance(self, time: npt.ArrayLike, *, modulus: ModulusKind = "longitudinal") -> Any:
        """Creep compliance D(t) (1/Pa), or J(t).

        Args:
            time: times (s), of any shape.
            modulus: ``"longitudinal"`` for D, ``"shear"`` for J.

        Returns:
            numbers of the same shape.

        Example:
            >>> d = Material.library("pmma").creep_compliance([0.0, 1000.0])
            >>> bool(d[1] > d[0])
            True
        """
        return _mapped(lambda t: self._core.creep_compliance(t, modulus), time, "s")

    def relaxation_modulus(self, time: npt.ArrayLike, *, modulus: ModulusKind = "longitudinal") -> Any:
        """Relaxation modulus E(t) (Pa), or G(t).

        Args:
            time: times (s), of any shape.
            modulus: Young's or shear modulus.

        Returns:
            numbers of the same shape.

        Example:
            >>> e = Material.library("pmma").relaxation_modulus([0.0, 1000.0])
            >>> bool(e[1] < e[0])
            True
        """
        return _mapped(lambda t: self._core.relaxation_modulus(t, modulus), time, "s")

    def __repr__(self) -> str:
        parts = [repr(self.name)] if self.name else []
        if self._core.is_series:
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


def _restored(text: str, source: str, fit: MaterialFit | None) -> Material:
    material = Material._of("the pickled material", text)
    material._source, material._fit = source, fit
    return material


def _mapped(of_line: Callable[[Floats], npt.NDArray[Any]], given: npt.ArrayLike, unit: str) -> Any:
    """What a function of a line of numbers makes of numbers in any shape; a number of a number."""
    array = _toml.si(given, unit, "the argument")
    made = of_line(np.ascontiguousarray(array).reshape(-1)).reshape(array.shape)
    return made[()]


def library_materials() -> dict[str, str]:
    """Names of the materials of the library, and where their constants come from.

    Example:
        >>> "pmma" in library_materials()
        True
    """
    return {name: source for name, _, source in _core.library_materials()}
