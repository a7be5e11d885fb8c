//! The blocks of a sweep file under each of its conditions: read once for every set of values that axes give them.

use std::collections::HashMap;
use std::sync::Arc;

use super::Axes;
use crate::drive::HarmonicDrive;
use crate::indenter::Indenter;
use crate::input::adhesion_block::{self, Attraction};
use crate::input::axis::{self, Swept};
use crate::input::diagnostic::Problems;
use crate::input::document::reader::TableReader;
use crate::input::document::tree;
use crate::input::document::{Located, block};
use crate::input::given::Given;
use crate::input::harmonic_block::{self, Pressed};
use crate::input::keys::drive::Prescribed;
use crate::input::material_table::DirectSum;
use crate::input::{indenter_block, keys, material_block, solver_block};
use crate::material::{Creep, Material};
use crate::quantity::Dimension;
use crate::quantity::key::Key;
use crate::simulation::body_material::BodyMaterial;
use crate::sweep::plan::axes::GivenBlocks;
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{self, AxisValue, AxisValues, Block, Condition, Varied};

/// What a block says, and what it says under each condition; under none of them where that is the same.
#[derive(Clone)]
pub(super) struct Over<T> {
    pub(super) own: T,
    each: Vec<T>,
}

impl<T> Over<T> {
    fn same(own: T) -> Self {
        let each = Vec::new();
        Self { own, each }
    }

    fn under(&self, condition: usize) -> &T {
        self.each.get(condition).unwrap_or(&self.own)
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &T> {
        std::iter::once(&self.own).chain(&self.each)
    }
}

/// What the indenter is made of.
type Body = Arc<Located<Material>>;

/// What makes a case besides its frequency; `None` where a problem was reported.
pub(super) struct Blocks<'a> {
    material: Option<Over<Arc<Material>>>,
    pub(super) layer: Option<Over<Option<LayerPlan>>>,
    pub(super) indenter: Option<Over<Arc<dyn Indenter>>>,
    drive: Option<Over<HarmonicDrive>>,
    attraction: Option<Option<Attraction<'a>>>,
    given_blocks: GivenBlocks,
    /// The values of all axes under each condition.
    conditions: Vec<Vec<f64>>,
    prescribed: Prescribed,
}

impl<'a> Blocks<'a> {
    /// Reads all blocks under the conditions of these axes.
    pub(super) fn read(
        root: &mut TableReader<'a>,
        sweep: Option<&Axes>,
        prescribed: Prescribed,
        given: &Given,
    ) -> Self {
        let swept = sweep.map_or(&[][..], |sweep| &sweep.swept);
        let file = File {
            swept,
            conditions: conditions(swept, sweep.is_some_and(|sweep| sweep.pairs)),
            given,
            sweep: root.parsed(&keys::SWEEP),
            problems: root.problems(),
        };
        file.refuse_beside_lists(root);
        let indenter_material = file.indenter_material(root);
        let layer = file.layer(root);
        let has_indenter_material =
            (indenter_material.as_ref()).is_some_and(|over| over.all().any(Option::is_some));
        solver_block::refuse_second_body(root, has_indenter_material);
        let indenter_material = indenter_material.filter(|over| {
            let mut bodies = over.all().flatten();
            bodies.all(|body| check_contact(file.problems, body))
        });
        let given_blocks = file.given_blocks(root);
        let material = file.material(root).zip(indenter_material);
        let indenter = file.indenter(root);
        let pressed = Pressed {
            area_m2: indenter.as_ref().and_then(period_area_m2),
            is_attracted: root.has(&keys::ADHESION),
        };
        let attraction = adhesion_block::read(root);
        let drive = file.block(root, &keys::DRIVE, file.swept(Block::Drive), |t| {
            harmonic_block::read(t, pressed)
        });
        Self {
            material: material.map(|(own, of)| beside(&own, &of)),
            layer,
            indenter,
            drive,
            attraction,
            given_blocks,
            conditions: file.conditions,
            prescribed,
        }
    }

