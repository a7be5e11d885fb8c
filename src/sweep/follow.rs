//! Follows one drive history on one engine, from moment to moment: rows, surfaces at the times asked for, checkpoints.

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::half_space::grid::Grid;
use crate::contact::surface::Surface;
use crate::contact::{ContactError, Prescribed, Solution};
use crate::drive::{Moment, Schedule};
use crate::history::{Hereditary, March};
use crate::sweep::engines::{self, AsContactError, EngineError};
use crate::sweep::history_checkpoint::{HistoryCheckpoint, Stand};
use crate::sweep::scenario::ScenarioPlan;
use crate::sweep::simulate::{HistoryRow, Progress, SimulationOutcome, SurfaceRecord};

/// Why a march ended early.
#[derive(Debug, thiserror::Error)]
pub(super) enum MarchError {
    #[error(transparent)]
    Contact(ContactError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error("interrupted")]
    Interrupted,
}

impl From<ContactError> for MarchError {
    fn from(error: ContactError) -> Self {
        match error {
            ContactError::Interrupted => Self::Interrupted,
            other => Self::Contact(other),
        }
    }
}

impl AsContactError for MarchError {
    fn as_contact_error(&self) -> Option<&ContactError> {
        match self {
            Self::Contact(error) => Some(error),
            _ => None,
        }
    }
}

impl MarchError {
    /// Whether the contact does not look like a disc.
    pub(super) fn is_of_a_disc(&self) -> bool {
        matches!(
            self,
            Self::Contact(ContactError::NotADisc { .. } | ContactError::Ring { .. })
        )
    }
}

/// A history to follow, and how.
pub(super) struct Following<'a> {
    pub(super) plan: &'a ScenarioPlan,
    pub(super) schedule: &'a Schedule,
    /// Per moment, whether the approach is undefined.
    pub(super) floating: &'a [bool],
    pub(super) field_grid: &'a Grid,
    /// How often the domain has been enlarged.
    pub(super) growths: usize,
    pub(super) checkpoint: &'a HistoryCheckpoint,
    pub(super) interrupt: &'a AtomicBool,
    pub(super) progress: &'a Progress<'a>,
}

