//! A measured force curve, and the fewer points that a fit takes of it.

use std::ops::Range;

use super::resolved::Probe;
use super::smooth::{Corner, Line, Smooth};
use crate::numerics::order::median;

/// Force over indentation over time, of one approach, hold and retraction or several.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ForceCurve {
    /// How messages and tables call it.
    pub name: String,
    pub time_s: Vec<f64>,
    pub force_n: Vec<f64>,
    /// From any zero: where the contact begins is sought.
    pub indentation_m: Vec<f64>,
    /// What moves the instrument, which a drag goes with, where that is not the indentation.
    pub travel_m: Option<Vec<f64>>,
    /// Standard deviation (N) of the forces, where it is known; otherwise neighbours tell it.
    pub force_error_n: Option<f64>,
    /// Where on the specimen it was taken, of a map.
    pub place_m: Option<(f64, f64)>,
}

/// About how many points are left of a curve.
const POINTS: usize = 240;

/// By how many standard deviations samples may scatter about a line (root mean square) to be one point.
const STRAIGHT: f64 = 2.0;

/// The least noise, as a part of the range of a signal: below it the model is not exact.
const LEAST_NOISE: f64 = 2e-5;

/// Longest point after a corner of the indentation, as a part of the time since then: on that scale a body relaxes.
const SINCE_CORNER: f64 = 0.15;

/// The same of the force, which laws and springs make to so many digits.
const LEAST_NOISE_OF_FORCE: f64 = 5e-4;

/// How far the indentation may be off a line within a point, as a part of its range.
const BENT: f64 = 1e-4;

/// Means over samples that lie on a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    pub time_s: Vec<f64>,
    pub force_n: Vec<f64>,
    /// Without its noise.
    pub indentation_m: Vec<f64>,
    /// How fast the instrument moves.
    pub speed_m_per_s: Vec<f64>,
    /// Of how many samples each is the mean.
    pub samples: Vec<f64>,
    /// Times and indentations on the way, with corners between the points; and where on it each point is.
    pub path_s: Vec<f64>,
    pub path_m: Vec<f64>,
    pub on_path: Vec<usize>,
    /// Points before which others are left out.
    pub gaps: Vec<usize>,
    /// Standard deviation of the force of a sample, as its neighbours tell it.
    pub noise_n: f64,
}

impl Points {
    /// Lays the path through the points and the corners between them.
    fn lead_through(&mut self, corners: &[Corner]) {
        let mut corners = corners.iter().peekable();
        for (t, depth_m) in self.time_s.iter().zip(&self.indentation_m) {
            while let Some(corner) = corners.next_if(|corner| corner.time_s <= *t) {
                if corner.time_s < *t {
                    self.path_s.push(corner.time_s);
                    self.path_m.push(corner.value);
                }
            }
            self.on_path.push(self.path_s.len());
            self.path_s.push(*t);
            self.path_m.push(*depth_m);
        }
    }

    /// The largest speed of the instrument, either way.
    pub(super) fn fastest_m_per_s(&self) -> f64 {
        let speeds = self.speed_m_per_s.iter();
        speeds.fold(0.0, |fastest, speed| fastest.max(speed.abs()))
    }

    /// Takes a drag (N s/m) off that has so large a part of it at each indentation (m).
    pub(super) fn less_drag(&mut self, drag_n_s_per_m: f64, part: impl Fn(f64) -> f64) {
        let moved = self.speed_m_per_s.iter().zip(&self.indentation_m);
        for (force_n, (speed, depth_m)) in self.force_n.iter_mut().zip(moved) {
            *force_n -= drag_n_s_per_m * part(*depth_m) * speed;
        }
    }

    /// Lets a drag that was taken off fall with the height above the contact point (m), and the speeds that one is proportional to.
    pub(super) fn drag_falls(&mut self, probe: &Probe, contact_point_m: f64) {
        let part = |depth_m: f64| probe.drag_at(contact_point_m - depth_m);
        let drag_n_s_per_m = probe.drag_n_s_per_m.unwrap_or(0.0);
        self.less_drag(-drag_n_s_per_m, |depth_m| 1.0 - part(depth_m));
        for (speed, depth_m) in self.speed_m_per_s.iter_mut().zip(&self.indentation_m) {
            *speed *= part(*depth_m);
        }
    }

    /// Leaves out these points; the path goes on through them, which tells where on it they were.
    pub(super) fn leave_out(&mut self, points: Range<usize>) -> Range<usize> {
        let on_path = self.on_path[points.start]..self.on_path[points.end - 1] + 1;
        for column in [
            &mut self.time_s,
            &mut self.force_n,
            &mut self.indentation_m,
            &mut self.speed_m_per_s,
            &mut self.samples,
        ] {
            column.drain(points.clone());
        }
        self.on_path.drain(points.clone());
        let behind = self.gaps.iter_mut().filter(|gap| **gap >= points.end);
        behind.for_each(|gap| *gap -= points.len());
        self.gaps.push(points.start);
        on_path
    }
}

impl ForceCurve {
    /// Takes back what the channel of its motion does beside that of the force: of the piezo, where there is one.
    pub fn take_response_back(&mut self, probe: &Probe) {
        let gives_m = probe.frame_compliance_m_per_n;
        let moved_m: Vec<f64> = match &self.travel_m {
            Some(travel_m) => travel_m.clone(),
            None => (self.indentation_m.iter().zip(&self.force_n))
                .map(|(depth_m, force_n)| depth_m + gives_m * force_n)
                .collect(),
        };
        let truly_m = probe.response().take_back(&self.time_s, &moved_m);
        for (depth_m, (truly, moved)) in
            (self.indentation_m.iter_mut()).zip(truly_m.iter().zip(&moved_m))
        {
            *depth_m += truly - moved;
        }
        if self.travel_m.is_some() {
            self.travel_m = Some(truly_m);
        }
    }

