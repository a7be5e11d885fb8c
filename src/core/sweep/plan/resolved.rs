//! The resolved sweep: every default written out, with units, as a sweep file that gives the same plan again; and its hash, which
//! neither the `[figures]` table enters nor the place where a data file lies.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use crate::drive::{Control, HarmonicDrive};
use crate::engine::SolverPlan;
use crate::indenter::{Indenter, Parameter, Value};
use crate::material::Material;
use crate::quantity::{Dimension, format_si};
pub(crate) use crate::sweep::plan::material_text::compressibility_line;
use crate::sweep::plan::material_text::text_over_temperatures;
pub use crate::sweep::plan::material_text::{material_text, material_text_without_poisson_ratio};
use crate::sweep::plan::{Axes, AxisValue, Block, Condition, CyclePlan, SweepPlan, Varied};

/// The plan as the text of a sweep file.
pub fn resolved_text(plan: &SweepPlan) -> String {
    // By name, so that what is added to a plan and not written here, and so not hashed, does not compile.
    let SweepPlan {
        title,
        base,
        axes,
        solver,
        angular_frequencies_rad_per_s,
        refine,
        cycle,
        figures,
    } = plan;
    let (contact, axes) = (&base.contact, axes.as_ref());
    let solver = solver_text(solver, contact.indenter.as_ref());
    let given = axes.map(|axes| &axes.given_blocks);
    let is_listed = |block| axes.is_some_and(|axes| axes.whole(block).is_some());
    let mut blocks = match given.and_then(|given| given.material.as_deref()) {
        _ if is_listed(Block::Material) => String::new(),
        Some(block) => block.to_owned(),
        None => {
            let conditions = axes.iter().flat_map(|axes| &axes.conditions);
            material_of(&contact.material, conditions, axes)
        }
    };
    let indenter_material = match given.and_then(|given| given.indenter_material.as_deref()) {
        Some(block) => Some(block.to_owned()),
        None => contact
            .material
            .indenter_material()
            .map(indenter_material_text),
    };
    let contact = contact.blocks(indenter_material);
    blocks.push_str(&contact.layer);
    if !is_listed(Block::Indenter) {
        blocks.push_str(&contact.indenter);
    }
    let each = angular_frequencies_rad_per_s.iter();
    let each = each.map(|omega| quoted(*omega, Dimension::AngularFrequency));
    let frequencies: String = each.map(|omega| format!("    {omega},\n")).collect();
    let listed = axes.iter().flat_map(|axes| axes.over.iter().enumerate());
    let listed = listed.map(|(axis, varied)| listed_text(plan, axis, varied));
    [
        opening_text(title, &blocks),
        drive_text(&base.drive),
        format!("\n{}\n[sweep]\n", contact.adhesion),
        axes.map(numbers_text).unwrap_or_default(),
        entry("refine", refine.then(|| "true".to_owned())),
        format!("angular_frequency = [\n{frequencies}]\n\n"),
        listed.collect(),
        cycle_text(cycle),
        format!("\n{}", solver),
        figures.text(),
    ]
    .concat()
}

/// The axes over numbers, as keys of `[sweep]`.
fn numbers_text(axes: &Axes) -> String {
    let over = axes.over.iter().enumerate();
    let over = over.filter(|(_, varied)| !varied.is_whole());
    let lines = over.map(|(axis, varied)| {
        let number = |value: f64| match varied.dimension {
            Some(dimension) => quoted(value, dimension),
            None => format!("{value:?}"),
        };
        let values: Vec<String> = axes.numbers_of(axis).into_iter().map(number).collect();
        // Beside a list of blocks the key would be one of a table in its place.
        let quote = match varied.is_nested() || axes.whole(varied.block).is_some() {
            true => "\"",
            false => "",
        };
        format!(
            "{quote}{}{quote} = [{}]\n",
            varied.path(),
            values.join(", ")
        )
    });
    lines.collect::<String>() + &entry("pairs", axes.pairs.then(|| "true".to_owned()))
}

