//! A cycle as it is recorded: sample by sample, and what the record says of it.

use crate::contact::surface::Surface;
use crate::contact::{ContactError, Prescribed};
use crate::cycle::{self, ContactDuty, Extrema, Loop, LoopAnalysis, LoopError, Smoothness};
use crate::history::{Dissipation, March, NodalWork, Stage};
use crate::steady::Record;
use crate::sweep::case::lift_off::{contact_duty, smoothness};
use crate::sweep::case::pressure::Pressures;
use crate::sweep::case::stabilise::{CaseError, Contact, Wanted};
use crate::sweep::case::tangent_radius::TangentRadius;
use crate::sweep::record::attracted::Attracted;
use crate::sweep::record::{BranchLoss, CaseResult, CellLoss, RecordedCycle, SurfaceLoss};

/// Where rounding of load and approach is more than this part of the area of a loop, far above and below the spectrum, the loss is
/// what the branches dissipate, which no rounding touches.
const LARGEST_ROUNDING: f64 = 1e-6;

/// What a recorded cycle is watched for, as far as it is wanted.
pub(super) struct Recording {
    samples: Loop,
    dissipation: Dissipation,
    pressures: Option<Pressures>,
    tangent_radius: Option<TangentRadius>,
    /// Only of a cycle that closes.
    work: Option<NodalWork>,
}

impl Recording {
    /// Of a cycle in this many steps, the instant at which it begins: where the march stands.
    pub fn new(
        contact: &Contact<'_>,
        march: &mut March<'_>,
        steps: usize,
    ) -> Result<Self, ContactError> {
        let nodes = march.pressure().len();
        let step_s = contact.period_s() / steps as f64;
        let (everything, numbers) = (Wanted::Everything, Wanted::Numbers);
        let is_transient = contact.cycle.at_cycle.is_some();
        let mut recording = Self {
            samples: Loop::default(),
            dissipation: march.dissipation(step_s)?,
            pressures: (contact.wanted >= everything)
                .then(|| Pressures::new(&contact.condition.drive, steps)),
            tangent_radius: (contact.wanted >= numbers).then(|| TangentRadius::new(steps)),
            work: (contact.wanted >= everything && !is_transient)
                .then(|| NodalWork::new(contact.compliance, nodes, step_s)),
        };
        recording.sample(march, 0.0)?;
        Ok(recording)
    }

    /// Takes a step of this number, whose end is at this time, and the instant there.
    pub fn step(
        &mut self,
        march: &mut March<'_>,
        (stages, drive): (&[Stage], &dyn Fn(f64) -> Prescribed),
        (step, time_s): (usize, f64),
    ) -> Result<(), ContactError> {
        march.step_dissipating(stages, drive, &mut self.dissipation)?;
        self.sample(march, time_s)?;
        if let Some(pressures) = &mut self.pressures {
            pressures.see(march, step, time_s)?;
        }
        if let Some(tangent_radius) = &mut self.tangent_radius {
            tangent_radius.see(march, step)?;
        }
        Ok(())
    }

    /// Appends the present instant to the loop.
    fn sample(&mut self, march: &mut March<'_>, time_s: f64) -> Result<(), ContactError> {
        let with_numbers = self.tangent_radius.is_some();
        sample(march, &mut self.samples, time_s, with_numbers)?;
        match &mut self.work {
            Some(work) => march.add_work(work, &self.dissipation),
            None => Ok(()),
        }
    }

