//! What every page has around its own sections: head, title, style, how to cite, the input, data, script.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde::Serialize;

use super::html::{data_link, json_for_script};
use crate::report::ReportError;

const VERSION: &str = env!("CARGO_PKG_VERSION");
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
    /// The page's own sections; the first has a heading with the id `answer`.
    pub main: Markup,
    pub input: Input<'a>,
    /// What the page's script needs besides the common part; the last defines `start(data)`.
    pub script: &'a [&'a str],
}

/// What the results came from.
pub struct Input<'a> {
    /// Hashes, and what each stands for: "exactly this input".
    pub hashes: Vec<(&'a str, String)>,
    /// Names and texts of the files as they can be run again: at least one, or there is no section for them.
    pub files: Vec<(&'a str, &'a str)>,
    /// What to do with them, as HTML.
    pub text: &'a str,
}

/// Nothing may be loaded but pictures that are beside the page.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src 'self' file: data:";

impl Frame<'_> {
    /// The page, with what its script knows.
    ///
    /// # Errors
    /// [`ReportError::Table`] where the data are no JSON.
    pub fn page(&self, data: &impl Serialize) -> Result<String, ReportError> {
        let data = json_for_script(data)?;
        let script = [&[CORE], self.script, &[BEGIN]].concat().concat();
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    title { (self.title) }
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta http-equiv="Content-Security-Policy" content=(POLICY);
                    meta name="generator" content={ "contact-dma " (VERSION) };
                    link rel="icon" href="data:,";
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    a class="skip" href="#answer" { "Skip to the result" }
                    header {
                        div {
                            h1 { (self.title) }
                            p class="asked" { (self.asked) }
                        }
                        button id="theme" type="button" class="live" aria-pressed="false" { "Dark" }
                    }
                    main { (self.main) (self.input.cite()) (self.input.section()) }
                    footer {
                        p {
                            "Made by contact-dma " (VERSION)
                            ". This page needs no network; sent without its folder, it lacks the figures that are files of it."
                        }
                    }
                    script type="application/json" id="data" { (PreEscaped(data)) }
                    script { (PreEscaped(script)) }
                }
            }
        };
        Ok(page.into_string())
    }
}

impl<'a> Input<'a> {
    /// One file, and the hash of what is in it under a name.
    pub fn of_file(
        (what, hash): (&'a str, String),
        file: (&'a str, &'a str),
        about: &'a str,
    ) -> Self {
        Self {
            hashes: vec![(what, hash)],
            files: vec![file],
            text: about,
        }
    }

    fn cite(&self) -> Markup {
        html! {
            section aria-labelledby="cite-heading" {
                h2 id="cite-heading" { "How to cite" }
                p {
                    "S. Spinu, " cite { "Viscoelastic Contact Simulation under Harmonic Cyclic Load" }
                    ", Advances in Tribology 2018, 9432894, "
                    a href="https://doi.org/10.1155/2018/9432894" { "doi:10.1155/2018/9432894" }
                    ", for the method; contact-dma, version " (VERSION) ", for the program"
                    @for (what, hash) in &self.hashes {
                        ", and the hash " code class="hash" { (hash) } " for " (what)
                    }
                    "."
                }
            }
        }
    }

    fn section(&self) -> Markup {
        let text = PreEscaped(self.text);
        html! {
            @if !self.files.is_empty() {
                section aria-labelledby="file-heading" {
                    h2 id="file-heading" { "The input, to run again" }
                    @if let [(name, file)] = &self.files[..] {
                        p { (text) " " (link(name, file, Some("download-input"))) }
                        pre id="input" tabindex="0" aria-labelledby="file-heading" { code { (file) } }
                    } @else {
                        p { (text) }
                        @for (name, file) in &self.files {
                            details {
                                summary { (name) }
                                p { (link(name, file, None)) }
                                pre tabindex="0" aria-label=(name) { code { (file) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn link(name: &str, text: &str, id: Option<&str>) -> Markup {
    let link = data_link("text/plain", text);
    html! { a id=[id] download=(name) href=(link) { "Download " (name) } }
}
