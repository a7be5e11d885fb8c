//! JSON Schemas (2020-12) of the input files, for editors and validators.

use serde_json::{Map, Value as Json, json};

use super::document::kind::text_definitions;
use super::keys::FileKind;

/// The schema of a kind of input file, as the text of a file.
pub fn text(kind: FileKind) -> String {
    let mut schema = kind.rows().schema();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(kind.rows().means.trim());
    let mut parts = Map::new();
    kind.rows()
        .visit("", &mut |_, row| parts.extend(row.kind().definitions()));
    let referring = format!("{schema}{}", Json::Object(parts.clone()));
    let is_used = |name: &str| referring.contains(&format!("#/$defs/{name}\""));
    let definitions = text_definitions().into_iter();
    let used = definitions.filter(|(name, _)| is_used(name));
    parts.extend(used);
    schema["$defs"] = Json::Object(parts);
    format!("{schema:#}\n")
}