/// The `[drive]` block of an oscillation, with an empty line before it and no line end behind it.
pub(crate) fn drive_text(drive: &HarmonicDrive) -> String {
    let dimension = drive_dimension(drive.control());
    format!(
        "\n[drive]\ncontrol = \"{}\"\nmean = {}\namplitude = {}\nphase = {}\nhold = {}",
        drive.control().name(),
        quoted(drive.mean(), dimension),
        quoted(drive.amplitude(), dimension),
        quoted(drive.phase_rad(), Dimension::Angle),
        quoted(drive.hold_s(), Dimension::Time)
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
    format!(
        "[cycle]\nsteps = {steps}\nmethod = \"{}\"\ntolerance = {tolerance:e}\nmax_cycles = {max_cycles}\n{}error_bars = \
         {error_bars}\n{}",
        method.name(),
        entry("at_cycle", at_cycle.map(|cycle| cycle.to_string())),
        entry("accuracy", accuracy.map(|accuracy| format!("{accuracy:e}")))
    )
}

/// The `[indenter.material]` block.
pub(crate) fn indenter_material_text(material: &Material) -> String {
    // Only the material of the body has alternatives in a file.
    let mut own = material.clone();
    own.origin.alternatives.clear();
    let moved = |line: &str| match line.split_once("[material") {
        // A header, and not a name with these letters.
        Some((brackets @ ("" | "["), rest)) => format!("{brackets}[indenter.material{rest}"),
        _ => line.to_owned(),
    };
    let text = material_text(&own);
    text.split('\n').map(moved).collect::<Vec<_>>().join("\n")
}

/// The material of a block under these conditions: at each temperature, where that varies.
fn material_of<'a>(
    own: &Material,
    conditions: impl Iterator<Item = &'a Condition>,
    axes: Option<&Axes>,
) -> String {
    match axes.is_some_and(|axes| axes.over.iter().any(Varied::is_temperature)) {
        true => text_over_temperatures(conditions.map(|condition| &*condition.contact.material)),
        false => material_text(own),
    }
}

