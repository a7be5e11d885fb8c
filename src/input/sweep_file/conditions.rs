//! The blocks of a sweep file under each of its conditions: the document with one assignment of every axis, of which a block is read
//! once for each set of assignments that change it.

use std::collections::HashMap;
use std::iter;
use std::rc::Rc;
use std::sync::Arc;

use super::Sweep;
use crate::drive::HarmonicDrive;
use crate::indenter::Indenter;
use crate::input::adhesion_block::{self, Attraction};
use crate::input::axis::{self, Axis};
use crate::input::diagnostic::{Location, Problems};
use crate::input::document::block;
use crate::input::document::reader::TableReader;
use crate::input::document::tree;
use crate::input::given::Given;
use crate::input::harmonic_block::{self, Pressed};
use crate::input::material_table::DirectSum;
use crate::input::{indenter_block, keys, material_block, solver_block};
use crate::material::Material;
use crate::quantity::Dimension;
use crate::quantity::key::Key;
use crate::simulation::body_material::BodyMaterial;
use crate::sweep::plan::axes::GivenBlocks;
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{self, AxisValue, AxisValues, Block, Condition, Varied};

/// What makes a case besides its frequency: of each block what the file itself says, and then what it says under each condition.
/// `None` where a problem was reported.
pub(super) struct Blocks<'a> {
    material: Option<Vec<Arc<Material>>>,
    pub(super) layer: Option<Vec<Option<LayerPlan>>>,
    pub(super) indenter: Option<Vec<Arc<dyn Indenter>>>,
    drive: Option<Vec<HarmonicDrive>>,
    attraction: Option<Option<Attraction<'a>>>,
    given_blocks: GivenBlocks,
    /// Under each condition the places of the values of all axes.
    conditions: Vec<Vec<usize>>,
}

impl<'a> Blocks<'a> {
    /// Reads all blocks under the conditions of these axes.
    pub(super) fn read(root: &mut TableReader<'a>, sweep: Option<&Sweep>, given: &Given) -> Self {
        let file = File {
            axes: sweep.map_or(&[][..], |sweep| &sweep.axes),
            conditions: sweep.map(conditions).unwrap_or_default(),
            given,
            problems: root.problems(),
        };
        file.refuse_beside_lists(root);
        let bodies = file.indenter_material(root);
        let layer = file.layer(root);
        let yields = |bodies: &Vec<Option<_>>| bodies.iter().any(Option::is_some);
        solver_block::refuse_second_body(root, bodies.as_ref().is_some_and(yields));
        let given_blocks = file.given_blocks(root);
        let material = file.material(root).zip(bodies);
        let indenter = file.indenter(root);
        let pressed = Pressed {
            area_m2: indenter.as_deref().and_then(period_area_m2),
            is_attracted: root.has(&keys::ADHESION),
        };
        let attraction = adhesion_block::read(root);
        let is_of_drive = |varied: &Varied| varied.block == Block::Drive;
        let read_drive = |table: TableReader<'_>| harmonic_block::read(table, pressed);
        Self {
            material: material.map(|(own, bodies)| beside(&own, &bodies)),
            layer,
            indenter,
            drive: file.each(root, &keys::DRIVE, is_of_drive, read_drive),
            attraction,
            given_blocks,
            conditions: file.conditions,
        }
    }

    /// What the file itself says of a case, and its axes besides the frequency, where there are any. Pressures become the loads that
    /// they are.
    pub(super) fn into_plan(self, sweep: &Sweep) -> Option<(Condition, Option<plan::Axes>)> {
        let (material, indenter, drive) = (self.material?, self.indenter?, self.drive?);
        let (layer, attraction) = (self.layer?, self.attraction?);
        let area_m2 = indenter.first()?.period_area_m2().unwrap_or(1.0);
        let is_pressure = |varied: &Varied| {
            varied.block == Block::Drive && varied.dimension == Some(Dimension::Stress)
        };
        let value = |(axis, at): (&Axis, &usize)| match axis.value(*at) {
            AxisValue::Number(pressure_pa) if is_pressure(&axis.varied) => {
                AxisValue::Number(area_m2 * pressure_pa)
            }
            value => value,
        };
        let values = |places: &Vec<usize>| {
            let values: Vec<AxisValue> = sweep.axes.iter().zip(places).map(value).collect();
            AxisValues::new(&values)
        };
        let of_file = iter::once(Some(AxisValues::default()));
        let values = of_file.chain(self.conditions.iter().map(values));
        let contacts = material.into_iter().zip(layer).zip(indenter);
        let all = values.zip(contacts).zip(drive);
        let mut all = all.map(|((values, ((material, layer), indenter)), drive)| {
            Some(Condition {
                values: values?,
                drive: match &attraction {
                    Some(attraction) => attraction.drive(indenter.as_ref(), &drive)?,
                    None => drive,
                },
                contact: ContactPlan {
                    material,
                    layer,
                    indenter,
                    adhesion: attraction.as_ref().map(|attraction| attraction.adhesion),
                },
            })
        });
        let own = all.next()??;
        let conditions = all.collect::<Option<Vec<Condition>>>()?;
        let mut over: Vec<Varied> = sweep.axes.iter().map(|axis| axis.varied.clone()).collect();
        for varied in over.iter_mut().filter(|varied| is_pressure(varied)) {
            varied.dimension = Some(Dimension::Force);
        }
        let axes = plan::Axes {
            over,
            pairs: sweep.pairs,
            given_blocks: self.given_blocks,
            conditions,
        };
        Some((own, (!sweep.axes.is_empty()).then_some(axes)))
    }
}

