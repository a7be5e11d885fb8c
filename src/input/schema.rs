//! JSON Schemas (2020-12) of the input files, for editors and validators.

use serde_json::{Map, Value as Json, json};

use super::document::kind::text_definitions;
use super::keys::FileKind;

/// The schema of a kind of input file, as the text of a file.
pub fn text(kind: FileKind) -> String {
    let mut schema = kind.rows().schema();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(kind.rows().means.trim());
    let referring = schema.to_string();
    let is_used = |name: &str| referring.contains(&format!("#/$defs/{name}\""));
    let definitions = text_definitions().into_iter();
    let used: Map<String, Json> = definitions.filter(|(name, _)| is_used(name)).collect();
    schema["$defs"] = Json::Object(used);
    format!("{schema:#}\n")
}
