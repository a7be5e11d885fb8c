//! Data against the series fitted to them, and the relative difference between the two.

use super::Figure;
use super::dynamic::spectrum::continuous;
use super::plot::Plot;
use super::quantity::{Quantity, RESIDUAL, Spread, TIME};
use super::trace::Trace;
use super::units::{Measure, Units};
use crate::material::MaterialFunction;
use crate::material::continuous::Spectrum;
use crate::material::fit::Fit;
use crate::material::tabulated::Tabulated;
use crate::report::caption::Caption;
use crate::report::chart::Marker;
use crate::report::table::{cells, csv};

/// Points of the fitted curve; most symbols along it, between which it can still be seen, and most symbols without a curve.
const CURVE: usize = 400;
const SYMBOLS_ON_CURVE: usize = 50;
const SYMBOLS: usize = 2000;

/// Two figures, `fit` and `fit-residual`, and the continuous spectrum where there is one. A sample at time zero has no place on their logarithmic axis; it is in the data.
pub fn figures(table: &Tabulated, fit: &Fit, spectrum: Option<&Spectrum>) -> Vec<Figure> {
    let symbol = MaterialFunction::Relaxation.symbol(table.kind());
    let spectrum = spectrum.map(|spectrum| continuous(spectrum, symbol));
    let figures = [curves(table, fit), residual(table, fit)];
    figures.into_iter().chain(spectrum).collect()
}

/// Samples at positive times; where there are more than `most`, as many at about equal distances in the logarithm of time.
fn shown(table: &Tabulated, most: usize) -> Vec<(f64, f64)> {
    let values = table.values().iter().copied();
    let samples = table.times_s().iter().copied().zip(values);
    let positive: Vec<_> = samples.filter(|(time_s, _)| *time_s > 0.0).collect();
    if positive.len() <= most {
        return positive;
    }
    let (from, to) = positive_range_s(table);
    let mut next = 0.0;
    let far_enough = |(time_s, _): &(f64, f64)| {
        let place = (time_s / from).ln() / (to / from).ln() * (most - 1) as f64;
        let taken = place >= next - 1e-9;
        if taken {
            next = place.floor() + 1.0;
        }
        taken
    };
    positive.into_iter().filter(far_enough).collect()
}

/// What was measured, as an axis.
fn measured(table: &Tabulated) -> Quantity {
    let symbol = table.function().symbol(table.kind());
    let (column, words, measure) = match table.function() {
        MaterialFunction::Relaxation => (
            "relaxation_modulus_pa",
            "relaxation modulus",
            Measure::Modulus,
        ),
        MaterialFunction::Creep => (
            "creep_compliance_per_pa",
            "creep compliance",
            Measure::Compliance,
        ),
    };
    Quantity::new(column, "", measure)
        .called(format!("{words} {symbol}(t)"))
        .spread(Spread::OfValues)
}

fn curves(table: &Tabulated, fit: &Fit) -> Figure {
    let symbols = shown(table, SYMBOLS_ON_CURVE);
    let samples = table.times_s().len();
    let label = match symbols.len() + 1 < samples {
        true => format!("data ({} of {samples} samples)", symbols.len()),
        false => "data".to_owned(),
    };
    let (from, to) = positive_range_s(table);
    let curve = (0..=CURVE).map(|i| {
        let time_s = from * (to / from).powf(i as f64 / CURVE as f64);
        (time_s, fit.series().value(time_s))
    });
    let plot = Plot::new(TIME.spread(Spread::Log), measured(table)).traces([
        Trace::symbols(symbols).marker(Marker::Ring).label(label),
        Trace::line(curve).label("fit").color(1),
    ]);
    let caption = caption(table, fit, "Data and the series fitted to them");
    Figure::of("fit", &[plot], caption, &Units::default()).with_data(data_table(table, fit))
}

