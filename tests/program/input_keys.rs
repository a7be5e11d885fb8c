//! What the schemas say of the keys of input files is what the program does, and every key comes back in the resolved file.

use crate::prelude::*;
use std::sync::OnceLock;

use crate::refused;
use contact_dma::input::given::Given;
use contact_dma::input::keys::{self, FileKind};
use contact_dma::input::{identify_file, scenario_file, schema, sweep_file};
use contact_dma::simulation::scenario;
use contact_dma::sweep::plan::resolved::identity;
use toml::Value;

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Whether files that tests hold to what they should be are written anew.
pub fn is_renewed() -> bool {
    std::env::var_os("RENEW").is_some()
}

/// Holds a file to what it should be, or writes that.
pub fn assert_current(file: impl AsRef<Path>, expected: &str) {
    let path = root().join(&file);
    if is_renewed() {
        fs::write(&path, expected).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    let name = file.as_ref().display();
    let renew = "with RENEW=1 this test writes it anew";
    assert!(found == expected, "{name} is stale: {renew}:\n{expected}");
}

#[test]
fn the_command_prints_the_schemas() {
    for (name, kind) in FileKind::NAMES {
        let printed = Place::new().done(&format!("schema --kind {name}"));
        assert_eq!(printed.stdout, schema::text(*kind));
    }
}

/// The validator of a kind of file; to make one takes longer than what it then has to do.
fn validator(kind: FileKind) -> &'static jsonschema::Validator {
    static MADE: OnceLock<Vec<(FileKind, jsonschema::Validator)>> = OnceLock::new();
    let made = MADE.get_or_init(|| {
        let make = |(_, kind)| {
            let schema = serde_json::from_str(&schema::text(kind)).unwrap();
            (kind, jsonschema::draft202012::new(&schema).unwrap())
        };
        FileKind::NAMES.iter().copied().map(make).collect()
    });
    let (_, validator) = made.iter().find(|(known, _)| *known == kind).unwrap();
    validator
}

fn json(text: &str) -> serde_json::Value {
    serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
}

fn problems(kind: FileKind, text: &str) -> String {
    let (validator, instance) = (validator(kind), json(text));
    let errors = validator
        .iter_errors(&instance)
        .map(|error| error.to_string());
    errors.collect::<Vec<_>>().join("\n")
}

#[test]
fn every_example_names_its_schema_and_validates() {
    let all = below(&root().join("sweeps"), "toml");
    assert!(all.len() > 25);
    for path in all.iter().filter(|path| !path.ends_with("figures.toml")) {
        let text = fs::read_to_string(path).unwrap();
        let table: toml::Table = text.parse().unwrap();
        let (name, kind) = match ["sweep", "identify"].map(|key| table.contains_key(key)) {
            [true, _] => FileKind::NAMES[0],
            [_, true] => FileKind::NAMES[2],
            _ => FileKind::NAMES[1],
        };
        let named = text
            .lines()
            .find_map(|line| line.strip_prefix("#:schema "))
            .unwrap();
        let named = path.parent().unwrap().join(named).canonicalize().unwrap();
        let is_named = named.ends_with(format!("sweeps/schema/{name}.json"));
        assert!(is_named, "{}", path.display());
        assert_eq!(problems(kind, &text), "", "{}", path.display());
    }
}

#[test]
fn what_a_schema_can_see_of_a_wrong_file_it_refuses_as_the_program_does() {
    let right = pmma_sweep("[sweep]\nangular_frequency = [\"0.01 rad/s\"]\n");
    assert_eq!(problems(FileKind::Sweep, &right), "");
    let kinds = FileKind::NAMES.iter().map(|(name, kind)| match kind {
        FileKind::Scenario => ("simulate", *kind),
        _ => (*name, *kind),
    });
    let mut seen = String::new();
    for (folder, kind) in kinds {
        for file in refused::files(folder, "toml") {
            let text = String::from_utf8_lossy(&fs::read(&file).unwrap()).into_owned();
            if text.parse::<toml::Table>().is_ok() && !problems(kind, &text).is_empty() {
                let name = file.file_name().unwrap().to_str().unwrap();
                seen.push_str(&format!("{folder}/{name}\n"));
            }
        }
    }
    assert_current("tests/refused/seen-by-schema.txt", &seen);
}

