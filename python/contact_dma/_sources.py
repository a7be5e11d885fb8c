"""What sweeps, histories and identifications have in common: arguments as the source that the compiled module reads."""

from __future__ import annotations

import inspect
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _contact_dma as _core
from . import _toml
from ._result import warn
from .indenters import Indenter
from .materials import Material, library_materials

SWEEP_KEYS = ("angular_frequency", "frequency", "pairs", "refine")
DRIVE_KEYS = ("control", "mean", "amplitude", "phase", "hold")
CYCLE_KEYS = ("steps", "method", "tolerance", "max_cycles", "at_cycle", "error_bars", "accuracy")
SOLVER_KEYS = ("engine", "cells", "springs", "time_rule")


@dataclass(frozen=True)
class Source:
    """A file with changes, or text and values; read by the compiled module."""

    name: str
    text: str | None
    set: Sequence[str] = ()
    material: _core.Body | None = None
    indenter: _core.Shape | None = None


def chosen(options: dict[str, Any], keys: Sequence[str]) -> dict[str, Any]:
    return {key: options.pop(key, None) for key in keys}


def with_signature(function: Callable[..., Any], options: Sequence[str]) -> None:
    """Lets help and notebooks offer the options by name that the function takes as `**options`."""
    plain = inspect.signature(function)
    own = [parameter for parameter in plain.parameters.values() if parameter.kind is not parameter.VAR_KEYWORD]
    defaults = {"control": "load"}
    named = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=defaults.get(name)) for name in options]
    function.__signature__ = plain.replace(parameters=[*own, *named])  # type: ignore[attr-defined]


def refuse(call: str, options: Mapping[str, Any]) -> None:
    if options:
        names = ", ".join(options)
        raise TypeError(f"{call}() got unexpected arguments: {names}")


def file_of(call: str, first: Any, indenter: Any) -> str:
    """The path of a file that is given in place of material and indenter."""
    if isinstance(first, Indenter):
        raise ValueError(f"{call}(material, indenter, ...): the material comes first, then the indenter")
    if isinstance(first, str) and first in library_materials():
        raise ValueError(f"\"{first}\" is a material of the library: write contact_dma.Material.library(\"{first}\")")
    if not isinstance(first, (str, os.PathLike)):
        raise ValueError(f"{call}(material, indenter, ...): the first argument is a Material, or the path of a file, and is {first!r}")
    if indenter is not None:
        raise ValueError(f"{call}(file) takes no indenter, since a file says all; write a Material, such as Material.library(\"pmma\")")
    return _toml.existing(first)


PLACES = {
    **{name: f"drive.{name}" for name in ("mean", "amplitude", "phase", "hold")},
    **{name: f"cycle.{name}" for name in ("steps", "tolerance", "max_cycles", "at_cycle", "accuracy")},
    **{name: f"solver.{name}" for name in ("cells", "springs")},
    "solver_tolerance": "solver.tolerance",
}
"""Options of one value, and their keys in a sweep file, which may be axes."""


def one_each(options: Mapping[str, Any]) -> None:
    """Refuses several values where one is taken."""
    for name, key in PLACES.items():
        if _toml.is_list(options.get(name)):
            raise ValueError(f"{name} takes one value, and has several; of a sweep they are an axis: axes={{\"{key}\": [...]}}")


