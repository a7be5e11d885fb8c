//! What is reported of laws that were found from force curves: lines for people, tables, the summary.

pub mod summary;
pub mod tables;

use rayon::prelude::*;
use serde_json::Value;

use crate::force_curve::resolved::{CurvesPlan, resolved_text};
use crate::force_curve::{CurveError, CurveFit, ForceCurve};
use crate::identify::ModulusBand;
use crate::identify::laws::Drawn;
use crate::material::{Material, ModulusKind};
use crate::quantity::{Dimension, format_human};
use crate::report::dynamic::tables::prony;
use crate::report::identify::tables::over;
use crate::report::laws::{Named, laws_in_words, named, table};
use crate::report::number::scientific;
use crate::report::text::{Table, Text};
use crate::report::words::listed;
use crate::sweep::plan::resolved::material_text;
use crate::sweep::store::files::{DATA, Place};

/// The table of moduli over frequency.
const MODULI_TABLE: Place<'_> = Place::Figure("moduli", DATA);

/// What is sought of an attraction: its name with the unit, as tables call it, in words, and its dimension.
const ATTRACTION: [(&str, &str, Dimension); 2] = [
    (
        "work_j_per_m2",
        "work of adhesion",
        Dimension::EnergyPerArea,
    ),
    ("range_m", "range of the attraction", Dimension::Length),
];

/// Laws of curves and what they came to.
pub struct CurvesReport<'a> {
    pub plan: &'a CurvesPlan,
    /// In the order of the curves.
    curves: Vec<(&'a ForceCurve, Result<Found<'a>, &'a CurveError>)>,
}

/// A curve that was fitted.
pub struct Found<'a> {
    pub curve: &'a ForceCurve,
    pub fit: &'a CurveFit,
    /// Moduli with their bands over angular frequencies (rad/s): the window of the curve and a little beyond.
    pub bands: Vec<(f64, ModulusBand)>,
}

impl<'a> Found<'a> {
    fn new(curve: &'a ForceCurve, fit: &'a CurveFit) -> Self {
        let omegas = over(fit.window_rad_per_s).into_iter();
        let bands = omegas.filter_map(|omega| Some((omega, fit.laws.band(omega)?)));
        Self {
            curve,
            fit,
            bands: bands.collect(),
        }
    }

    /// The frequency (rad/s) in the middle of what the curve says something about.
    pub fn middle(&self) -> f64 {
        (self.fit.window_rad_per_s.0 * self.fit.window_rad_per_s.1).sqrt()
    }

    /// Everything that was found with its interval: parameters of the law, contact point, what the instrument adds.
    pub fn named(&self) -> Vec<Named> {
        let parameters = named(self.fit.laws.best());
        let contact_point = Named {
            name: "contact_point_m".to_owned(),
            words: "contact point".to_owned(),
            estimate: self.fit.contact_point_m,
            dimension: Some(Dimension::Length),
        };
        let attraction = ATTRACTION.iter().zip(&self.fit.attraction);
        let attraction = attraction.map(|((name, words, dimension), estimate)| Named {
            name: (*name).to_owned(),
            words: (*words).to_owned(),
            estimate: *estimate,
            dimension: Some(*dimension),
        });
        let nuisances = self.fit.nuisances.iter();
        let nuisances = nuisances.map(|(nuisance, estimate)| Named {
            name: nuisance.name().to_owned(),
            words: nuisance.words().to_owned(),
            estimate: *estimate,
            dimension: nuisance.dimension(),
        });
        parameters
            .into_iter()
            .chain([contact_point])
            .chain(attraction)
            .chain(nuisances)
            .collect()
    }
}

impl<'a> CurvesReport<'a> {
    /// Of the fits of the curves of a plan, in their order.
    pub fn new(plan: &'a CurvesPlan, fits: &'a [Result<CurveFit, CurveError>]) -> Self {
        let curves = plan.curves.par_iter().zip(fits);
        let curves = curves.map(|(curve, fit)| {
            let found = fit.as_ref().map(|fit| Found::new(curve, fit));
            (curve, found)
        });
        Self {
            plan,
            curves: curves.collect(),
        }
    }

