//! The resolved sweep: every default written out, with units, as a sweep file that gives the same plan again; and its hash,
//! which neither the `[figures]` table at its end enters nor the place where a data file lies.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use crate::drive::{Control, HarmonicDrive};
use crate::indenter::{Indenter, Parameter, Value};
use crate::material::{Compressibility, Material, MaterialFunction, Relaxation, RelaxationBranch};
use crate::quantity::{Dimension, format_si};
use crate::sweep::figures::figure_plan::without_figures;
use crate::sweep::plan::{Axes, Block, Condition, CyclePlan, SolverPlan, SweepPlan, Varied};

/// The plan as the text of a sweep file.
pub fn resolved_text(plan: &SweepPlan) -> String {
    // By name, so that what is added to a plan and not written here, and so not hashed, does not compile.
    let SweepPlan {
        title,
        contact,
        drive,
        axes,
        angular_frequencies_rad_per_s,
        refine,
        cycle,
        figures,
    } = plan;
    let given = axes.as_ref().map(|axes| &axes.given_blocks);
    let is_listed = |block| {
        axes.as_ref()
            .is_some_and(|axes| axes.whole(block).is_some())
    };
    let given_material = given.and_then(|given| given.material.as_deref());
    let mut blocks = match given_material {
        _ if is_listed(Block::Material) => String::new(),
        Some(block) => block.to_owned(),
        None => material_of(
            &contact.material,
            axes.iter().flat_map(|axes| &axes.conditions),
            axes,
        ),
    };
    let counterbody = match given.and_then(|given| given.counterbody.as_deref()) {
        Some(block) => Some(block.to_owned()),
        None => contact.material.counterbody().map(counterbody_text),
    };
    let contact = contact.blocks(counterbody);
    blocks.push_str(&contact.layer);
    if !is_listed(Block::Indenter) {
        blocks.push_str(&contact.indenter);
    }
    let mut text = opening_text(title, &blocks);
    let quantity = |value: f64, dimension| format!("\"{}\"", format_si(value, dimension));
    let mut line = |content: &str| {
        text.push_str(content);
        text.push('\n');
    };
    line(&drive_text(drive));
    if !contact.adhesion.is_empty() {
        line(contact.adhesion.trim_end());
    }
    line("\n[sweep]");
    let over = || axes.iter().flat_map(|axes| axes.over.iter().enumerate());
    for (k, varied) in over().filter(|(_, varied)| !varied.is_whole()) {
        let number = |value: f64| match varied.dimension {
            Some(dimension) => quantity(value, dimension),
            None => format!("{value:?}"),
        };
        let values = axes.as_ref().map_or(Vec::new(), |axes| axes.values_of(k));
        let values: Vec<String> = values.into_iter().map(number).collect();
        // Beside a list of blocks the key would be one of a table in its place.
        let path = match varied.is_nested() || is_listed(varied.block) {
            true => format!("\"{}\"", varied.path()),
            false => varied.path(),
        };
        line(&format!("{path} = [{}]", values.join(", ")));
    }
    if axes.as_ref().is_some_and(|axes| axes.pairs) {
        line("pairs = true");
    }
    if *refine {
        line("refine = true");
    }
    line("angular_frequency = [");
    for &omega in angular_frequencies_rad_per_s {
        line(&format!(
            "    {},",
            quantity(omega, Dimension::AngularFrequency)
        ));
    }
    line("]\n");
    for (k, varied) in over() {
        text.push_str(&listed_text(plan, k, varied));
    }
    text.push_str(&cycle_text(cycle));
    text.push('\n');
    text.push_str(&contact.solver);
    text.push_str(&figures.text());
    text
}

/// The `[drive]` block of an oscillation, with an empty line before it and no line end behind it.
pub(crate) fn drive_text(drive: &HarmonicDrive) -> String {
    let quantity = |value: f64, dimension| format!("\"{}\"", format_si(value, dimension));
    let dimension = drive_dimension(drive.control());
    format!(
        "\n[drive]\ncontrol = \"{}\"\nmean = {}\namplitude = {}\nphase = {}\nhold = {}",
        drive.control().name(),
        quantity(drive.mean(), dimension),
        quantity(drive.amplitude(), dimension),
        quantity(drive.phase_rad(), Dimension::Angle),
        quantity(drive.hold_s(), Dimension::Time)
    )
}

/// The `[cycle]` block.
pub(crate) fn cycle_text(cycle: &CyclePlan) -> String {
    let CyclePlan {
        steps,
        method,
        tolerance,
        max_cycles,
        at_cycle,
        error_bars,
        accuracy,
    } = cycle;
    let at_cycle = at_cycle.map(|cycle| format!("at_cycle = {cycle}\n"));
    let accuracy = accuracy.map(|accuracy| format!("accuracy = {accuracy:e}\n"));
    format!(
        "[cycle]\nsteps = {steps}\nmethod = \"{}\"\ntolerance = {tolerance:e}\nmax_cycles = {max_cycles}\n{}error_bars = \
         {error_bars}\n{}",
        method.name(),
        at_cycle.unwrap_or_default(),
        accuracy.unwrap_or_default()
    )
}

