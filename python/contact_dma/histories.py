"""Single drive histories and their results."""

from __future__ import annotations

import html
import os
from collections.abc import Mapping
from typing import Any

from . import _calls
from . import _contact_dma as _core
from ._calls import simulate as simulate
from ._contact_dma import Field as Field
from ._contact_dma import SurfaceLine as SurfaceLine
from ._contact_dma import SurfaceProfile as SurfaceProfile
from ._result import Columns, Table, Warning, arrays, heard, svg, warn
from ._sources import source_of_file, source_of_values, thread_count, warn_without_effect
from ._stored import StoredHistory
from .indenters import Indenter
from .materials import Material


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
        return self._core.warnings

    @property
    def profiles(self) -> tuple[SurfaceProfile, ...]:
        """The surface along lines at the times of ``profiles_at``."""
        return self._core.profiles

    @property
    def fields(self) -> tuple[Field, ...]:
        """Whole fields at the times of ``fields_at``; their arrays are views that cannot be written to."""
        return self._core.fields

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


@_calls.body("simulate")
def _simulate(
    keys: Mapping[str, Any],
    material: Material | str | os.PathLike[str],
    indenter: Indenter | None = None,
    *,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Any = None,
    **bodies: Any,
) -> HistoryResult:
    """Follows one history of load or approach.

    Of a material, fluids and samples as they are too, an indenter and ``segments`` such as ``{"kind": "ramp", "to": "2 N", "duration":
    "5 s"}``, of kinds ``step``, ``ramp``, ``polynomial``, ``sine``, and ``table`` with arrays ``times`` and ``values``; or of a scenario
    file, ``simulate("file.toml", overrides={...})``.

    {arguments}

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
        source = source_of_values("simulate", keys, material, indenter, **bodies)
    else:
        source = source_of_file("simulate", material, indenter, overrides, {**keys, **bodies})
        keys = {}
    result = HistoryResult(_core.History(source, thread_count(threads), told))
    warn_without_effect("simulate", keys, result.resolved)
    if result.failure is not None:
        warn(f"simulate: the history ended before its time: {result.failure}")
    return result