    /// The curves, each as it was fitted or why it was not.
    pub fn curves(&self) -> &[(&'a ForceCurve, Result<Found<'a>, &'a CurveError>)] {
        &self.curves
    }

    /// The curves that were fitted.
    pub fn found(&self) -> impl Iterator<Item = &Found<'a>> {
        self.curves
            .iter()
            .filter_map(|(_, found)| found.as_ref().ok())
    }

    /// The curve, where there is one alone.
    pub fn single(&self) -> Option<&Found<'a>> {
        self.found().next().filter(|_| self.curves.len() == 1)
    }

    /// Names of curves that were not fitted, and why.
    pub fn missing(&self) -> Vec<(&'a str, &'a CurveError)> {
        let all = self.curves.iter();
        let all = all.filter_map(|(curve, found)| Some((&curve.name[..], *found.as_ref().err()?)));
        all.collect()
    }

    /// Every file of the folder but figures and page; `block` is the `[material]` block, where there is one.
    pub fn files(&self, summary: &Value, block: Option<&str>) -> Vec<(String, Vec<u8>)> {
        let top = |name, bytes| (Place::Top(name).to_string(), bytes);
        let mut files = vec![
            top("resolved.toml", resolved_text(self.plan).into_bytes()),
            top("curves.csv", tables::curves(self)),
            top("fit.csv", tables::points(self)),
            top("summary.json", format!("{summary:#}\n").into()),
            (MODULI_TABLE.to_string(), tables::moduli(self)),
        ];
        files.extend(block.map(|block| top("material.toml", block.into())));
        if self.found().any(|found| !found.fit.ensemble.is_empty()) {
            files.push(top("ensemble.csv", tables::ensemble(self)));
        }
        let series = self.single().and_then(|found| found.fit.laws.series());
        files.extend(series.map(|series| top("prony.csv", prony(&series))));
        files
    }

    /// The `[material]` block of a sweep file, below title and findings as comments; `None` of several curves.
    pub fn block(&self) -> Option<String> {
        let fit = self.single()?.fit;
        let (kind, known) = (
            ModulusKind::Longitudinal,
            &self.plan.fit.contact.material.compressibility,
        );
        let mut body = Material::from_relaxation(fit.laws.series()?, kind, known.clone()).ok()?;
        let (lowest, highest) = fit.window_rad_per_s;
        body.origin.measured_window_s = Some((1.0 / highest, 1.0 / lowest));
        let drawn = fit.ensemble.iter();
        let replica = |(drawn, _): &(Drawn, f64)| {
            Material::from_relaxation(drawn.series.clone(), kind, known.clone())
        };
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
            Some(found) => lines_of(found, self.plan.fit.contact.adhesion.is_some()),
            None => self.lines_of_many(),
        }
    }

    fn lines_of_many(&self) -> Vec<String> {
        let mut counts: Vec<(String, usize)> = Vec::new();
        for found in self.found() {
            let law = found.fit.laws.best().form.in_words();
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
                self.curves.len()
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
        Some(table(&found.named()))
    }
}

fn lines_of(found: &Found<'_>, is_attracted: bool) -> Vec<String> {
    let Found { curve, fit, .. } = found;
    let mut lines = Vec::new();
    let laws = &fit.laws;
    if laws.inflation > 1.0 {
        lines.push(format!(
            "Warning: the law misses the curve: chi squared per degree of freedom is {}, and all intervals are {} times as wide as the \
             noise says. Indenter, units, spring constant, adhesion or a thin specimen may be the cause.",
            scientific(laws.reduced_chi_squared, 2),
            scientific(laws.inflation, 2)
        ));
    }
    lines.push(format!(
        "Curve {}: {} samples, taken as {} points; noise of a sample {}; chi squared per degree of freedom {}.",
        curve.name,
        curve.time_s.len(),
        fit.points.time_s.len(),
        format_human(fit.points.noise_n, Dimension::Force, 2),
        scientific(laws.reduced_chi_squared, 2)
    ));
    lines.extend(laws_in_words(laws, "the curve", 'E'));
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
        let left_out = match is_attracted {
            true => {
                "Note: what follows the largest pull, while the contact tears off, is left out."
            }
            false => {
                "Note: the retraction pulls, as no law without attraction does: it is left out; with `[adhesion]` it is not."
            }
        };
        lines.push(left_out.to_owned());
    }
    if fit.nuisances.is_empty() {
        lines.push(
            "Note: there is no part before contact: offset, drift and drag are taken as none."
                .to_owned(),
        );
    }
    lines
}
