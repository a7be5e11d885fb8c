//! What is reported of laws that were found from force curves: lines for people, tables, the summary.

use serde_json::{Map, Value, json};

use crate::force_curve::resolved::{CurvesPlan, resolved_text};
use crate::force_curve::{CurveError, CurveFit, Drawn, Estimate, FittedLaw, ForceCurve};
use crate::identify::ModulusBand;
use crate::material::law::{Form, Law, Scale};
use crate::material::{Material, ModulusKind};
use crate::quantity::{Dimension, format_human};
use crate::report::dynamic::tables::prony;
use crate::report::identify::tables::{MODULI, over, with_ends};
use crate::report::number::scientific;
use crate::report::table::{Cell, cells, csv};
use crate::report::text::{Column, Table, Text};
use crate::report::words::listed;
use crate::sweep::plan::resolved::material_text;
use crate::sweep::store::files::{DATA, Place};

/// The table of moduli over frequency.
const MODULI_TABLE: Place<'_> = Place::Figure("moduli", DATA);

/// The weight from which another law explains the curve as well.
const NEARLY: f64 = 0.05;

/// Laws of curves and what they came to.
pub struct CurvesReport<'a> {
    pub plan: &'a CurvesPlan,
    /// In the order of the curves.
    pub fits: &'a [Result<CurveFit, CurveError>],
}

/// A curve that was fitted.
#[derive(Clone, Copy)]
pub struct Found<'a> {
    pub curve: &'a ForceCurve,
    pub fit: &'a CurveFit,
}

impl<'a> CurvesReport<'a> {
    /// The curves that were fitted.
    pub fn found(&self) -> impl Iterator<Item = Found<'a>> + use<'a> {
        let all = self.plan.curves.iter().zip(self.fits);
        all.filter_map(|(curve, fit)| {
            Some(Found {
                curve,
                fit: fit.as_ref().ok()?,
            })
        })
    }

