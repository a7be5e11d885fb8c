//! The instants at which a drive history is followed: time steps, given or chosen, with every joint hit exactly.
//!
//! Chosen steps: after each joint the body answers on all its time scales, so steps begin at a small part of its shortest
//! time and grow in proportion to the time since the joint; they grow no further than what resolves the drive itself. A
//! value that is held needs no more than that, however long it is held, since the hereditary integral is exact for any step.

use super::piece::Piece;
use super::segments::SegmentedDrive;

/// How long the time steps are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Steps {
    /// This long (s), counted anew from each joint.
    Given { step_s: f64 },
    /// Chosen from the drive and the shortest time (s) on which the body answers, `None` for an elastic one.
    Chosen { shortest_time_s: Option<f64> },
}

/// One instant of a history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Time since the history began (s).
    pub time_s: f64,
    /// Time since the moment before (s), 0 for a jump. Not simply the difference of the times, which loses digits.
    pub step_s: f64,
    /// What the drive prescribes, in the unit of its control.
    pub value: f64,
    /// The segment, counted from 0.
    pub segment: usize,
    /// The smooth piece of the drive, and the time since it began (s).
    piece: usize,
    since_s: f64,
}

impl Moment {
    /// Whether the drive jumps to this state from another one at the same time, or from before the history.
    pub fn is_jump(&self) -> bool {
        self.step_s == 0.0
    }
}

impl SegmentedDrive {
    /// What is prescribed at a fraction of the step that leads to a moment of this drive, in the unit of its control.
    pub fn value_within(&self, moment: &Moment, fraction: f64) -> f64 {
        let since_s = moment.since_s - (1.0 - fraction) * moment.step_s;
        match self.pieces().get(moment.piece) {
            Some(piece) if fraction < 1.0 => self.value_in(piece, since_s),
            _ => moment.value,
        }
    }
}

/// All moments of a history.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    /// In order of time; the first is a jump at time 0, from rest to the drive's first value.
    pub moments: Vec<Moment>,
    /// For each time that was asked for, its moment; at a jump the one after it.
    pub requested: Vec<usize>,
    /// For each moment its place in the schedule of fineness [`Fineness::FULL`], where it has one.
    pub in_full: Vec<Option<usize>>,
    /// Whether every smooth piece of the drive takes two steps or more, so that there are steps to leave out.
    pub can_be_coarser: bool,
}

/// How a schedule differs from the one that the history is followed by, to tell the error of the latter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fineness {
    /// Of the moments within a smooth piece of the drive every n-th, and its end.
    EveryNth(usize),
    /// Every step split into n.
    Split(usize),
}

impl Fineness {
    /// Every moment.
    pub const FULL: Self = Self::EveryNth(1);
}

/// Why there is no schedule.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScheduleError {
    #[error("the time step is {step_s} s; it must be positive and finite")]
    Step { step_s: f64 },
    #[error(
        "the history would take more than {MAX_MOMENTS} time steps; give a longer step or a shorter history"
    )]
    TooMany,
    #[error("{time_s} s is not within the history, which lasts from 0 s to {duration_s} s")]
    Outside { time_s: f64, duration_s: f64 },
}

/// More steps than this are a slip of the pen rather than a wish.
pub const MAX_MOMENTS: usize = 2_000_000;

/// The first step after a joint, as a part of the body's shortest time, and the growth of the time since the joint.
const FIRST_STEP: f64 = 1e-2;
const STEPS_PER_DECADE: f64 = 20.0;
/// Between the points of a table steps double, from no less than an eighth of the way to the next point.
const TABLE_GROWTH: f64 = 2.0;
const TABLE_FIRST_STEP: f64 = 0.125;
/// Times closer than this part of the history are the same time.
const SAME_TIME: f64 = 1e-12;
/// A step shorter than this part of its neighbour is merged with it.
const STUMP: f64 = 0.5;

impl Schedule {
    /// The moments of this history, among them every joint and every requested time (s).
    ///
    /// # Errors
    /// [`ScheduleError`]: a step that is no step, a requested time outside the history, too many moments.
    pub fn new(
        drive: &SegmentedDrive,
        steps: Steps,
        requested_s: &[f64],
    ) -> Result<Self, ScheduleError> {
        Self::of_fineness(drive, steps, requested_s, Fineness::FULL)
    }

