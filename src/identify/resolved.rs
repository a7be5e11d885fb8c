//! The resolved identification: every default written out, as a file that gives the same plan again.

use crate::identify::IdentifyPlan;
use crate::sweep::plan::resolved::{
    cycle_text, drive_text, opening_text, solver_text, toml_string,
};

/// The plan as the text of an identification file.
pub fn resolved_text(plan: &IdentifyPlan) -> String {
    let material = format!("[material]\npoisson_ratio = {:?}\n", plan.poisson_ratio);
    let opening = opening_text(&plan.title, &material, plan.indenter.as_ref());
    let branches = match plan.branches {
        Some(number) => number.to_string(),
        None => "\"auto\"".to_owned(),
    };
    format!(
        "{opening}{}\n\n[identify]\ndata = {}\nbranches = {branches}\n\n{}\n{}",
        drive_text(&plan.drive),
        toml_string(&plan.data),
        cycle_text(&plan.cycle),
        solver_text(&plan.solver, plan.indenter.as_ref())
    )
}