/// The blocks of a list, each under its name; nothing of an axis over a number.
fn listed_text(plan: &SweepPlan, axis: usize, varied: &Varied) -> String {
    let conditions = plan.conditions();
    let mut text = String::new();
    for (place, name) in varied.names.iter().enumerate() {
        let is_meant = |c: &&Condition| c.values.get(axis) == Some(AxisValue::Block(place));
        let under = || conditions.iter().filter(is_meant);
        // Pairs and combinations have every block.
        let Some(first) = under().next() else {
            continue;
        };
        let (block, name) = match varied.block {
            Block::Indenter => {
                let indenter_material = first
                    .contact
                    .material
                    .indenter_material()
                    .map(indenter_material_text);
                let block = indenter_text(first.contact.indenter.as_ref(), indenter_material);
                (block, Some(toml_string(name)))
            }
            _ => (
                material_of(&first.contact.material, under(), plan.axes.as_ref()),
                None,
            ),
        };
        let own = varied.block.name();
        let lines = block.trim_start().lines().skip(1);
        let lines = lines.map(|line| match line.starts_with('[') {
            true => line.replacen(own, &format!("sweep.{own}"), 1) + "\n",
            false => format!("{line}\n"),
        });
        let lines: String = lines.collect();
        text += &format!("[[sweep.{own}]]\n{}{lines}\n", entry("name", name));
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
pub(crate) fn indenter_text(indenter: &dyn Indenter, indenter_material: Option<String>) -> String {
    let parameters = indenter.parameters();
    let parameters = parameters
        .iter()
        .map(|p| format!("{}\n", parameter_text(p)));
    let of_indenter = indenter_material.map(|block| format!("\n{block}"));
    format!(
        "\n[indenter]\nshape = \"{}\"\n{}{}",
        indenter.shape(),
        parameters.collect::<String>(),
        of_indenter.unwrap_or_default()
    )
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
    let cells = indenter.own_cells().is_none().then(|| cells.to_string());
    format!(
        "[solver]\nengine = \"{}\"\n{}springs = {springs}\n{}time_rule = \"{}\"\n",
        engine.name(),
        entry("cells", cells),
        entry("tolerance", tolerance.map(|t| format!("{t:e}"))),
        time_rule.name()
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
fn parameter_text(parameter: &Parameter) -> String {
    let value = match &parameter.value {
        Value::Quantity(value, dimension) => quoted(*value, *dimension),
        Value::Quantities(values, dimension) => {
            let values: Vec<String> = values.iter().map(|&v| quoted(v, *dimension)).collect();
            format!("[{}]", values.join(", "))
        }
        // Debug keeps the decimal point that TOML asks of a float.
        Value::Number(number) => format!("{number:?}"),
        Value::Integer(integer) => integer.to_string(),
        Value::Text(text) => toml_string(text),
        Value::Tables(tables) => {
            let row = |table: &Vec<Parameter>| {
                let entries: Vec<String> = table.iter().map(parameter_text).collect();
                format!("    {{ {} }},\n", entries.join(", "))
            };
            format!("[\n{}]", tables.iter().map(row).collect::<String>())
        }
    };
    format!("{} = {value}", parameter.key)
}

/// SHA-256 of the values of a resolved file that make it the one that it is, in hexadecimal; of what is no TOML that of its text.
pub fn hash(resolved: &str) -> String {
    let values = values(resolved).and_then(|values| serde_json::to_vec(&values).ok());
    hash_of_bytes(values.as_deref().unwrap_or(resolved.as_bytes()))
}

/// What makes a resolved sweep or scenario the one that it is, as TOML with its keys in alphabetical order.
pub fn identity(resolved: &str) -> String {
    let text = values(resolved).and_then(|values| toml::to_string_pretty(&values).ok());
    text.unwrap_or_else(|| resolved.to_owned())
}

/// The values of a resolved file without what it is called and how its figures look, and without the place of data files, whose content
/// is known by the hash beside it.
fn values(resolved: &str) -> Option<toml::Value> {
    fn without_places(value: &mut toml::Value) {
        match value {
            toml::Value::Table(table) => {
                if table.contains_key("sha256") {
                    table.remove("file");
                }
                table
                    .iter_mut()
                    .for_each(|(_, below)| without_places(below));
            }
            toml::Value::Array(items) => items.iter_mut().for_each(without_places),
            _ => {}
        }
    }
    let mut values: toml::Table = resolved.parse().ok()?;
    values.remove("title");
    values.remove("figures");
    let mut values = toml::Value::Table(values);
    without_places(&mut values);
    Some(values)
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

/// A line with a key, where there is a value.
pub(crate) fn entry(key: &str, value: Option<String>) -> String {
    value.map_or(String::new(), |value| format!("{key} = {value}\n"))
}

/// A quantity as TOML.
pub(crate) fn quoted(value: f64, dimension: Dimension) -> String {
    format!("\"{}\"", format_si(value, dimension))
}

/// A list of bare numbers as TOML.
pub(crate) fn numbers(values: impl Iterator<Item = f64>) -> String {
    // `{:?}` writes a float as TOML reads it, with a point or an exponent, and loses no bit.
    let values: Vec<String> = values.map(|value| format!("{value:?}")).collect();
    format!("[{}]", values.join(", "))
}

/// A TOML basic string.
pub fn toml_string(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::plan::figures::FigurePlan;

    #[test]
    fn its_title_and_how_its_figures_look_are_no_part_of_what_a_sweep_is() {
        let sweep = "title = \"a\"\n\n[solver]\ncells = 3\n";
        let figures = FigurePlan {
            width_m: Some(0.085),
            titles: false,
            ..FigurePlan::default()
        };
        let whole = format!("{sweep}{}", figures.text());
        assert!(whole.contains("[figures]"));
        assert_eq!(identity(&whole), identity(sweep));
        assert_eq!(hash(&whole), hash(sweep));
        assert_eq!(hash(&sweep.replace("\"a\"", "\"b\"")), hash(sweep));
        // A name that looks like the table is none.
        let name = "[material]\nname = \"\"\"a\n[figures]\nb\"\"\"\n\n[solver]\ncells = 3\n";
        assert!(identity(name).contains("[figures]"));
    }

    #[test]
    fn the_order_and_the_layout_of_keys_make_no_other_sweep() {
        let one = "title = \"a\"\n[solver]\ncells = 3\nsprings = 4\n";
        let other = "title='a' # the same\n[solver]\nsprings=4\ncells =   3\n";
        assert_eq!(hash(one), hash(other));
        assert_ne!(hash(one), hash(&one.replace('4', "5")));
    }
}