    /// What the file itself says of a case, and its axes besides the frequency, where there are any. Pressures are told as the loads
    /// that they are.
    pub(super) fn into_plan(self, sweep: Option<&Axes>) -> Option<(Condition, Option<plan::Axes>)> {
        let (material, indenter, drive) = (self.material?, self.indenter?, self.drive?);
        let (layer, attraction) = (self.layer?, self.attraction?);
        let condition = |values, material: &Arc<_>, layer, indenter: &Arc<dyn Indenter>, drive| {
            Some(Condition {
                values,
                drive: match &attraction {
                    Some(attraction) => attraction.drive(indenter.as_ref(), drive)?,
                    None => *drive,
                },
                contact: ContactPlan {
                    material: Arc::clone(material),
                    layer,
                    indenter: Arc::clone(indenter),
                    adhesion: attraction.as_ref().map(|attraction| attraction.adhesion),
                },
            })
        };
        let base = condition(
            AxisValues::default(),
            &material.own,
            layer.own,
            &indenter.own,
            &drive.own,
        )?;
        let is_pressure = |swept: &Swept| {
            let of_drive = swept.varied.is_mean() || swept.varied.is_amplitude();
            self.prescribed == Prescribed::Pressure && of_drive
        };
        let area_m2 = indenter.own.period_area_m2().unwrap_or(1.0);
        let value_of = |(value, swept): (&f64, &Swept)| match is_pressure(swept) {
            _ if swept.varied.is_whole() => AxisValue::Block(*value as usize),
            true => AxisValue::Number(area_m2 * value),
            false => AxisValue::Number(*value),
        };
        let axes = |sweep: &Axes| {
            let mut conditions = Vec::with_capacity(self.conditions.len());
            for (k, values) in self.conditions.iter().enumerate() {
                let values: Vec<_> = values.iter().zip(&sweep.swept).map(value_of).collect();
                conditions.push(condition(
                    AxisValues::new(&values)?,
                    material.under(k),
                    *layer.under(k),
                    indenter.under(k),
                    drive.under(k),
                )?);
            }
            let varied = |swept: &Swept| match is_pressure(swept) {
                true => Varied {
                    dimension: Some(Dimension::Force),
                    ..swept.varied.clone()
                },
                false => swept.varied.clone(),
            };
            Some(plan::Axes {
                over: sweep.swept.iter().map(varied).collect(),
                pairs: sweep.pairs,
                given_blocks: self.given_blocks,
                conditions,
            })
        };
        let axes = match sweep.filter(|sweep| !sweep.swept.is_empty()) {
            Some(sweep) => Some(axes(sweep)?),
            None => None,
        };
        Some((base, axes))
    }
}

