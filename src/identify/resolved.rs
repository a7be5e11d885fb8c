//! The resolved identification: every default written out, as a file that gives the same plan again.

use crate::identify::{Driven, IdentifyPlan};
use crate::sweep::plan::resolved::{
    compressibility_line, counterbody_text, cycle_text, drive_text, indenter_text, opening_text,
    solver_text, toml_string,
};
use crate::sweep::plan::scenario::history_text;

/// The plan as the text of an identification file.
pub fn resolved_text(plan: &IdentifyPlan) -> String {
    let layer = plan.layer.map_or(String::new(), |layer| layer.text());
    let known = compressibility_line(&plan.compressibility).unwrap_or_default();
    let material = format!("[material]\n{known}\n{layer}");
    let counterbody = plan.counterbody.as_ref().map(counterbody_text);
    let indenter = indenter_text(plan.indenter.as_ref(), counterbody);
    let opening = opening_text(&plan.title, &(material + &indenter));
    let branches = match plan.branches {
        Some(number) => number.to_string(),
        None => "\"auto\"".to_owned(),
    };
    let driven = match &plan.drive {
        Driven::Cycles(drive) => drive_text(drive),
        Driven::History(drive) => history_text(drive).trim_end().to_owned(),
    };
    format!(
        "{opening}{}\n{}\n[identify]\ndata = {}\nbranches = {branches}\n\n{}\n{}",
        driven,
        plan.adhesion
            .map_or(String::new(), |adhesion| adhesion.text()),
        toml_string(&plan.data),
        cycle_text(&plan.cycle),
        solver_text(&plan.solver, plan.indenter.as_ref())
    )
}
