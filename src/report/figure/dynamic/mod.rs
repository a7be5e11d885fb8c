//! Figures of dynamic data and of what was made of them: the list of them, and what they have in common.

mod data_and_fit;
mod isotherms;
mod master_curve;
mod residuals;
mod shift_factors;
pub(super) mod spectrum;
mod van_gurp_palmen;

use num_complex::Complex;

use super::Figure;
use super::quantity::Quantity;
use super::trace::{Point, Trace};
use super::units::Units;
use crate::material::dynamic::DynamicPoint;
use crate::quantity;
use crate::report::caption::Caption;
use crate::report::chart::{Color, ColorScale, LineStyle, Marker};
use crate::report::dynamic::DynamicReport;
use crate::report::dynamic::tables::celsius;

/// Every figure that the data have: shift factors and isotherms take several temperatures.
pub fn figures(report: &DynamicReport<'_>) -> Vec<Figure> {
    let of_all = [
        Some(data_and_fit::figure(report)),
        Some(residuals::figure(report)),
        master_curve::figure(report),
        isotherms::figure(report),
        shift_factors::figure(report),
        Some(spectrum::figure(report)),
        report
            .spectrum()
            .map(|of| spectrum::continuous(of, report.symbol())),
        Some(van_gurp_palmen::figure(report)),
    ];
    of_all.into_iter().flatten().collect()
}

/// Storage or loss modulus, and how it is drawn wherever both stand in one frame.
struct Part {
    name: &'static str,
    primes: char,
    of_point: fn(&DynamicPoint) -> f64,
    of_modulus: fn(Complex<f64>) -> f64,
    marker: Marker,
    style: LineStyle,
    color: usize,
}

const STORAGE: Part = Part {
    name: "storage modulus",
    primes: '′',
    of_point: |point| point.storage_modulus_pa,
    of_modulus: |modulus| modulus.re,
    marker: Marker::Disc,
    style: LineStyle::Solid,
    color: 0,
};

const LOSS: Part = Part {
    name: "loss modulus",
    primes: '″',
    of_point: |point| point.loss_modulus_pa,
    of_modulus: |modulus| modulus.im,
    marker: Marker::Square,
    style: LineStyle::Dashed,
    color: 1,
};

impl Part {
    /// `storage modulus E′`.
    fn label(&self, report: &DynamicReport<'_>) -> String {
        self.called(report, self.name)
    }

    /// `measured E′`.
    fn called(&self, report: &DynamicReport<'_>, what: &str) -> String {
        format!("{what} {}{}", report.symbol(), self.primes)
    }

    /// The fitted series as a curve.
    fn curve(&self, report: &DynamicReport<'_>) -> Trace {
        let points = frequencies(report).into_iter().map(|omega| {
            let modulus = report.relaxation().complex_modulus(omega);
            (omega, (self.of_modulus)(modulus))
        });
        let label = self.called(report, "series");
        Trace::line(points).style(self.style).label(label)
    }

    /// A point of this modulus.
    fn point(&self, point: &DynamicPoint) -> Point {
        Point::new(point.angular_frequency_rad_per_s, (self.of_point)(point))
    }
}

/// The units of the figures: frequencies as in the data.
fn units(report: &DynamicReport<'_>) -> Units {
    Units::in_si(report.source.frequency_unit)
}

/// The frequencies: reduced where isotherms were shifted.
fn frequency(report: &DynamicReport<'_>) -> Quantity {
    let own = Quantity::frequency(&units(report));
    let unit = report.source.frequency_unit;
    match report.made.master {
        Some(_) => own.called(format!("reduced {} a_T {}", unit.quantity(), unit.symbol())),
        None => own,
    }
}

/// What the figures say of the data.
fn caption(report: &DynamicReport<'_>, shows: &str) -> Caption {
    let points = report.data.points().count();
    let at = report.reference_temperature_k().map(quantity::celsius);
    let data = match (&report.made.master, at) {
        (Some(master), Some(at)) => format!(
            "{points} points in {} isotherms, shifted to {at}.",
            master.shifts.len()
        ),
        (_, Some(at)) => format!("{points} points at {at}."),
        _ => format!("{points} points."),
    };
    Caption::new(shows).say(data)
}

