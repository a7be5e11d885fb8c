//! The page of one history: what it carries for its script, and what it says without.

use maud::{Markup, html};
use serde::Serialize;

use super::answer::warned;
use super::compact::{CoarseCells, coarse, picked, picked_optional, rounded, spread};
use super::how;
use super::question::{self, Facts};
use super::sweep_data::MaterialData;
use super::{Pictures, moduli, scroll, section};
use crate::contact::surface::{CellSurface, Surface};
use crate::quantity::Dimension;
use crate::report::caption;
use crate::report::number::{plain, with_error};
use crate::report::profile_lines;
use crate::report::quantities::{CYCLES, Column};
use crate::report::words;
use crate::simulation::body_material::BodyMaterial;
use crate::simulation::cycles::HistoryCycle;
use crate::simulation::outside_model;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::work::HistoryWork;
use crate::simulation::{HistoryRow, SimulationEnd, SimulationOutcome, SurfaceRecord};

/// Moments of the history that the page carries.
const MOMENTS: usize = 1500;
/// Points of a profile, and cells along a side of a map: of few maps, and of many.
const POINTS: usize = 160;
const FEW: usize = 4;
const CELLS: [usize; 2] = [96, 64];

/// Everything the script of the page knows.
#[derive(Serialize)]
pub(super) struct SimulationData {
    kind: &'static str,
    history: History,
    /// What profiles run along: r or x.
    line: String,
    profiles: Vec<Profile>,
    fields: Vec<Field>,
    material: Option<MaterialData>,
}

#[derive(Serialize)]
struct History {
    time_s: Vec<f64>,
    load_n: Vec<f64>,
    approach_m: Vec<Option<f64>>,
    contact_radius_m: Vec<f64>,
    peak_pressure_pa: Vec<Option<f64>>,
}

#[derive(Serialize)]
struct Profile {
    time_s: f64,
    position_m: Vec<f64>,
    pressure_pa: Vec<Option<f64>>,
    displacement_m: Vec<f64>,
}

#[derive(Serialize)]
struct Field {
    time_s: f64,
    load_n: f64,
    #[serde(flatten)]
    cells: CoarseCells,
    pressure_pa: Vec<Option<f64>>,
    displacement_m: Vec<Option<f64>>,
}

impl SimulationData {
    /// The data of a history, as far as it came.
    pub(super) fn new(
        plan: &ScenarioPlan,
        outcome: &SimulationOutcome,
        profiles: &[profile_lines::Profile],
    ) -> Self {
        let first = profiles.first().and_then(|profile| profile.lines.first());
        let fields = &outcome.fields;
        let cells = CELLS[usize::from(fields.len() > FEW)];
        Self {
            kind: "simulation",
            history: history(&outcome.rows),
            line: first.map_or("r", |(line, _)| line).to_owned(),
            profiles: profiles.iter().filter_map(profile).collect(),
            fields: fields.iter().filter_map(|f| field(f, cells)).collect(),
            material: plan.contact.material.series().map(MaterialData::of),
        }
    }
}

fn history(rows: &[HistoryRow]) -> History {
    // Both sides of a jump stay: a spread may pass one of them over.
    let mut places = spread(rows.len(), MOMENTS);
    for (i, pair) in rows.windows(2).enumerate() {
        if pair[0].time_s == pair[1].time_s {
            places.extend([i, i + 1]);
        }
    }
    places.sort_unstable();
    places.dedup();
    let numbers = |value: fn(&HistoryRow) -> f64| {
        picked(&rows.iter().map(value).collect::<Vec<_>>(), &places)
    };
    let optional = |value: fn(&HistoryRow) -> Option<f64>| {
        picked_optional(&rows.iter().map(value).collect::<Vec<_>>(), &places)
    };
    History {
        time_s: numbers(|row| row.time_s),
        load_n: numbers(|row| row.load_n),
        approach_m: optional(|row| row.approach_m),
        contact_radius_m: numbers(|row| row.contact_radius_m),
        peak_pressure_pa: optional(|row| row.peak_pressure_pa),
    }
}