fn residual(table: &Tabulated, fit: &Fit) -> Figure {
    let off = |time_s: f64, value: f64| fit.series().value(time_s) / value - 1.0;
    let points = shown(table, SYMBOLS).into_iter();
    let points = points.map(|(time_s, value)| (time_s, off(time_s, value)));
    let (from, to) = positive_range_s(table);
    let plot = Plot::new(TIME.spread(Spread::Log), RESIDUAL).traces([
        Trace::guide([(from, 0.0), (to, 0.0)]).color(1),
        Trace::symbols(points).marker(Marker::Ring),
    ]);
    let samples = table.times_s().iter().zip(table.values());
    let rows = samples.map(|(&time_s, &value)| cells![time_s, off(time_s, value)]);
    let caption = caption(
        table,
        fit,
        "Relative difference of the fitted series from the data",
    );
    Figure::of("fit-residual", &[plot], caption, &Units::default())
        .with_data(csv(&["time_s", "relative_difference"], rows))
}

fn caption(table: &Tabulated, fit: &Fit, shows: &str) -> Caption {
    let what = match table.function() {
        MaterialFunction::Creep => "creep compliance",
        MaterialFunction::Relaxation => "relaxation modulus",
    };
    let report = fit.report().to_string();
    let sentences = report.lines().map(|line| {
        let line = line.trim();
        match line.ends_with(['.', '!', '?']) {
            true => line.to_owned(),
            false => format!("{line}."),
        }
    });
    Caption::new(format!("{shows}, against time t"))
        .say(format!("{} samples of the {what}.", table.times_s().len()))
        .say_all(sentences)
}

fn positive_range_s(table: &Tabulated) -> (f64, f64) {
    let curve = table.curve();
    (curve.shortest_time_s().unwrap_or(1.0), curve.last_time_s())
}

fn data_table(table: &Tabulated, fit: &Fit) -> Vec<u8> {
    let columns = match table.function() {
        MaterialFunction::Creep => ["time_s", "creep_compliance_per_pa", "fit_per_pa"],
        MaterialFunction::Relaxation => ["time_s", "relaxation_modulus_pa", "fit_pa"],
    };
    let samples = table.times_s().iter().zip(table.values());
    csv(
        &columns,
        samples.map(|(&time_s, &value)| cells![time_s, value, fit.series().value(time_s)]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::ModulusKind;
    use crate::material::fit::fit;

    fn table(count: i32) -> Tabulated {
        let times: Vec<f64> = (0..count).map(|i| f64::from(i) * 0.5).collect();
        let values = times
            .iter()
            .map(|t| 1e-9 * (2.0 - (-t / 10.0).exp()))
            .collect();
        Tabulated::new(MaterialFunction::Creep, ModulusKind::Shear, times, values).unwrap()
    }

    #[test]
    fn many_samples_are_thinned_evenly_and_the_legend_says_so() {
        let table = table(2001);
        let symbols = shown(&table, SYMBOLS_ON_CURVE);
        assert!(symbols.len() <= SYMBOLS_ON_CURVE && symbols.len() > 30);
        assert_eq!(symbols[0].0, 0.5);
        assert_eq!(symbols.last().unwrap().0, 1000.0);
        let figures = figures(&table, &fit(&table, None).unwrap(), None);
        let label = chart_of(&figures[0]).series[0].label.clone().unwrap();
        assert!(label.starts_with("data (") && label.contains("of 2001 samples"));
        let few = table_figures(20);
        assert_eq!(chart_of(&few[0]).series[0].label.as_deref(), Some("data"));
    }

    fn chart_of(figure: &Figure) -> &crate::report::chart::Chart {
        &figure.picture.0[0]
    }

    fn table_figures(count: i32) -> Vec<Figure> {
        let table = table(count);
        figures(&table, &fit(&table, None).unwrap(), None)
    }

    #[test]
    fn the_figures_hold_every_sample_in_their_data_and_can_be_drawn() {
        for figure in table_figures(20) {
            let rows = String::from_utf8(figure.data).unwrap();
            assert_eq!(rows.lines().count(), 21);
            assert!(rows.lines().nth(1).unwrap().starts_with("0e0,"));
            assert!(figure.picture.draw().is_ok());
        }
    }
}
