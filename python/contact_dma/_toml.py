"""Arguments as the text of an input file, so that keys, ranges, units and messages are those of the program."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np


def value(given: Any) -> str:
    """A value as TOML: numbers without losing a bit, strings, lists, tables, arrays of NumPy."""
    if isinstance(given, (bool, np.bool_)):
        return "true" if given else "false"
    if isinstance(given, (int, np.integer)):
        return str(int(given))
    if isinstance(given, (float, np.floating)):
        return repr(float(given))
    if isinstance(given, str):
        return json.dumps(given, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(given, os.PathLike):
        return value(os.fspath(given))
    if isinstance(given, np.ndarray):
        return value(given.tolist())
    if isinstance(given, Mapping):
        pairs = (f"{key(name)} = {value(item)}" for name, item in given.items() if item is not None)
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(given, Iterable):
        return "[" + ", ".join(value(item) for item in given) + "]"
    raise ValueError(f"{given!r} is a {type(given).__name__}: write a number, a string with a unit, or a list of them")


def key(name: str) -> str:
    """A key, in quotes where it has other characters than letters, digits, `_` and `-`."""
    bare = name.replace("_", "").replace("-", "")
    return name if bare.isascii() and bare.isalnum() else value(name)


def table(header: str, entries: Mapping[str, Any]) -> str:
    """A table of a file; entries that are None are left out, and a table without entries is none."""
    lines = [f"{key(name)} = {value(item)}\n" for name, item in entries.items() if item is not None]
    return f"[{header}]\n" + "".join(lines) + "\n" if lines else ""


def path(file: str | os.PathLike[str]) -> str:
    """The absolute path of a file, which stays right where it is read from another folder."""
    return os.path.abspath(os.fspath(file))


def overrides(changes: Mapping[str, Any] | None) -> list[str]:
    """Changes of a file as the arguments of `--set`; None removes a key."""
    return [f"{name}={'' if item is None else value(item)}" for name, item in (changes or {}).items()]