/// The colours of the temperatures; `None` where the data name none, or a single one.
fn temperatures(report: &DynamicReport<'_>) -> Option<ColorScale> {
    let isotherms = report.data.isotherms();
    let known = isotherms.iter().filter_map(|i| i.temperature_k);
    match isotherms.len() {
        1 => None,
        _ => ColorScale::over("temperature T / °C", known.map(celsius)),
    }
}

/// One set of symbols for each isotherm, in the colour of its temperature.
fn coloured(
    report: &DynamicReport<'_>,
    points: &[DynamicPoint],
    marker: Marker,
    place: impl Fn(&DynamicPoint) -> Point,
) -> Vec<Trace> {
    let scale = temperatures(report);
    let isotherms = report.data.isotherms().iter();
    let of_isotherm = isotherms.map(|isotherm| {
        // A point belongs to the isotherm that is nearest to it.
        let own = |point: &&DynamicPoint| nearest(report, point) == isotherm.temperature_k;
        let places = points.iter().filter(own).map(&place);
        let color = match (&scale, isotherm.temperature_k) {
            (Some(scale), Some(temperature_k)) => scale.color(celsius(temperature_k)),
            _ => Color::Palette(0),
        };
        Trace::symbols(places)
            .marker(marker)
            .color(color)
            .member(isotherm.temperature_k)
    });
    of_isotherm.collect()
}

/// The temperature (K) of the isotherm that a point belongs to.
fn nearest(report: &DynamicReport<'_>, point: &DynamicPoint) -> Option<f64> {
    let of_point = point.temperature_k?;
    let isotherms = report.data.isotherms().iter();
    let known = isotherms.filter_map(|isotherm| isotherm.temperature_k);
    known.min_by(|a, b| (a - of_point).abs().total_cmp(&(b - of_point).abs()))
}

/// An entry of the legend without points: what a symbol stands for where its colours stand for something else.
fn legend_of_marker(label: String, marker: Marker) -> Trace {
    Trace {
        marker: Some(marker),
        line: None,
        ..Trace::guide([]).label(label)
    }
}

/// As many frequencies from the lowest to the highest of the data as a smooth curve takes.
fn frequencies(report: &DynamicReport<'_>) -> Vec<f64> {
    const POINTS: i32 = 400;
    let (lowest, highest) = report.made.fit.window_rad_per_s;
    let decades = (highest / lowest).log10();
    (0..=POINTS)
        .map(|i| lowest * 10_f64.powf(decades * f64::from(i) / f64::from(POINTS)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::dynamic::tests::{measured, source};

    #[test]
    fn every_figure_can_be_drawn_with_isotherms_and_without() {
        let (data, mut made) = measured();
        let source = source();
        let names = |made: &_| {
            let report = DynamicReport {
                source: &source,
                data: &data,
                made,
                beside: None,
            };
            let figures = figures(&report);
            for figure in &figures {
                let drawing = figure.picture.draw().unwrap();
                assert!(!drawing.to_png(1.0).unwrap().is_empty());
                let rows = String::from_utf8(figure.data.clone()).unwrap();
                let columns = rows.lines().next().unwrap_or_default().split(',').count();
                assert!(rows.lines().all(|row| row.split(',').count() == columns));
            }
            figures
                .into_iter()
                .map(|figure| figure.name)
                .collect::<Vec<_>>()
        };
        let all = [
            "fit",
            "fit-residual",
            "master-curve",
            "isotherms",
            "shift-factors",
            "spectrum",
            "van-gurp-palmen",
        ];
        assert_eq!(names(&made), all);
        made.master = None;
        // The isotherms as they were measured need no master curve.
        assert_eq!(names(&made), [all[0], all[1], all[3], all[5], all[6]]);
        made.replicas.clear();
        assert_eq!(names(&made).len(), 5);
    }
}
