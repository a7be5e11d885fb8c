//! Figures 4 and 5: pressure under a load put on at once and held, on a Maxwell and on a Zener half-space; and, beside figure
//! 5, the same history driven by its approach.

use std::sync::atomic::{AtomicBool, Ordering};

use super::by_engine::{self, By, cell_m};
use super::claim::Value;
use super::look::{Member, evenly, spread};
use super::number::datum;
use super::scale::{ProfilePoint, at, largest};
use super::{Claim, Figure, Measure, Plans, ReproductionError, Scale, Stated, series_of};
use crate::contact::Prescribed;
use crate::contact::surface::Surface;
use crate::drive::Control;
use crate::history::March;
use crate::reference::step_load::StepLoad;
use crate::report::chart::{Axis, Chart, Series};
use crate::report::table::Table;
use crate::sweep::engine::{EngineBuilder, LargestContact};
use crate::sweep::history::{Simulation, SimulationOutcome};
use crate::sweep::plan::scenario::ScenarioPlan;

/// Figure 4.
pub(super) fn figure_4(
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let plan = plans.scenario("figure-04")?;
    let step = StepFigure::new(4, plan, |by| by_engine::simulate(plan, by, interrupt))?;
    let caption = "Pressure under a step load on a Maxwell half-space. Lines: closed form. Symbols: computed; for the \
                   half-space engine every sixth cell of the row beside the middle.";
    Ok(vec![step.figure(caption, Vec::new())?])
}

/// Figure 5.
pub(super) fn figure_5(
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let plan = plans.scenario("figure-05")?;
    let mut back = Vec::new();
    let step = StepFigure::new(5, plan, |by| {
        let (outcome, difference) = there_and_back(&by_engine::plan(plan, by), interrupt)?;
        back.push(difference);
        Ok(outcome)
    })?;
    let back = Claim {
        figure: 5,
        quantity: "driven by the approach instead: largest difference of the pressure at any node".to_owned(),
        exact: Value::Difference,
        axisymmetric: back.first().copied(),
        half_space: back.get(1).copied(),
        measure: Measure::absolute("of the peak", 1e-6, 1e-6),
        stated: Stated::default(),
        note: "the approach that load control gave, imposed at the same times, gives the pressure back".to_owned(),
    };
    let caption = "Pressure under a step load on a Zener half-space of two equal springs. Lines: closed form. Symbols: \
                   computed; for the half-space engine every sixth cell of the row beside the middle.";
    Ok(vec![step.figure(caption, vec![back])?])
}

/// A history under load, and the largest difference, as a part of the peak pressure and over the profiles, when its approach
/// is imposed instead.
fn there_and_back(
    plan: &ScenarioPlan,
    interrupt: &AtomicBool,
) -> Result<(SimulationOutcome, f64), ReproductionError> {
    let simulation = Simulation::new(plan.clone())?;
    let outcome = by_engine::run(&simulation, interrupt)?;
    let compliance = series_of(plan)?.contact_compliance()?;
    let largest = LargestContact {
        control: Control::Load,
        maximum: plan.drive.maximum(),
        compliance_per_pa: compliance.compliance(plan.drive.duration_s()),
    };
    let builder = EngineBuilder::new(plan.indenter.clone(), plan.solver, largest)?;
    let mut worst = 0.0_f64;
    builder.on_a_large_enough_domain(
        0,
        |_, _| {},
        |engine| -> Result<(), ReproductionError> {
            worst = 0.0;
            let mut before_m = 0.0;
            let mut march = March::new(engine, compliance.clone(), plan.solver.time_rule);
            let schedule = simulation.schedule();
            for (index, (moment, row)) in schedule.moments.iter().zip(&outcome.rows).enumerate() {
                if interrupt.load(Ordering::Relaxed) {
                    return Err(ReproductionError::Interrupted);
                }
                let approach_m = row.approach_m.unwrap_or(0.0);
                let stages = march.stages(moment.step_s);
                march.step_in_stages(&stages, |end| {
                    Prescribed::ApproachM(before_m + end * (approach_m - before_m))
                })?;
                before_m = approach_m;
                let profiles = schedule.requested.iter().zip(&outcome.profiles);
                for (_, record) in profiles.filter(|(requested, _)| **requested == index) {
                    if let Some(surface) = march.surface()? {
                        worst = worst.max(largest_difference(&surface, &record.surface));
                    }
                }
            }
            Ok(())
        },
    )?;
    Ok((outcome, worst))
}