/// What reading the blocks of a file has in common.
struct File<'a> {
    axes: &'a [Axis],
    /// Under each condition the places of the values of all axes.
    conditions: Vec<Vec<usize>>,
    given: &'a Given,
    problems: &'a Problems,
}

impl File<'_> {
    /// The list of blocks that stands in place of one, where there is any.
    fn listed(&self, block: Block) -> Option<&Axis> {
        let mut of_block = self.axes.iter().filter(|axis| axis.varied.block == block);
        of_block.find(|axis| axis.varied.is_whole())
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
                    .label(&list.key, "the list")
                    .help(format!("remove `[{name}]`, or the list"));
            }
        }
    }

    /// The same under the file itself and under each condition.
    fn same<T: Clone>(&self, own: T) -> Vec<T> {
        vec![own; 1 + self.conditions.len()]
    }

    /// What is read of a block under the file itself, and then under each condition: of the document with the values of these axes
    /// assigned. Where the file leaves out what one of them varies, and of blocks in a list, the first condition counts for it. What is
    /// wrong with one number is wrong with others too, and reported once; of the blocks of a list each has mistakes of its own.
    fn each<T: Clone>(
        &self,
        root: &mut TableReader<'_>,
        row: &Key,
        is_meant: impl Fn(&Varied) -> bool,
        read: impl Fn(TableReader<'_>) -> Option<T>,
    ) -> Option<Vec<T>> {
        let axes = self.axes.iter().enumerate();
        let axes: Vec<_> = axes.filter(|(_, axis)| is_meant(&axis.varied)).collect();
        let own = match axes.iter().any(|(_, axis)| axis.varied.is_whole()) {
            true => tree::Table::default(),
            // What is wrong with the list is reported already.
            false if axis::has_list(root.parsed(&keys::SWEEP), row.name) => return None,
            false => root.alone(row)?,
        };
        let under = |places: &[usize]| {
            let (mut document, mut path) = (own.clone(), row.name);
            for ((_, axis), at) in axes.iter().zip(places) {
                let assigned = axis.assign(*at, &mut document);
                assigned.map_err(|why| self.problems.push(why)).ok()?;
                path = axis.block_path(*at).unwrap_or(path);
            }
            let place = &document.entries.get(row.name)?.node.location;
            let (table, path) = (document.table(row.name)?, path.to_owned());
            let table = TableReader::new(table, place.clone(), path, self.problems);
            read(table.in_folder(root.folder()))
        };
        let places = |condition: &Vec<usize>| -> Vec<usize> {
            axes.iter().map(|(axis, _)| condition[*axis]).collect()
        };
        let of_file = match axes.iter().all(|(_, axis)| axis.is_in(&own)) {
            true => Vec::new(),
            false => places(self.conditions.first()?),
        };
        let mut known: HashMap<Vec<usize>, Option<T>> = HashMap::new();
        let all = iter::once(of_file).chain(self.conditions.iter().map(places));
        let each = all.map(|places| {
            let known = known.entry(places);
            known.or_insert_with_key(|places| under(places)).clone()
        });
        match axes.iter().all(|(_, axis)| axis.varied.is_whole()) {
            true => each.collect::<Vec<_>>().into_iter().collect(),
            false => each.collect(),
        }
    }

    /// What the indenter is made of, where it is not rigid. What is wrong with the block itself is reported where its shape is read.
    fn indenter_material(&self, root: &mut TableReader<'_>) -> Option<Vec<Option<Arc<Material>>>> {
        if root.parsed(&keys::INDENTER).is_none() && self.listed(Block::Indenter).is_none() {
            return Some(self.same(None));
        }
        let is_meant = |varied: &Varied| {
            varied.is_of_indenter_material()
                || (varied.block == Block::Indenter && varied.is_whole())
        };
        self.each(root, &keys::INDENTER, is_meant, |table| {
            Some(match indenter_block::material_of(table)? {
                Some(body) => Some(self.for_contact(body.value, &body.location)?),
                None => None,
            })
        })
    }

    /// The material, without what the indenter is made of. One fit gives it at every temperature.
    fn material(&self, root: &mut TableReader<'_>) -> Option<Vec<Arc<Material>>> {
        let given = self.given.material.as_ref();
        let given = given.filter(|_| self.listed(Block::Material).is_none());
        if let Some(series) = given.and_then(BodyMaterial::series)
            && root.key_location(&keys::MATERIAL).is_none()
        {
            let material = self.for_contact(series.clone(), root.as_ref())?;
            return Some(self.same(material));
        }
        let mut axes = self.axes.iter();
        let temperature = axes.position(|axis| axis.varied.is_temperature());
        let temperatures = temperature.and_then(|axis| self.axes[axis].numbers());
        let is_meant =
            |varied: &Varied| varied.block == Block::Material && !varied.is_temperature();
        let each = self.each(root, &keys::MATERIAL, is_meant, |table| {
            let axis = temperatures.as_ref();
            let (body, mut each) = material_block::read_over(table, DirectSum::Refused, axis)?;
            let place = body.location.clone();
            if axis.is_none() {
                each.push(material_block::series_of(body)?.value);
            }
            let each = each.into_iter().map(|at| self.for_contact(at, &place));
            each.collect::<Option<Rc<[_]>>>()
        })?;
        let of_condition = |condition: &Vec<usize>| temperature.map_or(0, |axis| condition[axis]);
        let places = iter::once(0).chain(self.conditions.iter().map(of_condition));
        let at = |(each, place): (Rc<[Arc<Material>]>, usize)| each.get(place).cloned();
        each.into_iter().zip(places).map(at).collect()
    }

    /// The texts of the blocks in whose tables an axis varies a number.
    fn given_blocks(&self, root: &mut TableReader<'_>) -> GivenBlocks {
        let text = |table: Option<&tree::Table>, header, is_meant: &dyn Fn(&Varied) -> bool| {
            let is_varied = self.axes.iter().any(|axis| is_meant(&axis.varied));
            Some(table.filter(|_| is_varied)?.toml(header).into())
        };
        let in_material = |varied: &Varied| varied.block == Block::Material && varied.is_nested();
        let of_indenter = Varied::is_of_indenter_material;
        let indenter = root.parsed(&keys::INDENTER);
        let body = indenter.and_then(|indenter| indenter.table("material"));
        GivenBlocks {
            material: text(root.parsed(&keys::MATERIAL), "material", &in_material),
            indenter_material: text(body, "indenter.material", &of_indenter),
        }
    }

    fn indenter(&self, root: &mut TableReader<'_>) -> Option<Vec<Arc<dyn Indenter>>> {
        let list = self.listed(Block::Indenter);
        let given = self.given.indenter.as_ref().filter(|_| list.is_none());
        if let (Some(given), None) = (given, root.key_location(&keys::INDENTER)) {
            return Some(self.same(Arc::clone(given)));
        }
        let is_meant =
            |varied: &Varied| varied.block == Block::Indenter && !varied.is_of_indenter_material();
        let each = self.each(root, &keys::INDENTER, is_meant, indenter_block::read)?;
        let cells = each.first()?.own_cells();
        if let Some(list) = list.filter(|_| each.iter().any(|other| other.own_cells() != cells)) {
            let message = "the indenters of one sweep must be on the same cells";
            self.problems
                .at(&list.key, message)
                .because("maps bring cells of their own")
                .help("make a sweep of each map, and compare their folders");
            return None;
        }
        Some(each)
    }

    /// The layer, where the body is one; where an axis varies it, it must be.
    fn layer(&self, root: &mut TableReader<'_>) -> Option<Vec<Option<LayerPlan>>> {
        let is_meant = |varied: &Varied| varied.block == Block::Layer;
        let is_varied = self.axes.iter().any(|axis| is_meant(&axis.varied));
        match root.has(&keys::LAYER) || is_varied {
            true => self.each(root, &keys::NEEDED_LAYER, is_meant, |table| {
                block::read(table, None).map(Some)
            }),
            false => Some(self.same(None)),
        }
    }

    /// A material that can be in contact and whose contact has a stabilised cycle; any other is refused.
    fn for_contact(&self, material: Material, place: &Location) -> Option<Arc<Material>> {
        let compliance = self.problems.accept(place, material.contact_compliance())?;
        if !compliance.is_fluid() {
            return Some(Arc::new(material));
        }
        self.problems
            .at(
                place,
                "this material is a fluid, and a sweep looks for a stabilised cycle",
            )
            .because("creeps without end under a mean load")
            .help(match material.origin.fit.as_ref() {
                Some(_) => {
                    "write `flow = false` in [material.table] for the solid that fits best, or follow one history \
                     with `contact-dma simulate`"
                }
                None if material.origin.approximation.is_some() => {
                    "write model = \"zener\" with an equilibrium modulus above zero, or follow one history with \
                     `contact-dma simulate`"
                }
                None => "give it an equilibrium modulus above zero, or leave out its viscosity",
            });
        None
    }
}

