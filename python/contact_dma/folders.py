"""Folders of the program, read."""

from __future__ import annotations

import errno
import json
import os
from pathlib import Path
from typing import Any, TypeVar, Union, overload

from . import _contact_dma as _core
from . import _toml
from .histories import HistoryResult
from .measurements import AnalysisResult, IdentifiedMaterial
from .sweeps import SweepResult


AnyResult = Union[SweepResult, HistoryResult, AnalysisResult, IdentifiedMaterial]
_Kind = TypeVar("_Kind", bound=AnyResult)


def schema(kind: str = "sweep") -> dict[str, Any]:
    """The JSON Schema of a kind of input files, as ``contact-dma schema`` prints it.

    Example:
        >>> sorted(schema("setup")["properties"])
        ['contact', 'indenter', 'instrument', 'title']
    """
    made: dict[str, Any] = json.loads(_core.schema(kind))
    return made


@overload
def read(folder: str | os.PathLike[str], kind: None = None) -> AnyResult: ...
@overload
def read(folder: str | os.PathLike[str], kind: type[_Kind]) -> _Kind: ...
def read(folder: str | os.PathLike[str], kind: type[Any] | None = None) -> Any:
    """The result in a folder that the program or `save` has written: of a sweep, a history, measured loops, or an identified material.

    Nothing is solved, and nothing is written. Cycles of a large sweep stay in the folder until they are asked for.

    Args:
        folder: such as ``reports/pmma``.
        kind: the class of the result that it must hold, such as ``SweepResult``, which type checkers then know.

    Raises:
        ValueError: where the folder holds no such result.
        FileNotFoundError: where it is not there.

    Example:
        >>> import tempfile
        >>> import contact_dma as cd
        >>> result = cd.sweep(cd.Material.library("pmma"), cd.Sphere("10 mm"), mean=10.0, amplitude=5.0,
        ...                   angular_frequency=[1e-2], springs=16, steps=16)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     result.save(folder)
        ...     cd.read(folder, cd.SweepResult) == result
        True
    """
    found = _read(folder)
    if kind is not None and not isinstance(found, kind):
        raise ValueError(f"{os.fspath(folder)} holds a {type(found).__name__}, not a {kind.__name__}")
    return found


def _read(folder: str | os.PathLike[str]) -> AnyResult:
    # Absolute, so that a pickle of what is read is found from another working directory.
    path = Path(_toml.path(folder))
    if not path.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), os.fspath(folder))
    files = dict(_core.files_of(path))
    if "records/analysis.json" in files and "resolved.toml" not in files:
        return AnalysisResult(files["records/analysis.json"].read_bytes())
    if "material.toml" in files and "fit.csv" in files:
        names = (name for name in IdentifiedMaterial._FILES if name in files)
        return IdentifiedMaterial([(name, files[name].read_bytes()) for name in names])
    if (path / "history.csv").is_file():
        return HistoryResult(path)
    return SweepResult(path)