/// Files that have, together, every key, and the data that they name: what they are is how their names begin.
fn accepted() -> PathBuf {
    root().join("tests/accepted")
}

fn files() -> Vec<(FileKind, String)> {
    let of = |path: PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap();
        let (command, _) = name.split_once('-').unwrap();
        let kind = match command {
            "sweep" => FileKind::Sweep,
            "simulate" => FileKind::Scenario,
            "identify" => FileKind::Identify,
            other => panic!("{other} is no kind of file"),
        };
        (kind, fs::read_to_string(&path).unwrap())
    };
    let mut files: Vec<(FileKind, String)> =
        below(&accepted(), "toml").into_iter().map(of).collect();
    files.extend(files.iter().flat_map(over_every_number).collect::<Vec<_>>());
    files
}

/// A sweep with the block of a file, over each of its numbers that may be a second axis.
fn over_every_number((of, text): &(FileKind, String)) -> Vec<(FileKind, String)> {
    let kind = FileKind::Sweep;
    let base = fs::read_to_string(accepted().join("sweep-plain.toml")).unwrap();
    let (base, table): (toml::Table, toml::Table) = (base.parse().unwrap(), text.parse().unwrap());
    let all = keys::paths(kind);
    let paths = all.iter().filter_map(|path| {
        let (block, key) = path.strip_prefix("sweep.")?.split_once('.')?;
        // A history may be on a fluid, and under an indenter of one.
        let is_right = block == "indenter" || *of == FileKind::Sweep;
        let whole = table.get(block).filter(|_| is_right)?.as_table()?;
        let whole = Some(whole).filter(|whole| !whole.contains_key("material"))?;
        // The series of a bulk modulus is no number.
        let number = whole.get(key).filter(|value| !value.is_table())?;
        let axis = [(key.to_owned(), Value::Array(vec![number.clone()]))];
        let mut over = base.clone();
        over.insert(block.to_owned(), whole.clone().into());
        let sweep = over.get_mut("sweep")?.as_table_mut()?;
        sweep.insert(block.to_owned(), toml::Table::from_iter(axis).into());
        Some((kind, toml::to_string(&over).unwrap()))
    });
    paths.collect()
}

/// Keys that cannot be changed alone, or that no file above shows, and why.
const APART: [&str; 15] = [
    // What a sweep is called makes no other sweep.
    "title",
    // What the files hold counts, and the hash of it, not what they are called.
    "indenter.file",
    "indenter.sha256",
    "material.table.file",
    "material.dynamic.file",
    "material.dynamic.files",
    "material.dynamic.shift.file",
    // A file has one format.
    "material.dynamic.format",
    "drive.segments.file",
    "identify.data",
    // No trial finds another name of the library.
    "material.library",
    "indenter.material.library",
    // Creep rises and relaxation falls: no values are both.
    "material.table.quantity",
    // Has no contact, and so neither sweep nor history.
    "material.kelvin_voigt.spring",
    "material.kelvin_voigt.time",
];

/// The resolved text of a file, or why it is refused.
fn resolved(kind: FileKind, text: &str) -> Result<String, String> {
    let document = Document::parse("file.toml", text)
        .unwrap()
        .in_folder(&accepted());
    let text = match kind {
        FileKind::Sweep => sweep_file::plan(&document).map(|plan| resolved_text(&plan)),
        FileKind::Scenario => {
            scenario_file::plan(&document).map(|plan| scenario::resolved_text(&plan))
        }
        FileKind::Identify => {
            identify_file::plan(&document, &Given::default()).map(|asked| asked.resolved_text())
        }
        FileKind::Setup => unreachable!("a setup is not resolved: `setup_file` has its own tests"),
    };
    text.map_err(|why| why.render(contact_dma::input::diagnostic::Styling::Plain))
}