    /// The curve, where there is one alone.
    pub fn single(&self) -> Option<Found<'a>> {
        self.found().next().filter(|_| self.fits.len() == 1)
    }

    /// Names of curves that were not fitted, and why.
    pub fn missing(&self) -> Vec<(&'a str, &'a CurveError)> {
        let all = self.plan.curves.iter().zip(self.fits);
        all.filter_map(|(curve, fit)| Some((&curve.name[..], fit.as_ref().err()?)))
            .collect()
    }

    /// Every file of the folder but figures and page; `block` is the `[material]` block, where there is one.
    pub fn files(&self, block: Option<&str>) -> Vec<(String, Vec<u8>)> {
        let top = |name, bytes| (Place::Top(name).to_string(), bytes);
        let summary = format!("{:#}\n", self.summary());
        let mut files = vec![
            top("resolved.toml", resolved_text(self.plan).into_bytes()),
            top("curves.csv", self.table()),
            top("fit.csv", self.fitted_points()),
            top("summary.json", summary.into()),
            (MODULI_TABLE.to_string(), self.moduli()),
        ];
        files.extend(block.map(|block| top("material.toml", block.into())));
        if self.found().any(|found| !found.fit.ensemble.is_empty()) {
            files.push(top("ensemble.csv", self.ensemble()));
        }
        let series = self.single().and_then(|found| found.fit.series());
        files.extend(series.map(|series| top("prony.csv", prony(&series))));
        files
    }

    /// The `[material]` block of a sweep file, below title and findings as comments; `None` of several curves.
    pub fn block(&self) -> Option<String> {
        let fit = self.single()?.fit;
        let (kind, known) = (ModulusKind::Longitudinal, &self.plan.fit.compressibility);
        let mut body = Material::from_relaxation(fit.series()?, kind, known.clone()).ok()?;
        let (lowest, highest) = fit.window_rad_per_s;
        body.origin.measured_window_s = Some((1.0 / highest, 1.0 / lowest));
        let drawn = fit.ensemble.iter();
        let replica =
            |drawn: &Drawn| Material::from_relaxation(drawn.series.clone(), kind, known.clone());
        body.origin.replicas = drawn.map(replica).collect::<Result<_, _>>().ok()?;
        let mut text = Text::from(self.plan.title.as_str());
        text.append(self.text());
        Some(text.as_comments() + &material_text(&body))
    }

    /// What was found.
    pub fn text(&self) -> Text {
        self.lines().into_iter().collect()
    }

    /// The same, one fact a line.
    pub fn lines(&self) -> Vec<String> {
        match self.single() {
            Some(found) => lines_of(&found),
            None => self.lines_of_many(),
        }
    }

    fn lines_of_many(&self) -> Vec<String> {
        let mut counts: Vec<(String, usize)> = Vec::new();
        for found in self.found() {
            let law = found.fit.law().form.in_words();
            match counts.iter_mut().find(|(other, _)| *other == law) {
                Some((_, count)) => *count += 1,
                None => counts.push((law, 1)),
            }
        }
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let laws: Vec<String> = counts
            .into_iter()
            .map(|(law, count)| format!("{law} {count}"))
            .collect();
        let mut lines = vec![
            format!(
                "{} of {} curves were fitted.",
                self.found().count(),
                self.fits.len()
            ),
            format!("Laws: {}.", listed(&laws)),
        ];
        let missing = self.missing();
        lines.extend(
            missing
                .iter()
                .take(5)
                .map(|(name, why)| format!("Warning: {name}: {why}.")),
        );
        if missing.len() > 5 {
            lines.push(format!(
                "Warning: {} more curves were not fitted: see curves.csv.",
                missing.len() - 5
            ));
        }
        lines
    }

    /// The parameters of a single curve with their intervals.
    pub fn parameters(&self) -> Option<Table> {
        let found = self.single()?;
        let columns = [
            Column::left("", 24),
            Column::right("value", 13),
            Column::left("95 % interval", 0),
        ];
        let mut table = Table::new(2, columns);
        for (name, estimate, dimension) in named(found.fit) {
            let value = |value: f64| match dimension {
                Some(dimension) => format_human(value, dimension, 4),
                None => scientific(value, 4),
            };
            let interval = format!("{} to {}", value(estimate.low), value(estimate.high));
            table.row([in_words(&name, dimension), value(estimate.value), interval]);
        }
        Some(table)
    }

    /// `curves.csv`: a row for every curve.
    fn table(&self) -> Vec<u8> {
        let columns = [
            "curve",
            "x_m",
            "y_m",
            "status",
            "law",
            "law_weight",
            "angular_frequency_rad_per_s",
            "storage_modulus_pa",
            "storage_modulus_low_pa",
            "storage_modulus_high_pa",
            "loss_modulus_pa",
            "loss_modulus_low_pa",
            "loss_modulus_high_pa",
            "contact_point_m",
            "contact_point_low_m",
            "contact_point_high_m",
            "reduced_chi_squared",
            "message",
        ];
        let rows = self.plan.curves.iter().zip(self.fits).map(|(curve, fit)| {
            let [x_m, y_m] = match curve.place_m {
                Some((x_m, y_m)) => [Some(x_m), Some(y_m)],
                None => [None; 2],
            };
            let mut row = vec![Cell::from(curve.name.clone()), x_m.into(), y_m.into()];
            match fit {
                Err(error) => {
                    row.push(Cell::from("failed".to_owned()));
                    row.extend((0..13).map(|_| Cell::from(None::<f64>)));
                    row.push(Cell::from(error.to_string()));
                    row
                }
                Ok(fit) => {
                    let omega = middle(fit);
                    let band = fit.band(omega);
                    let values = band.map(|band| with_ends(omega, &band).map(Some));
                    let contact = fit.contact_point_m;
                    row.extend([
                        Cell::from("converged".to_owned()),
                        Cell::from(fit.law().form.in_words()),
                        Cell::from(fit.law().weight),
                    ]);
                    row.extend(values.unwrap_or([None; 7]).map(Cell::from));
                    row.extend([
                        Cell::from(contact.value),
                        Cell::from(contact.low),
                        Cell::from(contact.high),
                        Cell::from(fit.reduced_chi_squared),
                        Cell::from(String::new()),
                    ]);
                    row
                }
            }
        });
        csv(&columns, rows)
    }

    /// `fit.csv`: every point as measured and as computed.
    fn fitted_points(&self) -> Vec<u8> {
        let columns = [
            "curve",
            "time_s",
            "indentation_m",
            "force_n",
            "force_error_n",
            "computed_n",
        ];
        let rows = self.found().flat_map(|Found { curve, fit }| {
            (0..fit.computed_n.len()).map(|k| {
                cells![
                    curve.name.clone(),
                    fit.points.time_s[k],
                    fit.points.indentation_m[k],
                    fit.points.force_n[k],
                    fit.error_n[k],
                    fit.computed_n[k],
                ]
            })
        });
        csv(&columns, rows)
    }

    /// `ensemble.csv`: the moduli of every sample, at both ends of the window and in the middle.
    fn ensemble(&self) -> Vec<u8> {
        let columns = [
            "curve",
            "sample",
            "law",
            "contact_point_m",
            "angular_frequency_rad_per_s",
            "storage_modulus_pa",
            "loss_modulus_pa",
        ];
        let rows = self.found().flat_map(|Found { curve, fit }| {
            let (low, high) = fit.window_rad_per_s;
            let samples = fit.ensemble.iter().enumerate();
            samples.flat_map(move |(number, drawn)| {
                [low, middle(fit), high].into_iter().map(move |omega| {
                    let modulus = drawn.complex_modulus_pa(omega);
                    cells![
                        curve.name.clone(),
                        number + 1,
                        drawn.form.in_words(),
                        drawn.contact_point_m,
                        omega,
                        modulus.map(|modulus| modulus.re),
                        modulus.map(|modulus| modulus.im),
                    ]
                })
            })
        });
        csv(&columns, rows)
    }

    /// `moduli.csv`: E' and E'' with their 95 % bands, over the curve and a little beyond; of several curves each by its name.
    pub fn moduli(&self) -> Vec<u8> {
        let is_single = self.single().is_some();
        let name = (!is_single).then_some("curve");
        let columns: Vec<&str> = name.into_iter().chain(MODULI).collect();
        let rows = self.found().flat_map(|Found { curve, fit }| {
            bands(fit).into_iter().map(move |(omega, band)| {
                let name = (!is_single).then(|| Cell::from(curve.name.clone()));
                let values = with_ends(omega, &band).map(Cell::from);
                name.into_iter().chain(values).collect::<Vec<Cell>>()
            })
        });
        csv(&columns, rows)
    }

    /// The summary as an object; what is undefined is null.
    pub fn summary(&self) -> Value {
        let mut summary = match self.single() {
            Some(found) => of_curve(&found),
            None => {
                let curves = self.plan.curves.iter().zip(self.fits).map(|(curve, fit)| match fit {
                    Ok(fit) => Value::Object(of_curve(&Found { curve, fit })),
                    Err(error) => json!({ "curve": curve.name, "status": "failed", "message": error.to_string() }),
                });
                let mut all = Map::new();
                all.insert("curves".into(), curves.collect());
                all
            }
        };
        let known = &self.plan.fit.compressibility;
        for (key, value) in [
            ("title", json!(self.plan.title)),
            ("of", json!("force-curves")),
            ("laws_asked", json!(self.plan.laws)),
            ("fitted", json!(self.found().count())),
            ("failed", json!(self.missing().len())),
            ("poisson_ratio", json!(known.poisson_ratio())),
            ("bulk_modulus_pa", json!(known.constant_bulk_modulus_pa())),
            ("program", json!(env!("CARGO_PKG_NAME"))),
            ("program_version", json!(env!("CARGO_PKG_VERSION"))),
        ] {
            summary.insert(key.to_owned(), value);
        }
        Value::Object(summary)
    }
}

