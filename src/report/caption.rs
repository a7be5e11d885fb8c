//! Captions: what a figure shows, of what, with which numbers, and how it was computed, as one paragraph to paste into a paper.

use super::number::{at_frequency, plain};
use super::words::{self, adhesion_line, compressibility, drive_line, range, row, varied_line};
use crate::engine::{EngineKind, SolverPlan};
use crate::indenter::{Indenter, Value};
use crate::material::Material;
use crate::material::dynamic::replicas::SIMULTANEOUS_DEVIATIONS;
use crate::quantity::Dimension;
use crate::simulation::SimulationOutcome;
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{Block, Method, SweepPlan, Varied};
use crate::sweep::search::run::Outcome;

/// What a figure itself has to say.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Caption {
    /// What is drawn, without a full stop.
    shows: String,
    /// Whole sentences: numbers, symbols, error bars.
    says: Vec<String>,
}

impl Caption {
    /// What is drawn, without a full stop.
    pub fn new(shows: impl Into<String>) -> Self {
        Self {
            shows: shows.into(),
            says: Vec::new(),
        }
    }

    /// Adds a sentence.
    #[must_use]
    pub fn say(mut self, sentence: impl Into<String>) -> Self {
        self.says.push(sentence.into());
        self
    }

    /// Adds sentences; an `Option` serves as well.
    #[must_use]
    pub fn say_all(mut self, sentences: impl IntoIterator<Item = String>) -> Self {
        self.says.extend(sentences);
        self
    }

    /// The paragraph, in one line.
    pub fn text(&self, setting: &Setting) -> String {
        let Setting { of, by } = setting;
        let mut text = match of.is_empty() {
            true => format!("{}.", self.shows),
            false => format!("{}: {of}.", self.shows),
        };
        for sentence in self.says.iter().chain(by) {
            text += " ";
            text += sentence;
        }
        text
    }
}

/// What all figures of a result have in common.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Setting {
    /// Material, indenter, drive.
    of: String,
    /// Sentences on engine, resolution, and units that are not SI.
    by: Vec<String>,
}

impl Setting {
    /// The setting of a sweep.
    pub fn of_sweep(plan: &SweepPlan, outcome: &Outcome, units: Option<String>) -> Self {
        // A cycle that is found directly has no beginning.
        let is_marched = plan.cycle.method == Method::March;
        let hold_s = Some(plan.base.drive.hold_s()).filter(|hold_s| *hold_s > 0.0 && is_marched);
        let rest = after_comma(hold_s.map(|hold_s| {
            let hold = plain(hold_s, Dimension::Time, 4);
            format!("after {hold} of rest under the mean")
        }));
        let attraction = after_comma(adhesion_line(plan.base.contact.adhesion));
        let swept = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
        let varied = after_comma(varied_line(plan));
        // What is drawn over another axis does not tell the frequency, where there is but one.
        let one = match (&plan.axes, plan.angular_frequencies_rad_per_s.as_slice()) {
            (Some(_), [omega]) => Some(at_frequency(plan.figures.frequency_unit, *omega, 4)),
            _ => None,
        };
        let one = after_comma(one);
        let of = format!(
            "{} on {}{}, {} (mean ± amplitude){one}{rest}{attraction}{varied}",
            words::each_of(plan, Block::Indenter, |name, c| {
                indenter(
                    (name, c.contact.indenter.as_ref()),
                    swept,
                    c.contact.material.indenter_material(),
                )
            }),
            words::each_of(plan, Block::Material, |_, c| material(&c.contact.material)),
            layer(plan.base.contact.layer, swept),
            drive_line(&plan.base.drive, plan)
        );
        let records = &outcome.records;
        let steps = range(records.iter().map(|record| record.steps as f64), 0);
        let nodes = range(records.iter().map(|record| record.nodes as f64), 0);
        let cycles = match plan.cycle.at_cycle {
            Some(number) => format!(
                "Cycle {number} from the beginning of the oscillation, not stabilised, a straight line taken off so that it closes"
            ),
            None => format!(
                "Stabilised cycles to a relative tolerance of {:e}",
                plan.cycle.tolerance
            ),
        };
        let computed = format!(
            "{cycles}, {steps} time steps per cycle, computed by {}.",
            engine(&plan.solver, &plan.base.contact, &nodes)
        );
        Self {
            of,
            by: units.into_iter().chain([computed]).collect(),
        }
    }

    /// The setting of a history.
    pub fn of_scenario(
        plan: &ScenarioPlan,
        outcome: &SimulationOutcome,
        units: Option<String>,
    ) -> Self {
        let contact = &plan.contact;
        let body = match contact.material.series() {
            Some(series) => material(series),
            None => "a material given by its samples".to_owned(),
        };
        let attraction = after_comma(adhesion_line(contact.adhesion));
        let of = format!(
            "{} on {body}{}, {} against time prescribed{attraction}",
            indenter(
                (None, contact.indenter.as_ref()),
                &[],
                contact.material.indenter_material()
            ),
            layer(contact.layer, &[]),
            plan.drive.control().name()
        );
        let computed = format!(
            "{} time steps, computed by {}.",
            outcome.rows.len(),
            engine(&plan.solver, contact, &plan.solver.nodes().to_string())
        );
        Self {
            of,
            by: units.into_iter().chain([computed]).collect(),
        }
    }

