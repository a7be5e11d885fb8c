"""Single drive histories and their results."""

from __future__ import annotations

import html
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, overload

from . import _contact_dma as _core
from . import _toml
from ._result import Columns, Floats, Progress, Record, Table, Warning, arrays, heard, svg, warn
from ._sources import SOLVER_KEYS, Source, bodies, file_of, one_each, refuse, solver, thread_count, warn_without_effect, with_signature
from ._stored import StoredHistory
from .indenters import Indenter
from .materials import Material, Quantity


@dataclass(frozen=True, eq=False, repr=False)
class SurfaceLine(Record):
    """The deformed surface along a line through the origin, arrays of shape (n,).

    Attributes:
        along: ``"r"``, ``"x"`` or ``"y"``.
        position: m.
        pressure: Pa; NaN where it is unbounded.
        displacement: m, positive into the body.
        gap: m; NaN where there is no indenter.
    """

    along: str
    position: Floats
    pressure: Floats
    displacement: Floats
    gap: Floats


@dataclass(frozen=True, eq=False, repr=False)
class SurfaceProfile(Record):
    """Profiles at a requested time: time (s), load (N), approach (m), contact radius (m), and lines."""

    time: float
    load: float
    approach: float
    contact_radius: float
    lines: tuple[SurfaceLine, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Field(Record):
    """Fields at a requested time, arrays of shape (cells along y, cells along x) that share the memory of the result.

    Attributes:
        time: s.
        load: N.
        approach: m; NaN where the indenter is clear of the surface.
        contact_radius: m.
        spacing: of the cells along x and y (m).
        pressure: Pa.
        displacement: m, positive into the body.
        gap: m, infinite where there is no indenter; None where its place is unknown.
    """

    time: float
    load: float
    approach: float
    contact_radius: float
    spacing: tuple[float, float]
    pressure: Floats
    displacement: Floats
    gap: Floats | None


class HistoryResult(Table):
    """What a drive history came to: the columns of ``history.csv``, one row a time step; profiles and fields at requested times.

    Example:
        >>> import contact_dma as cd
        >>> result = cd.simulate(cd.Material.library("pmma"), cd.Sphere("10 mm"), springs=32,
        ...                      segments=[{"kind": "ramp", "to": "5 N", "duration": "10 s"}])
        >>> result.failure is None, float(result["load_n"][-1])
        (True, 5.0)
    """

    def __init__(self, core: _core.History | StoredHistory) -> None:
        self._core = core
        self._columns = arrays(core.columns())

    @property
    def title(self) -> str:
        """Its title."""
        return self._core.title

    @property
    def cycles(self) -> Columns:
        """The columns of ``cycles.csv``: loss, phase and moduli of every whole cycle of the sine segments, with errors, arrays of shape
        (cycles,).

        Example:
            >>> import contact_dma as cd
            >>> sine = {"kind": "sine", "mean": 5.0, "amplitude": 2.0, "frequency": "0.1 Hz", "cycles": 2}
            >>> result = cd.simulate(cd.Material.library("pmma"), cd.Sphere("10 mm"), springs=32, segments=[sine])
            >>> result.cycles["energy_loss_j"].shape
            (2,)
        """
        return Columns(arrays(self._core.cycles()))

    @property
    def failure(self) -> str | None:
        """Why the history ended before its time; None where it did not. What came before is in the columns."""
        return self._core.failure

    def raise_for_status(self) -> None:
        """Raises RuntimeError where the history ended before its time, with the reason."""
        if self.failure is not None:
            raise RuntimeError(f"the history ended before its time: {self.failure}")

    @property
    def errors_missing(self) -> str | None:
        """Why there are no errors although they were asked for."""
        return self._core.errors_missing

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """What lies outside the model."""
        return tuple(Warning(*each) for each in self._core.warnings())

    @property
    def profiles(self) -> tuple[SurfaceProfile, ...]:
        """The surface along lines at the times of ``profiles_at``."""
        made = (self._core.profile(k) for k in range(self._core.profile_count))
        return tuple(SurfaceProfile(*at, tuple(SurfaceLine(along, *line) for along, line in lines)) for at, lines in made)

    @property
    def fields(self) -> tuple[Field, ...]:
        """Whole fields at the times of ``fields_at``; their arrays are views that cannot be written to."""
        fields = (self._core.field(k) for k in range(self._core.field_count))
        return tuple(Field(*made[0], *made[1:]) for made in fields)

    @property
    def resolved(self) -> str:
        """The scenario as the text of its file, every default filled in."""
        return self._core.resolved

    def save(self, folder: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Writes the tables that ``contact-dma simulate --no-figures`` writes: ``history.csv``, profiles, fields, ``summary.json``,
        ``resolved.toml``.

        Args:
            folder: is made where it is not there.
            overwrite: whether another result there is replaced.
        """
        self._core.save(os.fspath(folder), overwrite)

    def __repr__(self) -> str:
        ended = f", failed: {self.failure}" if self.failure else ""
        return f"<HistoryResult {self.title!r}: {len(self['time_s'])} time steps{ended}>"

    def _repr_html_(self) -> str:
        picture = svg([(self["time_s"], self["approach_m"])], ("time / s", "approach / m"), log_x=False)
        return f"<figure><figcaption>{html.escape(self.title)}</figcaption>{picture}</figure>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (HistoryResult, (self._core,))


@overload
def simulate(
    material: Material,
    indenter: Indenter,
    *,
    segments: Sequence[Mapping[str, Any]],
    control: Literal["load", "pressure", "approach"] = "load",
    indenter_material: Material | str | None = None,
    layer: Mapping[str, Any] | None = None,
    adhesion: Quantity | Mapping[str, Any] | None = None,
    step: Quantity | None = None,
    profiles_at: Sequence[Quantity] | None = None,
    fields_at: Sequence[Quantity] | None = None,
    field_cells: int | None = None,
    error_bars: bool | None = None,
    engine: Literal["axisymmetric", "half-space"] | None = None,
    cells: int | None = None,
    springs: int | None = None,
    solver_tolerance: float | None = None,
    time_rule: Literal["linear", "constant"] | None = None,
    title: str | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
) -> HistoryResult: ...
@overload
def simulate(
    material: str | os.PathLike[str],
    indenter: None = None,
    *,
    segments: None = None,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
) -> HistoryResult: ...
def simulate(
    material: Material | str | os.PathLike[str],
    indenter: Indenter | None = None,
    *,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
    **options: Any,
) -> HistoryResult:
    """Follows one history of load or approach: of a scenario file, ``simulate("file.toml", overrides={...})``, or of values.

    Args:
        material: what the half-space is made of; fluids and samples as they are will do.
        indenter: what is pressed into it.
        segments: one after another, with the keys of the program: ``{"kind": "ramp", "to": "2 N", "duration": "5 s"}``, kinds
            ``step``, ``ramp``, ``polynomial``, ``sine``, and ``table`` with arrays ``times`` (s) and ``values`` (N or m).
        control: whether the load is prescribed (default), the mean pressure on a surface that repeats itself, or the approach.
        indenter_material: what the indenter is made of, as a material or a name of the library; rigid where it is left out.
        layer: of the material on a base in place of the half-space, ``{"thickness": "0.5 mm", "base": "bonded"}``; on cells.
        adhesion: work of adhesion (J/m^2) of a small, stiff sphere that is attracted, or ``{"work": ..., "equilibrium_distance": ...}``.
        step: time step (s); chosen from drive and material where it is left out.
        profiles_at: times (s) of profiles.
        fields_at: times (s) of fields.
        field_cells: cells per side of the fields of the axisymmetric engine; 128 by default.
        error_bars: whether coarser resolutions give the errors of all rows; True by default.
        engine: the contact engine; the axisymmetric one by default if the indenter is a convex body of revolution.
        cells: of the half-space engine, along the longer side; 128 by default, and a height map has its own.
        springs: of the axisymmetric engine; 400 by default.
        solver_tolerance: of an instant of the half-space engine, relative; chosen where it is left out.
        time_rule: rule of the hereditary integral, ``"linear"`` by default.
        title: of tables and figures; by default what the material and the indenter are.
        threads: how many; where it is left out, as many as ``CONTACT_DMA_THREADS``, ``RAYON_NUM_THREADS`` or ``OMP_NUM_THREADS`` say, and otherwise one
            per processor. Results do not depend on it, bit for bit.
        progress: a function of time steps done and in all, or a bar of tqdm.

    Warns:
        ContactDmaWarning: where the history ended before its time; ``result.raise_for_status()`` makes an exception of it.

    Raises:
        ValueError: with the program's message, for bad input.
        FileNotFoundError: where a file is not there.
        KeyboardInterrupt: within a second of Ctrl-C.

    Example:
        >>> import contact_dma as cd
        >>> touch = [{"kind": "step", "to": "1 N", "duration": "100 s"}]
        >>> creep = cd.simulate(cd.Material.library("pmma"), cd.Sphere("10 mm"), segments=touch, springs=32)
        >>> bool(creep["approach_m"][-1] > creep["approach_m"][1])
        True
    """
    told = heard(progress)
    if isinstance(material, Material):
        if not isinstance(indenter, Indenter):
            raise ValueError("simulate(material, indenter, ...): the second argument is an indenter, such as Sphere(0.01)")
        if overrides is not None:
            raise ValueError("overrides change a file; write options as arguments")
        one_each(options)
        given = dict(options)
        title = options.pop("title", None) or f"{material.name or 'history'} under {indenter!r}"
        text = f"title = {_toml.value(title)}\n\n"
        drive = {"control": options.pop("control", None), "segments": options.pop("segments", None)}
        output = {key: options.pop(key, None) for key in ("profiles_at", "fields_at", "field_cells", "error_bars")}
        text += _toml.table("drive", drive) + _toml.table("time", {"step": options.pop("step", None)})
        text += _toml.table("output", output) + solver(options)
        block = bodies(indenter, options, False)
        refuse("simulate", options)
        shape = None if "[indenter]" in block else indenter._core
        source = Source("simulate(...)", text + block, (), material._core, shape)
    else:
        file, given = file_of("simulate", material, indenter), {}
        if any(option is not None for option in options.values()):
            raise ValueError("a scenario file says all; write overrides={\"solver.springs\": 48} to change it")
        source = Source(file, None, _toml.overrides(overrides))
    result = HistoryResult(_core.simulate(source, thread_count(threads), told))
    warn_without_effect("simulate", given, result.resolved)
    if result.failure is not None:
        warn(f"simulate: the history ended before its time: {result.failure}")
    return result


_DRIVE_KEYS = ("segments", "control", "indenter_material", "layer", "adhesion", "step")
_OUTPUT_KEYS = ("profiles_at", "fields_at", "field_cells", "error_bars")
with_signature(simulate, (*_DRIVE_KEYS, *_OUTPUT_KEYS, *SOLVER_KEYS, "solver_tolerance", "title"))
