//! A material as text, table and figures: its series both ways, its moduli over frequency, its peaks.

use serde_json::{Value, json};

use super::figure;
use super::figure::Figure;
use super::figure::moduli::ModulusPoint;
use super::number::{four_digits, range, six_digits};
use super::text::{Column, Table, Text};
use super::words;
use crate::material::fit::FitReport;
use crate::material::library;
use crate::material::{Creep, LossPeak, Material, MaterialError, MaterialFunction, Relaxation};
use crate::quantity::{Dimension, format_human};
use crate::sweep::plan::resolved;

/// A material with its functions as moduli of the kind it was given in.
pub struct MaterialReport<'a> {
    material: &'a Material,
    symbol: char,
}

impl<'a> MaterialReport<'a> {
    /// A report on this material.
    pub fn new(material: &'a Material) -> Self {
        let symbol = MaterialFunction::Relaxation.symbol(material.kind());
        Self { material, symbol }
    }

    /// Times of all branches, shortest and longest (s); those of one second where there are no branches.
    pub(super) fn time_range_s(&self) -> (f64, f64) {
        let relaxation = self.material.relaxation().map(Relaxation::branches);
        let relaxation = relaxation.unwrap_or_default().iter().map(|b| b.time_s);
        let retardation = self.material.creep().branches().iter().map(|b| b.time_s);
        let times = range(relaxation.chain(retardation));
        if times.1 > 0.0 { times } else { (1.0, 1.0) }
    }

    /// Moduli at `per_decade` frequencies per decade, from two decades below to two above the reciprocal times.
    pub fn moduli(&self, per_decade: usize) -> Vec<ModulusPoint> {
        let (shortest, longest) = self.time_range_s();
        // Powers of ten that are doubles.
        let within = |power: f64| power.clamp(-307.0, 307.0) as i32;
        let first = within((-longest.log10() - 2.0).floor());
        let last = within((-shortest.log10() + 2.0).ceil());
        let count = (last - first).max(1) as usize * per_decade;
        (0..=count)
            .map(|i| {
                let omega = 10_f64.powf(f64::from(first) + i as f64 / per_decade as f64);
                let creep = self.material.creep();
                // A modulus of the series as given is accurate where its creep function is stiff, and the reverse.
                let modulus = match self.material.relaxation() {
                    Some(relaxation) => relaxation.complex_modulus(omega),
                    None => creep.complex_modulus(omega),
                };
                let compliance = creep.complex_compliance(omega);
                ModulusPoint {
                    angular_frequency_rad_per_s: omega,
                    storage_modulus_pa: modulus.re,
                    loss_modulus_pa: modulus.im,
                    storage_compliance_per_pa: compliance.re,
                    loss_compliance_per_pa: -compliance.im,
                }
            })
            .collect()
    }

    /// Relaxation modulus and creep compliance from 0 to past the end of relaxation, where there is a relaxation modulus.
    fn relaxation_curve(&self) -> Option<Vec<(f64, f64, f64)>> {
        let relaxation = self.material.relaxation()?;
        let times = relaxation.branches().iter().map(|branch| branch.time_s);
        let longest = times.fold(0.0, f64::max);
        let longest = if longest > 0.0 { longest } else { 1.0 };
        // Eight relaxation times, rounded up to one digit: 1000 s for PMMA.
        let span = 8.0 * longest;
        let power = 10_f64.powf(span.log10().floor());
        let end = (span / power).ceil() * power;
        let creep = self.material.creep();
        let times = (0..=400).map(|i| end * f64::from(i) / 400.0);
        let point = |t| (t, relaxation.modulus(t), creep.compliance(t));
        Some(times.map(point).collect())
    }

    /// The figures: moduli over frequency, relaxation modulus over time.
    pub fn figures(&self) -> Vec<Figure> {
        let mut figures = vec![figure::moduli::figure(&self.moduli(20), self.symbol)];
        if let Some(curve) = self.relaxation_curve() {
            figures.push(figure::relaxation::figure(&curve, self.symbol));
        }
        figures
    }