/// The area (m^2) of one period of a surface that repeats itself, if it has the same under all conditions.
fn period_area_m2(indenters: &[Arc<dyn Indenter>]) -> Option<f64> {
    let own = indenters.first()?.period_area_m2()?;
    let is_same = |other: &Arc<dyn Indenter>| other.period_area_m2() == Some(own);
    indenters.iter().all(is_same).then_some(own)
}

/// Materials beside what the indenter is made of; each pair is made once.
fn beside(materials: &[Arc<Material>], bodies: &[Option<Arc<Material>>]) -> Vec<Arc<Material>> {
    let mut known: HashMap<_, Arc<Material>> = HashMap::new();
    let pairs = materials.iter().zip(bodies);
    let pair = |(own, body): (&Arc<Material>, &Option<Arc<Material>>)| {
        let Some(body) = body else {
            return Arc::clone(own);
        };
        let known = known.entry((Arc::as_ptr(own), Arc::as_ptr(body)));
        let both = || Arc::new(Material::clone(own).against(Material::clone(body)));
        Arc::clone(known.or_insert_with(both))
    };
    pairs.map(pair).collect()
}

/// Under each condition the places of the values of all axes: all combinations, those of the last axis fastest; of pairs the same place
/// on every axis, equal pairs once.
fn conditions(Sweep { axes, pairs, .. }: &Sweep) -> Vec<Vec<usize>> {
    let Some(first) = axes.first() else {
        return Vec::new();
    };
    if *pairs {
        let places: Vec<Vec<usize>> = axes.iter().map(Axis::first_places).collect();
        let together = |at: usize| places.iter().map(|of_axis| of_axis[at]).collect();
        let mut together: Vec<Vec<usize>> = (0..first.count()).map(together).collect();
        together.dedup();
        return together;
    }
    axes.iter().fold(vec![Vec::new()], |before, axis| {
        let with =
            |before: Vec<usize>| (0..axis.count()).map(move |at| [&before[..], &[at]].concat());
        before.into_iter().flat_map(with).collect()
    })
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use super::*;
    use crate::drive::harmonic::{AMPLITUDE, MEAN};
    use crate::input::document::Document;

    /// What is read of `[drive]`, in order, and what each condition has of it, in a sweep with these axes.
    fn readings(axes: &str) -> (Vec<f64>, Vec<f64>) {
        let text = format!("[drive]\nmean = 7\namplitude = 1\n[sweep]\nfrequency = [1]\n{axes}\n");
        let document = Document::parse("axes.toml", &text).unwrap();
        let problems = Problems::new();
        let mut root = document.root(&problems);
        let sweep = root.table(&keys::SWEEP).unwrap();
        let sweep = super::super::read(sweep, Dimension::Force).unwrap();
        let file = File {
            axes: &sweep.axes,
            conditions: conditions(&sweep),
            given: &Given::default(),
            problems: &problems,
        };
        let read = RefCell::new(Vec::new());
        let is_of_drive = |varied: &Varied| varied.block == Block::Drive;
        let each = file.each(&mut root, &keys::DRIVE, is_of_drive, |mut table| {
            table.choose(Dimension::Force);
            let (mean, _) = (table.value(&MEAN)?, table.value::<f64>(&AMPLITUDE)?);
            read.borrow_mut().push(mean);
            Some(mean)
        });
        (read.into_inner(), each.unwrap())
    }

    #[test]
    fn a_block_is_read_once_for_each_set_of_values_that_its_own_axes_give_it() {
        let (read, each) = readings("drive.mean = [1, 2, 3]\nindenter.radius = [4, 5]");
        assert_eq!(read, [7.0, 1.0, 2.0, 3.0]);
        assert_eq!(each, [7.0, 1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
        let (read, each) = readings("indenter.radius = [4, 5, 6]");
        assert_eq!((read, each), (vec![7.0], vec![7.0; 4]));
        let (read, each) = readings("");
        assert_eq!((read, each), (vec![7.0], vec![7.0]));
        let (read, each) =
            readings("drive.mean = [2, 1, 2]\nindenter.radius = [4, 5, 6]\npairs = true");
        assert_eq!(
            (read, each),
            (vec![7.0, 2.0, 1.0], vec![7.0, 2.0, 1.0, 2.0])
        );
    }
}
