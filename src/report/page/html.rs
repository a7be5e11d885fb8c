//! Text into HTML: escaping, templates, data for the script.

use serde::Serialize;

use crate::report::ReportError;

/// Text as it may stand between tags and within quoted attributes.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            _ => safe.push(c),
        }
    }
    safe
}

/// A template with each `{{name}}` replaced. What is put in is not looked at again.
///
/// # Errors
/// [`ReportError::Table`] where the template names what there is not.
pub fn filled(template: &str, values: &[(&str, &str)]) -> Result<String, ReportError> {
    let mut text = String::with_capacity(template.len());
    let mut parts = template.split("{{");
    text.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let found = part.split_once("}}").and_then(|(name, rest)| {
            let (_, value) = values.iter().find(|(key, _)| *key == name)?;
            Some((*value, rest))
        });
        let (value, rest) = found.ok_or_else(|| ReportError::Table {
            name: "index.html",
            reason: "its template has a place that nothing fills".to_owned(),
        })?;
        text.push_str(value);
        text.push_str(rest);
    }
    Ok(text)
}

/// Data as JSON that may stand within a script element: no `<` is left that could end it or begin a comment.
///
/// # Errors
/// [`ReportError::Table`] where the data are no JSON.
pub fn json_for_script(data: &impl Serialize) -> Result<String, ReportError> {
    let json = serde_json::to_string(data).map_err(|error| ReportError::Table {
        name: "index.html",
        reason: error.to_string(),
    })?;
    // Within JSON a `<` can stand in strings alone.
    Ok(json.replace('<', "\\u003c"))
}

/// A link that holds the text itself.
pub fn data_link(media_type: &str, text: &str) -> String {
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
    fn text_cannot_leave_its_place() {
        assert_eq!(escaped("<b a='\"'>&"), "&lt;b a=&#39;&quot;&#39;&gt;&amp;");
        let json = json_for_script(&"</script><!-- a").unwrap();
        assert_eq!(json, r#""\u003c/script>\u003c!-- a""#);
        let read: String = serde_json::from_str(&json).unwrap();
        assert_eq!(read, "</script><!-- a");
    }

    #[test]
    fn what_fills_a_template_is_not_filled_again() {
        let text = filled("{{a}} and {{b}}", &[("a", "{{b}}"), ("b", "2")]).unwrap();
        assert_eq!(text, "{{b}} and 2");
        assert!(filled("{{c}}", &[]).is_err());
        assert!(filled("{{c", &[("c", "1")]).is_err());
    }

    #[test]
    fn a_link_holds_every_byte() {
        assert_eq!(
            data_link("text/plain", "a\n\"é"),
            "data:text/plain;charset=utf-8,a%0A%22%C3%A9"
        );
    }
}
