//! Figures 4, 5 and 7: a load put on at once and held, on a Maxwell and on a Zener half-space. Figures 4 and 5 show its
//! pressure and, beside figure 5, the same history driven by its approach; figure 7 shows the surface, also after the load is
//! taken off at once: a Maxwell half-space keeps its dashpot's part of the dent, a Zener half-space recovers.

use std::sync::atomic::{AtomicBool, Ordering};

use super::by_engine::both;
use super::curves::{Member, curve, spread};
use super::number::Data;
use super::scale::{ProfilePoint, Scale, at, largest};
use super::{
    ByEngine, Claim, Figure, Measure, Plans, ReproductionError, Result, Source, series_of,
};
use crate::contact::Prescribed;
use crate::contact::surface::Surface;
use crate::engine::EngineKind;
use crate::engine::{EngineBuilder, LargestContact};
use crate::history::March;
use crate::reference::step_load::StepLoad;
use crate::report::chart::{Axis, Chart, LegendPlace, Series};
use crate::report::table::{Cell, cells};
use crate::simulation::SimulationOutcome;
use crate::simulation::scenario::ScenarioPlan;

/// A history of one load, by both engines, beside its closed form.
struct Held<'a> {
    plan: &'a ScenarioPlan,
    times: &'a [f64],
    scale: Scale,
    exact: StepLoad,
    /// Springs, cells.
    computed: [SimulationOutcome; 2],
    /// How far profiles are looked at, in Hertz radii.
    reach: f64,
}

/// How near to the edge of the contact, in cells, a pressure need not be right.
const EDGE_CELLS: f64 = 2.0;

/// When the load of figure 7 is taken off, in tau; the last instant under load is written as a time just before.
const UNLOADED: f64 = 2.0;

impl<'a> Held<'a> {
    fn new(plan: &'a ScenarioPlan, reach: f64, interrupt: &AtomicBool) -> Result<Self> {
        let load_n = plan.drive.maximum();
        let scale = Scale::new(series_of(plan)?, plan.contact.indenter.as_ref(), load_n)?;
        let compliance = scale.contact_compliance.clone();
        Ok(Self {
            plan,
            times: &plan.output.profiles_at_s,
            exact: StepLoad::new(scale.sphere_radius_m, load_n, compliance)?,
            computed: both(plan, interrupt)?,
            scale,
            reach,
        })
    }

    /// Side of a cell in Hertz radii.
    fn cell(&self) -> f64 {
        let [_, on_cells] = &self.computed;
        let side_m = 2.0 * on_cells.domain_half_width_m / self.plan.solver.cells as f64;
        side_m / self.scale.contact_radius_m
    }

    /// Contact radius of the closed form, normalised as all that follows.
    fn radius(&self, time: f64) -> f64 {
        self.exact.contact_radius_m(time) / self.scale.contact_radius_m
    }

    /// Pressure by the closed form.
    fn pressure(&self, radius: f64, time: f64) -> f64 {
        let r_m = radius * self.scale.contact_radius_m;
        self.exact.pressure_pa(r_m, time) / self.scale.pressure_pa
    }

    /// Displacement by the closed form; `None` where that form is not defined.
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

    /// The computed surfaces at one of the times: springs, cells.
    fn profiles(&self, k: usize) -> [Vec<ProfilePoint>; 2] {
        [0, 1].map(|engine| {
            let record = self.computed[engine].profiles.get(k);
            let mut profile = record.map_or_else(Vec::new, |r| self.scale.profile(&r.surface));
            profile.retain(|point| point.radius <= self.reach);
            profile
        })
    }

    /// Curves at one of the times: rows of the data behind these cells, series of a chart.
    fn curves<Y: Copy + Into<Cell> + Into<Option<f64>>>(
        &self,
        (k, label): (usize, String),
        data: &mut Data,
        before: &[Cell],
        curves: ByEngine<Vec<(f64, Y)>>,
    ) -> [Series; 3] {
        let of = self.times.len();
        let member = Member { step: k, of };
        let mut rows = |source: &str, points: &[(f64, Y)]| {
            data.points(&[before, &cells![source]].concat(), points);
        };
        rows("closed form", &curves.exact);
        rows("axisymmetric", &curves.axisymmetric);
        rows("half-space", &curves.half_space);
        // A value is absent where its y is.
        let point = |(x, y): (f64, Y)| Some((x, Into::<Option<f64>>::into(y)?));
        let drawn = curves.map(|points| points.into_iter().map(point).collect());
        let line = member.line(drawn.exact).label(label);
        let cells = member.cells(drawn.half_space, self.plan.solver.cells);
        [line, member.springs(drawn.axisymmetric), cells]
    }
}

