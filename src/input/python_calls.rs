//! The functions of the Python package whose arguments are keys of the input files: their signatures and what every argument means, from the
//! tables of keys. The package makes its functions of them where it is imported, `contact-dma renew` the stubs that type checkers read.

mod arguments;
mod stubs;

use serde::Serialize;
use serde_json::{Value as Json, json};

use super::document::kind::json_of;
use super::key_reference::ways;
use super::keys::{self, FileKind, material::NAME};
use crate::identify::IdentifyPlan;
use crate::material::ModulusKind;
use crate::quantity::block::{Block, Word};
use crate::quantity::key::{Key, Kind};
use crate::quantity::rows::{Branch, Rows};
use crate::sweep::plan::CyclePlan;
use arguments::{
    AS_PYTHON, COMMON, DATA, DYNAMIC, FILE, HEIGHTS, INDENTER, INDENTERS, MATERIAL, MATERIALS,
    OF_SWEEP, Own, PROFILE, SAMPLES,
};
pub use stubs::stubs;
use stubs::{annotation, attribute};

/// A function, a constructor of a material, or the arguments of a class of indenters.
#[derive(Serialize)]
pub struct Call {
    /// In Python: `sweep`, `zener`, `FlatPunch`.
    pub name: String,
    pub of: CallOf,
    /// What it makes, or is; empty for a function.
    pub about: &'static str,
    /// Arguments that may be given by their places; the others have names.
    pub positional: usize,
    pub arguments: Vec<Argument>,
}

/// Where a call belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum CallOf {
    Module,
    Material,
    Indenter,
}

/// An argument.
#[derive(Serialize)]
pub struct Argument {
    pub name: &'static str,
    /// The dotted key that it stands for; empty for what is no key.
    pub key: String,
    /// Its type, as Python writes it.
    pub annotation: String,
    /// What counts where it is left out; `None` where it must be there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub default: Option<Json>,
    pub means: String,
    /// Of a list of tables that rows stand for: their keys, each with the number of its values, and whether it must be there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rows: Vec<(&'static str, usize, bool)>,
    /// The type of what an indenter has under the key.
    #[serde(skip)]
    pub attribute: &'static str,
}

/// Every call.
pub fn calls() -> Vec<Call> {
    let mut calls = vec![
        function(
            "sweep",
            FileKind::Sweep,
            &["drive", "sweep", "cycle", "solver"],
        ),
        function(
            "simulate",
            FileKind::Scenario,
            &["drive", "time", "output", "solver"],
        ),
        function(
            "identify",
            FileKind::Identify,
            &["identify", "material", "drive", "cycle", "solver"],
        ),
    ];
    let forms = ways("material").into_iter();
    let forms = forms.filter(|(form, _)| deciding(form).is_some());
    calls.extend(forms.map(|(form, about)| material(form, about)));
    let shapes = ways("indenter").into_iter();
    calls.extend(shapes.map(|(shape, about)| indenter(shape, about)));
    calls
}

/// Constructors of materials, as the guide lists them.
pub fn constructors() -> Vec<String> {
    let calls = calls()
        .into_iter()
        .filter(|call| call.of == CallOf::Material);
    calls.map(|call| call.name).collect()
}

/// Required keys of a form or a shape may be given by their places; of more than so many only the first.
const MOST_BY_PLACE: usize = 3;

/// Forms and shapes that Python also takes data for as arrays: what may be given by its place, and these arguments.
const WITH_DATA: [(&str, &[&str], &[Own]); 4] = [
    ("table", &["time", "values"], &SAMPLES),
    ("dynamic", &["file"], &DYNAMIC),
    ("profile", &["file", "gap"], &PROFILE),
    ("height-map", &["heights", "spacing"], &HEIGHTS),
];

/// Keys that name the data of a form; in Python these are arguments that are no keys.
const DATA_KEYS: [&str; 4] = ["file", "files", "times", "values"];

