"""Functions and classes whose arguments are keys of the input files: their signatures and what every argument means, from the tables of the
program.

Type checkers read ``_calls.pyi``, which ``contact-dma renew`` writes from the same tables."""

import inspect
import json
import re

from . import _contact_dma as _core
from . import _toml
from .indenters import Indenter

_BODIES = {}
KEYS = {}
"""Of every function its arguments that are keys, and these."""


def body(name):
    """Makes a function what is done by the call of this name: it gets the given keys by their dotted names, and all other arguments."""

    def register(function):
        _BODIES[name] = function
        _say(globals()[name], inspect.cleandoc(function.__doc__), next(call for call in _CALLS if call["name"] == name))
        return function

    return register


def _say(function, text, call):
    lines = [f"    {argument['name']}: {argument['means']}" for argument in call["arguments"]]
    function.__doc__ = text.replace("{arguments}", "Args:\n" + "\n".join(lines))


def _parameter(argument, kind):
    default = argument.get("default", inspect.Parameter.empty)
    return inspect.Parameter(argument["name"], kind, annotation=argument["annotation"], default=default)


def _made(name, call, do, first=None):
    """A function of these arguments, which hands those that are given to `do`."""
    arguments = call["arguments"]
    by_place, by_name = inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY
    kinds = [by_place] * call["positional"] + [by_name] * len(arguments)
    parameters = [inspect.Parameter(first, by_place)] if first else []
    signature = inspect.Signature([*parameters, *map(_parameter, arguments, kinds)])
    keys = KEYS[name] = {argument["name"]: argument["key"] for argument in arguments if argument["key"]}
    rows = {argument["name"]: argument["rows"] for argument in arguments if "rows" in argument}
    lists = {argument["name"] for argument in arguments if re.search("ArrayLike|Sequence|Mapping|BulkModulus", argument["annotation"])}
    # Keys that must be in a file, and have a default in Python alone.
    needed = {argument["name"]: "longitudinal" for argument in arguments if argument.get("default") == "longitudinal"}

    def function(*args, **given):
        bound = signature.bind(*args, **given)
        chosen = needed | {name: value for name, value in bound.arguments.items() if value is not None}
        for name in chosen.keys() & keys.keys() - lists:
            if _toml.is_list(chosen[name]):
                axis = "" if first else f"; of a sweep they are an axis: axes={{\"{keys[name]}\": [...]}}"
                raise ValueError(f"{name} takes one value, and has several{axis}")
        by_key = {keys[name]: value for name, value in chosen.items() if name in keys}
        by_key |= {keys[name]: _toml.rows(name, chosen[name], rows[name]) for name in rows.keys() & chosen.keys()}
        others = {name: value for name, value in bound.arguments.items() if name not in keys}
        return do(by_key, **others)

    function.__name__ = function.__qualname__ = name
    function.__module__ = __package__
    function.__signature__ = signature
    return function


def _function(name, call):
    return _made(name, call, lambda keys, **others: _BODIES[name](keys, **others))


def _form(name, call):
    made = _made(name, call, lambda keys, cls, **data: cls._of_form(name, keys, **data), "cls")
    _say(made, f"{call['about']}\n\n{{arguments}}", call)
    return classmethod(made)


def _shape(name, call):
    word = re.sub("(?<!^)(?=[A-Z])", "-", name).lower()
    made = _made("__init__", call, lambda keys, self, **data: self._make(word, keys, **data), "self")
    _say(made, "{arguments}", call)
    settings = {argument["name"]: _setting(argument) for argument in call["arguments"] if argument["key"]}
    content = {"__slots__": (), "__module__": __package__, "__init__": made, "__doc__": call["about"]}
    return type(name, (Indenter,), content | settings)


def _setting(argument):
    name, default = argument["name"], argument.get("default")
    return property(lambda self: self._core.settings().get(name, default), doc=argument["means"])


def _all(of, make):
    return {call["name"]: make(call["name"], call) for call in _CALLS if call["of"] == of}


_CALLS = json.loads(_core.calls())
MaterialForms = type("MaterialForms", (), {"__slots__": ()} | _all("Material", _form))
_EXPORTED = _all("Module", _function) | _all("Indenter", _shape)
__all__ = list(_EXPORTED)
globals().update(_EXPORTED)
