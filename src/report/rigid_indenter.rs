//! What it costs to take an indenter as rigid: by how much one of steel would be more compliant, where that is more than the error bars.

use crate::material::library;
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::run::Outcome;

/// What is to be kept in mind, in one line; `None` where a rigid indenter costs less than the numerical error, or is none.
pub fn note(plan: &SweepPlan, outcome: &Outcome) -> Option<String> {
    let steel = library::find("steel")?.material().ok()?;
    let steel_per_pa = steel.contact_compliance().ok()?.instantaneous_compliance();
    // Records stand condition after condition.
    let mut rest = outcome.records.iter().peekable();
    let (mut count, mut largest) = (0, 0.0_f64);
    for condition in plan.conditions().iter() {
        while let Some(record) = rest.next_if(|record| record.is_of(condition)) {
            let bar = record.energy_loss_j().zip(record.energy_loss_error_j());
            let Some((loss_j, error_j)) =
                bar.filter(|_| condition.contact.material.indenter_material().is_none())
            else {
                continue;
            };
            let omega = record.angular_frequency_rad_per_s;
            let part = steel_per_pa
                * condition
                    .contact
                    .material
                    .contact_complex_modulus(omega)
                    .norm();
            if part > (error_j / loss_j).abs() {
                (count, largest) = (count + 1, largest.max(part));
            }
        }
    }
    let percent = 100.0 * largest;
    let decimals = (1.0 - percent.log10().floor()).clamp(0.0, 9.0) as usize;
    (count > 0).then(|| {
        format!(
            "the indenter is taken as rigid: a steel one would add up to {percent:.decimals$} % to the compliance, which is more than \
             the error bars of {count} of {} cases; to include it, give the indenter a material in [indenter.material]",
            outcome.records.len()
        )
    })
}
