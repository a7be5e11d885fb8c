//! The JSON Schema of a table, and the macros by which keys are declared.

use serde_json::{Value as Json, json};

use super::kind::{Describe, json_of};
use crate::input::axis::AxisOf;
use crate::quantity::key::{Key, Kind};
use crate::quantity::rows::{Others, Rows};

/// The JSON Schema of a table.
pub(crate) fn schema(rows: &Rows) -> Json {
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
            let axes = AxisOf::new(axes);
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

/// Keys as constants, their meaning being their documentation. A key that is not `optional` must be there, or has what stands behind
/// `or`.
macro_rules! keys {
    ($( $(#[doc = $means:literal])+ $name:ident = $key:literal, $kind:expr $(, $presence:ident $($default:expr)?)?; )+) => {
        $(
            $(#[doc = $means])+
            pub(crate) const $name: $crate::quantity::key::Key = $crate::quantity::key::Key {
                name: $key,
                means: concat!($($means),+),
                kind: $kind,
                presence: $crate::input::document::row::keys!(@presence $kind $(, $presence $($default)?)?),
            };
        )+
    };
    (@presence $kind:expr) => { $crate::quantity::key::Presence::Required };
    (@presence $kind:expr, optional) => { $crate::quantity::key::Presence::Optional };
    (@presence $kind:expr, or $default:expr) => {
        $crate::quantity::key::Presence::Or(|| $crate::quantity::block::Field::written(&$default, &$kind))
    };
}
pub(in crate::input) use keys;

/// A key whose word decides which others its table has: the enum of its words, its key, and the keys that each word brings.
macro_rules! choice {
    ($(#[doc = $means:literal])+ $row:ident = $key:literal, $name:ident, $others:ident:
        $( $(#[doc = $about:literal])+ $variant:ident = $word:literal: $keys:expr $(, $ways:expr)?; )+) => {
        contact_dma_core::words! {
            $(#[doc = $means])+
            pub(crate) enum $name { $( $(#[doc = $about])+ $variant = $word ),+ }
        }
        $crate::input::document::row::keys! {
            $(#[doc = $means])+
            $row = $key, $crate::quantity::key::Kind::Word($name::WORDS);
        }
        const $others: $crate::quantity::rows::Others = $crate::quantity::rows::Others::ByWord(&$row, &[$(
            ($word, &$crate::quantity::rows::Rows {
                means: concat!($($about),+),
                keys: $keys,
                others: $crate::input::document::row::choice!(@ways $($ways)?),
            })
        ),+]);
    };
    (@ways) => { $crate::quantity::rows::Others::None };
    (@ways $ways:expr) => { $crate::quantity::rows::Others::OneList($ways) };
}
pub(in crate::input) use choice;
