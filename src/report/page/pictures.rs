//! Pictures on their way to their files, kept for the page: each is drawn once.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

use maud::{Markup, PreEscaped, html};

use crate::report::chart::{ChartError, Drawing};

/// The pictures of a result by name, as elements of a page.
#[derive(Debug, Default)]
pub struct Pictures {
    sweep_hash: Option<String>,
    by_name: Mutex<BTreeMap<String, String>>,
    not_drawn: Mutex<BTreeMap<String, String>>,
    missing_letters: Mutex<BTreeSet<char>>,
}

impl Pictures {
    /// Pictures that say which sweep they show.
    pub fn of_sweep(hash: &str) -> Self {
        Self {
            sweep_hash: Some(hash.to_owned()),
            ..Self::default()
        }
    }

    /// For figures of these names, a mark in the place of each picture, which [`Pictures::placed`] replaces.
    pub(in crate::report) fn marks<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let names = names.into_iter();
        Self {
            by_name: Mutex::new(names.map(|name| (name.to_owned(), mark(name))).collect()),
            ..Self::default()
        }
    }

    /// A page with pictures in the places of their marks; why there is none stands in the place of one that could not be drawn.
    pub(in crate::report) fn placed(&self, page: &str, names: &[&str]) -> String {
        let reasons = self
            .not_drawn
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let picture = |name: &str| {
            let reason = || html! { p { (reasons.get(name).map_or("", String::as_str)) } };
            self.inline(name).unwrap_or_else(reason).into_string()
        };
        let placed = |page: String, name: &&str| page.replace(&mark(name), &picture(name));
        names.iter().fold(page.to_owned(), placed)
    }

    pub(in crate::report) fn sweep_hash(&self) -> Option<&str> {
        self.sweep_hash.as_deref()
    }

    /// Keeps a picture under this name.
    pub fn insert(&self, name: &str, drawing: &Drawing) {
        let mut pictures = self.by_name.lock().unwrap_or_else(PoisonError::into_inner);
        pictures.insert(name.to_owned(), drawing.to_page_element());
        let missing = drawing.missing_letters();
        let letters = self.missing_letters.lock();
        letters
            .unwrap_or_else(PoisonError::into_inner)
            .extend(missing);
    }

    /// Keeps why a picture could not be drawn.
    pub fn insert_failure(&self, name: &str, error: &ChartError) {
        let mut reasons = self
            .not_drawn
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        reasons.insert(name.to_owned(), format!("no figure {name}: {error}"));
    }

    /// Why pictures could not be drawn, a sentence each, in the order of their names; and which letters are missing in those that were.
    pub fn not_drawn(&self) -> Vec<String> {
        let reasons = self
            .not_drawn
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let letters = self.missing_letters.lock();
        let letters = letters.unwrap_or_else(PoisonError::into_inner);
        let missing = (!letters.is_empty()).then(|| {
            let letters: Vec<String> = letters.iter().map(char::to_string).collect();
            let letters = letters.join(" ");
            format!("the typeface of the figures does not have {letters}: boxes are drawn in their place")
        });
        reasons.values().cloned().chain(missing).collect()
    }

    /// The picture of this name as a part of a page.
    pub fn inline(&self, name: &str) -> Option<Markup> {
        let pictures = self.by_name.lock().unwrap_or_else(PoisonError::into_inner);
        pictures.get(name).cloned().map(PreEscaped)
    }
}

/// The place of a picture: a comment, as which nothing that a page says can stand there, since it is escaped.
fn mark(name: &str) -> String {
    format!("<!-- picture {name} -->")
}
