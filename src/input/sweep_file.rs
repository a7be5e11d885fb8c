//! Sweep files: from a document to a finished plan, every default filled in, every problem reported where it stands.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use super::adhesion_block::Attraction;
use super::axis::Swept;
use super::diagnostic::{Diagnostics, Problems};
use super::document::kind::Table;
use super::document::reader::TableReader;
use super::document::row::{Required, Row};
use super::document::tree::Value;
use super::document::{self, Document, Located};
use super::figures_block::{self, Figures};
use super::given::Given;
use super::harmonic_block::Pressed;
use super::keys;
use super::keys::drive::{
    ANGULAR_FREQUENCY, DRIVE_AXIS, FREQUENCY, INDENTER_AXIS, LAYER_AXIS, MATERIAL_AXIS, PAIRS,
    Prescribed, REFINE,
};
use super::keys::settings::{
    AT_CYCLE, CYCLE_ACCURACY, CYCLE_ERROR_BARS, CYCLE_STEPS, CYCLE_TOLERANCE, ENGINE, MAX_CYCLES,
    METHOD, SOLVER_CELLS, SOLVER_SPRINGS, SOLVER_TOLERANCE, TIME_RULE,
};
use super::material_table::DirectSum;
use super::{adhesion_block, axis, harmonic_block, indenter_block, layer_block, material_block};
use crate::drive::HarmonicDrive;
use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::{Dimension, FrequencyUnit};
use crate::sweep::figures::figure_plan::FigurePlan;
use crate::sweep::plan::axes::{GivenBlocks, MOST as MOST_AXES};
use crate::sweep::plan::body_material::BodyMaterial;
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{
    self, AxisValues, Block, Condition, CyclePlan, Method, SolverPlan, SweepPlan, Varied,
};
use crate::sweep::scales::elastic::ElasticScale;

const MAX_CASES: usize = SweepPlan::MAX_CASES;

/// The plan that a sweep file asks for.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document) -> Result<SweepPlan, Diagnostics> {
    plan_with(document, &Given::default())
}