/// The frequency (rad/s) in the middle of what a curve says something about.
pub fn middle(fit: &CurveFit) -> f64 {
    (fit.window_rad_per_s.0 * fit.window_rad_per_s.1).sqrt()
}

/// Moduli with their bands, over the window of a curve and a little beyond.
pub fn bands(fit: &CurveFit) -> Vec<(f64, ModulusBand)> {
    let omegas = over(fit.window_rad_per_s).into_iter();
    omegas
        .filter_map(|omega| Some((omega, fit.band(omega)?)))
        .collect()
}

/// Everything that was found with its interval: parameters of the law, contact point, what the instrument adds.
pub fn named(fit: &CurveFit) -> Vec<(String, Estimate, Option<Dimension>)> {
    let law = fit.law();
    let parameters = law.form.parameters().into_iter().zip(&law.parameters);
    let mut all: Vec<(String, Estimate, Option<Dimension>)> = parameters
        .map(|(parameter, estimate)| {
            let dimension = match parameter.scale {
                Scale::Logarithm(dimension) => Some(dimension),
                Scale::Odds => None,
            };
            (parameter.name, *estimate, dimension)
        })
        .collect();
    all.push((
        "contact_point_m".to_owned(),
        fit.contact_point_m,
        Some(Dimension::Length),
    ));
    let nuisances = fit.nuisances.iter();
    all.extend(
        nuisances.map(|(nuisance, estimate)| {
            (nuisance.name().to_owned(), *estimate, nuisance.dimension())
        }),
    );
    all
}

