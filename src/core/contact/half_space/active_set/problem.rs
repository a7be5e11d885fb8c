//! What the active set is given: a surface, what is imposed on it, work space and how long to go on.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::super::convolution::{ConvolutionError, SINGLE, Scratch};
use super::super::grid::Grid;
use crate::contact::{ContactError, go_on};

/// A surface in cells that yields in proportion to the pressure: of a window, or of a period.
pub(in super::super) trait Elastic {
    /// Its cells.
    fn grid(&self) -> &Grid;

    /// The displacement of every cell by these pressures (Pa), in units of [`Elastic::unit_m`] per 1/Pa, to [`SINGLE`]. In that unit it is
    /// of the size of the pressures, so that no system of units leaves the range of single precision.
    fn displace(
        &self,
        pressure: &[f32],
        displacement: &mut [f32],
        scratch: &mut Scratches,
    ) -> Result<(), ConvolutionError>;

    /// What a displacement by [`Elastic::displace`] is counted in (m).
    fn unit_m(&self) -> f64;

    /// Nearly the inverse of that, symmetric and positive, but for a factor; in these rows alone.
    fn precondition(
        &self,
        gap: &[f32],
        pressure: &mut [f32],
        rows: Range<usize>,
        scratch: &mut Scratches,
    ) -> Result<(), ConvolutionError>;

    /// The sum of the pressures (Pa), which is above zero or nil, and the displacement (m) to which gaps are relative, that they cause
    /// or a bound of it from below; the gap (m) is the one they leave before the approach is taken off.
    fn load(&self, pressure: &[f64], gap_m: &[f64], compliance_per_pa: f64) -> (f64, f64);
}

/// What the problem of an instant is, apart from its fields.
#[derive(Clone, Copy)]
pub(in super::super) struct InstantOfCells<'a> {
    pub(in super::super) elastic: &'a dyn Elastic,
    pub(in super::super) compliance_per_pa: f64,
    /// Sum of the pressures, where the load is prescribed.
    pub(in super::super) target_sum: Option<f64>,
    pub(in super::super) approach_m: Option<f64>,
    pub(in super::super) tolerance: f64,
    /// Steps of the instant after which this is not the way.
    pub(in super::super) fast_steps: usize,
    /// What rounding leaves in a gap (m).
    pub(in super::super) noise_m: f64,
    /// Whether the contact may have many patches.
    pub(in super::super) has_patches: bool,
}

impl InstantOfCells<'_> {
    /// What a displacement by [`Elastic::displace`] lifts the surface by (m).
    pub(super) fn lift_m(&self) -> f64 {
        self.compliance_per_pa * self.elastic.unit_m()
    }
}

/// How far an iterate is from the solution.
#[derive(Debug, Clone, Copy, Default)]
pub(in super::super) struct IterateState {
    pub(in super::super) approach_m: f64,
    pub(in super::super) pressure_sum: f64,
    /// What the tolerance bounds.
    pub(in super::super) residual: f64,
    /// Length to which gaps are relative (m).
    pub(in super::super) reference_m: f64,
}

/// Work space of the operators: in double precision for a gap, in single for changes of it, and for what shows the way.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Scratches {
    pub(in super::super) convolution: Scratch,
    pub(in super::super) changes: Scratch<f32>,
    pub(in super::super) preconditioner: Scratch<f32>,
}

/// The part of a tolerance that single precision may take up.
const DRIFT: f64 = 0.1;

/// Work counted, and whether to go on with it.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Work {
    pub(in super::super) steps: usize,
    pub(in super::super) convolutions: usize,
    /// What single precision may have left in the gap (m) since that was last computed afresh.
    drift_m: f64,
    /// Set from outside to end the instant.
    interrupt: Option<Arc<AtomicBool>>,
}

impl Work {
    /// No work yet, which this flag ends.
    pub(in super::super) fn until(interrupt: Option<Arc<AtomicBool>>) -> Self {
        Self {
            interrupt,
            ..Self::default()
        }
    }

    /// A gap computed afresh.
    pub(in super::super) fn count_fresh_gap(&mut self) {
        self.convolutions += 1;
        self.drift_m = 0.0;
    }

    /// A change of the gap, by this much (m) where it is largest, and its convolution.
    pub(super) fn count_change(&mut self, largest_m: f64) {
        self.convolutions += 1;
        self.drift_m += SINGLE * largest_m;
    }

    /// Whether the gap is as exact as this state, which solves the instant to a tolerance, asks for.
    pub(in super::super) fn is_exact(&self, state: &IterateState, tolerance: f64) -> bool {
        self.drift_m <= DRIFT * tolerance * state.reference_m
    }

    /// [`ContactError::Interrupted`] where the instant is to end.
    pub(in super::super) fn go_on(&self) -> Result<(), ContactError> {
        go_on(self.interrupt.as_deref())
    }
}

/// The part of the residual at which waiting led astray, from which on it is tried again.
const WELL_BELOW: f64 = 0.3;

/// Whether cells of negative pressure may wait for the gaps inside the contact to shrink. That is by far the faster way for many patches, and
/// may lead away from the solution: where it has, they leave at once until the residual is well below where that began.
pub(super) struct Waiting {
    is_possible: bool,
    waits: bool,
    last: f64,
    below: f64,
}

impl Waiting {
    pub(super) fn new(is_possible: bool) -> Self {
        Self {
            is_possible,
            waits: false,
            last: f64::INFINITY,
            below: f64::INFINITY,
        }
    }

    /// Whether they wait from this residual on.
    pub(super) fn after(&mut self, residual: f64) -> bool {
        if self.waits && residual > self.last {
            self.below = WELL_BELOW * self.last;
        }
        self.last = residual;
        self.waits = self.is_possible && residual < self.below;
        self.waits
    }
}
