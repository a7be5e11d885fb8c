//! Pictures on their way to their files, kept for the page: each is drawn once.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, MutexGuard, PoisonError};

use maud::{Markup, PreEscaped, html};

use crate::report::chart::{ChartError, Drawing};
use crate::report::figure::Figure;
use crate::sweep::store::files::{CAPTION, DATA, Place};

/// The pictures of a result by name, as elements of a page.
#[derive(Debug, Default)]
pub struct Pictures {
    sweep_hash: Option<String>,
    by_name: Mutex<BTreeMap<String, Shown>>,
    not_drawn: Mutex<BTreeMap<String, String>>,
    missing_letters: Mutex<BTreeSet<char>>,
    /// Whether marks stand in the places of pictures, until these are drawn.
    are_marks: bool,
}

/// What a page shows of a figure.
#[derive(Debug, Default)]
struct Shown {
    /// The picture; empty where there is none.
    element: String,
    /// Whether its file shows the same: on axes of other units it does not.
    differs_from_file: bool,
    caption: String,
    /// The endings of the files that were written.
    endings: BTreeSet<String>,
}

/// Bytes of the pictures that a page holds in its gallery where they have no file that it can show.
const MOST_INLINE: usize = 400_000;

/// Where a lock was poisoned, what was inserted is whole all the same.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
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
        let shown = |name: &str| Shown {
            element: mark("picture", name),
            ..Shown::default()
        };
        let names = names.into_iter();
        Self {
            by_name: Mutex::new(names.map(|name| (name.to_owned(), shown(name))).collect()),
            are_marks: true,
            ..Self::default()
        }
    }

    /// A page with pictures in the places of their marks; why there is none stands in the place of one that could not be drawn.
    pub(in crate::report) fn placed(&self, page: &str, names: &[&str]) -> String {
        let reasons = lock(&self.not_drawn);
        let mut room = MOST_INLINE;
        let mut page = page.to_owned();
        for name in names {
            let reason = || html! { p { (reasons.get(*name).map_or("", String::as_str)) } };
            let picture = || self.inline(name).unwrap_or_else(reason);
            // A picture is large: only what the page has a mark for is made.
            let mut put = |what: &str, made: &mut dyn FnMut() -> Markup| {
                let mark = mark(what, name);
                if page.contains(&mark) {
                    page = page.replace(&mark, &made().into_string());
                }
            };
            put("picture", &mut || picture());
            put("whole", &mut || self.captioned(name, picture()));
            for is_still in [true, false] {
                put(gallery_mark(is_still), &mut || {
                    self.item(name, is_still, &mut room)
                });
            }
        }
        page
    }

    pub(in crate::report) fn sweep_hash(&self) -> Option<&str> {
        self.sweep_hash.as_deref()
    }

    /// Keeps a picture under this name, with its caption.
    pub fn insert(&self, name: &str, caption: &str, drawing: &Drawing) {
        let mut pictures = lock(&self.by_name);
        let shown = pictures.entry(name.to_owned()).or_default();
        shown.element = drawing.to_page_element();
        caption.clone_into(&mut shown.caption);
        lock(&self.missing_letters).extend(drawing.missing_letters());
    }

    /// Has the page show another picture in the place of the one that is in the files.
    pub fn show_instead(&self, name: &str, drawing: &Drawing) {
        let mut pictures = lock(&self.by_name);
        let shown = pictures.entry(name.to_owned()).or_default();
        shown.element = drawing.to_page_element();
        shown.differs_from_file = true;
    }

    /// Takes note of a file of a figure.
    pub fn wrote(&self, name: &str, ending: &str) {
        let mut pictures = lock(&self.by_name);
        let shown = pictures.entry(name.to_owned()).or_default();
        shown.endings.insert(ending.to_owned());
    }

    /// Keeps why a picture could not be drawn.
    pub fn insert_failure(&self, name: &str, error: &ChartError) {
        lock(&self.not_drawn).insert(name.to_owned(), format!("no figure {name}: {error}"));
    }

    /// Why pictures could not be drawn, a sentence each, in the order of their names; and which letters are missing in those that were.
    pub fn not_drawn(&self) -> Vec<String> {
        let reasons = lock(&self.not_drawn);
        let letters = lock(&self.missing_letters);
        let missing = (!letters.is_empty()).then(|| {
            let letters: Vec<String> = letters.iter().map(char::to_string).collect();
            let letters = letters.join(" ");
            format!("the typeface of the figures does not have {letters}: boxes are drawn in their place")
        });
        reasons.values().cloned().chain(missing).collect()
    }

    /// The picture of this name as a part of a page.
    pub fn inline(&self, name: &str) -> Option<Markup> {
        let pictures = lock(&self.by_name);
        let element = pictures.get(name).map(|shown| shown.element.clone());
        element
            .filter(|element| !element.is_empty())
            .map(PreEscaped)
    }

    /// A figure that a reader without script sees in this place; with one, its place is in the gallery. `otherwise` is said where
    /// there is nothing to draw.
    pub(super) fn still(&self, name: &str, otherwise: &str) -> Markup {
        let is_moved = lock(&self.by_name)
            .get(name)
            .is_some_and(|shown| !shown.differs_from_file);
        html! {
            figure class="static" data-figure=[is_moved.then_some(name)] {
                @match self.inline(name) {
                    Some(figure) => (figure),
                    None => p { (otherwise) },
                }
            }
        }
    }

    /// Figures with their pictures in the page itself, captions and links to their files.
    pub(super) fn whole(&self, figures: &[Figure]) -> Markup {
        let whole = |name: &str| match self.are_marks {
            true => PreEscaped(mark("whole", name)),
            false => self.captioned(name, self.inline(name).unwrap_or_default()),
        };
        html! { div class="gallery" { @for figure in figures { (whole(&figure.name)) } } }
    }

    /// A picture with its caption and links to its files.
    fn captioned(&self, name: &str, picture: Markup) -> Markup {
        let caption = lock(&self.by_name)
            .get(name)
            .map(|shown| shown.caption.clone());
        html! {
            figure id={ "figure-" (name) } {
                (picture)
                figcaption { (caption.unwrap_or_default()) (self.files(name)) }
            }
        }
    }

    /// Every figure with its caption and links to its files: first those that stand in other places of the page as stills.
    pub(super) fn gallery(&self, stills: &[&str]) -> Markup {
        let drawn =
            |(name, shown): (&String, &Shown)| (!shown.element.is_empty()).then(|| name.clone());
        let names: Vec<String> = lock(&self.by_name).iter().filter_map(drawn).collect();
        let is_still = |name: &String| stills.contains(&name.as_str());
        let (mut first, rest): (Vec<String>, Vec<String>) = names.into_iter().partition(is_still);
        first.sort_by_key(|name| stills.iter().position(|still| still == name));
        let mut room = MOST_INLINE;
        html! {
            @if !first.is_empty() || !rest.is_empty() {
                section aria-labelledby="figures-heading" {
                    h2 id="figures-heading" { "Figures" }
                    div class="gallery" {
                        @for name in first.iter().chain(&rest) { (self.item(name, is_still(name), &mut room)) }
                    }
                }
            }
        }
    }

    /// One figure of the gallery; the script brings the picture of a still here.
    fn item(&self, name: &str, is_still: bool, room: &mut usize) -> Markup {
        if self.are_marks {
            return PreEscaped(mark(gallery_mark(is_still), name));
        }
        let pictures = lock(&self.by_name);
        let Some(shown) = pictures.get(name) else {
            return Markup::default();
        };
        let mut endings = [".svg", ".png"].into_iter();
        let file = endings.find(|ending| shown.endings.contains(*ending));
        let is_inline = file.is_none() && !shown.differs_from_file && shown.element.len() <= *room;
        let picture = match file {
            _ if is_still && !shown.differs_from_file => Markup::default(),
            Some(ending) => {
                let source = Place::Figure(name, ending).to_string();
                html! { img loading="lazy" src=(source) alt=(name.replace('-', " ")); }
            }
            None if is_inline => {
                *room -= shown.element.len();
                PreEscaped(shown.element.clone())
            }
            None => Markup::default(),
        };
        drop(pictures);
        self.captioned(name, picture)
    }

    /// Links to the files of a figure.
    fn files(&self, name: &str) -> Markup {
        let pictures = lock(&self.by_name);
        let mut endings: Vec<&String> = match pictures.get(name) {
            Some(shown) => shown.endings.iter().collect(),
            None => Vec::new(),
        };
        // Pictures first.
        endings.sort_by_key(|ending| [DATA, CAPTION].iter().position(|last| last == ending));
        html! {
            @for ending in endings {
                " " a href=(Place::Figure(name, ending).to_string()) { (called(ending)) }
            }
        }
    }
}

/// What a link to a file with this ending is called.
fn called(ending: &str) -> String {
    match ending {
        CAPTION => "caption".to_owned(),
        DATA => "data (CSV)".to_owned(),
        "@2x.png" => "PNG, twice as fine".to_owned(),
        ending => ending.trim_start_matches('.').to_uppercase(),
    }
}

fn gallery_mark(is_still: bool) -> &'static str {
    if is_still { "still" } else { "figure" }
}

/// The place of a picture, or of what belongs to it: a comment, as which nothing that a page says can stand there, since it is escaped.
fn mark(what: &str, name: &str) -> String {
    format!("<!-- {what} {name} -->")
}