/// The `[indenter.material]` block.
pub(crate) fn counterbody_text(material: &Material) -> String {
    material_text(material).replace("[material", "[indenter.material")
}

/// The material of a block under these conditions: at each temperature, where that varies.
fn material_of<'a>(
    own: &Material,
    conditions: impl Iterator<Item = &'a Condition>,
    axes: &Option<Axes>,
) -> String {
    let mut over = axes.iter().flat_map(|axes| &axes.over);
    match over.any(Varied::is_temperature) {
        true => material_text_over(conditions),
        false => material_text(own),
    }
}

/// The blocks of a list, each under its name; nothing of an axis over a number.
fn listed_text(plan: &SweepPlan, axis: usize, varied: &Varied) -> String {
    let conditions = plan.conditions();
    let mut text = String::new();
    for (place, name) in varied.names.iter().enumerate() {
        let is_meant = |c: &&Condition| c.values.get(axis) == Some(place as f64);
        let under = || conditions.iter().filter(is_meant);
        // Pairs and combinations have every block.
        let Some(first) = under().next() else {
            continue;
        };
        let (block, name_line) = match varied.block {
            Block::Indenter => {
                let counterbody = first.material.counterbody().map(counterbody_text);
                let block = indenter_text(first.indenter.as_ref(), counterbody);
                (block, format!("name = {}\n", toml_string(name)))
            }
            _ => (
                material_of(&first.material, under(), &plan.axes),
                String::new(),
            ),
        };
        let own = varied.block.name();
        for (k, line) in block.trim_start().lines().enumerate() {
            let line = match k {
                0 => format!("[[sweep.{own}]]\n{name_line}"),
                _ if line.starts_with('[') => line.replacen(own, &format!("sweep.{own}"), 1) + "\n",
                _ => format!("{line}\n"),
            };
            text.push_str(&line);
        }
        text.push('\n');
    }
    text
}

/// What sweeps and scenarios have in common at their beginning: title, and the blocks of material and indenter.
pub(crate) fn opening_text(title: &str, blocks: &str) -> String {
    let title = toml_string(title);
    match blocks.trim_start() {
        "" => format!("title = {title}\n"),
        blocks => format!("title = {title}\n\n{blocks}"),
    }
}

/// The `[indenter]` block and that of what it is made of, with an empty line before each.
pub(crate) fn indenter_text(indenter: &dyn Indenter, counterbody: Option<String>) -> String {
    let mut text = String::new();
    let mut line = |content: &str| {
        text.push_str(content);
        text.push('\n');
    };
    line("\n[indenter]");
    line(&format!("shape = \"{}\"", indenter.shape()));
    for parameter in indenter.parameters() {
        line(&format!("{} = {}", parameter.key, value(&parameter.value)));
    }
    let of_indenter = counterbody.map(|block| format!("\n{block}"));
    text + &of_indenter.unwrap_or_default()
}

/// The `[solver]` block, at the end of both.
pub(crate) fn solver_text(solver: &SolverPlan, indenter: &dyn Indenter) -> String {
    let SolverPlan {
        engine,
        cells,
        springs,
        time_rule,
        tolerance,
    } = solver;
    let cells = match indenter.own_cells() {
        Some(_) => String::new(),
        None => format!("cells = {cells}\n"),
    };
    let (engine, rule) = (engine.name(), time_rule.name());
    let tolerance = tolerance.map(|t| format!("tolerance = {t:e}\n"));
    format!(
        "[solver]\nengine = \"{engine}\"\n{cells}springs = {springs}\n{}time_rule = \"{rule}\"\n",
        tolerance.unwrap_or_default(),
    )
}

/// What kind of quantity a drive's values are.
pub fn drive_dimension(control: Control) -> Dimension {
    match control {
        Control::Load => Dimension::Force,
        Control::Approach => Dimension::Length,
    }
}

/// A setting of the indenter as TOML.
fn value(value: &Value) -> String {
    let list = |items: Vec<String>| format!("[{}]", items.join(", "));
    let quoted = |value: f64, dimension| format!("\"{}\"", format_si(value, dimension));
    match value {
        Value::Quantity(value, dimension) => quoted(*value, *dimension),
        Value::Quantities(values, dimension) => {
            list(values.iter().map(|&v| quoted(v, *dimension)).collect())
        }
        // Debug keeps the decimal point that TOML asks of a float.
        Value::Number(number) => format!("{number:?}"),
        Value::Integer(integer) => integer.to_string(),
        Value::Text(text) => toml_string(text),
        Value::Tables(tables) => {
            let rows: Vec<String> = tables.iter().map(|t| inline_table(t)).collect();
            format!("[\n{}]", rows.concat())
        }
    }
}

