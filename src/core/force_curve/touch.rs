//! Where a contact begins, roughly, and what the instrument adds to the force.

use std::ops::Range;

use super::fit::CurveError;
use super::record::Points;
use super::smooth::Line;
use super::springs::Springs;
use crate::contact::half_space::layer::Layer;
use crate::indenter::Axisymmetric;
use crate::measured::statistics::mean;
use crate::quantity::Dimension;

/// Points before contact that tell what the instrument adds.
const FEWEST_BEFORE: usize = 4;

/// The pull of a retraction that is no noise, drift or drag, as a part of the largest force.
const PULL: f64 = 0.1;

/// The same of a curve that ends while it is held.
const HELD: f64 = 0.3;

/// The fall of the force of a jump into contact, in standard deviations.
const JUMP: f64 = 8.0;

/// That of the points on either side that belong to it.
const FALLING: f64 = 2.0;

/// So many points are left out before and behind it.
const ABOUT: usize = 3;

/// How near (standard deviations of a point) a point is to the line of those behind it where nothing touches; and the most that this line
/// may change beside the drift, as a part of the pull.
const ON_THE_LINE: f64 = 4.0;
const FLAT: f64 = 0.1;

/// The part of the depth above which an indenter has not been retracted yet.
const RETRACTED: f64 = 0.95;

/// From which difference on a speed is another one, as a part of the fastest.
const OTHER: f64 = 0.3;

/// What the instrument adds to the force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nuisance {
    /// N.
    Offset,
    /// N/s.
    Drift,
    /// N s/m.
    Drag,
}

impl Nuisance {
    /// With its unit, as tables call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Offset => "force_offset_n",
            Self::Drift => "force_drift_n_per_s",
            Self::Drag => "drag_n_s_per_m",
        }
    }

    /// Without a unit that stands with the value.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Offset => "force offset",
            Self::Drift => "force drift / (N/s)",
            Self::Drag => "drag",
        }
    }

    /// Of what can be written with a prefix.
    pub const fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Offset => Some(Dimension::Force),
            Self::Drift => None,
            Self::Drag => Some(Dimension::Damping),
        }
    }
}

/// Where a curve begins to be a contact, as an elastic body would have it.
pub(super) struct Touch {
    pub(super) contact_point_m: f64,
    pub(super) modulus_pa: f64,
    /// Points before it.
    pub(super) before: usize,
}

/// Tries every point of the first approach as that of first contact, with a force that is constant before it and elastic from it on.
pub(super) fn touch(
    profile: &dyn Axisymmetric,
    layer: Option<Layer>,
    points: &Points,
) -> Result<Touch, CurveError> {
    let (least_m, deepest_m) = (
        points
            .indentation_m
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min),
        largest(&points.indentation_m),
    );
    if deepest_m <= least_m {
        return Err(CurveError::Still);
    }
    let springs = Springs::new(profile, layer, 1.0001 * (deepest_m - least_m));
    let springs = springs.ok_or(CurveError::NoLaw)?;
    let end = end_of_approach(points);
    let mut best: Option<(f64, Touch)> = None;
    for start in 0..end.saturating_sub(3) {
        let contact_point_m = points.indentation_m[start];
        // An offset, where something tells it.
        let has_offset = start >= FEWEST_BEFORE;
        let mut sums = [0.0; 6];
        for k in 0..=end {
            let shape = springs.elastic_m2(points.indentation_m[k] - contact_point_m);
            let (w, force) = (points.samples[k], points.force_n[k]);
            for (sum, term) in sums.iter_mut().zip([
                1.0,
                shape,
                shape * shape,
                force,
                force * shape,
                force * force,
            ]) {
                *sum += w * term;
            }
        }
        let [n, s, ss, f, fs, ff] = sums;
        let (modulus_pa, left) = match has_offset {
            true => {
                let modulus_pa = (n * fs - s * f) / (n * ss - s * s);
                let offset = (f - modulus_pa * s) / n;
                (modulus_pa, ff - modulus_pa * fs - offset * f)
            }
            false => (fs / ss, ff - fs * fs / ss),
        };
        if modulus_pa > 0.0 && best.as_ref().is_none_or(|(least, _)| left < *least) {
            let touch = Touch {
                contact_point_m,
                modulus_pa,
                before: start,
            };
            best = Some((left, touch));
        }
    }
    best.map(|(_, touch)| touch).ok_or(CurveError::NoContact)
}

/// The point where most of the depth has been reached for the first time.
fn end_of_approach(points: &Points) -> usize {
    let depths_m = points.indentation_m.iter();
    let least_m = depths_m.copied().fold(f64::INFINITY, f64::min);
    let deepest_m = largest(&points.indentation_m);
    let is_deep = |d: &f64| *d >= deepest_m - 0.02 * (deepest_m - least_m);
    points.indentation_m.iter().position(is_deep).unwrap_or(0)
}

/// The points of a retraction that pulls, as no law without attraction does, down to where the force has come back; `None` where nothing pulls.
pub(super) fn pulled(points: &Points, touch: &Touch) -> Option<Range<usize>> {
    if touch.before < FEWEST_BEFORE {
        return None;
    }
    let retraction = Retraction::of(points, touch.before)?;
    let before_n = mean(&points.force_n[..touch.before])?;
    let largest_n = largest(&points.force_n) - before_n;
    // Drift and drag have moved the baseline of the end, but not by much.
    let (least_n, after_n) = (points.force_n[retraction.pull], retraction.after_n);
    let is_pulled =
        before_n.min(after_n) - least_n > PULL * largest_n || before_n - after_n > HELD * largest_n;
    let depth_m = points.indentation_m[retraction.deepest] - touch.contact_point_m;
    let deep_m = touch.contact_point_m + RETRACTED * depth_m;
    let speeds = &points.speed_m_per_s;
    let other = OTHER * points.fastest_m_per_s();
    let is_before = |k: &usize| points.indentation_m[*k] > deep_m && speeds[*k] > -other;
    let last = (0..speeds.len()).rfind(is_before)?;
    let left_out = last + 1..retraction.back;
    (is_pulled && !left_out.is_empty()).then_some(left_out)
}

