//! A case whose surfaces attract one another within a range: its cycle on springs whose edges move within a step.

use std::f64::consts::PI;
use std::sync::atomic::Ordering;

use crate::adhesive::cycle::{Jumped, State};
use crate::adhesive::{Attraction, Body, Cycle, Edges, Ending, Found, Layout, Start};
use crate::contact::ContactError;
use crate::cycle::{ContactDuty, Extrema, Harmonic, Loop, LoopAnalysis, analyse, analyse_open};
use crate::engine::{body_of_revolution, prescribed};
use crate::history::Work;
use crate::sweep::case::levels::Level;
use crate::sweep::case::stabilise::{CaseError, Contact, Stabilised};
use crate::sweep::plan::Method;
use crate::sweep::record::attracted::{Attracted, AttractedCycle, Jump};
use crate::sweep::record::{CaseResult, RecordedCycle, SurfaceLoss};

/// Cycles that a search may take before it is given up for marching.
const SEARCH_CYCLES: usize = 40;

/// Distance to the stabilised cycle at which a search is no failure: far above the spectrum of a body that relaxes a thousandfold its
/// surface is moulded to the indenter, and where the contact ends there hardly matters to anything else. The error bars hold it.
const SETTLED: f64 = 3e-2;

/// Distance above which a search that started from fewer steps starts once more from rest.
const NEAR: f64 = 1e-3;

/// Cycles of a march after a search.
const MARCHED: usize = 200;