/// The same, with values for blocks that the file leaves out.
///
/// # Errors
/// As [`plan`].
pub fn plan_with(document: &Document, given: &Given) -> Result<SweepPlan, Diagnostics> {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let title = root.value(&keys::TITLE);
    let prescribed = harmonic_block::prescribed(&mut root);
    let sweep = root
        .table(&keys::SWEEP)
        .and_then(|t| axes(t, prescribed.dimension(), &problems));
    let swept = sweep.as_ref().map_or(&[][..], |sweep| &sweep.swept);
    let pairs = sweep.as_ref().is_some_and(|sweep| sweep.pairs);
    let file = File {
        folder: document.folder(),
        swept,
        pairs,
        conditions: conditions(swept, pairs),
        prescribed,
        given,
        sweep: root.parsed(&keys::SWEEP),
        problems: &problems,
    };
    file.refuse_beside_lists(&mut root);
    let counterbody = file.counterbody(&mut root);
    let layer = file.layer(&mut root);
    let bodies = |(own, each): &Over<Option<Body>>| {
        let all = [own].into_iter().chain(each).flatten();
        all.cloned().collect::<Vec<Body>>()
    };
    let has_counterbody = (counterbody.as_ref()).is_some_and(|over| !bodies(over).is_empty());
    layer_block::refuse_second_body(&mut root, has_counterbody, &problems);
    let counterbody =
        counterbody.filter(|over| (bodies(over).iter()).all(|body| check_contact(&problems, body)));
    let given_blocks = file.given_blocks(&mut root);
    let material = file.material(&mut root);
    let material = material.zip(counterbody).map(|(own, of)| beside(own, &of));
    let indenter = file.indenter(&mut root);
    let adhesion_at = root.key_location(&keys::ADHESION);
    let adhesion = root.table_or(&keys::ADHESION, None, |t| adhesion_block::read(t).map(Some));
    let pressed = Pressed {
        area_m2: indenter
            .as_ref()
            .and_then(|indenter| file.period_area_m2(indenter)),
        is_attracted: adhesion_at.is_some(),
    };
    let drive = file.block(&mut root, &keys::DRIVE, file.swept(Block::Drive), |t| {
        harmonic_block::read(t, pressed, &problems)
    });
    let cycle = root.table_or(&keys::CYCLE, CyclePlan::default(), |t| cycle(t, &problems));
    let own_layer = layer.as_ref().and_then(|(own, _)| *own);
    // Cells can do what springs cannot.
    let deciding = indenter.as_ref().map(|(own, each)| {
        let mut on_cells = each.iter().filter(|other| other.axisymmetric().is_none());
        on_cells.next().unwrap_or(own).as_ref()
    });
    let default = default_solver(deciding, own_layer);
    let solver = root.table_or(&keys::SOLVER, default, |t| {
        layer_block::solver_on(own_layer.is_some(), t, default, &problems)
    });
    let frequencies = sweep.as_ref();
    let frequencies = frequencies.map(|axes| axes.angular_frequencies_rad_per_s.as_slice());
    let given_in = sweep.as_ref().map(|axes| axes.given_in);
    let given_in = given_in.unwrap_or_default();
    let figures = root.table_or(&keys::FIGURES, Figures::of_unit(given_in), |t| {
        figures_block::of_sweep(t, (frequencies, given_in), &problems)
    });
    root.finish();
    let plan = (|| {
        let (figures, cycle, solver) = (figures?, cycle?, solver?);
        let (material, indenter, drive, layer) = (material?, indenter?, drive?, layer?);
        let adhesion = adhesion?;
        let attracted =
            |own: HarmonicDrive, indenter: &dyn Indenter| match (&adhesion, &adhesion_at) {
                (Some(adhesion), Some(place)) => Attraction {
                    adhesion,
                    place,
                    problems: &problems,
                }
                .drive(indenter, &own),
                _ => Some(own),
            };
        let own_drive = attracted(drive.0, indenter.0.as_ref())?;
        let mut axes = file.axes((&material, &layer, &indenter, &drive), given_blocks);
        for condition in axes.iter_mut().flat_map(|axes| &mut axes.conditions) {
            condition.drive = attracted(condition.drive, condition.indenter.as_ref())?;
        }
        let sweep = sweep.as_ref()?;
        let mut plan = SweepPlan {
            title: title?,
            contact: ContactPlan {
                material: material.0,
                layer: layer.0,
                indenter: indenter.0,
                adhesion,
                solver,
            },
            drive: own_drive,
            angular_frequencies_rad_per_s: sweep.angular_frequencies_rad_per_s.clone(),
            axes,
            refine: sweep.refine,
            cycle,
            figures: FigurePlan::default(),
        };
        let scale = || ElasticScale::of_sweep(&plan).map(drop);
        plan.figures = figures.checked(scale, &problems)?;
        Some(plan)
    })();
    problems.into_result(plan)
}

/// What a block says, and what it says under each condition.
type Over<T> = (T, Vec<T>);

/// What the indenter is made of.
type Body = Arc<Located<Material>>;

/// Material, layer, indenter and drive.
type Blocks<'a> = (
    &'a Over<Arc<Material>>,
    &'a Over<Option<LayerPlan>>,
    &'a Over<Arc<dyn Indenter>>,
    &'a Over<HarmonicDrive>,
);

/// What the blocks of a file have in common.
struct File<'a> {
    folder: &'a Path,
    swept: &'a [Swept],
    pairs: bool,
    /// The values of all axes under each condition.
    conditions: Vec<Vec<f64>>,
    prescribed: Prescribed,
    given: &'a Given,
    /// The `[sweep]` block as it was parsed.
    sweep: Option<&'a document::tree::Table>,
    problems: &'a Problems,
}

