"""Results drawn with matplotlib, which is asked for when something is drawn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._result import Result
from ._toml import split_unit, unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .sweeps import SweepResult


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot as plt
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError("plots need matplotlib: pip install matplotlib", name=error.name) from error

    return plt.subplots(layout="constrained")[1]


def label(column: str) -> str:
    """A column in words, with its unit."""
    words, unit = split_unit(column)[0].replace("_", " "), unit_of(column)
    return f"{words} ({unit})" if unit else words


def _condition(result: Result, others: Sequence[str], row: int) -> str:
    """What the axes besides the frequency are in a row."""
    values = [(label(name), result[name][row]) for name in others]
    return ", ".join(str(value) if isinstance(value, str) else f"{words}: {value:.4g}" for words, value in values)


def plot_column(result: Result, axes: Sequence[str], column: str, peaks: Iterable[tuple[float, float]], ax: Axes | None, style: Mapping[str, Any]) -> Axes:
    """A column over the frequency, which is the last of the axes."""
    values = result[column]
    if values.dtype.kind not in "fiu":
        raise ValueError(f"{column} has no numbers that could be drawn")
    ax = _axes(ax)
    *others, frequency = axes
    stem, unit = split_unit(column)
    x, errors = result[frequency], result.get(f"{stem}_error{unit}")
    conditions = [_condition(result, others, row) for row in range(len(x))]
    for condition in dict.fromkeys(conditions):
        rows = np.array([other == condition for other in conditions])
        bars = None if errors is None else errors[rows]
        ax.errorbar(x[rows], values[rows], bars, **{"marker": "o", "markersize": 3, "label": condition or None, **style})
    per_rad = 1.0 if unit_of(frequency) == "rad/s" else 2 * np.pi
    for omega, loss in peaks:
        ax.plot(omega / per_rad, loss, "*", color="black", zorder=3)
    ax.set(xscale="log", xlabel=label(frequency), ylabel=label(column))
    if others:
        ax.legend()
    return ax


def plot_loops(result: SweepResult, cases: Sequence[int] | None, ax: Axes | None, style: Mapping[str, Any]) -> Axes:
    """Load over approach."""
    if cases is None:
        losses = result["energy_loss_j"]
        done = np.flatnonzero(np.isfinite(losses))
        if done.size == 0:
            raise ValueError("no case has a loop that could be drawn")
        spread = done[np.linspace(0, done.size - 1, min(4, done.size)).astype(int)]
        cases = sorted({*spread.tolist(), int(done[np.argmax(losses[done])])})
    ax = _axes(ax)
    for k in cases:
        cycle, condition = result.cycles[k], _condition(result, result._axes()[:-1], k)
        name = f"{cycle.angular_frequency:.3g} rad/s"
        ax.plot(cycle.approach, cycle.load, **{"label": f"{name}, {condition}" if condition else name, **style})
    ax.set(xlabel="approach (m)", ylabel="load (N)")
    ax.legend()
    return ax
