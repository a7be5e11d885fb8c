//! A drive history: segments one after another.

use super::piece::Piece;
use super::segment::{SEGMENT, Segment, SegmentProblem};
use super::{Control, PRESCRIBES};
use crate::keys;
use crate::quantity::key::Kind;
use crate::quantity::rows::{Rows, table};
use crate::quantity::setting::{Table, Value};

/// More segments than this belong into a table.
const MOST_SEGMENTS: usize = 10_000;

keys! {
    /// The segments, one after another; jumps between them are resolved exactly.
    SEGMENTS = "segments", Kind::Tables(&SEGMENT, MOST_SEGMENTS, ", or a table: { kind = \"table\", file = \"drive.csv\" }");
}

/// The `[drive]` block of a scenario file.
pub static HISTORY: Rows = table(
    " A history of load or approach, starting at first touch.",
    &[&[PRESCRIBES, SEGMENTS]],
);

/// Why a history is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HistoryError {
    #[error("a drive history needs at least one segment")]
    Empty,
    #[error(
        "the {} never rises above zero: there is nothing to simulate", .control.name()
    )]
    NeverTouches { control: Control },
    #[error("segment {}: {problem}", .segment + 1)]
    Segment {
        /// Counted from 0.
        segment: usize,
        problem: SegmentProblem,
    },
}

/// Where two pieces of a history meet, its beginning and its end included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Time since the history began (s).
    pub time_s: f64,
    /// The value before; `None` at the beginning.
    pub before: Option<f64>,
    /// The value after, another one at a jump; `None` at the end.
    pub after: Option<f64>,
}

/// A drive history made of segments. Before it begins the body is undisturbed: load 0, approach 0.
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentedDrive {
    control: Control,
    segments: Vec<Segment>,
    pieces: Vec<Piece>,
    maximum: f64,
    pull_off_n: f64,
}

/// Below this part of what makes it up, a load is zero plus rounding.
const ZERO_LOAD: f64 = 1e-14;
/// Values at a joint that differ by less than this part of their size differ by rounding.
const SAME: f64 = 1e-12;
impl SegmentedDrive {
    /// The block of a file that gives the same history again.
    pub fn table(&self) -> Table {
        let segments = self.segments.iter();
        let segments = segments.map(|segment| segment.settings(self.control));
        Table::new("drive")
            .and(PRESCRIBES.setting(self.control))
            .and(SEGMENTS.setting(Value::Tables(segments.collect())))
    }

    /// A history of these segments.
    ///
    /// # Errors
    /// [`HistoryError`]: a number out of range, a table out of order, a load that becomes a pull, a history that never
    /// touches the body.
    pub fn new(control: Control, segments: Vec<Segment>) -> Result<Self, HistoryError> {
        Self::attracted(control, segments, 0.0)
    }

    /// The same on an indenter that is attracted by this much (N), which a load may pull as far as that; an infinite attraction is one
    /// of which the contact says how much it carries. Moments, joints and values within
    /// steps are then of the load on the contact, which the attraction adds to.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn attracted(
        control: Control,
        segments: Vec<Segment>,
        pull_off_n: f64,
    ) -> Result<Self, HistoryError> {
        let mut pieces: Vec<Piece> = Vec::new();
        for (index, segment) in segments.iter().enumerate() {
            let (start_s, before) = pieces.last().map_or((0.0, 0.0), |last| {
                (last.end_s(), last.value(last.duration_s))
            });
            let placed = segment.pieces(index, start_s, before).and_then(|new| {
                new.iter()
                    .try_for_each(|piece| piece.check(control, pull_off_n))?;
                Ok(new)
            });
            pieces.extend(placed.map_err(|problem| HistoryError::Segment {
                segment: index,
                problem,
            })?);
        }
        if pieces.is_empty() {
            return Err(HistoryError::Empty);
        }
        let largest = pieces.iter().map(|piece| piece.extremes().1.value);
        let maximum = largest.fold(f64::NEG_INFINITY, f64::max);
        if maximum + pull_off_n <= 0.0 {
            return Err(HistoryError::NeverTouches { control });
        }
        Ok(Self {
            control,
            segments,
            pieces,
            maximum,
            pull_off_n,
        })
    }

    /// The constant attraction (N) that the contact carries beside a load, 0 without one.
    pub fn pull_off_n(&self) -> f64 {
        super::constant_n(self.pull_off_n)
    }

    /// What is prescribed.
    pub fn control(&self) -> Control {
        self.control
    }

    /// The segments, in order.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// When a segment begins (s); `None` for one that there is not.
    pub fn start_s(&self, segment: usize) -> Option<f64> {
        let mut pieces = self.pieces.iter();
        let first = pieces.find(|piece| piece.segment == segment);
        first.map(|piece| piece.start_s)
    }

    /// Length of the history (s).
    pub fn duration_s(&self) -> f64 {
        self.pieces.last().map_or(0.0, Piece::end_s)
    }

    /// The largest value of the history, between joints too; above zero without an attraction.
    pub fn maximum(&self) -> f64 {
        self.maximum
    }

    /// Where pieces meet: the ends of segments and the points of tables, in order, the beginning and the end of the history
    /// among them.
    pub fn joints(&self) -> Vec<Joint> {
        let mut joints: Vec<Joint> = Vec::with_capacity(self.pieces.len() + 1);
        let mut before = None;
        for piece in &self.pieces {
            joints.push(Joint {
                time_s: piece.start_s,
                before,
                after: Some(self.value_in(piece, 0.0)),
            });
            before = Some(self.value_in(piece, piece.duration_s));
        }
        joints.push(Joint {
            time_s: self.duration_s(),
            before,
            after: None,
        });
        joints
    }

    /// The smooth pieces.
    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The value on the contact this long after a piece began. A load that is zero but for rounding is zero: a contact is out of contact
    /// at load zero, and a pull of 1e-16 N would be no load at all.
    pub(super) fn value_in(&self, piece: &Piece, time_s: f64) -> f64 {
        let value = piece.value(time_s) + self.pull_off_n();
        let rounding = ZERO_LOAD * (piece.scale() + self.pull_off_n());
        let may_pull = self.pull_off_n.is_infinite();
        match self.control == Control::Load && !may_pull && value <= rounding {
            true => 0.0,
            false => value,
        }
    }

    /// Whether the drive jumps from the end of one piece to the beginning of the next.
    pub(super) fn jumps(&self, piece: &Piece, next: &Piece) -> bool {
        let (before, after) = (
            self.value_in(piece, piece.duration_s),
            self.value_in(next, 0.0),
        );
        (after - before).abs() > SAME * piece.scale().max(next.scale())
    }
}

