//! The equivalent moduli of the loops beside the material's own: the data of four figures.

use num_complex::Complex;

use super::Figure;
use super::curve::{Curve, SweepCurves};
use crate::material::Material;
use crate::quantity::FrequencyUnit;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Series};
use crate::report::number::{largest, scientific};
use crate::report::table::{cells, csv_leading};
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::record::{CaseRecord, CaseResult};

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
        let material = &curve.condition.contact.material;
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
    let material = &curve.condition.contact.material;
    let of_loop = |(record, result): (&'a CaseRecord, &CaseResult)| {
        let omega = record.angular_frequency_rad_per_s;
        Some(LoopModulus {
            record,
            storage_pa: result.storage_modulus_pa?,
            loss_pa: result.loss_modulus_pa?,
            own_pa: material.longitudinal_complex_modulus(omega),
        })
    };
    curve.results().into_iter().filter_map(of_loop).collect()
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

    /// Both moduli (Pa).
    pub fn modulus(&self) -> Complex<f64> {
        Complex::new(self.storage_pa, self.loss_pa)
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
pub fn table(sweep: &SweepCurves<'_>) -> Vec<u8> {
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
    let rows = sweep.curves.iter().flat_map(of_loops).map(|at| {
        let numbers = cells![
            at.omega(),
            at.storage_pa,
            at.error_pa(Quantity::StorageModulus),
            at.loss_pa,
            at.error_pa(Quantity::LossModulus),
            at.own_pa.re,
            at.own_pa.im,
            at.storage_difference(),
            at.loss_difference(),
        ];
        (sweep.place_of(at.record), numbers)
    });
    sweep.table(&[], &numbers, rows)
}

/// A figure that draws the loops as symbols beside the material's line.
pub struct Diagram<'a> {
    pub name: &'static str,
    /// What it shows, for its caption.
    pub shows: &'a str,
    pub x: Axis,
    pub y: Axis,
    /// Of the material, which moduli are drawn.
    pub own: &'a Line,
    /// Where a modulus (Pa) at an angular frequency (rad/s) is drawn.
    pub place: &'a dyn Fn(f64, Complex<f64>) -> Option<(f64, f64)>,
    /// The numbers that stand for it in the data, and their columns.
    pub numbers: fn(Complex<f64>) -> [f64; 2],
    pub columns: [&'static str; 2],
}

impl Diagram<'_> {
    /// The figure.
    pub fn figure(self, equivalent: &Equivalent<'_>, unit: FrequencyUnit) -> Figure {
        let loops = equivalent.loops.iter();
        let loops: Line = loops.map(|at| (at.omega(), at.modulus())).collect();
        let points = |line: &Line| {
            let points = line
                .iter()
                .map(|(omega, modulus)| (self.place)(*omega, *modulus));
            points.collect::<Vec<_>>()
        };
        let chart = Chart::new(self.x, self.y)
            .maybe_title(equivalent.title.clone())
            .series(Series::line(points(self.own)).label("material"))
            .series(symbols(points(&loops)).label("from the loops").color(1));
        let rows = [("loop", &loops), ("material", self.own)];
        let rows = rows.into_iter().flat_map(|(kind, line)| {
            let numbers = &self.numbers;
            line.iter().map(move |(omega, modulus)| {
                let [x, y] = numbers(*modulus);
                cells![kind, *omega, x, y]
            })
        });
        let [x, y] = self.columns;
        let columns = ["kind", "angular_frequency_rad_per_s", x, y];
        Figure {
            name: self.name,
            picture: chart.into(),
            caption: equivalent.caption(self.shows),
            data: csv_leading(unit, &columns, rows),
        }
    }
}
