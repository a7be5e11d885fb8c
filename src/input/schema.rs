//! JSON Schemas (2020-12) of the input files, for editors and validators.

use std::collections::{HashMap, HashSet};

use serde_json::{Map, Value as Json, json};

use super::axis::AxisOf;
use super::document::kind::text_definitions;
use super::document::schema;
use super::keys::FileKind;
use super::keys::drive::LISTED;
use crate::quantity::key::Kind;

/// The schema of a kind of input file, as the text of a file.
pub fn text(kind: FileKind) -> String {
    let mut schema = schema::of_table(kind.rows());
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(kind.rows().means.trim());
    if kind == FileKind::Sweep {
        may_be_listed(&mut schema);
    }
    let mut parts = Map::new();
    kind.rows().visit("", &mut |_, key| {
        if let Kind::Axes(axes) = &key.kind {
            parts.extend(AxisOf(axes).definitions());
        }
    });
    let referring = format!("{schema}{}", Json::Object(parts.clone()));
    let is_used = |name: &str| referring.contains(&format!("#/$defs/{name}\""));
    let definitions = text_definitions().into_iter();
    let used = definitions.filter(|(name, _)| is_used(name));
    parts.extend(used);
    schema["$defs"] = Json::Object(parts);
    define_longer_parts(&mut schema);
    format!("{schema:#}\n")
}

/// Makes definitions of the longer parts of a schema, beside those that it has.
fn define_longer_parts(schema: &mut Json) {
    let mut definitions = Definitions::of(schema);
    definitions.take_out_of(schema);
    if let Some(Json::Object(known)) = schema.get_mut("$defs") {
        known.extend(definitions.made);
    }
}

/// Blocks that a list in `[sweep]` may take the place of are needed where there is none.
fn may_be_listed(schema: &mut Json) {
    if let Some(Json::Array(required)) = schema.get_mut("required") {
        required.retain(|key| !LISTED.iter().any(|block| key == block));
    }
    let either = LISTED.map(|block| {
        let list = json!({ "properties": { block: { "type": "array" } }, "required": [block] });
        let listed = json!({ "properties": { "sweep": list } });
        json!({ "anyOf": [{ "required": [block] }, listed] })
    });
    schema["allOf"] = json!(either);
}

/// A reference is no shorter than what has fewer characters.
const SHORT: usize = 150;

/// The longer parts of a schema, as definitions. Each is called by the path of keys that leads to it and by the words that decide
/// for it, `indenter-cone` or `material-relaxation-branches`, so that what is added beside it changes nothing of it. A part that
/// stands in several places has the name of the shortest path.
struct Definitions {
    /// Names, by the text of what they stand for.
    names: HashMap<String, String>,
    made: Map<String, Json>,
}

impl Definitions {
    /// Names every longer part of a schema.
    fn of(schema: &mut Json) -> Self {
        let mut places = Places::default();
        places.find(schema, &Place::default());
        // A stable sort: of equal depth the first that was met comes first.
        places.found.sort_by_key(|(_, place)| place.depth);
        let (mut names, mut taken) = (HashMap::new(), HashSet::new());
        for (text, place) in places.found {
            let numbered = (2..).map(|k| format!("{}-{k}", place.whole_name));
            let wanted = [place.name, place.whole_name.clone()].into_iter();
            let free = |name: &String| taken.insert(name.clone());
            let name = wanted.chain(numbered).find(free);
            names.insert(text, name.unwrap_or_default());
        }
        let made = Map::new();
        Self { names, made }
    }

    /// Puts references in the place of what is named within.
    fn take_out_of(&mut self, schema: &mut Json) {
        inner(schema, &Place::default(), &mut |_, schema| {
            let Some(name) = self.names.get(&schema.to_string()).cloned() else {
                return self.take_out_of(schema);
            };
            if !self.made.contains_key(&name) {
                let mut definition = schema.clone();
                self.take_out_of(&mut definition);
                self.made.insert(name.clone(), definition);
            }
            *schema = json!({ "$ref": format!("#/$defs/{name}") });
        });
    }
}

