//! What of a history lies outside the model.

use crate::drive::{Segment, SegmentedDrive};
use crate::engine::domain;
use crate::material::ModulusKind;
use crate::material::tabulated::TableWarning;
use crate::simulation::body_material::BodyMaterial;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::{HistoryRow, SimulationOutcome};
use crate::sweep::record::slope::{Patch, ROUNDING, slope_of_body, slope_warnings};
use crate::sweep::record::warning::Warning;

/// What is to be said of a history, as far as it came.
pub fn warnings(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> Vec<Warning> {
    let window = plan.contact.material.measured_window_s();
    let mut warnings = time_warnings(window, &plan.drive);
    let series = plan.contact.material.series();
    warnings.extend(series.and_then(Warning::of_temperature));
    let widest =
        (outcome.rows.iter()).reduce(|a, b| match b.contact_radius_m > a.contact_radius_m {
            true => b,
            false => a,
        });
    let approach_m = outcome.rows.iter().filter_map(|row| row.approach_m);
    let approach_m = approach_m.fold(0.0, f64::max);
    if let Some(widest) = widest
        && let Some(modulus_pa) = creep_modulus_pa(&plan.contact.material, widest.time_s)
    {
        let slope = slope_of_history(plan, outcome, (widest, approach_m));
        warnings.extend(slope_warnings(slope, widest.contact_radius_m, modulus_pa));
    }
    let radius_m = widest.map_or(0.0, |row| row.contact_radius_m);
    let indenter = plan.contact.indenter.as_ref();
    warnings.extend(Warning::of_cells(indenter, radius_m));
    warnings.extend(Warning::of_depth(plan.contact.layer, approach_m));
    warnings.extend(tabor_parameter(plan));
    warnings.extend(material_error(plan).filter(|_| plan.output.error_bars));
    warnings
}

/// That the materials of a history are known to within an error only, which its bars leave out.
fn material_error(plan: &ScenarioPlan) -> Option<Warning> {
    let material = &plan.contact.material;
    let is_noisy = match material {
        BodyMaterial::Series(_) => false,
        BodyMaterial::Samples(sampled) => {
            let mut findings = sampled.table().warnings().iter();
            findings.any(|finding| matches!(finding, TableWarning::Noise { .. }))
        }
    };
    let bodies = material
        .series()
        .into_iter()
        .chain(material.indenter_material());
    let others = bodies.map(|body| body.origin.alternatives.len() + body.origin.replicas.len());
    let others = others.sum();
    (is_noisy || others > 0).then_some(Warning::NoMaterialError { others })
}

/// Tabor's parameter of an indenter that is attracted, of the body as soft as it becomes.
fn tabor_parameter(plan: &ScenarioPlan) -> Option<Warning> {
    let compliance = plan.contact.material.compliance().ok()?;
    let softest_pa = compliance.largest_per_pa(plan.drive.duration_s()).recip();
    let adhesion = plan.contact.adhesion?;
    let parameter = adhesion.tabor_parameter(plan.contact.indenter.as_ref(), softest_pa)?;
    Warning::of_tabor_parameter(adhesion.model, parameter)
}

/// The times of a drive against those in which the material was measured.
fn time_warnings(window_s: Option<(f64, f64)>, drive: &SegmentedDrive) -> Vec<Warning> {
    let Some((first_measured_s, last_measured_s)) = window_s else {
        return Vec::new();
    };
    let (shortest_s, time_s) = (shortest_s(drive), drive.duration_s());
    let shorter = (shortest_s < first_measured_s * (1.0 - ROUNDING)).then_some(
        Warning::ShorterThanMeasured {
            time_s: shortest_s,
            first_measured_s,
        },
    );
    let longer =
        (time_s > last_measured_s * (1.0 + ROUNDING)).then_some(Warning::LongerThanMeasured {
            time_s,
            last_measured_s,
        });
    shorter.into_iter().chain(longer).collect()
}

/// The shortest time (s) within which a drive changes: 0 where it jumps.
fn shortest_s(drive: &SegmentedDrive) -> f64 {
    let jumps = (drive.joints().iter()).any(|joint| {
        joint
            .after
            .is_some_and(|after| after != joint.before.unwrap_or(0.0))
    });
    if jumps {
        return 0.0;
    }
    let times_s = drive.segments().iter().map(Segment::changes_within_s);
    times_s.fold(f64::INFINITY, f64::min)
}

/// One over the longitudinal creep compliance (Pa) after this time.
fn creep_modulus_pa(material: &BodyMaterial, time_s: f64) -> Option<f64> {
    match material.poisson_ratio() {
        Some(nu) => {
            let contact_per_pa = material.compliance().ok()?.largest_per_pa(time_s);
            Some((1.0 - nu * nu) / contact_per_pa)
        }
        None => {
            let longitudinal = material.series()?.creep_as(ModulusKind::Longitudinal);
            Some(longitudinal.ok()?.compliance(time_s).recip())
        }
    }
}

/// Slope within the widest contact of a history. Of a shape that is no body of revolution the contact is taken as that lowest part
/// of it which has the area of the contact.
fn slope_of_history(
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
    (widest, approach_m): (&HistoryRow, f64),
) -> Option<f64> {
    /// Cells along the longer side of the domain, where the shape has none of its own.
    const CELLS: usize = 128;
    let indenter = plan.contact.indenter.as_ref();
    if let Some(body) = indenter.axisymmetric() {
        return slope_of_body(body, widest.contact_radius_m, approach_m);
    }
    let load_n = outcome.rows.iter().fold(0.0, |a, row| row.load_n.max(a));
    let compliance = plan.contact.material.compliance().ok()?;
    let compliance_per_pa = compliance.largest_per_pa(plan.drive.duration_s());
    let grid = domain::grid(&indenter.domain(load_n, compliance_per_pa), CELLS, 0).ok()?;
    Patch::lowest(indenter, &grid, widest.contact_area_m2()).steepest()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::Control;

    #[test]
    fn a_drive_that_is_faster_or_longer_than_the_measurement_is_warned_of() {
        let ramp = |to, duration_s| Segment::Ramp { to, duration_s };
        let step = |to, duration_s| Segment::Step { to, duration_s };
        let codes = |segments: Vec<Segment>| -> Vec<&str> {
            let drive = SegmentedDrive::new(Control::Load, segments).unwrap();
            let warnings = time_warnings(Some((1.0, 100.0)), &drive);
            warnings.iter().map(Warning::code).collect()
        };
        assert!(codes(vec![ramp(1.0, 1.0), ramp(0.5, 99.0)]).is_empty());
        assert_eq!(codes(vec![step(1.0, 10.0)]), ["shorter-than-measured"]);
        // A step to the value that is held already is no jump.
        assert!(codes(vec![ramp(1.0, 2.0), step(1.0, 5.0)]).is_empty());
        assert_eq!(
            codes(vec![ramp(1.0, 0.5), ramp(0.5, 100.0)]),
            ["shorter-than-measured", "longer-than-measured"]
        );
        let sine = |angular_frequency_rad_per_s| Segment::Sine {
            mean: 1.0,
            amplitude: 0.5,
            angular_frequency_rad_per_s,
            phase_rad: 0.0,
            cycles: 2.0,
        };
        assert!(codes(vec![ramp(1.0, 2.0), sine(0.9)]).is_empty());
        assert_eq!(
            codes(vec![ramp(1.0, 2.0), sine(1.1)]),
            ["shorter-than-measured"]
        );
    }
}
