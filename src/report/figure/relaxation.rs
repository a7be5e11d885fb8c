//! Relaxation modulus against time, as figure 1 of S. Spinu, Advances in Tribology 2018, 9432894, shows it for PMMA.

use super::Figure;
use super::plot::Plot;
use super::quantity::{Quantity, TIME};
use super::trace::Trace;
use super::units::{Measure, Units};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::number::plain;
use crate::report::table::{cells, csv};

/// The figure, from (time in s, relaxation modulus in Pa, creep compliance in 1/Pa).
pub fn figure(points: &[(f64, f64, f64)], symbol: char) -> Figure {
    let modulus = Quantity::new("relaxation_modulus_pa", "", Measure::Modulus)
        .called(format!("relaxation modulus {symbol}(t)"));
    let line = Trace::line(points.iter().map(|point| (point.0, point.1)));
    let plot = Plot::new(TIME, modulus).traces([line]);
    let columns = ["time_s", "relaxation_modulus_pa", "creep_compliance_per_pa"];
    let rows = points
        .iter()
        .map(|(time, modulus, compliance)| cells![*time, *modulus, *compliance]);
    let data = csv(&columns, rows);
    let units = Units::default();
    Figure::of("relaxation", &[plot], caption(points, symbol), &units).with_data(data)
}

fn caption(points: &[(f64, f64, f64)], symbol: char) -> Caption {
    let ends = points.first().zip(points.last()).map(|(first, last)| {
        format!(
            "It falls from {} to {} within {}.",
            plain(first.1, Dimension::Stress, 4),
            plain(last.1, Dimension::Stress, 4),
            plain(last.0, Dimension::Time, 4)
        )
    });
    Caption::new(format!("Relaxation modulus {symbol}(t) against time t")).say_all(ends)
}
