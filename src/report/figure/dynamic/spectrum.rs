//! The branches of the fitted series: modulus over relaxation time.

use super::{caption, units};
use crate::material::continuous::Spectrum;
use crate::quantity::{Dimension, format_human};
use crate::report::caption::Caption;
use crate::report::chart::Mark;
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::figure::plot::Plot;
use crate::report::figure::quantity::{MODULUS, Quantity, Spread};
use crate::report::figure::trace::{Point, Trace};
use crate::report::figure::units::{Measure, Units};
use crate::report::laws::spectrum_csv;
use crate::report::number::range;

const RELAXATION_TIME: Quantity =
    Quantity::new("time_s", "relaxation time τ", Measure::Time).spread(Spread::Log);

/// The figure; its data are `prony.csv`.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let relaxation = report.relaxation();
    let branches = relaxation.branches();
    let equilibrium_pa = relaxation.equilibrium_modulus();
    let moduli = branches.iter().map(|b| b.modulus_pa);
    let equilibrium = (equilibrium_pa > 0.0).then_some(equilibrium_pa);
    let (least, largest) = range(moduli.chain(equilibrium));
    // Stems stand on half a decade below the least.
    let (foot, top) = (0.4 * least, 4.0 * largest);
    let stems = branches.iter().flat_map(|branch| {
        let at = |height: Option<f64>| Point::new(branch.time_s, height);
        [at(Some(foot)), at(Some(branch.modulus_pa)), at(None)]
    });
    let heads = branches.iter().map(|b| (b.time_s, b.modulus_pa));
    let (first_s, last_s) = report.window_s();
    let level = equilibrium.map(|modulus_pa| {
        let modulus = format_human(modulus_pa, Dimension::Stress, 3);
        Mark::horizontal(modulus_pa, format!("equilibrium {modulus}"))
    });
    let ends = [
        Mark::vertical(first_s, "1/ω of the last point"),
        Mark::vertical(last_s, "1/ω of the first point"),
    ];
    let modulus = MODULUS.called(format!("modulus of the branch {}ᵢ", report.symbol()));
    let plot = Plot {
        y_ends: Some((foot, top)),
        ..Plot::new(RELAXATION_TIME, modulus)
            .traces([Trace::line(stems), Trace::symbols(heads)])
            .marks(level.into_iter().chain(ends))
    };
    let caption = caption(report, "Relaxation spectrum: modulus of each branch of the series over its relaxation time τ")
        .say("Dashed: equilibrium modulus, and the reciprocals of the lowest and highest frequency of the data; times outside are not resolved.");
    Figure::of("spectrum", &[plot], caption, &units(report)).without_data()
}

/// A continuous spectrum with its band, of a modulus of this symbol.
pub(in crate::report::figure) fn continuous(spectrum: &Spectrum, symbol: char) -> Figure {
    /// What is not determined fills the frame, not the axis.
    const WIDE: f64 = 30.0;
    let largest = spectrum
        .points
        .iter()
        .map(|p| p.spectrum_pa)
        .fold(0.0, f64::max);
    let shown = spectrum
        .points
        .iter()
        .filter(|p| p.spectrum_pa > 1e-4 * largest);
    let points = shown.map(|p| {
        let open = (p.high_pa / p.spectrum_pa).min(WIDE);
        let band = (p.spectrum_pa / open, p.spectrum_pa * open);
        Point::new(p.time_s, p.spectrum_pa).band(Some(band))
    });
    let (first_s, last_s) = spectrum.window_s;
    let height = MODULUS.called(format!("relaxation spectrum H of {symbol}"));
    let plot = Plot::new(RELAXATION_TIME, height)
        .traces([Trace::line(points)])
        .marks([
            Mark::vertical(first_s, "first measured"),
            Mark::vertical(last_s, "last measured"),
        ]);
    let caption = Caption::new(format!(
        "Continuous relaxation spectrum: {symbol}(t) = {symbol}\u{221e} + \u{222b} H exp(-t/\u{3c4}) d ln \u{3c4}"
    ))
    .say("Shaded: 95 % band, drawn up to a factor of thirty; outside the dashed lines the spectrum is an extrapolation.");
    Figure::of("continuous-spectrum", &[plot], caption, &Units::default())
        .with_data(spectrum_csv(spectrum))
}