/// A name without its unit, which stands with the value.
fn in_words(name: &str, dimension: Option<Dimension>) -> String {
    let of_drift = name.strip_suffix("_n_per_s");
    if let Some(drift) = of_drift {
        return format!("{} / (N/s)", drift.replace('_', " "));
    }
    let unit = name.rfind('_').filter(|_| dimension.is_some());
    let drag = name.find("_n_s_per_m").or(unit);
    name[..drag.unwrap_or(name.len())].replace('_', " ")
}

fn lines_of(Found { curve, fit }: &Found<'_>) -> Vec<String> {
    let law = fit.law();
    let mut lines = Vec::new();
    if fit.inflation > 1.0 {
        lines.push(format!(
            "Warning: the law misses the curve: chi squared per degree of freedom is {}, and all intervals are {} times as wide as the \
             noise says. Indenter, units, spring constant, adhesion or a thin specimen may be the cause.",
            scientific(fit.reduced_chi_squared, 2),
            scientific(fit.inflation, 2)
        ));
    }
    lines.push(format!(
        "Curve {}: {} samples, taken as {} points; noise of a sample {}; chi squared per degree of freedom {}.",
        curve.name,
        curve.time_s.len(),
        fit.points.time_s.len(),
        format_human(fit.points.noise_n, Dimension::Force, 2),
        scientific(fit.reduced_chi_squared, 2)
    ));
    let others = fit
        .laws
        .iter()
        .skip(1)
        .filter(|other| other.weight > NEARLY);
    let others: Vec<String> = others
        .map(|other| {
            format!(
                "{} ({})",
                other.form.in_words(),
                scientific(other.weight, 2)
            )
        })
        .collect();
    let chosen = format!(
        "Law: {} (weight {})",
        law.form.in_words(),
        scientific(law.weight, 2)
    );
    lines.push(match (others.is_empty(), fit.laws.len()) {
        (_, 1) => format!("Law: {}, as asked for.", law.form.in_words()),
        (true, _) => format!("{chosen}; the curve tells it from all others that were tried."),
        (false, _) => format!(
            "{chosen}; the curve does not tell it from {}. The bands of the moduli hold what these say.",
            listed(&others)
        ),
    });
    lines.push(formula(law.form).to_owned());
    let (lowest, highest) = fit.window_rad_per_s;
    let [from, to] =
        [lowest, highest].map(|omega| format_human(omega, Dimension::AngularFrequency, 3));
    lines.push(format!(
        "The contact lasts for what \u{3c9} = {from} to {to} are; outside, the law is an extrapolation."
    ));
    if !fit.ensemble.is_empty() {
        lines.push(format!(
            "Ensemble: the law fitted {} times with the noise drawn anew; each is a replica of the material, from which a sweep has a band \
             about its loss.",
            fit.ensemble.len()
        ));
    }
    if fit.is_pulled {
        lines.push(
            "Note: the retraction pulls, as no law without attraction does: it is left out."
                .to_owned(),
        );
    }
    if fit.nuisances.is_empty() {
        lines.push(
            "Note: there is no part before contact: offset, drift and drag are taken as none."
                .to_owned(),
        );
    }
    lines
}

