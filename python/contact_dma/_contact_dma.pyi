# Written by python/stubs.sh from the compiled module.
from numpy import complex128, float64
from numpy.typing import ArrayLike, NDArray
from typing import overload
from ._toml import Quantity
from .materials import ModulusKind
from _typeshed import SupportsGetItem
from os import PathLike
from pathlib import Path
from typing import Any, Final, SupportsFloat, SupportsIndex, final
from typing_extensions import disjoint_base

__all__ = ["BUILD", "COMMIT", "VERSION", "Body", "Cycle", "Field", "Figure", "History", "Loops", "MeasuredCycle", "Peak", "PressureLine", "PressureProfile", "Shape", "Status", "SurfaceLine", "SurfaceProfile", "Sweep", "Warning", "calls", "files_of", "identify_material", "kept_figures", "library_materials", "packed_sweep", "placed", "quantity", "run_program", "schema", "solve_shard", "write_identification"]

BUILD: Final[str]
COMMIT: Final[str | None]
VERSION: Final[str]

@disjoint_base
class Body:
    """
    A material that was read from its block of a sweep file.
    """
    def __new__(cls, /, name: str, text: str, tables: SupportsGetItem[int, tuple[str, SupportsGetItem[int, SupportsIndex]]] = ...) -> Body: ...
    def _fitted(self, /) -> tuple[list[str], list[str], list[str], list[tuple[str, bytes]]] | None:
        """
        How the series was fitted; `None` of a material that was not fitted to data.
        """
    @property
    def _is_series(self, /) -> bool:
        """
        Whether it is a series, which sweeps take, and not samples as they are.
        """
    def _prony(self, /) -> tuple[float, NDArray[float64], NDArray[float64]]: ...
    @property
    def bulk_modulus(self, /) -> float | None:
        """
        Bulk modulus (Pa), where it is constant in time in place of the Poisson ratio.
        """
    @overload
    def complex_modulus(self, /, angular_frequency: Quantity, *, modulus: "ModulusKind" = "longitudinal") -> complex: ...  # type: ignore[overload-overlap]
    @overload
    def complex_modulus(self, /, angular_frequency: ArrayLike, *, modulus: "ModulusKind" = "longitudinal") -> NDArray[complex128]:
        """
        Complex modulus E' + i E'' (Pa), or G' + i G''.

        Args:
            angular_frequency: angular frequencies (rad/s), of any shape.
            modulus: Young's or shear modulus.

        Returns:
            complex numbers of the same shape.
        """
    @overload
    def creep_compliance(self, /, time: Quantity, *, modulus: "ModulusKind" = "longitudinal") -> float: ...  # type: ignore[overload-overlap]
    @overload
    def creep_compliance(self, /, time: ArrayLike, *, modulus: "ModulusKind" = "longitudinal") -> NDArray[float64]:
        """
        Creep compliance D(t) (1/Pa), or J(t).

        Args:
            time: times (s), of any shape.
            modulus: ``"longitudinal"`` for D, ``"shear"`` for J.

        Returns:
            numbers of the same shape.
        """
    def export(self, /, program: str) -> str:
        """
        The text that gives the material to a finite element program.

        Args:
            program: ``"abaqus"``, ``"ansys"``, ``"ls-dyna"``, ``"comsol"``, or ``"csv"``.
        """
    @property
    def name(self, /) -> str | None:
        """
        Its name, where it has one.
        """
    @property
    def poisson_ratio(self, /) -> float | None:
        """
        Poisson ratio, where it is constant in time.
        """
    @overload
    def relaxation_modulus(self, /, time: Quantity, *, modulus: "ModulusKind" = "longitudinal") -> float: ...  # type: ignore[overload-overlap]
    @overload
    def relaxation_modulus(self, /, time: ArrayLike, *, modulus: "ModulusKind" = "longitudinal") -> NDArray[float64]:
        """
        Relaxation modulus E(t) (Pa), or G(t).

        Args:
            time: times (s), of any shape.
            modulus: Young's or shear modulus.

        Returns:
            numbers of the same shape.
        """
    @property
    def temperature(self, /) -> float | None:
        """
        The temperature (K) that it is for, where the data know temperatures.
        """
    @property
    def text(self, /) -> str:
        """
        The material as a ``[material]`` block of a sweep file that gives the same material again, bit for bit.
        """