impl File<'_> {
    /// The axes of a block, with the place of each among all.
    fn swept(&self, block: Block) -> Vec<(usize, &Swept)> {
        self.swept_where(|varied| varied.block == block)
    }

    fn swept_where(&self, is_meant: impl Fn(&Varied) -> bool) -> Vec<(usize, &Swept)> {
        let all = self.swept.iter().enumerate();
        all.filter(|(_, swept)| is_meant(&swept.varied)).collect()
    }

    /// The list of blocks that stands in place of one, where there is any.
    fn listed(&self, block: Block) -> Option<&Swept> {
        let mut all = self.swept.iter().map(|swept| (swept, &swept.varied));
        all.find(|(_, varied)| varied.block == block && varied.is_whole())
            .map(|(swept, _)| swept)
    }

    /// Refuses a block beside the list of those that take its place.
    fn refuse_beside_lists(&self, root: &mut TableReader<'_>) {
        for (block, row) in [
            (Block::Material, &keys::MATERIAL),
            (Block::Indenter, &keys::INDENTER),
        ] {
            if let Some((list, key)) = self.listed(block).zip(root.key_location(row)) {
                let name = row.name;
                self.problems
                    .at(&key, format!("`[{name}]` beside `[[sweep.{name}]]`"))
                    .because("one, where the list has several")
                    .label(&list.key_location, "the list")
                    .help(format!("remove `[{name}]`, or the list"));
            }
        }
    }

    /// Reads a block: once, and once more for each set of values that these axes give it. Where the block leaves out what an axis
    /// varies, and of blocks in a list, the first condition counts.
    fn block<T: Clone>(
        &self,
        root: &mut TableReader<'_>,
        row: &Row<Table, Required>,
        swept: Vec<(usize, &Swept)>,
        read: impl Fn(TableReader<'_>) -> Option<T>,
    ) -> Option<Over<T>> {
        let list = swept.iter().position(|(_, swept)| swept.varied.is_whole());
        let has_list = || {
            self.sweep
                .is_some_and(|sweep| axis::has_list(sweep, row.name))
        };
        let (given, base) = match list {
            Some(_) => (None, None),
            // What is wrong with the list is told already.
            None if has_list() => return None,
            None => {
                let parsed = root.parsed(row);
                let own = root.table(row)?;
                let (false, Some(parsed)) = (swept.is_empty(), parsed) else {
                    return Some((read(own)?, Vec::new()));
                };
                let place = own.as_ref().clone();
                let is_given = |(_, swept): &(usize, &Swept)| swept.is_in(parsed);
                let given = match swept.iter().all(is_given) {
                    true => Some(read(own)?),
                    false => None,
                };
                let base = Located {
                    value: parsed.clone(),
                    path: row.name.to_owned(),
                    location: place,
                };
                (given, Some(base))
            }
        };
        let each = self.each(&swept, |values| {
            let base = match list {
                Some(at) => swept.get(at)?.1.block(*values.get(at)?)?,
                None => base.as_ref()?,
            };
            let mut all = values.iter().zip(&swept);
            let table = all.try_fold(base.value.clone(), |table, (value, (_, swept))| {
                swept.put_into(&table, *value)
            });
            let table = table.map_err(|problem| self.problems.push(problem)).ok()?;
            let (place, path) = (base.location.clone(), base.path.clone());
            read(TableReader::new(&table, place, path, self.problems))
        })?;
        Some((given.or_else(|| each.first().cloned())?, each))
    }

    /// What is read of the values of some axes, under each condition; each set of values is read once. What is wrong with one value
    /// of numbers is wrong with others too, and told once; of the blocks of a list each has mistakes of its own.
    fn each<T: Clone>(
        &self,
        swept: &[(usize, &Swept)],
        read: impl Fn(&[f64]) -> Option<T>,
    ) -> Option<Vec<T>> {
        let mut known: HashMap<Vec<u64>, Option<T>> = HashMap::new();
        let of_condition = |values: &Vec<f64>| {
            let own: Vec<f64> = swept.iter().map(|(axis, _)| values[*axis]).collect();
            let bits = own.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            let known = known.entry(bits);
            known.or_insert_with(|| read(&own)).clone()
        };
        let conditions = self.conditions.iter().map(of_condition);
        match swept.iter().all(|(_, swept)| swept.varied.is_whole()) {
            true => conditions.collect::<Vec<_>>().into_iter().collect(),
            false => conditions.collect(),
        }
    }

    /// What the indenter is made of, where it is not rigid. What is wrong with the block itself is told where its shape is read.
    fn counterbody(&self, root: &mut TableReader<'_>) -> Option<Over<Option<Body>>> {
        let is_listed = self.listed(Block::Indenter).is_some();
        if root.parsed(&keys::INDENTER).is_none() && !is_listed {
            return Some((None, Vec::new()));
        }
        let is_meant = |varied: &Varied| {
            varied.is_of_counterbody() || (varied.block == Block::Indenter && varied.is_whole())
        };
        let swept = self.swept_where(is_meant);
        self.block(root, &keys::INDENTER, swept, |t| {
            let body = indenter_block::material_of(t, self.folder, self.problems)?;
            Some(body.map(Arc::new))
        })
    }

    /// The material, without what the indenter is made of.
    fn material(&self, root: &mut TableReader<'_>) -> Option<Over<Arc<Material>>> {
        let for_contact =
            |material: Located<Material>| for_contact(self.problems, material).map(Arc::new);
        let over = |t: TableReader<'_>, axis: Option<&Located<Vec<f64>>>| {
            material_block::read_over(t, self.folder, DirectSum::Refused, axis, self.problems)
        };
        let given =
            (self.given.material.as_ref()).filter(|_| self.listed(Block::Material).is_none());
        let series = given.and_then(BodyMaterial::series);
        if let (Some(series), None) = (series, root.key_location(&keys::MATERIAL)) {
            let given = Located {
                value: series.clone(),
                path: "material".to_owned(),
                location: root.as_ref().clone(),
            };
            return Some((for_contact(given)?, Vec::new()));
        }
        let swept = self.swept(Block::Material);
        let temperature = |(_, swept): &&(usize, &Swept)| swept.varied.is_temperature();
        match (swept.iter().find(temperature), swept.as_slice()) {
            // One fit gives the material at every temperature.
            (Some(temperatures), [_]) => {
                let values = &temperatures.1.values;
                let (body, each) = over(root.table(&keys::MATERIAL)?, Some(values))?;
                let place = body.location.clone();
                let at = |material: &Material| {
                    for_contact(Located {
                        value: material.clone(),
                        path: "material".to_owned(),
                        location: place.clone(),
                    })
                };
                let each: Vec<_> = each.iter().map(at).collect::<Option<_>>()?;
                let of_condition = self.each(&swept, |at| {
                    let at = values
                        .value
                        .iter()
                        .position(|value| Some(value) == at.first());
                    each.get(at?).cloned()
                })?;
                Some((of_condition.first()?.clone(), of_condition))
            }
            _ => self.block(root, &keys::MATERIAL, swept, |t| {
                for_contact(material_block::series_of(over(t, None)?.0)?)
            }),
        }
    }

    /// The texts of the blocks in whose tables an axis varies a number.
    fn given_blocks(&self, root: &mut TableReader<'_>) -> GivenBlocks {
        let varies = |of: &dyn Fn(&Varied) -> bool| self.swept.iter().any(|s| of(&s.varied));
        let in_material = |varied: &Varied| varied.block == Block::Material && varied.is_nested();
        let material = root
            .parsed(&keys::MATERIAL)
            .filter(|_| varies(&in_material));
        let indenter = root.parsed(&keys::INDENTER);
        let counterbody = indenter.filter(|_| varies(&Varied::is_of_counterbody));
        let counterbody =
            counterbody.and_then(
                |indenter| match &indenter.entries.get("material")?.node.value {
                    Value::Table(block) => Some(block),
                    _ => None,
                },
            );
        GivenBlocks {
            material: material.map(|block| block.toml("material").into()),
            counterbody: counterbody.map(|block| block.toml("indenter.material").into()),
        }
    }

    fn indenter(&self, root: &mut TableReader<'_>) -> Option<Over<Arc<dyn Indenter>>> {
        let list = self.listed(Block::Indenter);
        let given = self.given.indenter.as_ref().filter(|_| list.is_none());
        if let (Some(given), None) = (given, root.key_location(&keys::INDENTER)) {
            return Some((Arc::clone(given), Vec::new()));
        }
        let swept = self
            .swept_where(|varied| varied.block == Block::Indenter && !varied.is_of_counterbody());
        let over = self.block(root, &keys::INDENTER, swept, |t| {
            indenter_block::read(t, self.folder, self.problems)
        })?;
        let has_other_cells = |other: &Arc<dyn Indenter>| other.own_cells() != over.0.own_cells();
        match list.filter(|_| over.1.iter().any(has_other_cells)) {
            Some(list) => {
                self.problems
                    .at(
                        &list.key_location,
                        "the indenters of one sweep must be on the same cells",
                    )
                    .because("maps bring cells of their own")
                    .help("make a sweep of each map, and compare their folders");
                None
            }
            None => Some(over),
        }
    }

    /// The layer, where the body is one; where an axis varies it, it must be.
    fn layer(&self, root: &mut TableReader<'_>) -> Option<Over<Option<LayerPlan>>> {
        match root.has(&keys::LAYER) || !self.swept(Block::Layer).is_empty() {
            true => self.block(root, &keys::NEEDED_LAYER, self.swept(Block::Layer), |t| {
                layer_block::read(t, self.problems).map(Some)
            }),
            false => Some((None, Vec::new())),
        }
    }

    /// The area (m^2) of one period of a surface that repeats itself, if it has the same under all conditions.
    fn period_area_m2(&self, indenter: &Over<Arc<dyn Indenter>>) -> Option<f64> {
        let own = indenter.0.period_area_m2()?;
        let is_same = |other: &Arc<dyn Indenter>| other.period_area_m2() == Some(own);
        indenter.1.iter().all(is_same).then_some(own)
    }

    /// The axes besides the frequency, where there are any. Pressures are told as the loads that they are.
    fn axes(
        &self,
        (material, layer, indenter, drive): Blocks<'_>,
        given_blocks: GivenBlocks,
    ) -> Option<plan::Axes> {
        if self.swept.is_empty() {
            return None;
        }
        let is_pressure = |varied: &Varied| {
            self.prescribed == Prescribed::Pressure && (varied.is_mean() || varied.is_amplitude())
        };
        let area_m2 = indenter.0.period_area_m2().unwrap_or(1.0);
        let as_load = |(value, swept): (&f64, &Swept)| match is_pressure(&swept.varied) {
            true => area_m2 * value,
            false => *value,
        };
        let conditions = self.conditions.iter().enumerate();
        let conditions = conditions.map(|(k, values)| {
            let values: Vec<f64> = values.iter().zip(self.swept).map(as_load).collect();
            Some(Condition {
                values: AxisValues::new(&values)?,
                material: Arc::clone(material.1.get(k).unwrap_or(&material.0)),
                layer: *layer.1.get(k).unwrap_or(&layer.0),
                indenter: Arc::clone(indenter.1.get(k).unwrap_or(&indenter.0)),
                drive: *drive.1.get(k).unwrap_or(&drive.0),
            })
        });
        Some(plan::Axes {
            over: self
                .swept
                .iter()
                .map(|swept| match is_pressure(&swept.varied) {
                    true => Varied {
                        dimension: Some(Dimension::Force),
                        ..swept.varied.clone()
                    },
                    false => swept.varied.clone(),
                })
                .collect(),
            pairs: self.pairs,
            given_blocks,
            conditions: conditions.collect::<Option<_>>()?,
        })
    }
}

