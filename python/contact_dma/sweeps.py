"""Frequency sweeps and their results."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, overload

import numpy as np
import numpy.typing as npt

from . import _contact_dma as _core
from . import _toml
from ._result import Floats, Progress, Record, Status, Table, Warning, arrays, failures, heard, shown, svg, warn
from ._sources import CYCLE_KEYS, DRIVE_KEYS, SOLVER_KEYS, SWEEP_KEYS, Source, file_of, source_of_values, thread_count, warn_without_effect, with_signature
from .indenters import Indenter
from .materials import Material, Quantity


@dataclass(frozen=True)
class Peak:
    """A local maximum of the energy loss over frequency, located to a thousandth of its frequency.

    Attributes:
        angular_frequency: its angular frequency (rad/s).
        energy_loss: the loss per cycle there (J).
        angular_frequency_uncertainty: numerical uncertainty of the frequency (rad/s).
        energy_loss_error: numerical error of the loss (J); None without error bars.
        varied: SI values of the axes besides the frequency, names of materials or indenters, empty where there are none.
        drive_mean: mean of the drive (N, Pa or m by its control), where there are several.
        drive_amplitude: amplitude of the drive (N, Pa or m), where there are several.
        varied_columns: the column of the result that each value of `varied` belongs to.
    """

    angular_frequency: float
    energy_loss: float
    angular_frequency_uncertainty: float
    energy_loss_error: float | None
    varied: tuple[float | str, ...] = ()
    drive_mean: float | None = None
    drive_amplitude: float | None = None
    varied_columns: tuple[str, ...] = ()

    @property
    def frequency(self) -> float:
        """Its frequency (Hz)."""
        return self.angular_frequency / (2 * np.pi)


@dataclass(frozen=True, eq=False, repr=False)
class PressureLine(Record):
    """The contact pressure along a line through the origin.

    Attributes:
        along: ``"r"``, ``"x"`` or ``"y"``.
        position: positions (m), shape (n,).
        pressure: pressures (Pa), shape (n,); NaN where it is unbounded.
    """

    along: str
    position: Floats
    pressure: Floats


@dataclass(frozen=True, eq=False, repr=False)
class PressureProfile(Record):
    """The contact pressure at a quarter of the oscillation.

    Attributes:
        instant: such as ``"greatest load"``.
        time: since the cycle began (s).
        load: load (N).
        approach: approach (m).
        contact_radius: contact radius (m).
        lines: along the radius, or along x and y.
    """

    instant: str
    time: float
    load: float
    approach: float
    contact_radius: float
    lines: tuple[PressureLine, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Cycle(Record):
    """The stabilised cycle of a case, sample by sample; arrays of length 0 where the case has no result.

    Attributes:
        angular_frequency: rad/s.
        time: since the cycle began (s), shape (samples,).
        load: N, shape (samples,).
        approach: m, shape (samples,).
        contact_radius: m, shape (samples,).
        peak_pressure: Pa, shape (samples,); NaN where it is unbounded.
        profiles: the pressure over the contact at the quarters of the oscillation.
    """

    angular_frequency: float
    time: Floats
    load: Floats
    approach: Floats
    contact_radius: Floats
    peak_pressure: Floats
    profiles: tuple[PressureProfile, ...]


class Cycles(Sequence[Cycle]):
    """The cycles of all cases, in the order of the rows."""

    def __init__(self, result: SweepResult) -> None:
        self._result = result

    def __len__(self) -> int:
        return len(self._result._core)

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


class SweepResult(Table):
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

    def __init__(self, core: _core.Sweep) -> None:
        self._core = core
        self._columns = arrays(core.columns())

    @property
    def title(self) -> str:
        """Its title."""
        return self._core.title

    @property
    def status(self) -> tuple[Status, ...]:
        """How every case ended, and why it has no result."""
        return tuple(Status(*each) for each in self._core.status())

    @property
    def warnings(self) -> tuple[tuple[Warning, ...], ...]:
        """For every case, what lies outside the model or was not estimated."""
        return tuple(tuple(Warning(*each) for each in of_case) for of_case in self._core.warnings())

    def raise_for_status(self) -> None:
        """Raises RuntimeError where a case has no result, with the reasons of the first."""
        message = failures(self.status, "case")
        if message is not None:
            raise RuntimeError(message)

    @property
    def peaks(self) -> tuple[Peak, ...]:
        """Local maxima of the loss over frequency, largest first."""
        peaks = self._core.peaks()
        columns = self._axes() if any(p[4] for p in peaks) else ()
        return tuple(Peak(*p[:4], varied=tuple(p[4]), drive_mean=p[5], drive_amplitude=p[6], varied_columns=columns) for p in peaks)

    @property
    def peak_problems(self) -> tuple[str, ...]:
        """Peaks that could not be located, with the reason."""
        return tuple(self._core.peak_problems)

    @property
    def notes(self) -> tuple[str, ...]:
        """What was met on the way, such as a damaged record."""
        return tuple(self._core.notes)

    @property
    def cycles(self) -> Cycles:
        """The stabilised cycle of every case."""
        return Cycles(self)

    @property
    def resolved(self) -> str:
        """The sweep as the text of a sweep file, every default filled in."""
        return self._core.resolved

    @property
    def summary(self) -> dict[str, Any]:
        """What the program writes to ``summary.json``."""
        summary: dict[str, Any] = json.loads(self._core.summary())
        return summary

    def save(self, folder: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Writes what ``contact-dma sweep`` writes: records, ``sweep.csv``, loops, pressures, work, ``cycles.npz``,
        ``summary.json``, ``resolved.toml``, ``run.json``; a map of an array as ``height-map.npy``.

        Figures and page are drawn from these by ``contact-dma report FOLDER``, and `read` reads them again.

        Args:
            folder: is made where it is not there.
            overwrite: whether another sweep's results there are replaced.
        """
        self._core.save(os.fspath(folder), overwrite)

    def _cycle(self, index: int) -> Cycle:
        samples = self._core.cycle(index)
        none = np.empty(0)
        profiles = (
            PressureProfile(instant, *numbers, tuple(PressureLine(*line) for line in lines))
            for instant, numbers, lines in self._core.profiles(index)
        )
        omega = float(self["angular_frequency_rad_per_s"][index])
        return Cycle(omega, *(samples or (none, none, none, none, none)), tuple(profiles))

    def _axes(self) -> tuple[str, ...]:
        """The columns of the axes besides the frequency."""
        return tuple(axis["column"] for axis in self.summary.get("axes", []))

    def _curves(self) -> tuple[list[tuple[Floats, Floats]], list[str]]:
        """Frequencies and losses of every curve, and what axes have there."""
        omega, loss = self["angular_frequency_rad_per_s"], self["energy_loss_j"]
        # A curve ends where frequencies begin anew.
        ends = [*(np.flatnonzero(np.diff(omega) <= 0) + 1).tolist(), len(omega)]
        starts = [0, *ends[:-1]]
        axes = self._axes()

        def name(case: int) -> str:
            values = (self[axis][case] for axis in axes)
            return ", ".join(value if isinstance(value, str) else f"{axis} {value:.4g}" for axis, value in zip(axes, values))

        return [(omega[a:b], loss[a:b]) for a, b in zip(starts, ends)], [name(a) for a in starts]

    def __repr__(self) -> str:
        done = sum(status.converged for status in self.status)
        peaks, warned = len(self.peaks), sum(map(bool, self.warnings))
        text = f"{done} of {len(self.status)} cases converged, {peaks} peak{'' if peaks == 1 else 's'}"
        return f"<SweepResult {self.title!r}: {text}{f', {warned} with warnings' if warned else ''}>"

    def _repr_html_(self) -> str:
        labels = ("angular frequency ω / rad/s", "energy loss ΔW / J")
        rows = "".join(
            f"<li>peak of {shown(p.energy_loss, 'J')} at {shown(p.angular_frequency, 'rad/s')}</li>" for p in self.peaks[:5]
        )
        failed = [f"<li>case {k}: {html.escape(str(s))}</li>" for k, s in enumerate(self.status) if not s.converged]
        said = dict.fromkeys(warning.message for of_case in self.warnings for warning in of_case)
        failed = failed[:5] + [f"<li>Warning: {html.escape(message)}</li>" for message in list(said)[:5]]
        curves, names = self._curves()
        marks = [(peak.angular_frequency, peak.energy_loss) for peak in self.peaks]
        picture = svg(curves, labels, log_x=True, names=names, marks=marks)
        return f"<figure><figcaption>{html.escape(self.title)}</figcaption>{picture}<ul>{rows}{''.join(failed)}</ul></figure>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (SweepResult, (self._core,))


