//! The JSON Schema of a table.

use serde_json::{Value as Json, json};

use super::kind::{Describe, json_of};
use crate::input::axis::AxisOf;
use crate::quantity::key::{Key, Kind};
use crate::quantity::rows::{Others, Rows};

/// The JSON Schema of a table.
pub(crate) fn of_table(rows: &Rows) -> Json {
    let branches = rows.branches();
    let mut schema = match branches.is_empty() {
        true => object(&rows.own(), &[]),
        false => {
            let all = branches.iter().map(|branch| {
                let mut keys = rows.own();
                keys.extend(&branch.keys);
                object(&keys, &branch.decided_by)
            });
            json!({ "oneOf": all.collect::<Vec<_>>() })
        }
    };
    if let Others::AtMostOne(keys) = rows.others {
        schema["not"] = json!({ "required": keys });
    }
    schema
}

fn object(keys: &[&Key], decided_by: &[(&str, Option<&str>)]) -> Json {
    let (mut properties, mut patterns) = (serde_json::Map::new(), serde_json::Map::new());
    let mut required: Vec<&str> = decided_by.iter().map(|(key, _)| *key).collect();
    for key in keys {
        let mut schema = key.kind.schema();
        schema["description"] = json!(key.means());
        if let Some(default) = key.default() {
            schema["default"] = json_of(&default);
        }
        if key.is_required() && !required.contains(&key.name) {
            required.push(key.name);
        }
        properties.insert(key.name.to_owned(), schema);
        if let Kind::Axes(axes) = &key.kind {
            let axes = AxisOf(axes);
            // In quotes they may be written in place of the table.
            let before = format!("{}.", key.name);
            properties.extend(axes.references(&before));
            patterns.extend(axes.patterns(&before));
        }
    }
    for (key, word) in decided_by {
        if let Some(word) = word {
            properties.insert((*key).to_owned(), json!({ "const": word }));
        }
    }
    let mut schema = json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    if !patterns.is_empty() {
        schema["patternProperties"] = json!(patterns);
    }
    schema
}
