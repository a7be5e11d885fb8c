//! What stands in a page and is no element: data for the script, links that hold a text.

use serde::Serialize;

use crate::report::ReportError;

/// Data as JSON that may stand within a script element: no `<` is left that could end it or begin a comment.
///
/// # Errors
/// [`ReportError::Table`] where the data are no JSON.
pub(super) fn json_for_script(data: &impl Serialize) -> Result<String, ReportError> {
    let json = serde_json::to_string(data).map_err(|error| ReportError::Table {
        name: "index.html",
        reason: error.to_string(),
    })?;
    // Within JSON a `<` can stand in strings alone.
    Ok(json.replace('<', "\\u003c"))
}

/// A link that holds the text itself.
pub(super) fn data_link(media_type: &str, text: &str) -> String {
    let mut link = format!("data:{media_type};charset=utf-8,");
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte) {
            link.push(char::from(byte));
        } else {
            link.push_str(&format!("%{byte:02X}"));
        }
    }
    link
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_cannot_leave_their_place() {
        let json = json_for_script(&"</script><!-- a").unwrap();
        assert_eq!(json, r#""\u003c/script>\u003c!-- a""#);
        let read: String = serde_json::from_str(&json).unwrap();
        assert_eq!(read, "</script><!-- a");
    }

    #[test]
    fn a_link_holds_every_byte() {
        assert_eq!(
            data_link("text/plain", "a\n\"é"),
            "data:text/plain;charset=utf-8,a%0A%22%C3%A9"
        );
    }
}
