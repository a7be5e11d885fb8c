//! Why a chart could not be drawn.

use std::fmt;

use crate::figures::font::FontError;

/// Why a chart could not be drawn, and what to write instead.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ChartError {
    #[error(
        "cannot draw the chart of {chart}: there is no point to show; give at least one series with a point inside the axis ranges"
    )]
    Empty { chart: String },

    #[error(
        "cannot draw {item}: {quantity} is {value}, which is not a finite number; where a value is absent, leave it out (None)"
    )]
    NotFinite {
        item: String,
        quantity: &'static str,
        value: f64,
    },

    #[error(
        "cannot draw {item}: its {axis} is {value}, and a logarithmic axis shows only values above zero; leave it out (None) or make the {axis} axis linear"
    )]
    NotPositive {
        item: String,
        axis: AxisName,
        value: f64,
    },

    #[error("cannot {step} the chart: {reason}; this is an error of the program")]
    Internal { step: &'static str, reason: String },

    #[error("cannot lay out the {axis} axis from {low} to {high}: {reason}")]
    Range {
        axis: AxisName,
        low: f64,
        high: f64,
        reason: &'static str,
    },

    #[error(
        "cannot draw the error bars of {series}: there are {errors} of them for {points} points; give one per point, None where there is none"
    )]
    ErrorBarCount {
        series: String,
        errors: usize,
        points: usize,
    },

    #[error(
        "cannot draw the error bar of {item}: its half-length is {value}; give a finite number of at least zero"
    )]
    ErrorBar { item: String, value: f64 },

    #[error(
        "cannot draw {series}: it has neither line nor marker nor filled area; give it one of them"
    )]
    Invisible { series: String },

    #[error(
        "cannot draw {mark}: its {axis} {value} is outside the axis, {low} to {high}; widen the range or leave the mark out"
    )]
    MarkOutside {
        mark: String,
        axis: AxisName,
        value: f64,
        low: f64,
        high: f64,
    },

    #[error(
        "cannot draw the map of {map}: there are {found} values for {columns} columns and {rows} rows; give one per cell, None \
         where there is none"
    )]
    CellCount {
        map: String,
        found: usize,
        columns: usize,
        rows: usize,
    },

    #[error("cannot draw the map of {map}: {reason}")]
    Map { map: String, reason: &'static str },

    #[error("cannot stack no charts; give at least one")]
    EmptyStack,

    #[error(
        "cannot write the text {text:?}: it contains a control character; write it on one line of printable characters"
    )]
    Text { text: String },

    #[error("cannot draw a chart of {width_px} x {height_px} px: {reason}")]
    Size {
        width_px: u32,
        height_px: u32,
        reason: &'static str,
    },

    #[error("cannot turn the chart into pixels at scale {scale}: {reason}")]
    PixelScale { scale: f64, reason: &'static str },

    #[error("cannot set the chart in the font of this file: {0}")]
    Font(#[from] FontError),
}

impl ChartError {
    /// What none of those that draw a chart can cause.
    pub(super) fn internal(step: &'static str, reason: impl ToString) -> Self {
        Self::Internal {
            step,
            reason: reason.to_string(),
        }
    }
}

/// Which axis an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisName {
    X,
    Y,
}

impl fmt::Display for AxisName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
        })
    }
}