@final
class Cycle:
    """
    The stabilised cycle of a case, sample by sample; arrays of length 0 where the case has no result.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> Cycle: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def angular_frequency(self, /) -> float:
        """
        rad/s.
        """
    @property
    def approach(self, /) -> NDArray[float64]:
        """
        m, shape (samples,).
        """
    @property
    def contact_radius(self, /) -> NDArray[float64]:
        """
        m, shape (samples,).
        """
    @property
    def load(self, /) -> NDArray[float64]:
        """
        N, shape (samples,).
        """
    @property
    def peak_pressure(self, /) -> NDArray[float64]:
        """
        Pa, shape (samples,); NaN where it is unbounded.
        """
    @property
    def profiles(self, /) -> tuple[PressureProfile, ...]:
        """
        The pressure over the contact at the quarters of the oscillation.
        """
    @property
    def time(self, /) -> NDArray[float64]:
        """
        Since the cycle began (s), shape (samples,).
        """

@final
class Field:
    """
    Fields at a requested time, arrays of shape (cells along y, cells along x) that share the memory of the result.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> Field: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def approach(self, /) -> float:
        """
        m; NaN where the indenter is clear of the surface.
        """
    @property
    def contact_radius(self, /) -> float:
        """
        m.
        """
    @property
    def displacement(self, /) -> NDArray[float64]:
        """
        m, positive into the body.
        """
    @property
    def gap(self, /) -> NDArray[float64] | None:
        """
        m, infinite where there is no indenter; None where its place is unknown.
        """
    @property
    def load(self, /) -> float:
        """
        N.
        """
    @property
    def pressure(self, /) -> NDArray[float64]:
        """
        Pa.
        """
    @property
    def spacing(self, /) -> tuple[float, float]:
        """
        Of the cells along x and y (m).
        """
    @property
    def time(self, /) -> float:
        """
        s.
        """

@final
class Figure:
    """
    A figure as the program draws it; a notebook shows it.
    """
    def __repr__(self, /) -> str: ...
    def _repr_html_(self, /) -> str | None: ...
    @property
    def name(self, /) -> str:
        """
        The name of its files, such as ``"energy-loss"``.
        """
    def save(self, /, file: str | PathLike[str]) -> None:
        """
        Writes it as its ending says: ``.svg``, ``.pdf``, ``.eps`` or ``.png``.

        Args:
            file: is replaced where it is there.
        """

@disjoint_base
class History:
    """
    What a drive history came to.
    """
    def __new__(cls, /, origin: "object", threads: SupportsIndex | None = None, progress: Any | None = None) -> History: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def _all_columns(self, /) -> list[tuple[str, Any]]: ...
    def _cycles(self, /) -> list[tuple[str, Any]]: ...
    def _figures(self, /) -> list[Figure]: ...
    def _summary(self, /) -> bytes: ...
    @property
    def errors_missing(self, /) -> str | None:
        """
        Why there are no errors although they were asked for.
        """
    @property
    def failure(self, /) -> str | None:
        """
        Why the history ended before its time; None where it did not. What came before is in the columns.
        """
    @property
    def fields(self, /) -> tuple[Field, ...]:
        """
        Whole fields at the times of ``fields_at``; their arrays are views that cannot be written to.
        """
    @property
    def profiles(self, /) -> tuple[SurfaceProfile, ...]:
        """
        The surface along lines at the times of ``profiles_at``.
        """
    @property
    def resolved(self, /) -> str:
        """
        The scenario as the text of its file, every default filled in.
        """
    def save(self, /, folder: str | PathLike[str], *, overwrite: bool = False) -> None:
        """
        Writes the tables that ``contact-dma simulate --no-figures`` writes: ``history.csv``, profiles, fields, ``summary.json``,
        ``resolved.toml``. ``contact-dma report FOLDER`` draws figures and page from them.

        Args:
            folder: is made where it is not there.
            overwrite: whether another result there is replaced.
        """
    @property
    def title(self, /) -> str:
        """
        Its title.
        """
    @property
    def warnings(self, /) -> tuple[Warning, ...]:
        """
        What lies outside the model.
        """

