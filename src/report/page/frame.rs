//! What every page has around its own sections: head, title, style, how to cite, the input, data, script.

use super::html::{data_link, escaped, filled};
use crate::report::ReportError;

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

/// Parts of the script, in the order in which they may use each other. `start(data)` is the page's own.
const CORE: &str = include_str!("core.js");
const BEGIN: &str = include_str!("start.js");
pub(super) const PLOT: &str = include_str!("plot.js");
pub(super) const HEAT: &str = include_str!("heat.js");
pub(super) const TABLE: &str = include_str!("table.js");
pub(super) const MODULI: &str = include_str!("moduli.js");

/// The parts of a page around its own.
pub struct Frame<'a> {
    pub title: &'a str,
    /// One line under the title.
    pub asked: String,
    /// HTML of the page's own sections; the first has a heading with the id `answer`.
    pub main: String,
    pub input: Input<'a>,
    /// JSON for the script, in which no `<` is left.
    pub data: String,
    /// What the page's script needs besides the common part; the last defines `start(data)`.
    pub script: &'a [&'a str],
}

/// What the results came from.
pub struct Input<'a> {
    /// Hashes, and what each stands for: "exactly this input".
    pub hashes: Vec<(&'a str, String)>,
    /// The files: at least one, or there is no section for them.
    pub files: Vec<InputFile<'a>>,
    /// What to do with them, as HTML.
    pub text: &'a str,
}

/// A file as it can be run again.
pub struct InputFile<'a> {
    pub name: &'a str,
    pub text: &'a str,
}

impl Frame<'_> {
    /// The page.
    ///
    /// # Errors
    /// [`ReportError::Table`] where a template has a place that nothing fills.
    pub fn page(&self) -> Result<String, ReportError> {
        let script = [&[CORE], self.script, &[BEGIN]].concat().concat();
        filled(
            PAGE,
            &[
                ("title", &escaped(self.title)),
                ("asked", &escaped(&self.asked)),
                ("main", &self.main),
                ("version", env!("CARGO_PKG_VERSION")),
                ("cited", &self.input.cited()),
                ("input", &self.input.section()),
                ("style", STYLE),
                ("data", &self.data),
                ("script", &script),
            ],
        )
    }
}

impl Input<'_> {
    fn cited(&self) -> String {
        let hashes = self.hashes.iter().map(|(what, hash)| {
            let hash = escaped(hash);
            format!(
                ", and the hash <code class=\"hash\">{hash}</code> for {}",
                escaped(what)
            )
        });
        hashes.collect()
    }

    fn section(&self) -> String {
        let files = match &self.files[..] {
            [] => return String::new(),
            [file] => format!(
                "<p>{} {}</p>\n<pre id=\"input\" tabindex=\"0\" aria-labelledby=\"file-heading\"><code>{}</code></pre>\n",
                self.text,
                file.link(" id=\"download-input\""),
                escaped(file.text)
            ),
            files => {
                let files: String = files.iter().map(InputFile::folded).collect();
                format!("<p>{}</p>\n{files}", self.text)
            }
        };
        format!(
            "<section aria-labelledby=\"file-heading\">\n<h2 id=\"file-heading\">The input, to run again</h2>\n{files}</section>\n"
        )
    }
}

impl InputFile<'_> {
    fn link(&self, attributes: &str) -> String {
        let name = escaped(self.name);
        format!(
            "<a{attributes} download=\"{name}\" href=\"{}\">Download {name}</a>",
            data_link("text/plain", self.text)
        )
    }

    /// One of several: opened by its reader.
    fn folded(&self) -> String {
        let name = escaped(self.name);
        format!(
            "<details>\n<summary>{name}</summary>\n<p>{}</p>\n<pre tabindex=\"0\" aria-label=\"{name}\"><code>{}</code></pre>\n\
             </details>\n",
            self.link(""),
            escaped(self.text)
        )
    }
}
