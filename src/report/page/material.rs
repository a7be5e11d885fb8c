//! The page of a material: its moduli over frequency, its function over time, and, where it was fitted, the data.

use maud::{Markup, html};
use serde::Serialize;

use super::compact::{picked, rounded, spread};
use super::frame::{Frame, Input, MODULI, PLOT};
use super::sweep_data::MaterialData;
use super::{Pictures, moduli, question};
use crate::material::fit::Fit;
use crate::material::tabulated::Tabulated;
use crate::material::{Material, MaterialFunction};
use crate::report::ReportError;
use crate::report::material::MaterialReport;
use crate::report::number::range;
use crate::sweep::plan::resolved;

const SCRIPT: &str = include_str!("material.js");
/// Points of a curve over time, and samples shown at most.
const POINTS: usize = 200;
const SAMPLES: usize = 1000;

#[derive(Serialize)]
struct Data {
    kind: &'static str,
    material: MaterialData,
    label: &'static str,
    unit: &'static str,
    curves: Vec<Curve>,
}

#[derive(Serialize)]
struct Curve {
    name: &'static str,
    /// Points that no line joins.
    scatter: bool,
    time_s: Vec<f64>,
    values: Vec<f64>,
}

/// What a page says of a material besides what the material itself knows.
pub struct About<'a> {
    pub title: &'a str,
    /// Where it comes from.
    pub text: &'a str,
    /// The `[material]` block that gives it again.
    pub block: &'a str,
    /// The figures that have gone by, and the name of the one for a reader without script.
    pub pictures: &'a Pictures,
    pub figure: &'a str,
    /// The data it was fitted to.
    pub fit: Option<(&'a Tabulated, &'a Fit)>,
}

/// The page.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn page(material: &Material, about: &About<'_>) -> Result<String, ReportError> {
    let main = html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "The material" }
            (described(material, about.text))
            (question::material(material))
            div id="material" class="live" { h3 { "Moduli over frequency" } (moduli("grid")) }
            h3 class="live" { "Over time" }
            div class="live controls" role="group" aria-label="Axes" {
                label { input type="checkbox" id="log-x" checked; " log t" }
                label { input type="checkbox" id="log-y"; " log values" }
            }
            div id="over-time" class="live plot tall" {}
            (about.pictures.still(about.figure, "There is nothing to draw."))
        }
        (about.pictures.gallery(&[about.figure]))
    };
    let function = match about.fit {
        Some((table, _)) => table.function(),
        None => material.function(),
    };
    let (label, unit) = match function {
        MaterialFunction::Relaxation => ("relaxation modulus", "Pa"),
        MaterialFunction::Creep => ("creep compliance", "1/Pa"),
    };
    let frame = Frame {
        title: about.title,
        asked: format!("{label} over time, complex modulus over frequency"),
        main,
        input: Input::of_file(
            ("exactly this input", resolved::hash(about.block)),
            ("material.toml", about.block),
            "The material as a block of a sweep file, every number exact. \
             <code>contact-dma material show material.toml</code> shows it again.",
        ),
        script: &[PLOT, MODULI, SCRIPT],
    };
    frame.page(&Data {
        kind: "material",
        material: MaterialData::of(material),
        label,
        unit,
        curves: curves(material, about.fit),
    })
}

/// The text in paragraphs; nothing where the list of facts holds the same, line by line.
fn described(material: &Material, text: &str) -> Markup {
    let lines = text.replace("Source:", "\u{0}Source:");
    let paragraphs = lines.split('\u{0}').map(str::trim);
    let is_told = |paragraph: &&str| !paragraph.is_empty() && material.origin.fit.is_none();
    html! { @for paragraph in paragraphs.filter(is_told) { p { (paragraph) } } }
}

/// The data and their fit, or the function alone, at times evenly spread in their logarithm.
fn curves(material: &Material, fit: Option<(&Tabulated, &Fit)>) -> Vec<Curve> {
    let times = |from: f64, to: f64| -> Vec<f64> {
        let step = (to / from).ln() / POINTS as f64;
        (0..=POINTS)
            .map(|k| from * (step * k as f64).exp())
            .collect()
    };
    let curve = |name, times: Vec<f64>, value: &dyn Fn(f64) -> f64| Curve {
        name,
        scatter: false,
        values: times.iter().map(|t| rounded(value(*t))).collect(),
        time_s: times.into_iter().map(rounded).collect(),
    };
    if let Some((table, fit)) = fit {
        let places = spread(table.times_s().len(), SAMPLES);
        let data = Curve {
            name: "data",
            scatter: true,
            time_s: picked(table.times_s(), &places),
            values: picked(table.values(), &places),
        };
        let positive = table.times_s().iter().copied().filter(|t| *t > 0.0);
        let (from, to) = range(positive);
        let fitted = curve("fit", times(from, to), &|t| fit.series().value(t));
        return vec![data, fitted];
    }
    let (shortest, longest) = MaterialReport::new(material).time_range_s();
    let times = times(0.01 * shortest, 100.0 * longest);
    vec![match (material.function(), material.relaxation()) {
        (MaterialFunction::Relaxation, Some(relaxation)) => {
            curve("relaxation modulus", times, &|t| relaxation.modulus(t))
        }
        _ => curve("creep compliance", times, &|t| {
            material.creep().compliance(t)
        }),
    }]
}
