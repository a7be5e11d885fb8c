//! Lists of values of one kind.

use std::collections::HashMap;

use serde_json::{Value as Json, json};

use super::{Asked, Spot};
use crate::input::diagnostic::{Diagnostics, Problems};
use crate::input::document::tree::{Node, Value as Toml};
use crate::quantity::block::Field as _;
use crate::quantity::key::{Entries, Kind};
use crate::quantity::setting::Value;

/// The list, or everything that is wrong with it; a single value is a list of one.
pub(super) fn read(list: &Asked<'_>, item: &Kind, entries: &Entries) -> Result<Value, Diagnostics> {
    let (found, mut values) = (Problems::new(), Vec::new());
    let Asked { node, spot, .. } = *list;
    match &node.value {
        Toml::Array(items) => {
            for (index, node) in items.iter().enumerate() {
                let path = format!("{}[{index}]", spot.path);
                let (path, key) = (path.as_str(), None);
                let spot = &Spot { path, key };
                let kind = item;
                match (Asked { kind, node, spot }).read() {
                    Ok(value) => values.push((value, node)),
                    Err(diagnostics) => found.extend(diagnostics),
                }
            }
        }
        Toml::Text(_) | Toml::Integer(_) | Toml::Float(_) => {
            let only = Asked {
                kind: item,
                ..*list
            };
            values.push((only.read()?, node));
        }
        _ => return Err(list.refused()),
    }
    if found.is_empty() {
        check(list, entries, &values, &found);
    }
    let values = values.into_iter().map(|(value, _)| value);
    found.into_result(Some(match item {
        Kind::Number(number) => {
            let numbers = values.filter_map(|value| value.number()).collect();
            match number.dimension {
                Some(dimension) => Value::Quantities(numbers, dimension),
                None => Value::Numbers(numbers),
            }
        }
        _ => Value::Texts(values.filter_map(String::of).collect()),
    }))
}

fn check(list: &Asked<'_>, entries: &Entries, values: &[(Value, &Node)], found: &Problems) {
    let path = list.spot.path;
    let (least, most) = (*entries.number.start(), *entries.number.end());
    if !entries.number.contains(&values.len()) {
        let allowed = match (least, most) {
            (least, usize::MAX) => format!("at least {least}"),
            (least, most) if least == most => format!("exactly {most}"),
            (0, most) => format!("at most {most}"),
            (least, most) => format!("{least} to {most}"),
        };
        let has = match values.len() {
            1 => "1 entry".to_owned(),
            count => format!("{count} entries"),
        };
        let message = format!("`{path}` has {has}, where {allowed} are allowed");
        let problem = found.at(&list.node.location, message);
        if !entries.instead.is_empty() {
            problem.help(entries.instead);
        }
    }
    if entries.repeats {
        return;
    }
    let mut known: HashMap<String, &Node> = HashMap::new();
    for (index, (value, node)) in values.iter().enumerate() {
        if let Some(other) = known.insert(value.toml(), node) {
            let message = format!("`{path}[{index}]` is listed twice");
            found
                .at(&node.location, message)
                .label(&other.location, "the other one")
                .help("write every entry once");
        }
    }
}

pub(super) fn schema(item: &Json, entries: &Entries) -> Json {
    let mut array = json!({ "type": "array", "items": item });
    array["minItems"] = json!(entries.number.start());
    if *entries.number.end() < usize::MAX {
        array["maxItems"] = json!(entries.number.end());
    }
    if !entries.repeats {
        array["uniqueItems"] = json!(true);
    }
    match entries.number.contains(&1) {
        true => json!({ "anyOf": [array, item] }),
        false => array,
    }
}