/// A material beside what the indenter is made of, under each condition where either varies; each pair is made once.
fn beside(own: Over<Arc<Material>>, counterbody: &Over<Option<Body>>) -> Over<Arc<Material>> {
    let ((own, each), (of_indenter, of_each)) = (own, counterbody);
    let mut known: HashMap<_, Arc<Material>> = HashMap::new();
    let mut pair = |own: &Arc<Material>, of: &Option<Body>| {
        let Some(of) = of else {
            return Arc::clone(own);
        };
        let known = known.entry((Arc::as_ptr(own), Arc::as_ptr(of)));
        let both = || Arc::new(Material::clone(own).against(of.value.clone()));
        Arc::clone(known.or_insert_with(both))
    };
    let first = pair(&own, of_indenter);
    let conditions = 0..each.len().max(of_each.len());
    let under = |k: usize| {
        let of = of_each.get(k).unwrap_or(of_indenter);
        pair(each.get(k).unwrap_or(&own), of)
    };
    (first, conditions.map(under).collect())
}

/// All combinations of the values of these axes, those of the last fastest; or the values that stand at the same place, in the order of
/// the first axis.
fn conditions(swept: &[Swept], pairs: bool) -> Vec<Vec<f64>> {
    let values = |axis: &Swept| axis.values.value.clone();
    if pairs {
        let all: Vec<Vec<f64>> = swept.iter().map(values).collect();
        let count = all.iter().map(Vec::len).min().unwrap_or(0);
        let mut together: Vec<Vec<f64>> = (0..count)
            .map(|k| all.iter().map(|values| values[k]).collect())
            .collect();
        together.dedup();
        return together;
    }
    swept.iter().fold(vec![Vec::new()], |before, axis| {
        let with = |values: &Vec<f64>| {
            let values = values.clone();
            let next = axis.values.value.iter();
            next.map(move |value| values.iter().copied().chain([*value]).collect())
                .collect::<Vec<Vec<f64>>>()
        };
        before.iter().flat_map(with).collect()
    })
}

