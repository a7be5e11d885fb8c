//! The work that the indenter does on the body in the course of a history: the integral of the load over the approach.
//!
//! Between two instants a trapezium is right to the second order of the step. At a jump of the drive it is not: there the body
//! answers at once and elastically, on a path that no row shows. With u = B (C_0 p + H) and H what it remembers, the work is the integral
//! of p du, and that is a difference of two numbers,
//!
//! ```text
//! C_0/2 (<p_1, B p_1> - <p_0, B p_0>),
//! ```
//!
//! whatever touches in between: where p is not zero the surface moves with the indenter. A sphere pressed into an elastic body from first
//! touch on takes 2/5 W delta; a trapezium would say 1/2.
//!
//! Where the indenter is clear of the surface there is no load, and it does no work. It meets the surface again where the engine finds the
//! two just to touch, which is where the next trapezium begins.

use serde::{Deserialize, Serialize};

use crate::contact::ContactError;
use crate::drive::Moment;
use crate::history::{Hereditary, March};
use crate::simulation::errors::{Plan, RowErrors};
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::{HistoryRow, SimulationEnd, SimulationOutcome};

/// Why a folder has no work.
pub const UNKNOWN: &str =
    "an earlier version of the program wrote these rows, which do not tell the work";

/// The work up to a moment, and what the next one needs of it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct WorkDone {
    work_j: f64,
    load_n: f64,
    approach_m: f64,
    /// <p, B p>, where a jump follows.
    pressed: f64,
}

/// A moment and the one after it.
pub(super) type AtMoment<'a> = (&'a Moment, Option<&'a Moment>);

impl WorkDone {
    /// Takes in the instant just solved, at which the contact carries this load at this approach; the work (J) up to it. An attraction,
    /// which the contact carries too, does its part as long as there is contact.
    pub(super) fn add<M: Hereditary>(
        &mut self,
        march: &mut March<'_, M>,
        (moment, next): AtMoment<'_>,
        (load_n, approach_m): (f64, f64),
        attraction_n: f64,
    ) -> Result<f64, ContactError> {
        let is_at_jump = moment.is_jump() || next.is_some_and(Moment::is_jump);
        let pressed = match is_at_jump && load_n > 0.0 {
            true => march.pressed()?,
            false => 0.0,
        };
        let travel_m = approach_m - self.approach_m;
        let work_j = match moment.is_jump() {
            true => 0.5 * march.compliance_per_pa() * (pressed - self.pressed),
            false => 0.5 * (load_n + self.load_n) * travel_m,
        };
        let is_attracted = load_n > 0.0 || self.load_n > 0.0;
        let attracted_n = if is_attracted { attraction_n } else { 0.0 };
        *self = Self {
            work_j: self.work_j + work_j - attracted_n * travel_m,
            load_n,
            approach_m,
            pressed,
        };
        Ok(self.work_j)
    }
}

/// Fills in the work of rows that have none, as far as load and approach tell it: up to the first jump under load, and up to where an
/// indenter that was clear of the surface meets it at a place that no row holds.
pub fn fill_in(plan: &ScenarioPlan, rows: &mut [HistoryRow]) {
    let attraction_n = plan.drive.pull_off_n();
    let is_clear = |row: &HistoryRow| row.load_n + attraction_n == 0.0;
    // What comes before the first row is a jump of its own.
    let mut work_j = rows.first().is_some_and(is_clear).then_some(0.0);
    let mut last: Option<HistoryRow> = None;
    for row in rows {
        if let Some(last) = last {
            let is_jump = last.time_s == row.time_s;
            let trapezium =
                || Some(0.5 * (last.load_n + row.load_n) * (row.approach_m? - last.approach_m?));
            let step_j = match is_clear(&last) && is_clear(row) {
                true => Some(0.0),
                false => trapezium().filter(|_| !is_jump),
            };
            work_j = work_j.zip(step_j).map(|(work, step)| work + step);
        }
        row.work_j = work_j;
        last = Some(*row);
    }
}

/// The pull of surfaces that attract one another, with errors where they were asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Separation {
    /// The largest pull (N): the pull-off load where the surfaces part.
    pub pull_n: f64,
    pub pull_error_n: Option<f64>,
    /// The work (J) of the pull that parts them, from where it last begins; `None` where they stay together.
    pub work_j: Option<f64>,
    pub work_error_j: Option<f64>,
}

impl Separation {
    /// That of a history; `None` where no attraction moves the edge of the contact, or nothing is pulled.
    pub(super) fn of(plan: &ScenarioPlan, rows: &[HistoryRow]) -> Option<Self> {
        if !plan.contact.is_attracted() {
            return None;
        }
        let pulled = (0..rows.len()).filter(|place| rows[*place].load_n < 0.0);
        let last_pulled = pulled.clone().next_back();
        let least = pulled.min_by(|a, b| rows[*a].load_n.total_cmp(&rows[*b].load_n));
        let (least, last) = least.zip(last_pulled)?;
        let begins = rows[..=last].iter().rposition(|row| row.load_n >= 0.0);
        let steps = rows[begins.unwrap_or(0)..].windows(2).filter_map(|pair| {
            let travel_m = pair[1].approach_m? - pair[0].approach_m?;
            Some(0.5 * (pair[0].load_n + pair[1].load_n) * travel_m)
        });
        let ends_apart = rows
            .last()
            .is_some_and(|row| row.load_n == 0.0 && row.contact_radius_m == 0.0);
        Some(Self {
            pull_n: -rows[least].load_n,
            pull_error_n: None,
            work_j: ends_apart.then(|| steps.sum()),
            work_error_j: None,
        })
    }

    /// The same with errors, from what each resolution came to.
    pub(super) fn with_errors(self, all: &[Option<Self>], plan: &Plan) -> Self {
        let error = |value: fn(&Self) -> Option<f64>| {
            let values: Vec<_> = all.iter().map(|own| value(own.as_ref()?)).collect();
            plan.error_of_whole(&values)
        };
        Self {
            pull_error_n: error(|own| Some(own.pull_n)),
            work_error_j: error(|own| own.work_j),
            ..self
        }
    }
}

/// What a history comes to as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryWork {
    /// The work of the indenter on the body (J), and its error.
    pub work_j: f64,
    pub error_j: Option<f64>,
    /// Why the work is not dissipated, where it is not.
    pub stored: Option<&'static str>,
}

impl HistoryWork {
    /// That of an outcome; `None` where its rows do not tell it.
    pub fn of(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> Option<Self> {
        let last = outcome.rows.last()?;
        let errors = outcome.errors.last().copied();
        let errors: RowErrors = errors.unwrap_or_default();
        let carried_n = last.load_n + plan.drive.pull_off_n();
        // Attracted surfaces may touch under no load.
        let is_held = plan.contact.is_attracted() && last.contact_radius_m > 0.0;
        Some(Self {
            work_j: last.work_j?,
            error_j: errors.work_j,
            stored: match outcome.ended {
                SimulationEnd::Done if carried_n == 0.0 && !is_held => None,
                SimulationEnd::Done => {
                    Some("the history ends under load: a part of the work is stored in the body")
                }
                _ => Some("the history is not whole"),
            },
        })
    }

    /// The energy (J) that the body dissipates, the recovery after the end of the history included, where nothing else becomes of the
    /// work.
    pub fn dissipated_j(&self) -> Option<f64> {
        self.stored.is_none().then_some(self.work_j)
    }

    /// Its error (J).
    pub fn dissipated_error_j(&self) -> Option<f64> {
        self.error_j.filter(|_| self.stored.is_none())
    }
}
