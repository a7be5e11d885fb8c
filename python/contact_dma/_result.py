"""What results have in common: columns by name, a table for pandas, a picture for notebooks."""

from __future__ import annotations

import csv
import html
import io
import json
import math
import os
import sys
import warnings
from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import is_dataclass
from inspect import Parameter, Signature
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ._contact_dma import Figure as Figure
from ._contact_dma import Status as Status
from ._contact_dma import Warning as Warning

from ._toml import unit_of

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


def filled(names: Sequence[str], values: Sequence[Any], named: Mapping[str, Any] | None) -> tuple[Any, ...]:
    """The fields of a record by place or by name; None where one is left out."""
    fields = [Parameter(name, Parameter.POSITIONAL_OR_KEYWORD, default=None) for name in names]
    bound = Signature(fields).bind(*values, **(named or {}))
    bound.apply_defaults()
    return bound.args


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

    def _axes(self) -> list[str]:
        """The columns whose values tell rows from one another."""
        return []

    def to_xarray(self) -> Any:
        """The columns as a dataset of xarray over what varies, or over the rows, with their SI units; needs xarray and pandas.

        Returns:
            a ``xarray.Dataset``, NaN where a combination was not computed.
        """
        axes, frame = self._axes(), self.to_pandas()
        dataset = (frame.set_index(axes) if axes else frame).to_xarray()
        for name in dataset.variables:
            dataset[name].attrs["units"] = unit_of(str(name))
        return dataset


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


def table(content: bytes) -> Columns:
    """A CSV file as columns: numbers with NaN for empty cells, or texts."""
    head, *rows = csv.reader(io.StringIO(content.decode("utf-8")))

    def column(cells: Sequence[str]) -> npt.NDArray[Any]:
        try:
            return np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError:
            return np.array(cells)

    return Columns(arrays([(name, column([row[k] for row in rows])) for k, name in enumerate(head)]))


def failures(statuses: Sequence[Status], noun: str) -> str | None:
    """What is said of those that have no result; None where all have one."""
    failed = [f"{noun} {k} is {status}" for k, status in enumerate(statuses) if not status.converged]
    if not failed:
        return None
    more = f"; and {len(failed) - 3} more" if len(failed) > 3 else ""
    return f"{len(failed)} of {len(statuses)} {noun}s have no result, and are NaN: {'; '.join(failed[:3])}{more}"


class Result(Table):
    """Columns of a compiled result, how it ended, and how a notebook shows it."""

    @abstractmethod
    def _all_columns(self) -> list[tuple[str, Any]]: ...

    @abstractmethod
    def _figures(self) -> list[Figure]: ...

    @abstractmethod
    def _summary(self) -> bytes: ...

    @property
    def summary(self) -> dict[str, Any]:
        """What the program writes to ``summary.json``."""
        summary: dict[str, Any] = json.loads(self._summary())
        return summary

    @property
    @abstractmethod
    def title(self) -> str:
        """Its title."""

    @abstractmethod
    def _failures(self) -> str | None:
        """What is said of what has no result; None where all has one."""

    def __init__(self, *_: Any) -> None:
        self._columns = arrays(self._all_columns())

    @property
    def figures(self) -> dict[str, Figure]:
        """The figures that the program draws of it, by name; a notebook shows them, and ``figure.save("loss.pdf")`` writes one.

        Example:
            >>> import contact_dma as cd
            >>> result = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), mean=10.0, amplitude=5.0,
            ...                   angular_frequency=[1e-3, 1e-2, 1e-1], springs=32, steps=32)
            >>> result.figures["energy-loss"]
            <Figure energy-loss>
        """
        return {figure.name: figure for figure in self._figures()}

    def figure(self, name: str) -> Figure:
        """One of `figures`: ``result.figure("energy-loss").save("loss.pdf")``.

        Example:
            >>> import contact_dma as cd
            >>> result = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), mean=10.0, amplitude=5.0,
            ...                   angular_frequency=[1e-3, 1e-2, 1e-1], springs=32, steps=32)
            >>> result.figure("loops")
            <Figure loops>
        """
        figures = self.figures
        if name not in figures:
            raise KeyError(f"no figure {name!r}; there are: {', '.join(figures)}")
        return figures[name]

    def raise_for_status(self) -> None:
        """Raises RuntimeError where something has no result, with the reasons of the first."""
        message = self._failures()
        if message is not None:
            raise RuntimeError(message)

    def _warn_of_failures(self, call: str) -> None:
        message = self._failures()
        if message is not None:
            warn(f"{call}: {message}")

    def _remarks(self) -> list[str]:
        """What is said below its picture."""
        return []

    def _repr_html_(self) -> str:
        picture = next((figure._repr_html_() for figure in self._figures()), None) or "<p>no case has a result</p>"
        remarks = "".join(f"<li>{html.escape(remark)}</li>" for remark in self._remarks())
        caption = f"<figcaption>{html.escape(self.title)}</figcaption>"
        # Pictures are drawn on white.
        return f'<figure style="background: white; color: black">{caption}{picture}<ul>{remarks}</ul></figure>'


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
