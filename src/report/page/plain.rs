//! What pages have in common on which nothing moves: the figures are the same with a script and without.

use maud::{Markup, html};
use serde::Serialize;

use super::Pictures;
use crate::report::caption::Setting;
use crate::report::figure::Figure;

/// The script of such a page.
pub(super) const SCRIPT: &str = "function start() {}\n";

/// What the script knows.
#[derive(Serialize)]
pub(super) struct Data {
    pub(super) kind: &'static str,
}

/// A figure with its caption.
pub(super) fn shown(figure: &Figure, pictures: &Pictures) -> Markup {
    html! {
        @if let Some(picture) = pictures.inline(figure.name) {
            figure {
                (picture)
                figcaption { (figure.caption.text(&Setting::default())) }
            }
        }
    }
}