@overload
def sweep(
    material: Material | Mapping[str, Material],
    indenter: Indenter | Mapping[str, Indenter],
    *,
    mean: Quantity,
    amplitude: Quantity,
    angular_frequency: npt.ArrayLike | Mapping[str, Any] | None = None,
    frequency: npt.ArrayLike | Mapping[str, Any] | None = None,
    control: Literal["load", "pressure", "approach"] = "load",
    phase: Quantity | None = None,
    hold: Quantity | None = None,
    indenter_material: Material | str | None = None,
    layer: Mapping[str, Any] | None = None,
    adhesion: Quantity | Mapping[str, Any] | None = None,
    axes: Mapping[str, Sequence[Quantity] | npt.NDArray[Any]] | None = None,
    pairs: bool | None = None,
    refine: bool | None = None,
    steps: int | None = None,
    method: Literal["direct", "march"] | None = None,
    tolerance: float | None = None,
    max_cycles: int | None = None,
    at_cycle: int | None = None,
    error_bars: bool | None = None,
    accuracy: float | None = None,
    engine: Literal["axisymmetric", "half-space"] | None = None,
    cells: int | None = None,
    springs: int | None = None,
    solver_tolerance: float | None = None,
    time_rule: Literal["linear", "constant"] | None = None,
    title: str | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
) -> SweepResult: ...
@overload
def sweep(
    material: str | os.PathLike[str],
    indenter: None = None,
    *,
    mean: None = None,
    amplitude: None = None,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
) -> SweepResult: ...
def sweep(
    material: Material | Mapping[str, Material] | str | os.PathLike[str],
    indenter: Indenter | Mapping[str, Indenter] | None = None,
    *,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
    **options: Any,
) -> SweepResult:
    """Solves the stabilised cycle at every load frequency, and locates the peaks of the energy loss.

    Either of a sweep file, ``sweep("file.toml", overrides={"cycle.steps": 48})``, where an override takes the place of the
    program's ``--set`` and None removes a key; or of values:

    Args:
        material: what the half-space is made of; several by their names, ``{"dry": dry, "wet": wet}``, are an axis.
        indenter: what is pressed into it; several by their names likewise.
        mean: mean load (N), or mean approach (m).
        amplitude: amplitude of the load (N), or of the approach (m).
        angular_frequency: angular frequencies (rad/s), shape (n,), in any order; or a range ``{"from": ..., "to": ..., "points": ...}``.
        frequency: frequencies (Hz), in place of these.
        control: whether the load is prescribed (default), the mean pressure on a surface that repeats itself, or the approach.
        phase: at which the oscillation begins (rad); 0 by default.
        hold: rest under the mean before it (s); for the march alone, 0 by default.
        indenter_material: what the indenter is made of, as a material or a name of the library; rigid where it is left out.
        layer: of the material on a base in place of the half-space, ``{"thickness": "0.5 mm", "base": "bonded"}``; on cells. The base
            is rigid, or has ``base_modulus_ratio`` times the layer's shear modulus, and ``base_poisson_ratio``.
        adhesion: work of adhesion (J/m^2) of a small, stiff sphere that is attracted, or ``{"work": ..., "equilibrium_distance": ...}``.
        axes: other axes of the sweep, such as ``{"indenter.radius": ["5 mm", "10 mm"], "drive.amplitude": [1.0, 2.0]}``.
        pairs: whether the values of axes go together one by one, in place of all combinations (default).
        refine: whether frequencies are added where the curve is not resolved; False by default.
        steps: time steps per cycle; 200 by default.
        method: whether the stabilised cycle is found directly (default) or by marching.
        tolerance: distance to the stabilised cycle, relative; 1e-4 by default.
        max_cycles: cycles of marching, at most; 1000 by default.
        at_cycle: the cycle of the march that is recorded as it is, in place of the stabilised one; with ``method="march"``.
        error_bars: whether coarser resolutions give the errors of all results; True by default.
        accuracy: largest relative error of every loss; steps and nodes are then chosen.
        engine: the contact engine; the axisymmetric one by default if the indenter is a convex body of revolution.
        cells: of the half-space engine, along the longer side; 128 by default, and a height map has its own.
        springs: of the axisymmetric engine; 400 by default.
        solver_tolerance: of an instant of the half-space engine, relative; by default a tenth of what ``tolerance`` allows in the loss.
        time_rule: rule of the hereditary integral, ``"linear"`` by default.
        title: of tables and figures; by default what the material and the indenter are.
        threads: how many; where it is left out, as many as ``CONTACT_DMA_THREADS``, ``RAYON_NUM_THREADS`` or ``OMP_NUM_THREADS`` say, and otherwise one
            per processor. Results do not depend on it, bit for bit.
        progress: a function of cases done and cases in all, or a bar of tqdm.

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
    told = heard(progress)
    if isinstance(material, (Material, Mapping)):
        if not isinstance(indenter, (Indenter, Mapping)):
            raise ValueError("sweep(material, indenter, ...): the second argument is an indenter, such as Sphere(0.01)")
        if overrides is not None:
            raise ValueError("overrides change a file; write options as arguments: steps=48 in place of {'cycle.steps': 48}")
        result = SweepResult(_core.sweep(source_of_values(material, indenter, dict(options)), thread_count(threads), told))
        warn_without_effect("sweep", options, result.resolved)
    else:
        file = file_of("sweep", material, indenter)
        given = [name for name, option in options.items() if option is not None]
        if given:
            raise ValueError(f"a sweep file says all; in place of {', '.join(given)} write overrides={{\"cycle.steps\": 48}}")
        result = SweepResult(_core.sweep(Source(file, None, _toml.overrides(overrides)), thread_count(threads), told))
    message = failures(result.status, "case")
    if message is not None:
        warn(f"sweep: {message}")
    return result


_OTHER_KEYS = ("indenter_material", "layer", "adhesion", "axes", "solver_tolerance", "title")
with_signature(sweep, (*DRIVE_KEYS, *SWEEP_KEYS, *CYCLE_KEYS, *SOLVER_KEYS, *_OTHER_KEYS))