impl Piece {
    /// Time from the beginning of the history to the end of the piece (s).
    pub(super) fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// Refuses values that are no numbers, and pulls.
    fn check(&self, control: Control, pull_off_n: f64) -> Result<(), SegmentProblem> {
        if !self.scale().is_finite() {
            let value = self.value(self.duration_s);
            return Err(SegmentProblem::NotFinite {
                what: "value",
                value,
            });
        }
        let (least, _) = self.extremes();
        if control == Control::Load
            && least.value < -pull_off_n - ZERO_LOAD * (self.scale() + pull_off_n)
        {
            return Err(SegmentProblem::Pull {
                load_n: least.value,
                time_s: self.start_s + least.time_s,
                since_s: self.offset_s + least.time_s,
                pull_off_n,
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(to: f64, duration_s: f64) -> Segment {
        Segment::Step { to, duration_s }
    }

    fn ramp(to: f64, duration_s: f64) -> Segment {
        Segment::Ramp { to, duration_s }
    }

    fn sine(mean: f64, amplitude: f64, phase_rad: f64, cycles: f64) -> Segment {
        Segment::Sine {
            mean,
            amplitude,
            angular_frequency_rad_per_s: std::f64::consts::TAU,
            phase_rad,
            cycles,
        }
    }

    fn table(times_s: &[f64], values: &[f64]) -> Segment {
        Segment::Table {
            times_s: times_s.to_vec(),
            values: values.to_vec(),
        }
    }

    fn load(segments: Vec<Segment>) -> Result<SegmentedDrive, HistoryError> {
        SegmentedDrive::new(Control::Load, segments)
    }

    fn problem(segments: Vec<Segment>) -> (usize, SegmentProblem) {
        match load(segments) {
            Err(HistoryError::Segment { segment, problem }) => (segment, problem),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn every_joint_has_the_value_before_and_after_it() {
        let drive = load(vec![
            ramp(2.0, 4.0),
            step(10.0, 200.0),
            ramp(2.0, 5.0),
            Segment::Polynomial {
                coefficients: vec![2.0, 0.1, 0.03],
                duration_s: 3.0,
            },
            sine(2.0, 1.0, 0.0, 4.0),
            table(&[0.0, 1.0, 1.0, 3.0], &[2.0, 4.0, 0.0, 0.0]),
        ])
        .unwrap();
        let joint = |time_s, before, after| Joint {
            time_s,
            before,
            after,
        };
        let expected = [
            joint(0.0, None, Some(0.0)),
            joint(4.0, Some(2.0), Some(10.0)),
            joint(204.0, Some(10.0), Some(10.0)),
            joint(209.0, Some(2.0), Some(2.0)),
            // 2 + 0.3 + 0.27 at the end of the polynomial.
            joint(212.0, Some(2.57), Some(2.0)),
            joint(216.0, Some(2.0), Some(2.0)),
            joint(217.0, Some(4.0), Some(0.0)),
            joint(219.0, Some(0.0), None),
        ];
        let joints = drive.joints();
        assert_eq!(joints.len(), expected.len());
        for (found, expected) in joints.iter().zip(expected) {
            let same = |a: Option<f64>, b: Option<f64>| match (a, b) {
                // Rounding of a few operations on numbers up to 200, and of the sine of 8 pi.
                (Some(a), Some(b)) => (a - b).abs() < 1e-13,
                (a, b) => a == b,
            };
            assert!((found.time_s - expected.time_s).abs() < 1e-12);
            assert!(same(found.before, expected.before), "{found:?}");
            assert!(same(found.after, expected.after), "{found:?}");
        }
        assert_eq!(drive.maximum(), 10.0);
    }

    #[test]
    fn jumps_at_the_ends_of_a_table_are_kept() {
        let drive = load(vec![
            step(3.0, 1.0),
            table(&[0.0, 0.0, 2.0, 2.0], &[3.0, 5.0, 6.0, 1.0]),
            ramp(0.0, 1.0),
        ])
        .unwrap();
        let joints = drive.joints();
        let states: Vec<_> = joints
            .iter()
            .map(|j| (j.time_s, j.before, j.after))
            .collect();
        assert_eq!(
            states,
            [
                (0.0, None, Some(3.0)),
                (1.0, Some(3.0), Some(3.0)),
                (1.0, Some(3.0), Some(5.0)),
                (3.0, Some(6.0), Some(1.0)),
                (3.0, Some(1.0), Some(1.0)),
                (4.0, Some(0.0), None),
            ]
        );
    }

    #[test]
    fn a_load_that_touches_zero_is_zero_there_and_one_that_goes_below_is_refused_with_its_place() {
        let touching = load(vec![sine(1.0, 1.0, 1.5 * std::f64::consts::PI, 3.0)]).unwrap();
        assert_eq!(touching.joints()[0].after, Some(0.0));
        assert_eq!(touching.joints()[1].before, Some(0.0));
        let (segment, found) = problem(vec![step(1.0, 2.0), sine(1.0, 1.5, 0.0, 1.0)]);
        assert_eq!(segment, 1);
        // The trough of a sine lies at three quarters of its cycle.
        let SegmentProblem::Pull {
            load_n,
            time_s,
            since_s,
            pull_off_n: 0.0,
        } = found
        else {
            panic!("{found:?}")
        };
        assert!((load_n + 0.5).abs() < 1e-12);
        assert!((time_s - 2.75).abs() < 1e-12 && (since_s - 0.75).abs() < 1e-12);
        // A quarter of the same sine stays above zero.
        assert!(load(vec![sine(1.0, 1.5, 0.0, 0.25)]).is_ok());
        for bad in [
            step(-1.0, 1.0),
            ramp(-1e-9, 1.0),
            table(&[0.0, 1.0], &[1.0, -1.0]),
            Segment::Polynomial {
                // Below zero between 0.4 and 0.6 only.
                coefficients: vec![0.24, -1.0, 1.0],
                duration_s: 1.0,
            },
        ] {
            assert!(matches!(problem(vec![bad]).1, SegmentProblem::Pull { .. }));
        }
        // (t - 1/2)^2 touches zero and stays.
        assert!(
            load(vec![Segment::Polynomial {
                coefficients: vec![0.25, -1.0, 1.0],
                duration_s: 1.0
            }])
            .is_ok()
        );
    }

    #[test]
    fn an_approach_may_be_negative_but_must_reach_the_surface() {
        let approach = |segments| SegmentedDrive::new(Control::Approach, segments);
        assert!(approach(vec![step(-1e-6, 1.0), ramp(1e-6, 1.0)]).is_ok());
        assert!(matches!(
            approach(vec![step(-1e-6, 1.0), ramp(0.0, 1.0)]),
            Err(HistoryError::NeverTouches { .. })
        ));
        assert!(matches!(
            load(vec![step(0.0, 1.0)]),
            Err(HistoryError::NeverTouches { .. })
        ));
        assert_eq!(load(Vec::new()), Err(HistoryError::Empty));
    }

    #[test]
    fn numbers_that_make_no_segment_are_refused_by_name() {
        let inf = f64::INFINITY;
        assert!(matches!(
            problem(vec![step(1.0, 0.0)]).1,
            SegmentProblem::Duration { .. }
        ));
        assert!(matches!(
            problem(vec![step(inf, 1.0)]).1,
            SegmentProblem::NotFinite { what: "value", .. }
        ));
        assert!(matches!(
            problem(vec![sine(1.0, 0.0, 0.0, 1.0)]).1,
            SegmentProblem::NotPositive {
                what: "amplitude",
                ..
            }
        ));
        assert!(matches!(
            problem(vec![table(&[1.0, 2.0], &[1.0, 2.0])]).1,
            SegmentProblem::FirstTime { time_s: 1.0 }
        ));
        assert!(matches!(
            problem(vec![table(&[0.0, 2.0, 1.0], &[1.0, 2.0, 3.0])]).1,
            SegmentProblem::Order { point: 2, .. }
        ));
        assert!(matches!(
            problem(vec![table(&[0.0, 1.0, 1.0, 1.0, 2.0], &[1.0; 5])]).1,
            SegmentProblem::TripleJump { time_s: 1.0 }
        ));
        assert!(matches!(
            problem(vec![table(&[0.0, 1.0], &[1.0])]).1,
            SegmentProblem::Lengths { .. }
        ));
        let overflow = Segment::Polynomial {
            coefficients: vec![1.0, 1e300],
            duration_s: 1e30,
        };
        assert!(matches!(
            problem(vec![step(1.0, 1.0), overflow]),
            (1, SegmentProblem::NotFinite { .. })
        ));
    }
}
