//! What of a case lies outside the model, or was not estimated.

use crate::cycle::ContactDuty;
use crate::engine::{EngineKind, SolverPlan};
use crate::sweep::case::lift_off::FEWEST_STEPS;
use crate::sweep::plan::Condition;
use crate::sweep::record::CaseResult;
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::record::slope::{ROUNDING, slope_of_case, slope_warnings};
use crate::sweep::record::warning::{NoErrorBars, Warning};

/// What is to be said of a case at an angular frequency (rad/s) and in a number of steps, once it is solved.
pub(crate) fn warnings(
    solver: &SolverPlan,
    condition: &Condition,
    (omega, steps): (f64, usize),
    result: Option<&CaseResult>,
    error_bars_wanted: bool,
) -> Vec<Warning> {
    let window = condition.contact.material.origin.measured_window_s;
    let mut warnings: Vec<Warning> = frequency_warning(window, omega).into_iter().collect();
    warnings.extend(Warning::of_temperature(&condition.contact.material));
    let Some(result) = result else {
        return warnings;
    };
    let slope = slope_of_case(condition.contact.indenter.as_ref(), result);
    let modulus_pa = condition
        .contact
        .material
        .longitudinal_complex_modulus(omega)
        .norm();
    let radius_m = result.contact_radius_m.maximum;
    warnings.extend(slope_warnings(slope, radius_m, modulus_pa));
    let tabor = condition.contact.adhesion.zip(result.tabor_parameter());
    warnings.extend(
        tabor.and_then(|(plan, parameter)| Warning::of_tabor_parameter(plan.model, parameter)),
    );
    warnings.extend(Warning::of_depth(
        condition.contact.layer,
        result.approach_m.maximum,
    ));
    warnings.extend(Warning::of_cells(
        condition.contact.indenter.as_ref(),
        radius_m,
    ));
    warnings.extend(Warning::of_loss(result));
    let steps_in_contact = result.contact_duty.steps(steps);
    let lifts_off = result.contact_duty != ContactDuty::WHOLE;
    if lifts_off {
        warnings.extend(Warning::of_steps_in_contact(steps_in_contact));
    }
    let loss_j = result.analysis.energy_loss_j.abs();
    let error_j = result
        .errors
        .as_ref()
        .and_then(|errors| errors.of(Quantity::EnergyLoss));
    let bar = error_j.map(|error_j| error_j / loss_j);
    let imbalance = result.energy_imbalance();
    warnings.extend(imbalance.and_then(|part| Warning::of_energy_imbalance(part, bar)));
    if error_bars_wanted && result.errors.is_none() {
        let on_cells = solver.engine == EngineKind::HalfSpace;
        let because = match on_cells && condition.contact.indenter.own_cells().is_some() {
            true => NoErrorBars::OwnCells,
            false if lifts_off && steps_in_contact < FEWEST_STEPS => NoErrorBars::ShortContact,
            false => NoErrorBars::NoCoarserResult,
        };
        warnings.push(Warning::NoErrorBars { because });
    }
    warnings
}

/// A frequency against the times (s) in which the material was measured.
fn frequency_warning(window_s: Option<(f64, f64)>, omega: f64) -> Option<Warning> {
    let (first_measured_s, last_measured_s) = window_s?;
    if omega * last_measured_s < 1.0 - ROUNDING {
        return Some(Warning::BelowMeasured {
            angular_frequency_rad_per_s: omega,
            last_measured_s,
        });
    }
    (omega * first_measured_s > 1.0 + ROUNDING).then_some(Warning::AboveMeasured {
        angular_frequency_rad_per_s: omega,
        first_measured_s,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frequency_within_the_measured_times_is_not_warned_of() {
        let window = Some((0.1, 1000.0));
        // The ends themselves, with the rounding of one over them.
        for omega in [1e-3, 1.0, 10.0, 1.0 / 1000.0, 1.0 / 0.1] {
            assert_eq!(frequency_warning(window, omega), None);
        }
        let code = |omega| frequency_warning(window, omega).map(|warning| warning.code());
        assert_eq!(code(0.99e-3), Some("below-measured"));
        assert_eq!(code(10.1), Some("above-measured"));
        // A table that begins at 0 s tells of every high frequency.
        assert_eq!(frequency_warning(Some((0.0, 1000.0)), 1e12), None);
        assert_eq!(frequency_warning(None, 1e12), None);
    }
}
