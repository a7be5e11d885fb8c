//! Figure 7: the surface under a load put on at once, held and taken off at once. A Maxwell half-space keeps its dashpot's
//! part of the dent; a Zener half-space recovers.

use std::sync::atomic::AtomicBool;

use super::by_engine::{By, simulate};
use super::claim::Value;
use super::look::{Member, evenly, spread};
use super::number::{datum, optional_datum};
use super::scale::{ProfilePoint, at, largest};
use super::{Claim, Figure, Measure, Plans, ReproductionError, Scale, Stated, series_of};
use crate::reference::step_load::StepLoad;
use crate::report::chart::{Axis, Chart, LegendPlace, Series};
use crate::report::table::Table;
use crate::sweep::history::SimulationOutcome;

/// When the load is taken off, in tau; the last instant under load is written as a time just before.
const UNLOADED: f64 = 2.0;
/// How far the profiles are drawn, in Hertz radii.
const REACH: f64 = 1.5;

/// One half-space.
struct Body {
    name: &'static str,
    part: char,
    /// A place outside the contact throughout (Hertz radii).
    outside: f64,
    times: Vec<f64>,
    cells: usize,
    scale: Scale,
    exact: StepLoad,
    springs: SimulationOutcome,
    on_cells: SimulationOutcome,
}

/// The figure.
pub(super) fn figures(
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let bodies = [
        body(
            plans,
            "figure-07-maxwell",
            ("Maxwell", 'a', 1.45),
            interrupt,
        )?,
        body(plans, "figure-07-zener", ("Zener", 'b', 1.35), interrupt)?,
    ];
    let columns = [
        "half_space",
        "time_tau",
        "state",
        "source",
        "radius_a_h",
        "displacement_delta_h",
    ];
    let mut table = Table::new("figure-07.csv", &columns)?;
    let (mut panels, mut claims) = (Vec::new(), Vec::new());
    for body in &bodies {
        panels.push(body.panel(&mut table)?);
        claims.extend(body.claims());
    }
    Ok(vec![Figure {
        number: 7,
        caption: "Surface displacement under a step load that is taken off at 2 τ; (a) Maxwell, (b) Zener half-space. Lines: \
                  closed form. Symbols: computed."
            .to_owned(),
        panels,
        data: table.finish()?,
        claims,
        statements: Vec::new(),
    }])
}