/// Every value that is no table, by the dotted path of its key.
fn leaves(value: &mut Value, path: &str, see: &mut dyn FnMut(&str, &mut Value)) {
    match value {
        Value::Table(table) => {
            for (key, value) in table.iter_mut() {
                let path = format!("{path}.{key}");
                leaves(value, path.trim_start_matches('.'), see);
            }
        }
        Value::Array(items) if items.iter().all(Value::is_table) => {
            items.iter_mut().for_each(|item| leaves(item, path, see));
        }
        value => see(path, value),
    }
}

/// Other values of the same kind.
fn others(value: &Value) -> Vec<Value> {
    let scaled = |by: f64| match value {
        Value::Integer(integer) => Value::Float(*integer as f64 * by),
        Value::Float(float) => Value::Float(float * by),
        Value::String(text) => {
            let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
            let number: f64 = number.parse().unwrap_or_default();
            Value::String(format!("{} {unit}", by * number))
        }
        other => other.clone(),
    };
    let mut others: Vec<Value> = [1.01, 0.99].map(scaled).into();
    match value {
        Value::Integer(integer) => others.extend([1, -1].map(|by| Value::Integer(integer + by))),
        Value::Boolean(boolean) => others.push(Value::Boolean(!boolean)),
        Value::String(text) => {
            let words = keys::words().into_iter().chain(["rubber"]);
            others.extend(words.map(Value::from));
            others.push(Value::String(format!("{text} and more")));
        }
        Value::Array(items) => {
            for place in 0..items.len() {
                let replace = |other| {
                    let mut items = items.clone();
                    items[place] = other;
                    Value::Array(items)
                };
                others.extend(self::others(&items[place]).into_iter().map(replace));
            }
        }
        _ => {}
    }
    others
}

/// Adds the paths of a file whose value, when changed, changes the resolved file; of those that were not seen yet.
fn see_changes(kind: FileKind, text: &str, seen: &mut BTreeSet<String>) {
    let before = resolved(kind, text).unwrap();
    let mut whole: Value = Value::Table(text.parse().unwrap());
    let mut candidates: Vec<(String, usize, Vec<Value>)> = Vec::new();
    leaves(&mut whole, "", &mut |path, value| {
        candidates.push((path.to_owned(), candidates.len(), others(value)));
    });
    candidates.retain(|(path, ..)| !seen.contains(path));
    for (path, place, others) in candidates {
        let changes = others.into_iter().any(|other| {
            let (mut changed, mut at) = (whole.clone(), 0);
            leaves(&mut changed, "", &mut |_, value| {
                if at == place {
                    *value = other.clone();
                }
                at += 1;
            });
            let Ok(after) = resolved(kind, &toml::to_string(&changed).unwrap()) else {
                return false;
            };
            let of_figures = path.starts_with("figures.");
            let is_same = identity(&after) == identity(&before);
            assert!(is_same || !of_figures, "{path}");
            after != before && (of_figures || !is_same)
        });
        if changes {
            seen.insert(path);
        }
    }
}

#[test]
fn every_key_validates_changes_the_resolved_file_and_comes_back_from_it() {
    let mut seen: BTreeSet<String> = APART.map(str::to_owned).into();
    for (kind, text) in files() {
        assert_eq!(problems(kind, &text), "", "{text}");
        let first = resolved(kind, &text).unwrap_or_else(|why| panic!("{text}{why}"));
        assert_eq!(problems(kind, &first), "", "{first}");
        assert_eq!(resolved(kind, &first).as_ref(), Ok(&first));
        see_changes(kind, &text, &mut seen);
    }
    let known = [FileKind::Sweep, FileKind::Scenario]
        .map(keys::paths)
        .concat();
    let missed: Vec<&String> = known.iter().filter(|path| !seen.contains(*path)).collect();
    assert!(missed.is_empty(), "{missed:?}");
}