/// Of two pressures over the same nodes, as a part of the peak.
fn largest_difference(a: &Surface, b: &Surface) -> f64 {
    let pressures = |surface: &Surface| -> Vec<f64> {
        match surface {
            Surface::Radial(radial) => radial
                .pressure_pa
                .iter()
                .map(|p| p.unwrap_or(0.0))
                .collect(),
            Surface::Cells(cells) => cells.pressure_pa.clone(),
        }
    };
    let (a, b) = (pressures(a), pressures(b));
    let peak = b.iter().copied().fold(0.0, f64::max);
    let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / peak
}

/// A step load computed by both engines, beside its closed form.
struct StepFigure {
    number: u8,
    times: Vec<f64>,
    cells: usize,
    /// Side of a cell in Hertz radii.
    cell: f64,
    scale: Scale,
    exact: StepLoad,
    springs: SimulationOutcome,
    on_cells: SimulationOutcome,
}

/// How near to the edge of the contact, in cells, a pressure need not be right.
const EDGE_CELLS: f64 = 2.0;

impl StepFigure {
    fn new(
        number: u8,
        plan: &ScenarioPlan,
        mut simulate: impl FnMut(By) -> Result<SimulationOutcome, ReproductionError>,
    ) -> Result<Self, ReproductionError> {
        let load_n = plan.drive.maximum();
        let scale = Scale::new(series_of(plan)?, plan.indenter.as_ref(), load_n)?;
        let springs = simulate(By::Springs)?;
        let on_cells = simulate(By::Cells)?;
        Ok(Self {
            number,
            times: plan.output.profiles_at_s.clone(),
            cells: plan.solver.cells,
            cell: cell_m(&on_cells, plan.solver.cells) / scale.contact_radius_m,
            exact: StepLoad::new(
                scale.sphere_radius_m,
                load_n,
                scale.contact_compliance.clone(),
            )?,
            scale,
            springs,
            on_cells,
        })
    }

    /// Contact radius and pressure of the closed form, normalised.
    fn radius(&self, time: f64) -> f64 {
        self.exact.contact_radius_m(time) / self.scale.contact_radius_m
    }

    fn pressure(&self, radius: f64, time: f64) -> f64 {
        let r_m = radius * self.scale.contact_radius_m;
        self.exact.pressure_pa(r_m, time) / self.scale.pressure_pa
    }

    fn profile(&self, outcome: &SimulationOutcome, k: usize) -> Vec<ProfilePoint> {
        let record = outcome.profiles.get(k);
        record.map_or_else(Vec::new, |record| self.scale.profile(&record.surface))
    }

