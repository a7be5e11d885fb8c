//! A history between its rows: values at any time, of rows that no joint of the drive parts.

use crate::drive::SegmentedDrive;
use crate::numerics::polynomial::lagrange;
use crate::simulation::HistoryRow;

/// Times closer than this part of what they lie in are the same.
pub(super) const SAME: f64 = 1e-9;

/// A value at each of these times (s), by cubics through the rows; at a jump of the drive the one after it. `None` where the value is
/// undefined, or the history has not come so far.
pub fn values_at(
    drive: &SegmentedDrive,
    rows: &[HistoryRow],
    times_s: &[f64],
    value: fn(&HistoryRow) -> Option<f64>,
) -> Vec<Option<f64>> {
    let joints: Vec<f64> = drive.joints().iter().map(|joint| joint.time_s).collect();
    let at = |time_s: f64| {
        let last = joints.len().checked_sub(2)?;
        let slack_s = SAME * drive.duration_s();
        let next = joints.partition_point(|joint| *joint <= time_s + slack_s);
        let stretch = next.saturating_sub(1).min(last);
        let (start_s, end_s) = (joints[stretch], joints[stretch + 1]);
        let rows = within(rows, start_s, end_s - start_s)?;
        let times: Vec<f64> = rows.iter().map(|row| row.time_s).collect();
        let values: Option<Vec<f64>> = rows.iter().map(value).collect();
        Some(cubic(&times, &values?, time_s.clamp(start_s, end_s)))
    };
    times_s.iter().map(|time_s| at(*time_s)).collect()
}

/// The rows from a time on for so long, both ends included: at a jump the row after it, and at its end the one before. `None` where
/// the history has not come so far.
pub(super) fn within(rows: &[HistoryRow], start_s: f64, duration_s: f64) -> Option<&[HistoryRow]> {
    let slack_s = SAME * duration_s;
    let first = rows.partition_point(|row| row.time_s <= start_s + slack_s);
    let last = rows.partition_point(|row| row.time_s < start_s + duration_s - slack_s);
    rows.get(first.checked_sub(1)?..=last)
}

/// The cubic through the four samples about a time: exact at the samples.
pub(super) fn cubic(times: &[f64], values: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|t| *t < time);
    let first = after.saturating_sub(2).min(times.len().saturating_sub(4));
    let near = first..(first + 4).min(times.len());
    lagrange(&times[near.clone()], &values[near], time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_found_between_samples_of_any_distances() {
        let times = [0.0, 0.1, 0.5, 0.6, 1.0, 1.7];
        let cubed = |t: f64| 2.0 - t + 0.5 * t * t + 3.0 * t * t * t;
        let values = times.map(cubed);
        for time in [0.0, 0.03, 0.5, 0.77, 1.3, 1.7] {
            assert!((cubic(&times, &values, time) - cubed(time)).abs() < 1e-13);
        }
    }

    #[test]
    fn a_cycle_between_two_jumps_has_the_rows_inside() {
        let row = |time_s, load_n| HistoryRow {
            time_s,
            load_n,
            approach_m: None,
            contact_radius_m: 0.0,
            peak_pressure_pa: None,
            work_j: None,
        };
        let rows = [
            row(0.0, 0.0),
            row(1.0, 0.0),
            row(1.0, 1.0),
            row(1.5, 2.0),
            row(2.0, 3.0),
            row(2.0, 9.0),
        ];
        let loads = |start_s, period_s| -> Option<Vec<f64>> {
            let rows = within(&rows, start_s, period_s)?;
            Some(rows.iter().map(|row| row.load_n).collect())
        };
        assert_eq!(loads(1.0, 1.0), Some(vec![1.0, 2.0, 3.0]));
        assert_eq!(loads(1.5, 1.0), None);
    }
}
