"""What results have in common: columns by name, a table for pandas, a curve for notebooks, a folder."""

from __future__ import annotations

import html
import math
import os
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import is_dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ._contact_dma import Status as Status
from ._contact_dma import Warning as Warning

if TYPE_CHECKING:
    import pandas as pd

Floats: TypeAlias = npt.NDArray[np.float64]

Progress = Callable[[int, int], object]
"""Called with what is done and how much there is in all."""


class ContactDmaWarning(UserWarning):
    """A case without a result, a fit that is to be looked at, or an argument that has no effect."""


def warn(message: str) -> None:
    """Warns at the line of the user that called the package."""
    level, frame = 1, sys._getframe()
    own = os.path.dirname(__file__)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == own:
        level, frame = level + 1, frame.f_back
    warnings.warn(message, ContactDmaWarning, stacklevel=level)


def failures(statuses: Sequence[Status], noun: str) -> str | None:
    """What is said of those that have no result; None where all have one."""
    failed = [f"{noun} {k} is {status}" for k, status in enumerate(statuses) if not status.converged]
    if not failed:
        return None
    more = f"; and {len(failed) - 3} more" if len(failed) > 3 else ""
    return f"{len(failed)} of {len(statuses)} {noun}s have no result, and are NaN: {'; '.join(failed[:3])}{more}"


def same(one: Sequence[Any], other: Sequence[Any]) -> bool:
    """Whether values are the same bit for bit, arrays and their NaN too."""
    return len(one) == len(other) and all(_same(a, b) for a, b in zip(one, other))


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    return bool(a == b) or (isinstance(a, float) and isinstance(b, float) and math.isnan(a) and math.isnan(b))


def brief(record: Any) -> str:
    """A record as it was made, without the numbers of its arrays."""
    values = (f"{name}={_brief(getattr(record, name))}" for name in record.__match_args__)
    return f"{type(record).__name__}({', '.join(values)})"


