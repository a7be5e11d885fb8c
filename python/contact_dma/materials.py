"""Materials: what the half-space is made of."""

from __future__ import annotations

import csv
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias, Union

import numpy as np
import numpy.typing as npt

from . import _contact_dma as _core
from . import _toml

Quantity: TypeAlias = Union[float, str]
"""A number in SI units, or a string with a unit: ``0.01`` or ``"10 mm"``."""

ModulusKind: TypeAlias = Union[Literal["longitudinal"], Literal["shear"]]
"""Whether a modulus is Young's (E) or the shear modulus (G)."""

BulkModulus: TypeAlias = Union[Quantity, tuple[Quantity, Sequence[tuple[Quantity, Quantity]]]]
"""A bulk modulus (Pa) that is constant in time, or that at rest with the modulus (Pa) and relaxation time (s) of each branch."""

Floats: TypeAlias = npt.NDArray[np.float64]


def _bulk(given: BulkModulus | None) -> Quantity | dict[str, object] | None:
    if not isinstance(given, tuple):
        return given
    equilibrium, branches = given
    return {"equilibrium": equilibrium, "branches": [{"modulus": m, "time": t} for m, t in branches]}


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
        Material('PMMA', poisson_ratio=0.38)
        >>> bool(abs(pmma.complex_modulus(1.0)) > pmma.prony.equilibrium)
        True
    """

    __slots__ = ("_core", "_source")

    _core: _core.Body
    _source: str

    def __init__(self) -> None:
        raise TypeError("write Material.library, .relaxation, .creep, .zener, .maxwell, .table, .fractional or .from_dynamic")

    @classmethod
    def _of(cls, name: str, text: str, *, keep: bool = True) -> Material:
        material = object.__new__(cls)
        material._core = _core.Body(name, text)
        # Where a key of the block becomes an axis of a sweep, the block is read again.
        material._source = text if keep else material._core.text
        return material

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
            "branches": [{"modulus": m, "time": t} for m, t in branches],
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
            "branches": [{"compliance": c, "time": t} for c, t in branches],
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
            "times": np.asarray(time, dtype=np.float64),
            "values": np.asarray(values, dtype=np.float64),
        }
        return cls._block("table", {"name": name, "poisson_ratio": poisson_ratio}, table=table)

    @classmethod
    def from_dynamic(
        cls,
        file: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None = None,
        *,
        poisson_ratio: float,
        modulus: ModulusKind = "longitudinal",
        angular_frequency: npt.ArrayLike | None = None,
        storage_modulus: npt.ArrayLike | None = None,
        loss_modulus: npt.ArrayLike | None = None,
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
            file: a file, or several, in any of the program's formats.
            poisson_ratio: Poisson ratio.
            modulus: whether the moduli are E' and E'' or G' and G''.
            angular_frequency: in place of a file: angular frequencies (rad/s), shape (n,).
            storage_modulus: storage moduli (Pa), shape (n,).
            loss_modulus: loss moduli (Pa), shape (n,).
            temperature: temperatures (K), shape (n,), of several isotherms.
            temperature_of_sweep: the temperature of the contact (K).
            reference_temperature: that of the master curve (K).
            shift: how isotherms are shifted.
            vertical_shift: whether moduli are shifted too.
            branches: how many branches; ``"auto"`` lets the data choose.
            replicas: how many series are fitted to the data with other noise, for the error that comes from the data.
            seed: of that noise.
            format: that of the file, where its content does not say.
            name: a name for tables.

        Example:
            >>> import numpy as np
            >>> omega = np.logspace(-2, 2, 25)
            >>> solid = Material.relaxation("10 MPa", [("90 MPa", "1 s")], poisson_ratio=0.45)
            >>> measured = solid.complex_modulus(omega)
            >>> again = Material.from_dynamic(angular_frequency=omega, storage_modulus=measured.real,
            ...                               loss_modulus=measured.imag, poisson_ratio=0.45)
            >>> bool(np.allclose(again.complex_modulus(omega), measured, rtol=0.01))
            True
        """
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
            "angular_frequency_rad_per_s": angular_frequency,
            "storage_modulus_pa": storage_modulus,
            "loss_modulus_pa": loss_modulus,
            "temperature_k": temperature,
        }
        given = {column: values for column, values in arrays.items() if values is not None}
        if file is not None and given:
            raise ValueError("from_dynamic takes a file or arrays, not both")
        if isinstance(file, (str, os.PathLike)):
            return cls._block("from_dynamic", entries, dynamic={**table, "file": _toml.path(file)})
        if file is not None:
            return cls._block("from_dynamic", entries, dynamic={**table, "files": [_toml.path(each) for each in file]})
        for column in list(arrays)[:3]:
            if column not in given:
                raise ValueError("from_dynamic needs a file, or angular_frequency, storage_modulus and loss_modulus")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "arrays.csv"
            write_columns(path, given)
            return cls._block("from_dynamic", entries, keep=False, dynamic={**table, "file": _toml.path(path)})

    @classmethod
    def from_toml(cls, text: str) -> Material:
        """The material of a ``[material]`` block of a sweep file, such as `text` or a ``material.toml`` of the program.

        Example:
            >>> pmma = Material.library("pmma")
            >>> Material.from_toml(pmma.text) == pmma
            True
        """
        return cls._of("Material.from_toml(...)", text)

    @property
    def text(self) -> str:
        """The material as a ``[material]`` block of a sweep file that gives the same material again, bit for bit."""
        return self._core.text

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
        return _mapped(lambda omega: self._core.complex_modulus(omega, modulus), angular_frequency)

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
        return _mapped(lambda t: self._core.creep_compliance(t, modulus), time)

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
        return _mapped(lambda t: self._core.relaxation_modulus(t, modulus), time)

    def __repr__(self) -> str:
        name = f"{self.name!r}, " if self.name else ""
        if self.poisson_ratio is not None:
            return f"Material({name}poisson_ratio={self.poisson_ratio})"
        bulk = self.bulk_modulus
        return f"Material({name}bulk_modulus={'relaxing' if bulk is None else bulk})"

    def __eq__(self, other: object) -> bool:
        return self.text == other.text if isinstance(other, Material) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.text)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (self.text, self._source))


def _restored(text: str, source: str) -> Material:
    material = Material._of("the pickled material", text)
    material._source = source
    return material


def _mapped(of_line: Callable[[Floats], npt.NDArray[Any]], given: npt.ArrayLike) -> Any:
    """What a function of a line of numbers makes of numbers in any shape; a number of a number."""
    array = np.asarray(given, dtype=np.float64)
    made = of_line(np.ascontiguousarray(array).reshape(-1)).reshape(array.shape)
    return made[()]


def write_columns(path: Path, columns: Mapping[str, Any]) -> None:
    """Arrays as the columns of a CSV file, numbers without losing a bit, cells empty where one is NaN."""
    arrays = [np.asarray(values, dtype=np.float64).reshape(-1) for values in columns.values()]
    lengths = {len(array) for array in arrays}
    if len(lengths) > 1:
        counts = ", ".join(f"{name} {len(array)}" for name, array in zip(columns, arrays))
        raise ValueError(f"columns must have as many rows as one another: {counts}")
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        for row in zip(*arrays):
            writer.writerow(["" if np.isnan(cell) else repr(float(cell)) for cell in row])


def library_materials() -> dict[str, str]:
    """Names of the materials of the library, and where their constants come from.

    Example:
        >>> "pmma" in library_materials()
        True
    """
    return {name: source for name, _, source in _core.library_materials()}
