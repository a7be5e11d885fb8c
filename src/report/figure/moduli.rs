//! Storage modulus and loss modulus over angular frequency: of a material, and beside it what the loops of a sweep give.

use num_complex::Complex;

use super::Figure;
use super::curve::SweepCurves;
use super::equivalent::{self, Equivalent, Line, LoopModulus};
use super::units::Units;
use crate::report::caption::{self, Caption};
use crate::report::chart::{Axis, Chart, LineStyle, Marker, Series};
use crate::report::number::{largest, scientific};
use crate::report::table::{cells, csv};
use crate::sweep::record::error_bars::Quantity;

/// One frequency of a material: rad/s, then Pa, then 1/Pa.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ModulusPoint {
    pub angular_frequency_rad_per_s: f64,
    pub storage_modulus_pa: f64,
    pub loss_modulus_pa: f64,
    pub storage_compliance_per_pa: f64,
    pub loss_compliance_per_pa: f64,
}

/// The figure of a material. `symbol` is E for longitudinal and G for shear moduli.
pub fn figure(points: &[ModulusPoint], symbol: char) -> Figure {
    let line: Line = points
        .iter()
        .map(|p| {
            let modulus = Complex::new(p.storage_modulus_pa, p.loss_modulus_pa);
            (p.angular_frequency_rad_per_s, modulus)
        })
        .collect();
    let (chart, _) = of_material(&line, symbol, &Units::default());
    let columns = [
        "angular_frequency_rad_per_s",
        "storage_modulus_pa",
        "loss_modulus_pa",
        "loss_tangent",
        "storage_compliance_per_pa",
        "loss_compliance_per_pa",
    ];
    let rows = points.iter().map(|p| {
        cells![
            p.angular_frequency_rad_per_s,
            p.storage_modulus_pa,
            p.loss_modulus_pa,
            p.loss_tangent(),
            p.storage_compliance_per_pa,
            p.loss_compliance_per_pa,
        ]
    });
    Figure {
        name: "moduli",
        picture: chart.into(),
        caption: Caption::new(format!(
            "Storage modulus {symbol}′ and loss modulus {symbol}″ over angular frequency ω"
        ))
        .say_all(largest_tangent(points)),
        data: csv(&columns, rows),
    }
}

impl ModulusPoint {
    fn loss_tangent(&self) -> f64 {
        self.loss_modulus_pa / self.storage_modulus_pa
    }
}

/// Where the material dissipates most of what it stores.
fn largest_tangent(points: &[ModulusPoint]) -> Option<String> {
    let points = points.iter();
    let largest = points.max_by(|a, b| a.loss_tangent().total_cmp(&b.loss_tangent()))?;
    let at = Units::default().frequency_label(largest.angular_frequency_rad_per_s);
    (largest.loss_tangent() > 0.0).then(|| {
        let tangent = scientific(largest.loss_tangent(), 4);
        format!("Largest loss tangent of the points drawn: {tangent} at {at}.")
    })
}

/// The figure of a sweep: the equivalent moduli of the loops as symbols, the material's own as lines.
pub fn with_loops(equivalent: &Equivalent<'_>, sweep: &SweepCurves<'_>) -> Figure {
    let units = &sweep.units;
    let (chart, factor) = of_material(&equivalent.own, 'E', units);
    let to_omega = units.frequency().0;
    let symbols = |quantity: Quantity, value: fn(&LoopModulus<'_>) -> f64| {
        let points = equivalent.loops.iter().map(|at| {
            let scaled = factor * value(at);
            (scaled > 0.0).then_some((to_omega * at.omega(), scaled))
        });
        let errors = equivalent.loops.iter();
        let errors = errors.map(|at| Some(factor * at.error_pa(quantity)?));
        equivalent::symbols(points).error_bars(errors)
    };
    let chart = chart
        .maybe_title(equivalent.title.clone())
        .series(symbols(Quantity::StorageModulus, |at| at.storage_pa).label("E′ from the loop"))
        .series(
            symbols(Quantity::LossModulus, |at| at.loss_pa)
                .label("E″ from the loop")
                .marker(Marker::Square)
                .color(1),
        );
    let shows = format!(
        "Storage modulus E′ and loss modulus E″ over {}",
        units.frequency_words()
    );
    Figure {
        name: "moduli",
        picture: chart.into(),
        caption: equivalent
            .caption(&shows)
            .say_all(caption::error_bars(sweep.plan, sweep.outcome)),
        data: equivalent::table(sweep),
    }
}

/// The lines of a material, and the factor from Pa to the unit of the axis.
fn of_material(own: &Line, symbol: char, units: &Units) -> (Chart, f64) {
    let (factor, unit) = units.modulus(largest(own.iter().map(|(_, modulus)| modulus.re)));
    let to_omega = units.frequency().0;
    // A modulus of exactly zero has no place on a log axis.
    let line = |part: fn(&Complex<f64>) -> f64| {
        Series::line(own.iter().map(|(omega, modulus)| {
            let value = factor * part(modulus);
            (value > 0.0).then_some((to_omega * omega, value))
        }))
    };
    let chart = Chart::new(
        Axis::log(units.frequency_title()),
        Axis::log(format!("modulus / {unit}")),
    )
    .series(line(|m| m.re).label(format!("storage modulus {symbol}′")))
    .series(
        line(|m| m.im)
            .label(format!("loss modulus {symbol}″"))
            .style(LineStyle::Dashed)
            .color(1),
    );
    (chart, factor)
}
