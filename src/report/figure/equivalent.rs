//! The equivalent moduli of the loops beside the material's own: the data of four figures.

use num_complex::Complex;

use super::curve::{Curve, curves, place_columns, place_of};
use super::units::Units;
use crate::material::Material;
use crate::report::caption::Caption;
use crate::report::chart::Series;
use crate::report::number::{largest, scientific};
use crate::report::table::{cells, csv_leading};
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::CaseRecord;
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::search::run::Outcome;

/// What indentation reads from one loop, and what it stands for.
#[derive(Debug, Clone, Copy)]
pub struct LoopModulus<'a> {
    pub record: &'a CaseRecord,
    pub storage_pa: f64,
    pub loss_pa: f64,
    /// The material's longitudinal complex modulus (Pa).
    pub own_pa: Complex<f64>,
}

/// Frequency (rad/s) and complex modulus (Pa).
pub type Line = Vec<(f64, Complex<f64>)>;

/// One curve with the material's own moduli.
pub struct Equivalent<'a> {
    pub loops: Vec<LoopModulus<'a>>,
    /// Over the frequencies of the loops.
    pub own: Line,
    /// Two decades further on both sides.
    pub own_beyond: Line,
    pub title: Option<String>,
    /// The same as a sentence.
    pub under: Option<String>,
}

impl<'a> Equivalent<'a> {
    /// `None` where fewer than two loops have moduli.
    pub fn of(curve: &Curve<'a>) -> Option<Self> {
        let material = &curve.condition.material;
        let loops = of_loops(curve);
        let first = loops.first()?.record.angular_frequency_rad_per_s;
        let last = loops.last()?.record.angular_frequency_rad_per_s;
        (loops.len() > 1 && last > first).then(|| Self {
            own: line(material, first, last),
            own_beyond: line(material, 1e-2 * first, 1e2 * last),
            title: curve.label.clone(),
            under: curve.sentence.clone(),
            loops,
        })
    }
}

/// Loops as symbols beside the line of the material, which they must not hide.
pub fn symbols<P: Into<Option<(f64, f64)>>>(points: impl IntoIterator<Item = P>) -> Series {
    Series::scatter(points).spaced()
}

/// The moduli of the loops of a curve, as far as they have any.
pub fn of_loops<'a>(curve: &Curve<'a>) -> Vec<LoopModulus<'a>> {
    let material = &curve.condition.material;
    let records = curve.records.iter();
    records
        .filter_map(|&record| {
            let result = record.result.as_ref()?;
            let omega = record.angular_frequency_rad_per_s;
            Some(LoopModulus {
                record,
                storage_pa: result.storage_modulus_pa?,
                loss_pa: result.loss_modulus_pa?,
                own_pa: material.longitudinal_complex_modulus(omega),
            })
        })
        .collect()
}

fn line(material: &Material, first: f64, last: f64) -> Line {
    let count = (30.0 * (last / first).log10()).ceil().clamp(100.0, 1000.0) as usize;
    (0..=count)
        .map(|k| first * (last / first).powf(k as f64 / count as f64))
        .map(|omega| (omega, material.longitudinal_complex_modulus(omega)))
        .collect()
}

impl Equivalent<'_> {
    /// A caption of a figure that draws loops beside the material: how the symbols come about, and how far they are off.
    pub fn caption(&self, shows: &str) -> Caption {
        let [storage, loss] = largest_differences(|| self.loops.iter());
        Caption::new(shows)
            .say_all(self.under.clone())
            .say(
                "Lines: the material's longitudinal modulus. Symbols: what indentation reads from the hysteresis loops, \
                 E′ = (1 − ν²)W₁cosφ/(2aδ₁) and E″ with sinφ, W₁ and δ₁ being the first harmonics of load and approach, φ the \
                 phase between them and a the mean contact radius. Symbols that would crowd over the lines are left out; the data have \
                 all.",
            )
            .say(format!(
                "They differ from the material's by at most {storage} % in E′ and {loss} % in E″."
            ))
    }
}

/// The largest differences of storage and loss modulus from the material's, in percent of these.
pub fn largest_differences<'a, I>(loops: impl Fn() -> I) -> [String; 2]
where
    I: Iterator<Item = &'a LoopModulus<'a>>,
{
    let storage = largest(loops().map(|at| at.storage_difference().abs()));
    let losses = loops().filter_map(LoopModulus::loss_difference);
    [storage, largest(losses.map(f64::abs))].map(|share| scientific(100.0 * share, 3))
}

impl LoopModulus<'_> {
    /// Angular frequency (rad/s).
    pub fn omega(&self) -> f64 {
        self.record.angular_frequency_rad_per_s
    }

    /// Estimated error (Pa) of one of the moduli.
    pub fn error_pa(&self, quantity: Quantity) -> Option<f64> {
        let result = self.record.result.as_ref()?;
        result.errors.as_ref()?.of(quantity)
    }

    /// By how much the storage modulus of the loop differs from the material's, relative to it.
    pub fn storage_difference(&self) -> f64 {
        self.storage_pa / self.own_pa.re - 1.0
    }

    /// The same of the loss modulus; `None` where the material has none.
    pub fn loss_difference(&self) -> Option<f64> {
        (self.own_pa.im > 0.0).then(|| self.loss_pa / self.own_pa.im - 1.0)
    }
}

/// The table behind the moduli: all loops of a sweep, under all conditions.
pub fn table(plan: &SweepPlan, outcome: &Outcome, units: &Units) -> Vec<u8> {
    let mut columns = place_columns(plan.axes.as_ref());
    let numbers = [
        "angular_frequency_rad_per_s",
        "storage_modulus_pa",
        "storage_modulus_error_pa",
        "loss_modulus_pa",
        "loss_modulus_error_pa",
        "material_storage_modulus_pa",
        "material_loss_modulus_pa",
        "storage_relative_difference",
        "loss_relative_difference",
    ];
    columns.extend(numbers.map(str::to_owned));
    let curves = curves(plan, outcome, units);
    let loops = curves.iter();
    let rows = loops.flat_map(|curve| of_loops(curve)).map(|at| {
        let mut row = place_of(plan.axes.as_ref(), at.record);
        row.extend(cells![
            at.omega(),
            at.storage_pa,
            at.error_pa(Quantity::StorageModulus),
            at.loss_pa,
            at.error_pa(Quantity::LossModulus),
            at.own_pa.re,
            at.own_pa.im,
            at.storage_difference(),
            at.loss_difference(),
        ]);
        row
    });
    csv_leading(units.frequency_unit(), &columns, rows)
}

/// The table behind a figure that draws loops beside the material's line: of both, these two numbers.
pub fn pairs(
    equivalent: &Equivalent<'_>,
    own: &Line,
    [x, y]: [&str; 2],
    pair: impl Fn(Complex<f64>) -> [f64; 2],
    units: &Units,
) -> Vec<u8> {
    let loops = equivalent.loops.iter();
    let loops = loops.map(|at| ("loop", at.omega(), Complex::new(at.storage_pa, at.loss_pa)));
    let own = own
        .iter()
        .map(|(omega, modulus)| ("material", *omega, *modulus));
    let rows = loops.chain(own).map(|(kind, omega, modulus)| {
        let [x, y] = pair(modulus);
        cells![kind, omega, x, y]
    });
    let columns = ["kind", "angular_frequency_rad_per_s", x, y];
    csv_leading(units.frequency_unit(), &columns, rows)
}