@disjoint_base
class Loops:
    """
    What measured loops say.
    """
    def __new__(cls, /, origin: "object", frequency_hz: SupportsFloat | SupportsIndex | None = None, setup: tuple[str, str | None] = ..., threads: SupportsIndex | None = None) -> Loops:
        """
        Of records, of which a frequency (Hz) and a setup, by name and text, may be known; or of the bytes of a ``records/analysis.json``.
        """
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def _all_columns(self, /) -> list[tuple[str, Any]]: ...
    def _figures(self, /) -> list[Figure]: ...
    def _summary(self, /) -> bytes: ...
    @property
    def cycles(self, /) -> tuple[MeasuredCycle, ...]:
        """
        The mean cycle of every record.
        """
    @property
    def findings(self, /) -> tuple[tuple[Warning, ...], ...]:
        """
        For every record, what is to be known of it.
        """
    def save(self, /, folder: str | PathLike[str], *, overwrite: bool = False) -> None:
        """
        Writes what ``contact-dma analyse`` writes; ``contact-dma report FOLDER`` draws figures and page from it.

        Args:
            folder: a new or empty folder, or one of an analysis.
            overwrite: whether another result there is replaced; files of others stay.
        """
    @property
    def status(self, /) -> tuple[Status, ...]:
        """
        How every record ended, and why it has no result.
        """
    @property
    def title(self, /) -> str:
        """
        Its title.
        """

@final
class MeasuredCycle:
    """
    The mean cycle of a record, corrected, as uniform samples; arrays of length 0 where there is none.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> MeasuredCycle: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def approach(self, /) -> NDArray[float64]:
        """
        m, shape (samples,).
        """
    @property
    def load(self, /) -> NDArray[float64]:
        """
        N, shape (samples,).
        """
    @property
    def time(self, /) -> NDArray[float64]:
        """
        s, shape (samples,).
        """

@final
class Peak:
    """
    A local maximum of the energy loss over frequency, located to a thousandth of its frequency.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> Peak: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def angular_frequency(self, /) -> float:
        """
        Its angular frequency (rad/s).
        """
    @property
    def angular_frequency_uncertainty(self, /) -> float:
        """
        Numerical uncertainty of the frequency (rad/s).
        """
    @property
    def drive_amplitude(self, /) -> float | None:
        """
        Amplitude of the drive (N, Pa or m), where there are several.
        """
    @property
    def drive_mean(self, /) -> float | None:
        """
        Mean of the drive (N, Pa or m by its control), where there are several.
        """
    @property
    def energy_loss(self, /) -> float:
        """
        The loss per cycle there (J).
        """
    @property
    def energy_loss_error(self, /) -> float | None:
        """
        Numerical error of the loss (J); None without error bars.
        """
    @property
    def frequency(self, /) -> float:
        """
        Its frequency (Hz).
        """
    @property
    def varied(self, /) -> tuple[float | str, ...]:
        """
        SI values of the axes besides the frequency, names of materials or indenters, empty where there are none.
        """
    @property
    def varied_columns(self, /) -> tuple[str, ...]:
        """
        The column of the result that each value of `varied` belongs to.
        """

