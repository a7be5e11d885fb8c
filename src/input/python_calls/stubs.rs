//! The types of arguments, and the stubs of all calls, as Python writes them.

use std::fmt::Write;

use serde_json::Value as Json;

use super::{Call, CallOf, calls};
use crate::quantity::key::Kind;

/// The type of what may stand under a key, as Python writes it.
pub(super) fn annotation(kind: &Kind) -> String {
    match kind {
        Kind::Flag => "bool".to_owned(),
        Kind::Integer(_) => "int".to_owned(),
        // With or without a unit.
        Kind::Number(number) => match number.dimension {
            Some(_) => "Quantity".to_owned(),
            None => "float".to_owned(),
        },
        Kind::Text => "str".to_owned(),
        Kind::Word(words) => format!("Literal[{}]", quoted(words)),
        Kind::Numbers(..) => "ArrayLike".to_owned(),
        Kind::Texts(_) => "Sequence[str]".to_owned(),
        Kind::Words(words, _) => format!("Sequence[Literal[{}]]", quoted(words)),
        Kind::Points(..) => "Quantity | ArrayLike | Mapping[str, Any]".to_owned(),
        Kind::Table(_) | Kind::Axes(_) => "Mapping[str, Any]".to_owned(),
        Kind::Tables(..) => "Sequence[Mapping[str, Any]]".to_owned(),
        Kind::Either(first, second, _) => {
            format!("{} | {}", annotation(first), annotation(second))
        }
    }
}

/// The type of what an indenter has under a key of this kind, in SI units.
pub(super) fn attribute(kind: &Kind) -> &'static str {
    match kind {
        Kind::Flag => "bool",
        Kind::Integer(_) => "int",
        Kind::Number(_) => "float",
        Kind::Text | Kind::Word(_) => "str",
        Kind::Numbers(..) => "tuple[float, ...]",
        Kind::Texts(_) | Kind::Words(..) => "tuple[str, ...]",
        Kind::Tables(..) => "tuple[dict[str, Any], ...]",
        Kind::Points(..) | Kind::Table(_) | Kind::Axes(_) | Kind::Either(..) => "Any",
    }
}

/// Words as Python writes them.
fn quoted(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    words.join(", ")
}

/// The stubs of all calls.
pub fn stubs() -> String {
    let mut text = STUBS_HEAD.to_owned();
    let calls = calls();
    let (functions, others): (Vec<&Call>, Vec<&Call>) =
        calls.iter().partition(|call| call.of == CallOf::Module);
    for call in functions {
        let result = match call.name.as_str() {
            "sweep" => "SweepResult",
            "simulate" => "HistoryResult",
            _ => "IdentifiedMaterial",
        };
        write_stub(call, ("", "", result), &mut text);
    }
    text.push_str("\nclass MaterialForms:\n");
    let (forms, shapes): (Vec<&Call>, Vec<&Call>) = others
        .into_iter()
        .partition(|call| call.of == CallOf::Material);
    for call in forms {
        text.push_str("    @classmethod\n");
        write_stub(call, ("    ", "cls", "Material"), &mut text);
    }
    for call in &shapes {
        let _ = write!(text, "\nclass {}(Indenter):\n", call.name);
        let init = ("    ", "self", "None");
        write_stub(call, init, &mut text);
        for argument in call.arguments.iter().filter(|a| !a.key.is_empty()) {
            let (name, kind) = (argument.name, argument.attribute);
            let none = match argument.default {
                Some(Json::Null) => " | None",
                _ => "",
            };
            let _ = writeln!(
                text,
                "    @property\n    def {name}(self) -> {kind}{none}: ..."
            );
        }
    }
    let exported = calls.iter().filter(|call| call.of != CallOf::Material);
    let exported: Vec<&str> = exported.map(|call| call.name.as_str()).collect();
    let _ = writeln!(text, "\n__all__ = [{}]", quoted(&exported));
    text
}

const STUBS_HEAD: &str = "\
# Written by `contact-dma renew` from the keys of the input files.
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from os import PathLike
from typing import Any, Literal, TypeVar

from numpy.typing import ArrayLike, NDArray

from ._result import Progress
from ._toml import ForceCurveLike, Quantity, TableLike, TopographyLike
from .histories import HistoryResult
from .indenters import Indenter
from .materials import BulkModulus, Material
from .measurements import IdentifiedMaterial
from .sweeps import SweepResult

_Body = TypeVar(\"_Body\", bound=Callable[..., Any])

KEYS: dict[str, dict[str, str]]

def body(name: str) -> Callable[[_Body], _Body]: ...
";

/// A stub, indented, with the name of the object or class before its arguments.
fn write_stub(call: &Call, (indent, first, result): (&str, &str, &str), text: &mut String) {
    let name = match call.of {
        CallOf::Indenter => "__init__",
        _ => call.name.as_str(),
    };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{indent}def {name}(");
    if !first.is_empty() {
        let _ = writeln!(text, "{indent}    {first},");
    }
    for (place, argument) in call.arguments.iter().enumerate() {
        if place == call.positional {
            let _ = writeln!(text, "{indent}    *,");
        }
        let default = argument.default.as_ref().map(|value| match value {
            Json::Null => " = None".to_owned(),
            Json::Bool(true) => " = True".to_owned(),
            Json::Bool(false) => " = False".to_owned(),
            value => format!(" = {value}"),
        });
        let (name, annotation) = (argument.name, &argument.annotation);
        let _ = writeln!(
            text,
            "{indent}    {name}: {annotation}{},",
            default.unwrap_or_default()
        );
    }
    let _ = writeln!(
        text,
        "{indent}) -> {result}:\n{indent}    \"\"\"{}",
        call.about
    );
    let _ = writeln!(text, "{indent}    Args:");
    for argument in &call.arguments {
        let _ = writeln!(
            text,
            "{indent}        {}: {}",
            argument.name, argument.means
        );
    }
    let _ = writeln!(text, "{indent}    \"\"\"");
}
