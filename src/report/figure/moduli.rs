//! Storage modulus and loss modulus over angular frequency: of a material, and beside it what the loops of a sweep give.

use super::Figure;
use super::equivalent::{self, Equivalent, LoopModulus};
use super::units::Units;
use crate::report::caption::{self, Caption};
use crate::report::chart::{Axis, Chart, LineStyle, Marker, Series};
use crate::report::number::{largest, scientific};
use crate::report::table::{cells, csv};
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::search::run::Outcome;

/// One frequency of a material: rad/s, then Pa, then 1/Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModulusPoint {
    pub angular_frequency_rad_per_s: f64,
    pub storage_modulus_pa: f64,
    pub loss_modulus_pa: f64,
    pub storage_compliance_per_pa: f64,
    pub loss_compliance_per_pa: f64,
}

/// The figure of a material. `symbol` is E for longitudinal and G for shear moduli.
pub fn figure(points: &[ModulusPoint], symbol: char) -> Figure {
    let lines = points.iter().map(|p| {
        let (storage, loss) = (p.storage_modulus_pa, p.loss_modulus_pa);
        (p.angular_frequency_rad_per_s, storage, loss)
    });
    let (chart, _) = of_material(lines, symbol, &Units::default());
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
            p.loss_modulus_pa / p.storage_modulus_pa,
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

/// Where the material dissipates most of what it stores.
fn largest_tangent(points: &[ModulusPoint]) -> Option<String> {
    let tangent = |p: &ModulusPoint| p.loss_modulus_pa / p.storage_modulus_pa;
    let largest = points
        .iter()
        .max_by(|a, b| tangent(a).total_cmp(&tangent(b)))?;
    let at = Units::default().frequency_label(largest.angular_frequency_rad_per_s);
    (tangent(largest) > 0.0).then(|| {
        let tangent = scientific(tangent(largest), 4);
        format!("Largest loss tangent of the points drawn: {tangent} at {at}.")
    })
}

/// The figure of a sweep: the equivalent moduli of the loops as symbols, the material's own as lines.
pub fn with_loops(
    equivalent: &Equivalent<'_>,
    plan: &SweepPlan,
    outcome: &Outcome,
    units: &Units,
) -> Figure {
    let own = equivalent.own.iter();
    let (mut chart, factor) = of_material(
        own.map(|(w, modulus)| (*w, modulus.re, modulus.im)),
        'E',
        units,
    );
    let to_omega = units.frequency().0;
    chart.title.clone_from(&equivalent.title);
    let symbols = |quantity: Quantity, value: fn(&LoopModulus<'_>) -> f64| {
        let points = equivalent.loops.iter().map(|at| {
            let scaled = factor * value(at);
            (scaled > 0.0).then_some((to_omega * at.omega(), scaled))
        });
        let errors = equivalent.loops.iter();
        let errors = errors.map(|at| Some(factor * at.error_pa(quantity)?));
        equivalent::symbols(points).error_bars(errors.collect::<Vec<_>>())
    };
    let chart = chart
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
            .say_all(caption::error_bars(plan, outcome)),
        data: equivalent::table(plan, outcome, units),
    }
}

/// The lines of a material from (rad/s, Pa, Pa), and the factor from Pa to the unit of the axis.
fn of_material(
    points: impl Iterator<Item = (f64, f64, f64)> + Clone,
    symbol: char,
    units: &Units,
) -> (Chart, f64) {
    let storage = points.clone().map(|(_, storage, _)| storage);
    let (factor, unit) = units.modulus(largest(storage));
    let to_omega = units.frequency().0;
    // A modulus of exactly zero has no place on a log axis.
    let line = |value: fn((f64, f64, f64)) -> f64| {
        let scaled = points.clone().map(move |p| {
            let value = factor * value(p);
            (value > 0.0).then_some((to_omega * p.0, value))
        });
        Series::line(scaled)
    };
    let chart = Chart::new(
        Axis::log(units.frequency_title()),
        Axis::log(format!("modulus / {unit}")),
    )
    .series(line(|p| p.1).label(format!("storage modulus {symbol}′")))
    .series(
        line(|p| p.2)
            .label(format!("loss modulus {symbol}″"))
            .style(LineStyle::Dashed)
            .color(1),
    );
    (chart, factor)
}