/// Figure 4.
pub(super) fn figure_4(plans: &Plans, interrupt: &AtomicBool) -> Result<Vec<Figure>> {
    let held = Held::new(plans.scenario("figure-04")?, f64::INFINITY, interrupt)?;
    let caption = "Pressure under a step load on a Maxwell half-space. Lines: closed form. Symbols: computed; for the \
                   half-space engine every sixth cell of the row beside the middle.";
    let (chart, data) = pressures(&held);
    let claims = pressure_claims(&held, true);
    Ok(vec![Figure::new(4, caption, vec![chart], data, claims)])
}

/// Figure 5.
pub(super) fn figure_5(plans: &Plans, interrupt: &AtomicBool) -> Result<Vec<Figure>> {
    let held = Held::new(plans.scenario("figure-05")?, f64::INFINITY, interrupt)?;
    let [springs, cells] = [EngineKind::Axisymmetric, EngineKind::HalfSpace];
    let [by_springs, by_cells] = &held.computed;
    let back = [
        driven_back(held.plan, springs, by_springs, interrupt)?,
        driven_back(held.plan, cells, by_cells, interrupt)?,
    ];
    let back = Claim::difference(
        "driven by the approach instead: largest difference of the pressure at any node",
        back,
        Measure::absolute("of the peak", 1e-6, 1e-6),
    )
    .note(
        "the approach that load control gave, imposed at the same times, gives the pressure back",
    );
    let caption = "Pressure under a step load on a Zener half-space of two equal springs. Lines: closed form. Symbols: \
                   computed; for the half-space engine every sixth cell of the row beside the middle.";
    let (chart, data) = pressures(&held);
    let mut claims = pressure_claims(&held, false);
    claims.push(back);
    Ok(vec![Figure::new(5, caption, vec![chart], data, claims)])
}

/// The largest difference of the pressure at any node, as a part of the peak, when the approach of an outcome is imposed at its
/// times on an engine with the same nodes.
fn driven_back(
    plan: &ScenarioPlan,
    engine: EngineKind,
    outcome: &SimulationOutcome,
    interrupt: &AtomicBool,
) -> Result<Option<f64>> {
    let compliance = series_of(plan)?.contact_compliance()?;
    let largest_contact = LargestContact {
        control: plan.drive.control(),
        maximum: plan.drive.maximum(),
        compliance_per_pa: compliance.compliance(plan.drive.duration_s()),
    };
    let mut solver = plan.solver;
    solver.engine = engine;
    let engines = EngineBuilder::new(plan.contact.indenter.clone(), solver, largest_contact)?;
    let mut engine = engines.engine(0)?;
    let mut march = March::new(engine.as_mut(), compliance, solver.time_rule);
    let (mut time_s, mut from_m, mut differences) = (0.0, 0.0, Vec::new());
    for row in &outcome.rows {
        if interrupt.load(Ordering::Relaxed) {
            return Err(ReproductionError::Interrupted);
        }
        let to_m = row.approach_m.unwrap_or(0.0);
        let stages = march.stages(row.time_s - time_s);
        march.step_in_stages(&stages, |end| {
            Prescribed::ApproachM(from_m + end * (to_m - from_m))
        })?;
        (time_s, from_m) = (row.time_s, to_m);
        for record in outcome.profiles.iter().filter(|record| record.row == *row) {
            let surface = march.surface()?;
            differences.push(surface.and_then(|surface| difference(&surface, &record.surface)));
        }
    }
    Ok(largest(differences.into_iter()))
}