/// An argument that is no key.
fn own((name, annotation, means): Own) -> Argument {
    Argument {
        name,
        key: String::new(),
        annotation: annotation.to_owned(),
        default: annotation.ends_with("None").then_some(Json::Null),
        means: means.to_owned(),
        rows: Vec::new(),
        attribute: "",
    }
}

/// An argument for a key at a dotted path.
fn of_key(path: &str, key: &Key) -> Argument {
    // Moduli and compliances are longitudinal where nothing else is said.
    let is_longitudinal = key.kind.words() == ModulusKind::WORDS;
    let default = match (key.default(), key.is_required()) {
        (None, true) => is_longitudinal.then(|| json!(ModulusKind::Longitudinal.word())),
        (default, _) => default.as_ref().map(json_of).or(Some(Json::Null)),
    };
    Argument {
        name: key.name,
        key: match path {
            "" => key.name.to_owned(),
            path => format!("{path}.{}", key.name),
        },
        annotation: annotation(&key.kind),
        default,
        means: format!("{} {}.", key.means(), capital(&key.kind.expected())),
        rows: Vec::new(),
        attribute: attribute(&key.kind),
    }
}

/// The keys of the tables in a list, for rows in place of these.
fn rows_of(kind: &Kind) -> Vec<(&'static str, usize, bool)> {
    let Kind::Tables(rows, ..) = kind else {
        return Vec::new();
    };
    let row = |key: &Key| match &key.kind {
        Kind::Number(_) => Some((key.name, 1, key.is_required())),
        Kind::Numbers(_, entries) if *entries.number.end() == 2 => {
            Some((key.name, 2, key.is_required()))
        }
        _ => None,
    };
    let rows: Option<Vec<_>> = rows.all().into_iter().map(row).collect();
    rows.unwrap_or_default()
}

/// Makes an argument one that may be left out.
fn optional(mut argument: Argument) -> Argument {
    argument.default = argument.default.or(Some(Json::Null));
    or_none(&mut argument.annotation);
    argument
}

/// Makes a type one that may be None.
fn or_none(annotation: &mut String) {
    if !annotation.ends_with("None") {
        annotation.push_str(" | None");
    }
}

/// A function of a kind of file: the keys of some of its tables, and what else it takes.
fn function(name: &str, kind: FileKind, tables: &[&'static str]) -> Call {
    let is_identify = kind == FileKind::Identify;
    let first: &[Own] = match kind {
        FileKind::Identify => &[DATA, INDENTER, FILE],
        FileKind::Sweep => &[MATERIALS, INDENTERS],
        FileKind::Scenario | FileKind::Setup => &[MATERIAL, INDENTER],
    };
    let mut arguments: Vec<Argument> = first.iter().map(|first| own(*first)).collect();
    let positional = 2;
    let all = kind.rows().all();
    for table in tables {
        let rows = all.iter().find(|row| row.name == *table);
        let keys = rows.and_then(|row| row.kind.rows()).map(Rows::all);
        for key in keys.unwrap_or_default() {
            let is_own = matches!(key.kind, Kind::Axes(_)) || key.name == "data";
            if !is_own {
                let mut argument = optional(of_key(table, key));
                if argument.key == "solver.tolerance" {
                    argument.name = "solver_tolerance";
                }
                arguments.push(argument);
            }
        }
    }
    if is_identify {
        model_defaults(&mut arguments);
    }
    let title = all.iter().find(|row| row.name == "title");
    let title = title.map(|row| optional(of_key("", row)));
    let common = COMMON
        .into_iter()
        .filter(|own| !(is_identify && own.0 == "progress"));
    arguments.extend(title.into_iter().chain(common.map(own)));
    if kind == FileKind::Sweep {
        arguments.extend(OF_SWEEP.map(own));
    }
    Call {
        name: name.to_owned(),
        of: CallOf::Module,
        about: "",
        positional,
        arguments,
    }
}

/// The model of an identification is coarser than a sweep.
fn model_defaults(arguments: &mut [Argument]) {
    let cycle = CyclePlan::KEYS.iter().zip(IdentifyPlan::CYCLE.values());
    let cycle = cycle.filter_map(|(key, value)| Some((key.name, json_of(&value?))));
    let solver = [
        ("springs", json!(IdentifyPlan::SPRINGS)),
        ("cells", json!(IdentifyPlan::CELLS)),
    ];
    for (name, default) in cycle.chain(solver) {
        for argument in arguments
            .iter_mut()
            .filter(|argument| argument.name == name)
        {
            argument.default = Some(default.clone());
        }
    }
}

/// The ways to fill a table that a key, or a word under one, decides for.
fn branches(table: &str, decides: &str) -> Vec<Branch> {
    let branches = keys::tables_at(table).into_iter().map(Rows::branches);
    let of = |branch: &Branch| {
        let first = branch.decided_by.first();
        first.is_some_and(|(key, word)| word.unwrap_or(key) == decides)
    };
    let branches = branches.map(|all| all.into_iter().filter(of).collect::<Vec<_>>());
    branches.max_by_key(Vec::len).unwrap_or_default()
}

/// The key of a form of material that is a table or a name.
fn deciding(form: &str) -> Option<&'static Key> {
    let way = branches("material", form).into_iter().next()?;
    let key = way.keys.first().copied()?;
    matches!(key.kind, Kind::Table(_) | Kind::Text).then_some(key)
}

