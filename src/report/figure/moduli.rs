//! Storage modulus, loss modulus and loss tangent of a material over angular frequency.

use super::{Figure, prefix};
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, LineStyle, Series};
use crate::report::table::Table;

/// One frequency of a material: rad/s, then Pa, then 1/Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModulusPoint {
    pub angular_frequency_rad_per_s: f64,
    pub storage_modulus_pa: f64,
    pub loss_modulus_pa: f64,
    pub storage_compliance_per_pa: f64,
    pub loss_compliance_per_pa: f64,
}

/// The figure. `symbol` is E for longitudinal and G for shear moduli.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(points: &[ModulusPoint], symbol: char) -> Result<Figure, ReportError> {
    let largest = points.iter().map(|p| p.storage_modulus_pa);
    let (factor, unit) = prefix(largest.fold(0.0, f64::max));
    let series = |value: fn(&ModulusPoint) -> f64| {
        // A modulus of exactly zero has no place on a log axis.
        let point = move |p: &ModulusPoint| {
            let scaled = factor * value(p);
            (scaled > 0.0).then_some((p.angular_frequency_rad_per_s, scaled))
        };
        Series::line(points.iter().map(point))
    };
    let chart = Chart::new(
        Axis::log("angular frequency ω / rad·s⁻¹"),
        Axis::log(format!("modulus / {unit}Pa")),
    )
    .series(series(|p| p.storage_modulus_pa).label(format!("storage modulus {symbol}′")))
    .series(
        series(|p| p.loss_modulus_pa)
            .label(format!("loss modulus {symbol}″"))
            .style(LineStyle::Dashed)
            .color(1),
    );
    let columns = [
        "angular_frequency_rad_per_s",
        "storage_modulus_pa",
        "loss_modulus_pa",
        "loss_tangent",
        "storage_compliance_per_pa",
        "loss_compliance_per_pa",
    ];
    let mut table = Table::new("moduli.csv", &columns)?;
    for p in points {
        table.numbers(&[
            p.angular_frequency_rad_per_s,
            p.storage_modulus_pa,
            p.loss_modulus_pa,
            p.loss_modulus_pa / p.storage_modulus_pa,
            p.storage_compliance_per_pa,
            p.loss_compliance_per_pa,
        ])?;
    }
    Ok(Figure {
        name: "moduli",
        chart,
        data: table.finish()?,
    })
}
