# Written by python/stubs.sh from the compiled module.
from numpy import complex128, float64
from numpy.typing import NDArray
from _typeshed import SupportsGetItem
from os import PathLike
from typing import Any, Final, SupportsFloat, SupportsIndex, final

__all__ = ["VERSION", "Body", "History", "Shape", "Sweep", "analyse", "identify_material", "library_materials", "placed", "quantity", "read_sweep", "restore_analysis", "restore_history", "restore_sweep", "simulate", "sweep", "write_files"]

VERSION: Final[str]

@final
class Body:
    """
    A material that was read from its block of a sweep file.
    """
    def __new__(cls, /, name: str, text: str) -> Body: ...
    @property
    def bulk_modulus_pa(self, /) -> float | None:
        """
        The bulk modulus (Pa), where it is constant in time in place of the Poisson ratio.
        """
    def complex_modulus(self, /, angular_frequency: NDArray[float64], modulus: str) -> "NDArray[complex128]": ...
    def creep_compliance(self, /, time: NDArray[float64], modulus: str) -> NDArray[float64]: ...
    def fit(self, /) -> tuple[list[str], list[str], list[str], list[tuple[str, bytes]]] | None:
        """
        How the series was fitted; `None` of a material that was not fitted to data.
        """
    @property
    def is_series(self, /) -> bool:
        """
        Whether it is a series, which sweeps take, and not samples as they are.
        """
    @property
    def name(self, /) -> str | None: ...
    @property
    def poisson_ratio(self, /) -> float | None:
        """
        The Poisson ratio, where it is constant in time.
        """
    def prony(self, /, modulus: str) -> tuple[float, NDArray[float64], NDArray[float64]]: ...
    def relaxation_modulus(self, /, time: NDArray[float64], modulus: str) -> NDArray[float64]: ...
    @property
    def temperature_k(self, /) -> float | None: ...
    @property
    def text(self, /) -> str:
        """
        A block of a sweep file that gives the same material again.
        """

@final
class History:
    """
    A history and what it came to.
    """
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def columns(self, /) -> list[tuple[str, Any]]: ...
    def cycles(self, /) -> list[tuple[str, Any]]:
        """
        The cycles of sine segments, one row each.
        """
    @property
    def errors_missing(self, /) -> str | None: ...
    @property
    def failure(self, /) -> str | None:
        """
        Why the history ended before its time.
        """
    def field(self, /, index: SupportsIndex) -> tuple[tuple[float, float, float, float], tuple[float, float], NDArray[float64], NDArray[float64], NDArray[float64] | None]:
        """
        A field of this result, whose arrays are not copied.
        """
    @property
    def field_count(self, /) -> int: ...
    def profile(self, /, index: SupportsIndex) -> tuple[tuple[float, float, float, float], list[tuple[str, tuple[NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64]]]]]: ...
    @property
    def profile_count(self, /) -> int: ...
    @property
    def resolved(self, /) -> str:
        """
        The scenario as the text of its file, every default filled in.
        """
    def save(self, /, folder: str | PathLike[str], force: bool) -> None:
        """
        Writes what the program writes, but for figures and page.
        """
    @property
    def title(self, /) -> str: ...
    def warnings(self, /) -> list[tuple[str, str]]:
        """
        What lies outside the model: code and sentence.
        """

@final
class Shape:
    """
    An indenter that was read from its block of a sweep file, or a height map of an array.
    """
    def __new__(cls, /, name: str, text: str) -> Shape:
        """
        The indenter of a block.
        """
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]":
        """
        A map of an array by its gaps; other indenters are pickled by their text.
        """
    def gap(self, /, x: NDArray[float64], y: NDArray[float64]) -> NDArray[float64]:
        """
        Gap (m) between the undeformed indenter and the half-space at points x, y (m).
        """
    def gaps(self, /) -> NDArray[float64]:
        """
        Gap (m) at every point of a map of an array.
        """
    def key(self, /) -> str:
        """
        Shape and settings, by which indenters of text are compared.
        """
    def map_keys(self, /) -> str:
        """
        The block, without file, that a map of an array has together with its gaps.
        """
    @staticmethod
    def of_heights(name: str, text: str, heights: NDArray[float64]) -> Shape:
        """
        A map of heights, one row for each y, with the other keys of its block.
        """