    /// What the cycle comes to.
    pub fn result(
        mut self,
        contact: &Contact<'_>,
        march: &mut March<'_>,
    ) -> Result<CaseResult, CaseError> {
        let drive = &contact.condition.drive;
        let mut pressures = (self.pressures.take()).map_or_else(Vec::new, Pressures::finished);
        // The contact carries the attraction too.
        let pull_off_n = drive.pull_off_n();
        if pull_off_n > 0.0 {
            let loads = self.samples.load_n.iter_mut();
            let loads = loads.chain(pressures.iter_mut().map(|p| &mut p.load_n));
            loads.for_each(|load_n| *load_n -= pull_off_n);
        }
        let is_transient = contact.cycle.at_cycle.is_some();
        let analysis = self.analysis(is_transient)?;
        let contact_duty = contact_duty(drive, &self.samples.load_n);
        // A loop that holds time out of contact is read as no modulus.
        let moduli = match contact_duty == ContactDuty::WHOLE {
            true => self.moduli_pa(contact, &analysis),
            false => None,
        };
        let samples = &self.samples;
        let [of_approach, of_contact] = smoothness(drive, samples, !is_transient);
        let peaks: Option<Vec<f64>> = samples.peak_pressure_pa.iter().copied().collect();
        let largest_radius_m = samples.contact_radius_m.iter().copied().fold(0.0, f64::max);
        let surface_loss = match &self.work {
            Some(work) => surface_loss(march.work_density(work, largest_radius_m)?),
            None => SurfaceLoss::default(),
        };
        // What an open cycle dissipates is not the area of a loop: the body stores another part of the work.
        let branches = match is_transient {
            true => &[],
            false => contact.compliance.branches(),
        };
        let branches = branches.iter().zip(&contact.solid.shares_of_indenter);
        let branches = branches.zip(self.dissipation.branch_energies_j());
        Ok(CaseResult {
            storage_modulus_pa: moduli.map(|m| m.0),
            loss_modulus_pa: moduli.map(|m| m.1),
            approach_m: extrema(of_approach, &samples.approach_m)?,
            contact_radius_m: not_negative(extrema(of_contact, &samples.contact_radius_m)?),
            contact_duty,
            attraction: (contact.tabor_parameter()).map_or(Attracted::Nothing, |tabor_parameter| {
                Attracted::Constant { tabor_parameter }
            }),
            peak_pressure_pa: (peaks.as_deref())
                .and_then(|peaks| extrema(of_contact, peaks).ok())
                .map(not_negative),
            errors: None,
            replica_losses_j: Vec::new(),
            branches: branches
                .map(|((branch, indenter_share), energy_loss_j)| BranchLoss {
                    retardation_time_s: branch.time_s,
                    energy_loss_j,
                    indenter_share: *indenter_share,
                })
                .collect(),
            analysis,
            cycle: RecordedCycle {
                samples: self.samples,
                pressures,
                surface_loss,
            },
        })
    }

    /// The numbers of the loop.
    fn analysis(&self, is_transient: bool) -> Result<LoopAnalysis, LoopError> {
        let Loop {
            load_n, approach_m, ..
        } = &self.samples;
        let analysis = match is_transient {
            true => cycle::analyse_open(load_n, approach_m)?,
            false => cycle::analyse(load_n, approach_m)?,
        };
        let energies = self.dissipation.branch_energies_j();
        // A body without branches is elastic and loses nothing: what its loop encloses is rounding.
        let is_rounding = analysis.rounding_j() > LARGEST_ROUNDING * analysis.energy_loss_j.abs();
        Ok(
            match energies.is_empty() || (is_rounding && !is_transient) {
                // The sum of nothing would be -0.
                true => analysis.of_energy_loss(energies.iter().fold(0.0, |sum, e| sum + e)),
                false => analysis,
            },
        )
    }

    /// E' and E'' (Pa) that the loop is read as.
    fn moduli_pa(&self, contact: &Contact<'_>, analysis: &LoopAnalysis) -> Option<(f64, f64)> {
        let radii_m = &self.samples.contact_radius_m;
        // The mean over the period counts the seam once.
        let count = radii_m.len().saturating_sub(1).max(1);
        let mean_radius_m = radii_m.iter().skip(1).sum::<f64>() / count as f64;
        let radius_m = self.tangent_radius.as_ref()?.mean_m(mean_radius_m)?;
        let material = &contact.condition.contact.material;
        let nu = material.poisson_ratio().unwrap_or(0.0);
        let moduli_pa = analysis.equivalent_moduli_pa(radius_m, nu)?;
        Some(material.of_loop(moduli_pa, contact.angular_frequency_rad_per_s))
    }
}