    fn figure(&self, caption: &str, more: Vec<Claim>) -> Result<Figure, ReproductionError> {
        let columns = ["time_tau", "source", "radius_a_h", "pressure_p_h"];
        let mut table = Table::new("pressure profiles", &columns)?;
        let mut series: Vec<Series> = Vec::new();
        for (k, &time) in self.times.iter().enumerate() {
            let member = Member {
                step: k,
                of: self.times.len(),
            };
            let edge = self.radius(time);
            let line = evenly(0.0, edge, 200)
                .into_iter()
                .map(|r| (r, self.pressure(r, time)))
                .collect::<Vec<_>>();
            let inside = |outcome: &SimulationOutcome, every: usize| -> Vec<(f64, f64)> {
                let profile = self.profile(outcome, k);
                let loaded = profile
                    .iter()
                    .step_by(every)
                    .filter_map(|p| Some((p.radius, p.pressure?)));
                loaded.filter(|(_, pressure)| *pressure > 0.0).collect()
            };
            let springs = spread(&inside(&self.springs, 1), 30);
            let cells = inside(&self.on_cells, 6);
            for (source, points) in [
                ("closed form", &line),
                ("axisymmetric", &springs),
                ("half-space", &cells),
            ] {
                for (r, p) in points {
                    table.row(&[datum(time), source.to_owned(), datum(*r), datum(*p)])?;
                }
            }
            let label = match time {
                0.0 => "t = 0 (Hertz)".to_owned(),
                1.0 => "t = τ".to_owned(),
                _ => format!("t = {time} τ"),
            };
            series.push(member.line(line).label(label));
            series.extend(member.engines(springs, cells, self.cells));
        }
        let chart = Chart::new(
            Axis::linear("radial coordinate r / Hertz radius"),
            Axis::linear("pressure p / Hertz peak pressure"),
        )
        .all_series(series);
        let mut claims = self.claims();
        claims.extend(more);
        Ok(Figure {
            number: self.number,
            caption: caption.to_owned(),
            panels: vec![chart],
            data: table.finish()?,
            claims,
            statements: Vec::new(),
        })
    }

    fn claims(&self) -> Vec<Claim> {
        let mut claims = Vec::new();
        for (k, &time) in self.times.iter().enumerate().skip(1) {
            let (springs, cells) = (
                self.profile(&self.springs, k),
                self.profile(&self.on_cells, k),
            );
            let pressure = |radius: f64, place: &str, note: &str| Claim {
                figure: self.number,
                quantity: format!("pressure {place} at t = {time} τ"),
                exact: Value::ClosedForm(Some(self.pressure(radius, time))),
                axisymmetric: at(&springs, radius, |p| p.pressure),
                half_space: at(&cells, radius, |p| p.pressure),
                measure: Measure::absolute("of p_H", 2e-3, 0.01),
                stated: Stated::default(),
                note: note.to_owned(),
            };
            claims.push(pressure(0.0, "on the axis", ""));
            if self.number == 4 {
                let note = "the closed form has a vertical tangent here";
                claims.push(pressure(1.0, "at r = a_H", note));
            }
            claims.push(self.radius_claim(k, time));
            claims.push(Claim {
                exact: Value::Difference,
                axisymmetric: self.deviation(&springs, time),
                half_space: self.deviation(&cells, time),
                ..pressure(
                    0.0,
                    "anywhere but within two cells of the edge, largest error",
                    "",
                )
            });
        }
        claims
    }

    fn radius_claim(&self, k: usize, time: f64) -> Claim {
        let found = |outcome: &SimulationOutcome| {
            let record = outcome.profiles.get(k)?;
            Some(record.row.contact_radius_m / self.scale.contact_radius_m)
        };
        Claim {
            figure: self.number,
            quantity: format!("contact radius / a_H at t = {time} τ"),
            exact: Value::ClosedForm(Some(self.radius(time))),
            axisymmetric: found(&self.springs),
            half_space: found(&self.on_cells),
            measure: Measure::absolute("of a_H", 1e-3, 0.5 * self.cell),
            stated: Stated::default(),
            note: String::new(),
        }
    }

    /// Largest difference from the closed form, away from the edge of the contact; `None` of no points.
    fn deviation(&self, profile: &[ProfilePoint], time: f64) -> Option<f64> {
        let edge = self.radius(time);
        let away = |p: &&ProfilePoint| (p.radius - edge).abs() > EDGE_CELLS * self.cell;
        // Springs stand closer than need be looked at.
        let every = (profile.len() / 400).max(1);
        let differences = profile
            .iter()
            .step_by(every)
            .filter(away)
            .map(|p| Some((p.pressure? - self.pressure(p.radius, time)).abs()));
        largest(differences)
    }
}
