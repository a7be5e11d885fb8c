"""Functions whose arguments are keys of the input files: their signatures and what every argument means, from the tables of the program.

Type checkers read ``_calls.pyi``, which ``contact-dma renew`` writes from the same tables."""

import inspect
import json
import re

from . import _contact_dma as _core
from . import _toml

_BODIES = {}
KEYS = {}
"""Of every function its arguments that are keys, and these."""


def body(name):
    """Makes a function what is done by the call of this name: it gets the given keys by their dotted names, and all other arguments."""

    def register(function):
        _BODIES[name] = function
        arguments = next(arguments for _, call, *_, arguments in _CALLS if call == name)
        _public(globals()[name], inspect.cleandoc(function.__doc__), arguments)
        return function

    return register


def _public(function, text, arguments):
    lines = [f"    {name}: {means}" for name, _, _, _, means in arguments]
    function.__doc__ = text.replace("{arguments}", "Args:\n" + "\n".join(lines))


def _parameter(argument, kind):
    name, _, annotation, default, _ = argument
    default = inspect.Parameter.empty if default is None else json.loads(default)
    return inspect.Parameter(name, kind, annotation=annotation, default=default)


def _made(name, positional, arguments, do, first=None):
    """A function of these arguments, which hands those that are given to `do`."""
    by_place, by_name = inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY
    kinds = [by_place] * positional + [by_name] * len(arguments)
    parameters = [inspect.Parameter(first, by_place)] if first else []
    signature = inspect.Signature([*parameters, *map(_parameter, arguments, kinds)])
    keys = {argument[0]: argument[1] for argument in arguments if argument[1]}
    KEYS[name] = keys
    lists = {argument[0] for argument in arguments if re.search("ArrayLike|Sequence|Mapping|BulkModulus", argument[2])}

    # Keys that must be in a file, and have a default in Python alone.
    needed = {argument[0]: "longitudinal" for argument in arguments if argument[3] == '"longitudinal"'}

    def call(*args, **given):
        bound = signature.bind(*args, **given)
        chosen = needed | {name: value for name, value in bound.arguments.items() if value is not None}
        for name in chosen.keys() & keys.keys() - lists:
            if _toml.is_list(chosen[name]):
                axis = "" if first else f"; of a sweep they are an axis: axes={{\"{keys[name]}\": [...]}}"
                raise ValueError(f"{name} takes one value, and has several{axis}")
        by_key = {keys[name]: value for name, value in chosen.items() if name in keys}
        others = {name: value for name, value in bound.arguments.items() if name not in keys}
        return do(by_key, **others)

    call.__name__ = call.__qualname__ = name
    call.__module__ = __package__
    call.__signature__ = signature
    return call


def _function(name, _, positional, arguments):
    return _made(name, positional, arguments, lambda keys, **others: _BODIES[name](keys, **others))


def _form(name, about, positional, arguments):
    made = _made(name, positional, arguments, lambda keys, cls, **data: cls._of_form(name, keys, **data), "cls")
    _public(made, f"{about}\n\n{{arguments}}", arguments)
    return classmethod(made)


def _shape(name, about, positional, arguments):
    word = re.sub("(?<!^)(?=[A-Z])", "-", name).lower()
    made = _made("__init__", positional, arguments, lambda keys, self: self._made_of(word, keys), "self")
    _public(made, "{arguments}", arguments)
    return type(name, (), {"__slots__": (), "__init__": made, "__doc__": about})


_CALLS = _core.calls()
MaterialForms = type("MaterialForms", (), {"__slots__": ()} | {call[0]: _form(*call) for of, *call in _CALLS if of == "Material"})
globals().update({call[0]: _function(*call) for of, *call in _CALLS if not of})
globals().update({call[0]: _shape(*call) for of, *call in _CALLS if of == "Indenter"})