def _brief(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"<{' x '.join(map(str, value.shape))} numbers>"
    if isinstance(value, tuple) and value and is_dataclass(value[0]):
        return f"<{len(value)}>"
    return repr(value)


class Table(Mapping[str, npt.NDArray[Any]]):
    """Columns by name, as in the CSV files of the program: the last part of a name is its SI unit, NaN stands where a value is
    undefined, texts are arrays of strings. Errors stand beside values: ``energy_loss_j`` and ``energy_loss_error_j``. Only ``drive_mean``
    and ``drive_amplitude`` have no unit in their names: they are in N, Pa or m, as the control of the drive is load, pressure or approach."""

    _columns: dict[str, npt.NDArray[Any]]

    def __getitem__(self, column: str) -> npt.NDArray[Any]:
        try:
            return self._columns[column]
        except KeyError:
            names = ", ".join(self._columns)
            raise KeyError(f"no column {column!r}; there are: {names}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __array__(self, *_: Any, **__: Any) -> npt.NDArray[Any]:
        raise TypeError("a result is columns by name, not an array: write result[\"...\"] for a column, or result.to_pandas()")

    def _ipython_key_completions_(self) -> list[str]:
        """What a notebook offers after ``result["``."""
        return list(self._columns)

    def __eq__(self, other: object) -> bool:
        """Whether all columns are the same, bit for bit."""
        if type(other) is not type(self) or not isinstance(other, Table):
            return NotImplemented
        return list(self) == list(other) and same(list(self.values()), list(other.values()))

    __hash__ = None  # type: ignore[assignment]

    def to_pandas(self) -> pd.DataFrame:
        """The columns as a data frame, one row a case; needs pandas."""
        try:
            import pandas as pd
        except ModuleNotFoundError as error:
            raise ModuleNotFoundError("to_pandas needs pandas: pip install pandas", name=error.name) from error

        return pd.DataFrame(dict(self._columns))


class Columns(Table):
    """Columns that come with a result."""

    def __init__(self, columns: Mapping[str, npt.NDArray[Any]]) -> None:
        self._columns = dict(columns)

    def __repr__(self) -> str:
        return f"<{len(next(iter(self._columns.values()), ()))} rows of {', '.join(self._columns)}>"


def arrays(columns: list[tuple[str, Any]]) -> dict[str, npt.NDArray[Any]]:
    """Columns of the compiled module, lists of texts as arrays; none can be written to."""
    made = {name: np.asarray(values) for name, values in columns}
    for array in made.values():
        array.flags.writeable = False
    return made


def heard(progress: Any) -> Progress | None:
    """A callback, or a bar of tqdm, as a callback."""
    if progress is None:
        return None
    if hasattr(progress, "update"):

        def told(done: int, total: int) -> None:
            progress.total = total
            progress.update(done - progress.n)

        return told
    if not callable(progress):
        raise ValueError("progress is called with what is done and the total: give a function, or a bar of tqdm")
    return progress  # type: ignore[no-any-return]


COLORS = ("#1f5fa8", "#c0392b", "#2e8b57", "#b8860b", "#7d3c98", "#16828c")
"""Of the curves of a picture, one after another."""


def ticks(low: float, high: float) -> list[float]:
    """About four round numbers from the lowest to the highest."""
    if not high > low:
        return [low]
    decade = 10.0 ** math.floor(math.log10((high - low) / 4))
    step = next(decade * k for k in (1, 2, 5, 10) if decade * k >= (high - low) / 4)
    return [step * k for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def svg(
    curves: list[tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]],
    labels: tuple[str, str],
    *,
    log_x: bool,
    names: Sequence[str] = (),
    marks: Sequence[tuple[float, float]] = (),
) -> str:
    """Curves as a small inline picture, with their names and with marked points; points without a value are left out."""
    width, height, left, top, right, bottom = 420, 240, 78, 14, 12, 44
    kept, colors = [], []
    for k, (x, y) in enumerate(curves):
        fine = np.isfinite(x) & np.isfinite(y) & ((x > 0) | (not log_x))
        if fine.any():
            kept.append((np.log10(x[fine]) if log_x else x[fine], y[fine]))
            colors.append(COLORS[k % len(COLORS)])
    if not kept:
        return "<p>no case has a result</p>"
    x0, x1 = min(x.min() for x, _ in kept), max(x.max() for x, _ in kept)
    y0, y1 = min(0.0, min(y.min() for _, y in kept)), max(y.max() for _, y in kept)

    def place(x: float, y: float) -> str:
        across = (x - x0) / (x1 - x0) if x1 > x0 else 0.5
        up = (y - y0) / (y1 - y0) if y1 > y0 else 0.5
        return f"{left + across * (width - left - right):.1f},{height - bottom - up * (height - top - bottom):.1f}"

    def circle(point: str, color: str) -> str:
        cx, cy = point.split(",")
        return f'<circle cx="{cx}" cy="{cy}" r="2.5" fill="{color}"/>'

    lines = []
    for (x, y), color in zip(kept, colors):
        points = " ".join(place(a, b) for a, b in zip(x.tolist(), y.tolist()))
        lines.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.6"/>')
        if len(x) == 1:
            lines.append(circle(points, color))
    lines.extend(circle(place(math.log10(x) if log_x else x, y), "currentColor") for x, y in marks)
    base = height - bottom
    texts = []
    for tick in ticks(x0, x1):
        text = f"{10.0**tick if log_x else tick:.3g}"
        texts.append(f'<text x="{place(tick, y0).split(",")[0]}" y="{base + 16}" text-anchor="middle">{text}</text>')
    for tick in ticks(y0, y1):
        texts.append(f'<text x="{left - 5}" y="{float(place(x0, tick).split(",")[1]) + 4}" text-anchor="end">{tick:.3g}</text>')
    # As many names as there is room for.
    for k, name in enumerate(names[:12] if len(curves) > 1 else ()):
        color = COLORS[k % len(COLORS)]
        texts.append(f'<text x="{left + 8}" y="{top + 10 + 14 * k}" fill="{color}">{html.escape(name)}</text>')
    texts += [
        f'<text x="{(left + width - right) / 2}" y="{height - 8}" text-anchor="middle">{html.escape(labels[0])}</text>',
        f'<text transform="translate(12 {(top + base) / 2}) rotate(-90)" text-anchor="middle">{html.escape(labels[1])}</text>',
    ]
    frame = f'<path d="M{left} {top}V{base}H{width - right}" fill="none" stroke="#888"/>'
    style = 'font-family="sans-serif" font-size="11" fill="currentColor"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" {style}>'
        f"{frame}{''.join(lines)}{''.join(texts)}</svg>"
    )


def shown(value: float, unit: str) -> str:
    """A number for people, or a dash."""
    return f"{value:.4g} {unit}" if math.isfinite(value) else "–"
