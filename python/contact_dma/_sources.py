"""What sweeps, histories and identifications have in common: arguments as the source that the compiled module reads."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _contact_dma as _core
from . import _calls, _toml
from ._result import warn
from .indenters import Indenter
from .materials import Material, library_materials

@dataclass(frozen=True)
class Source:
    """A file with changes, or text and values; read by the compiled module."""

    name: str
    text: str | None
    set: Sequence[str] = ()
    tables: Sequence[tuple[str, bytes]] = ()
    material: _core.Body | None = None
    indenter: _core.Shape | None = None


def source_of(
    call: str, keys: Mapping[str, Any], material: Any, indenter: Any, overrides: Mapping[str, Any] | None, others: Mapping[str, Any]
) -> Source:
    """Of material and indenter, of which a sweep may have several by their names, or of a file in place of both."""
    materials: tuple[type[Any], ...] = (Material, Mapping) if call == "sweep" else (Material,)
    indenters: tuple[type[Any], ...] = (Indenter, Mapping) if call == "sweep" else (Indenter,)
    if not isinstance(material, materials):
        return _source_of_file(call, material, indenter, overrides, {**keys, **others})
    if not isinstance(indenter, indenters):
        raise ValueError(f"{call}(material, indenter, ...): the second argument is an indenter, such as Sphere(0.01)")
    if overrides is not None:
        raise ValueError("overrides change a file; write options as arguments: steps=48 in place of {'cycle.steps': 48}")
    return source_of_values(call, keys, material, indenter, **others)


def _source_of_file(call: str, first: Any, indenter: Any, overrides: Mapping[str, Any] | None, others: Mapping[str, Any]) -> Source:
    """A file that is given in place of material and indenter."""
    if isinstance(first, Indenter):
        raise ValueError(f"{call}(material, indenter, ...): the material comes first, then the indenter")
    if isinstance(first, str) and first in library_materials():
        raise ValueError(f"\"{first}\" is a material of the library: write contact_dma.Material.library(\"{first}\")")
    if not isinstance(first, (str, os.PathLike)):
        raise ValueError(f"{call}(material, indenter, ...): the first argument is a Material, or the path of a file, and is {first!r}")
    if indenter is not None:
        raise ValueError(f"{call}(file) takes no indenter, since a file says all; write a Material, such as Material.library(\"pmma\")")
    given = [key.rpartition(".")[2] for key, other in others.items() if other is not None]
    if given:
        raise ValueError(f"the file says all; in place of {', '.join(given)} write overrides={{\"solver.springs\": 48}}")
    return Source(_toml.existing(first), None, _toml.overrides(overrides))


def axes_of(given: Any) -> dict[str, Any]:
    """The axes besides the frequency."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise ValueError(f"axes is {given!r}: write keys and their values, such as {{\"indenter.radius\": [\"5 mm\", \"10 mm\"]}}")
    for key, values in given.items():
        if values is None:
            raise ValueError(f"the axis {key!r} has no values: write a list, or leave the axis out")
        if key in _calls.KEYS["sweep"]:
            raise ValueError(f"the axis {key!r} is not a key: write {_calls.KEYS['sweep'][key]!r}")
        counted = re.sub(r"\.(\d+)(?=\.|$)", r"[\1]", str(key))
        if counted != key:
            raise ValueError(f"the axis {key!r} is not a key: write {counted!r}")
    return dict(given)


def warn_without_effect(call: str, source: Source, keys: Mapping[str, Any], resolved: str) -> None:
    """Warns of options that the engine or the method does not look at, where these are arguments."""
    if source.text is None:
        return
    chosen = dict(re.findall(r'(?m)^(engine|method) = "(.*)"$', resolved))
    idle: dict[tuple[str, str], dict[str, str]] = {
        ("engine", "axisymmetric"): {"solver.cells": "cells", "solver.tolerance": "solver_tolerance"},
        ("engine", "half-space"): {"solver.springs": "springs"},
        ("method", "direct"): {"drive.hold": "hold"},
    }
    for (kind, name), unused in idle.items():
        for key, option in unused.items():
            if chosen.get(kind) == name and key in keys:
                warn(f"{call}: {option} has no effect with {kind}=\"{name}\"")


HEADERS = {"sweep": ("drive", "sweep"), "simulate": ("drive",), "identify": ("identify", "material", "drive"), "identify-curve": ("identify", "material")}
"""Tables that a call has whatever is given."""


def source_of_values(
    call: str,
    keys: Mapping[str, Any],
    material: Material | Mapping[str, Material] | None,
    indenter: Indenter | Mapping[str, Indenter],
    *,
    axes: Any = None,
    tables: Sequence[tuple[str, bytes]] = (),
    indenter_material: Material | str | None = None,
    layer: Mapping[str, Any] | None = None,
    adhesion: Any = None,
) -> Source:
    """The text of keys and axes, and of bodies that are no values, or that an axis varies."""
    axes = axes_of(axes)
    for what, named in (("material", material), ("indenter", indenter)):
        if isinstance(named, Mapping) and not named:
            raise ValueError(f"there is no {what} in {named!r}: give one, or several by their names")
    tables_of_keys = _toml.tables({**keys, "title": keys.get("title") or _title(call, material, indenter)}, *HEADERS[call])
    if call == "sweep":
        tables_of_keys["sweep"].update(axes)
    if layer is not None and not isinstance(layer, Mapping):
        raise ValueError(f"layer is {layer!r}: write its keys, such as {{\"thickness\": \"0.5 mm\"}}")
    # An empty table is not the half-space, but one whose keys are missing.
    work = adhesion if adhesion is None or isinstance(adhesion, Mapping) else {"work": adhesion}
    tables_of_keys |= {name: dict(given) for name, given in (("layer", layer), ("adhesion", work)) if given is not None}
    text = _toml.document(tables_of_keys)
    # A block that an axis varies is read for every value of it.
    varies = {str(axis).split(".")[0] for axis in axes}
    body, shape = None, None
    if isinstance(material, Mapping):
        for name, one in material.items():
            if not isinstance(one, Material):
                raise ValueError(f"{name!r} is no material but {one!r}: write a Material, such as Material.library('pmma')")
            text += _core.placed(one._source, "material", "sweep.material", str(name)) + "\n"
    elif material is not None and ("material" in varies or (call == "sweep" and not material._is_series)):
        text += material._source + "\n"
    else:
        body = material
    if isinstance(indenter, Mapping):
        for name, each in indenter.items():
            if not isinstance(each, Indenter):
                raise ValueError(f"{name!r} is {each!r}: write an Indenter, such as Sphere(0.01)")
            text += _core.placed(indenter_block(each, indenter_material), "indenter", "sweep.indenter", str(name)) + "\n"
    elif "indenter" in varies or indenter_material is not None:
        text += indenter_block(indenter, indenter_material)
    else:
        shape = indenter._core
    held = [table for each in (indenter.values() if isinstance(indenter, Mapping) else [indenter]) for table in each._tables]
    return Source(f"{call}(...)", text, (), list(dict([*tables, *held]).items()), body, shape)


def _title(call: str, material: Any, indenter: Any) -> str:
    if material is None:
        return "Measured cycles"
    of = together(material) if isinstance(material, Mapping) else material.name or ("sweep" if call == "sweep" else "history")
    return f"{of} under {together(indenter) if isinstance(indenter, Mapping) else repr(indenter)}"


def together(names: Mapping[str, Any]) -> str:
    """Names of an axis for a title."""
    if len(names) <= 4:
        return ", ".join(map(str, names))
    first, second, *_, last = map(str, names)
    return f"{first}, {second}, ..., {last} ({len(names)})"


def indenter_block(indenter: Indenter, made_of: Material | str | None) -> str:
    """The text of the indenter, and of what it is made of."""
    if isinstance(made_of, Material):
        return indenter._text + _core.placed(made_of._source, "material", "indenter.material", None)
    return indenter._text + ("" if made_of is None else _toml.document({"indenter.material": {"library": made_of}}))


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
