//! Where a peak lies with each replica of the material: the errors of its frequency and loss that come from the noise of the data.
//!
//! The curves of the replicas are known at the frequencies of the sweep. Their maxima, and that of the sweep's own curve, are read off
//! between them in the same way, so that what the interpolation misses is nearly the same for all; the peak located moves by the ratios.

use crate::sweep::record::{CaseRecord, material_error};
use crate::sweep::search::peak::{Peak, Point, vertex};

/// Points through which a maximum is read off.
const STENCIL: usize = 5;

/// Adds its errors to a peak of a curve, whose records are in ascending frequency; nothing where there are no replicas.
pub(super) fn add_errors(found: &mut Peak, records: &[CaseRecord]) {
    let results = records.iter();
    let results: Vec<_> = results
        .filter_map(|record| Some((record.angular_frequency_rad_per_s, record.result.as_ref()?)))
        .collect();
    let replicas = results
        .iter()
        .map(|(_, result)| result.replica_losses_j.len());
    let replicas = replicas.max().unwrap_or(0);
    let (near, loss_j) = (found.angular_frequency_rad_per_s.ln(), found.energy_loss_j);
    let own = results.iter();
    let own: Vec<Point> = own
        .map(|(omega, result)| (omega.ln(), result.analysis.energy_loss_j))
        .collect();
    let Some((own_at, own_j)) = maximum(&own, near) else {
        return;
    };
    let of_replica = |k: usize| {
        let points = results.iter().filter_map(|(omega, result)| {
            Some((omega.ln(), result.replica_losses_j.get(k).copied()??))
        });
        let (at, other_j) = maximum(&points.collect::<Vec<Point>>(), near)?;
        Some(((near + at - own_at).exp(), loss_j * other_j / own_j))
    };
    let peaks: Vec<Option<Point>> = (0..replicas).map(of_replica).collect();
    let part = |part: fn(&Point) -> f64| -> Vec<Option<f64>> {
        peaks.iter().map(|peak| peak.as_ref().map(part)).collect()
    };
    let omega = found.angular_frequency_rad_per_s;
    found.angular_frequency_material_error_rad_per_s =
        material_error::from_replicas(omega, &part(|p| p.0));
    found.energy_loss_material_error_j = material_error::from_replicas(loss_j, &part(|p| p.1));
}

/// The maximum (place and value) of a curve that is reached uphill from its point nearest to `near`; `None` where that leads to an end.
fn maximum(curve: &[Point], near: f64) -> Option<Point> {
    let value = |k: usize| curve.get(k).map(|point| point.1);
    let away = |k: &usize| (curve[*k].0 - near).abs();
    let mut top = (0..curve.len()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    loop {
        let (below, above) = (value(top.checked_sub(1)?)?, value(top + 1)?);
        let here = value(top)?;
        top = match (below > here, above > here) {
            (false, false) => break,
            (true, _) if below >= above => top - 1,
            _ => top + 1,
        };
    }
    let first = top.saturating_sub(STENCIL / 2);
    let first = first.min(curve.len().saturating_sub(STENCIL));
    let around = curve.iter().skip(first).take(STENCIL);
    let (places, values): (Vec<f64>, Vec<f64>) = around.copied().unzip();
    vertex(&places, &values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shifted_curve_has_a_shifted_maximum_and_a_rising_one_has_none() {
        let debye = |x: f64| 1.0 / (x.exp() + (-x).exp());
        let curve = |shift: f64| -> Vec<Point> {
            let x = (-20..=20).map(|k| 0.23 * f64::from(k));
            x.map(|x| (x, debye(x - shift))).collect()
        };
        let (own, own_value) = maximum(&curve(0.0), 0.0).unwrap();
        for shift in [-0.9, -0.31, -0.1, 0.07, 0.2, 1.4] {
            let (at, value) = maximum(&curve(shift), 0.0).unwrap();
            // A quartic over five points 0.23 apart follows a relaxation to 1e-4 of its height.
            assert!((at - own - shift).abs() < 2e-3, "{shift}: {at}");
            assert!((value / own_value - 1.0).abs() < 1e-4);
        }
        assert_eq!(maximum(&curve(9.0), 0.0), None);
        assert_eq!(maximum(&[], 0.0), None);
    }
}
