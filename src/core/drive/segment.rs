//! A segment of a drive history, a step, a ramp, a polynomial, a sine or a table: its pieces, and how a file has it.

use super::piece::{Form, Piece};
use super::{Control, PHASE, PRESCRIBED};
use crate::quantity::Dimension::{AngularFrequency, Frequency, Time};
use crate::quantity::key::{Entries, Key, Kind, number, quantity};
use crate::quantity::rows::Rows;
use crate::quantity::setting::Setting;
use crate::quantity::{Dimension, format_human};
use crate::{choice, keys};

choice! {
    /// The kind of the segment; what it needs is listed below.
    KIND = "kind", SegmentKind, BY_KIND:
    /// A jump to a constant value.
    Step = "step": &[&[TARGET, DURATION]];
    /// A straight line from the end of the previous segment.
    Ramp = "ramp": &[&[TARGET, DURATION]];
    /// A polynomial of time.
    Polynomial = "polynomial": &[&[COEFFICIENTS, DURATION]];
    /// mean + amplitude sin(omega t + phase): exactly one of `angular_frequency` and `frequency`.
    Sine = "sine": &[&[SINE_MEAN, SINE_AMPLITUDE, PHASE, CYCLES]],
        &[&[&[SINE_ANGULAR_FREQUENCY]], &[&[SINE_FREQUENCY]]];
    /// Straight lines between points: a `file`, or `times` and `values`.
    Table = "table": &[], &[&[&[FILE]], &[&[TIMES, VALUES]]];
}

/// An item of `segments`.
pub static SEGMENT: Rows = Rows {
    means: " A part of the history.",
    keys: &[&[KIND]],
    others: BY_KIND,
};

keys! {
    /// The value held, or reached at the end.
    TARGET = "to", Kind::Number(PRESCRIBED);
    /// Duration of the segment.
    DURATION = "duration", Kind::Number(quantity(Time).above_zero());
    /// Coefficients of 1, t, t^2, ... in SI units, with t from the start of the segment.
    COEFFICIENTS = "coefficients", Kind::Numbers(number("2.0"), Entries::ANY);
    /// Mean.
    SINE_MEAN = "mean", Kind::Number(PRESCRIBED);
    /// Amplitude.
    SINE_AMPLITUDE = "amplitude", Kind::Number(PRESCRIBED.above_zero());
    /// Number of cycles, not necessarily whole.
    CYCLES = "cycles", Kind::Number(number("4.0").above_zero());
    /// Angular frequency; Hz is accepted too.
    SINE_ANGULAR_FREQUENCY = "angular_frequency", Kind::Number(quantity(AngularFrequency).above_zero());
    /// Frequency; rad/s is accepted too.
    SINE_FREQUENCY = "frequency", Kind::Number(quantity(Frequency).above_zero());
    /// CSV file with the columns `time_s` and `load_n` or `approach_m`.
    FILE = "file", Kind::Text;
    /// Times, in place of a file; the first is 0 s, two equal ones are a jump.
    TIMES = "times", Kind::Numbers(quantity(Time), Entries::ANY);
    /// Their values.
    VALUES = "values", Kind::Numbers(PRESCRIBED, Entries::ANY);
}

/// One segment of a drive history. Values are loads in N or approaches in m, as the history's [`Control`] says.
#[derive(Debug, Clone, PartialEq)]
pub enum Segment {
    /// A jump to a value, which is then held.
    Step { to: f64, duration_s: f64 },
    /// From the value before, evenly to another.
    Ramp { to: f64, duration_s: f64 },
    /// Sum of c_k t^k, t in seconds since the segment began.
    Polynomial {
        coefficients: Vec<f64>,
        duration_s: f64,
    },
    /// mean + amplitude sin(omega t + phase), t since the segment began, for this many cycles (not necessarily a whole
    /// number).
    Sine {
        mean: f64,
        amplitude: f64,
        angular_frequency_rad_per_s: f64,
        phase_rad: f64,
        cycles: f64,
    },
    /// Points joined by straight lines; times count from the beginning of the segment. Two points at one time are a jump.
    Table { times_s: Vec<f64>, values: Vec<f64> },
}