    /// The Poisson ratio, or the bulk modulus and how the Poisson ratio goes with time.
    fn compressibility(&self) -> Result<Text, MaterialError> {
        let mut line = words::compressibility(self.material);
        line.replace_range(..1, &line[..1].to_uppercase());
        let mut text = Text::from(line);
        if self.material.poisson_ratio().is_none() {
            let relaxation = self.material.relaxation().into_iter();
            let times = relaxation.flat_map(|r| r.branches().iter().map(|b| b.time_s));
            let columns = [
                Column::right("t / s", 12),
                Column::left("Poisson ratio in a relaxation test", 0),
            ];
            let mut table = Table::new(2, columns);
            for time_s in [0.0].into_iter().chain(times).chain([f64::INFINITY]) {
                let nu = self.material.poisson_ratio_at(time_s)?;
                table.row([six_digits(time_s), format!("{nu:.4}")]);
            }
            text.blank();
            text.append(table);
        }
        Ok(text)
    }

    /// The text: series, limits, table, peaks.
    ///
    /// # Errors
    /// What the conversion of the material refuses.
    pub fn text(&self) -> Result<Text, MaterialError> {
        let symbol = self.symbol;
        let kind = self.material.kind();
        let compliance = MaterialFunction::Creep.symbol(kind);
        let kind = kind.name();
        let mut text = self.compressibility()?;
        text.append(format!("\nRelaxation modulus ({kind}; MPa, s)"));
        text.append(match self.material.relaxation() {
            Some(relaxation) => relaxation_lines(symbol, relaxation),
            None => {
                "  none: without an instantaneous compliance it has an impulse at t = 0".to_owned()
            }
        });
        let creep = self.material.creep();
        text.append(format!("\nCreep compliance ({kind}; 1/MPa, s)"));
        text.append(creep_lines(compliance, creep));
        text.append("\nShear creep function J(t)/2 (1/MPa, s)");
        text.append(creep_lines('Φ', &self.material.shear_creep_function()?));
        text.blank();
        text.append(moduli_table(symbol, compliance, &self.moduli(2)));
        let peaks = self.material.loss_peaks(self.material.kind())?;
        text.append("\nPeaks over angular frequency");
        let modulus = |value| format_human(value, Dimension::Stress, 5);
        let per_mpa = |value: f64| format!("{:.4e} 1/MPa", value * 1e6);
        let tangent = |value| format!("{value:.4}");
        let (e, d) = (format!("{symbol}″"), format!("{compliance}″"));
        text.append(peak_lines(&e, &peaks.loss_modulus, modulus));
        text.append(peak_lines(&d, &peaks.loss_compliance, per_mpa));
        text.append(peak_lines("tan δ", &peaks.loss_tangent, tangent));
        Ok(text)
    }
}

fn relaxation_lines(symbol: char, relaxation: &Relaxation) -> String {
    let mpa = |pa: f64| six_digits(pa * 1e-6);
    let mut text = format!("  {symbol}(t) = {}", mpa(relaxation.equilibrium_modulus()));
    for branch in relaxation.branches() {
        let (modulus, time) = (mpa(branch.modulus_pa), six_digits(branch.time_s));
        text.push_str(&format!("\n       + {modulus} exp(-t / {time})"));
    }
    let at_once = mpa(relaxation.instantaneous_modulus());
    text + &format!("\n  {symbol}(0) = {at_once} MPa")
}