/// Largest of two pressures over the same nodes, as a part of the peak; `None` where the nodes differ.
fn difference(a: &Surface, b: &Surface) -> Option<f64> {
    let pressures = |surface: &Surface| -> Vec<f64> {
        match surface {
            Surface::Radial(radial) => {
                let pressures = radial.pressure_pa.iter();
                pressures.map(|p| p.unwrap_or(0.0)).collect()
            }
            Surface::Cells(cells) => cells.pressure_pa.clone(),
        }
    };
    let (a, b) = (pressures(a), pressures(b));
    let peak = b.iter().copied().fold(0.0, f64::max);
    let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    (a.len() == b.len()).then(|| differences.fold(0.0, f64::max) / peak)
}

fn pressures(held: &Held<'_>) -> (Chart, Data) {
    let mut data = Data::new(&["time_tau", "source", "radius_a_h", "pressure_p_h"]);
    let mut chart = Chart::new(
        Axis::linear("radial coordinate r / Hertz radius"),
        Axis::linear("pressure p / Hertz peak pressure"),
    );
    for (k, &time) in held.times.iter().enumerate() {
        let [springs, cells] = held.profiles(k);
        let inside = |profile: &[ProfilePoint], every: usize| -> Vec<(f64, f64)> {
            let points = profile.iter().step_by(every);
            let pressed = points.filter_map(|p| Some((p.radius, p.pressure?)));
            pressed.filter(|(_, pressure)| *pressure > 0.0).collect()
        };
        let curves = ByEngine {
            exact: curve(0.0, held.radius(time), 200, |r| held.pressure(r, time)),
            axisymmetric: spread(&inside(&springs, 1), 30),
            half_space: inside(&cells, 6),
        };
        let label = match time {
            0.0 => "t = 0 (Hertz)".to_owned(),
            1.0 => "t = τ".to_owned(),
            _ => format!("t = {time} τ"),
        };
        chart = chart.all_series(held.curves((k, label), &mut data, &cells![time], curves));
    }
    (chart, data)
}

fn pressure_claims(held: &Held<'_>, at_first_edge: bool) -> Vec<Claim> {
    let mut claims = Vec::new();
    for (k, &time) in held.times.iter().enumerate().skip(1) {
        let profiles = held.profiles(k);
        let measure = Measure::absolute("of p_H", 2e-3, 0.01);
        let pressure = |radius: f64, place: &str| {
            let computed = profiles.each_ref().map(|p| at(p, radius, |p| p.pressure));
            let values = ByEngine::of(Some(held.pressure(radius, time)), computed);
            let quantity = format!("pressure {place} at t = {time} τ");
            Claim::new(quantity, Source::ClosedForm, values, measure)
        };
        claims.push(pressure(0.0, "on the axis"));
        if at_first_edge {
            let note = "the closed form has a vertical tangent here";
            claims.push(pressure(1.0, "at r = a_H").note(note));
        }
        let radius = held.computed.each_ref().map(|outcome| {
            let record = outcome.profiles.get(k)?;
            Some(record.row.contact_radius_m / held.scale.contact_radius_m)
        });
        claims.push(Claim::new(
            format!("contact radius / a_H at t = {time} τ"),
            Source::ClosedForm,
            ByEngine::of(Some(held.radius(time)), radius),
            Measure::absolute("of a_H", 1e-3, 0.5 * held.cell()),
        ));
        let deviation = profiles.map(|profile| {
            let edge = held.radius(time);
            let away = |p: &&ProfilePoint| (p.radius - edge).abs() > EDGE_CELLS * held.cell();
            // Springs stand closer than need be looked at.
            let every = (profile.len() / 400).max(1);
            let points = profile.iter().step_by(every).filter(away);
            largest(points.map(|p| Some((p.pressure? - held.pressure(p.radius, time)).abs())))
        });
        claims.push(Claim::difference(
            format!(
                "pressure anywhere but within two cells of the edge, largest error at t = {time} τ"
            ),
            deviation,
            measure,
        ));
    }
    claims
}

