//! The resolved sweep: every default written out, with units, as a sweep file that gives the same plan again; and its hash, which
//! neither the `[figures]` table enters nor the place where a data file lies.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::Dimension;
use crate::quantity::block::Block as _;
use crate::quantity::setting::{Setting, Table, Value, document};
use crate::sweep::plan::axes::PAIRS;
pub(crate) use crate::sweep::plan::material_text::compressibility;
use crate::sweep::plan::material_text::{material_table, table_over_temperatures};
pub use crate::sweep::plan::material_text::{material_text, material_text_without_poisson_ratio};
use crate::sweep::plan::{Axes, AxisValue, Block, Condition, REFINE, SweepPlan, Varied};

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
    let solver = solver.table_for(contact.indenter.as_ref());
    let given = axes.map(|axes| &axes.given_blocks);
    let is_listed = |block| axes.is_some_and(|axes| axes.whole(block).is_some());
    let material = match given.and_then(|given| given.material.as_deref()) {
        _ if is_listed(Block::Material) => String::new(),
        Some(block) => block.trim_start().to_owned(),
        None => {
            let conditions = axes.iter().flat_map(|axes| &axes.conditions);
            material_of(&contact.material, conditions, axes).toml()
        }
    };
    let indenter_material = match given.and_then(|given| given.indenter_material.as_deref()) {
        Some(block) => Some(block.to_owned()),
        None => (contact.material.indenter_material()).map(indenter_material_text),
    };
    let mut contact = contact.blocks(indenter_material);
    if is_listed(Block::Indenter) {
        contact.indenter.clear();
    }
    let frequencies = angular_frequencies_rad_per_s.clone();
    let frequencies = Value::QuantityLines(frequencies, Dimension::AngularFrequency);
    let sweep = Table::new("sweep")
        .and(axes.map(numbers).into_iter().flatten())
        .and(REFINE.setting(refine.then_some(true)))
        .with("angular_frequency", frequencies);
    let listed = axes.iter().flat_map(|axes| axes.over.iter().enumerate());
    let listed = listed.flat_map(|(axis, varied)| listed_blocks(plan, axis, varied));
    let opening = [material, contact.layer, contact.indenter];
    let drive = [base.drive.table().toml(), contact.adhesion];
    let settings = [cycle.table().toml(), solver.toml(), figures.text()];
    let blocks = opening.into_iter().chain(drive).chain([sweep.toml()]);
    document(title, blocks.chain(listed).chain(settings))
}

/// The axes over numbers, as keys of `[sweep]`.
fn numbers(axes: &Axes) -> Vec<Setting> {
    let over = axes.over.iter().enumerate();
    let over = over.filter(|(_, varied)| !varied.is_whole());
    let numbers = over.map(|(axis, varied)| {
        let numbers = axes.numbers_of(axis);
        let values = match varied.dimension {
            Some(dimension) => Value::Quantities(numbers, dimension),
            None => Value::Numbers(numbers),
        };
        // Beside a list of blocks the key would be one of a table in its place.
        match varied.is_nested() || axes.whole(varied.block).is_some() {
            true => Setting::new(format!("\"{}\"", varied.path()), values),
            false => Setting::new(varied.path(), values),
        }
    });
    let pairs = PAIRS.setting(axes.pairs.then_some(true));
    numbers.chain(pairs).collect()
}

/// The `[indenter.material]` block.
pub(crate) fn indenter_material_text(material: &Material) -> String {
    indenter_material(material).toml_below("indenter")
}

/// What an indenter is made of, as a table below it.
fn indenter_material(material: &Material) -> Table {
    // Only the material of the body has alternatives in a file.
    let mut own = material.clone();
    own.origin.alternatives.clear();
    material_table(&own)
}

/// The material of a block under these conditions: at each temperature, where that varies.
fn material_of<'a>(
    own: &Material,
    conditions: impl Iterator<Item = &'a Condition>,
    axes: Option<&Axes>,
) -> Table {
    match axes.is_some_and(|axes| axes.over.iter().any(Varied::is_temperature)) {
        true => table_over_temperatures(conditions.map(|condition| &*condition.contact.material)),
        false => material_table(own),
    }
}

/// The blocks of a list, each under its name; none of an axis over a number.
fn listed_blocks(plan: &SweepPlan, axis: usize, varied: &Varied) -> Vec<String> {
    let conditions = plan.conditions();
    let names = varied.names.iter().enumerate();
    let block = names.filter_map(|(place, name)| {
        let is_meant = |c: &&Condition| c.values.get(axis) == Some(AxisValue::Block(place));
        let under = || conditions.iter().filter(is_meant);
        // Pairs and combinations have every block.
        let first = &under().next()?.contact;
        let block = match varied.block {
            Block::Indenter => {
                let named = Table::new("indenter").with("name", &**name);
                let own = first.material.indenter_material().map(indenter_material);
                named.and(shape(first.indenter.as_ref())).above(own)
            }
            _ => material_of(&first.material, under(), plan.axes.as_ref()),
        };
        Some(block.listed().toml_below("sweep"))
    });
    block.collect()
}

/// Shape and settings of an indenter.
pub(crate) fn shape(indenter: &dyn Indenter) -> Vec<Setting> {
    let mut settings = vec![Setting::new("shape", indenter.shape())];
    settings.extend(indenter.parameters());
    settings
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::plan::figures::FigurePlan;

    #[test]
    fn its_title_and_how_its_figures_look_are_no_part_of_what_a_sweep_is() {
        let sweep = "title = \"a\"\n\n[solver]\ncells = 3\n";
        let figures = FigurePlan {
            width_m: Some(0.085),
            titles: Some(false),
            ..FigurePlan::default()
        };
        let whole = format!("{sweep}\n{}", figures.text());
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
