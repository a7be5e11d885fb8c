//! JSON Schemas (2020-12) of the input files, for editors and validators.

use std::collections::HashMap;

use serde_json::{Map, Value as Json, json};

use super::axis::AxisOf;
use super::document::kind::text_definitions;
use super::keys::FileKind;
use super::keys::drive::LISTED;

/// The schema of a kind of input file, as the text of a file.
pub fn text(kind: FileKind) -> String {
    let mut schema = kind.rows().schema();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(kind.rows().means.trim());
    if kind == FileKind::Sweep {
        may_be_listed(&mut schema);
    }
    let mut parts = Map::new();
    kind.rows().visit("", &mut |_, row| {
        parts.extend(row.kind().axes().into_iter().flat_map(AxisOf::definitions));
    });
    let referring = format!("{schema}{}", Json::Object(parts.clone()));
    let is_used = |name: &str| referring.contains(&format!("#/$defs/{name}\""));
    let definitions = text_definitions().into_iter();
    let used = definitions.filter(|(name, _)| is_used(name));
    parts.extend(used);
    schema["$defs"] = Json::Object(parts);
    let mut repeated = Repeated::default();
    repeated.count(&mut schema);
    repeated.take_out_of(&mut schema);
    if let Some(Json::Object(definitions)) = schema.get_mut("$defs") {
        definitions.extend(repeated.definitions);
    }
    format!("{schema:#}\n")
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

/// What stands in several places of a schema, and becomes a definition.
#[derive(Default)]
struct Repeated {
    counts: HashMap<String, usize>,
    /// Names, by the text of what they stand for.
    names: HashMap<String, String>,
    definitions: Map<String, Json>,
}

/// A reference is no shorter than what has fewer characters.
const SHORT: usize = 150;

impl Repeated {
    fn count(&mut self, schema: &mut Json) {
        inner(schema, &mut |_, schema| {
            *self.counts.entry(schema.to_string()).or_default() += 1;
            self.count(schema);
        });
    }

    /// Puts references in the place of what is repeated within.
    fn take_out_of(&mut self, schema: &mut Json) {
        inner(schema, &mut |hint, schema| {
            let text = schema.to_string();
            if text.len() < SHORT || self.counts.get(&text).is_none_or(|count| *count < 2) {
                return self.take_out_of(schema);
            }
            let name = match self.names.get(&text) {
                Some(name) => name.clone(),
                None => {
                    let name = self.free_name(hint);
                    self.names.insert(text, name.clone());
                    let mut definition = schema.clone();
                    self.take_out_of(&mut definition);
                    self.definitions.insert(name.clone(), definition);
                    name
                }
            };
            *schema = json!({ "$ref": format!("#/$defs/{name}") });
        });
    }

    /// `key-radius`, `key-radius-2` where that is something else already.
    fn free_name(&self, hint: &str) -> String {
        let numbered = |k: usize| match k {
            1 => format!("key-{hint}"),
            k => format!("key-{hint}-{k}"),
        };
        let taken = |name: &String| self.names.values().any(|other| other == name);
        let mut names = (1..).map(numbered);
        names.find(|name| !taken(name)).unwrap_or_default()
    }
}

/// Shows the schemas that a schema is made of, each with the key that it is of.
fn inner(schema: &mut Json, see: &mut dyn FnMut(&str, &mut Json)) {
    let Json::Object(parts) = schema else {
        return;
    };
    for (word, part) in parts {
        match (word.as_str(), part) {
            ("properties" | "patternProperties" | "$defs", Json::Object(of_keys)) => {
                for (key, schema) in of_keys {
                    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                    let hint = if key.chars().all(is_word) {
                        key
                    } else {
                        "several"
                    };
                    see(hint, schema);
                }
            }
            ("oneOf" | "anyOf", Json::Array(ways)) => {
                ways.iter_mut().for_each(|way| see("way", way))
            }
            ("items", item @ Json::Object(_)) => see("item", item),
            _ => {}
        }
    }
}