    /// The setting of a material alone.
    pub fn of_material(of: &Material) -> Self {
        Self {
            of: material(of),
            by: Vec::new(),
        }
    }
}

/// A further part of a sentence, where there is one.
fn after_comma(part: Option<String>) -> String {
    part.map_or(String::new(), |part| format!(", {part}"))
}

fn material(material: &Material) -> String {
    let is_elastic = material.creep().branches().is_empty() && !material.creep().is_fluid();
    let unnamed = match is_elastic {
        true => "an elastic material",
        false => "a viscoelastic material",
    };
    let name = material.name().unwrap_or(unnamed);
    format!("{name} ({})", compressibility(material))
}

/// The layer that the body is, with a blank before it, without what axes vary; nothing of a half-space.
pub(in crate::report) fn layer(layer: Option<LayerPlan>, swept: &[Varied]) -> String {
    let words = |layer: LayerPlan| layer.words(|key| is_swept(swept, Block::Layer, key));
    layer.map_or(String::new(), |layer| format!(" {}", words(layer)))
}

fn is_swept(swept: &[Varied], block: Block, key: &str) -> bool {
    let mut swept = swept.iter();
    swept.any(|varied| varied.block == block && varied.key == key)
}

/// The indenter, of a list with its name, without the numbers that axes vary.
fn indenter(
    (name, indenter): (Option<&str>, &dyn Indenter),
    swept: &[Varied],
    of: Option<&Material>,
) -> String {
    let mut shape = indenter.shape().replace('-', " ");
    if let Some(name) = name {
        shape = format!("{shape} “{name}”");
    }
    let shape = match of {
        Some(of) => format!("{shape} of {}", material(of)),
        None => format!("rigid {shape}"),
    };
    // Where a shape comes from is told by resolved.toml.
    let told = |value: &Value| {
        matches!(
            value,
            Value::Quantity(..) | Value::Number(_) | Value::Integer(_)
        )
    };
    let mut settings = indenter.parameters();
    settings.retain(|own| told(&own.value) && !is_swept(swept, Block::Indenter, &own.key));
    match settings.is_empty() {
        true => shape,
        false => format!("{shape} ({})", row(&settings)),
    }
}

fn engine<M>(solver: &SolverPlan, contact: &ContactPlan<M>, nodes: &str) -> String {
    match (solver.engine, contact.indenter.own_cells()) {
        (EngineKind::Axisymmetric, _) => {
            format!("the axisymmetric engine of contact-dma on {nodes} springs")
        }
        (EngineKind::HalfSpace, Some((x, y))) => {
            format!("the half-space engine of contact-dma on the {x} × {y} cells of the map")
        }
        (EngineKind::HalfSpace, None) => {
            format!("the half-space engine of contact-dma on {nodes} cells per side")
        }
    }
}

/// What error bars mean; nothing where there are none.
pub fn error_bars(plan: &SweepPlan, outcome: &Outcome) -> Option<String> {
    let nodes = match plan.solver.engine {
        EngineKind::Axisymmetric => "springs",
        EngineKind::HalfSpace => "cells",
    };
    let mut records = outcome.records.iter();
    let any = records.any(|record| record.energy_loss_error_j().is_some());
    any.then(|| {
        let distance = match plan.cycle.at_cycle {
            Some(_) => "",
            None => " and from the distance to the stabilised cycle",
        };
        let mut materials = plan.each_of(Block::Material).into_iter();
        let is_open = materials.any(|(_, condition)| !condition.contact.material.origin.alternatives.is_empty());
        let open = match is_open {
            true => ", plus the largest difference that other materials make which this one may be as well",
            false => "",
        };
        format!(
            "Error bars: estimated numerical error, from half and a quarter of the time steps and {nodes}{distance}{open}; bars shorter \
             than their symbol are not drawn."
        )
    })
}

/// What the band of the material means; nothing where there is none.
pub fn material_band(plan: &SweepPlan, outcome: &Outcome) -> Option<String> {
    let mut records = outcome.records.iter();
    let any = records.any(|record| record.energy_loss_material_error_j().is_some());
    any.then(|| {
        format!(
            "Shaded: simultaneous 95 % band of the curve from the uncertainty of the material, apart from the numerical error: \
             {SIMULTANEOUS_DEVIATIONS} times the root mean square difference that {} bootstrap samples make, series fitted to the same \
             data with other noise.",
            words::replicas(plan)
        )
    })
}

/// Cases that are absent from the curves; nothing where all are there.
pub fn absent(outcome: &Outcome) -> Option<String> {
    let records = outcome.records.iter();
    let (of, without) = (
        records.len(),
        records.filter(|record| record.result.is_none()),
    );
    let without = without.count();
    (without > 0).then(|| format!("{without} of {of} cases have no result and are absent."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caption_is_one_paragraph_of_whole_sentences() {
        let setting = Setting {
            of: "a sphere on PMMA".to_owned(),
            by: vec!["Computed.".to_owned()],
        };
        let caption = Caption::new("Loss").say("Largest: 3 µJ.").say_all(None);
        assert_eq!(
            caption.text(&setting),
            "Loss: a sphere on PMMA. Largest: 3 µJ. Computed."
        );
        assert_eq!(Caption::new("Loss").text(&Setting::default()), "Loss.");
    }
}