/// What reading the blocks of a file has in common.
struct File<'a> {
    swept: &'a [Swept],
    /// The values of all axes under each condition.
    conditions: Vec<Vec<f64>>,
    given: &'a Given,
    /// The `[sweep]` block as it was parsed.
    sweep: Option<&'a tree::Table>,
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
        let mut of_block = self.swept.iter().filter(|s| s.varied.block == block);
        of_block.find(|swept| swept.varied.is_whole())
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
        row: &Key,
        swept: Vec<(usize, &Swept)>,
        read: impl Fn(TableReader<'_>) -> Option<T>,
    ) -> Option<Over<T>> {
        let folder = root.folder();
        let list = swept.iter().position(|(_, swept)| swept.varied.is_whole());
        let (mut given, mut base) = (None, None);
        if list.is_none() {
            if (self.sweep).is_some_and(|sweep| axis::has_list(sweep, row.name)) {
                // What is wrong with the list is told already.
                return None;
            }
            let parsed = root.parsed(row);
            let own = root.table(row)?;
            let (false, Some(parsed)) = (swept.is_empty(), parsed) else {
                return Some(Over::same(read(own)?));
            };
            base = Some(Located {
                value: parsed.clone(),
                path: row.name.to_owned(),
                location: own.as_ref().clone(),
            });
            if swept.iter().all(|(_, swept)| swept.is_in(parsed)) {
                given = Some(read(own)?);
            }
        }
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
            read(TableReader::new(&table, place, path, self.problems).in_folder(folder))
        })?;
        let own = given.or_else(|| each.first().cloned())?;
        Some(Over { own, each })
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
    fn indenter_material(&self, root: &mut TableReader<'_>) -> Option<Over<Option<Body>>> {
        if root.parsed(&keys::INDENTER).is_none() && self.listed(Block::Indenter).is_none() {
            return Some(Over::same(None));
        }
        let swept = self.swept_where(|varied| {
            varied.is_of_indenter_material()
                || (varied.block == Block::Indenter && varied.is_whole())
        });
        self.block(root, &keys::INDENTER, swept, |t| {
            Some(indenter_block::material_of(t)?.map(Arc::new))
        })
    }

    /// The material, without what the indenter is made of.
    fn material(&self, root: &mut TableReader<'_>) -> Option<Over<Arc<Material>>> {
        let for_contact = |material: Located<Material>| {
            check_contact(self.problems, &material).then(|| Arc::new(material.value))
        };
        let read =
            |t: TableReader<'_>, axis| material_block::read_over(t, DirectSum::Refused, axis);
        let at = |material: &Material, location| Located {
            value: material.clone(),
            path: "material".to_owned(),
            location,
        };
        let given = self.given.material.as_ref();
        let given = given.filter(|_| self.listed(Block::Material).is_none());
        if let Some(series) = given.and_then(BodyMaterial::series)
            && root.key_location(&keys::MATERIAL).is_none()
        {
            return for_contact(at(series, root.as_ref().clone())).map(Over::same);
        }
        let swept = self.swept(Block::Material);
        let temperatures = match swept[..] {
            [(_, only)] if only.varied.is_temperature() => only,
            _ => {
                return self.block(root, &keys::MATERIAL, swept, |t| {
                    for_contact(material_block::series_of(read(t, None)?.0)?)
                });
            }
        };
        // One fit gives the material at every temperature.
        let values = &temperatures.values;
        let (body, each) = read(root.table(&keys::MATERIAL)?, Some(values))?;
        let each = each.iter();
        let each = each.map(|material| for_contact(at(material, body.location.clone())));
        let each: Vec<_> = each.collect::<Option<_>>()?;
        let each = self.each(&swept, |at| {
            let at = (values.value.iter()).position(|value| Some(value) == at.first());
            each.get(at?).cloned()
        })?;
        let own = each.first()?.clone();
        Some(Over { own, each })
    }

    /// The texts of the blocks in whose tables an axis varies a number.
    fn given_blocks(&self, root: &mut TableReader<'_>) -> GivenBlocks {
        let varies = |of: &dyn Fn(&Varied) -> bool| self.swept.iter().any(|s| of(&s.varied));
        let in_material = |varied: &Varied| varied.block == Block::Material && varied.is_nested();
        let material = root.parsed(&keys::MATERIAL);
        let indenter = root.parsed(&keys::INDENTER);
        let indenter_material = indenter.and_then(|indenter| indenter.table("material"));
        let text = |table: Option<&tree::Table>, header, is_varied| {
            let table = table.filter(|_| is_varied)?;
            Some(table.toml(header).into())
        };
        GivenBlocks {
            material: text(material, "material", varies(&in_material)),
            indenter_material: text(
                indenter_material,
                "indenter.material",
                varies(&Varied::is_of_indenter_material),
            ),
        }
    }

    fn indenter(&self, root: &mut TableReader<'_>) -> Option<Over<Arc<dyn Indenter>>> {
        let list = self.listed(Block::Indenter);
        let given = self.given.indenter.as_ref().filter(|_| list.is_none());
        if let (Some(given), None) = (given, root.key_location(&keys::INDENTER)) {
            return Some(Over::same(Arc::clone(given)));
        }
        let swept = self.swept_where(|varied| {
            varied.block == Block::Indenter && !varied.is_of_indenter_material()
        });
        let over = self.block(root, &keys::INDENTER, swept, indenter_block::read)?;
        let has_other_cells = |other: &Arc<dyn Indenter>| other.own_cells() != over.own.own_cells();
        if let Some(list) = list.filter(|_| over.all().any(has_other_cells)) {
            let message = "the indenters of one sweep must be on the same cells";
            self.problems
                .at(&list.key_location, message)
                .because("maps bring cells of their own")
                .help("make a sweep of each map, and compare their folders");
            return None;
        }
        Some(over)
    }

    /// The layer, where the body is one; where an axis varies it, it must be.
    fn layer(&self, root: &mut TableReader<'_>) -> Option<Over<Option<LayerPlan>>> {
        let swept = self.swept(Block::Layer);
        match root.has(&keys::LAYER) || !swept.is_empty() {
            true => self.block(root, &keys::NEEDED_LAYER, swept, |t| {
                block::read(t, None).map(Some)
            }),
            false => Some(Over::same(None)),
        }
    }
}