/// What the parameters are of, in words.
fn formula(form: Form) -> &'static str {
    match form.law {
        Law::PowerLaw => "E* = modulus (i\u{3c9} \u{b7} 1 s)^exponent, Young's modulus.",
        Law::StandardSolid => "E(t) = equilibrium + modulus exp(-t/time), Young's modulus.",
        Law::FractionalZener => {
            "E* = equilibrium + modulus (i\u{3c9} time)^exponent / (1 + (i\u{3c9} time)^exponent), Young's modulus."
        }
        Law::FractionalMaxwell => {
            "E* = modulus (i\u{3c9} time)^a / (1 + (i\u{3c9} time)^(a - b)), a = exponent, b = exponent_ratio a, Young's modulus."
        }
        Law::KelvinVoigt => {
            "E* = equilibrium + modulus (i\u{3c9} \u{b7} 1 s)^exponent, Young's modulus."
        }
        Law::Kww => "E(t) = equilibrium + modulus exp(-(t/time)^exponent), Young's modulus.",
        Law::Series => "E(t) = equilibrium + sum of modulus_i exp(-t/time_i), Young's modulus.",
    }
}

fn of_curve(Found { curve, fit }: &Found<'_>) -> Map<String, Value> {
    let estimate = |estimate: &Estimate| json!({ "value": estimate.value, "low": estimate.low, "high": estimate.high });
    let law = fit.law();
    let names = law.form.parameters().into_iter().map(|p| p.name);
    let parameters: Map<String, Value> = names.zip(law.parameters.iter().map(estimate)).collect();
    let laws = fit.laws.iter().map(|law: &FittedLaw| {
        json!({
            "law": law.form.law.name(),
            "branches": (law.form.law == Law::Series).then_some(law.form.branches),
            "weight": law.weight,
            "schwarz": law.schwarz,
            "chi_squared": law.chi_squared,
        })
    });
    let nuisances: Map<String, Value> = (fit.nuisances.iter())
        .map(|(nuisance, value)| (nuisance.name().to_owned(), estimate(value)))
        .collect();
    let others = fit.laws.iter().skip(1).any(|other| other.weight > NEARLY);
    let moduli = bands(fit).into_iter().map(|(omega, band)| {
        let values = with_ends(omega, &band).map(Value::from);
        let names = MODULI.map(str::to_owned);
        names
            .into_iter()
            .zip(values)
            .collect::<Map<String, Value>>()
    });
    let value = json!({
        "curve": curve.name,
        "status": "converged",
        "law": law.form.law.name(),
        "laws": laws.collect::<Vec<_>>(),
        "law_is_told_from_others": !others,
        "parameters": parameters,
        "contact_point_m": estimate(&fit.contact_point_m),
        "instrument": nuisances,
        "samples": curve.time_s.len(),
        "ensemble": fit.ensemble.len(),
        "points": fit.points.time_s.len(),
        "noise_n": fit.points.noise_n,
        "degrees_of_freedom": fit.degrees_of_freedom,
        "reduced_chi_squared": fit.reduced_chi_squared,
        "intervals_widened_by": fit.inflation,
        "retraction_left_out": fit.is_pulled,
        "window_rad_per_s": fit.window_rad_per_s,
        "moduli": moduli.collect::<Vec<_>>(),
    });
    match value {
        Value::Object(object) => object,
        _ => Map::new(),
    }
}