    /// The same with fewer or more steps. Where they are fewer, requested times may be left out, as other moments are.
    ///
    /// # Errors
    /// As [`Schedule::new`].
    pub fn of_fineness(
        drive: &SegmentedDrive,
        steps: Steps,
        requested_s: &[f64],
        fineness: Fineness,
    ) -> Result<Self, ScheduleError> {
        if let Steps::Given { step_s } = steps
            && !(step_s.is_finite() && step_s > 0.0)
        {
            return Err(ScheduleError::Step { step_s });
        }
        let requested_s = within(drive, requested_s)?;
        let mut exact_s = requested_s.clone();
        exact_s.sort_by(f64::total_cmp);
        let mut schedule = Self {
            moments: Vec::new(),
            requested: Vec::new(),
            in_full: Vec::new(),
            can_be_coarser: true,
        };
        let mut before: Option<&Piece> = None;
        let mut full = 0;
        for (index, piece) in drive.pieces().iter().enumerate() {
            if before.is_none_or(|before| drive.jumps(before, piece)) {
                schedule.push(moment(drive, (index, piece), 0.0, 0.0), Some(full))?;
                full += 1;
            }
            let ends = ends(piece, &Pace::new(steps, piece), &exact_s)?;
            schedule.can_be_coarser &= ends.len() > 1;
            schedule.follow(drive, (index, piece), (&ends, full), fineness)?;
            full += ends.len();
            before = Some(piece);
        }
        if fineness == Fineness::FULL {
            // The last moment at a time is the one after a jump.
            let moments = &schedule.moments;
            let last_at = |time_s: &f64| moments.partition_point(|m| m.time_s <= *time_s) - 1;
            schedule.requested = requested_s.iter().map(last_at).collect();
        }
        Ok(schedule)
    }

    fn push(&mut self, moment: Moment, in_full: Option<usize>) -> Result<(), ScheduleError> {
        if self.moments.len() >= MAX_MOMENTS {
            return Err(ScheduleError::TooMany);
        }
        self.moments.push(moment);
        self.in_full.push(in_full);
        Ok(())
    }

    /// Adds those moments of one piece that the fineness keeps or brings, its end but not its beginning. `ends` are those of the
    /// full schedule, the first of which is its moment number `full`.
    fn follow(
        &mut self,
        drive: &SegmentedDrive,
        (index, piece): (usize, &Piece),
        (ends, full): (&[End], usize),
        fineness: Fineness,
    ) -> Result<(), ScheduleError> {
        let mut since_s = 0.0;
        for (k, end) in ends.iter().enumerate() {
            let parts = match fineness {
                Fineness::EveryNth(n) if (k + 1) % n != 0 && k + 1 < ends.len() => continue,
                Fineness::EveryNth(_) => 1,
                Fineness::Split(parts) => parts,
            };
            let (begin_s, step_s) = (since_s, end.since_s - since_s);
            let within = (1..parts).map(|part| {
                let since_s = begin_s + step_s * part as f64 / parts as f64;
                let time_s = piece.start_s + since_s;
                (End { since_s, time_s }, None)
            });
            for (end, in_full) in within.chain([(*end, Some(full + k))]) {
                let next = Moment {
                    time_s: end.time_s,
                    ..moment(drive, (index, piece), end.since_s, end.since_s - since_s)
                };
                self.push(next, in_full)?;
                since_s = end.since_s;
            }
        }
        Ok(())
    }
}

/// The requested times, those that differ from a joint by rounding moved onto it.
fn within(drive: &SegmentedDrive, requested_s: &[f64]) -> Result<Vec<f64>, ScheduleError> {
    let duration_s = drive.duration_s();
    let slack_s = SAME_TIME * duration_s;
    let joints_s: Vec<f64> = drive.joints().iter().map(|joint| joint.time_s).collect();
    let place = |&time_s: &f64| {
        if !(-slack_s..=duration_s + slack_s).contains(&time_s) {
            return Err(ScheduleError::Outside { time_s, duration_s });
        }
        let after = joints_s.partition_point(|joint| *joint < time_s - slack_s);
        let near = joints_s
            .get(after)
            .filter(|joint| **joint <= time_s + slack_s);
        Ok(near.copied().unwrap_or(time_s))
    };
    requested_s.iter().map(place).collect()
}