@final
class PressureLine:
    """
    The contact pressure along a line through the origin.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> PressureLine: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def along(self, /) -> str:
        """
        ``"r"``, ``"x"`` or ``"y"``.
        """
    @property
    def position(self, /) -> NDArray[float64]:
        """
        Positions (m), shape (n,).
        """
    @property
    def pressure(self, /) -> NDArray[float64]:
        """
        Pressures (Pa), shape (n,); NaN where it is unbounded.
        """

@final
class PressureProfile:
    """
    The contact pressure at a quarter of the oscillation.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> PressureProfile: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def approach(self, /) -> float:
        """
        Approach (m).
        """
    @property
    def contact_radius(self, /) -> float:
        """
        Contact radius (m).
        """
    @property
    def instant(self, /) -> str:
        """
        Such as ``"greatest load"``.
        """
    @property
    def lines(self, /) -> tuple[PressureLine, ...]:
        """
        Along the radius, or along x and y.
        """
    @property
    def load(self, /) -> float:
        """
        Load (N).
        """
    @property
    def time(self, /) -> float:
        """
        Since the cycle began (s).
        """

@final
class Shape:
    """
    An indenter that was read from its block of a sweep file.
    """
    def __new__(cls, /, name: str, text: str, tables: SupportsGetItem[int, tuple[str, SupportsGetItem[int, SupportsIndex]]]) -> Shape:
        """
        The indenter of a block, which may name these tables as files.
        """
    def gap(self, /, x: NDArray[float64], y: NDArray[float64]) -> NDArray[float64]:
        """
        Gap (m) between the undeformed indenter and the half-space at points x, y (m).
        """
    def gaps(self, /) -> NDArray[float64]:
        """
        Gap (m) at the points of its grid, a row for each y.
        """
    def key(self, /) -> str:
        """
        Shape and settings, by which indenters are compared; a file counts by its content.
        """
    def settings(self, /) -> "dict[str, Any]":
        """
        Its settings by their keys, numbers in SI units.
        """

@final
class Status:
    """
    How a case ended.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> Status: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    def __str__(self, /) -> str: ...
    @property
    def converged(self, /) -> bool:
        """
        Whether there is a result.
        """
    @property
    def name(self, /) -> str:
        """
        ``"converged"``, ``"transient"``, ``"not-converged"`` or ``"failed"``.
        """
    @property
    def reason(self, /) -> str | None:
        """
        Why there is no result, or what else is to be known.
        """

@final
class SurfaceLine:
    """
    The deformed surface along a line through the origin, arrays of shape (n,).
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> SurfaceLine: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def along(self, /) -> str:
        """
        ``"r"``, ``"x"`` or ``"y"``.
        """
    @property
    def displacement(self, /) -> NDArray[float64]:
        """
        m, positive into the body.
        """
    @property
    def gap(self, /) -> NDArray[float64]:
        """
        m; NaN where there is no indenter.
        """
    @property
    def position(self, /) -> NDArray[float64]:
        """
        m.
        """
    @property
    def pressure(self, /) -> NDArray[float64]:
        """
        Pa; NaN where it is unbounded.
        """