/// Records cycles of a search, in so many steps, of which the last is kept.
pub(super) struct Recorder<'a> {
    pub contact: &'a Contact<'a>,
    pub steps: usize,
    pub recording: Option<Recording>,
}

impl Record for Recorder<'_> {
    fn begin(&mut self, march: &mut March<'_>) -> Result<(), ContactError> {
        self.recording = Some(Recording::new(self.contact, march, self.steps)?);
        Ok(())
    }

    fn step(
        &mut self,
        march: &mut March<'_>,
        step: usize,
        in_stages: (&[Stage], &dyn Fn(f64) -> Prescribed),
    ) -> Result<(), ContactError> {
        let time_s = step as f64 / self.steps as f64 * self.contact.period_s();
        match &mut self.recording {
            Some(recording) => recording.step(march, in_stages, (step, time_s)),
            None => Ok(()),
        }
    }
}

fn extrema(smooth: Smoothness<'_>, signal: &[f64]) -> Result<Extrema, LoopError> {
    let (extrema, _) = smooth.extrema(signal).ok_or(LoopError::TooFewSamples {
        samples: 0,
        needed: 1,
    })?;
    Ok(extrema)
}

/// Extrema of what cannot be negative: where a contact opens or closes, a parabola through samples may go below zero.
fn not_negative(extrema: Extrema) -> Extrema {
    Extrema {
        minimum: extrema.minimum.max(0.0),
        ..extrema
    }
}

/// The surface's "pressure" is the density; beyond the contact there is nothing, and nothing is stored.
fn surface_loss(surface: Surface) -> SurfaceLoss {
    match surface {
        Surface::Radial(mut radial) => {
            let inside = radial.pressure_pa.iter().rposition(|d| *d != Some(0.0));
            let kept = inside.map_or(0, |last| last + 2);
            radial.radius_m.truncate(kept);
            radial.pressure_pa.truncate(kept);
            SurfaceLoss::Radial {
                radius_m: radial.radius_m,
                density_j_per_m2: radial.pressure_pa,
            }
        }
        Surface::Cells(cells) => {
            let grid = cells.grid;
            let (nx, ny) = (grid.cells_x(), grid.cells_y());
            let (mut x, mut y) = ((nx, 0), (ny, 0));
            let all = cells.pressure_pa.iter().enumerate();
            for (cell, _) in all.filter(|(_, density)| **density != 0.0) {
                x = (x.0.min(cell % nx), x.1.max(cell % nx + 1));
                y = (y.0.min(cell / nx), y.1.max(cell / nx + 1));
            }
            let rows = (y.0..y.1).flat_map(|row| {
                let start = row * nx;
                &cells.pressure_pa[start + x.0..start + x.1]
            });
            SurfaceLoss::Cells(CellLoss {
                first_x_m: grid.x_m(x.0.min(nx - 1)),
                first_y_m: grid.y_m(y.0.min(ny - 1)),
                spacing_x_m: grid.spacing_x_m(),
                spacing_y_m: grid.spacing_y_m(),
                cells_x: x.1.saturating_sub(x.0),
                density_j_per_m2: rows.map(|density| *density as f32).collect(),
            })
        }
    }
}

/// Appends the present instant to a loop, with its peak pressure or without.
pub fn sample(
    march: &mut March<'_>,
    samples: &mut Loop,
    time_s: f64,
    with_peak: bool,
) -> Result<(), ContactError> {
    march.observe(&mut |engine, pressure, solution| {
        samples.time_s.push(time_s);
        samples.load_n.push(solution.load_n);
        samples.approach_m.push(solution.approach_m);
        samples.contact_radius_m.push(solution.contact_radius_m);
        samples.peak_pressure_pa.push(match with_peak {
            true => engine.peak_pressure_pa(pressure, solution)?,
            false => None,
        });
        Ok(())
    })
}