def axes_of(given: Any) -> dict[str, Any]:
    """The axes besides the frequency."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise ValueError(f"axes is {given!r}: write keys and their values, such as {{\"indenter.radius\": [\"5 mm\", \"10 mm\"]}}")
    for key, values in given.items():
        if values is None:
            raise ValueError(f"the axis {key!r} has no values: write a list, or leave the axis out")
        if key in PLACES:
            raise ValueError(f"the axis {key!r} is not a key: write {PLACES[key]!r}")
        counted = re.sub(r"\.(\d+)(?=\.|$)", r"[\1]", str(key))
        if counted != key:
            raise ValueError(f"the axis {key!r} is not a key: write {counted!r}")
    return dict(given)


def warn_without_effect(call: str, options: Mapping[str, Any], resolved: str) -> None:
    """Warns of options that the engine or the method does not look at."""
    chosen = dict(re.findall(r'(?m)^(engine|method) = "(.*)"$', resolved))
    idle: dict[tuple[str, str], tuple[str, ...]] = {
        ("engine", "axisymmetric"): ("cells", "solver_tolerance"),
        ("engine", "half-space"): ("springs",),
        ("method", "direct"): ("hold",),
    }
    for (kind, name), unused in idle.items():
        for option in unused:
            if chosen.get(kind) == name and options.get(option) is not None:
                warn(f"{call}: {option} has no effect with {kind}=\"{name}\"")


def solver(options: dict[str, Any]) -> str:
    return _toml.table("solver", {**chosen(options, SOLVER_KEYS), "tolerance": options.pop("solver_tolerance", None)})


def source_of_values(
    material: Material | Mapping[str, Material], indenter: Indenter | Mapping[str, Indenter], options: dict[str, Any]
) -> Source:
    axes = axes_of(options.pop("axes", None))
    for what, named in (("material", material), ("indenter", indenter)):
        if isinstance(named, Mapping) and not named:
            raise ValueError(f"there is no {what} in {named!r}: give one, or several by their names")
    one_each(options)
    names = [together(material) if isinstance(material, Mapping) else material.name or "sweep"]
    names.append(together(indenter) if isinstance(indenter, Mapping) else repr(indenter))
    title = options.pop("title", None) or " under ".join(names)
    text = f"title = {_toml.value(title)}\n\n"
    for kind in ("angular_frequency", "frequency"):
        given = options.get(kind)
        if given is not None and not isinstance(given, Mapping) and (np.isscalar(given) or getattr(given, "ndim", 1) == 0):
            options[kind] = [given]
    text += _toml.table("drive", chosen(options, DRIVE_KEYS))
    text += _toml.table("sweep", {**chosen(options, SWEEP_KEYS), **axes}) or "[sweep]\n\n"
    text += _toml.table("cycle", chosen(options, CYCLE_KEYS)) + solver(options)
    # A block that an axis varies is read for every value of it.
    varies = {str(axis).split(".")[0] for axis in axes}
    text += surroundings(options)
    made_of = options.pop("indenter_material", None)
    refuse("sweep", options)
    body, shape = None, None
    if isinstance(material, Mapping):
        for name, one in material.items():
            if not isinstance(one, Material):
                raise ValueError(f"{name!r} is no material but {one!r}: write a Material, such as Material.library('pmma')")
            text += _core.placed(one._source, "material", "sweep.material", str(name)) + "\n"
    elif "material" in varies or not material._core.is_series:
        text += material._source + "\n"
    else:
        body = material._core
    if isinstance(indenter, Mapping):
        for name, each in indenter.items():
            if not isinstance(each, Indenter) or each._text is None:
                raise ValueError(f"{name!r} is {each!r}: write an Indenter, such as Sphere(0.01); a map from a file")
            text += _core.placed(indenter_block(each, made_of, True), "indenter", "sweep.indenter", str(name)) + "\n"
    else:
        if "indenter" in varies and indenter._text is None:
            raise ValueError("a map of an array has no keys to vary: write the array to a file, or make one sweep for each map")
        block = indenter_block(indenter, made_of, "indenter" in varies)
        text, shape = text + block, None if "[indenter]" in block else indenter._core
    return Source("sweep(...)", text, (), body, shape)


def together(names: Mapping[str, Any]) -> str:
    """Names of an axis for a title."""
    if len(names) <= 4:
        return ", ".join(map(str, names))
    first, second, *_, last = map(str, names)
    return f"{first}, {second}, ..., {last} ({len(names)})"


def bodies(indenter: Indenter, options: dict[str, Any], by_text: bool) -> str:
    """The text of the indenter, where it has to be text, of what it is made of, of a layer, and of adhesion."""
    made_of = options.pop("indenter_material", None)
    return surroundings(options) + indenter_block(indenter, made_of, by_text)


def surroundings(options: dict[str, Any]) -> str:
    """The text of a layer and of adhesion."""
    layer, adhesion = options.pop("layer", None), options.pop("adhesion", None)
    if layer is not None and not isinstance(layer, Mapping):
        raise ValueError(f"layer is {layer!r}: write its keys, such as {{\"thickness\": \"0.5 mm\"}}")
    # An empty table is not the half-space, but one whose keys are missing.
    text = _toml.table("layer", layer, even_empty=True) if layer is not None else ""
    if adhesion is not None:
        text += _toml.table("adhesion", adhesion if isinstance(adhesion, Mapping) else {"work": adhesion}, even_empty=True)
    return text


def indenter_block(indenter: Indenter, made_of: Material | str | None, by_text: bool) -> str:
    """The text of the indenter, where it has to be text, and of what it is made of."""
    text = ""
    if made_of is not None and indenter._text is None:
        raise ValueError("an indenter of an array is rigid: write the array to a file and give HeightMap its path")
    if by_text or made_of is not None:
        text += indenter._text or ""
    if isinstance(made_of, Material):
        text += _core.placed(made_of._source, "material", "indenter.material", None)
    elif made_of is not None:
        text += _toml.table("indenter.material", {"library": made_of})
    return text


THREADS = ("CONTACT_DMA_THREADS", "RAYON_NUM_THREADS", "OMP_NUM_THREADS")
"""Variables of the environment that say how many threads there are to be, the first of them that is a number: that of the program, then
those that job schedulers and joblib set for their workers."""


def thread_count(threads: int | None) -> int | None:
    if threads is None:
        given = (os.environ.get(name, "").strip() for name in THREADS)
        return next((int(text) for text in given if text.isdecimal() and 1 <= int(text) < 2**31), None)
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)) or not 1 <= threads < 2**31:
        raise ValueError(f"threads is {threads!r}: give a number of at least 1, or leave it out for one per processor")
    return int(threads)