/// The area (m^2) of one period of a surface that repeats itself, if it has the same under all conditions.
fn period_area_m2(indenter: &Over<Arc<dyn Indenter>>) -> Option<f64> {
    let own = indenter.own.period_area_m2()?;
    let is_same = |other: &Arc<dyn Indenter>| other.period_area_m2() == Some(own);
    indenter.all().all(is_same).then_some(own)
}

/// A material beside what the indenter is made of, under each condition where either varies; each pair is made once.
fn beside(material: &Over<Arc<Material>>, of: &Over<Option<Body>>) -> Over<Arc<Material>> {
    let mut known: HashMap<_, Arc<Material>> = HashMap::new();
    let mut pair = |own: &Arc<Material>, of: &Option<Body>| {
        let Some(of) = of else {
            return Arc::clone(own);
        };
        let known = known.entry((Arc::as_ptr(own), Arc::as_ptr(of)));
        let both = || Arc::new(Material::clone(own).against(of.value.clone()));
        Arc::clone(known.or_insert_with(both))
    };
    let own = pair(&material.own, &of.own);
    let conditions = 0..material.each.len().max(of.each.len());
    let each = conditions.map(|k| pair(material.under(k), of.under(k)));
    let each = each.collect();
    Over { own, each }
}

/// All combinations of the values of these axes, those of the last fastest; or the values that stand at the same place, in the order of
/// the first axis.
fn conditions(swept: &[Swept], pairs: bool) -> Vec<Vec<f64>> {
    let all: Vec<&[f64]> = swept.iter().map(|axis| &axis.values.value[..]).collect();
    if pairs {
        let count = all.iter().map(|values| values.len()).min().unwrap_or(0);
        let together = |k: usize| all.iter().map(|values| values[k]).collect();
        let mut together: Vec<Vec<f64>> = (0..count).map(together).collect();
        together.dedup();
        return together;
    }
    all.iter().fold(vec![Vec::new()], |before, values| {
        let next = |before: &Vec<f64>, value: &f64| [&before[..], &[*value]].concat();
        let with = |before: &Vec<f64>| values.iter().map(|v| next(before, v)).collect::<Vec<_>>();
        before.iter().flat_map(with).collect()
    })
}

/// Refuses materials that cannot be in contact, or whose contact has no stabilised cycle: false of those.
fn check_contact(problems: &Problems, material: &Located<Material>) -> bool {
    let compliance = problems.accept(material, material.value.contact_compliance());
    if !compliance.as_ref().is_some_and(Creep::is_fluid) {
        return compliance.is_some();
    }
    problems
        .at(
            material,
            "this material is a fluid, and a sweep looks for a stabilised cycle",
        )
        .because("creeps without end under a mean load")
        .help(match material.value.origin.fit.as_ref() {
            Some(_) => {
                "write `flow = false` in [material.table] for the solid that fits best, or follow one history \
                 with `contact-dma simulate`"
            }
            None if material.value.origin.approximation.is_some() => {
                "write model = \"zener\" with an equilibrium modulus above zero, or follow one history with \
                 `contact-dma simulate`"
            }
            None => "give it an equilibrium modulus above zero, or leave out its viscosity",
        });
    false
}