/// One line of an array of tables.
fn inline_table(table: &[Parameter]) -> String {
    let entries: Vec<String> = table
        .iter()
        .map(|parameter| format!("{} = {}", parameter.key, value(&parameter.value)))
        .collect();
    format!("    {{ {} }},\n", entries.join(", "))
}

/// SHA-256 of the [`identity`], in hexadecimal.
pub fn hash(resolved: &str) -> String {
    hash_of_bytes(identity(resolved).as_bytes())
}

/// What makes a resolved sweep or scenario the one that it is: its text without how its figures look, and without the path of a
/// data file, whose content stands in the line below.
pub fn identity(resolved: &str) -> String {
    let lines: Vec<&str> = without_figures(resolved).split_inclusive('\n').collect();
    let is_place = |k: usize| {
        let next = lines.get(k + 1).copied().unwrap_or_default();
        lines[k].starts_with("file = ") && next.starts_with("sha256 = ")
    };
    let kept = (0..lines.len()).filter(|&k| !is_place(k));
    kept.map(|k| lines[k]).collect()
}

/// SHA-256 of any bytes, in hexadecimal.
pub fn hash_of_bytes(bytes: &[u8]) -> String {
    let mut hash = String::with_capacity(64);
    for byte in Sha256::digest(bytes) {
        // Writing to a String cannot fail.
        let _ = write!(hash, "{byte:02x}");
    }
    hash
}

/// The material as the block of a sweep file that gives the same material again.
pub fn material_text(material: &Material) -> String {
    text_of(|line| material_lines(material, line))
}

/// The same of a material at every temperature of these conditions, the first of which counts where none is asked for.
fn material_text_over<'a>(conditions: impl Iterator<Item = &'a Condition>) -> String {
    let mut materials: Vec<&Material> = Vec::new();
    for condition in conditions {
        let known = |other: &&Material| other.temperature_k() == condition.material.temperature_k();
        if !materials.iter().any(known) {
            materials.push(&condition.material);
        }
    }
    let materials = || materials.iter().copied();
    text_of(|line| {
        if let Some(first) = materials().next() {
            head_lines(first, line);
        }
        for material in materials() {
            isotherm_lines(material, line);
        }
    })
}

fn text_of(write: impl FnOnce(&mut dyn FnMut(&str))) -> String {
    let mut text = String::new();
    write(&mut |line| {
        text.push_str(line);
        text.push('\n');
    });
    text
}

/// The same of a material whose Poisson ratio is not known: a comment in its place says what to write.
pub fn material_text_without_poisson_ratio(material: &Material) -> String {
    let lines = material_text(material);
    let lines = lines.lines().map(|line| match line.starts_with("poisson_ratio = ") {
        true => "# poisson_ratio = 0.4   # not known: write that of the material before the block goes into a sweep\n".to_owned(),
        false => format!("{line}\n"),
    });
    lines.collect()
}

/// What stands above the numbers: name, Poisson ratio and temperature.
fn head_lines(material: &Material, line: &mut dyn FnMut(&str)) {
    line("[material]");
    if let Some(name) = material.name() {
        line(&format!("name = {}", toml_string(name)));
    }
    if let Some(known) = compressibility_line(material.compressibility()) {
        line(&known);
    }
    temperature_line(material, line);
}

/// The key of a Poisson ratio, or of a bulk modulus that is constant in time.
pub(crate) fn compressibility_line(compressibility: &Compressibility) -> Option<String> {
    if let Some(nu) = compressibility.poisson_ratio() {
        return Some(format!("poisson_ratio = {nu:?}"));
    }
    let bulk_pa = compressibility.constant_bulk_modulus_pa()?;
    let bulk = format_si(bulk_pa, Dimension::Stress);
    Some(format!("bulk_modulus = \"{bulk}\""))
}

/// The bulk modulus, where it relaxes.
fn bulk_lines(material: &Material, line: &mut dyn FnMut(&str)) {
    let bulk = material.compressibility().bulk_modulus();
    if let Some(bulk) = bulk.filter(|bulk| !bulk.branches().is_empty()) {
        line("\n[material.bulk_modulus]");
        relaxation_lines(bulk, line);
    }
}

fn temperature_line(material: &Material, line: &mut dyn FnMut(&str)) {
    if let Some(temperature_k) = material.temperature_k() {
        let temperature = format_si(temperature_k, Dimension::Temperature);
        line(&format!("temperature = \"{temperature}\""));
    }
}

