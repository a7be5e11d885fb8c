//! The resolved identification: every default written out, as a file that gives the same plan again.

use crate::identify::{Driven, IdentifyPlan};
use crate::simulation::scenario::history_text;
use crate::sweep::plan::resolved::{
    compressibility_line, cycle_text, drive_text, indenter_material_text, opening_text,
    solver_text, toml_string,
};

/// The plan as the text of an identification file.
pub fn resolved_text(plan: &IdentifyPlan) -> String {
    let known = &plan.contact.material;
    let contact =
        (plan.contact).blocks(known.indenter_material.as_ref().map(indenter_material_text));
    let known = compressibility_line(&known.compressibility).unwrap_or_default();
    let bodies = format!("[material]\n{known}\n{}{}", contact.layer, contact.indenter);
    let opening = opening_text(&plan.title, &bodies);
    let branches = match plan.branches {
        Some(number) => number.to_string(),
        None => "\"auto\"".to_owned(),
    };
    let zero = plan.approach_zero.map_or(String::new(), |zero| {
        format!("approach_zero = {}\n", toml_string(zero.name()))
    });
    let driven = match &plan.drive {
        Driven::Cycles(drive) => drive_text(drive),
        Driven::History(drive) => history_text(drive).trim_end().to_owned(),
    };
    format!(
        "{opening}{}\n{}\n[identify]\ndata = {}\nbranches = {branches}\n{zero}\n{}\n{}",
        driven,
        contact.adhesion,
        toml_string(&plan.data),
        cycle_text(&plan.cycle),
        solver_text(&plan.solver, plan.contact.indenter.as_ref())
    )
}
