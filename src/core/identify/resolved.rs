//! The resolved identification: every default written out, as a file that gives the same plan again.

use crate::identify::{Driven, IdentifyPlan};
use crate::quantity::block::Block as _;
use crate::quantity::setting::{Table, Value, document};
use crate::simulation::scenario::history_table;
use crate::sweep::plan::resolved::{compressibility, drive_table, indenter_material_text};

/// The plan as the text of an identification file.
pub fn resolved_text(plan: &IdentifyPlan) -> String {
    let known = &plan.contact.material;
    let contact =
        (plan.contact).blocks(known.indenter_material.as_ref().map(indenter_material_text));
    let material = Table::new("material").and(compressibility(&known.compressibility));
    let drive = match &plan.drive {
        Driven::Cycles(drive) => drive_table(drive),
        Driven::History(drive) => history_table(drive),
    };
    let identify = Table::new("identify")
        .with("data", &*plan.data)
        .with("branches", plan.branches.map_or("auto".into(), Value::from))
        .with_some("approach_zero", plan.approach_zero.map(|zero| zero.name()));
    let solver = plan.solver.table_for(plan.contact.indenter.as_ref());
    let blocks = [
        material.toml(),
        contact.layer,
        contact.indenter,
        drive.toml(),
        contact.adhesion,
        identify.toml(),
        plan.cycle.table().toml(),
        solver.toml(),
    ];
    document(&plan.title, blocks)
}