/// The solver where the file asks for none: springs where indenter and body allow them, cells elsewhere.
pub(super) fn default_solver(
    indenter: Option<&dyn Indenter>,
    layer: Option<LayerPlan>,
) -> SolverPlan {
    indenter.map_or_else(SolverPlan::default, |indenter| {
        SolverPlan::of(indenter, layer)
    })
}

/// A material that has passed [`check_contact`]; `None` of others.
fn for_contact(problems: &Problems, material: Located<Material>) -> Option<Material> {
    check_contact(problems, &material).then_some(material.value)
}

/// Refuses materials that cannot be in contact, or whose contact has no stabilised cycle: false of those.
fn check_contact(problems: &Problems, material: &Located<Material>) -> bool {
    match material.value.contact_compliance() {
        Err(error) => {
            problems.at(material, error.to_string());
            false
        }
        Ok(compliance) if compliance.is_fluid() => {
            problems
                .at(
                    material,
                    "this material is a fluid, and a sweep looks for a stabilised cycle",
                )
                .because("creeps without end under a mean load")
                .help(match material.value.fit() {
                    Some(_) => {
                        "write `flow = false` in [material.table] for the solid that fits best, or follow one history \
                         with `contact-dma simulate`"
                    }
                    None if material.value.approximation().is_some() => {
                        "write model = \"zener\" with an equilibrium modulus above zero, or follow one history with \
                         `contact-dma simulate`"
                    }
                    None => "give it an equilibrium modulus above zero, or leave out its viscosity",
                });
            false
        }
        Ok(_) => true,
    }
}