fn moment(
    drive: &SegmentedDrive,
    (index, piece): (usize, &Piece),
    since_s: f64,
    step_s: f64,
) -> Moment {
    Moment {
        time_s: piece.start_s + since_s,
        step_s,
        value: drive.value_in(piece, since_s),
        segment: piece.segment,
        piece: index,
        since_s,
    }
}

/// The end of a step: the time since its piece began, and since the history began (s).
#[derive(Debug, Clone, Copy)]
struct End {
    since_s: f64,
    time_s: f64,
}

/// The ends of the steps of one piece.
fn ends(piece: &Piece, pace: &Pace, exact_s: &[f64]) -> Result<Vec<End>, ScheduleError> {
    let first = exact_s.partition_point(|t| *t <= piece.start_s);
    let mut inside = exact_s[first..]
        .iter()
        .copied()
        .take_while(|t| *t < piece.end_s())
        .peekable();
    let mut ends = Vec::new();
    let mut since_s = 0.0;
    while since_s < piece.duration_s {
        let next_s = pace.after(since_s).min(piece.duration_s);
        // Within the piece's own time, which keeps its digits.
        let exact = inside.next_if(|t| *t - piece.start_s <= next_s * (1.0 + SAME_TIME));
        let next_s = exact.map_or(next_s, |t| t - piece.start_s);
        while inside.next_if(|t| *t - piece.start_s <= next_s).is_some() {}
        if ends.len() >= MAX_MOMENTS || next_s <= since_s {
            return Err(ScheduleError::TooMany);
        }
        ends.push(End {
            since_s: next_s,
            time_s: exact.unwrap_or(piece.start_s + next_s),
        });
        since_s = next_s;
    }
    Ok(ends)
}

/// The rhythm of the steps within one piece.
struct Pace {
    /// The first step, and the factor by which the time since the beginning grows with each.
    first_s: f64,
    growth: f64,
    /// Times at whole multiples of this are hit, and no step is longer.
    grid_s: f64,
    /// The end of the piece (s).
    end_s: f64,
}

impl Pace {
    fn new(steps: Steps, piece: &Piece) -> Self {
        let longest_s = piece.longest_step_s.unwrap_or(f64::INFINITY);
        match steps {
            Steps::Given { step_s } => Self {
                first_s: f64::INFINITY,
                growth: f64::INFINITY,
                grid_s: step_s,
                end_s: piece.duration_s,
            },
            Steps::Chosen { shortest_time_s } => {
                let first_s = shortest_time_s.map_or(f64::INFINITY, |t| FIRST_STEP * t);
                let (first_s, growth) = if piece.is_continued_table {
                    (
                        first_s.max(TABLE_FIRST_STEP * piece.duration_s),
                        TABLE_GROWTH,
                    )
                } else {
                    (first_s, 10_f64.powf(1.0 / STEPS_PER_DECADE))
                };
                Self {
                    first_s,
                    growth,
                    grid_s: longest_s,
                    end_s: piece.duration_s,
                }
            }
        }
    }

