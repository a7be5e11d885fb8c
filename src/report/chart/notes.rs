//! What the caption of a picture must say of it, because there was no room or too many symbols.

use super::Chart;
use super::arrange::Arrangement;
use super::drawing::Drawing;

/// What was drawn otherwise than the chart says.
#[derive(Clone, Debug, Default)]
pub(super) struct Notes {
    /// The labels of marks that have a number instead, from 1 on.
    pub(super) numbered: Vec<String>,
    /// The labels of marks that stand nowhere.
    unlabelled: Vec<String>,
    is_thinned: bool,
    /// Sizes (pt) of its text: asked for, and as there was room for.
    smaller_text_pt: Option<(f64, f64)>,
}

impl Notes {
    pub(super) fn add(&mut self, chart: &Chart, arrangement: &Arrangement) {
        let label = |place: usize| chart.marks[place].label.clone();
        let labels = &arrangement.labels;
        let numbered = labels.iter().filter(|label| label.number.is_some());
        self.numbered
            .extend(numbered.map(|placed| label(placed.mark)));
        let is_placed = |place: usize| labels.iter().any(|label| label.mark == place);
        let unlabelled = (0..chart.marks.len()).filter(|&place| !is_placed(place));
        let unlabelled = unlabelled.map(label).filter(|label| !label.is_empty());
        self.unlabelled.extend(unlabelled);
        self.is_thinned |= arrangement.curves.iter().any(|curve| curve.is_thinned);
    }
}

impl Drawing {
    /// The numbers that stand in the picture where a label had no room, each with its label; over all its charts.
    pub fn numbered(&self) -> Vec<(usize, String)> {
        (1..).zip(self.notes.numbered.iter().cloned()).collect()
    }

    /// The labels that stand nowhere in the picture, because not even a number had room.
    pub fn unlabelled(&self) -> &[String] {
        &self.notes.unlabelled
    }

    /// Whether a line goes through more points than have a symbol, because symbols would crowd.
    pub fn is_thinned(&self) -> bool {
        self.notes.is_thinned
    }

    /// The same, whose text has not the size asked for (pt), for want of room, but this one.
    #[must_use]
    pub fn with_smaller_text(mut self, asked_pt: f64, drawn_pt: f64) -> Self {
        self.notes.smaller_text_pt = Some((asked_pt, drawn_pt));
        self
    }

    /// The caption with what it must say besides: which numbers stand for which labels, that symbols were left out, and that text is
    /// smaller than it should be.
    pub fn captioned(&self, caption: &str) -> String {
        let mut said = caption.to_owned();
        if self.is_thinned() && !caption.contains("symbols at some") {
            said += " Lines go through all points, symbols at some.";
        }
        let numbered = self.numbered();
        if !numbered.is_empty() {
            let listed = numbered
                .iter()
                .map(|(number, label)| format!("{number}: {label}"));
            said += &format!(" {}.", listed.collect::<Vec<_>>().join("; "));
        }
        if !self.unlabelled().is_empty() {
            said += &format!(" Without a label: {}.", self.unlabelled().join("; "));
        }
        if let Some((asked_pt, drawn_pt)) = self.notes.smaller_text_pt {
            said += &format!(" Text of {asked_pt} pt has no room: it is {drawn_pt:.1} pt high.");
        }
        said
    }
}