fn body(
    plans: &Plans,
    file: &'static str,
    (name, part, outside): (&'static str, char, f64),
    interrupt: &AtomicBool,
) -> Result<Body, ReproductionError> {
    let plan = plans.scenario(file)?;
    let load_n = plan.drive.maximum();
    let scale = Scale::new(series_of(plan)?, plan.indenter.as_ref(), load_n)?;
    Ok(Body {
        name,
        part,
        outside,
        times: plan.output.profiles_at_s.clone(),
        cells: plan.solver.cells,
        exact: StepLoad::new(
            scale.sphere_radius_m,
            load_n,
            scale.contact_compliance.clone(),
        )?,
        springs: simulate(plan, By::Springs, interrupt)?,
        on_cells: simulate(plan, By::Cells, interrupt)?,
        scale,
    })
}

impl Body {
    /// Displacement by the closed form, normalised; `None` where that form is not defined.
    fn displacement(&self, radius: f64, time: f64) -> Option<f64> {
        let r_m = radius * self.scale.contact_radius_m;
        let found_m = if time < UNLOADED {
            Some(self.exact.displacement_m(r_m, time))
        } else {
            let since = time - UNLOADED;
            self.exact
                .displacement_after_unloading_m(r_m, UNLOADED, since)
        };
        Some(found_m? / self.scale.approach_m)
    }

    fn profile(&self, outcome: &SimulationOutcome, k: usize) -> Vec<ProfilePoint> {
        let record = outcome.profiles.get(k);
        let mut profile =
            record.map_or_else(Vec::new, |record| self.scale.profile(&record.surface));
        profile.retain(|point| point.radius <= REACH);
        profile
    }

    fn panel(&self, table: &mut Table) -> Result<Chart, ReproductionError> {
        let mut series: Vec<Series> = Vec::new();
        for (k, &time) in self.times.iter().enumerate() {
            let member = Member {
                step: k,
                of: self.times.len(),
            };
            let points = |profile: Vec<ProfilePoint>| -> Vec<(f64, Option<f64>)> {
                let pairs = profile.iter().map(|p| (p.radius, Some(p.displacement)));
                spread(&pairs.collect::<Vec<_>>(), 16)
            };
            let line: Vec<(f64, Option<f64>)> = evenly(0.0, REACH, 60)
                .into_iter()
                .map(|r| (r, self.displacement(r, time)))
                .collect();
            let springs = points(self.profile(&self.springs, k));
            let cells = points(self.profile(&self.on_cells, k));
            let state = if time < UNLOADED {
                "loaded"
            } else {
                "unloaded"
            };
            for (source, points) in [
                ("closed form", &line),
                ("axisymmetric", &springs),
                ("half-space", &cells),
            ] {
                for (r, u) in points {
                    let ([time, r], u) = ([time, *r].map(datum), optional_datum(*u));
                    let row = [
                        self.name.to_owned(),
                        time,
                        state.to_owned(),
                        source.to_owned(),
                        r,
                        u,
                    ];
                    table.row(&row)?;
                }
            }
            let [line, springs, cells] = [line, springs, cells].map(drawn);
            series.push(member.line(line).label(label(time)));
            series.extend(member.engines(springs, cells, self.cells));
        }
        let axis = format!("({}) displacement u / Hertz approach", self.part);
        Ok(Chart::new(
            Axis::linear("radial coordinate r / Hertz radius").range(0.0, REACH),
            Axis::linear(axis),
        )
        .all_series(series)
        .legend(LegendPlace::Right)
        .size(900, 520))
    }

    fn claims(&self) -> Vec<Claim> {
        let mut claims = Vec::new();
        for (k, &time) in self.times.iter().enumerate().skip(1) {
            let [springs, cells] = [&self.springs, &self.on_cells].map(|o| self.profile(o, k));
            let displacement = |radius: f64, place: &str| Claim {
                figure: 7,
                quantity: format!("{}: displacement / δ_H {place}, {}", self.name, label(time)),
                exact: Value::ClosedForm(self.displacement(radius, time)),
                axisymmetric: at(&springs, radius, |p| Some(p.displacement)),
                half_space: at(&cells, radius, |p| Some(p.displacement)),
                measure: Measure::absolute("of δ_H", 2e-3, 5e-3),
                stated: Stated::default(),
                note: String::new(),
            };
            let outside = self.outside;
            let places = [
                displacement(0.0, "on the axis"),
                displacement(outside, &format!("at r = {outside} a_H")),
            ];
            let deviation = |profile: &[ProfilePoint]| {
                let every = (profile.len() / 30).max(1);
                let differences = profile
                    .iter()
                    .step_by(every)
                    .map(|p| Some((p.displacement - self.displacement(p.radius, time)?).abs()));
                largest(differences)
            };
            let anywhere = Claim {
                exact: Value::Difference,
                axisymmetric: deviation(&springs),
                half_space: deviation(&cells),
                ..displacement(
                    0.0,
                    "inside and outside the contact to 1.5 a_H, largest error",
                )
            };
            // Before the last instant under load the displacement is that of Hertz.
            if time > 1.9 {
                claims.extend(places);
            }
            claims.push(anywhere);
        }
        claims.extend(self.what_is_left());
        claims
    }

    /// How the dent on the axis changes from just after unloading to the end.
    fn what_is_left(&self) -> Option<Claim> {
        let first = self.times.iter().position(|t| *t >= UNLOADED)?;
        let last = self.times.len() - 1;
        let left = |outcome: &SimulationOutcome| {
            let on_axis = |k| at(&self.profile(outcome, k), 0.0, |p| Some(p.displacement));
            Some(on_axis(last)? / on_axis(first)?)
        };
        let time = self.times.get(last)?;
        let on_axis = |time| self.displacement(0.0, time);
        let exact = on_axis(*time)
            .zip(on_axis(UNLOADED))
            .map(|(after, before)| after / before);
        Some(Claim {
            figure: 7,
            quantity: format!(
                "{}: dent at {time} τ over the dent just after unloading",
                self.name
            ),
            exact: Value::ClosedForm(exact),
            axisymmetric: left(&self.springs),
            half_space: left(&self.on_cells),
            measure: Measure::relative(exact, 1e-9, 1e-9),
            stated: Stated::default(),
            note: "nothing is solved after unloading: the memory alone decides".to_owned(),
        })
    }
}

/// Points with a value absent where the y is.
fn drawn(points: Vec<(f64, Option<f64>)>) -> Vec<Option<(f64, f64)>> {
    points.into_iter().map(|(x, y)| Some((x, y?))).collect()
}

fn label(time: f64) -> String {
    match time {
        0.0 => "t = 0 (Hertz)".to_owned(),
        1.0 => "t = τ".to_owned(),
        UNLOADED => "t = 2 τ, load just off".to_owned(),
        t if t > 1.9 && t < UNLOADED => "t = 2 τ, load still on".to_owned(),
        t if t > UNLOADED => format!("t = {t} τ, load off"),
        t => format!("t = {t} τ"),
    }
}