impl Contact<'_> {
    /// What attracts, where that is more than a constant pull.
    pub(super) fn attraction(&self) -> Option<Attraction> {
        let contact = &self.condition.contact;
        let adhesion = contact.adhesion?;
        adhesion.attraction(contact.indenter.as_ref(), self.solid.relaxed_per_pa)
    }

    /// The stabilised cycles on this many springs, in the most steps and in fewer before it, each searched from the last, the first from
    /// what was left before; and what is left of the last.
    pub(super) fn attracted(
        &self,
        attraction: Attraction,
        springs: usize,
        (fewer, steps): (&[usize], usize),
        before: Option<(Layout, State)>,
    ) -> Result<(Level, Option<(Layout, State)>), CaseError> {
        let drive = &self.condition.drive;
        let of_drive = |value| prescribed(drive.control(), value);
        let body = Body::new(self.compliance, self.period_s()).map_err(super::SetupError::from)?;
        let cycle = Cycle {
            body: &body,
            profile: body_of_revolution(self.condition.contact.indenter.as_ref())?,
            attraction,
            drive: &|fraction| of_drive(drive.value(fraction)),
            mean: of_drive(drive.mean()),
            maximum: of_drive(drive.maximum()),
            period_s: self.period_s(),
        };
        let (layout, mut state) = match before {
            Some((layout, state)) => (layout, Some(state)),
            None => (
                cycle.layout(&|| self.interrupt.load(Ordering::Relaxed))?,
                None,
            ),
        };
        let mut coarser = Vec::new();
        for &count in fewer {
            match self.attracted_in(&cycle, &layout, (count, springs), state.as_ref()) {
                Ok((stabilised, left)) => {
                    state = Some(left);
                    coarser.push((count, stabilised));
                }
                Err(error) if error.may_be_of_the_resolution() => {}
                Err(error) => return Err(error),
            }
        }
        let (finest, left) =
            self.attracted_in(&cycle, &layout, (steps, springs), state.as_ref())?;
        let level = Level::new(springs, (steps, finest), coarser);
        Ok((level, Some((layout, left))))
    }

    fn attracted_in(
        &self,
        cycle: &Cycle<'_>,
        layout: &Layout,
        resolution: (usize, usize),
        state: Option<&State>,
    ) -> Result<(Stabilised, State), CaseError> {
        let stop = || self.interrupt.load(Ordering::Relaxed);
        let within = |start: Start<'_>, tolerance: f64, most_cycles: usize| {
            let ending = Ending {
                tolerance,
                most_cycles,
                stop: &stop,
            };
            cycle.stabilised(layout, resolution, start, ending)
        };
        let drive = &self.condition.drive;
        let march = Start::March {
            hold_s: drive.hold_s(),
            held: prescribed(drive.control(), drive.held()),
        };
        let (tolerance, most) = (self.cycle.tolerance, self.cycle.max_cycles);
        let (found, method) = match (self.cycle.at_cycle, self.cycle.method) {
            (Some(number), _) => (within(march, -1.0, number)?, Method::March),
            (None, Method::March) => (within(march, tolerance, most)?, Method::March),
            (None, Method::Direct) => {
                let start = state.map_or(Start::Rest, Start::From);
                let mut searched = within(start, tolerance, SEARCH_CYCLES.min(most));
                let is_near = |found: &Found| found.distance <= NEAR.max(tolerance);
                if !searched.as_ref().is_ok_and(is_near) {
                    let again = within(Start::Rest, tolerance, (2 * SEARCH_CYCLES).min(most));
                    searched = match (again, searched) {
                        (Ok(again), Ok(first)) if first.distance < again.distance => Ok(first),
                        (again, first) => again.or(first),
                    };
                }
                match searched {
                    Ok(found) if found.distance <= tolerance.max(SETTLED) => {
                        (found, Method::Direct)
                    }
                    Err(error) if !matches!(error, ContactError::NotConverged { .. }) => {
                        return Err(error.into());
                    }
                    _ => (within(march, tolerance, most.min(MARCHED))?, Method::March),
                }
            }
        };
        let is_transient = self.cycle.at_cycle.is_some();
        let is_found = is_transient || found.distance <= tolerance.max(SETTLED);
        let message = (!is_transient && found.distance > tolerance).then(|| {
            let instead = match is_found {
                true => "; the error bars hold it: an edge that moves without effort is where it is by little".to_owned(),
                false => too_few(layout, resolution.1),
            };
            format!(
                "after {} cycles the estimated distance to the stabilised cycle is {:.1e}, above the tolerance {tolerance:.1e}{instead}",
                found.cycles, found.distance
            )
        });
        let result = match is_found {
            true => Some(self.attracted_result(cycle, &found)?),
            false => None,
        };
        let stabilised = Stabilised {
            cycles: found.cycles,
            work: Work {
                instants: (found.cycles * resolution.0) as u64,
                ..Work::default()
            },
            distance: Some(found.distance),
            message,
            result,
            ..Stabilised::none(method)
        };
        Ok((stabilised, found.state))
    }

    /// What a cycle comes to.
    fn attracted_result(&self, cycle: &Cycle<'_>, found: &Found) -> Result<CaseResult, CaseError> {
        let edges = &found.edges;
        let steps = edges.len() - 1;
        let all = |of: fn(&Edges) -> f64| edges.iter().map(of).collect::<Vec<f64>>();
        let (load_n, approach_m) = (all(|e| e.load_n), all(|e| e.approach_m));
        let (contact_radius_m, zone_radius_m) = (all(|e| e.contact_m), all(|e| e.zone_m));
        let mut analysis = match self.cycle.at_cycle {
            Some(_) => analyse_open(&load_n, &approach_m)?,
            None => analyse(&load_n, &approach_m)?,
        };
        let is_smooth = found.jumps.is_empty();
        if !is_smooth {
            // A jump has harmonics without end.
            let polygon_j = analysis.polygon_loss_j;
            analysis = analysis.of_energy_loss(polygon_j);
        } else if cycle.body.branches() == 0 {
            analysis = analysis.of_energy_loss(0.0);
        }
        let extrema = |samples: &[f64]| extrema(samples, &found.jumps);
        let radius_m = |samples: &[f64]| {
            let radius_m = extrema(samples);
            Extrema {
                minimum: radius_m.minimum.max(0.0),
                ..radius_m
            }
        };
        let contact_duty = ContactDuty::of(&contact_radius_m).unwrap_or(ContactDuty::WHOLE);
        let is_whole = is_smooth && contact_duty == ContactDuty::WHOLE;
        let moduli_pa = is_whole.then(|| self.attracted_moduli_pa(&contact_radius_m, &analysis));
        let moduli_pa = moduli_pa.flatten();
        let jumps = found.jumps.iter().map(|&(step, loss_j)| Jump {
            before: edges[step - 1].into(),
            after: edges[step].into(),
            loss_j,
        });
        let contact_radius = radius_m(&contact_radius_m);
        let attracted = AttractedCycle {
            tabor_parameter: self.tabor_parameter(),
            zone_radius_m: radius_m(&zone_radius_m),
            pull_n: -extrema(&load_n).minimum,
            bulk_loss_j: self.bulk_loss_j(contact_radius.minimum, &analysis.harmonics),
            jumps: jumps.collect(),
        };
        let step_s = self.period_s() / steps as f64;
        Ok(CaseResult {
            storage_modulus_pa: moduli_pa.map(|moduli| moduli.0),
            loss_modulus_pa: moduli_pa.map(|moduli| moduli.1),
            approach_m: extrema(&approach_m),
            contact_radius_m: contact_radius,
            contact_duty,
            attraction: Attracted::Edge(Box::new(attracted)),
            peak_pressure_pa: None,
            errors: None,
            replica_losses_j: Vec::new(),
            branches: Vec::new(),
            analysis,
            cycle: RecordedCycle {
                samples: Loop {
                    time_s: (0..=steps).map(|step| step as f64 * step_s).collect(),
                    peak_pressure_pa: vec![None; steps + 1],
                    load_n,
                    approach_m,
                    contact_radius_m,
                },
                pressures: Vec::new(),
                surface_loss: SurfaceLoss::default(),
            },
        })
    }

    /// E' and E'' (Pa) that the loop is read as at its mean radius.
    fn attracted_moduli_pa(&self, radius_m: &[f64], analysis: &LoopAnalysis) -> Option<(f64, f64)> {
        let mean_m = radius_m[1..].iter().sum::<f64>() / (radius_m.len() - 1) as f64;
        let material = &self.condition.contact.material;
        let nu = material.poisson_ratio().unwrap_or(0.0);
        let moduli_pa = analysis.equivalent_moduli_pa(mean_m, nu)?;
        Some(material.of_loop(moduli_pa, self.angular_frequency_rad_per_s))
    }

    /// What the springs dissipate that are in contact all the time: they share one displacement, and so the loss of each follows from
    /// its harmonics.
    fn bulk_loss_j(&self, always_m: f64, harmonics: &[Harmonic]) -> f64 {
        let losses = harmonics.iter().enumerate().map(|(k, harmonic)| {
            let n = (k + 1) as f64;
            let compliance =
                (self.compliance).complex_compliance(n * self.angular_frequency_rad_per_s);
            PI * n * harmonic.approach_amplitude_m.powi(2) * compliance.inv().im
        });
        2.0 * always_m * losses.sum::<f64>()
    }
}

