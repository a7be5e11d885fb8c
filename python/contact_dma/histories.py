"""Single drive histories and their results."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from . import _calls
from . import _contact_dma as _core
from ._contact_dma import Field as Field
from ._contact_dma import SurfaceLine as SurfaceLine
from ._contact_dma import SurfaceProfile as SurfaceProfile
from ._result import Columns, Result, arrays, heard
from ._sources import source_of, thread_count, warn_without_effect
from .indenters import Indenter
from .materials import Material


class HistoryResult(_core.History, Result):
    """What a drive history came to: the columns of ``history.csv``, one row a time step; profiles and fields at requested times.

    Example:
        >>> import contact_dma as cd
        >>> result = cd.simulate(cd.Material.library("pmma"), cd.Sphere("10 mm"), springs=32,
        ...                      segments=[{"kind": "ramp", "to": "5 N", "duration": "10 s"}])
        >>> result.failure is None, float(result["load_n"][-1])
        (True, 5.0)
    """

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
        return Columns(arrays(self._cycles()))

    def _axes(self) -> list[str]:
        return ["time_s"]

    def _failures(self) -> str | None:
        return None if self.failure is None else f"the history ended before its time: {self.failure}"

    def __repr__(self) -> str:
        ended = f", failed: {self.failure}" if self.failure else ""
        return f"<HistoryResult {self.title!r}: {len(self['time_s'])} time steps{ended}>"


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
    source = source_of("simulate", keys, material, indenter, overrides, bodies)
    result = HistoryResult(source, thread_count(threads), heard(progress))
    warn_without_effect("simulate", source, keys, result.resolved)
    result._warn_of_failures("simulate")
    return result