fn isotherm_lines(material: &Material, line: &mut dyn FnMut(&str)) {
    line("\n[[material.isotherm]]");
    temperature_line(material, line);
    if let Some(law) = material.shift() {
        line(&format!("wlf = [{:?}, {:?}]", law.c1, law.c2_k));
    }
    measured_line(material, line);
    line(&format!("modulus = \"{}\"", material.kind().name()));
    series_lines(material, line);
    replica_lines(material, line);
}

fn material_lines(material: &Material, line: &mut dyn FnMut(&str)) {
    let kind = material.kind().name();
    head_lines(material, line);
    if material.temperature_k().is_some() {
        isotherm_lines(material, line);
        return;
    }
    measured_line(material, line);
    match given_relaxation(material) {
        Some(_) => line(&format!("\n[material.relaxation]\nmodulus = \"{kind}\"")),
        None => line(&format!("\n[material.creep]\ncompliance = \"{kind}\"")),
    }
    series_lines(material, line);
    replica_lines(material, line);
    bulk_lines(material, line);
    for alternative in material.alternatives() {
        line("\n[[material.alternative]]");
        series_lines(alternative, line);
    }
}

fn measured_line(material: &Material, line: &mut dyn FnMut(&str)) {
    if let Some((first_s, last_s)) = material.measured_window_s() {
        let [first, last] = [first_s, last_s].map(|time_s| format_si(time_s, Dimension::Time));
        line(&format!("measured = [\"{first}\", \"{last}\"]"));
    }
}

/// The replicas, as bare numbers: there may be hundreds.
fn replica_lines(material: &Material, line: &mut dyn FnMut(&str)) {
    let replicas = material.replicas().iter().filter_map(Material::relaxation);
    let rows: Vec<String> = replicas.map(replica_row).collect();
    if !rows.is_empty() {
        line(&format!("replicas = [\n{}]", rows.concat()));
    }
}

fn replica_row(replica: &Relaxation) -> String {
    // Debug keeps the decimal point that TOML asks of a float, and loses no bit.
    let list = |value: fn(&RelaxationBranch) -> f64| {
        let values = replica.branches().iter().map(value);
        let values: Vec<String> = values.map(|value| format!("{value:?}")).collect();
        values.join(", ")
    };
    format!(
        "    {{ equilibrium = {:?}, moduli = [{}], times = [{}] }},\n",
        replica.equilibrium_modulus(),
        list(|branch| branch.modulus_pa),
        list(|branch| branch.time_s)
    )
}

/// The relaxation modulus of a material that was given by it.
fn given_relaxation(material: &Material) -> Option<&Relaxation> {
    let given = material.given() == MaterialFunction::Relaxation;
    material.relaxation().filter(|_| given)
}

/// The numbers of the function that was given.
fn series_lines(material: &Material, line: &mut dyn FnMut(&str)) {
    if let Some(relaxation) = given_relaxation(material) {
        return relaxation_lines(relaxation, line);
    }
    let creep = material.creep();
    let instantaneous_per_pa = creep.instantaneous_compliance();
    quantity_line(
        "instantaneous",
        (instantaneous_per_pa, Dimension::Compliance),
        line,
    );
    if let Some(viscosity) = creep.viscosity_pa_s() {
        quantity_line("viscosity", (viscosity, Dimension::Viscosity), line);
    }
    let branches = creep.branches().iter();
    let branches = branches.map(|b| (b.compliance_per_pa, b.time_s));
    branch_lines(("compliance", Dimension::Compliance), branches, line);
}

fn relaxation_lines(relaxation: &Relaxation, line: &mut dyn FnMut(&str)) {
    let equilibrium_pa = relaxation.equilibrium_modulus();
    quantity_line("equilibrium", (equilibrium_pa, Dimension::Stress), line);
    let branches = relaxation.branches().iter();
    let branches = branches.map(|b| (b.modulus_pa, b.time_s));
    branch_lines(("modulus", Dimension::Stress), branches, line);
}

fn quantity_line(key: &str, (value, dimension): (f64, Dimension), line: &mut dyn FnMut(&str)) {
    line(&format!("{key} = \"{}\"", format_si(value, dimension)));
}

fn branch_lines(
    (key, dimension): (&str, Dimension),
    branches: impl Iterator<Item = (f64, f64)>,
    line: &mut dyn FnMut(&str),
) {
    line("branches = [");
    for (strength, time_s) in branches {
        let strength = format_si(strength, dimension);
        let time = format_si(time_s, Dimension::Time);
        line(&format!(
            "    {{ {key} = \"{strength}\", time = \"{time}\" }},"
        ));
    }
    line("]");
}

/// A TOML basic string.
pub(crate) fn toml_string(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