/// Figure 7.
pub(super) fn figure_7(plans: &Plans, interrupt: &AtomicBool) -> Result<Vec<Figure>> {
    let columns = [
        "half_space",
        "time_tau",
        "state",
        "source",
        "radius_a_h",
        "displacement_delta_h",
    ];
    let mut data = Data::new(&columns);
    let (mut panels, mut claims) = (Vec::new(), Vec::new());
    // And a place outside the contact throughout (Hertz radii).
    for (file, name, part, outside) in [
        ("figure-07-maxwell", "Maxwell", 'a', 1.45),
        ("figure-07-zener", "Zener", 'b', 1.35),
    ] {
        let held = Held::new(plans.scenario(file)?, 1.5, interrupt)?;
        panels.push(displacements(&held, (name, part), &mut data));
        claims.extend(displacement_claims(&held, name, outside));
        claims.extend(what_is_left(&held, name));
    }
    let caption = "Surface displacement under a step load that is taken off at 2 τ; (a) Maxwell, (b) Zener half-space. Lines: \
                   closed form. Symbols: computed.";
    Ok(vec![Figure::new(7, caption, panels, data, claims)])
}

fn displacements(held: &Held<'_>, (name, part): (&str, char), data: &mut Data) -> Chart {
    let mut chart = Chart::new(
        Axis::linear("radial coordinate r / Hertz radius").range(0.0, held.reach),
        Axis::linear(format!("({part}) displacement u / Hertz approach")),
    )
    .legend(LegendPlace::Right)
    .size(900, 520);
    for (k, &time) in held.times.iter().enumerate() {
        let points = held.profiles(k).map(|profile| {
            let points = profile.iter().map(|p| (p.radius, Some(p.displacement)));
            spread(&points.collect::<Vec<_>>(), 16)
        });
        let line = curve(0.0, held.reach, 60, |r| held.displacement(r, time));
        let state = match time < UNLOADED {
            true => "loaded",
            false => "unloaded",
        };
        let curves = ByEngine::of(line, points);
        let before = cells![name, time, state];
        chart = chart.all_series(held.curves((k, label(time)), data, &before, curves));
    }
    chart
}

fn displacement_claims(held: &Held<'_>, name: &str, outside: f64) -> Vec<Claim> {
    let mut claims = Vec::new();
    for (k, &time) in held.times.iter().enumerate().skip(1) {
        let profiles = held.profiles(k);
        let measure = Measure::absolute("of δ_H", 2e-3, 5e-3);
        let quantity = |place: &str| format!("{name}: displacement / δ_H {place}, {}", label(time));
        let displacement = |radius: f64, place: &str| {
            let computed = profiles
                .each_ref()
                .map(|p| at(p, radius, |p| Some(p.displacement)));
            let values = ByEngine::of(held.displacement(radius, time), computed);
            Claim::new(quantity(place), Source::ClosedForm, values, measure)
        };
        // Before the last instant under load the displacement is that of Hertz.
        if time > 1.9 {
            claims.push(displacement(0.0, "on the axis"));
            claims.push(displacement(outside, &format!("at r = {outside} a_H")));
        }
        let deviation = profiles.each_ref().map(|profile| {
            let every = (profile.len() / 30).max(1);
            let points = profile.iter().step_by(every);
            largest(
                points.map(|p| Some((p.displacement - held.displacement(p.radius, time)?).abs())),
            )
        });
        let place = "inside and outside the contact to 1.5 a_H, largest error";
        claims.push(Claim::difference(quantity(place), deviation, measure));
    }
    claims
}

/// How the dent on the axis changes from just after unloading to the end.
fn what_is_left(held: &Held<'_>, name: &str) -> Option<Claim> {
    let first = held.times.iter().position(|t| *t >= UNLOADED)?;
    let (last, time) = (held.times.len() - 1, held.times.last()?);
    let [before, after] = [first, last].map(|k| {
        let on_axis = |profile: Vec<_>| at(&profile, 0.0, |p| Some(p.displacement));
        let exact = held.displacement(0.0, if k == first { UNLOADED } else { *time });
        ByEngine::of(exact, held.profiles(k).map(on_axis))
    });
    let ratio = |(after, before): (Option<f64>, Option<f64>)| Some(after? / before?);
    let claim = Claim::new(
        format!("{name}: dent at {time} τ over the dent just after unloading"),
        Source::ClosedForm,
        after.zip(before).map(ratio),
        Measure::relative(1e-9, 1e-9),
    );
    Some(claim.note("nothing is solved after unloading: the memory alone decides"))
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