fn profile(record: &profile_lines::Profile) -> Option<Profile> {
    let (_, points) = record.lines.first()?;
    let places = spread(points.len(), POINTS);
    let kept = || places.iter().filter_map(|&i| points.get(i));
    Some(Profile {
        time_s: record.row.time_s,
        position_m: kept().map(|p| rounded(p.position_m)).collect(),
        pressure_pa: kept().map(|p| p.pressure_pa.map(rounded)).collect(),
        displacement_m: kept().map(|p| rounded(p.displacement_m)).collect(),
    })
}

fn field(record: &SurfaceRecord, cells: usize) -> Option<Field> {
    let Surface::Cells(CellSurface {
        grid,
        pressure_pa,
        displacement_m,
    }) = &record.surface
    else {
        return None;
    };
    let value = |values: &[f64], i: usize| values.get(i).copied();
    let of = |all: &[f64]| coarse(grid.cells_x(), all.len(), |i| value(all, i), cells);
    let pressure = of(pressure_pa);
    Some(Field {
        time_s: record.row.time_s,
        load_n: rounded(record.row.load_n),
        cells: pressure.cells(
            [grid.x_m(0), grid.y_m(0)],
            [grid.spacing_x_m(), grid.spacing_y_m()],
        ),
        pressure_pa: pressure.values,
        displacement_m: of(displacement_m).values,
    })
}

/// The sections of the page.
pub(super) fn sections(
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
    pictures: &Pictures,
) -> Markup {
    html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "The history" }
            (answer(plan, outcome))
            (problems(outcome))
            (warned(outside_model::warnings(plan, outcome)))
            div id="load" class="live plot" {}
            div id="approach" class="live plot" {}
            div class="live grid" { div id="radius" class="plot" {} div id="pressure" class="plot" {} }
            h3 class="live" { "Load against approach" }
            div id="loop" class="live plot" {}
            (pictures.still("history", "The history has no two times: there is nothing to draw."))
        }
        (cycles(outcome, pictures))
        (surface())
        (pictures.gallery(&["history", "cycle-losses"]))
        (section("asked-heading", "What was asked", html! {
            (question(plan))
            div id="material" class="live" { h3 { "Moduli of the material" } (moduli("grid")) }
        }))
        (section("how-heading", "How the numbers were obtained", how(plan, outcome)))
    }
}

/// Cycles in the table, at most: the first ones and the last.
const TABLE: usize = 40;

/// The cycles of sine segments; nothing where there are none.
fn cycles(outcome: &SimulationOutcome, pictures: &Pictures) -> Markup {
    let shown: Vec<&Column<HistoryCycle>> =
        CYCLES.iter().filter(|c| c.error_name().is_some()).collect();
    let all = &outcome.cycles;
    if all.is_empty() {
        return Markup::default();
    }
    let last = (TABLE / 2).max(all.len().saturating_sub(TABLE / 2));
    let rows = all.iter().take(TABLE / 2).chain(all.iter().skip(last));
    let cell = |column: &Column<HistoryCycle>, cycle: &HistoryCycle| {
        let value = column.number(cycle).zip(column.dimension);
        value.map_or_else(String::new, |(value, dimension)| {
            with_error(value, column.error(cycle), dimension)
        })
    };
    let table = html! {
        table {
            thead { tr {
                th scope="col" { "segment" } th scope="col" { "cycle" }
                @for column in &shown { th scope="col" { (column.heading) } }
            } }
            tbody { @for cycle in rows { tr {
                td { (cycle.segment) } td { (cycle.number) }
                @for column in &shown { td { (cell(column, cycle)) } }
            } } }
        }
    };
    let content = html! {
        (pictures.still("cycle-losses", "No segment has two cycles to draw."))
        (scroll("Cycles", table))
        @if all.len() > TABLE { p { "The first and the last of " (all.len()) " cycles; all are in cycles.csv." } }
    };
    section("cycles-heading", "Cycle by cycle", content)
}