/// The points behind the largest pull, where the contact tears off, down to where the force has come back; `None` where it stays in contact.
pub(super) fn torn(points: &Points, touch: &Touch) -> Option<Range<usize>> {
    let before_n = mean(&points.force_n[..touch.before]).unwrap_or(0.0);
    let retraction = Retraction::of(points, touch.before)?;
    let least_n = points.force_n[retraction.pull];
    let is_torn = retraction.after_n - least_n > 0.5 * (before_n - least_n);
    let left_out = retraction.pull + 1..retraction.back;
    (least_n < before_n && is_torn && !left_out.is_empty()).then_some(left_out)
}

/// What the points of a retraction say, in their order: the deepest, that of the largest pull, the first of those whose force is as at the end.
struct Retraction {
    deepest: usize,
    pull: usize,
    back: usize,
    /// The force at the end.
    after_n: f64,
}

impl Retraction {
    fn of(points: &Points, before: usize) -> Option<Self> {
        let force_n = &points.force_n;
        let deepest = (0..force_n.len())
            .max_by(|a, b| points.indentation_m[*a].total_cmp(&points.indentation_m[*b]))?;
        let pull = (deepest..force_n.len()).min_by(|a, b| force_n[*a].total_cmp(&force_n[*b]))?;
        let count = force_n.len();
        let after_n = mean(&force_n[count - (count - deepest).min(FEWEST_BEFORE)..])?;
        // Out of contact the force is on a line, from which the points of the end go backwards.
        let line = |from: usize| Line::of(&points.time_s[from..], &force_n[from..]);
        let is_on = |k: &usize| {
            let sigma_n = points.noise_n / points.samples[*k].sqrt();
            (force_n[*k] - line(k + 1).at(points.time_s[*k])).abs() < ON_THE_LINE * sigma_n
        };
        let last = count.saturating_sub(FEWEST_BEFORE).max(pull);
        let back = (pull + 1..last)
            .rev()
            .take_while(is_on)
            .last()
            .unwrap_or(last);
        // A drift goes on as it was before contact.
        let drift = match before < FEWEST_BEFORE {
            true => 0.0,
            false => Line::of(&points.time_s[..before], &force_n[..before]).slope,
        };
        let rest_s = points.time_s[count - 1] - points.time_s[back];
        let changes_n = (line(back).slope - drift) * rest_s;
        let is_flat = changes_n.abs() < FLAT * (after_n - force_n[pull]);
        let back = if is_flat {
            (back + ABOUT).min(last)
        } else {
            count
        };
        Some(Self {
            deepest,
            pull,
            back,
            after_n,
        })
    }
}

/// The points about a jump of the approach into contact, by which the force falls from one point to the next and which a law may have a little
/// earlier or later; `None` where there is none.
pub(super) fn jump_in(points: &Points, touch: &Touch) -> Option<Range<usize>> {
    if touch.before < FEWEST_BEFORE {
        return None;
    }
    let end = end_of_approach(points);
    // In standard deviations; one point may be a mean over the jump.
    let fall = |k: usize, steps: usize| {
        let samples = points.samples[k].recip() + points.samples[k + steps].recip();
        (points.force_n[k] - points.force_n[k + steps]) / (points.noise_n * samples.sqrt())
    };
    let before = (0..end.saturating_sub(1)).max_by(|a, b| fall(*a, 2).total_cmp(&fall(*b, 2)))?;
    let is_falling = |k: &usize| fall(*k, 1) > FALLING;
    let first = (0..before).rev().take_while(is_falling).last();
    let last = (before + 2..end).take_while(is_falling).last();
    let from = first.unwrap_or(before).saturating_sub(ABOUT);
    let to = last.map_or(before + 2, |last| last + 1) + 1 + ABOUT;
    (fall(before, 2) > JUMP).then_some(from..to.min(points.force_n.len()))
}

/// What the instrument may add that the curve can tell.
pub(super) fn nuisances(points: &Points, touch: &Touch, has_drag: bool) -> Vec<Nuisance> {
    if touch.before < FEWEST_BEFORE {
        return Vec::new();
    }
    let mut all = vec![Nuisance::Offset, Nuisance::Drift];
    let speeds = &points.speed_m_per_s;
    let other = OTHER * points.fastest_m_per_s();
    let approach = mean(&speeds[..touch.before]).unwrap_or(0.0);
    // In contact the law takes what another speed changes.
    let outside = points.indentation_m.iter().zip(speeds);
    let outside = outside.filter(|(d, _)| **d < touch.contact_point_m);
    let others = outside.filter(|(_, v)| (**v - approach).abs() > other);
    if has_drag && others.count() >= FEWEST_BEFORE {
        all.push(Nuisance::Drag);
    }
    all
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
}

/// First and last time (s) at which points are deeper than the contact point.
pub(super) fn contact_times(points: &Points, contact_point_m: f64) -> (f64, f64) {
    let is_in = |d: &f64| *d > contact_point_m;
    let first = points.indentation_m.iter().position(is_in).unwrap_or(0);
    let last = points.indentation_m.iter().rposition(is_in).unwrap_or(0);
    (points.time_s[first], points.time_s[last])
}