/// The longer parts of a schema, each at the first of its places.
#[derive(Default)]
struct Places {
    found: Vec<(String, Place)>,
    /// Where among them a text is.
    of_text: HashMap<String, usize>,
}

impl Places {
    fn find(&mut self, schema: &mut Json, place: &Place) {
        inner(schema, place, &mut |place, schema| {
            let text = schema.to_string();
            if text.len() >= SHORT {
                let new = self.found.len();
                let known = *self.of_text.entry(text.clone()).or_insert(new);
                match self.found.get_mut(known) {
                    None => self.found.push((text, place.clone())),
                    Some((_, first)) if place.depth < first.depth => *first = place.clone(),
                    Some(_) => {}
                }
            }
            self.find(schema, &place);
        });
    }
}

/// Where a part of a schema stands.
#[derive(Debug, Clone, Default)]
struct Place {
    depth: usize,
    /// Keys and deciding words on the way to it, from which the names of what it holds go on.
    path: String,
    name: String,
    /// The name where another part has the first already: with all keys that tell the table from others in its place.
    whole_name: String,
    /// Of a way to fill a table: the path of that table, and its keys that are the same whatever the way.
    table: String,
    common: Vec<String>,
}

impl Place {
    /// What stands under a key.
    fn below(&self, key: &str) -> Self {
        let is_common = self.common.iter().any(|common| common == key);
        let path = joined(if is_common { &self.table } else { &self.path }, key);
        Self {
            depth: self.depth + 1,
            name: path.clone(),
            whole_name: joined(&self.whole_name, key),
            path,
            ..Self::default()
        }
    }

    /// An item of it, or one of the values that it may be; `path` is what the names of the keys below have of this.
    fn part(&self, path: &str, name: &str) -> Self {
        Self {
            depth: self.depth + 1,
            path: joined(&self.path, path),
            name: joined(&self.path, name),
            whole_name: joined(&self.whole_name, name),
            ..Self::default()
        }
    }
}

fn joined(path: &str, name: &str) -> String {
    let parts = [path, name].into_iter().filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("-")
}

/// Shows the schemas that a schema is made of, each with its place.
fn inner(schema: &mut Json, place: &Place, see: &mut dyn FnMut(Place, &mut Json)) {
    let Json::Object(parts) = schema else {
        return;
    };
    for (word, part) in parts {
        match (word.as_str(), part) {
            ("properties" | "patternProperties", Json::Object(of_keys)) => {
                let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                for (key, schema) in of_keys {
                    let is_pattern = !key.chars().all(is_word);
                    see(place.below(if is_pattern { "any" } else { key }), schema);
                }
            }
            ("$defs", Json::Object(definitions)) => {
                for (name, definition) in definitions {
                    inner(definition, &Place::default().below(name), see);
                }
            }
            ("oneOf", Json::Array(ways)) => {
                let places = ways_of(ways, place);
                places
                    .into_iter()
                    .zip(ways)
                    .for_each(|(p, way)| see(p, way));
            }
            ("anyOf", Json::Array(values)) => {
                for value in values {
                    let (path, name) = value_name(value);
                    see(place.part(&path, &name), value);
                }
            }
            ("items", item @ Json::Object(_)) => see(place.part("", "item"), item),
            _ => {}
        }
    }
}

/// The places of the ways to fill a table.
fn ways_of(ways: &[Json], table: &Place) -> Vec<Place> {
    let names: Vec<(String, String)> = ways.iter().map(deciding).collect();
    let first = ways.first().and_then(|way| way["properties"].as_object());
    let is_common = |(key, schema): &(&String, &Json)| {
        let mut others = ways.iter();
        others.all(|way| way["properties"].get(key.as_str()) == Some(schema))
    };
    let common = first.into_iter().flatten().filter(is_common);
    let common: Vec<String> = common.map(|(key, _)| key.clone()).collect();
    let place_of = |(word, keys): &(String, String)| {
        let is_alone = names.iter().filter(|(other, _)| other == word).count() == 1;
        let name = match is_alone && !word.is_empty() {
            true => word.clone(),
            false => joined(word, keys),
        };
        Place {
            table: table.path.clone(),
            common: common.clone(),
            ..table.part(word, &name)
        }
    };
    names.iter().map(place_of).collect()
}

