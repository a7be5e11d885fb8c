//! The branches of the fitted series: modulus over relaxation time.

use super::caption;
use crate::quantity::{Dimension, format_human};
use crate::report::chart::{Axis, Chart, Mark, Series};
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::number::{prefix, range};

/// The figure; its data are `prony.csv`.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let relaxation = report.relaxation();
    let symbol = report.symbol();
    let branches = relaxation.branches();
    let equilibrium_pa = relaxation.equilibrium_modulus();
    let moduli = branches.iter().map(|b| b.modulus_pa);
    let equilibrium = (equilibrium_pa > 0.0).then_some(equilibrium_pa);
    let (least, largest) = range(moduli.chain(equilibrium));
    let (factor, unit) = prefix(largest);
    // Stems stand on a decade below the least.
    let foot = 10_f64.powf((factor * least).log10().floor() - 0.3);
    let top = factor * largest * 4.0;
    let stems = branches.iter().flat_map(|branch| {
        let head = factor * branch.modulus_pa;
        [
            Some((branch.time_s, foot)),
            Some((branch.time_s, head)),
            None,
        ]
    });
    let heads = branches.iter().map(|b| (b.time_s, factor * b.modulus_pa));
    let mut chart = Chart::new(
        Axis::log("relaxation time τ / s"),
        Axis::log(format!("modulus of the branch {symbol}ᵢ / {unit}Pa")).range(foot, top),
    )
    .series(Series::line(stems))
    .series(Series::scatter(heads));
    let (first_s, last_s) = report.window_s();
    if let Some(equilibrium) = equilibrium {
        chart = chart.mark(Mark::horizontal(
            factor * equilibrium,
            format!(
                "equilibrium {}",
                format_human(equilibrium, Dimension::Stress, 3)
            ),
        ));
    }
    chart = chart
        .mark(Mark::vertical(first_s, "1/ω of the last point"))
        .mark(Mark::vertical(last_s, "1/ω of the first point"));
    Figure {
        name: "spectrum",
        picture: chart.into(),
        caption: caption(report, "Relaxation spectrum: modulus of each branch of the series over its relaxation time τ")
            .say("Dashed: equilibrium modulus, and the reciprocals of the lowest and highest frequency of the data; times outside are not resolved."),
        data: Vec::new(),
    }
}