/// Profiles and fields, which the script fills.
fn surface() -> Markup {
    html! {
        section aria-labelledby="profiles-heading" class="live" id="profiles" {
            h2 id="profiles-heading" { "Along the surface" }
            div class="controls" role="group" aria-label="Choice of the profile" {
                label { "Time " select id="profile" {} }
                label { input type="checkbox" id="all-profiles" checked; " the other times too" }
            }
            div class="grid" {
                div id="profile-pressure" class="plot" {}
                div id="profile-displacement" class="plot" {}
            }
        }
        section aria-labelledby="fields-heading" class="live" id="fields" {
            h2 id="fields-heading" { "Over the surface" }
            div class="controls" role="group" aria-label="Choice of the field" {
                label { "Time " input type="range" id="field-time" min="0" value="0" step="1"; }
                label {
                    "Field "
                    select id="field" {
                        option value="pressure_pa" { "pressure" }
                        option value="displacement_m" { "displacement" }
                    }
                }
            }
            p id="field-spoken" aria-live="polite" {}
            div id="map" class="plot" {}
        }
    }
}

/// One line: material, indenter, drive.
pub(super) fn line(plan: &ScenarioPlan) -> String {
    let material = plan.contact.material.series();
    let name = material.and_then(|material| material.name());
    format!(
        "{}{}, under a {}; {} over {}",
        name.unwrap_or("A material of its own"),
        caption::layer(plan.contact.layer, &[]),
        plan.contact.indenter.shape(),
        plan.drive.control().name(),
        plain(plan.drive.duration_s(), Dimension::Time, 5)
    )
}

/// The largest values, as a list.
fn answer(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> Markup {
    let largest = |value: fn(&HistoryRow) -> Option<f64>| {
        let values = outcome.rows.iter().filter_map(value);
        values.reduce(f64::max)
    };
    let force = largest(|r| Some(r.load_n));
    let approach = largest(|r| r.approach_m);
    let radius = largest(|r| Some(r.contact_radius_m));
    let pressure = largest(|r| r.peak_pressure_pa);
    let end = outcome.rows.last().map(|r| r.time_s);
    let mut facts = Facts::default();
    for (name, value, dimension) in [
        ("largest load", force, Dimension::Force),
        ("largest approach", approach, Dimension::Length),
        ("largest contact radius", radius, Dimension::Length),
        ("largest peak pressure", pressure, Dimension::Stress),
        ("end", end, Dimension::Time),
    ] {
        let text = value.map(|value| plain(value, dimension, 5));
        facts.add(name, text.as_deref().unwrap_or("nowhere defined"));
    }
    if let Some(work) = HistoryWork::of(plan, outcome) {
        facts.add("work of the indenter", words::work(&work));
    }
    if let Some(separation) = &outcome.separation {
        facts.add("separation", words::separation(separation));
    }
    facts.html()
}

/// Why the history is not whole; nothing where it is.
fn problems(outcome: &SimulationOutcome) -> Markup {
    let why = match &outcome.ended {
        SimulationEnd::Done => return Markup::default(),
        SimulationEnd::Interrupted => "The history was interrupted.".to_owned(),
        SimulationEnd::Failed(message) => format!("The history ends early: {message}"),
    };
    html! { div class="problems" { p { (why) } } }
}

/// What was asked.
fn question(plan: &ScenarioPlan) -> Markup {
    let contact = &plan.contact;
    let material = match &contact.material {
        BodyMaterial::Series(material) => question::material(material),
        BodyMaterial::Samples(_) => {
            html! { p { "Samples of a measured function, taken as they are: see the input below." } }
        }
    };
    let mut drive = Facts::default();
    drive.add("control", plan.drive.control().name());
    drive.add("segments", plan.drive.segments().len());
    let duration = plain(plan.drive.duration_s(), Dimension::Time, 6);
    drive.add("duration", duration);
    let dimension = plan.drive.control().dimension();
    drive.add("largest value", plain(plan.drive.maximum(), dimension, 6));
    if let Some(attraction) = words::adhesion_line(contact.adhesion) {
        drive.add("attraction", attraction);
    }
    question::parts(
        html! { (material) (question::body(contact.layer)) },
        question::indenter_body(contact.indenter.as_ref(), contact.material.series()),
        drive.html(),
    )
}

/// How the numbers were obtained.
fn how(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> Markup {
    let mut facts = Facts::default();
    let nodes = plan.solver.nodes().to_string();
    how::engine(&mut facts, &plan.solver, &plan.contact, &nodes);
    facts.add("time steps", outcome.rows.len());
    facts.add("contact iterations", outcome.iterations);
    let half_width = plain(outcome.domain_half_width_m, Dimension::Length, 4);
    facts.add("half width of the domain", half_width);
    facts.html()
}
