"""Frequency sweeps and their results."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, overload

from . import _calls
from . import _contact_dma as _core
from ._contact_dma import Cycle as Cycle
from ._contact_dma import Peak as Peak
from ._contact_dma import PressureLine as PressureLine
from ._contact_dma import PressureProfile as PressureProfile
from ._plot import plot_column, plot_loops
from ._result import Result, failures, heard
from ._shards import records_of_shards
from ._sources import source_of, thread_count, warn_without_effect
from .indenters import Indenter
from .materials import Material

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Cycles(Sequence[Cycle]):
    """The cycles of all cases, in the order of the rows."""

    def __init__(self, result: SweepResult) -> None:
        self._result = result

    def __len__(self) -> int:
        return self._result._cases

    @overload
    def __getitem__(self, index: int) -> Cycle: ...
    @overload
    def __getitem__(self, index: slice) -> list[Cycle]: ...
    def __getitem__(self, index: int | slice) -> Cycle | list[Cycle]:
        if isinstance(index, slice):
            return [self._result._cycle(k) for k in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(f"there are {len(self)} cases, counted from 0, and none {index}")
        return self._result._cycle(index % len(self))

    def __repr__(self) -> str:
        return f"<Cycles of {len(self)} cases>"


class SweepResult(_core.Sweep, Result):
    """What a sweep came to: columns by name, cycles, peaks.

    Cases are rows, condition after condition, each in ascending frequency. A case without a result is NaN in the columns, and
    `status` has its reason. Results pickle.

    Example:
        >>> import contact_dma as cd
        >>> result = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), mean=10.0, amplitude=5.0,
        ...                   angular_frequency=[1e-3, 1e-2, 1e-1], springs=32, steps=32)
        >>> result["energy_loss_j"].shape
        (3,)
        >>> len(result.peaks), result.cycles[0].load.shape
        (1, (33,))
        >>> [str(status) for status in result.status]
        ['converged', 'converged', 'converged']
    """

    @property
    def cycles(self) -> Cycles:
        """The stabilised cycle of every case."""
        return Cycles(self)

    def plot(self, column: str = "energy_loss_j", *, ax: Axes | None = None, **style: Any) -> Axes:
        """Draws a column over the load frequency, a curve for every condition, with error bars and, of the loss, the peaks; needs matplotlib.

        For a picture as the program draws it, see `figure`.

        Args:
            column: one that has numbers, such as ``"loss_modulus_pa"``.
            ax: what is drawn into; new where it is left out.
            style: what ``ax.errorbar`` takes.

        Returns:
            the axes, for further settings.

        Example:
            >>> import contact_dma as cd
            >>> result = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), mean=10.0, amplitude=5.0,
            ...                   angular_frequency=[1e-3, 1e-2, 1e-1], springs=32, steps=32)
            >>> result.plot("loss_modulus_pa").get_ylabel()
            'loss modulus (Pa)'
        """
        peaks = [(peak.angular_frequency, peak.energy_loss) for peak in self.peaks] if column == "energy_loss_j" else []
        return plot_column(self, self._axes(), column, peaks, ax, style)

    def plot_loops(self, cases: Sequence[int] | None = None, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Draws the hysteresis loops, load over approach; needs matplotlib.

        Args:
            cases: their numbers, from 0; left out: five over the range, the largest loss among them.
            ax: what is drawn into; new where it is left out.
            style: what ``ax.plot`` takes.

        Returns:
            the axes, for further settings.
        """
        return plot_loops(self, cases, ax, style)

    def __repr__(self) -> str:
        done = sum(status.converged for status in self.status)
        peaks, warned = len(self.peaks), sum(map(bool, self.warnings))
        text = f"{done} of {len(self.status)} cases converged, {peaks} peak{'' if peaks == 1 else 's'}"
        return f"<SweepResult {self.title!r}: {text}{f', {warned} with warnings' if warned else ''}>"

    def _failures(self) -> str | None:
        return failures(self.status, "case")

    def _axes(self) -> list[str]:
        frequency, *others = list(self)[: list(self).index("drive_amplitude") + 1]
        return [*(name for name in others if "frequency" not in name and len(set(self[name].tolist())) > 1), frequency]

    def _remarks(self) -> list[str]:
        peaks = [f"peak of {peak.energy_loss:.4g} J at {peak.angular_frequency:.4g} rad/s" for peak in self.peaks[:5]]
        failed = [f"case {k}: {status}" for k, status in enumerate(self.status) if not status.converged]
        said = dict.fromkeys(warning.message for of_case in self.warnings for warning in of_case)
        return peaks + failed[:5] + [f"Warning: {message}" for message in list(said)[:5]]


@_calls.body("sweep")
def _sweep(
    keys: Mapping[str, Any],
    material: Material | Mapping[str, Material] | str | os.PathLike[str],
    indenter: Indenter | Mapping[str, Indenter] | None = None,
    *,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Any = None,
    executor: Executor | None = None,
    shards: int | None = None,
    **bodies: Any,
) -> SweepResult:
    """Solves the stabilised cycle at every load frequency, and locates the peaks of the energy loss.

    Of a material and an indenter, a mean, an amplitude and frequencies, or of a file, ``sweep("file.toml", overrides={"cycle.steps": 48})``.

    {arguments}

    Returns:
        the result; the numbers are those of the program, bit for bit.

    Warns:
        ContactDmaWarning: of cases without a result; ``result.raise_for_status()`` makes an exception of them.

    Raises:
        ValueError: with the program's message, for bad input.
        FileNotFoundError: where a file is not there.
        KeyboardInterrupt: within a second of Ctrl-C.

    Example:
        >>> import contact_dma as cd
        >>> result = cd.sweep(cd.Material.library("pmma"), cd.Sphere(10e-3), mean=10.0, amplitude="5 N",
        ...                   angular_frequency=[1e-2], springs=32, steps=32)
        >>> result["energy_loss_j"] > 0
        array([ True])
    """
    source = source_of("sweep", keys, material, indenter, overrides, bodies)
    if executor is None:
        if shards is not None:
            raise ValueError("shards are handed to an executor, and there is none: give executor=, or leave shards out")
        result = SweepResult(source, thread_count(threads), heard(progress))
    else:
        records = records_of_shards(source, executor, shards, thread_count(threads) or 1, heard(progress))
        result = SweepResult(source, thread_count(threads), None, records)
    warn_without_effect("sweep", source, keys, result.resolved)
    result._warn_of_failures("sweep")
    return result