/// What is wrong with a segment.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SegmentProblem {
    #[error("its duration is {duration_s} s; it must be positive and finite")]
    Duration { duration_s: f64 },
    #[error("its {what} is {value}; it must be finite")]
    NotFinite { what: &'static str, value: f64 },
    #[error("its {what} is {value}; it must be positive and finite")]
    NotPositive { what: &'static str, value: f64 },
    #[error("a polynomial needs at least one coefficient")]
    NoCoefficients,
    #[error("a table needs as many values as times, but has {values} and {times}")]
    Lengths { times: usize, values: usize },
    #[error("a table needs at least two points, but has {points}")]
    TooFewPoints { points: usize },
    #[error(
        "the times of a table count from the beginning of its segment, so that the first is 0 s, not {time_s} s"
    )]
    FirstTime { time_s: f64 },
    #[error("time {time_s} s of point {} does not follow {before_s} s of the point before", .point + 1)]
    Order {
        point: usize,
        time_s: f64,
        before_s: f64,
    },
    #[error(
        "more than two points stand at {time_s} s; two are a jump, from the first to the second"
    )]
    TripleJump { time_s: f64 },
    #[error(
        "the load falls to {} at {} of the history, {} after the segment began: {}",
        format_human(*load_n, Dimension::Force, 4),
        format_human(*time_s, Dimension::Time, 6),
        format_human(*since_s, Dimension::Time, 6),
        carried(*pull_off_n)
    )]
    Pull {
        load_n: f64,
        time_s: f64,
        since_s: f64,
        /// The pull (N) at which the indenter comes off; 0 without an attraction.
        pull_off_n: f64,
    },
}

/// What a contact can carry.
fn carried(pull_off_n: f64) -> String {
    match pull_off_n > 0.0 {
        true => format!(
            "the indenter comes off the surface at {}",
            format_human(-pull_off_n, Dimension::Force, 4)
        ),
        false => "a contact without adhesion cannot carry a pull".to_owned(),
    }
}

/// Time steps that resolve a cycle, and a ramp, polynomial or table.
const STEPS_PER_CYCLE: f64 = 200.0;
const STEPS_PER_SEGMENT: f64 = 100.0;

impl Segment {
    /// The keys of the segment in a file, under such a control.
    pub fn settings(&self, control: Control) -> Vec<Setting> {
        let to = |key: &Key, value: &f64| key.of(control.dimension()).setting(*value);
        let bare = |key: &Key, values: &[f64]| key.setting(values.to_vec()).map(Setting::bare);
        let (kind, settings) = match self {
            Self::Step {
                to: end,
                duration_s,
            } => (
                SegmentKind::Step,
                vec![to(&TARGET, end), DURATION.setting(*duration_s)],
            ),
            Self::Ramp {
                to: end,
                duration_s,
            } => (
                SegmentKind::Ramp,
                vec![to(&TARGET, end), DURATION.setting(*duration_s)],
            ),
            Self::Polynomial {
                coefficients,
                duration_s,
            } => (
                SegmentKind::Polynomial,
                vec![
                    COEFFICIENTS.setting(coefficients.clone()),
                    DURATION.setting(*duration_s),
                ],
            ),
            Self::Sine {
                mean,
                amplitude,
                angular_frequency_rad_per_s: omega,
                phase_rad,
                cycles,
            } => (
                SegmentKind::Sine,
                vec![
                    to(&SINE_MEAN, mean),
                    to(&SINE_AMPLITUDE, amplitude),
                    SINE_ANGULAR_FREQUENCY.setting(*omega),
                    PHASE.setting(*phase_rad),
                    CYCLES.setting(*cycles),
                ],
            ),
            Self::Table { times_s, values } => (
                SegmentKind::Table,
                vec![bare(&TIMES, times_s), bare(&VALUES, values)],
            ),
        };
        let kind = std::iter::once(KIND.setting(kind));
        kind.chain(settings).flatten().collect()
    }

    /// The shortest time (s) within which it changes.
    pub fn changes_within_s(&self) -> f64 {
        match self {
            Self::Step { duration_s, .. }
            | Self::Ramp { duration_s, .. }
            | Self::Polynomial { duration_s, .. } => *duration_s,
            Self::Sine {
                angular_frequency_rad_per_s,
                ..
            } => angular_frequency_rad_per_s.recip(),
            Self::Table { times_s, .. } => times_s.last().copied().unwrap_or(f64::INFINITY),
        }
    }

