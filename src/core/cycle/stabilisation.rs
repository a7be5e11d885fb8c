//! By how much a loop fails to close: the area of the gap in it, which counts little in the memory of the body but much in a loss
//! that is itself a small part of the work done in a cycle.

/// What rounding leaves in the step between the two ends of a cycle, relative to its largest sample: that of a sum over some
/// hundreds of nodes, and half a unit in the last place for every step, by which the factor of the memory's decay is rounded alike
/// in all of them.
fn rounding(steps: usize) -> f64 {
    f64::EPSILON * (0.5 * steps as f64).max(64.0)
}

/// By which part of the loss a loop fails to close: half the range of the load times the step in the approach between the
/// two ends of the cycle, and the same with the two exchanged, over the area of the loop closed by a straight line.
///
/// A steady drift D of the approach over a cycle shifts its first harmonic by D/pi, and so the loss by W_A D at most: all of
/// it where the two ends lie at an extremum of the load, nothing where they lie at its mean. `None` for a loop without
/// samples or without area: there is no loss to be a part of.
pub fn closure_error(load_n: &[f64], approach_m: &[f64]) -> Option<f64> {
    let (load_step, load_range) = step_and_range(load_n)?;
    let (approach_step, approach_range) = step_and_range(approach_m)?;
    let gap_j = 0.5 * (load_range * approach_step + approach_range * load_step);
    // Rounding of an elastic loop, or of one far narrower than its load and approach are large: neither a gap nor an area.
    let largest = |samples: &[f64]| samples.iter().fold(0.0_f64, |l, v| l.max(v.abs()));
    let products = load_range * largest(approach_m) + approach_range * largest(load_n);
    let rounding_j = (rounding(load_n.len()) * products).max(1e-13 * load_range * approach_range);
    if gap_j <= rounding_j {
        return Some(0.0);
    }
    let area_j = super::analysis::polygon_area(load_n, approach_m).abs();
    (area_j > 0.0).then(|| gap_j / area_j)
}

/// |last - first|, and largest - smallest.
fn step_and_range(samples: &[f64]) -> Option<(f64, f64)> {
    let step = (samples.last()? - samples.first()?).abs();
    let largest = samples.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let smallest = samples.iter().copied().fold(f64::INFINITY, f64::min);
    Some((step, largest - smallest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drift_is_counted_by_what_it_does_to_the_loss() {
        let n = 200;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let load: Vec<f64> = (0..=n).map(|i| 10.0 + 5.0 * angle(i).cos()).collect();
        let approach = |drift: f64| -> Vec<f64> {
            (0..=n)
                .map(|i| 3.0 + (angle(i) - 0.01).cos() + drift * i as f64 / n as f64)
                .collect()
        };
        let loss = |approach: &[f64]| {
            crate::cycle::analyse(&load, approach)
                .unwrap()
                .energy_loss_j
        };
        let (closed, open) = (approach(0.0), approach(1e-4));
        assert!(closure_error(&load, &closed).unwrap() < 1e-10);
        let shift = (loss(&open) / loss(&closed) - 1.0).abs();
        let estimate = closure_error(&load, &open).unwrap();
        // The polygon's area is itself shifted by the drift, by a part in a hundred here.
        assert!((estimate / shift - 1.0).abs() < 0.03, "{estimate} {shift}");
        assert_eq!(closure_error(&[], &[]), None);
    }

    #[test]
    fn what_rounding_leaves_of_a_narrow_loop_is_no_gap() {
        // A loop of a body that has crept far: 1e-8 of load times approach, in 1600 steps, each of which rounds the memory alike.
        let n = 1600;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let load: Vec<f64> = (0..=n).map(|i| 1.0 + 0.016 * angle(i).sin()).collect();
        let closure = |drift: f64| {
            let approach: Vec<f64> = (0..=n)
                .map(|i| 1.0 + 1e-8 * (angle(i) - 0.5).sin() + drift * i as f64 / n as f64)
                .collect();
            closure_error(&load, &approach).unwrap()
        };
        assert_eq!(closure(f64::EPSILON * 0.4 * n as f64), 0.0);
        assert!(closure(f64::EPSILON * 40.0 * n as f64) > 1e-4);
    }
}