/// The `[sweep]` block.
struct Axes {
    angular_frequencies_rad_per_s: Vec<f64>,
    given_in: FrequencyUnit,
    swept: Vec<Swept>,
    pairs: bool,
    refine: bool,
}

fn axes(mut table: TableReader<'_>, controlled: Dimension, problems: &Problems) -> Option<Axes> {
    let frequencies = frequencies(&mut table);
    let refine = table.value(&REFINE);
    let pairs = table.value(&PAIRS);
    let mut swept = Vec::new();
    let mut is_whole = true;
    for row in [&MATERIAL_AXIS, &LAYER_AXIS, &INDENTER_AXIS, &DRIVE_AXIS] {
        let row = row.of(controlled);
        let row = Row {
            kind: row.kind.in_order(pairs.unwrap_or(false)),
            ..row
        };
        match table.value(&row) {
            Some(found) => swept.extend(found.into_iter().flatten()),
            None => is_whole = false,
        }
    }
    table.finish();
    let ((frequencies, given_in), pairs) = (frequencies?, pairs?);
    check_axes(&swept, pairs, frequencies.len(), problems)?;
    is_whole.then_some(())?;
    if pairs {
        in_order_of_numbers(&mut swept);
    }
    Some(Axes {
        angular_frequencies_rad_per_s: frequencies,
        given_in,
        swept,
        pairs,
        refine: refine?,
    })
}

/// Puts pairs in ascending order of their numbers, and what is listed beside them in the same order.
fn in_order_of_numbers(swept: &mut [Swept]) {
    let numbers = swept.iter().filter(|axis| !axis.varied.is_whole());
    let numbers: Vec<&[f64]> = numbers.map(|axis| axis.values.value.as_slice()).collect();
    let pairs = swept.first().map_or(0, |axis| axis.values.value.len());
    let of_pair = |k: usize| numbers.iter().map(move |values| values[k]);
    let mut order: Vec<usize> = (0..pairs).collect();
    order.sort_by(|a, b| {
        let order = of_pair(*a).partial_cmp(of_pair(*b));
        order.unwrap_or(std::cmp::Ordering::Equal)
    });
    swept.iter_mut().for_each(|axis| axis.reorder(&order));
}

