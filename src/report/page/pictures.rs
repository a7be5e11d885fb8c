//! Pictures on their way to their files, kept for the page: each is drawn once.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::drawing::inline_figure;

/// The SVG that went by.
#[derive(Debug, Default)]
pub struct Pictures {
    by_name: Mutex<BTreeMap<String, String>>,
}

impl Pictures {
    /// Keeps a file that is being written, where it is an SVG.
    pub fn see(&self, file: &str, bytes: &[u8]) {
        if let (Some(name), Ok(svg)) = (file.strip_suffix(".svg"), std::str::from_utf8(bytes)) {
            let mut pictures = self.by_name.lock().unwrap_or_else(PoisonError::into_inner);
            pictures.insert(name.to_owned(), svg.to_owned());
        }
    }

    /// The picture of this name as a part of a page.
    pub fn inline(&self, name: &str) -> Option<String> {
        let pictures = self.by_name.lock().unwrap_or_else(PoisonError::into_inner);
        pictures.get(name).map(|svg| inline_figure(svg, name))
    }
}