/// The words that decide for a way to fill a table, and the other keys that it must have.
fn deciding(way: &Json) -> (String, String) {
    let required = way["required"].as_array().into_iter().flatten();
    let required = required.filter_map(Json::as_str);
    let word = |key: &str| way["properties"][key]["const"].as_str();
    let keys: Vec<&str> = required.clone().filter(|key| word(key).is_none()).collect();
    let words: Vec<&str> = required.filter_map(word).collect();
    (words.join("-"), keys.join("-"))
}

/// What one of several values is called, in the names of what it holds and in its own: of a quantity in one of several dimensions the
/// dimension, of anything else its type.
fn value_name(value: &Json) -> (String, String) {
    if let Some(kind) = value["type"].as_str() {
        return (String::new(), kind.to_owned());
    }
    let text = value.to_string();
    let name = text
        .split_once("#/$defs/text-")
        .and_then(|(_, rest)| rest.split_once('"'));
    let name = name.map_or("other", |(name, _)| name).to_owned();
    (name.clone(), name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Dimension::Length;
    use crate::quantity::key::quantity;
    use crate::quantity::rows::{List, Others, Rows, table};
    use contact_dma_core::keys;

    keys! {
        /// Which of the shapes it is; what every one of them needs is listed below, under its name.
        FIGURE = "shape", Kind::Word(&["disc", "ring", "square"]);
        /// The radius of the disc, or the one at the outer edge of the ring, which is the larger of its two.
        OUTER = "outer", Kind::Number(quantity(Length).above_zero());
        /// The radius at the inner edge of the ring, which is the smaller of its two, and may be as small as nothing.
        INNER = "inner", Kind::Number(quantity(Length).not_negative());
        /// The length of one side of the square, which is that of the others as well, since they are all alike.
        SIDE = "side", Kind::Number(quantity(Length).above_zero());
    }

    const KEYS: List = &[&[FIGURE]];
    static DISC: Rows = table(" A disc.", &[&[OUTER]]);
    static RING: Rows = table(" A ring.", &[&[OUTER, INNER]]);
    static SQUARE: Rows = table(" A square.", &[&[SIDE]]);
    static TWO: Rows = Rows {
        means: " Two shapes.",
        keys: KEYS,
        others: Others::ByWord(&FIGURE, &[("disc", &DISC), ("square", &SQUARE)]),
    };
    static THREE: Rows = Rows {
        means: " Three shapes.",
        keys: KEYS,
        others: Others::ByWord(
            &FIGURE,
            &[("disc", &DISC), ("ring", &RING), ("square", &SQUARE)],
        ),
    };

    /// The lines of the schema of a table under the key `body`.
    fn lines(rows: &Rows) -> Vec<String> {
        let body = json!({ "properties": { "body": schema::of_table(rows) } });
        let mut schema = json!({ "properties": body["properties"], "$defs": {} });
        define_longer_parts(&mut schema);
        let text = format!("{schema:#}");
        text.lines()
            .map(|line| line.trim_end_matches(',').to_owned())
            .collect()
    }

    #[test]
    fn a_shape_in_the_middle_changes_no_line_of_the_others() {
        let (two, three) = (lines(&TWO), lines(&THREE));
        let mut added = three.iter();
        for line in &two {
            assert!(added.any(|other| other == line), "{line}");
        }
        for name in ["body", "body-disc", "body-square", "body-disc-outer"] {
            let name = format!("    \"{name}\": {{");
            assert!(two.contains(&name), "{name}");
        }
        assert!(three.contains(&"    \"body-ring\": {".to_owned()));
    }

    #[test]
    fn no_part_is_called_by_a_number() {
        for (file, kind) in FileKind::NAMES {
            let schema: Json = serde_json::from_str(&text(*kind)).unwrap();
            let names = schema["$defs"].as_object().unwrap().keys();
            // The limits of numbers are in the names of axes.
            for name in names.filter(|name| !name.starts_with("over-")) {
                let last = name.rsplit('-').next().unwrap();
                assert!(last.parse::<usize>().is_err(), "{file}: {name}");
            }
        }
    }
}
