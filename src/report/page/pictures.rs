//! Pictures on their way to their files, kept for the page: each is drawn once.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use maud::{Markup, PreEscaped};

use crate::report::chart::Drawing;

/// The pictures of a result by name, as elements of a page.
#[derive(Debug, Default)]
pub struct Pictures {
    sweep_hash: Option<String>,
    by_name: Mutex<BTreeMap<String, String>>,
}

impl Pictures {
    /// Pictures that say which sweep they show.
    pub fn of_sweep(hash: &str) -> Self {
        Self {
            sweep_hash: Some(hash.to_owned()),
            ..Self::default()
        }
    }

    pub(in crate::report) fn sweep_hash(&self) -> Option<&str> {
        self.sweep_hash.as_deref()
    }

    /// Keeps a picture under this name.
    pub fn insert(&self, name: &str, drawing: &Drawing) {
        let mut pictures = self.by_name.lock().unwrap_or_else(PoisonError::into_inner);
        pictures.insert(name.to_owned(), drawing.to_page_element());
    }

    /// The picture of this name as a part of a page.
    pub fn inline(&self, name: &str) -> Option<Markup> {
        let pictures = self.by_name.lock().unwrap_or_else(PoisonError::into_inner);
        pictures.get(name).cloned().map(PreEscaped)
    }
}
