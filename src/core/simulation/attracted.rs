//! Follows a history whose surfaces attract one another within a range: springs whose edges move within a step, and its jumps.

use std::sync::atomic::Ordering;

use crate::adhesive::{Body, Edges, Springs, StepWeights};
use crate::contact::{ContactError, Prescribed};
use crate::drive::Moment;
use crate::engine::{body_of_revolution, prescribed};
use crate::simulation::body_material::Compliance;
use crate::simulation::follow::{MarchError, Run, Trajectory};
use crate::simulation::{HistoryRow, Level, Simulation};
use crate::sweep::record::attracted::Jump;

/// Parts of a jump of the drive, over which the work of a contact that is not linear is summed.
const PARTS_OF_JUMP: usize = 50;

/// By how much the row of springs is lengthened that the attraction reaches beyond, and how often.
const LONGER: f64 = 1.4;
const MOST_LONGER: usize = 60;

impl Simulation {
    /// Follows the history at one resolution, on as long a row of springs as it needs.
    pub(super) fn follow_attracted(
        &self,
        level: &Level,
        run: &Run<'_>,
    ) -> (Trajectory, Result<(), MarchError>) {
        let mut trajectory = Trajectory::default();
        let mut end_m = level.engines.half_width_m();
        for _ in 0..MOST_LONGER {
            trajectory = Trajectory::default();
            match self.follow_on_row(level, end_m, &mut trajectory, run) {
                Err(MarchError::Contact(ContactError::ReachedEdge { .. })) => end_m *= LONGER,
                ended => return (trajectory, ended),
            }
        }
        let half_width_m = end_m;
        (
            trajectory,
            Err(ContactError::ReachedEdge { half_width_m }.into()),
        )
    }

    fn follow_on_row(
        &self,
        level: &Level,
        end_m: f64,
        trajectory: &mut Trajectory,
        run: &Run<'_>,
    ) -> Result<(), MarchError> {
        let contact = &self.plan.contact;
        let (Compliance::Series(creep), Some(adhesion)) = (&self.compliance, contact.adhesion)
        else {
            return Ok(());
        };
        let duration_s = self.plan.drive.duration_s();
        let relaxed_per_pa = self.compliance.largest_per_pa(duration_s);
        let indenter = contact.indenter.as_ref();
        let Some(attraction) = adhesion.attraction(indenter, relaxed_per_pa) else {
            return Ok(());
        };
        let body = Body::new(creep, duration_s).map_err(|error| ContactError::Operator {
            reason: error.to_string(),
        })?;
        let count = level.engines.nodes();
        let places_m = (0..=count).map(|k| end_m * k as f64 / count as f64);
        let profile = body_of_revolution(indenter)?;
        let mut springs = Springs::new(&body, profile, attraction, places_m.collect());
        let moments = &level.schedule.moments;
        let jump = StepWeights::new(&body, 0.0);
        let mut weights = jump.clone();
        // From where the surfaces are apart.
        let mut before = springs.edges();
        let mut work_j = 0.0;
        for (index, moment) in moments.iter().enumerate() {
            if run.interrupt.load(Ordering::Relaxed) {
                return Err(ContactError::Interrupted.into());
            }
            let parts = if moment.is_jump() { PARTS_OF_JUMP } else { 1 };
            if weights.step_s() != moment.step_s {
                weights = StepWeights::new(&body, moment.step_s);
            }
            let from = before;
            for part in 1..=parts {
                let share = part as f64 / parts as f64;
                let edges = springs.step(&weights, self.on_the_way(&from, moment, share))?;
                work_j +=
                    0.5 * (edges.load_n + before.load_n) * (edges.approach_m - before.approach_m);
                trajectory
                    .jumps
                    .extend(springs.jumped_j().map(|loss_j| Jump {
                        before: before.into(),
                        after: edges.into(),
                        loss_j,
                    }));
                before = edges;
            }
            trajectory.rows.push(HistoryRow {
                time_s: moment.time_s,
                load_n: before.load_n,
                approach_m: Some(before.approach_m),
                contact_radius_m: before.contact_m,
                peak_pressure_pa: None,
                work_j: Some(work_j),
            });
            (run.progress)(index + 1, moments.len());
        }
        Ok(())
    }

    /// What is prescribed at this share of the way from an instant to a moment.
    fn on_the_way(&self, before: &Edges, moment: &Moment, share: f64) -> Prescribed {
        let control = self.plan.drive.control();
        let from = match prescribed(control, moment.value) {
            Prescribed::LoadN(_) => before.load_n,
            Prescribed::ApproachM(_) => before.approach_m,
        };
        prescribed(control, from + share * (moment.value - from))
    }
}