/// What axes must not be together.
fn check_axes(swept: &[Swept], pairs: bool, frequencies: usize, problems: &Problems) -> Option<()> {
    let (Some(first), Some(last)) = (swept.first(), swept.last()) else {
        return Some(());
    };
    if swept.len() > MOST_AXES {
        let what = format!("a sweep has at most {MOST_AXES} axes besides the frequency");
        problems
            .at(&last.key_location, what)
            .help("remove one, or make several sweeps of it");
        return None;
    }
    let count = |axis: &Swept| axis.values.value.len();
    if let Some(other) = swept
        .iter()
        .find(|axis| pairs && count(axis) != count(first))
    {
        let what = "pairs need as many values on every axis";
        problems
            .at(&other.key_location, what)
            .because(format!("{} values", count(other)))
            .label(&first.key_location, format!("{} values", count(first)))
            .help("give as many, or remove `pairs` for all combinations");
        return None;
    }
    let conditions = match pairs {
        true => count(first),
        false => swept.iter().map(count).fold(1, usize::saturating_mul),
    };
    let cases = conditions.saturating_mul(frequencies);
    if cases > MAX_CASES {
        problems
            .at(
                &last.key_location,
                format!("{cases} cases are more than a sweep may have, {MAX_CASES}"),
            )
            .help("make several sweeps of it");
        return None;
    }
    Some(())
}

/// Angular frequencies in rad/s, ascending, and the unit they are given in.
fn frequencies(table: &mut TableReader<'_>) -> Option<(Vec<f64>, FrequencyUnit)> {
    let keys = [
        (
            &ANGULAR_FREQUENCY as _,
            (&ANGULAR_FREQUENCY, 1.0, FrequencyUnit::RadPerS),
        ),
        (
            &FREQUENCY as _,
            (&FREQUENCY, std::f64::consts::TAU, FrequencyUnit::Hz),
        ),
    ];
    let (row, to_angular, given_in) = table.one_of(&keys)?;
    let values = table.value(row)?.into_iter();
    Some((values.map(|value| value * to_angular).collect(), given_in))
}

pub(super) fn cycle(mut table: TableReader<'_>, problems: &Problems) -> Option<CyclePlan> {
    let steps = table.value(&CYCLE_STEPS);
    let method = table.value(&METHOD);
    let tolerance = table.value(&CYCLE_TOLERANCE);
    let max_cycles = table.value(&MAX_CYCLES);
    let at_cycle = table.value(&AT_CYCLE);
    if let (Some(key), Some(Method::Direct)) = (table.key_location(&AT_CYCLE), method) {
        problems
            .at(&key, "a cycle by its number needs `cycle.method = \"march\"`")
            .because("a direct search knows no cycles before the stabilised one")
            .help("add `method = \"march\"`, and in `[drive]` perhaps a `hold` before the first cycle");
    }
    let error_bars = table.value(&CYCLE_ERROR_BARS);
    let accuracy = table.value(&CYCLE_ACCURACY);
    table.finish();
    Some(CyclePlan {
        steps: steps?,
        method: method?,
        tolerance: tolerance?,
        max_cycles: max_cycles?,
        at_cycle: at_cycle?,
        error_bars: error_bars?,
        accuracy: accuracy?,
    })
}

pub(super) fn solver(mut table: TableReader<'_>, default: SolverPlan) -> Option<SolverPlan> {
    let engine = table.value(&ENGINE);
    let cells = table.value(&SOLVER_CELLS);
    let springs = table.value(&SOLVER_SPRINGS);
    let tolerance = table.value(&SOLVER_TOLERANCE);
    let time_rule = table.value(&TIME_RULE);
    table.finish();
    Some(SolverPlan {
        engine: engine?.unwrap_or(default.engine),
        time_rule: time_rule?,
        springs: springs?,
        cells: cells?,
        tolerance: tolerance?,
    })
}