fn creep_lines(symbol: char, creep: &Creep) -> String {
    let per_mpa = |per_pa: f64| format!("{:.4e}", per_pa * 1e6);
    // As the paper writes it where that is there: equilibrium less what is still to come.
    let equilibrium = creep.equilibrium_compliance();
    let first = equilibrium.unwrap_or(creep.instantaneous_compliance());
    let mut text = format!("  {symbol}(t) = {}", per_mpa(first));
    for branch in creep.branches() {
        let (compliance, time) = (per_mpa(branch.compliance_per_pa), six_digits(branch.time_s));
        let rate = six_digits(branch.time_s.recip());
        text.push_str(&match equilibrium {
            Some(_) => {
                format!("\n       - {compliance} exp(-{rate} t)    retardation time {time} s")
            }
            None => format!("\n       + {compliance} (1 - exp(-t / {time}))"),
        });
    }
    if let Some(viscosity) = creep.viscosity_pa_s().filter(|_| equilibrium.is_none()) {
        text.push_str(&format!(
            "\n       + t / {} MPa s",
            six_digits(viscosity * 1e-6)
        ));
    }
    text
}

fn moduli_table(symbol: char, compliance: char, points: &[ModulusPoint]) -> Table {
    let columns = [
        Column::right("ω / rad/s", 11),
        Column::right(format!("{symbol}′ / MPa"), 11),
        Column::right(format!("{symbol}″ / MPa"), 11),
        Column::right("tan δ", 9),
        Column::right(format!("{compliance}′ / 1/MPa"), 11),
        Column::right(format!("{compliance}″ / 1/MPa"), 11),
    ];
    let mut table = Table::new(2, columns);
    for p in points {
        table.row([
            four_digits(p.angular_frequency_rad_per_s),
            six_digits(p.storage_modulus_pa * 1e-6),
            six_digits(p.loss_modulus_pa * 1e-6),
            format!("{:.3e}", p.loss_modulus_pa / p.storage_modulus_pa),
            format!("{:.4e}", p.storage_compliance_per_pa * 1e6),
            format!("{:.4e}", p.loss_compliance_per_pa * 1e6),
        ]);
    }
    table
}

fn peak_lines(name: &str, peaks: &[LossPeak], value: fn(f64) -> String) -> String {
    if peaks.is_empty() {
        return format!("  {name}: none\n");
    }
    let line = |peak: &LossPeak| {
        let omega = six_digits(peak.angular_frequency_rad_per_s);
        format!("  {name} = {} at ω = {omega} rad/s\n", value(peak.value))
    };
    peaks.iter().map(line).collect()
}

/// The library: every material with what is said of it.
pub fn library() -> Text {
    let mut text = Text::default();
    for entry in library::entries() {
        text.line(format!("{}    {}", entry.name, entry.title));
        text.append(about(entry));
    }
    text
}

/// What the library says of a material, set in by four.
pub fn about(entry: &library::LibraryEntry) -> Text {
    let mut text = Text::default();
    text.indented(entry.notes, "    ", "    ");
    text.indented(format!("Source: {}", entry.source), "    ", "    ");
    text
}

/// A material: its series both ways, moduli over frequency, peaks of its losses, its fit where it has one.
///
/// # Errors
/// What the conversion of the material refuses.
pub fn to_json(material: &Material) -> Result<Value, MaterialError> {
    let peaks = material.loss_peaks(material.kind());
    Ok(json!({
        "name": material.name(),
        "poisson_ratio": material.poisson_ratio(),
        "bulk_modulus_pa": material.compressibility().constant_bulk_modulus_pa(),
        "modulus": material.kind().name(),
        "relaxation": material.relaxation(),
        "creep": material.creep(),
        "moduli": MaterialReport::new(material).moduli(10),
        "peaks": peaks?,
        "fit": material.origin.fit.as_ref().map(fit_json),
        "approximation": material.origin.approximation.as_ref(),
        "material_toml": resolved::material_text(material),
    }))
}

/// How well a series fits its table.
pub fn fit_json(report: &FitReport) -> Value {
    let remarks = report
        .remarks
        .iter()
        .map(|remark| json!({ "text": remark.to_string(), "is_warning": remark.is_warning() }));
    json!({
        "samples": report.samples,
        "first_s": report.first_s,
        "last_s": report.last_s,
        "branches": report.branches,
        "relative_misfit": report.misfit,
        "remarks": remarks.collect::<Vec<_>>(),
    })
}