impl Following<'_> {
    /// Marches to the end, from where an earlier run stood if that fits; what there is by then is in the outcome either way.
    pub(super) fn run<M: Hereditary>(
        &self,
        mut march: March<'_, M>,
        stand: Option<Stand<'_>>,
        outcome: &mut SimulationOutcome,
    ) -> Result<(), MarchError> {
        outcome.rows.clear();
        let profiles = self.plan.output.profiles_at_s.len();
        let (profiles, fields) = self.schedule.requested.split_at(profiles);
        let mut kept = [Kept::new(profiles), Kept::new(fields)];
        let mut within_step = false;
        if let Some(stand) = stand
            && self.fits(&stand, &kept)
            && march.restore_step(&stand.step)
        {
            within_step = true;
            outcome.rows = stand.rows.into_owned();
            for (kept, surfaces) in kept.iter_mut().zip(stand.surfaces) {
                kept.records = surfaces.into_owned();
            }
        }
        let ended = self.go_on(&mut march, within_step, outcome, &mut kept);
        outcome.iterations = march.work().iterations;
        [outcome.profiles, outcome.fields] = kept.map(Kept::finish);
        ended
    }

    /// Whether the stand can be one of this history.
    fn fits(&self, stand: &Stand<'_>, kept: &[Kept<'_>; 2]) -> bool {
        let mut surfaces = stand.surfaces.iter().zip(kept);
        stand.rows.len() < self.schedule.moments.len()
            && surfaces.all(|(stored, kept)| stored.len() == kept.records.len())
    }

    /// Marches from moment to moment, and keeps what is asked for. `within_step`: the march stands within the first step.
    fn go_on<M: Hereditary>(
        &self,
        march: &mut March<'_, M>,
        mut within_step: bool,
        outcome: &mut SimulationOutcome,
        kept: &mut [Kept<'_>; 2],
    ) -> Result<(), MarchError> {
        let moments = &self.schedule.moments;
        let mut guess = Vec::new();
        for (index, moment) in moments.iter().enumerate().skip(outcome.rows.len()) {
            let weights = match outcome.damped_throughout || moment.is_settling {
                true => march.settling_weights(moment.step_s),
                false => march.weights(moment.step_s),
            };
            if !std::mem::take(&mut within_step) {
                march.begin_step(&weights);
            }
            if self.checkpoint.keeps() {
                guess.clear();
                guess.extend_from_slice(march.pressure());
            }
            let interrupted = self.interrupt.load(Ordering::Relaxed);
            if interrupted || self.checkpoint.is_due() {
                self.keep(march, &guess, outcome, kept);
            }
            if interrupted {
                return Err(MarchError::Interrupted);
            }
            let prescribed = engines::prescribed(self.plan.drive.control(), moment.value);
            let solved = march.end_step(&weights, prescribed);
            if solved == Err(ContactError::Interrupted) {
                self.keep(march, &guess, outcome, kept);
            }
            let mut row = self.row(march, moment, prescribed, solved?, self.floating[index])?;
            if index == 0 && moment.value == 0.0 {
                // First touch of an undisturbed body: zero by definition, whatever node lies nearest to the axis.
                row.approach_m = Some(0.0);
            }
            let [profiles, fields] = &mut *kept;
            if profiles.wants(index)
                && let Some(surface) = march.surface()?
            {
                profiles.keep(index, self.surface_record(row, surface));
            }
            if fields.wants(index)
                && let Some(surface) = march.field(self.field_grid)?
            {
                fields.keep(index, self.surface_record(row, surface));
            }
            outcome.rows.push(row);
            (self.progress)(index + 1, moments.len());
        }
        Ok(())
    }

    /// Writes where the history stands: in the step whose guess this is.
    fn keep<M: Hereditary>(
        &self,
        march: &March<'_, M>,
        guess: &[f64],
        outcome: &SimulationOutcome,
        [profiles, fields]: &[Kept<'_>; 2],
    ) {
        if self.checkpoint.keeps() {
            self.checkpoint.write(&Stand {
                growths: self.growths,
                damped_throughout: outcome.damped_throughout,
                rows: Cow::Borrowed(&outcome.rows),
                surfaces: [&profiles.records, &fields.records].map(|r| Cow::Borrowed(r.as_slice())),
                step: march.step_state(guess),
            });
        }
    }

    /// The row of the instant just solved.
    fn row<M: Hereditary>(
        &self,
        march: &mut March<'_, M>,
        moment: &Moment,
        prescribed: Prescribed,
        solution: Solution,
        floating: bool,
    ) -> Result<HistoryRow, ContactError> {
        march.check_assumptions()?;
        let mut peak_pressure_pa = None;
        march.observe(&mut |engine, pressure, solution| {
            peak_pressure_pa = engine.peak_pressure_pa(pressure, solution)?;
            Ok(())
        })?;
        if solution.load_n == 0.0 {
            peak_pressure_pa = Some(0.0);
        }
        let Solution {
            load_n,
            approach_m,
            contact_radius_m,
            ..
        } = solution;
        Ok(HistoryRow {
            time_s: moment.time_s,
            // What was prescribed, without the rounding of the sum over the nodes.
            load_n: match prescribed {
                Prescribed::LoadN(load_n) => load_n,
                Prescribed::ApproachM(_) => load_n,
            },
            approach_m: (!floating).then_some(approach_m),
            contact_radius_m,
            peak_pressure_pa,
        })
    }

    fn surface_record(&self, row: HistoryRow, surface: Surface) -> SurfaceRecord {
        let indenter = self.plan.indenter.as_ref();
        let gap_m = row.approach_m.map(|approach_m| match &surface {
            Surface::Radial(radial) => {
                let points = radial.radius_m.iter().zip(&radial.displacement_m);
                points
                    .map(|(r, u)| indenter.gap_m(*r, 0.0) + u - approach_m)
                    .collect()
            }
            Surface::Cells(cells) => {
                let points = cells.displacement_m.iter().enumerate();
                points
                    .map(|(cell, u)| {
                        let (x_m, y_m) = cells.grid.center(cell);
                        indenter.gap_m(x_m, y_m) + u - approach_m
                    })
                    .collect()
            }
        });
        SurfaceRecord {
            row,
            surface,
            gap_m,
        }
    }
}

/// Surfaces wanted at some moments, in the order of the wishes.
struct Kept<'a> {
    moments: &'a [usize],
    wanted: HashSet<usize>,
    records: Vec<Option<SurfaceRecord>>,
}

impl<'a> Kept<'a> {
    fn new(moments: &'a [usize]) -> Self {
        Self {
            moments,
            wanted: moments.iter().copied().collect(),
            records: vec![None; moments.len()],
        }
    }

    fn wants(&self, moment: usize) -> bool {
        self.wanted.contains(&moment)
    }

    fn keep(&mut self, moment: usize, record: SurfaceRecord) {
        for (wanted, slot) in self.moments.iter().zip(&mut self.records) {
            if *wanted == moment {
                *slot = Some(record.clone());
            }
        }
    }

    fn finish(self) -> Vec<SurfaceRecord> {
        self.records.into_iter().flatten().collect()
    }
}