@final
class Sweep:
    """
    A sweep and what it came to.
    """
    def __len__(self, /) -> int: ...
    def __reduce__(self, /) -> "tuple[Any, tuple[Any, ...]]": ...
    def columns(self, /) -> list[tuple[str, Any]]: ...
    @property
    def control(self, /) -> str: ...
    def cycle(self, /, index: SupportsIndex) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64]] | None: ...
    @property
    def notes(self, /) -> list[str]: ...
    @property
    def peak_problems(self, /) -> list[str]: ...
    def peaks(self, /) -> list[tuple[float, float, float, float | None, list[float | str], float | None, float | None]]: ...
    def profiles(self, /, index: SupportsIndex) -> list[tuple[str, tuple[float, float, float, float], list[tuple[str, NDArray[float64], NDArray[float64]]]]]: ...
    @property
    def resolved(self, /) -> str:
        """
        The sweep as the text of a sweep file, every default filled in.
        """
    def save(self, /, folder: str | PathLike[str], force: bool) -> None:
        """
        Writes what the program writes, but for figures and page.
        """
    def status(self, /) -> list[tuple[str, str | None]]:
        """
        How every case ended, and why it has no result or what else is to be known of it.
        """
    def summary(self, /) -> bytes:
        """
        What is written to summary.json.
        """
    @property
    def title(self, /) -> str: ...
    def warnings(self, /) -> list[list[tuple[str, str]]]:
        """
        The warnings of every case: code and sentence.
        """

def analyse(records: SupportsGetItem[int, Any], frequency_hz: SupportsFloat | SupportsIndex | None, setup: tuple[str, str | None], threads: SupportsIndex | None) -> tuple[list[tuple[str, Any]], list[tuple[NDArray[float64], NDArray[float64], NDArray[float64]] | None], list[tuple[str, str | None]], list[list[tuple[str, str]]], list[tuple[str, bytes]]]:
    """
    What measured loops say. The text is that of a setup.
    """

def identify_material(source: "object", threads: SupportsIndex | None) -> tuple[str, list[str], list[tuple[str, bytes]]]:
    """
    A material from measured cycles: its block, and every file of the folder.
    """

def library_materials() -> list[tuple[str, str, str]]:
    """
    Names and titles of the materials of the library.
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

def read_sweep(folder: str | PathLike[str]) -> Sweep:
    """
    The result in a folder of the program.
    """

def restore_analysis(everything: bytes) -> tuple[list[tuple[str, Any]], list[tuple[NDArray[float64], NDArray[float64], NDArray[float64]] | None], list[tuple[str, str | None]], list[list[tuple[str, str]]], list[tuple[str, bytes]]]:
    """
    The analysis that the program has kept in `analysis.json`.
    """

def restore_history(build: str, resolved: str, shape: Shape | None, packed: bytes) -> History:
    """
    The history that [`History::__reduce__`] has packed.
    """

def restore_sweep(build: str, resolved: str, shape: Shape | None, records: bytes, threads: SupportsIndex) -> Sweep:
    """
    A result of the records that [`Sweep::__reduce__`] has packed.
    """

def simulate(source: "object", threads: SupportsIndex | None, progress: Any | None) -> History:
    """
    Follows a drive history.
    """

def sweep(source: "object", threads: SupportsIndex | None, progress: Any | None) -> Sweep:
    """
    Solves every case of a sweep and locates the peaks.
    """

def write_files(folder: str | PathLike[str], kind: str, files: SupportsGetItem[int, tuple[str, SupportsGetItem[int, SupportsIndex]]], force: bool) -> None:
    """
    Fills the folder of an `analysis`, an `identification` or a `scenario` with files; `force` replaces what else is there.
    """
