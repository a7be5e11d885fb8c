//! What every page has around its own sections: head, title, style, how to cite, the input, data, script.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::html::data_link;

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

/// Nothing may be loaded from anywhere.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

impl Frame<'_> {
    /// The page.
    pub fn page(&self) -> String {
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
                            ". This page needs no network: everything it shows is inside it."
                        }
                    }
                    script type="application/json" id="data" { (PreEscaped(&self.data)) }
                    script { (PreEscaped(script)) }
                }
            }
        };
        page.into_string()
    }
}

impl Input<'_> {
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
                    @if let [file] = &self.files[..] {
                        p { (text) " " (file.link(Some("download-input"))) }
                        pre id="input" tabindex="0" aria-labelledby="file-heading" {
                            code { (file.text) }
                        }
                    } @else {
                        p { (text) }
                        @for file in &self.files { (file.folded()) }
                    }
                }
            }
        }
    }
}

impl InputFile<'_> {
    fn link(&self, id: Option<&str>) -> Markup {
        let link = data_link("text/plain", self.text);
        html! {
            a id=[id] download=(self.name) href=(link) { "Download " (self.name) }
        }
    }

    /// One of several: opened by its reader.
    fn folded(&self) -> Markup {
        html! {
            details {
                summary { (self.name) }
                p { (self.link(None)) }
                pre tabindex="0" aria-label=(self.name) { code { (self.text) } }
            }
        }
    }
}