@final
class SurfaceProfile:
    """
    The surface along lines at a requested time.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> SurfaceProfile: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def approach(self, /) -> float:
        """
        m; NaN where the indenter is clear of the surface.
        """
    @property
    def contact_radius(self, /) -> float:
        """
        m.
        """
    @property
    def lines(self, /) -> tuple[SurfaceLine, ...]:
        """
        Along the radius, or along x and y.
        """
    @property
    def load(self, /) -> float:
        """
        N.
        """
    @property
    def time(self, /) -> float:
        """
        s.
        """

@disjoint_base
class Sweep:
    """
    A sweep and what it came to.
    """
    def __new__(cls, /, origin: "object", threads: SupportsIndex | None = None, progress: Any | None = None, records: bytes | None = None) -> Sweep: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def _all_columns(self, /) -> list[tuple[str, Any]]: ...
    @property
    def _cases(self, /) -> int: ...
    def _cycle(self, /, index: SupportsIndex) -> Cycle: ...
    def _figures(self, /) -> list[Figure]: ...
    def _summary(self, /) -> bytes: ...
    @property
    def notes(self, /) -> tuple[str, ...]:
        """
        What was met on the way, such as a damaged record.
        """
    @property
    def peak_problems(self, /) -> tuple[str, ...]:
        """
        Peaks that could not be located, with the reason.
        """
    @property
    def peaks(self, /) -> tuple[Peak, ...]:
        """
        Local maxima of the loss over frequency, largest first.
        """
    @property
    def resolved(self, /) -> str:
        """
        The sweep as the text of a sweep file, every default filled in.
        """
    def save(self, /, folder: str | PathLike[str], *, overwrite: bool = False) -> None:
        """
        Writes what ``contact-dma sweep`` writes: records, ``sweep.csv``, loops, pressures, work, ``cases/cycles.npz``, ``summary.json``,
        ``resolved.toml``, ``run.json``; a map of an array as ``records/height-map.npy``.

        Figures and page are drawn from these by ``contact-dma report FOLDER``, and `read` reads them again.

        Args:
            folder: is made where it is not there.
            overwrite: whether another sweep's results there are replaced.
        """
    @property
    def status(self, /) -> tuple[Status, ...]:
        """
        How every case ended, and why it has no result.
        """
    @property
    def title(self, /) -> str:
        """
        Its title.
        """
    @property
    def warnings(self, /) -> tuple[tuple[Warning, ...], ...]:
        """
        For every case, what lies outside the model or was not estimated.
        """

@final
class Warning:
    """
    What lies outside the model, or was not estimated.
    """
    __dataclass_fields__: Final[Any]
    """
    As of a dataclass, whose functions then take it.
    """
    __match_args__: Final[tuple[str, ...]]
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, *values: "Any", **named: "Any") -> Warning: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def __repr__(self, /) -> Any: ...
    @property
    def code(self, /) -> str:
        """
        The program's code of it.
        """
    @property
    def message(self, /) -> str:
        """
        A sentence.
        """

def calls() -> str:
    """
    What takes keys of the input files as its arguments, as JSON.
    """

def files_of(folder: str | PathLike[str]) -> list[tuple[str, Path]]:
    """
    Every file that the program has written into a folder: its name in the present layout, and its path, which differs in folders of
    earlier versions.
    """

def identify_material(source: "object", threads: SupportsIndex | None) -> list[tuple[str, bytes]]:
    """
    A material from measured cycles: every file of its folder.
    """

def kept_figures(file: bytes) -> list[Figure]:
    """
    The figures that a folder of the program keeps in its ``records/figures.json``.
    """

def library_materials() -> list[tuple[str, str, str]]:
    """
    Names and titles of the materials of the library.
    """

def packed_sweep(source: "object") -> "tuple[object, int]":
    """
    A sweep that other processes are to solve in shards, and the number of its cases.
    """

def placed(text: str, block: str, place: str, name: str | None) -> str:
    """
    The text of a block at another place of a file: `block` of `text` becomes `place`, `indenter.material` say; with a name it becomes an
    entry of a list there.
    """

def quantity(text: str, si_unit: str) -> float:
    """
    A number with its unit, in the SI unit of the quantity that is expected. Frequencies in Hz and in rad/s are read as one another.
    """

def run_program(arguments: SupportsGetItem[int, str]) -> int:
    """
    Runs the program with these arguments, the first being its name; its exit code.
    """

def schema(kind: str) -> str:
    """
    The JSON Schema of a kind of input files, as text.
    """

def solve_shard(packed: "object", number: SupportsIndex, of: SupportsIndex, threads: SupportsIndex | None = None) -> "bytes":
    """
    The records of one of several shards of a sweep.
    """

def write_identification(folder: str | PathLike[str], files: SupportsGetItem[int, tuple[str, SupportsGetItem[int, SupportsIndex]]], force: bool) -> None:
    """
    Fills the folder of an identification with files; `force` replaces what else is there.
    """