    /// The time after this one, both since the beginning of the piece.
    fn after(&self, since_s: f64) -> f64 {
        // The multiple that follows; one that lies within rounding counts as passed. Not the last one before the end,
        // where it differs from the end by rounding.
        let multiple = ((since_s / self.grid_s + 1e-9).floor() + 1.0) * self.grid_s;
        let stop_s = if multiple.is_finite() && multiple < self.end_s * (1.0 - 1e-9) {
            multiple
        } else {
            self.end_s
        };
        let grown_s = (since_s * self.growth).max(since_s + self.first_s);
        let stump_s = STUMP * (grown_s - since_s);
        if grown_s + stump_s < stop_s {
            grown_s
        } else {
            stop_s
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Control, Segment};
    use super::*;

    fn drive(segments: Vec<Segment>) -> SegmentedDrive {
        SegmentedDrive::new(Control::Load, segments).unwrap()
    }

    fn step(to: f64, duration_s: f64) -> Segment {
        Segment::Step { to, duration_s }
    }

    fn times(schedule: &Schedule) -> Vec<f64> {
        schedule.moments.iter().map(|m| m.time_s).collect()
    }

    const CHOSEN: Steps = Steps::Chosen {
        shortest_time_s: Some(1.0),
    };

    #[test]
    fn a_given_step_counts_from_each_joint_and_jumps_are_two_states_at_one_time() {
        let history = drive(vec![step(1.0, 2.5), step(2.0, 1.0)]);
        let schedule =
            Schedule::new(&history, Steps::Given { step_s: 1.0 }, &[0.0, 1.3, 2.5]).unwrap();
        assert_eq!(times(&schedule), [0.0, 1.0, 1.3, 2.0, 2.5, 2.5, 3.5]);
        let values: Vec<f64> = schedule.moments.iter().map(|m| m.value).collect();
        assert_eq!(values, [1.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0]);
        // At the jump the state after it.
        assert_eq!(schedule.requested, [0, 2, 5]);
        assert!(schedule.moments[5].is_jump() && !schedule.moments[4].is_jump());
    }

    #[test]
    fn a_hold_begins_at_a_hundredth_of_the_shortest_time_and_goes_on_in_proportion() {
        let history = drive(vec![step(1.0, 1e6)]);
        let schedule = Schedule::new(&history, CHOSEN, &[]).unwrap();
        assert!((schedule.moments[1].step_s - 0.01).abs() < 1e-15);
        for pair in times(&schedule).windows(2).skip(20) {
            let growth = pair[1] / pair[0];
            // 10^(1/20) = 1.122; the last step takes what is left.
            assert!(growth < 1.19 && growth > 1.0, "{growth}");
        }
        // Eight equal steps until 12 % of the time is longer than the first, then twenty per decade for seven decades.
        assert!((145..=160).contains(&schedule.moments.len()));
    }

    #[test]
    fn a_smooth_drive_is_resolved_whatever_the_body() {
        let sine = Segment::Sine {
            mean: 2.0,
            amplitude: 1.0,
            angular_frequency_rad_per_s: std::f64::consts::TAU / 10.0,
            phase_rad: 0.0,
            cycles: 3.0,
        };
        let ramp = Segment::Ramp {
            to: 5.0,
            duration_s: 7.0,
        };
        for shortest_time_s in [None, Some(1e-6), Some(1.0), Some(1e6)] {
            let steps = Steps::Chosen { shortest_time_s };
            let schedule = Schedule::new(&drive(vec![sine.clone()]), steps, &[]).unwrap();
            let longest = schedule
                .moments
                .iter()
                .map(|m| m.step_s)
                .fold(0.0, f64::max);
            // 200 per cycle; the time stands for 1.5 steps where a stump is merged.
            assert!(longest <= 0.05 * 1.5 + 1e-12, "{longest}");
            // The crests are among the moments.
            let crest = schedule.moments.iter().map(|m| m.value).fold(0.0, f64::max);
            assert!((crest - 3.0).abs() < 1e-12);
            let schedule = Schedule::new(&drive(vec![ramp.clone()]), steps, &[]).unwrap();
            assert!(schedule.moments.len() > 100 && schedule.moments.len() < 300);
        }
    }

    #[test]
    fn steps_add_up_to_the_time_and_grow_evenly() {
        let history = drive(vec![
            step(1.0, 5.0),
            Segment::Ramp {
                to: 3.0,
                duration_s: 50.0,
            },
        ]);
        let schedule = Schedule::new(&history, CHOSEN, &[0.3, 17.7, 55.0]).unwrap();
        let mut sum = 0.0;
        for moment in &schedule.moments {
            sum += moment.step_s;
            assert!((sum - moment.time_s).abs() < 1e-12);
        }
        for (index, time_s) in schedule.requested.iter().zip([0.3, 17.7, 55.0]) {
            assert!((schedule.moments[*index].time_s - time_s).abs() < 1e-12);
        }
        // Within a step the drive is where it says it is.
        for moment in schedule.moments.iter().filter(|m| !m.is_jump()) {
            for fraction in [0.0, 0.25, 1.0] {
                let time_s = moment.time_s - (1.0 - fraction) * moment.step_s;
                let expected = if time_s <= 5.0 {
                    1.0
                } else {
                    1.0 + (time_s - 5.0) / 25.0
                };
                let found = history.value_within(moment, fraction);
                assert!((found - expected).abs() < 1e-12, "{time_s}: {found}");
            }
        }
        // Only the first state is a jump: the ramp goes on from the step.
        assert_eq!(schedule.moments.iter().filter(|m| m.is_jump()).count(), 1);
    }

    #[test]
    fn every_point_of_a_table_is_hit_with_few_steps_between() {
        let times_s: Vec<f64> = (0..=1000).map(|k| f64::from(k) * 0.37).collect();
        let values: Vec<f64> = (0..=1000).map(|k| 1.0 + 0.5 * f64::from(k % 3)).collect();
        let history = drive(vec![Segment::Table {
            times_s: times_s.clone(),
            values: values.clone(),
        }]);
        for steps in [CHOSEN, Steps::Given { step_s: 1e3 }] {
            let schedule = Schedule::new(&history, steps, &times_s).unwrap();
            assert!(schedule.moments.len() <= 5 * 1000);
            for ((index, time_s), value) in schedule.requested.iter().zip(&times_s).zip(&values) {
                let moment = &schedule.moments[*index];
                assert!((moment.time_s - time_s).abs() < 1e-10);
                assert_eq!(moment.value, *value);
            }
        }
        let schedule = Schedule::new(&history, Steps::Given { step_s: 1e3 }, &[]).unwrap();
        assert_eq!(schedule.moments.len(), times_s.len());
    }

    #[test]
    fn fewer_steps_are_some_of_all_and_end_at_the_same_joints_and_jumps() {
        let ramp = Segment::Ramp {
            to: 5.0,
            duration_s: 7.0,
        };
        let history = drive(vec![ramp, step(1.0, 20.0), step(2.0, 3.0)]);
        for steps in [CHOSEN, Steps::Given { step_s: 0.3 }] {
            let of = |fineness| Schedule::of_fineness(&history, steps, &[9.1], fineness).unwrap();
            let full = of(Fineness::FULL);
            assert!(full.can_be_coarser);
            assert!(full.in_full.iter().enumerate().all(|(k, f)| *f == Some(k)));
            for n in [2, 4] {
                let fewer = of(Fineness::EveryNth(n));
                let number = (fewer.moments.len() * n) as f64 / full.moments.len() as f64;
                assert!((1.0..1.2).contains(&number), "{number}");
                let mut sum = 0.0;
                for (moment, place) in fewer.moments.iter().zip(&fewer.in_full) {
                    let same = full.moments[place.unwrap()];
                    assert_eq!((moment.time_s, moment.value), (same.time_s, same.value));
                    sum += moment.step_s;
                    assert!((sum - moment.time_s).abs() < 1e-12);
                }
                let jumps = |s: &Schedule| s.moments.iter().filter(|m| m.is_jump()).count();
                assert_eq!((jumps(&fewer), jumps(&full)), (3, 3));
                assert_eq!(fewer.moments.last().unwrap().time_s, 30.0);
            }
            let more = of(Fineness::Split(3));
            assert_eq!(more.moments.len(), 3 * (full.moments.len() - 3) + 3);
            let common = more.moments.iter().zip(&more.in_full);
            let common: Vec<f64> = common.filter_map(|(m, f)| f.map(|_| m.time_s)).collect();
            assert_eq!(common, times(&full));
        }
        // A single step between two joints leaves none out.
        let long = Schedule::new(&history, Steps::Given { step_s: 10.0 }, &[]).unwrap();
        assert!(!long.can_be_coarser);
    }

    #[test]
    fn what_cannot_be_followed_is_refused() {
        let history = drive(vec![step(1.0, 10.0)]);
        let refuse = |steps, requested: &[f64]| Schedule::new(&history, steps, requested);
        for step_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                refuse(Steps::Given { step_s }, &[]),
                Err(ScheduleError::Step { .. })
            ));
        }
        assert_eq!(
            refuse(Steps::Given { step_s: 1e-9 }, &[]),
            Err(ScheduleError::TooMany)
        );
        for time_s in [-1.0, 10.1, f64::NAN] {
            assert!(matches!(
                refuse(CHOSEN, &[time_s]),
                Err(ScheduleError::Outside { .. })
            ));
        }
    }
}
