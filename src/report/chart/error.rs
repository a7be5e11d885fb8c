//! Why a chart could not be drawn.

use crate::figures::font::FontError;

/// Why a chart could not be drawn, and what to write instead.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ChartError {
    /// A part of it: a point, an axis, a mark, the map.
    #[error("cannot draw {item}: {reason}")]
    Item { item: String, reason: String },

    #[error("cannot draw a chart of {width_px} x {height_px} px: {reason}")]
    Size {
        width_px: u32,
        height_px: u32,
        reason: &'static str,
    },

    #[error("cannot {step} the chart: {reason}; this is an error of the program")]
    Internal { step: &'static str, reason: String },

    #[error("cannot set the chart in the font of this file: {0}")]
    Font(#[from] FontError),
}

impl ChartError {
    pub(super) fn item(item: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Item {
            item: item.into(),
            reason: reason.into(),
        }
    }

    /// What none of those that draw a chart can cause.
    pub(super) fn internal(step: &'static str, reason: impl ToString) -> Self {
        Self::Internal {
            step,
            reason: reason.to_string(),
        }
    }
}