    /// The smooth pieces of the segment, which begins `start_s` after the history with the value `before` behind it.
    pub(super) fn pieces(
        &self,
        segment: usize,
        start_s: f64,
        before: f64,
    ) -> Result<Vec<Piece>, SegmentProblem> {
        let resolved = |duration_s: f64| Some(duration_s / STEPS_PER_SEGMENT);
        let (form, duration_s, longest_step_s) = match self {
            Self::Step { to, duration_s } => (Form::held(finite("value", *to)?), *duration_s, None),
            Self::Ramp { to, duration_s } => {
                let (from, to) = (before, finite("value", *to)?);
                (
                    Form::Linear { from, to },
                    *duration_s,
                    resolved(*duration_s),
                )
            }
            Self::Polynomial {
                coefficients,
                duration_s,
            } => {
                if coefficients.is_empty() {
                    return Err(SegmentProblem::NoCoefficients);
                }
                for &coefficient in coefficients {
                    finite("coefficient", coefficient)?;
                }
                let form = Form::Polynomial(coefficients.clone());
                (form, *duration_s, resolved(*duration_s))
            }
            &Self::Sine {
                mean,
                amplitude,
                angular_frequency_rad_per_s: omega,
                phase_rad,
                cycles,
            } => {
                let form = Form::Sine {
                    mean: finite("mean", mean)?,
                    amplitude: positive("amplitude", amplitude)?,
                    angular_frequency_rad_per_s: positive("angular frequency", omega)?,
                    phase_rad: finite("phase", phase_rad)?,
                };
                let cycle_s = std::f64::consts::TAU / omega;
                let duration_s = positive("number of cycles", cycles)? * cycle_s;
                (form, duration_s, Some(cycle_s / STEPS_PER_CYCLE))
            }
            Self::Table { times_s, values } => return table(segment, start_s, times_s, values),
        };
        let duration_s = checked_duration(duration_s)?;
        Ok(vec![Piece {
            form,
            segment,
            start_s,
            offset_s: 0.0,
            duration_s,
            longest_step_s,
            is_continued_table: false,
        }])
    }
}

/// The straight pieces between the points of a table.
fn table(
    segment: usize,
    start_s: f64,
    times_s: &[f64],
    values: &[f64],
) -> Result<Vec<Piece>, SegmentProblem> {
    check_table(times_s, values)?;
    let duration_s = checked_duration(times_s.last().copied().unwrap_or(0.0))?;
    let last = times_s.len() - 2;
    let mut pieces: Vec<Piece> = Vec::with_capacity(times_s.len());
    let mut after_jump = true;
    let pairs = times_s.windows(2).zip(values.windows(2));
    for (pair, (times, values)) in pairs.enumerate() {
        let length_s = times[1] - times[0];
        let straight = Form::Linear {
            from: values[0],
            to: values[1],
        };
        // A jump lies between two pieces; at an end of the table one of them has no length.
        let form = match (length_s > 0.0, pair) {
            (true, _) => straight,
            (false, 0) => Form::held(values[0]),
            (false, pair) if pair == last => Form::held(values[1]),
            (false, _) => {
                after_jump = true;
                continue;
            }
        };
        pieces.push(Piece {
            form,
            segment,
            start_s: start_s + times[0],
            offset_s: times[0],
            duration_s: length_s,
            longest_step_s: Some(duration_s / STEPS_PER_SEGMENT),
            is_continued_table: !after_jump,
        });
        after_jump = length_s == 0.0;
    }
    Ok(pieces)
}

fn check_table(times_s: &[f64], values: &[f64]) -> Result<(), SegmentProblem> {
    let points = times_s.len();
    let lengths = SegmentProblem::Lengths {
        times: points,
        values: values.len(),
    };
    refuse_unless(points == values.len(), lengths)?;
    refuse_unless(points >= 2, SegmentProblem::TooFewPoints { points })?;
    for (&time_s, &value) in times_s.iter().zip(values) {
        finite("time", time_s)?;
        finite("value", value)?;
    }
    let time_s = times_s[0];
    refuse_unless(time_s == 0.0, SegmentProblem::FirstTime { time_s })?;
    for (point, pair) in (1..).zip(times_s.windows(2)) {
        let (before_s, time_s) = (pair[0], pair[1]);
        let order = SegmentProblem::Order {
            point,
            time_s,
            before_s,
        };
        refuse_unless(time_s >= before_s, order)?;
    }
    match times_s.windows(3).find(|three| three[0] == three[2]) {
        Some(three) => Err(SegmentProblem::TripleJump { time_s: three[0] }),
        None => Ok(()),
    }
}

fn refuse_unless(holds: bool, problem: SegmentProblem) -> Result<(), SegmentProblem> {
    match holds {
        true => Ok(()),
        false => Err(problem),
    }
}

fn checked_duration(duration_s: f64) -> Result<f64, SegmentProblem> {
    positive("duration", duration_s).map_err(|_| SegmentProblem::Duration { duration_s })
}

fn finite(what: &'static str, value: f64) -> Result<f64, SegmentProblem> {
    refuse_unless(value.is_finite(), SegmentProblem::NotFinite { what, value })?;
    Ok(value)
}

fn positive(what: &'static str, value: f64) -> Result<f64, SegmentProblem> {
    let holds = value.is_finite() && value > 0.0;
    refuse_unless(holds, SegmentProblem::NotPositive { what, value })?;
    Ok(value)
}