    /// The points of a fit.
    pub fn points(&self) -> Points {
        let count = self.time_s.len();
        let noise_n = self
            .force_error_n
            .unwrap_or_else(|| deviation(&self.force_n));
        let noise_n = noise_n.max(LEAST_NOISE_OF_FORCE * span(&self.force_n));
        let smooth = Smooth::new(&self.time_s, &self.indentation_m);
        let indentation_m = &smooth.at_samples;
        let travel = self.travel_m.as_ref();
        let travel = travel.map(|travel_m| Smooth::new(&self.time_s, travel_m));
        let travel_m = &travel.as_ref().unwrap_or(&smooth).at_samples;
        let bent_m = BENT * span(indentation_m);
        let mut points = Points {
            time_s: Vec::new(),
            force_n: Vec::new(),
            indentation_m: Vec::new(),
            speed_m_per_s: Vec::new(),
            samples: Vec::new(),
            path_s: Vec::new(),
            path_m: Vec::new(),
            on_path: Vec::new(),
            gaps: Vec::new(),
            noise_n,
        };
        let size = count.div_ceil(POINTS);
        let mut left: Vec<(usize, usize)> = Vec::new();
        let (mut from, mut corner) = (0, 0);
        let corners = smooth.corners(&self.time_s);
        let samples = corners.iter().map(|corner| corner.sample);
        let mut samples = samples.chain([count]).peekable();
        while from < count {
            while let Some(next) = samples.next_if(|next| *next <= from) {
                corner = next;
            }
            let most = SINCE_CORNER * (self.time_s[from] - self.time_s[corner]);
            let is_short =
                |to: &usize| corner == 0 || self.time_s[to - 1] - self.time_s[from] <= most;
            let end = (from + size).min(samples.peek().copied().unwrap_or(count));
            let to = (from + 1..=end).take_while(is_short).last();
            let to = to.unwrap_or(from + 1);
            left.push((from, to));
            from = to;
        }
        left.reverse();
        while let Some((from, to)) = left.pop() {
            let is_line = |signal: &[f64], allowed: f64| {
                Line::of(&self.time_s[from..to], &signal[from..to]).scatter <= allowed
            };
            let is_point =
                is_line(&self.force_n, STRAIGHT * noise_n) && is_line(indentation_m, bent_m);
            if to - from > 2 && !is_point {
                let middle = usize::midpoint(from, to);
                left.extend([(middle, to), (from, middle)]);
                continue;
            }
            let mean = |signal: &[f64]| signal[from..to].iter().sum::<f64>() / (to - from) as f64;
            points.time_s.push(mean(&self.time_s));
            points.force_n.push(mean(&self.force_n));
            points.indentation_m.push(mean(indentation_m));
            // One sample more on either side, but none beyond a corner, where the speed is another.
            let behind = corners.partition_point(|corner| corner.sample <= from);
            let begin = behind.checked_sub(1).map_or(0, |last| corners[last].sample);
            let end = corners.get(behind).map_or(count, |next| next.sample);
            let around = from.saturating_sub(1).max(begin)..(to + 1).min(end);
            let around = match around.len() {
                1 => from.saturating_sub(1)..(to + 1).min(count),
                _ => around,
            };
            let line = Line::of(&self.time_s[around.clone()], &travel_m[around]);
            points.speed_m_per_s.push(line.slope);
            points.samples.push((to - from) as f64);
        }
        points.lead_through(&corners);
        points
    }
}

pub(super) fn span(signal: &[f64]) -> f64 {
    let most = signal.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
    let least = signal.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    most - least
}

/// Standard deviation of white noise on a smooth signal: the median of its third differences, of which a corner of the signal makes few
/// large.
pub(super) fn deviation(signal: &[f64]) -> f64 {
    let third = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
    let differences: Vec<f64> = signal.windows(4).map(third).collect();
    // The median of a normal variable's size is 0.6745 of its deviation; the weights squared sum to 20.
    let found = median(&differences) / (0.674_490 * 20_f64.sqrt());
    found.max(LEAST_NOISE * span(signal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::random;

    #[test]
    fn a_ramp_and_its_corner_are_found_in_noise_and_the_points_have_all_samples() {
        let mut random = random::Noise(3);
        let count = 4000;
        let mut curve = ForceCurve::default();
        for k in 0..count {
            let t = k as f64 / count as f64;
            let ramp = 1.0 - (2.0 * t - 1.0).abs();
            curve.time_s.push(t);
            curve
                .force_n
                .push(1e-6 * (ramp.powf(1.5) + 0.01 * random.normal()));
            curve
                .indentation_m
                .push(1e-6 * (ramp + 0.02 * random.normal()));
        }
        let points = curve.points();
        assert!((points.noise_n / 1e-8 - 1.0).abs() < 0.06);
        assert!((POINTS..POINTS + 20).contains(&points.time_s.len()));
        assert_eq!(points.samples.iter().sum::<f64>(), count as f64);
        for (t, depth) in points.time_s.iter().zip(&points.indentation_m) {
            let ramp = 1.0 - (2.0 * t - 1.0).abs();
            assert!((depth / 1e-6 - ramp).abs() < 0.01, "{t}: {depth}");
        }
    }
}