/// Extrema of a signal, between its samples where no jump is beside them: there is no parabola there.
fn extrema(samples: &[f64], jumps: &[Jumped]) -> Extrema {
    let by_size = |a: &usize, b: &usize| samples[*a].total_cmp(&samples[*b]);
    let least = (0..samples.len()).min_by(by_size).unwrap_or(0);
    let greatest = (0..samples.len()).max_by(by_size).unwrap_or(0);
    let refined = Extrema::of(samples);
    let at = |k: usize, refined: Option<f64>| {
        let is_smooth = !jumps.iter().any(|(step, _)| (k..=k + 1).contains(step));
        refined.filter(|_| is_smooth).unwrap_or(samples[k])
    };
    Extrema {
        minimum: at(least, refined.map(|refined| refined.minimum)),
        maximum: at(greatest, refined.map(|refined| refined.maximum)),
    }
}

/// What to do about a zone that so many springs do not resolve; nothing where they do.
fn too_few(layout: &Layout, springs: usize) -> String {
    let (width_m, spacing_m) = (layout.zone_width_m, layout.spacing_m(springs));
    match width_m < 3.0 * spacing_m {
        true => format!(
            "; the attracted zone is {width_m:.1e} m wide and the springs are {spacing_m:.1e} m apart: give more solver.springs or a \
             larger adhesion.range, or write adhesion.model = \"jkr\""
        ),
        false => String::new(),
    }
}

impl From<Edges> for crate::sweep::record::attracted::Instant {
    fn from(edges: Edges) -> Self {
        Self {
            load_n: edges.load_n,
            approach_m: edges.approach_m,
            zone_radius_m: edges.zone_m,
        }
    }
}