/// What Python takes as data of a form or a shape.
fn data_of(name: &str) -> (&'static [&'static str], &'static [Own]) {
    let known = WITH_DATA.iter().find(|(known, ..)| *known == name);
    known.map_or((&[], &[]), |(_, places, data)| (*places, *data))
}

/// The keys that a table may have whatever else it has.
fn own_keys_of(table: &str) -> Vec<&'static Key> {
    let rows = keys::tables_at(table).into_iter().next();
    rows.map(Rows::own).unwrap_or_default()
}

/// A constructor of a material: the keys of its form, and those beside it.
fn material(form: &'static str, about: &'static str) -> Call {
    let ways = branches("material", form);
    let everywhere = |row: &&Key| {
        let has = |way: &Branch| way.keys.iter().any(|other| other.name == row.name);
        ways.iter().all(has)
    };
    let (path, data) = (format!("material.{form}"), data_of(form));
    let rows = keys::tables_at(&path).into_iter().next();
    let mut arguments = arguments_of(&path, rows.map(Rows::all).unwrap_or_default(), data);
    // What some ways to fill the table lack may be left out: the program says where it is needed.
    let own: Vec<&str> = rows
        .map(Rows::own)
        .unwrap_or_default()
        .iter()
        .map(|key| key.name)
        .collect();
    let kinds = rows.map(Rows::branches).unwrap_or_default();
    let is_of_some = |argument: &Argument| {
        if !data.1.is_empty() {
            return false;
        }
        let is_in = |way: &Branch| way.keys.iter().any(|key| key.name == argument.name);
        !own.contains(&argument.name) && kinds.iter().any(is_in) && !kinds.iter().all(is_in)
    };
    let all = arguments.into_iter();
    arguments = all
        .map(|argument| {
            if is_of_some(&argument) {
                optional(argument)
            } else {
                argument
            }
        })
        .collect();
    let name = deciding(form).filter(|key| matches!(key.kind, Kind::Text));
    arguments.extend(name.map(|key| Argument {
        name: NAME.name,
        ..of_key("material", key)
    }));
    let own = required(&arguments);
    let mut beside = own_keys_of("material");
    beside.extend(ways.iter().flat_map(|way| way.keys.iter().copied()));
    for row in beside.into_iter().filter(|row| row.name != form) {
        let mut argument = of_key("material", row);
        if form == "dynamic" && argument.name == "temperature" {
            argument.name = "temperature_of_sweep";
        }
        if arguments.iter().all(|known| known.name != argument.name) {
            arguments.push(match everywhere(&row) {
                true => argument,
                false => optional(argument),
            });
        }
    }
    let name = match form {
        "dynamic" => "from_dynamic",
        form => form,
    };
    let named = (name.to_owned(), CallOf::Material, about);
    call(named, (data.0, own), arguments)
}

