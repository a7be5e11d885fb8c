//! Relaxation modulus against time, as figure 1 of S. Spinu, Advances in Tribology 2018, 9432894, shows it for PMMA.

use super::Figure;
use super::units::Units;
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Series};
use crate::report::number::{largest, plain};
use crate::report::table::{cells, csv};

/// The figure, from (time in s, relaxation modulus in Pa, creep compliance in 1/Pa).
pub fn figure(points: &[(f64, f64, f64)], symbol: char) -> Figure {
    let (factor, unit) = Units::default().modulus(largest(points.iter().map(|p| p.1)));
    let chart = Chart::new(
        Axis::linear("time t / s"),
        Axis::linear(format!("relaxation modulus {symbol}(t) / {unit}")),
    )
    .series(Series::line(points.iter().map(|p| (p.0, factor * p.1))));
    let columns = ["time_s", "relaxation_modulus_pa", "creep_compliance_per_pa"];
    let rows = points
        .iter()
        .map(|(time, modulus, compliance)| cells![*time, *modulus, *compliance]);
    Figure {
        name: "relaxation",
        picture: chart.into(),
        caption: caption(points, symbol),
        data: csv(&columns, rows),
    }
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