/// The arguments of a class of indenters: the keys of its shape, and where it stands.
fn indenter(shape: &'static str, about: &'static str) -> Call {
    let ways = branches("indenter", shape);
    let (data, keys) = (
        data_of(shape),
        ways.iter().flat_map(|way| way.keys.iter().copied()),
    );
    let mut arguments = arguments_of("indenter", keys.collect(), data);
    let own = required(&arguments);
    let beside = own_keys_of("indenter").into_iter();
    let beside = beside.filter(|row| row.name == "offset");
    arguments.extend(beside.map(|row| of_key("indenter", row)));
    call(
        (class(shape), CallOf::Indenter, about),
        (data.0, own),
        arguments,
    )
}

/// Arguments for keys, lists of tables in the form that they have in Python, behind those for data, which stand in place of some.
fn arguments_of(
    path: &str,
    keys: Vec<&'static Key>,
    (_, data): (&[&str], &[Own]),
) -> Vec<Argument> {
    let keys = keys.into_iter();
    let keys = keys.filter(|key| data.is_empty() || !DATA_KEYS.contains(&key.name));
    let arguments = keys.map(|key| Argument {
        rows: rows_of(&key.kind),
        ..of_key(path, key)
    });
    data.iter()
        .map(|data| own(*data))
        .chain(arguments)
        .collect()
}

/// Names of the arguments that must be there.
fn required(arguments: &[Argument]) -> Vec<&'static str> {
    let required = arguments
        .iter()
        .filter(|argument| argument.default.is_none());
    required.map(|argument| argument.name).collect()
}

/// A call with these arguments first, the others behind them in their order.
fn call(
    (name, of, about): (String, CallOf, &'static str),
    (places, required): (&[&'static str], Vec<&'static str>),
    mut arguments: Vec<Argument>,
) -> Call {
    let count = match required.len() {
        count if count > MOST_BY_PLACE => 1,
        count => count,
    };
    let by_place = required.get(..count).filter(|_| places.is_empty());
    let places = by_place.unwrap_or(places);
    let place = |argument: &Argument| {
        let place = places.iter().position(|place| *place == argument.name);
        place.unwrap_or(places.len())
    };
    arguments.sort_by_key(place);
    for argument in &mut arguments {
        let is_table = argument.annotation.contains("Mapping");
        let as_python = AS_PYTHON
            .iter()
            .find(|own| is_table && own.0 == argument.name);
        if let Some((_, annotation, means)) = as_python {
            (argument.annotation, argument.means) = ((*annotation).to_owned(), (*means).to_owned());
        }
        if argument.default == Some(Json::Null) {
            or_none(&mut argument.annotation);
        }
    }
    Call {
        name,
        of,
        about,
        positional: places.len(),
        arguments,
    }
}

/// The class of a shape: `FlatPunch` of `flat-punch`.
pub fn class(shape: &str) -> String {
    shape.split('-').map(capital).collect()
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_argument_is_one_key_and_those_by_their_places_come_first() {
        for call in calls() {
            let names: Vec<&str> = call.arguments.iter().map(|a| a.name).collect();
            for (place, name) in names.iter().enumerate() {
                assert!(
                    !names[..place].contains(name),
                    "{} has {name} twice",
                    call.name
                );
            }
            let required = |argument: &Argument| argument.default.is_none();
            let by_place = call.arguments.iter().take(call.positional);
            let optional = by_place.skip_while(|a| required(a)).filter(|a| required(a));
            assert_eq!(optional.count(), 0, "{}", call.name);
        }
    }
}
